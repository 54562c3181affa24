// The examples in the table of built-ins have the stated results.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "interp/session/expect.h"
#include "tests/interp/kernel_program.h"

static void report_failure(void *context, const CagTestFailure *f) {
  (void)context;
  print_error("%s: %s\n", f->test, f->message);
  if (f->expected) print_error("  expected: %s\n", f->expected);
  if (f->got) print_error("  got:      %s\n", f->got);
  if (f->detail) print_error("%s", f->detail);
}

static void every_row_has_a_summary_and_an_example(void **state) {
  (void)state;
  const char *signature, *summary, *example;
  size_t bad = 0;
  for (size_t i = 0; cag_builtin_row(i, &signature, &summary, &example, NULL); i++) {
    bool whole = summary && *summary && example && *example;
    if (!whole) print_error("%s: no summary or no example\n", signature);
    bad += !whole;
  }
  assert_int_equal(bad, 0);
}

static void every_example_runs_as_it_says(void **state) {
  (void)state;
  CagTestOptions options;
  CagTestCounts counts = {0};
  const char *signature, *example;
  size_t examples = 0;
  cag_test_options_init(&options);
  options.failure = report_failure;
  for (size_t i = 0; cag_builtin_row(i, &signature, NULL, &example, NULL); i++) {
    if (!example) continue;
    examples++;
    int status = cag_test_text(signature, example, strlen(example), &options, &counts);
    assert_int_equal(status, CAG_STATUS_OK);
  }
  assert_true(examples > 0);
  assert_int_equal(counts.failed, 0);
  assert_true(counts.passed + counts.skipped >= examples);
}

// An example without a result is useless.
static void every_example_prints_or_shows_or_fails(void **state) {
  (void)state;
  const char *signature, *example;
  size_t bad = 0;
  for (size_t i = 0; cag_builtin_row(i, &signature, NULL, &example, NULL); i++) {
    if (!example) continue;
    bool says = strstr(example, "print ") || strstr(example, "show ") ||
                strstr(example, "assert ") || strstr(example, "expect error:");
    if (!says) print_error("%s: the example shows nothing: %s\n", signature, example);
    bad += !says;
  }
  assert_int_equal(bad, 0);
}

int main(void) {
  use_kernel_program();
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_row_has_a_summary_and_an_example),
      cmocka_unit_test(every_example_runs_as_it_says),
      cmocka_unit_test(every_example_prints_or_shows_or_fails),
  };
  return cmocka_run_group_tests_name("examples of built-ins", tests, NULL, NULL);
}
