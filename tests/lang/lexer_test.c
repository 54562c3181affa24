// Words: numbers and units, names, texts, comments.

#include "support.h"

static void numbers_have_digits_on_both_sides_of_the_point(void **state) {
  (void)state;
  value_is("1", "1");
  value_is("0.5", "0.5");
  value_is("1_000", "1000");
  value_is("6.02e23", "6.02e+23");
  value_is("1e-3", "0.001");
  value_is("0..5", "(.. 0 5)");
  value_is("0.5..1.5", "(.. 0.5 1.5)");
  value_is("0..<5", "(..< 0 5)");
  expect_mend("x = .5\n", "E0111", "0.5");
  expect_mend("x = 5.\n", "E0111", "5.0");
}

static double value_of(const char *number, CagExprKind kind) {
  char text[128];
  snprintf(text, sizeof text, "x = %s", number);
  Parsed p = parse_text(text);
  assert_int_equal(p.errors.count, 0);
  const CagExpr *e = p.module->statements[0]->as.definition.value;
  assert_int_equal(e->kind, kind);
  double v = e->as.number;
  release(&p);
  return v;
}

// Compared with what the C compiler makes of the same decimal number.
static void numbers_are_rounded_correctly(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double value;
  } cases[] = {{"0.1", 0.1},
               {"123456789.123456789", 123456789.123456789},
               {"9007199254740993", 9007199254740993.0},
               {"1.7976931348623157e308", 1.7976931348623157e308},
               {"4.9e-324", 4.9e-324},
               {"2.2250738585072011e-308", 2.2250738585072011e-308},
               {"123456789012345678901234567890", 123456789012345678901234567890.0},
               {"0.000000000000000000000000000000123", 0.000000000000000000000000000000123},
               {"1e-400", 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_true(value_of(cases[i].text, CAG_EXPR_NUMBER) == cases[i].value);
}

static void units_scale_before_rounding(void **state) {
  (void)state;
  static const struct {
    const char *text;
    double millimetres;
  } lengths[] = {{"10mm", 10},  {"2.5cm", 25},   {"2.3cm", 23},  {"1m", 1000},      {"25um", 0.025},
                 {"1in", 25.4}, {"0.1in", 2.54}, {"1ft", 304.8}, {"1.1ft", 335.28}, {"0.057m", 57}};
  for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++)
    assert_true(value_of(lengths[i].text, CAG_EXPR_NUMBER) == lengths[i].millimetres);
  assert_true(value_of("45deg", CAG_EXPR_ANGLE) == 45);
  assert_true(value_of("0.5turn", CAG_EXPR_ANGLE) == 180);
  assert_true(value_of("1.5rad", CAG_EXPR_ANGLE) ==
              85.943669269623482); // 1.5 * 180/pi to 17 digits
}

static void an_unknown_unit_gets_the_nearest(void **state) {
  (void)state;
  expect_mend("x = 45degrees", "E0109", "45deg");
  expect_mend("x = 3inch", "E0109", "3in");
  expect_mend("x = 3parsec", "E0109", "3 * parsec");
  expect_mend("x = 45°", "E0109", "45deg");
  expect_mend("x = 1_000_", "E0112", "1_000");
  expect_mend("x = 1e999", "E0110", "inf");
}

static void names_are_compared_after_nfc(void **state) {
  (void)state;
  // é as one character, and as e with a combining accent
  expect_tree("\xc3\xa9t\xc3\xa9 = 1\nx = e\xcc\x81t\xc3\xa9\n",
              "(= \xc3\xa9t\xc3\xa9 1)\n(= x \xc3\xa9t\xc3\xa9)");
  Parsed p = resolve_text("\xc3\xa9 = 1\nx = e\xcc\x81\nрадиус = 1\nθ = радиус\n");
  assert_string_equal(errors_of(&p), "");
  release(&p);
}

static void texts_know_their_escapes(void **state) {
  (void)state;
  Parsed p = parse_text("x = \"a \\\"q\\\" \\t\\n \\\\ \\u{3b8} \\{y\\}\"");
  const CagExpr *e = p.module->statements[0]->as.definition.value;
  assert_int_equal(e->kind, CAG_EXPR_TEXT);
  const char *wanted = "a \"q\" \t\n \\ \xce\xb8 {y}";
  assert_int_equal(e->as.text.length, strlen(wanted));
  assert_memory_equal(e->as.text.bytes, wanted, strlen(wanted));
  release(&p);
  value_is("`C:\\data {x}\nnext`", "\"C:\\\\data {x}\\nnext\"");
  expect_mend("x = \"\\x41\"", "E0106", "\\u{41}");
  expect_mend("x = \"\\u{d800}\"", "E0107", "hexadecimal");
}

static void texts_hold_expressions_to_any_depth(void **state) {
  (void)state;
  value_is("\"a{1}b\"", "(text \"a\" 1 \"b\")");
  value_is("\"{1}{2}\"", "(text \"\" 1 \"\" 2 \"\")");
  value_is("\"{ {a: \"x{1}\"}.a }\"", "(text \"\" (. (record (a (text \"x\" 1 \"\"))) a) \"\")");
  value_is("\"{f(\"{g(\"}\")}\")}\"", "(text \"\" (call f (text \"\" (call g \"}\") \"\")) \"\")");
}

static void a_text_ends_on_its_line(void **state) {
  (void)state;
  expect_errors("x = \"abc\ny = 3\n", "E0104 1:5");
  expect_errors("x = \"{1 +\n2}\"\ny = 3 $\n", "E0104 1:5, E0102 3:7");
  expect_errors("x = \"{`a\nb`}\"\n", "E0104 1:5");
}

static void comments_nest_and_count_as_blanks(void **state) {
  (void)state;
  expect_tree("/* a /* b */ c */ x = 1 // d\n", "(= x 1)");
  expect_tree("x = 1 + /* \n */ 2", "(= x (+ 1 2))");
  expect_errors("x = 1 /* /* */\n", "E0103 1:7");
  Parsed p = parse_text("// one\n/// two\nx = 1 /* three */\n");
  assert_int_equal(p.module->comment_count, 3);
  assert_false(p.module->comments[0].doc);
  assert_true(p.module->comments[1].doc);
  assert_true(p.module->comments[2].block);
  assert_string_equal(p.module->tops[0]->doc, "two");
  release(&p);
}

static void documentation_is_that_of_the_definition_which_follows(void **state) {
  (void)state;
  Parsed p = parse_text("/// first\n///  second\n/// \nf(x) = x\n\n//// no\ny = 2\n");
  assert_string_equal(p.module->tops[0]->doc, "first\n second\n");
  assert_null(p.module->tops[1]->doc);
  release(&p);
}

static void invalid_utf8_is_shown_where_it_stands(void **state) {
  (void)state;
  expect_errors("x = 1\ny = \"\xff\"\n", "E0101 2:6");
  expect_errors("x = \"\xc0\x80\"\n", "E0101 1:6");     // overlong
  expect_errors("x = \"\xed\xa0\x80\"\n", "E0101 1:6"); // surrogate
  expect_errors("x = \"\xe2\x82", "E0101 1:6");         // cut off
  Parsed p = parse_bytes("a = 1\0b", 7, CAG_PARSE_FILE);
  assert_string_equal(errors_of(&p), "E0101 1:6");
  release(&p);
}

static void a_byte_order_mark_and_other_spaces_are_blanks(void **state) {
  (void)state;
  expect_tree("\xef\xbb\xbfx = 1\r\ny\xc2\xa0= 2\r\n", "(= x 1)\n(= y 2)");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_have_digits_on_both_sides_of_the_point),
      cmocka_unit_test(numbers_are_rounded_correctly),
      cmocka_unit_test(units_scale_before_rounding),
      cmocka_unit_test(an_unknown_unit_gets_the_nearest),
      cmocka_unit_test(names_are_compared_after_nfc),
      cmocka_unit_test(texts_know_their_escapes),
      cmocka_unit_test(texts_hold_expressions_to_any_depth),
      cmocka_unit_test(a_text_ends_on_its_line),
      cmocka_unit_test(comments_nest_and_count_as_blanks),
      cmocka_unit_test(documentation_is_that_of_the_definition_which_follows),
      cmocka_unit_test(invalid_utf8_is_shown_where_it_stands),
      cmocka_unit_test(a_byte_order_mark_and_other_spaces_are_blanks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
