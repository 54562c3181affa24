// The grammar: precedence, newlines, brackets, statements.

#include "support.h"

static void operators_bind_as_in_the_table(void **state) {
  (void)state;
  value_is("1 + 2 * 3", "(+ 1 (* 2 3))");
  value_is("1 - 2 - 3", "(- (- 1 2) 3)");
  value_is("a | b - c", "(- (| a b) c)");
  value_is("a | b & c", "(| a (& b c))");
  value_is("-2^2", "(neg (^ 2 2))");
  value_is("2^-1", "(^ 2 (neg 1))");
  value_is("2^3^2", "(^ 2 (^ 3 2))");
  value_is("-a * b", "(* (neg a) b)");
  value_is("-p.x", "(neg (. p x))");
  value_is("not a in b", "(not (in a b))");
  value_is("not a and b or c", "(or (and (not a) b) c)");
  value_is("a < b + 1 and c == d", "(and (< a (+ b 1)) (== c d))");
  value_is("x in 0..1", "(in x (.. 0 1))");
  value_is("0..n - 1 by 2 * k", "(.. 0 (- n 1) by (* 2 k))");
  value_is("a or b |> f", "(|> (or a b) f)");
  value_is("a |> f(b, k: c) |> r.f", "(|> (|> a (call f b k: c)) (. r f))");
  value_is("f(x)[1].y(2)", "(call (. (index (call f x) 1) y) 2)");
}

static void functions_and_branches_reach_far_right(void **state) {
  (void)state;
  value_is("x => x + 1 |> f", "(=> (x) (|> (+ x 1) f))");
  value_is("a => b => a", "(=> (a) (=> (b) a))");
  value_is("if a then b else c |> f", "(if a b (|> c f))");
  value_is("if a then 1 else if b then 2 else 3", "(if a 1 (if b 2 3))");
  value_is("a |> (x => x)", "(|> a (group (=> (x) x)))");
  value_is("f(x => x, if a then b else c)", "(call f (=> (x) x) (if a b c))");
}

static void a_parenthesis_opens_parameters_when_what_follows_says_so(void **state) {
  (void)state;
  value_is("() => 1", "(=> () 1)");
  value_is("(a) => a", "(=> (a) a)");
  value_is("(a, b = 2,) => a", "(=> (a (b 2)) a)");
  value_is("(a = 1) => a", "(=> ((a 1)) a)");
  value_is("(a)", "(group a)");
  value_is("(a => a)", "(group (=> (a) a))");
  value_is("(_, b) => b", "(=> (_ b) b)");
}

static void a_brace_opens_a_record_or_a_block(void **state) {
  (void)state;
  value_is("{}", "(record)");
  value_is("{ a: 1, \"b c\": 2, in: 3, }", "(record (a 1) (b c 2) (in 3))");
  value_is("{ ...r, x: 2 }", "(record (... r) (x 2))");
  value_is("{ a }", "(block a)");
  value_is("{ a = 1; f(n) = f(n - 1)\n assert a > 0, \"m\"\n a; }",
           "(block (= a 1) (= f (=> (n) (call f (- n 1)))) (assert (> a 0) \"m\") a)");
  value_is("{ {a: 1} }", "(block (record (a 1)))");
  value_is("{ \"text\" }", "(block \"text\")");
}

static void lists_spread_and_comprehend(void **state) {
  (void)state;
  value_is("[]", "(list)");
  value_is("[...a, 4,]", "(list (... a) 4)");
  value_is("[for i in 0..<5, j in xs if i != j: [i, j]]",
           "(for (i (..< 0 5)) (j xs if (!= i j)) (list i j))");
  value_is("[for [k, _] in r: k]", "(for ([k _] r) k)");
  value_is("[for _ in 0..3: 1]", "(for (_ (.. 0 3)) 1)");
}

static void reserved_words_name_fields_and_arguments(void **state) {
  (void)state;
  value_is("sort(xs, by: f).in.show", "(. (. (call sort xs by: f) in) show)");
  value_is("{ in: 1, print: 2 }", "(record (in 1) (print 2))");
}

static void statements_follow_their_grammar(void **state) {
  (void)state;
  expect_tree(
      "import std.materials\nimport a.b as c: x, y\nimport \"parts/gripper.cag\"\nimport q: z",
      "(import std.materials as materials)\n(import a.b as c : x y)\n"
      "(import \"parts/gripper.cag\" as gripper)\n(import q : z)");
  expect_tree("param h = 120 in 50..300 \"height\"\nparam s = \"a\" in [\"a\", \"b\"]\nparam t = 1",
              "(param h 120 in (.. 50 300) \"height\")\n(param s \"a\" in (list \"a\" "
              "\"b\"))\n(param t 1)");
  expect_tree("show a, b\nprint 1, \"x\"\nassert a == b, \"no\"",
              "(show a b)\n(print 1 \"x\")\n(assert (== a b) \"no\")");
  expect_tree("f(a, b = a) = a + b; g() = 1;", "(= f (=> (a (b a)) (+ a b)))\n(= g (=> () 1))");
}

static void a_newline_ends_a_statement_where_both_sides_allow_it(void **state) {
  (void)state;
  expect_tree("a = 1\nb = 2", "(= a 1)\n(= b 2)");
  expect_tree("a =\n  1 +\n  2\n  * 3", "(= a (+ 1 (* 2 3)))");
  expect_tree("a = x\n  |> f\n  .y\n  + 1\n  | b\n  and c",
              "(= a (|> x (and (| (+ (. f y) 1) b) c)))");
  expect_tree("a = if c\nthen 1\nelse 2", "(= a (if c 1 2))");
  expect_tree("f = x =>\n x", "(= f (=> (x) x))");
  expect_tree("show a,\n b", "(show a b)");
  expect_tree("a\n= 3", "(= a 3)");
  expect_tree("x = 0\n..\n3\nby 2", "(= x (.. 0 3 by 2))");
}

static void a_line_that_begins_with_minus_or_a_bracket_begins_something_new(void **state) {
  (void)state;
  Parsed p = parse_bytes("a\n-1\nb\n(2)\nc\n[3]", 15, CAG_PARSE_REPL);
  assert_string_equal(tree_of(&p), "a\n(neg 1)\nb\n(group 2)\nc\n(list 3)");
  release(&p);
  value_is("{\n a = 1\n -a\n}", "(block (= a 1) (neg a))");
}

static void newlines_do_not_count_inside_brackets(void **state) {
  (void)state;
  value_is("f(\n a\n - 1\n , b\n)", "(call f (- a 1) b)");
  value_is("[\n 1,\n -2\n]", "(list 1 (neg 2))");
  value_is("{\n a:\n 1\n - 2,\n b: 2\n}", "(record (a (- 1 2)) (b 2))");
  // the innermost bracket decides
  value_is("f({\n a = 1\n -a\n})", "(call f (block (= a 1) (neg a)))");
  value_is("{\n a = (1\n - 2)\n a\n}", "(block (= a (group (- 1 2))) a)");
  // but the bracket of a call or an index must be on the same line
  expect_errors("x = [max\n(1)]\n", "E0126 2:1");
  expect_errors("x = [max\n[1]]\n", "E0126 2:1");
}

static void what_does_not_chain_shows_its_mend(void **state) {
  (void)state;
  expect_help("x = 1 < 2 < 3", "E0133", "1 < 2 and 2 < 3");
  expect_help("x = 0..2..10", "E0134", "0..10 by 2");
  expect_help("x = 10 by 2", "E0135", "0..10 by 2");
}

static void the_repl_asks_for_more_when_something_is_open(void **state) {
  (void)state;
  static const char *const open[] = {"f(",   "[1,",         "{ a = 1",
                                     "1 +",  "x =",         "`raw",
                                     "/* c", "if a then 1", "f(x) = {\n y = 1\n",
                                     "a |>", "import",      "[for x in xs:"};
  static const char *const closed[] = {"1", "x = 1",      "\"abc",     "f(1))", "3 $",
                                       "",  "1 + 1 // c", "{ a = 1 }", "!x",    "f(1, $"};
  for (size_t i = 0; i < sizeof open / sizeof *open; i++)
    if (!cag_parse_incomplete(open[i], strlen(open[i]))) fail_msg("`%s` is open", open[i]);
  for (size_t i = 0; i < sizeof closed / sizeof *closed; i++)
    if (cag_parse_incomplete(closed[i], strlen(closed[i]))) fail_msg("`%s` is closed", closed[i]);
}

static void the_repl_tells_calls_from_definitions(void **state) {
  (void)state;
  const char *text = "f(x)\nf(x) = x\nx\nx = 1\n{ a: 1 }";
  Parsed p = parse_bytes(text, strlen(text), CAG_PARSE_REPL);
  assert_string_equal(errors_of(&p), "");
  assert_string_equal(tree_of(&p), "(call f x)\n(= f (=> (x) x))\nx\n(= x 1)\n(record (a 1))");
  release(&p);
}

// Writes one statement like cag_ast_dump does for a module.
static void dump_one(void *context, const CagModuleAst *m, const CagStatement *s) {
  CagStatement *alone[] = {(CagStatement *)(uintptr_t)s};
  CagModuleAst module = {.source = m->source, .statements = alone, .count = s != NULL};
  cag_ast_dump(context, &module);
}

static void statements_are_handed_over_one_by_one(void **state) {
  (void)state;
  // Names are repeated, and texts are read before the statement that they belong to.
  const char *text = "import \"a/b.cag\"\nx = 1\nshow x\nshow \"t\"; print \"u {x}\", x\n"
                     "f(x, y = 2) = { z = x\n z }\nimport std.m as n: x2\nprint (x) => x";
  Parsed p = parse_text(text);
  assert_string_equal(errors_of(&p), "");
  char *dumped;
  size_t length;
  FILE *f = open_memstream(&dumped, &length);
  CagDiagnostics errors = {0};
  assert_true(cag_parse_each(p.source, dump_one, f, &errors));
  fclose(f);
  dumped[strlen(dumped) - 1] = 0; // the last line end, which tree_of omits
  assert_string_equal(dumped, tree_of(&p));
  free(dumped);
  release(&p);

  // No statement is delivered after an error.
  p = parse_text("a = 1\nb = \nc = 3");
  f = open_memstream(&dumped, &length);
  assert_false(cag_parse_each(p.source, dump_one, f, &errors));
  fclose(f);
  assert_string_equal(dumped, "(= a 1)\n");
  assert_int_equal(errors.count, p.errors.count);
  cag_diagnostics_clear(&errors);
  free(dumped);
  release(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operators_bind_as_in_the_table),
      cmocka_unit_test(functions_and_branches_reach_far_right),
      cmocka_unit_test(a_parenthesis_opens_parameters_when_what_follows_says_so),
      cmocka_unit_test(a_brace_opens_a_record_or_a_block),
      cmocka_unit_test(lists_spread_and_comprehend),
      cmocka_unit_test(reserved_words_name_fields_and_arguments),
      cmocka_unit_test(statements_follow_their_grammar),
      cmocka_unit_test(a_newline_ends_a_statement_where_both_sides_allow_it),
      cmocka_unit_test(a_line_that_begins_with_minus_or_a_bracket_begins_something_new),
      cmocka_unit_test(newlines_do_not_count_inside_brackets),
      cmocka_unit_test(what_does_not_chain_shows_its_mend),
      cmocka_unit_test(the_repl_asks_for_more_when_something_is_open),
      cmocka_unit_test(the_repl_tells_calls_from_definitions),
      cmocka_unit_test(statements_are_handed_over_one_by_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
