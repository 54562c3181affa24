// Interactive sessions through the C interface: definitions by inputs, information about names, and
// writing the session as a script.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "session_support.h"

// The values returned by one call, each followed by a space.
typedef struct Heard {
  char text[8000];
} Heard;

static void hear(void *context, const char *text) {
  Heard *h = context;
  strncat(h->text, text, sizeof h->text - strlen(h->text) - 2);
  strcat(h->text, " ");
}

static void hear_value(void *context, const char *text, const char *type) {
  hear(context, text);
  hear(context, type);
}

// Enters each line of the text separately, and returns the values.
static Heard enter(CagSession *s, const char *text) {
  Heard h = {""};
  while (*text) {
    const size_t n = strcspn(text, "\n");
    if (cag_session_input(s, text, n, hear_value, &h) != CAG_STATUS_OK) {
      cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
      fail_msg("%.*s", (int)n, text);
    }
    text += n + (text[n] == '\n');
  }
  return h;
}

static void expect_values(CagSession *s, const char *text, const char *expected) {
  const Heard h = enter(s, text);
  assert_string_equal(h.text, expected);
}

static Heard members(CagSession *s, const char *path) {
  Heard h = {""};
  cag_session_members(s, path, hear, &h);
  return h;
}

static void members_are(CagSession *s, const char *path, const char *expected) {
  assert_string_equal(members(s, path).text, expected);
}

// Text written to a stream.
typedef struct Page {
  FILE *out;
  char *text;
  size_t length;
} Page;

static Page *page_new(void) {
  Page *p = calloc(1, sizeof *p);
  assert_non_null(p);
  p->out = open_memstream(&p->text, &p->length);
  assert_non_null(p->out);
  return p;
}
static void page_has(Page *p, const char *expected) {
  fclose(p->out);
  assert_string_equal(p->text, expected);
  free(p->text);
  free(p);
}

// --- Definitions ---

static void a_name_may_be_defined_again(void **state) {
  (void)state;
  CagSession *s = new_session();
  expect_values(s, "a = 1\nb = a + 1\nf(x) = x * a\nb\nf(3)", "2 number 3 number ");
  expect_values(s, "a = 5\nb\nf(3)\na", "6 number 15 number 5 number ");
  // An imported name replaces a definition, and vice versa. The module keeps its own definition.
  expect_values(s, "import std.robots: categories\nlen(categories) > 3", "true bool ");
  expect_values(s, "categories = 2\ncategories", "2 number ");
  expect_values(s, "import std.robots\nlen(robots.categories) > 3", "true bool ");
  expect_values(s, "import std.robots: categories\nlen(categories) > 3", "true bool ");
  expect_values(s, "import std.robots as a\nlen(a.categories) > 3\na = 7\na",
                "true bool 7 number ");
  cag_session_free(s);
}

static void params_have_the_values_given_from_outside(void **state) {
  (void)state;
  CagSession *s = new_session();
  cag_session_define(s, "width", "40");
  cag_session_set_frame(s, 3, 5);
  expect_values(s, "param width = 10 in 5..50\nwidth\ntime", "40 number 0.75 number ");
  expect_values(s, "param depth = 10\ndepth", "10 number ");
  cag_session_clear_defines(s);
  expect_values(s, "param width = 10 in 5..50\nwidth", "10 number ");
  cag_session_define(s, "width", "400");
  const char *text = "param width = 10 in 5..50";
  assert_int_equal(cag_session_input(s, text, strlen(text), NULL, NULL), CAG_STATUS_SCRIPT);
  cag_session_free(s);
}

// --- Members ---

static void members_of_all_kinds_of_values(void **state) {
  (void)state;
  CagSession *s = new_session();
  members_are(s, "r", "");
  enter(s, "r = {at: {x: 1, y: 2}, range: 0..3, list: [1, 2]}\nbad = 1 / 0\nimport std.robots");
  members_are(s, "r", "at range list ");
  members_are(s, "r.at", "x y ");
  members_are(s, "r.range", "start end step ");
  expect_values(s, "[r.range.start, r.range.end, r.range.step]", "[0, 3, 1] list ");
  members_are(s, "r.list", "");
  members_are(s, "r.none", "");
  members_are(s, "none", "");
  members_are(s, "", "");
  members_are(s, "bad", "");
  assert_int_equal(cag_session_error_count(s), 0);
  assert_non_null(strstr(members(s, "robots").text, "puma560 "));
  // Each member that the session lists can be evaluated.
  static const char *const values[] = {"box(1)",
                                       "translate([1, 2, 3])",
                                       "plane(origin, Z)",
                                       "circle(2)",
                                       "rectangle(2, 1)",
                                       "sphere_surface(2)",
                                       "mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])",
                                       "group(box(1), sphere(1))",
                                       "robots.puma560",
                                       "robots.puma560.links[1]",
                                       "fixed_link(translate([1, 2, 3]))",
                                       "ground()",
                                       "background(\"red\")",
                                       "camera([9, 9, 9])",
                                       "sun(-Z)"};
  for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
    char text[200];
    snprintf(text, sizeof text, "v = %s", values[i]);
    enter(s, text);
    Heard h = members(s, "v");
    for (char *name = strtok(h.text, " "); name; name = strtok(NULL, " ")) {
      snprintf(text, sizeof text, "v.%s == v.%s or true", name, name);
      if (cag_session_input(s, text, strlen(text), NULL, NULL) != CAG_STATUS_OK)
        fail_msg("%s has no member %s", values[i], name);
    }
  }
  cag_session_free(s);
}

// --- Names and their documentation ---

static void definitions_are_told_as_they_were_written(void **state) {
  (void)state;
  CagSession *s = new_session();
  const char *file =
      "/// The width of the door.\n/// In mm.\nwidth = 900\nimport std.robots: puma560\n";
  assert_int_equal(cag_session_input(s, file, strlen(file), NULL, NULL), CAG_STATUS_OK);
  Page *p = page_new();
  assert_true(cag_session_write_doc(s, "width", p->out));
  page_has(p, "width = 900\n  The width of the door.\n  In mm.\n");
  p = page_new();
  assert_false(cag_session_write_doc(s, "height", p->out));
  page_has(p, "");
  p = page_new();
  assert_true(cag_session_write_doc(s, "puma560", p->out));
  fflush(p->out);
  const char *first = "puma560 is imported from std.robots\n  ";
  assert_memory_equal(p->text, first, strlen(first));
  fclose(p->out);
  free(p->text);
  free(p);
  const char *text;
  size_t length;
  assert_string_equal(cag_session_name(s, 0, &text, NULL), "width");
  assert_memory_equal(text, "width = 900", 11);
  assert_string_equal(cag_session_name(s, 0, NULL, &length), "width");
  assert_int_equal(length, 11);
  assert_string_equal(cag_session_name(s, 1, &text, &length), "puma560");
  assert_null(text);
  cag_session_free(s);
}

static void names_of_the_library_are_found_by_what_they_are_called(void **state) {
  (void)state;
  static const struct {
    const char *name, *library; // NULL: not a name of the library
  } cases[] = {{"robots", "std.robots"},
               {"robots.puma560", "std.robots.puma560"},
               {"arms", "std.robots"},
               {"arms.puma560", "std.robots.puma560"},
               {"puma560", "std.robots.puma560"},
               {"puma560.links", NULL},
               {"own", NULL},
               {"own.x", NULL},
               {"none", NULL},
               {"", NULL}};
  CagSession *s = new_session();
  char name[64];
  assert_false(cag_session_library_name(s, "robots", name, sizeof name));
  enter(s,
        "import std.robots\nimport std.robots as arms\nimport std.robots: puma560\nown = {x: 1}");
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const bool found = cag_session_library_name(s, cases[i].name, name, sizeof name);
    if (found != (cases[i].library != NULL)) fail_msg("%s: %d", cases[i].name, found);
    if (found) assert_string_equal(name, cases[i].library);
  }
  cag_session_free(s);
}

// --- The session as a script ---

static void what_was_entered_is_written_as_a_script(void **state) {
  (void)state;
  CagSession *s = new_session();
  enter(s,
        "show sphere(1)\na = 1\nimport std.robots\nassert a < 2\nshow box(a), sphere(2), box(a)\n"
        "a = 1.5\n2 + 2");
  const char *documented = "/// Twice.\n///\n/// Of x.\nf(x) = 2 * x";
  assert_int_equal(cag_session_input(s, documented, strlen(documented), NULL, NULL), CAG_STATUS_OK);
  assert_int_equal(cag_session_hide(s, "box(a)"), 2);
  assert_int_equal(cag_session_hide(s, "box(a)"), 0);
  assert_int_equal(cag_session_hide(s, "box(2)"), 0);
  assert_int_equal(cag_session_hide(s, "sphere(1)"), 1);
  Page *p = page_new();
  cag_session_write_script(s, p->out);
  page_has(p,
           "import std.robots\na = 1.5\n/// Twice.\n/// \n/// Of x.\nf(x) = 2 * x\nassert a < 2\n"
           "show sphere(2)\n");
  CagShownCounts counts;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  assert_int_equal(counts.items, 2); // and the floor
  cag_session_clear(s);
  p = page_new();
  cag_session_write_script(s, p->out);
  page_has(p, "");
  cag_session_free(s);
}

// A session that has run a script, or nothing, has no inputs.
static void a_session_without_inputs_has_no_names(void **state) {
  (void)state;
  for (int with_run = 0; with_run < 2; with_run++) {
    CagSession *s = new_session();
    const char *text = "width = 1\nshow box(width)\n";
    if (with_run)
      assert_int_equal(cag_session_run_text(s, "run", text, strlen(text)), CAG_STATUS_OK);
    char name[64];
    assert_null(cag_session_name(s, 0, NULL, NULL));
    assert_false(cag_session_library_name(s, "width", name, sizeof name));
    members_are(s, "width", "");
    assert_int_equal(cag_session_hide(s, "box(width)"), 0);
    Page *p = page_new();
    assert_false(cag_session_write_doc(s, "width", p->out));
    cag_session_write_script(s, p->out);
    page_has(p, "");
    expect_values(s, "1 + 1", "2 number ");
    cag_session_free(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_name_may_be_defined_again),
      cmocka_unit_test(params_have_the_values_given_from_outside),
      cmocka_unit_test(members_of_all_kinds_of_values),
      cmocka_unit_test(definitions_are_told_as_they_were_written),
      cmocka_unit_test(names_of_the_library_are_found_by_what_they_are_called),
      cmocka_unit_test(what_was_entered_is_written_as_a_script),
      cmocka_unit_test(a_session_without_inputs_has_no_names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
