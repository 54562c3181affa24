// Name resolution: scopes, shadowing, params, imports, and the locations of errors.

#include "support.h"

static void unknown_names_are_all_found_with_the_nearest(void **state) {
  (void)state;
  expect_errors("height = 1\nprint hieght\nf(x) = xs + y1\n", "E0201 2:7, E0201 3:8, E0201 3:13");
  expect_help("height = 1\nprint hieght", "E0201", "height");
  expect_help("print revolv(1)", "E0201", "revolve");
  expect_help("print Sin", "E0201", "sin");
}

static void tops_see_each_other_in_any_order(void **state) {
  (void)state;
  expect_errors("a = b + f(1)\nb = 2\nf(x) = g(x)\ng(x) = f(x)\n", "");
}

static void a_name_is_defined_once_in_its_scope(void **state) {
  (void)state;
  Parsed p = resolve_text("a = 1\na = 2\n");
  assert_string_equal(errors_of(&p), "E0202 2:1");
  assert_int_equal(p.errors.items[0].notes[0].span.start, 0);
  release(&p);
  expect_errors("f(a, a) = 1\n", "E0202 1:6");
  expect_errors("x = {\n a = 1\n a = 2\n a\n}", "E0202 3:2");
  expect_errors("x = [for [a, a] in [[1, 2]]: a]", "E0202 1:14");
  expect_errors("import m\nm = 1\nimport n: m", "E0202 2:1, E0202 3:11, E0245 3:11");
  expect_errors("param a = 1\na = 2\n", "E0202 2:1");
  expect_errors("_ = 1\n_ = 2\nf(_, _) = 1\nx = { _ = 1\n _ = 2\n 3 }", "");
}

static void an_inner_name_may_hide_a_top_or_a_builtin_only(void **state) {
  (void)state;
  expect_errors("x = 1\nf(x) = x\ny = [for x in 0..3: x]\nz = { x = 2\n x }\nsin = 3\n", "");
  Parsed p = resolve_text("f(x) = [for x in 0..3: x]\n");
  assert_string_equal(errors_of(&p), "E0203 1:13");
  assert_int_equal(p.errors.items[0].notes[0].span.start, 2);
  release(&p);
  expect_errors("f(x) = {\n x = 1\n x\n}", "E0203 2:2");
  expect_errors("f(x) = x => x", "E0203 1:8");
  expect_errors("a = [for x in 0..3, x in 0..3: x]", "E0203 1:21");
  expect_errors("a = [for x in 0..3: (x => x)]", "E0203 1:22");
  expect_errors("a = {\n b = 1\n c = b => b\n c(b)\n}", "E0203 3:6");
  // side by side, not nested
  expect_errors("a = [for x in 0..3: x] + [for x in 0..3: x]\nf = (x => x)\ng = (x => x)", "");
}

static void a_block_runs_from_top_to_bottom(void **state) {
  (void)state;
  expect_errors("x = {\n a = b\n b = 1\n a\n}", "E0204 2:6");
  expect_errors("x = {\n f(n) = f(n - 1)\n f(1)\n}", "");
  expect_errors("x = {\n f = n => f(n - 1)\n f(1)\n}", "E0204 2:11");
  expect_errors("x = {\n f(n) = g(n)\n g(n) = f(n)\n f(1)\n}", "E0204 2:9");
}

static void defaults_use_the_parameters_before_them(void **state) {
  (void)state;
  expect_errors("f(a, b = a) = b", "");
  expect_errors("f(a = b, b = 1) = a", "E0204 1:7");
  expect_errors("f(a = 1, b) = a", "E0205 1:10");
}

static void params_know_builtin_names_only(void **state) {
  (void)state;
  expect_errors("param a = 2 * pi in 0..inf\n", "");
  expect_errors("b = 1\nparam a = b\n", "E0208 2:11");
  expect_errors("param b = 1\nparam a = 1 in 0..b\n", "E0208 2:19");
  expect_errors("param a = max(1, sum([for i in 0..3: i]))\n", "");
  // Local bindings: names of a block, parameters, and names of a comprehension.
  expect_errors("param a = { b = 1; b + 1 }\n", "");
  expect_errors("param a = (x => x + 1)(2)\n", "");
  expect_errors("param a = ((x, y = x) => y)(2)\n", "");
  expect_errors("param a = [for i in 0..3, k in [i]: k]\n", "");
  expect_errors("c = 1\nparam a = { b = c; b }\n", "E0208 2:17");
  expect_errors("c = 1\nparam a = (x => c)(2)\n", "E0208 2:17");
}

static void nothing_is_given_twice(void **state) {
  (void)state;
  expect_errors("x = max(a: 1, b: 2, a: 3)", "E0206 1:21");
  expect_errors("x = { a: 1, \"a\": 2 }", "E0207 1:13");
  expect_errors("r = {}\nx = { a: 1, ...r, b: 2 }", "");
  char text[8192] = "x = max(";
  for (int i = 0; i < 200; i++) sprintf(text + strlen(text), "a%d: 1, ", i == 150 ? 7 : i);
  strcat(text, ")");
  Parsed p = resolve_text(text);
  assert_int_equal(p.errors.count, 1);
  assert_string_equal(p.errors.items[0].message, "the argument a7 is given twice");
  release(&p);
}

static void imported_names_are_checked(void **state) {
  (void)state;
  expect_errors("import m: glazed, puma560\nimport n as k\nx = [glazed, puma560, k.glazed]", "");
  expect_help("import m: glaced", "E0245", "glazed");
  expect_help("import m\nx = m.glaced", "E0245", "glazed");
  expect_errors("import m: _a\nimport n\nx = n._b", "E0246 1:11, E0246 3:7");
  expect_errors("import m: glazed\nx = m.glazed", "E0201 2:5");
  expect_errors("import m\nf(m) = m.anything\n", ""); // the parameter hides the module
  expect_errors("import \"my-part.cag\"\nimport \"my-part.cag\" as part", "E0141 1:8");
}

static void bindings_and_owners_are_set(void **state) {
  (void)state;
  Parsed p = resolve_text("f(x) = y => x + y + sin(k)\nk = 1\ng = {\n h(n) = h\n h\n}\n");
  assert_string_equal(errors_of(&p), "");
  CagFunctionAst *f = p.module->statements[0]->as.definition.value->as.function;
  CagFunctionAst *inner = f->body->as.function;
  assert_null(f->outer);
  assert_ptr_equal(inner->outer, f);
  assert_ptr_equal(f->parameters[0].decl->owner, f);
  assert_true(f->parameters[0].decl->used);
  const CagExpr *sum = inner->body; // (x + y) + sin(k)
  const CagExpr *x = sum->as.binary.left->as.binary.left;
  assert_int_equal(x->as.name.binding, CAG_BIND_DECL);
  assert_ptr_equal(x->as.name.decl, f->parameters[0].decl);
  const CagExpr *call = sum->as.binary.right;
  assert_int_equal(call->as.call.callee->as.name.binding, CAG_BIND_BUILTIN);
  assert_int_equal(call->as.call.callee->as.name.index, 0);
  assert_int_equal(call->as.call.arguments[0].value->as.name.decl->index, 1);
  assert_null(p.module->tops[0]->owner);
  CagStatement *h = p.module->statements[2]->as.definition.value->as.block.statements[0];
  assert_ptr_equal(h->as.definition.value->as.function->self, h->as.definition.decl);
  release(&p);
}

static size_t find_outer(void *context, const char *name) {
  (void)context;
  return strcmp(name, "sin") == 0 || strcmp(name, "earlier") == 0 ? 42 : (size_t)-1;
}

static void earlier_inputs_of_the_repl_come_before_builtins(void **state) {
  (void)state;
  Parsed p = parse_bytes("earlier + sin + cos", 19, CAG_PARSE_REPL);
  CagResolveEnv env = test_env();
  env.find_outer = find_outer;
  cag_resolve(p.module, &env, &p.errors);
  assert_string_equal(errors_of(&p), "");
  const CagExpr *e = p.module->statements[0]->as.expression;
  assert_int_equal(e->as.binary.left->as.binary.left->as.name.index, 42);
  assert_int_equal(e->as.binary.left->as.binary.right->as.name.binding, CAG_BIND_OUTER);
  assert_int_equal(e->as.binary.right->as.name.binding, CAG_BIND_BUILTIN);
  release(&p);
}

// Every syntax or name error that a text alone can cause has an example that causes only this
// error.
static void each_example_of_the_table_provokes_its_error(void **state) {
  (void)state;
  for (size_t i = 0; i < CAG_ERR_COUNT; i++) {
    const CagErrorInfo *info = cag_error_info((CagErrorId)i);
    bool ours = strcmp(info->code, "E0240") < 0 || strcmp(info->code, "E0245") == 0 ||
                strcmp(info->code, "E0246") == 0;
    assert_true(strlen(info->explanation) > 20);
    assert_int_equal(cag_error_by_code(info->code), i);
    assert_int_equal(cag_error_by_reason(info->reason), i);
    if (!ours || !info->example) continue;
    Parsed p = resolve_text(info->example);
    if (p.errors.count == 0) fail_msg("the example of %s is well", info->code);
    for (size_t k = 0; k < p.errors.count; k++)
      if (p.errors.items[k].id != (CagErrorId)i)
        fail_msg("the example of %s provokes %s", info->code, errors_of(&p));
    release(&p);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(unknown_names_are_all_found_with_the_nearest),
      cmocka_unit_test(tops_see_each_other_in_any_order),
      cmocka_unit_test(a_name_is_defined_once_in_its_scope),
      cmocka_unit_test(an_inner_name_may_hide_a_top_or_a_builtin_only),
      cmocka_unit_test(a_block_runs_from_top_to_bottom),
      cmocka_unit_test(defaults_use_the_parameters_before_them),
      cmocka_unit_test(params_know_builtin_names_only),
      cmocka_unit_test(nothing_is_given_twice),
      cmocka_unit_test(imported_names_are_checked),
      cmocka_unit_test(bindings_and_owners_are_set),
      cmocka_unit_test(earlier_inputs_of_the_repl_come_before_builtins),
      cmocka_unit_test(each_example_of_the_table_provokes_its_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
