// The messages for common mistakes: each names what was found and how to fix it.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "cag.h"

// The first error of a script run.
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
  static const char help[] = "a line that starts with `-` is a new statement";
  expect("a = box(3)\n  - translate(box(1), [1, 1, 1])\nshow a", "E0150", "alone", help);
  expect("a = box(3)\n- box(1) - box(2)\nshow a", "E0150", "alone", help);
  expect("a = {\n  b = box(3)\n  b\n  - box(1)\n}\nshow a", "E0150", "not the last", help);
  // The fix in the message.
  CagSession *s;
  const CagErrorView e = first_error(&s, "a = box(3) -\n  translate(box(1), [1, 1, 1])\nshow a\nb");
  assert_int_equal(e.line, 4);
  cag_session_free(s);
}

static void braces_in_texts_are_explained(void **state) {
  (void)state;
  static const char help[] = "write \\{ for a brace";
  expect("x = \"texture { pigment {\"", "E0126", "found `{`", help);
  expect("x = \"a {\"", "E0104", "is not closed on its line", help);
  expect("x = \"{ a: 1 }\"", "E0126", "found `:`", help);
  expect("x = \"a { b c } d\"", "E0126", "found `c`", help);
  expect("x = \"a { qqzz } d\"", "E0201", "unknown name `qqzz`", help);
  expect("x = \"{}\"", "E0113", "nothing", help);
  expect("y = 1\nx = \"{y:.2f}\"", "E0167", "without a format", "text(y, digits: 2)");
}

// Functions that the checker cannot know before the run.
static void missing_arguments_are_named(void **state) {
  (void)state;
  expect("f(a, b, c = 3) = a + b + c\nprint [f][0](b: 2)", "E0302", "f needs an argument for `a`",
         NULL);
  expect("f(a, b, c = 3) = a + b + c\nprint [f][0](1, c: 2)", "E0302",
         "f needs an argument for `b`", NULL);
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
  expect(script, "E0456", "set `within` to a box, such as box([4, 4, 4], centered: true)", NULL);
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
  expect("norm = 50\nprint norm([1])", "E0304", "not a function", "hides the built-in function");
  expect("f(norm) = norm([1, 2])\nprint f(3)", "E0304", "not a function", "`norm` is defined here");
  expect("len = 4\nprint map([[1]], len)", "E0301", "expects a function", "`len` is defined here");
}

// A quarter of a circle of radius 1 has length pi/2.
static void lengths_beyond_a_curve_name_its_length(void **state) {
  (void)state;
  expect("print parameter_at_length(arc(1, 90deg..180deg), -1)", "E0310", "outside 0..1.5707963267",
         NULL);
  expect("print parameter_at_length(arc(1, 90deg..180deg), 9)", "E0310", "outside 0..1.5707963267",
         NULL);
}

static void a_circle_names_its_definitions(void **state) {
  (void)state;
  expect("a = b\nb = a\nprint a", "E0311", "the value of `a` depends on itself: a -> b -> a", NULL);
  expect("a = [b]\nb = { x: c }\nc = a\nprint b", "E0311", "depends on itself: b -> c -> a -> b",
         NULL);
  // That is the end of the message.
  CagSession *s;
  const CagErrorView e = first_error(&s, "a = b\nb = a\nprint a");
  static const char end[] = "a -> b -> a";
  assert_string_equal(e.message + strlen(e.message) - strlen(end), end);
  cag_session_free(s);
}

// The carets are below the wrong argument, not below the entire call.
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

// Messages of operators and other constructs for values of the wrong type.
static void values_of_a_wrong_type_are_named_with_what_to_write(void **state) {
  (void)state;
  static const struct {
    const char *script, *message, *help; // help may be NULL
  } rows[] = {
      {"print [1] + 30deg", " to the list [1] and the angle 30deg",
       "to add an element, write [...list, x]"},
      {"print 1 + 30deg", " to the number 1 and the angle 30deg", "write 1deg or 1rad"},
      {"print 30deg - 1", " to the angle 30deg and the number 1", "write 1deg or 1rad"},
      {"print 30deg * 30deg", " to the angle 30deg and the angle 30deg",
       "an angle times a number is an angle"},
      {"print 30deg ^ 2", " to the angle 30deg and the number 2", NULL},
      {"print 2 / 30deg", " to the number 2 and the angle 30deg", NULL},
      {"print [1, 2] + [1, 2, 3]", "of a list of 2 and a list of 3 elements",
       "write the 2-D point [x, y] as [x, y, 0]"},
      {"print [1, 2] + [1]", "of a list of 2 and a list of 1 elements", "write [...a, ...b]"},
      {"print [1, 2] - [1]", "of a list of 2 and a list of 1 elements", NULL},
      {"print [1, 2] * [1, 2]", " to the list [1, 2] and the list [1, 2]",
       "write dot(a, b) or cross(a, b)"},
      {"print [1, 2] + 1", " to the list [1, 2] and the number 1", "write [...list, x]"},
      {"print \"a\" + 1", " to the text \"a\" and the number 1", "put the value into the text"},
      {"print 1 + \"a\"", " to the number 1 and the text \"a\"", "put the value into the text"},
      {"print true & false", " to true and false", "write `and`"},
      {"print box(1) + box(2)", " to a solid and a solid", "a | b"},
      {"print region(circle(1)) * region(circle(2))", " to a region and a region", "a & b"},
      {"print true | false", " to true and false", "write `or`"},
      {"print sphere(1) * translate(X)", " to a solid and a transform",
       "the transform comes first"},
      {"print [1, \"a\", 2, 3, 4] + [1, 2, 3, 4, 5]", " to the text \"a\" and the number 2",
       "put the value into the text"},
      {"print 2 * [1, \"a\", 2, 3, 4]", " to the number 2 and the text \"a\"", NULL},
      {"print box(2) - [\"a\", box(1)]", " to a solid and the list [\"a\", box", NULL},
      {"print derivative(curve(t => [t, sum([for x in 0..t: x])], 0..1), 0.5)",
       "a range cannot be differentiated", NULL},
      {"print derivative(curve(t => [t, [1, 2][t - t]], 0..1), 0.5)",
       "an index cannot be differentiated", NULL},
      {"print [1, 2] / 0", "division of 1 by 0", NULL},
      {"print [1, 1e300] * 1e300", "too large for a number", NULL},
      {"print -{a: 1}", "found a record", NULL},
      {"print 1 < 2deg", "cannot compare the number 1 with the angle 2deg", "write 1deg or 1rad"},
      {"print 2deg < 1", "cannot compare the angle 2deg with the number 1", "write 1deg or 1rad"},
      {"print \"a\" < 1", "cannot compare the text \"a\" with the number 1", NULL},
      {"print 3 in 0deg..5deg", " to the number 3 and the range 0deg..5deg",
       "both sides must be numbers, or both angles"},
      {"print 1 in 2", " to the number 1 and the number 2",
       "searches a list or range for an element"},
      {"print 1 in \"a\"", " to the number 1 and the text \"a\"",
       "searches a list or range for an element"},
      {"print \"a\"..2", "a range needs numbers or angles, found the text \"a\"", NULL},
      {"print 1..2deg", "found 1 and 2deg", "write 1deg..2deg"},
      {"print 1deg..2", "found 1deg and 2", "write 1deg..2deg"},
      {"print 1..2 by 1deg",
       "the step of a range of numbers must be a number, found the angle 1deg", NULL},
      {"print 1deg..2deg by 1",
       "the step of a range of angles must be an angle, found the number 1", NULL},
      {"print 1..2 by 0", "a finite number other than 0", NULL},
      {"print [1, 2][0.5]", "expected an integer as the index, found 0.5", NULL},
      {"print [1, 2][2]", "index 2 lies outside of a list of 2", "0 to 1, or -2 to -1"},
      {"print [][0]", "index 0 lies outside of a list of 0", NULL},
      {"print \"abc\"[3]", "index 3 lies outside of a text of 3", "0 to 2, or -3 to -1"},
      {"print \"abc\"[1..7]", "index 7 lies outside of a text of 3", "0 to 2, or -3 to -1"},
      {"print [1, 2][1..5]", "index 5 lies outside of a list of 2", "0 to 1, or -2 to -1"},
      {"print [1, 2][-3..1]", "index -3 lies outside of a list of 2", "0 to 1, or -2 to -1"},
      {"print [1, 2][0..4 by 2]", "index 2 lies outside of a list of 2", "0 to 1, or -2 to -1"},
      {"print \"ab\"[0..4 by 2]", "index 2 lies outside of a text of 2", "0 to 1, or -2 to -1"},
      {"print (1..3)[5]", "index 5 lies outside of a range of 3", "0 to 2, or -3 to -1"},
      {"print [1, 2][0deg..1deg]", "expected integers as indices, found a range of angles", NULL},
      {"print [1, 2][0.5..1]", "expected integers as indices", NULL},
      {"print [1, 2][0..0.5]", "expected integers as indices", NULL},
      {"print [1, 2][\"a\"]", "expected a number or a range as the index, found the text \"a\"",
       NULL},
      {"print {a: 1}[1]", "expected a text as the name of a field, found the number 1", NULL},
      {"print 1[0]", "only lists, ranges, texts, and records have elements, found the number 1",
       NULL},
      {"print {a: 1}[\"b\"]", "the record has no field `b`", "its fields are a"},
      {"print {alpha: 1}.alpah", "the record has no field `alpah`", "did you mean `alpha`?"},
      {"print {}.a", "the record has no field `a`", NULL},
      {"print [1, 2].z", "a vector of 2 numbers has no `z`", NULL},
      {"print [\"a\", \"b\"].x", "needs a vector of 2 to 4 numbers", NULL},
      {"print (1..3).first", "a range has no member `first`", "write x |> first(...)"},
      {"print (1..3).middle", "a range has no member `middle`", "it has start, end, step"},
      {"print translate(X).orign", "a transform has no member `orign`", "did you mean `origin`?"},
      {"print robot([revolute()]).x", "a robot has no member `x`", "it has joints"},
      {"import std.robots as r\nprint r.pume560", "std.robots defines no pume560", "puma560"},
      {"print if \"a\" then 1 else 2", "a condition must be true or false, found the text \"a\"",
       "len(...) > 0"},
      {"print if [1] then 1 else 2", "a condition must be true or false, found the list [1]",
       "len(...) > 0"},
      {"print if none then 1 else 2", "a condition must be true or false, found none",
       "compare it: ... != none"},
      {"print not 1", "must be true or false, found the number 1", "compare it: ... != 0"},
      {"print true and 1", "the right side of `and` must be true or false", "compare it: ... != 0"},
      {"print false or \"a\"", "the right side of `or` must be true or false", "len(...) > 0"},
      {"print [for [a, b] in [1]: a]", "a list of 2 elements, found the number 1", NULL},
      {"print [for [a, b] in [[1, 2, 3]]: a]",
       "the pattern [a, b] expects a list of 2 elements, found 3: [1, 2, 3]",
       "`...rest` takes the other elements"},
      {"print [for [a] in [{b: 1}]: a]", "a list of 1 element, found the record {b: 1}",
       "a record is taken apart by { }"},
      {"{a} = [1]\nprint a", "the pattern {a} expects a record, found the list [1]",
       "a list is taken apart by [ ]"},
      {"{widht} = {width: 1}\nprint widht",
       "the pattern {widht} expects the field `widht`, missing in the record {width: 1}",
       "did you mean `width`?"},
      {"[a, ...b] = []\nprint a", "a list of at least 1 element, found 0: []", NULL},
      {"print [for x in 3: x]", "found the number 3", "to count, write 0..<n"},
      {"print [...3]", "spreads a list, found the number 3", NULL},
      {"print {...3}", "spreads a record, found the number 3", NULL},
      {"print 3(1)", "cannot call the number 3, which is not a function", NULL},
      {"assert [for i in 0..200: i] == [1]", "assertion failed", "5 ..., [1] is [1]"},
      {"assert {a: 1} == {b: 1}", "assertion failed", "{a: 1} is {a: 1}, {b: 1} is {b: 1}"},
      {"show 3", "found the number 3", "to write a value, use `print`"},
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagSession *s;
    const CagErrorView e = first_error(&s, rows[i].script);
    const bool helped = rows[i].help ? e.help && strstr(e.help, rows[i].help) : !e.help;
    if (!strstr(e.message, rows[i].message) || !helped) {
      bad++;
      print_error("%s\n  gives: %s\n  help: %s\n  expected: %s\n  help: %s\n", rows[i].script,
                  e.message, e.help ? e.help : "none", rows[i].message,
                  rows[i].help ? rows[i].help : "none");
    }
    cag_session_free(s);
  }
  assert_int_equal(bad, 0);
}

// The diagnostics of a failing script as text.
static void all_diagnostics(const char *script, char *said, size_t size) {
  CagSession *s;
  first_error(&s, script);
  FILE *f = fmemopen(said, size, "w");
  assert_non_null(f);
  cag_session_write_diagnostics(s, CAG_STYLE_TEXT, f);
  fclose(f);
  cag_session_free(s);
}

static size_t count_of(const char *text, const char *part) {
  size_t n = 0;
  for (const char *at = text; (at = strstr(at, part)); at++) n++;
  return n;
}

// For a long chain of calls, the innermost six and the outermost four are listed, and the number of
// the others.
static void chains_of_calls_are_told(void **state) {
  (void)state;
  for (size_t n = 0; n < 40; n++) {
    char script[200];
    snprintf(script, sizeof script,
             "f(n) =\n  if n == 0 then 1 / n\n  else 1 + f(n - 1)\nprint f(%zu)", n);
    char said[8192];
    all_diagnostics(script, said, sizeof said);
    // All except the call in `print` are calls of f by f.
    size_t skipped = 0;
    const char *omitted = strstr(said, "= ... ");
    if (omitted) assert_int_equal(sscanf(omitted, "= ... %zu more calls ...", &skipped), 1);
    const size_t inner = count_of(said, "= called from test:3:12 in f\n");
    assert_int_equal(count_of(said, "= called from test:4:7\n"), 1);
    assert_int_equal(inner + 1 + skipped, n + 1);
    assert_int_equal(skipped, n + 1 > 10 ? n + 1 - 10 : 0);
    // The gap is after six calls.
    if (omitted) {
      said[omitted - said] = 0;
      assert_int_equal(count_of(said, "= called from"), 6);
    }
  }
}

// Tail calls have no frame; the last sixteen are remembered.
static void calls_in_tail_position_are_told(void **state) {
  (void)state;
  for (size_t n = 0; n < 40; n++) {
    char script[200];
    snprintf(script, sizeof script,
             "f(n) =\n  if n == 0 then 1 / n\n  else f(n - 1)\nx = f(%zu) + 1\nprint x", n);
    char said[8192];
    all_diagnostics(script, said, sizeof said);
    size_t skipped = 0;
    const char *omitted = strstr(said, "= ... ");
    if (omitted)
      assert_int_equal(sscanf(omitted, "= ... %zu more calls in tail position ...", &skipped), 1);
    const size_t told = count_of(said, "= called from test:3:8 in f (tail call)\n");
    assert_int_equal(told, n < 16 ? n : 16);
    assert_int_equal(told + skipped, n);
    assert_int_equal(count_of(said, "= called from test:4:5 in x\n"), 1);
  }
}

static void limits_are_told_in_their_units(void **state) {
  (void)state;
  static const struct {
    size_t bytes;
    const char *message;
  } rows[] = {
      {(size_t)512 << 10, "exceeded the memory limit of 512 KiB (--max-memory)"},
      {(size_t)1 << 20, "exceeded the memory limit of 1 MiB (--max-memory)"},
      {((size_t)1 << 20) - 1024, "exceeded the memory limit of 1.02e+03 KiB (--max-memory)"},
      {(size_t)3 << 19, "exceeded the memory limit of 1.5 MiB (--max-memory)"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    CagSessionOptions options;
    cag_session_options_init(&options);
    options.max_memory = rows[i].bytes;
    CagSession *s = cag_session_new(&options);
    static const char script[] = "print len([for i in 0..1e6: [{a: i}]])";
    assert_int_equal(cag_session_run_text(s, "test", script, sizeof script - 1), CAG_STATUS_LIMIT);
    CagErrorView e;
    cag_session_error(s, 0, &e);
    assert_string_equal(e.message, rows[i].message);
    cag_session_free(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_of_a_wrong_type_are_named_with_what_to_write),
      cmocka_unit_test(a_line_that_begins_with_minus_is_explained),
      cmocka_unit_test(braces_in_texts_are_explained),
      cmocka_unit_test(missing_arguments_are_named),
      cmocka_unit_test(turns_about_three_axes_point_to_rpy),
      cmocka_unit_test(opacity_points_to_transmission),
      cmocka_unit_test(boxes_of_quadrics_are_boxes),
      cmocka_unit_test(mixed_ranges_name_the_angles),
      cmocka_unit_test(hidden_built_ins_are_mentioned),
      cmocka_unit_test(lengths_beyond_a_curve_name_its_length),
      cmocka_unit_test(a_circle_names_its_definitions),
      cmocka_unit_test(carets_stand_below_the_argument),
      cmocka_unit_test(chains_of_calls_are_told),
      cmocka_unit_test(calls_in_tail_position_are_told),
      cmocka_unit_test(limits_are_told_in_their_units),
  };
  return cmocka_run_group_tests_name("messages", tests, NULL, NULL);
}
