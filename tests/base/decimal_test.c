// Numbers as decimal text: the same text as that of printf.

#include "base/decimal.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static uint64_t seed = 1;

// The generator of Knuth's MMIX.
static uint64_t next_random(void) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return seed >> 11;
}

static double random_unit(void) { return (double)next_random() / (double)((uint64_t)1 << 53); }

// The shortest text by trying the digits of printf one after another.
static void tried_text(double x, char *out) {
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(out, 40, "%.*g", digits, x);
    if (strtod(out, NULL) == x) return;
  }
}

static void check_shortest(double x) {
  char expected[40], found[CAG_DECIMAL_ROOM + 1];
  char *end = cag_decimal_shortest(found, x);
  if (!end) return;
  *end = 0;
  tried_text(x, expected);
  assert_string_equal(found, expected);
}

static void whole_numbers_are_written(void **state) {
  (void)state;
  const uint64_t cases[] = {0, 9, 10, 99, 100, 12345, 1000000, UINT64_MAX};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char expected[24], found[24];
    snprintf(expected, sizeof expected, "%llu", (unsigned long long)cases[i]);
    *cag_decimal_index(found, cases[i]) = 0;
    assert_string_equal(found, expected);
  }
}

static void the_shortest_text_is_that_of_printf(void **state) {
  (void)state;
  for (int i = 0; i < 100000; i++) {
    const double x = (random_unit() - 0.5) * pow(10, (double)(next_random() % 20) - 4);
    check_shortest(x);
    check_shortest((float)x);                     // 16 or 17 digits
    check_shortest(round(x * 1e3) / 1e3);         // a few decimals
    check_shortest(round(x));                     // a whole number
    check_shortest(ldexp(1, (int)(i % 60) - 14)); // the gaps to the neighbors differ
  }
}

static void neighbors_of_powers_of_ten_and_two_are_exact(void **state) {
  (void)state;
  for (int k = -6; k <= 16; k++)
    for (int n = -20; n <= 20; n++) {
      double x = pow(10, k), y = ldexp(1, 3 * k);
      for (int i = 0; i < abs(n); i++) {
        x = nextafter(x, n < 0 ? 0 : INFINITY);
        y = nextafter(y, n < 0 ? 0 : INFINITY);
      }
      check_shortest(x);
      check_shortest(-y);
    }
}

// Only few numbers of ordinary size are left to printf.
static void ordinary_numbers_are_written(void **state) {
  (void)state;
  char text[CAG_DECIMAL_ROOM];
  size_t left = 0;
  for (int i = 0; i < 10000; i++) left += !cag_decimal_shortest(text, (random_unit() - 0.5) * 1000);
  assert_in_range(left, 0, 10);
  assert_non_null(cag_decimal_shortest(text, 0));
  assert_non_null(cag_decimal_shortest(text, 1));
  assert_non_null(cag_decimal_shortest(text, -0.25));
}

static void others_are_left_to_printf(void **state) {
  (void)state;
  const double cases[] = {-0.0, 1e-5, 1e15, -1e300, NAN, INFINITY, -INFINITY};
  char text[CAG_DECIMAL_ROOM];
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_null(cag_decimal_shortest(text, cases[i]));
}

// The text of printf with 13 decimals, without trailing zeros, and without the sign of a zero.
static void check_fixed(double x) {
  char expected[40], found[40];
  snprintf(expected, sizeof expected, "%.13f", x);
  size_t n = strlen(expected);
  while (expected[n - 1] == '0') expected[--n] = 0;
  *cag_decimal_fixed(found, x) = 0;
  assert_string_equal(found, strcmp(expected, "-0.") == 0 ? "0." : expected);
}

static void decimals_are_those_of_printf(void **state) {
  (void)state;
  const double cases[] = {
      0,      -0.0,      1,   -1,       0.5,    -1e-13,  4.9e-14, 5e-14,   -5e-14,          1e-20,
      5e-324, -2.2e-308, 0.1, 999.9999, -0.001, 1.0 / 3, 0x1p-14, 0x3p-14, 0.99999999999999};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) check_fixed(cases[i]);
  for (int i = 0; i < 100000; i++) {
    check_fixed(2 * random_unit() - 1);
    check_fixed((random_unit() - 0.5) * pow(10, -(double)(next_random() % 20)));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(whole_numbers_are_written),
      cmocka_unit_test(the_shortest_text_is_that_of_printf),
      cmocka_unit_test(neighbors_of_powers_of_ten_and_two_are_exact),
      cmocka_unit_test(ordinary_numbers_are_written),
      cmocka_unit_test(others_are_left_to_printf),
      cmocka_unit_test(decimals_are_those_of_printf),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
