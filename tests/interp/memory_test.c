// The C interface reports exhausted memory as a status, both when a session starts and during a
// run.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "cag.h"

static CagSession *session_of(size_t max_memory) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.max_memory = max_memory;
  options.out = options.messages = stderr;
  CagSession *s = cag_session_new(&options);
  assert_non_null(s);
  return s;
}

static int run(CagSession *s, const char *text) {
  return cag_session_run_text(s, "test", text, strlen(text));
}

static void assert_memory_error(const CagSession *s) {
  CagErrorView e;
  assert_int_equal(cag_session_error_count(s), 1);
  cag_session_error(s, 0, &e);
  assert_string_equal(e.reason, "memory-limit");
}

static void every_call_reports_too_little_memory_for_the_built_ins(void **state) {
  (void)state;
  for (size_t limit = 0; limit <= 10240; limit += 1024) {
    CagSession *s = session_of(limit);
    CagShownCounts counts;
    char *text;
    size_t length;
    assert_int_equal(run(s, "x = 1"), CAG_STATUS_LIMIT);
    assert_memory_error(s);
    assert_int_equal(cag_session_check_text(s, "test", "x = 1", 5), CAG_STATUS_LIMIT);
    assert_memory_error(s);
    assert_int_equal(cag_session_format(s, "test", "x = 1", 5, &text, &length), CAG_STATUS_LIMIT);
    assert_null(text);
    assert_int_equal(cag_session_input(s, "x = 1", 5, NULL, NULL), CAG_STATUS_LIMIT);
    assert_int_equal(cag_session_scene(s, &counts), CAG_STATUS_LIMIT);
    assert_int_equal(cag_session_export(s, "none.stl", NULL), CAG_STATUS_LIMIT);
    assert_null(cag_session_name(s, 0, NULL, NULL));
    cag_session_free(s);
  }
}

// A list of n small lists takes more than 16 n bytes.
static void a_session_goes_on_after_a_run_that_needed_too_much(void **state) {
  (void)state;
  CagSession *s = session_of((size_t)8 << 20);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(run(s, "print len([for i in 0..<1e7: [i, i]])"), CAG_STATUS_LIMIT);
    assert_memory_error(s);
    assert_int_equal(run(s, "assert 1 + 1 == 2"), CAG_STATUS_OK);
    assert_int_equal(cag_session_error_count(s), 0);
  }
  cag_session_free(s);
}

static void
an_interactive_session_keeps_its_names_after_an_input_that_needed_too_much(void **state) {
  (void)state;
  CagSession *s = session_of((size_t)8 << 20);
  assert_int_equal(cag_session_input(s, "n = 7", 5, NULL, NULL), CAG_STATUS_OK);
  const char *too_much = "len([for i in 0..<1e7: [i, i]])";
  assert_int_equal(cag_session_input(s, too_much, strlen(too_much), NULL, NULL), CAG_STATUS_LIMIT);
  assert_memory_error(s);
  const char *again = "assert n + 1 == 8";
  assert_int_equal(cag_session_input(s, again, strlen(again), NULL, NULL), CAG_STATUS_OK);
  assert_string_equal(cag_session_name(s, 0, NULL, NULL), "n");
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_call_reports_too_little_memory_for_the_built_ins),
      cmocka_unit_test(a_session_goes_on_after_a_run_that_needed_too_much),
      cmocka_unit_test(an_interactive_session_keeps_its_names_after_an_input_that_needed_too_much),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
