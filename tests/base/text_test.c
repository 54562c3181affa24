// UTF-8 characters, and JSON texts.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/json_text.h"
#include "base/utf8.h"

// One, two, three, and four bytes.
static const char mixed[] = "a\xC3\xA9\xE2\x82\xAC\xF0\x9F\x94\xA7";

static void characters_are_counted_by_their_first_bytes(void **state) {
  (void)state;
  assert_int_equal(cag_utf8_count(mixed, strlen(mixed)), 4);
  assert_int_equal(cag_utf8_count(mixed, 0), 0);
  assert_int_equal(cag_utf8_count(mixed, 2), 2); // the second is truncated
}

static void steps_lead_from_character_to_character(void **state) {
  (void)state;
  const size_t starts[] = {0, 1, 3, 6, 10}, n = strlen(mixed);
  for (size_t k = 0; k < 4; k++) {
    assert_int_equal(cag_utf8_next(mixed, n, starts[k]), starts[k + 1]);
    for (size_t i = starts[k]; i < starts[k + 1]; i++)
      assert_int_equal(cag_utf8_start(mixed, i), starts[k]);
  }
  assert_int_equal(cag_utf8_start(mixed, n), n);
}

static void json_escapes_what_it_must(void **state) {
  (void)state;
  char buffer[8];
  assert_string_equal(cag_json_escape('"', buffer), "\\\"");
  assert_string_equal(cag_json_escape('\\', buffer), "\\\\");
  assert_string_equal(cag_json_escape('\n', buffer), "\\n");
  assert_string_equal(cag_json_escape('\x01', buffer), "\\u0001");
  assert_null(cag_json_escape('a', buffer));
  assert_null(cag_json_escape('/', buffer));
  assert_null(cag_json_escape('\x7f', buffer));
  assert_null(cag_json_escape('\xC3', buffer));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(characters_are_counted_by_their_first_bytes),
                                     cmocka_unit_test(steps_lead_from_character_to_character),
                                     cmocka_unit_test(json_escapes_what_it_must)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
