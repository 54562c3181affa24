// Patterns: their grammar, errors, names, and the values of their names.

#include "support.h"

#include "lang/tree.h"

static void patterns_are_read_in_every_place(void **state) {
  (void)state;
  expect_tree("[x, y] = v", "(= [x y] v)");
  expect_tree("{a, b: [c, ...d], in: e,} = v", "(= {a: a b: [c ...d] in: e} v)");
  expect_tree("[...all] = v\n[_, _,] = v", "(= [...all] v)\n(= [_ _] v)");
  expect_tree("f([x], {y}, z = 1) = x", "(= f (=> ([x] {y: y} (z 1)) x))");
  value_is("([x, y]) => x", "(=> ([x y]) x)");
  value_is("(a, {b}) => a", "(=> (a {b: b}) a)");
  value_is("{ [x, y] = v; x }", "(block (= [x y] v) x)");
  value_is("{ {x} = v; x }", "(block (= {x: x} v) x)");
  value_is("[for {a, at: [x, _]} in v, [b] in w if b: a]",
           "(for ({a: a at: [x _]} v) ([b] w if b) a)");
}

static void a_bracket_without_equals_is_a_value(void **state) {
  (void)state;
  value_is("{ [1, 2] }", "(block (list 1 2))");
  value_is("{ [a, b] == c }", "(block (== (list a b) c))");
  value_is("([a, b])", "(group (list a b))");
  value_is("({ a: 1 })", "(group (record (a 1)))");
  expect_tree("x = a\n[y] = b\n{z} = c", "(= x a)\n(= [y] b)\n(= {z: z} c)");
  expect_tree("x = [\n[1, 2],\n[3, 4]\n]", "(= x (list (list 1 2) (list 3 4)))");
}

static void what_a_pattern_cannot_have_is_explained(void **state) {
  (void)state;
  expect_help("[...a, b] = v", "E0143", "a[-1]");
  expect_help("{a, ...b} = v", "E0143", "more fields");
  expect_help("{in} = v", "E0130", "in: name");
  expect_help("[a = 1] = v", "E0126", "default");
  expect_help("f([a] = 1) = a", "E0126", "block");
  expect_help("g = [a, b] => a", "E0144", "([a, b]) => e");
  expect_help("let [a, b] = v", "E0152", "let");
  expect_errors("[] = 1\n{} = 2", "E0129 1:1, E0129 2:1");
  expect_errors("[1] = v", "E0129 1:2");
  expect_errors("param [a] = 1", "E0129 1:7");
}

static void a_broken_pattern_leaves_the_other_lines(void **state) {
  (void)state;
  expect_errors("[x, y = [1, 2]\nz = x + y", "E0123 1:1");
  expect_errors("[x, 1] = [1, 2]\nz = x", "E0129 1:5");
  expect_errors("{x, [y]} = r\nz = x + y", "E0129 1:5");
  expect_errors("f(r) = {\n  [x, 2] = r\n  y = x\n  y\n}\nz = f($)", "E0129 2:7, E0102 6:7");
  expect_errors("a = (1\n[x, y] = [1, 2]\nz = x", "E0123 1:5");
}

static void names_of_a_pattern_are_defined_once(void **state) {
  (void)state;
  expect_errors("[a, a] = [1, 2]", "E0202 1:5");
  expect_errors("{a, b: [a, ..._]} = {}", "E0202 1:9");
  expect_errors("f([a], a) = 1", "E0202 1:8");
  expect_errors("a = 1\n[a] = [2]", "E0202 2:2");
  expect_errors("[_, _] = [1, 2]\nf([_], {b: _}) = 1", "");
  expect_errors("f([a]) = {\n [a] = [1]\n a\n}", "E0203 2:3");
  expect_errors("a = 1\nf([a]) = a\nx = [for [a] in [[1]]: a]\ny = { [a] = [1]\n a }", "");
  expect_errors("x = {\n [a, b] = [b, 1]\n a\n}", "E0204 2:12");
  expect_errors("x = a + b\n[a, ...b] = [1]", "");
  expect_errors("f([a, b], c = a + b) = c", "");
}

static double number_of(const CagModuleAst *m, size_t top) {
  const CagExpr *value = cag_tree_value(m->tops[top]);
  return value && value->kind == CAG_EXPR_NUMBER ? value->as.number : -1;
}

static void a_name_has_the_part_that_is_written(void **state) {
  (void)state;
  // tops[0] is the whole pattern.
  Parsed p = parse_text("[a, {b, c: [d, ...e]}, f] = [1, ({b: 2, c: [3, 4]}), ...[5]]");
  assert_true(p.module->tops[0]->whole);
  assert_string_equal(p.module->tops[0]->name, "[a, {b, c: [d, ...e]}, f]");
  assert_int_equal(p.module->top_count, 6);
  assert_true(number_of(p.module, 1) == 1);
  assert_true(number_of(p.module, 2) == 2);
  assert_true(number_of(p.module, 3) == 3);
  assert_null(cag_tree_value(p.module->tops[4])); // the rest
  assert_null(cag_tree_value(p.module->tops[5])); // spread
  release(&p);
  p = parse_text("{a} = {a: 1, ...r}");
  assert_null(cag_tree_value(p.module->tops[1]));
  release(&p);
}

static void patterns_nest_as_deep_as_brackets(void **state) {
  (void)state;
  char text[4096] = "";
  memset(text, '[', CAG_MAX_NESTING);
  text[CAG_MAX_NESTING] = 'x';
  memset(text + CAG_MAX_NESTING + 1, ']', CAG_MAX_NESTING);
  strcat(text, " = v");
  Parsed p = parse_text(text);
  assert_int_equal(p.errors.count, 0);
  assert_int_equal(p.module->top_count, 2);
  release(&p);
  memmove(text + 1, text, strlen(text) + 1);
  Parsed q = parse_text(text);
  assert_non_null(strstr(errors_of(&q), "E0127 1:1001"));
  release(&q);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(patterns_are_read_in_every_place),
      cmocka_unit_test(a_bracket_without_equals_is_a_value),
      cmocka_unit_test(what_a_pattern_cannot_have_is_explained),
      cmocka_unit_test(a_broken_pattern_leaves_the_other_lines),
      cmocka_unit_test(names_of_a_pattern_are_defined_once),
      cmocka_unit_test(a_name_has_the_part_that_is_written),
      cmocka_unit_test(patterns_nest_as_deep_as_brackets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
