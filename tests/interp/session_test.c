// The C interface with invalid calls: reentrant calls from callbacks, and elements that do not
// exist. Also the documentation of built-ins.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "session_support.h"

static int input(CagSession *s, const char *text,
                 void (*value)(void *context, const char *text, const char *type), void *context) {
  return cag_session_input(s, text, strlen(text), value, context);
}

// --- Reentry ---

typedef struct Reentry {
  CagSession *session;
  size_t values, refused, calls, names;
} Reentry;

static void no_name(void *context, const char *name) {
  (void)name;
  Reentry *r = context;
  r->names++;
}

static void no_measures(void *context, const CagMeasures *part) { no_name(context, part->name); }

static void no_definition(void *context, const char *text, const char *type, bool shown) {
  (void)type, (void)shown;
  no_name(context, text);
}

// Calls everything that needs the machine, from within another call.
static void call_everything(Reentry *r) {
  CagSession *s = r->session;
  CagShownCounts counts = {9, 9, 9};
  CagRenderOptions render;
  CagSiteOptions site = {.no_pictures = true};
  cag_render_options_init(&render);
  cag_session_options_init(&site.session);
  char *text = NULL;
  size_t length;
  FILE *null = fopen("/dev/null", "w");
  assert_non_null(null);
  const int statuses[] = {input(s, "b = 2", NULL, NULL),
                          cag_session_input_file(s, "none.cag"),
                          cag_session_run_text(s, "inner", "x = 1", 5),
                          cag_session_run_file(s, "none.cag"),
                          cag_session_format(s, "inner", "x=1", 3, &text, &length),
                          cag_session_check_text(s, "inner", "x = 1", 5),
                          cag_session_check_file(s, "none.cag"),
                          cag_session_scene(s, &counts),
                          cag_session_export(s, "/dev/null", "stl"),
                          cag_session_render(s, &render, "none.png"),
                          cag_session_document_text(s, "inner", "x = 1", 5, false, null),
                          cag_session_write_site(s, "/dev/null/site", &site),
                          cag_session_measure(s, no_measures, r),
                          cag_session_definition(s, "a", no_definition, r)};
  r->calls += sizeof statuses / sizeof *statuses;
  for (size_t i = 0; i < sizeof statuses / sizeof *statuses; i++)
    r->refused += statuses[i] == CAG_STATUS_USAGE;
  assert_null(text);
  assert_int_equal(counts.items, 0);
  assert_null(cag_session_camera(s, 0));
  assert_false(cag_session_document(s, "sphere", false, null));
  cag_session_document_names(s, no_name, r);
  cag_session_members(s, "a", no_name, r);
  cag_session_describe_scene(s, null);
  assert_false(cag_session_set_section(s, (double[]){0, 0, 1, 0}));
  assert_false(cag_session_show_only(s, "a"));
  cag_session_clear(s);
  fclose(null);
}

static void reenter(void *context, const char *text, const char *type) {
  (void)text;
  (void)type;
  Reentry *r = context;
  r->values++;
  call_everything(r);
}

static void a_value_callback_that_calls_the_session_is_refused(void **state) {
  (void)state;
  Reentry r = {.session = new_session()};
  assert_int_equal(input(r.session, "a = {x: 1}\nshow sphere(1)", NULL, NULL), CAG_STATUS_OK);
  CagShownCounts before, after;
  assert_int_equal(cag_session_scene(r.session, &before), CAG_STATUS_OK);
  for (int i = 0; i < 40; i++)
    assert_int_equal(input(r.session, "1\n2\n3", reenter, &r), CAG_STATUS_OK);
  assert_int_equal(r.values, 120);
  assert_int_equal(r.refused, r.calls);
  assert_int_equal(r.names, 0);
  assert_int_equal(cag_session_error_count(r.session), 0);
  // Previous definitions are kept, and the session can be used.
  assert_string_equal(cag_session_name(r.session, 0, NULL, NULL), "a");
  assert_null(cag_session_name(r.session, 1, NULL, NULL));
  assert_int_equal(cag_session_scene(r.session, &after), CAG_STATUS_OK);
  assert_int_equal(after.items, before.items);
  cag_session_free(r.session);
}

static void reenter_from_name(void *context, const char *name) {
  (void)name;
  reenter(context, NULL, NULL);
}

static void a_callback_given_names_is_refused_too(void **state) {
  (void)state;
  Reentry r = {.session = new_session()};
  assert_int_equal(input(r.session, "a = {x: 1, y: 2}", NULL, NULL), CAG_STATUS_OK);
  cag_session_members(r.session, "a", reenter_from_name, &r);
  assert_int_equal(r.values, 2);
  assert_int_equal(r.refused, r.calls);
  cag_session_free(r.session);
}

static void free_session(void *context, const char *text, const char *type) {
  (void)text;
  (void)type;
  Reentry *r = context;
  r->values++;
  cag_session_free(r->session);
  cag_session_free(r->session);
}

static void a_callback_may_free_the_session(void **state) {
  (void)state;
  Reentry r = {.session = new_session()};
  assert_int_equal(input(r.session, "1\n2", free_session, &r), CAG_STATUS_OK);
  assert_int_equal(r.values, 2);
}

// --- Elements that do not exist ---

static void errors_out_of_range_are_null(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(cag_session_run_text(s, "bad", "x = ", 4), CAG_STATUS_SCRIPT);
  const size_t n = cag_session_error_count(s);
  assert_int_equal(n, 1);
  const size_t places[] = {n, n + 1, 1000, (size_t)-1};
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    CagErrorView e;
    memset(&e, 0xff, sizeof e);
    cag_session_error(s, places[i], &e);
    assert_null(e.code);
    assert_null(e.reason);
    assert_null(e.message);
    assert_null(e.help);
    assert_null(e.file);
    assert_int_equal(e.line, 0);
  }
  cag_session_free(s);
}

static void names_and_cameras_out_of_range_are_null(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *text = "untouched";
  size_t length = 9;
  assert_null(cag_session_name(s, 0, &text, &length));
  assert_null(text);
  assert_int_equal(length, 0);
  assert_int_equal(input(s, "a = 1\nshow sphere(a)", NULL, NULL), CAG_STATUS_OK);
  assert_non_null(cag_session_name(s, 0, NULL, NULL));
  assert_null(cag_session_name(s, 1, NULL, NULL));
  assert_null(cag_session_name(s, (size_t)-1, NULL, NULL));
  assert_non_null(cag_session_camera(s, 0));
  assert_null(cag_session_camera(s, 1));
  assert_null(cag_session_camera(s, (size_t)-1));
  char name[8];
  assert_false(cag_session_write_doc(s, "b", stderr));
  assert_false(cag_session_library_name(s, "b", name, sizeof name));
  cag_session_free(s);
}

static void tables_out_of_range_are_null(void **state) {
  (void)state;
  const char *a = "a", *b = "b", *c = "c", *d = "d";
  assert_null(cag_library_module((size_t)-1));
  assert_null(cag_library_module(1000));
  assert_null(cag_export_format_story("none"));
  assert_false(cag_builtin_row((size_t)-1, &a, &b, &c, &d));
  assert_true(!a && !b && !c && !d);
  a = b = c = d = "";
  assert_false(cag_error_kind((size_t)-1, &a, &b, &c, &d));
  assert_true(!a && !b && !c && !d);
  assert_false(cag_explain("E9999", stderr));
  assert_false(cag_write_builtin_doc("no_such_name", stderr));
}

// --- The documentation of built-ins ---

// Appends the words of a text without its layout.
static void add_words(char *to, size_t size, const char *text) {
  for (size_t n; *(text += strspn(text, " \n")); text += n) {
    n = strcspn(text, " \n");
    const size_t length = strlen(to);
    if (length + n + 2 > size) return;
    memcpy(to + length, text, n);
    memcpy(to + length + n, " ", 2);
  }
}

// The documentation of a built-in has the words of its rows, in lines that fit on a screen.
static void built_ins_are_told_by_their_rows(void **state) {
  (void)state;
  enum { SIZE = 20000 };
  static char expected[SIZE], found[SIZE];
  for (const char *const *name = cag_builtin_name_list(); *name; name++) {
    char *text = NULL;
    size_t length;
    FILE *out = open_memstream(&text, &length);
    assert_non_null(out);
    assert_true(cag_write_builtin_doc(*name, out));
    fclose(out);
    for (const char *line = text; *line; line += strcspn(line, "\n") + 1)
      if (strncmp(line, "  ", 2) == 0 && line[2] != ' ') assert_true(strcspn(line, "\n") <= 90);
    expected[0] = found[0] = 0;
    add_words(found, SIZE, text);
    // There is an empty line between two rows, and none before the first.
    assert_int_equal(strncmp(text, *name, strlen(*name)), 0);
    size_t rows = 1;
    for (const char *gap = text; (gap = strstr(gap, "\n\n")); gap += 2) rows += gap[2] != ' ';
    const char *signature, *summary, *example;
    const size_t n = strlen(*name);
    for (size_t i = 0; cag_builtin_row(i, &signature, &summary, &example, NULL); i++) {
      if (strncmp(signature, *name, n) != 0 || (signature[n] != '(' && signature[n])) continue;
      rows--;
      add_words(expected, SIZE, summary ? summary : "");
      // The text contains each summary and example.
      if (!strstr(found, expected)) fail_msg("%s: `%s` is missing", *name, expected);
      expected[0] = 0;
      add_words(expected, SIZE, example ? example : "");
      if (!strstr(found, expected)) fail_msg("%s: `%s` is missing", *name, expected);
      expected[0] = 0;
      add_words(expected, SIZE, signature);
      if (!strstr(found, expected)) fail_msg("%s: `%s` is missing", *name, expected);
      expected[0] = 0;
    }
    assert_int_equal(rows, 0);
    free(text);
  }
}

// --- Runs and their statuses ---

static int run_text(CagSession *s, const char *text) {
  return cag_session_run_text(s, "test", text, strlen(text));
}

static CagErrorView first_error(const CagSession *s) {
  CagErrorView e = {0};
  assert_true(cag_session_error_count(s) > 0);
  cag_session_error(s, 0, &e);
  return e;
}

static void each_kind_of_error_has_its_status(void **state) {
  (void)state;
  static const struct {
    const char *text, *reason;
    int status;
  } rows[] = {
      {"print 1 +", "expected-expression", CAG_STATUS_SCRIPT},
      {"x = y", "unknown-name", CAG_STATUS_SCRIPT},
      {"assert false", "assertion", CAG_STATUS_SCRIPT},
      {"import nowhere", "module-not-found", CAG_STATUS_SCRIPT},
      {"f(n) = 1 + f(n + 1)\nx = f(0)\nassert x > 0", "depth-limit", CAG_STATUS_LIMIT},
      {"assert len([for i in 0..1e7: [{a: i}]]) > 0", "memory-limit", CAG_STATUS_LIMIT},
      {"f(n) = f(n + 1)\nassert f(0)", "time-limit", CAG_STATUS_LIMIT},
      {"assert len(faces(tessellate(sphere(10), tolerance: 1e-5))) > 0", "triangle-limit",
       CAG_STATUS_LIMIT},
  };
  CagSessionOptions options = session_options();
  options.max_depth = 100;
  options.max_memory = (size_t)8 << 20;
  options.max_triangles = 1000;
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    options.max_time = strcmp(rows[i].reason, "time-limit") == 0 ? 0.05 : 0;
    CagSession *s = cag_session_new(&options);
    const int status = run_text(s, rows[i].text);
    const CagErrorView e = first_error(s);
    // Each has a location in the script, even limits.
    if (status != rows[i].status || strcmp(e.reason, rows[i].reason) != 0 || e.line == 0) {
      print_error("%s: %d %s in line %zu\n", rows[i].text, status, e.reason, e.line);
      bad++;
    }
    cag_session_free(s);
  }
  assert_int_equal(bad, 0);
  CagSession *s = new_session();
  assert_int_equal(cag_session_run_file(s, "/tmp/no/such/script.cag"), CAG_STATUS_FILE);
  assert_int_equal(run_text(s, "show sphere(1)"), CAG_STATUS_OK);
  assert_int_equal(cag_session_export(s, "/tmp/no/such/folder/a.stl", NULL), CAG_STATUS_FILE);
  assert_int_equal(cag_session_export(s, "/tmp/a.none", NULL), CAG_STATUS_USAGE);
  assert_int_equal(cag_session_export(s, "/dev/null", "none"), CAG_STATUS_USAGE);
  // An interrupt that is already set ends any operation.
  const volatile int interrupt = 1;
  options = session_options();
  options.interrupt = &interrupt;
  CagSession *interrupted = cag_session_new(&options);
  assert_int_equal(run_text(interrupted, "x = 1\nassert x == 1"), CAG_STATUS_INTERRUPTED);
  assert_string_equal(first_error(interrupted).reason, "interrupted");
  cag_session_free(interrupted);
  cag_session_free(s);
}

static void errors_tell_where_they_begin_and_end(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(run_text(s, "x = 1\ny = \"\xc3\xa9\" + [2,\n 3]\nassert y"), CAG_STATUS_SCRIPT);
  const CagErrorView e = first_error(s);
  assert_string_equal(e.file, "test");
  assert_int_equal(e.line, 2);
  assert_int_equal(e.column, 5);
  assert_int_equal(e.end_line, 3);
  assert_int_equal(e.end_column, 4);
  cag_session_free(s);
}

// The asserts of all imported modules are checked, including indirectly imported ones, wherever the
// import is. The last line of one of four modules is false at a time.
static void asserts_of_imported_modules_are_checked(void **state) {
  (void)state;
  static const struct {
    const char *name, *text;
  } modules[] = {{"first", "assert 2 > 1\nvalue = 3\n"},
                 {"second", "value = 4\nimport inner\nimport first\nassert value == 4\nsum = "
                            "inner.value + first.value\n"},
                 {"inner", "value = 5\nassert value == 5\n"},
                 {"last", "value = 6\n"}};
  enum { COUNT = sizeof modules / sizeof *modules };
  char folder[] = "/tmp/cag-session-XXXXXX", path[COUNT][80];
  assert_non_null(mkdtemp(folder));
  const char *const folders[] = {folder};
  for (int wrong = -1; wrong < COUNT; wrong++) {
    for (int i = 0; i < COUNT; i++) {
      snprintf(path[i], sizeof path[i], "%s/%s.cag", folder, modules[i].name);
      FILE *f = fopen(path[i], "w");
      assert_non_null(f);
      fprintf(f, "%s%s", modules[i].text, i == wrong ? "assert value == 7, \"wrong\"\n" : "");
      fclose(f);
    }
    CagSessionOptions options = session_options();
    options.module_path = folders;
    options.module_path_count = 1;
    CagSession *s = cag_session_new(&options);
    const int status =
        run_text(s, "x = 1\nimport first\nassert x == 1\nimport second\nimport last\n"
                    "assert second.sum == 8 and last.value == 6");
    assert_int_equal(status, wrong < 0 ? CAG_STATUS_OK : CAG_STATUS_SCRIPT);
    if (wrong >= 0) {
      assert_string_equal(first_error(s).reason, "assertion");
      assert_non_null(strstr(first_error(s).message, "wrong"));
    }
    cag_session_free(s);
  }
  for (int i = 0; i < COUNT; i++) unlink(path[i]);
  rmdir(folder);
}

static void modules_are_looked_for_in_each_folder(void **state) {
  (void)state;
  char folder[] = "/tmp/cag-session-XXXXXX", one[64], two[64], a[80], b[80], missing[80];
  assert_non_null(mkdtemp(folder));
  snprintf(one, sizeof one, "%s/one", folder);
  snprintf(two, sizeof two, "%s/two", folder);
  snprintf(missing, sizeof missing, "%s/missing", folder);
  snprintf(a, sizeof a, "%s/a.cag", one);
  snprintf(b, sizeof b, "%s/b.cag", two);
  assert_int_equal(mkdir(one, 0700), 0);
  assert_int_equal(mkdir(two, 0700), 0);
  FILE *f = fopen(a, "w");
  fputs("value = 3\n", f);
  fclose(f);
  f = fopen(b, "w");
  fputs("value = 4\n", f);
  fclose(f);
  const char *const folders[] = {missing, one, two};
  for (size_t n = 0; n <= 3; n++) {
    CagSessionOptions options = session_options();
    options.module_path = folders;
    options.module_path_count = n;
    CagSession *s = cag_session_new(&options);
    assert_int_equal(run_text(s, "import a\nassert a.value == 3") == CAG_STATUS_OK, n > 1);
    assert_int_equal(run_text(s, "import b\nassert b.value == 4") == CAG_STATUS_OK, n > 2);
    cag_session_free(s);
  }
  unlink(a);
  unlink(b);
  rmdir(one);
  rmdir(two);
  rmdir(folder);
}

static void frames_tell_the_time(void **state) {
  (void)state;
  CagSession *s = new_session();
  static const struct {
    double frame, frames;
    bool loop;
    const char *assertion;
  } rows[] = {
      {0, 1, false, "assert time == 0 and frame == 0 and frames == 1"},
      {3, 5, false, "assert time == 0.75 and frame == 3 and frames == 5"},
      {4, 5, false, "assert time == 1"},
      {3, 4, true, "assert time == 0.75 and frame == 3 and frames == 4"},
      {0, 4, true, "assert time == 0"},
      {0, 1, true, "assert time == 0"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    cag_session_set_frame(s, rows[i].frame, rows[i].frames);
    cag_session_set_loop(s, rows[i].loop);
    if (run_text(s, rows[i].assertion) != CAG_STATUS_OK) fail_msg("%s", rows[i].assertion);
  }
  cag_session_free(s);
}

// Messages for fields or members that do not exist.
static void fields_that_are_not_there_are_answered_with_those_that_are(void **state) {
  (void)state;
  static const struct {
    const char *script, *message, *help;
  } rows[] = {
      {"print {width: 1, height: 2}.widht", "the record has no field `widht`",
       "did you mean `width`?"},
      {"print {width: 1, height: 2}.qqq", "the record has no field `qqq`",
       "its fields are width, height"},
      {"print {w: 1}.qqq", "the record has no field `qqq`", "its fields are w"},
      {"print {}.qqq", "the record has no field `qqq`", NULL},
      {"print {a1: 1, a2: 1, a3: 1, a4: 1, a5: 1, a6: 1, a7: 1, a8: 1, a9: 1, b1: 1, b2: 1, b3: "
       "1}.qqqqqq",
       "the record has no field `qqqqqq`",
       "its fields are a1, a2, a3, a4, a5, a6, a7, a8, a9, b1, b2, b3"},
      {"print {a1: 1, a2: 1, a3: 1, a4: 1, a5: 1, a6: 1, a7: 1, a8: 1, a9: 1, b1: 1, b2: 1, b3: 1, "
       "b4: 1}.qqqqqq",
       "the record has no field `qqqqqq`", NULL},
      {"r = 1..3\nprint r.qqqq", "a range has no member `qqqq`", "it has start, end, step"},
      {"r = 1..3\nprint r.strat", "a range has no member `strat`", "did you mean `start`?"},
      {"t = identity\nprint t.qqqq", "a transform has no member `qqqq`", "it has x, y, z, origin"},
      {"t = identity\nprint t.orgin", "a transform has no member `orgin`",
       "did you mean `origin`?"},
      {"p = plane(origin, Z)\nprint p.qqqq", "a plane has no member `qqqq`",
       "it has point, normal, row"},
      {"c = circle(1)\nprint c.volume", "a curve has no member `volume`",
       "a function comes after |>: write x |> volume(...)"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagSession *s = new_session();
    const int status = run_text(s, rows[i].script);
    CagErrorView e = {0};
    if (status != CAG_STATUS_OK) cag_session_error(s, 0, &e);
    if (!e.message || strcmp(e.message, rows[i].message) != 0 ||
        (e.help != NULL) != (rows[i].help != NULL) ||
        (rows[i].help && strcmp(e.help, rows[i].help) != 0)) {
      print_error("%s: %s (%s)\n", rows[i].script, e.message ? e.message : "no error",
                  e.help ? e.help : "");
      bad++;
    }
    cag_session_free(s);
  }
  assert_int_equal(bad, 0);
}

// Invalid values of params: the message and the suggestion.
static void definitions_that_do_not_fit_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *script, *name, *value, *code, *message, *help; // code NULL: accepted
  } rows[] = {
      {"param width = 1\nparam height = 2\nx = 3", "widht", "1", "E0247",
       "test has no param `widht`", "did you mean `width`?"},
      {"param width = 1\nparam height = 2\nx = 3", "hight", "1", "E0247",
       "test has no param `hight`", "did you mean `height`?"},
      {"param width = 1\nheight = 2", "height", "1", "E0247", "test has no param `height`", NULL},
      {"x = 3", "tim", "1", "E0247", "test has no param `tim`", "did you mean `time`?"},
      {"x = 3", "framme", "1", "E0247", "test has no param `framme`", "did you mean `frame`?"},
      {"x = 3", "framess", "1", "E0247", "test has no param `framess`", "did you mean `frames`?"},
      {"param a = 1", "a", "1 2", NULL, NULL, NULL},
      {"param a = 1", "a", "\"x\"", "E0248",
       "the param `a` is a number, but -D sets it to the text \"x\"", NULL},
      {"param a = 1", "a", "3deg", "E0248",
       "the param `a` is a number, but -D sets it to the angle 3deg", NULL},
      {"param a = 1deg", "a", "30", "E0248",
       "the param `a` is an angle, but -D sets it to the number 30", "-D a=30deg"},
      {"param a = 1deg\nassert a == 0.25turn", "a", "90deg", "", NULL, NULL},
      {"param a = [1]\nassert len(a) == 3", "a", "1..3", "", NULL, NULL},
      {"param a = 1..3", "a", "[1]", "E0248",
       "the param `a` is a range, but -D sets it to the list [1]", NULL},
      {"param a = none\nassert a == 4", "a", "4", "", NULL, NULL},
      {"param a = (x => x)\nassert a(4) == 2", "a", "sqrt", "", NULL, NULL},
      {"param a = sqrt\nassert a(4) == 8", "a", "x => 2*x", "", NULL, NULL},
      {"param a = \"\"\nassert a == \"b c\"", "a", "b c", "", NULL, NULL},
      {"param a = \"\"\nassert a == \"b c\"", "a", "\"b c\"", "", NULL, NULL},
      {"param a = \"\"\nassert len(a) == 1", "a", "\"", "", NULL, NULL},
      {"param a = \"x\"\nassert a == \"\"", "a", "\"\"", "", NULL, NULL},
      {"param a = \"\"\nassert a == \"b\\\"\"", "a", "b\"", "", NULL, NULL},
      {"param a = 2 in 1..3", "a", "4", "E0249", "the param `a`: 4 is not in 1..3", NULL},
      {"param a = 2 in 1..3\nassert a == 3", "a", "3", "", NULL, NULL},
      {"param a = 2 in [2, 5]", "a", "3", "E0249", "the param `a`: 3 is not in [2, 5]", NULL},
      {"param a = 4 in 1..3", "a", "2", "E0250", "the default of the param `a`: 4 is not in 1..3",
       NULL},
      {"param a = \"x\" in [\"x\", \"y\"]", "a", "z", "E0249",
       "the param `a`: \"z\" is not in [\"x\", \"y\"]", NULL},
      {"x = 1", "time", "\"a\"", "E0248", "-D time expects a number", NULL},
      {"assert time == 0.5 and frame == 0 and frames == 1", "time", "1/2", "", NULL, NULL},
      {"assert frame == 7 and time == 0", "frame", "7", "", NULL, NULL},
      {"param time = 3\nassert time == 4 and frame == 0", "time", "4", "", NULL, NULL},
      {"param a = 1\nb = 2", "a", "b", "E0201", NULL, NULL},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagSession *s = new_session();
    cag_session_define(s, rows[i].name, rows[i].value);
    const int status = run_text(s, rows[i].script);
    const bool good = status == CAG_STATUS_OK, expected = rows[i].code && !*rows[i].code;
    CagErrorView e = {0};
    if (!good) cag_session_error(s, 0, &e);
    if (good != expected || (rows[i].code && *rows[i].code && strcmp(e.code, rows[i].code) != 0) ||
        (rows[i].message && strcmp(e.message, rows[i].message) != 0) ||
        (rows[i].message && (rows[i].help != NULL) != (e.help != NULL)) ||
        (rows[i].help && strcmp(e.help, rows[i].help) != 0)) {
      print_error("%s, -D %s=%s: %s %s (%s)\n", rows[i].script, rows[i].name, rows[i].value,
                  good ? "taken" : e.code, good ? "" : e.message, e.help ? e.help : "");
      bad++;
    }
    cag_session_free(s);
  }
  assert_int_equal(bad, 0);
}

static void definitions_from_outside_stay_until_they_are_cleared(void **state) {
  (void)state;
  CagSession *s = new_session();
  static const char script[] = "param a = 1\nparam b = \"x\"\nparam c = [1]\n";
  char text[256];
  cag_session_define(s, "a", "2 + 3");
  cag_session_define(s, "b", "two words");
  cag_session_define(s, "c", "[7, 8]");
  snprintf(text, sizeof text, "%sassert a == 5 and b == \"two words\" and c == [7, 8]", script);
  for (int i = 0; i < 2; i++) assert_int_equal(run_text(s, text), CAG_STATUS_OK);
  cag_session_define(s, "a", "6"); // the last one counts
  snprintf(text, sizeof text, "%sassert a == 6 and c == [7, 8]", script);
  assert_int_equal(run_text(s, text), CAG_STATUS_OK);
  cag_session_clear_defines(s);
  snprintf(text, sizeof text, "%sassert a == 1 and b == \"x\" and c == [1]", script);
  assert_int_equal(run_text(s, text), CAG_STATUS_OK);
  cag_session_define(s, "d", "1");
  assert_int_equal(run_text(s, text), CAG_STATUS_SCRIPT);
  cag_session_free(s);
}

// --- What is shown ---

static char *described_scene(CagSession *s) {
  char *text = NULL;
  size_t length;
  FILE *out = open_memstream(&text, &length);
  cag_session_describe_scene(s, out);
  fclose(out);
  return text;
}

static void what_is_shown_is_named_and_counted(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *text = "ball = sphere(2)\nother = box(1) |> named(\"own\")\n"
                     "side = camera([9, 9, 9])\n"
                     "show ball, other, box(3), [ball, ball]\n"
                     "show side, camera([9, 0, 9]), sun(-Z)\n";
  assert_int_equal(run_text(s, text), CAG_STATUS_OK);
  char *lines = described_scene(s);
  const char *const begins[] = {"ball: sphere, radius 2\n", "own: box, 1 x 1 x 1\n",
                                "box, 3 x 3 x 3\n"};
  const char *at = lines;
  for (size_t i = 0; i < 3; i++) {
    assert_memory_equal(at, begins[i], strlen(begins[i]));
    at += strlen(begins[i]);
  }
  assert_memory_equal(at, "ball: the list ", 15); // named after the first name in its expression
  size_t count = 0;
  for (const char *c = lines; *c; c++) count += *c == '\n';
  assert_int_equal(count, 7);
  free(lines);
  CagShownCounts counts;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  assert_int_equal(counts.items, 5);
  assert_int_equal(counts.cameras, 2);
  assert_int_equal(counts.lights, 1);
  assert_string_equal(cag_session_camera(s, 0), "side");
  assert_null(cag_session_camera(s, 2));
  cag_session_free(s);
}

static void scenes_without_shapes_are_errors(void **state) {
  (void)state;
  static const struct {
    const char *text, *message, *help;
  } rows[] = {
      {"x = 1", "test shows no shape", "show a shape, such as show sphere(10)"},
      {"show sun(-Z)", "test shows no shape", "show a shape, such as show sphere(10)"},
      {"show box(1) - box(2)", "test shows only empty shapes",
       "`is_empty` tests whether a shape is empty"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagSession *s = new_session();
    CagShownCounts counts;
    assert_int_equal(run_text(s, rows[i].text), CAG_STATUS_OK);
    assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_SCRIPT);
    CagErrorView e;
    cag_session_error(s, cag_session_error_count(s) - 1, &e);
    assert_string_equal(e.reason, "nothing-to-show");
    assert_string_equal(e.message, rows[i].message);
    assert_string_equal(e.help, rows[i].help);
    assert_int_equal(counts.items, 0);
    cag_session_free(s);
  }
}

// Warnings leave space for a subsequent error.
static void empty_shapes_are_warned_of(void **state) {
  (void)state;
  CagSession *s = new_session();
  char text[4000] = "show sphere(1)\n";
  for (int i = 0; i < 30; i++) {
    char one[64];
    snprintf(one, sizeof one, "e%d = box(1) - box(2)\nshow e%d\n", i, i);
    strcat(text, one);
  }
  assert_int_equal(run_text(s, text), CAG_STATUS_OK);
  CagShownCounts counts;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  assert_int_equal(counts.items, 2); // and the floor
  assert_int_equal(cag_session_error_count(s), 19);
  for (size_t i = 0; i < 19; i++) {
    CagErrorView e;
    char expected[100];
    cag_session_error(s, i, &e);
    snprintf(expected, sizeof expected, "e%zu: the shape is empty, so it adds nothing to the scene",
             i);
    assert_string_equal(e.message, expected);
    assert_int_equal(e.line, 2 + 2 * i); // the location of the constructor
  }
  cag_session_free(s);
}

static void an_endless_shape_is_shown_where_it_is_made(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(run_text(s, "a = sphere(3) & box(2)\n"
                               "b = sphere(1) | half_space(plane(origin, Z))\nshow a, b"),
                   CAG_STATUS_OK);
  CagShownCounts counts;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_SCRIPT);
  const CagErrorView e = first_error(s);
  assert_string_equal(e.reason, "solid-unbounded");
  assert_int_equal(e.line, 2);
  assert_int_equal(e.column, 5);
  cag_session_free(s);
}

// There is a warning for each flat loft, wherever it is among the shown shapes.
static void flat_lofts_are_warned_of(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(run_text(s,
                            "b = loft([circle(2), circle(3)])\nc = loft([circle(4), circle(5)])\n"
                            "show box(1), b, sphere(1), c"),
                   CAG_STATUS_OK);
  CagShownCounts counts;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  assert_int_equal(cag_session_error_count(s), 2);
  for (size_t i = 0; i < 2; i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    assert_string_equal(e.message,
                        i ? "c: its sections lie in one plane, so the loft has no volume"
                          : "b: its sections lie in one plane, so the loft has no volume");
  }
  cag_session_free(s);
}

// Files for printing have warnings about open parts, with their open edges.
static void exports_warn_of_open_parts(void **state) {
  (void)state;
  static const struct {
    const char *text, *format, *message, *help; // NULL: no warning
    int status;
  } rows[] = {
      {"t = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\nshow t", "stl",
       "t is an open mesh, not a solid: 3 open edges", "add the missing faces, or `weld` them",
       CAG_STATUS_OK},
      {"t = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\nshow t", "3mf",
       "t is an open mesh, not a solid: 3 open edges", "add the missing faces, or `weld` them",
       CAG_STATUS_OK},
      {"t = mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\nshow t", "obj", NULL, NULL,
       CAG_STATUS_OK},
      {"r = polygon([[0, 0], [3, 0], [0, 2]])\nshow r", "stl",
       "r is a flat region, not a solid: 3 open edges", "`prism` makes it printable",
       CAG_STATUS_OK},
      {"s = bilinear([0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0])\nshow s", "stl",
       "s is an open surface, not a solid: ", "`thicken` or `solid` makes it printable",
       CAG_STATUS_OK},
      {"show box(1)", "stl", NULL, NULL, CAG_STATUS_OK},
      {"show sphere_surface(1)", "stl", NULL, NULL, CAG_STATUS_OK},
      {"show label([0, 0, 0], \"a\")", "stl", "test shows nothing that a mesh file can contain",
       "labels have no mesh (`lettering` has one); show a surface, solid, or mesh",
       CAG_STATUS_SCRIPT},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagSession *s = new_session();
    assert_int_equal(run_text(s, rows[i].text), CAG_STATUS_OK);
    const int status = cag_session_export(s, "/dev/null", rows[i].format);
    CagErrorView e = {0};
    cag_session_error(s, 0, &e);
    const bool told = e.message && rows[i].message && e.help &&
                      strncmp(e.message, rows[i].message, strlen(rows[i].message)) == 0 &&
                      strcmp(e.help, rows[i].help) == 0;
    if (status != rows[i].status || (rows[i].message ? !told : e.message != NULL)) {
      print_error("%s to %s: %d %s (%s)\n", rows[i].text, rows[i].format, status,
                  e.message ? e.message : "nothing", e.help ? e.help : "");
      bad++;
    }
    cag_session_free(s);
  }
  assert_int_equal(bad, 0);
}

// A second interactive input may redefine names, and names that depend on them are updated.
static void scenes_of_inputs_follow_their_names(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(input(s, "r = 1\nb = box(r)\nshow b", NULL, NULL), CAG_STATUS_OK);
  char *lines = described_scene(s);
  assert_string_equal(lines, "b: box, 1 x 1 x 1\n");
  free(lines);
  assert_int_equal(input(s, "r = 2", NULL, NULL), CAG_STATUS_OK);
  lines = described_scene(s);
  assert_string_equal(lines, "b: box, 2 x 2 x 2\n");
  free(lines);
  CagShownCounts counts;
  for (int i = 0; i < 2; i++) {
    assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
    assert_int_equal(counts.items, 2); // and the floor
  }
  // A name that depends on a failing one fails, and works again after the fix.
  assert_int_equal(input(s, "r = -1", NULL, NULL), CAG_STATUS_OK);
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_SCRIPT);
  assert_int_equal(input(s, "r = 3", NULL, NULL), CAG_STATUS_OK);
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  cag_session_free(s);
}

// Warnings of the run and of building its scene are kept. Errors of a call that used the scene are
// replaced by those of the next call.
static void diagnostics_are_those_of_the_run_and_of_the_last_call(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(run_text(s, "e = box(1) - box(2)\nshow sphere(1), e"), CAG_STATUS_OK);
  for (int i = 0; i < 30; i++) {
    CagErrorView e;
    assert_int_equal(cag_session_export(s, "a.abc", NULL), CAG_STATUS_USAGE);
    cag_session_error(s, cag_session_error_count(s) - 1, &e);
    assert_string_equal(e.reason, "format-unknown");
    assert_false(e.warning);
    assert_int_equal(cag_session_export(s, "/dev/null", "svg"), CAG_STATUS_SCRIPT);
    assert_int_equal(cag_session_error_count(s), 2);
    cag_session_error(s, 0, &e);
    assert_string_equal(e.reason, "empty-shape");
    assert_true(e.warning);
    cag_session_error(s, 1, &e);
    assert_string_equal(e.reason, "svg-without-curves");
    assert_int_equal(cag_session_export(s, "/dev/null", "stl"), CAG_STATUS_OK);
    assert_int_equal(cag_session_error_count(s), 1);
  }
  assert_int_equal(run_text(s, "x = nothing"), CAG_STATUS_SCRIPT);
  CagShownCounts counts;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_SCRIPT);
  assert_int_equal(cag_session_error_count(s), 2);
  assert_string_equal(first_error(s).reason, "unknown-name");
  cag_session_free(s);
}

static void a_session_without_options_has_the_defaults(void **state) {
  (void)state;
  CagSession *s = cag_session_new(NULL);
  assert_non_null(s);
  assert_int_equal(run_text(s, "assert 1 + 1 == 2"), CAG_STATUS_OK);
  cag_session_free(s);
  cag_session_free(NULL);
}

static void a_limit_of_time_is_told_from_outside(void **state) {
  (void)state;
  CagSessionOptions options = session_options();
  options.max_time = 2.5;
  CagSession *s = cag_session_new(&options);
  char *text = NULL;
  size_t length;
  FILE *out = open_memstream(&text, &length);
  cag_session_write_overdue(s, CAG_STYLE_TEXT, out);
  fclose(out);
  assert_string_equal(text, "error: exceeded the time limit of 2.5 s (--max-time)\n");
  free(text);
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_kind_of_error_has_its_status),
      cmocka_unit_test(errors_tell_where_they_begin_and_end),
      cmocka_unit_test(asserts_of_imported_modules_are_checked),
      cmocka_unit_test(modules_are_looked_for_in_each_folder),
      cmocka_unit_test(frames_tell_the_time),
      cmocka_unit_test(definitions_that_do_not_fit_are_refused),
      cmocka_unit_test(fields_that_are_not_there_are_answered_with_those_that_are),
      cmocka_unit_test(definitions_from_outside_stay_until_they_are_cleared),
      cmocka_unit_test(what_is_shown_is_named_and_counted),
      cmocka_unit_test(scenes_without_shapes_are_errors),
      cmocka_unit_test(empty_shapes_are_warned_of),
      cmocka_unit_test(an_endless_shape_is_shown_where_it_is_made),
      cmocka_unit_test(exports_warn_of_open_parts),
      cmocka_unit_test(flat_lofts_are_warned_of),
      cmocka_unit_test(scenes_of_inputs_follow_their_names),
      cmocka_unit_test(a_limit_of_time_is_told_from_outside),
      cmocka_unit_test(diagnostics_are_those_of_the_run_and_of_the_last_call),
      cmocka_unit_test(a_session_without_options_has_the_defaults),
      cmocka_unit_test(a_value_callback_that_calls_the_session_is_refused),
      cmocka_unit_test(a_callback_given_names_is_refused_too),
      cmocka_unit_test(a_callback_may_free_the_session),
      cmocka_unit_test(errors_out_of_range_are_null),
      cmocka_unit_test(names_and_cameras_out_of_range_are_null),
      cmocka_unit_test(tables_out_of_range_are_null),
      cmocka_unit_test(built_ins_are_told_by_their_rows),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
