// Inputs of an interactive session: redefined names, their source, documentation, and members.

#include <stdlib.h>

#include "interp/session/session.h"
#include "session_support.h"

static char last_value[200], last_type[40];

static void keep_value(void *context, const char *text, const char *type) {
  (void)context;
  snprintf(last_value, sizeof last_value, "%s", text);
  snprintf(last_type, sizeof last_type, "%s", type);
}

static void input(CagSession *s, const char *text) {
  if (cag_session_input(s, text, strlen(text), keep_value, NULL) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s", text);
  }
}

// Each name is the previous one plus 1. Names that depend on a redefined name are updated.
static void many_names_follow_one_another(void **state) {
  (void)state;
  enum { N = 150 };
  CagSession *s = new_session();
  char text[80], expected[80];
  input(s, "x0 = 1");
  for (int i = 1; i < N; i++) {
    snprintf(text, sizeof text, "x%d = x%d + 1", i, i - 1);
    input(s, text);
  }
  input(s, "x149");
  assert_string_equal(last_value, "150");
  assert_string_equal(last_type, "number");
  for (int from = 0; from < N - 1; from += 37) {
    snprintf(text, sizeof text, "x%d = 1000", from);
    input(s, text);
    input(s, "x149");
    snprintf(expected, sizeof expected, "%d", 1000 + 149 - from);
    assert_string_equal(last_value, expected);
  }
  input(s, "x0");
  assert_string_equal(last_value, "1000");
  for (size_t i = 0; i < N; i++) {
    const char *source;
    size_t length;
    snprintf(text, sizeof text, "x%zu", i);
    assert_string_equal(cag_session_name(s, i, &source, &length), text);
    if (i % 37 == 0 && i < N - 1) snprintf(expected, sizeof expected, "x%zu = 1000", i);
    else snprintf(expected, sizeof expected, "x%zu = x%zu + 1", i, i - 1);
    assert_int_equal(length, strlen(expected));
    assert_memory_equal(source, expected, length);
    assert_string_equal(cag_session_name(s, i, NULL, NULL), text);
  }
  assert_null(cag_session_name(s, N, NULL, NULL));
  cag_session_free(s);
}

static void names_of_patterns_are_redefined_one_by_one(void **state) {
  (void)state;
  CagSession *s = new_session();
  input(s, "n = 1");
  input(s, "/// Two.\n[x, ...y] = [n, n + 1, 3]");
  input(s, "[x, y]");
  assert_string_equal(last_value, "[1, [2, 3]]");
  input(s, "n = 5"); // both are evaluated again
  input(s, "[y, x]");
  assert_string_equal(last_value, "[[6, 3], 5]");
  input(s, "x = 9"); // the other keeps its definition
  input(s, "n = 7");
  input(s, "[y, x]");
  assert_string_equal(last_value, "[[8, 3], 9]");
  input(s, "{x, b} = {x: n, b: 2}");
  input(s, "[x, b, y]");
  assert_string_equal(last_value, "[7, 2, [8, 3]]");
  const char *source;
  size_t length;
  assert_string_equal(cag_session_name(s, 2, &source, &length), "y");
  assert_int_equal(length, strlen("[x, ...y] = [n, n + 1, 3]"));
  assert_string_equal(cag_session_name(s, 3, NULL, NULL), "b");
  assert_null(cag_session_name(s, 4, NULL, NULL));
  assert_true(cag_input_is_incomplete("[x,", 3));
  assert_true(cag_input_is_incomplete("{x} =", 5));
  cag_session_free(s);
}

static char *document_of(CagSession *s, const char *name) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  const bool known = cag_session_write_doc(s, name, out);
  fclose(out);
  if (known) return text;
  assert_int_equal(size, 0);
  free(text);
  return NULL;
}

static void documents_of_names(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_null(document_of(s, "a"));
  input(s, "/// What it is,\n/// in two lines.\na(x) = x + 1");
  input(s, "b = 2; c = 3");
  input(s, "import std.materials as mat");
  static const char *const documents[][2] = {
      {"a", "a(x) = x + 1\n  What it is,\n  in two lines.\n"}, {"b", "b = 2\n"}, {"c", "c = 3\n"}};
  for (size_t i = 0; i < 3; i++) {
    char *text = document_of(s, documents[i][0]);
    assert_non_null(text);
    assert_string_equal(text, documents[i][1]);
    free(text);
  }
  assert_null(document_of(s, "d"));
  char *text = document_of(s, "mat");
  assert_non_null(text);
  assert_int_equal(strncmp(text, "mat is imported", 15), 0);
  free(text);
  char name[80];
  assert_true(cag_session_library_name(s, "mat.glazed", name, sizeof name));
  assert_string_equal(name, "std.materials.glazed");
  assert_true(cag_session_library_name(s, "mat", name, sizeof name));
  assert_string_equal(name, "std.materials");
  input(s, "import std.materials: glazed");
  assert_true(cag_session_library_name(s, "glazed", name, sizeof name));
  assert_string_equal(name, "std.materials.glazed");
  assert_false(cag_session_library_name(s, "glazed.x", name, sizeof name));
  text = document_of(s, "glazed");
  assert_non_null(text);
  static const char imported[] = "glazed is imported from std.materials\n"
                                 "  Glazed pottery, lacquer";
  assert_int_equal(strncmp(text, imported, strlen(imported)), 0);
  free(text);
  assert_false(cag_session_library_name(s, "b", name, sizeof name));
  assert_false(cag_session_library_name(s, "none.glazed", name, sizeof name));
  cag_session_free(s);
}

static char given[400];

static void append_name(void *context, const char *name) {
  (void)context;
  strcat(given, name);
  strcat(given, " ");
}

static void members_are_those_of_the_value(void **state) {
  (void)state;
  CagSession *s = new_session();
  static const char *const members[][2] = {
      {"p", "width depth "}, {"p.depth", "a b "}, {"p.depth.a", ""}, {"r", "start end step "},
      {"none", ""},          {"p.none", ""},      {"", ""},          {"p.depth.none.a", ""}};
  input(s, "p = {width: 3, depth: {a: 1, b: 2}}; r = 0..3; import std.materials as mat");
  for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
    given[0] = 0;
    cag_session_members(s, members[i][0], append_name, NULL);
    if (strcmp(given, members[i][1]) != 0) fail_msg("%s: %s", members[i][0], given);
    assert_int_equal(cag_session_error_count(s), 0);
  }
  cag_session_free(s);
}

static void scene_is(CagSession *s, const char *expected) {
  CagShownCounts counts;
  char *text = NULL;
  size_t size;
  assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_OK);
  FILE *out = open_memstream(&text, &size);
  cag_session_describe_scene(s, out);
  fclose(out);
  assert_string_equal(text, expected);
  free(text);
}

static void what_is_hidden_is_shown_no_more(void **state) {
  (void)state;
  CagSession *s = new_session();
  input(s, "show box(1), sphere(2), box(1)");
  input(s, "a = 3");
  input(s, "show box(1)\nshow box(2)");
  scene_is(s, "box, 1 x 1 x 1\nsphere, radius 2\nbox, 1 x 1 x 1\nbox, 1 x 1 x 1\n"
              "box, 2 x 2 x 2\n");
  assert_int_equal(cag_session_hide(s, "box(1"), 0);
  assert_int_equal(cag_session_hide(s, "box(1) "), 0);
  assert_int_equal(cag_session_hide(s, "box(1)"), 3);
  assert_int_equal(cag_session_hide(s, "box(1)"), 0);
  input(s, "a");
  scene_is(s, "sphere, radius 2\nbox, 2 x 2 x 2\n");
  assert_int_equal(cag_session_hide(s, "sphere(2)"), 1);
  input(s, "a");
  scene_is(s, "box, 2 x 2 x 2\n");
  cag_session_free(s);
}

// Shows are evaluated again with the current definitions.
static void shows_follow_names_that_are_defined_again(void **state) {
  (void)state;
  CagSession *s = new_session();
  input(s, "n = 3");
  input(s, "show box(n)");
  assert_int_equal(cag_session_build_scene(s), CAG_STATUS_OK);
  assert_int_equal(s->vm->shown_count, 1);
  input(s, "n = -3");
  assert_int_equal(cag_session_build_scene(s), CAG_STATUS_SCRIPT);
  assert_int_equal(s->diagnostics.count, 1); // only the box, not the missing scene
  assert_non_null(strstr(s->diagnostics.items[0].message, "box"));
  input(s, "n = 4");
  assert_int_equal(cag_session_build_scene(s), CAG_STATUS_OK);
  assert_int_equal(s->vm->shown_count, 1);
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(many_names_follow_one_another),
      cmocka_unit_test(names_of_patterns_are_redefined_one_by_one),
      cmocka_unit_test(shows_follow_names_that_are_defined_again),
      cmocka_unit_test(documents_of_names),
      cmocka_unit_test(members_are_those_of_the_value),
      cmocka_unit_test(what_is_hidden_is_shown_no_more),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
