// Errors as values, and the text and numbers of messages.

#include "base/status.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void an_error_may_lack_an_argument(void **state) {
  (void)state;
  CagError err;
  memset(&err, 0xff, sizeof err);
  assert_int_equal(cag_fail(&err, CAG_E_ARGUMENT, CAG_ERR_value, NULL, 3, "%d and %s", 2, "more"),
                   CAG_E_ARGUMENT);
  assert_string_equal(err.argument, "");
  assert_string_equal(err.message, "2 and more");
  assert_int_equal(err.index, 3);
  assert_false(cag_is_empty_shape(&err));
  cag_fail(&err, CAG_E_DEGENERATE, CAG_ERR_empty_range, "shape", -1, "nothing");
  assert_false(cag_is_empty_shape(&err));
  cag_fail(&err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "shape", -1, "nothing");
  assert_true(cag_is_empty_shape(&err));
  assert_string_equal(err.argument, "shape");
}

// Long texts are truncated at the end of their fields.
static void long_texts_are_cut(void **state) {
  (void)state;
  char text[2000];
  memset(text, 'x', sizeof text - 1);
  text[sizeof text - 1] = 0;
  CagError err;
  cag_fail(&err, CAG_E_ARGUMENT, CAG_ERR_value, text, -1, "%s", text);
  assert_int_equal(strlen(err.argument), sizeof err.argument - 1);
  assert_int_equal(strlen(err.message), sizeof err.message - 1);
}

static void exhausted_memory_is_noted_once(void **state) {
  (void)state;
  CagError err;
  cag_memory_was_out();
  assert_false(cag_memory_was_out());
  assert_int_equal(cag_fail_memory(&err), CAG_E_MEMORY);
  assert_string_equal(cag_error_info(err.id)->reason, "memory-limit");
  assert_true(cag_memory_was_out());
  assert_false(cag_memory_was_out());
}

// Decimal fractions of 15 digits are shown as they were written. Their neighboring doubles need 16
// or 17.
static void numbers_read_back_the_same(void **state) {
  (void)state;
  static const struct {
    double x;
    const char *text;
  } cases[] = {{0.1, "0.1"},
               {0, "0"},
               {-2.5, "-2.5"},
               {1e300, "1e+300"},
               {123456789012345, "123456789012345"},
               {1.0 / 3, "0.3333333333333333"},
               {0.1 + 0.2, "0.30000000000000004"},
               {9007199254740993.0, "9007199254740992"},
               {INFINITY, "inf"},
               {-INFINITY, "-inf"},
               {NAN, "nan"}};
  char buffer[32];
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_string_equal(cag_number_text(cases[i].x, buffer), cases[i].text);
  // A step of one unit in the last place changes the text.
  double x = 1e-3;
  char former[32] = "";
  for (int i = 0; i < 2000; i++, x = nextafter(x, 1)) {
    assert_true(strtod(cag_number_text(x, buffer), NULL) == x);
    assert_string_not_equal(buffer, former);
    strcpy(former, buffer);
  }
}

static void articles_suit_their_words(void **state) {
  (void)state;
  static const struct {
    const char *word, *article;
  } cases[] = {{"circle", "a"}, {"arc", "an"},      {"ellipse", "an"}, {"unit vector", "a"},
               {"Arc", "an"},   {"umbrella", "an"}, {"", "a"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_string_equal(cag_article(cases[i].word), cases[i].article);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_error_may_lack_an_argument),
      cmocka_unit_test(long_texts_are_cut),
      cmocka_unit_test(exhausted_memory_is_noted_once),
      cmocka_unit_test(numbers_read_back_the_same),
      cmocka_unit_test(articles_suit_their_words),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
