// The C interface against calls that make no sense: reentry from callbacks, and elements that do
// not exist; and what they tell of built-ins.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

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

// Every call that needs the machine, made from within another one.
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
                          cag_session_write_site(s, "/dev/null/site", &site)};
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
  // What was defined stays, and the session goes on.
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

// The words of a text without its layout.
static void add_words(char *to, size_t size, const char *text) {
  for (size_t n; *(text += strspn(text, " \n")); text += n) {
    n = strcspn(text, " \n");
    const size_t length = strlen(to);
    if (length + n + 2 > size) return;
    memcpy(to + length, text, n);
    memcpy(to + length + n, " ", 2);
  }
}

// What is told of a built-in are the words of its rows, in lines that fit on a screen.
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
    const char *signature, *summary, *example;
    const size_t n = strlen(*name);
    for (size_t i = 0; cag_builtin_row(i, &signature, &summary, &example, NULL); i++) {
      if (strncmp(signature, *name, n) != 0 || (signature[n] != '(' && signature[n])) continue;
      add_words(expected, SIZE, summary ? summary : "");
      // Each summary and example stands in the text.
      if (!strstr(found, expected)) fail_msg("%s: `%s` is missing", *name, expected);
      expected[0] = 0;
      add_words(expected, SIZE, example ? example : "");
      if (!strstr(found, expected)) fail_msg("%s: `%s` is missing", *name, expected);
      expected[0] = 0;
      add_words(expected, SIZE, signature);
      if (!strstr(found, expected)) fail_msg("%s: `%s` is missing", *name, expected);
      expected[0] = 0;
    }
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
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
