// What the messages of frequent mistakes say: each names what was found, and what to write.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"

// The first error of a script that is run.
static CagErrorView first_error(CagSession **session, const char *script) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  CagSession *s = *session = cag_session_new(&options);
  assert_non_null(s);
  cag_session_run_text(s, "test", script, strlen(script));
  CagErrorView e = {0};
  if (cag_session_error_count(s) == 0) fail_msg("no error: %s", script);
  cag_session_error(s, 0, &e);
  return e;
}

static void expect(const char *script, const char *code, const char *message, const char *help) {
  CagSession *s;
  const CagErrorView e = first_error(&s, script);
  if (strcmp(e.code, code) != 0 || !strstr(e.message, message) ||
      (help && (!e.help || !strstr(e.help, help))))
    fail_msg("%s\n  gives %s: %s\n  help: %s\n  instead of %s: %s\n  help: %s", script, e.code,
             e.message, e.help ? e.help : "none", code, message, help ? help : "any");
  cag_session_free(s);
}

static void a_line_that_begins_with_minus_is_explained(void **state) {
  (void)state;
  static const char help[] = "a line that begins with `-` starts a new statement";
  expect("a = box(3)\n  - translate(box(1), [1, 1, 1])\nshow a", "E0150", "alone", help);
  expect("a = box(3)\n- box(1) - box(2)\nshow a", "E0150", "alone", help);
  expect("a = {\n  b = box(3)\n  b\n  - box(1)\n}\nshow a", "E0150", "not the last", help);
  // The fix that the message names.
  CagSession *s;
  const CagErrorView e = first_error(&s, "a = box(3) -\n  translate(box(1), [1, 1, 1])\nshow a\nb");
  assert_int_equal(e.line, 4);
  cag_session_free(s);
}

static void braces_in_texts_are_explained(void **state) {
  (void)state;
  static const char help[] = "write \\{ for a brace itself";
  expect("x = \"texture { pigment {\"", "E0126", "found `{`", help);
  expect("x = \"a {\"", "E0104", "does not end", help);
  expect("x = \"{ a: 1 }\"", "E0126", "found `:`", help);
  expect("x = \"a { b c } d\"", "E0126", "found `c`", help);
  expect("x = \"a { qqzz } d\"", "E0201", "unknown name `qqzz`", help);
  expect("x = \"{}\"", "E0113", "nothing", help);
  expect("y = 1\nx = \"{y:.2f}\"", "E0167", "no format", "text(y, digits: 2)");
}

static void turns_about_three_axes_point_to_rpy(void **state) {
  (void)state;
  expect("print rotate(box(1), [0, 90, 0])", "E0302", "needs an argument for `angle`",
         "rpy: [0deg, 90deg, 0deg]");
  expect("print rotate(box(1), rpy: [0, 90, 0])", "E0301", "found the number 0", "write 0deg");
}

static void opacity_points_to_transmission(void **state) {
  (void)state;
  expect("print color(box(1), [1, 0, 0, 0.25])", "E0301", "expects a color",
         "{ color: [1, 0, 0], transmission: 0.75 }");
}

static void boxes_of_quadrics_are_boxes(void **state) {
  (void)state;
  static const char planes[] = "[1, -1, 0, 0, 0, 0, 0, 0, 0, -1]";
  char script[200];
  snprintf(script, sizeof script, "print quadric(%s)", planes);
  expect(script, "E0456", "give `within` a box, as box([4, 4, 4], centered: true)", NULL);
  snprintf(script, sizeof script, "print quadric(%s, within: [-2..2, -2..2, -2..2])", planes);
  expect(script, "E0301", "expects a box or a range of z", "box([4, 4, 4], centered: true)");
}

static void mixed_ranges_name_the_angles(void **state) {
  (void)state;
  expect("print 0..360deg", "E0301", "found 0 and 360deg", "write 0deg..360deg");
  expect("print 90deg..180", "E0301", "found 90deg and 180", "write 90deg..180deg");
}

static void hidden_built_ins_are_mentioned(void **state) {
  (void)state;
  expect("norm = 50\nprint norm([1])", "E0304", "no function", "hides the built-in function");
  expect("f(norm) = norm([1, 2])\nprint f(3)", "E0304", "no function", "`norm` is defined here");
  expect("len = 4\nprint map([[1]], len)", "E0301", "expects a function", "`len` is defined here");
}

// A quarter of a circle of radius 1 is pi/2 long.
static void lengths_beyond_a_curve_name_its_length(void **state) {
  (void)state;
  expect("print parameter_at_length(arc(1, 90deg..180deg), -1)", "E0310", "outside 0..1.5707963267",
         NULL);
  expect("print parameter_at_length(arc(1, 90deg..180deg), 9)", "E0310", "outside 0..1.5707963267",
         NULL);
}

static void a_circle_names_its_definitions(void **state) {
  (void)state;
  expect("a = b\nb = a\nprint a", "E0311", "the value of `a` needs itself: a -> b -> a", NULL);
  expect("a = [b]\nb = { x: c }\nc = a\nprint b", "E0311", "needs itself: b -> c -> a -> b", NULL);
  // The message ends there.
  CagSession *s;
  const CagErrorView e = first_error(&s, "a = b\nb = a\nprint a");
  static const char end[] = "a -> b -> a";
  assert_string_equal(e.message + strlen(e.message) - strlen(end), end);
  cag_session_free(s);
}

// The carets stand below the argument that is wrong, not below the whole call.
static void carets_stand_below_the_argument(void **state) {
  (void)state;
  CagSession *s;
  CagErrorView e = first_error(&s, "show sky(0..1)");
  assert_string_equal(e.code, "E0301");
  assert_int_equal(e.column, 10);
  assert_int_equal(e.end_column, 14);
  cag_session_free(s);
  e = first_error(&s, "show color(box(1), 3)");
  assert_int_equal(e.column, 20);
  assert_int_equal(e.end_column, 21);
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_line_that_begins_with_minus_is_explained),
      cmocka_unit_test(braces_in_texts_are_explained),
      cmocka_unit_test(turns_about_three_axes_point_to_rpy),
      cmocka_unit_test(opacity_points_to_transmission),
      cmocka_unit_test(boxes_of_quadrics_are_boxes),
      cmocka_unit_test(mixed_ranges_name_the_angles),
      cmocka_unit_test(hidden_built_ins_are_mentioned),
      cmocka_unit_test(lengths_beyond_a_curve_name_its_length),
      cmocka_unit_test(a_circle_names_its_definitions),
      cmocka_unit_test(carets_stand_below_the_argument),
  };
  return cmocka_run_group_tests_name("messages", tests, NULL, NULL);
}
