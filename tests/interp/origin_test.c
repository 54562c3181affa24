// Where shapes come from in the script.

#include "interp/vm/program.h"
#include "tests/interp/vm_support.h"

// The text of the call that made a shown shape.
static void expect_origin(const CagVm *vm, size_t shown, const char *text, size_t at,
                          const char *definition) {
  const CagValue v = vm->shown[shown].value;
  assert_true(cag_is_shape(v));
  const CagOrigin *o = &CAG_AS_SHAPE(v)->origin;
  const CagOriginStep *made = o->last;
  assert_non_null(made);
  while (made->before) made = made->before;
  assert_int_equal(made->site->span.start, at);
  assert_int_equal(made->site->span.end, at + strlen(text));
  if (definition) assert_string_equal(o->definition->bytes, definition);
  else assert_null(o->definition);
}

static void shapes_remember_the_call_that_made_them(void **state) {
  CagVm *vm = *state;
  static const char script[] = "lid = box([4, 4, 1])\n"
                               "cup(r) = cylinder(9, r)\n"
                               "show lid\n"
                               "show lid |> material({color: \"teal\"}) |> translate([0, 0, 9])\n"
                               "show cup(3)\n"
                               "high = lid |> named(\"top\")\n"
                               "show high\n";
  const size_t m = cag_load_text(vm, "shapes.cag", script, strlen(script), CAG_PARSE_FILE);
  assert_true(m != CAG_NO_MODULE);
  assert_true(cag_program_run(vm, vm->modules[m], NULL, NULL));
  assert_int_equal(vm->shown_count, 4);
  const char *made = strstr(script, "box("), *cup = strstr(script, "cylinder(");
  expect_origin(vm, 0, "box([4, 4, 1])", (size_t)(made - script), "lid");
  // Moving and coloring make another value of the same call.
  expect_origin(vm, 1, "box([4, 4, 1])", (size_t)(made - script), NULL);
  expect_origin(vm, 2, "cylinder(9, r)", (size_t)(cup - script), NULL);
  expect_origin(vm, 3, "box([4, 4, 1])", (size_t)(made - script), "lid");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(shapes_remember_the_call_that_made_them, open_vm, close_vm),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
