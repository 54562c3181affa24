// Numbers in mesh files compared with those of the C library, and self-intersecting polygons
// compared with a test of all pairs of edges.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "interp/formats/tangle.h"
#include "interp/formats/text_scan.h"
#include "tests/geom/random.h"

static size_t below(size_t n) { return (size_t)uniform(0, (double)n - 1e-9); }

static char *put_digits(char *at, size_t n) {
  for (size_t i = 0; i < n; i++) *at++ = (char)('0' + (below(4) ? below(10) : 0));
  return at;
}

// A decimal number of any length and size, in all notations.
static void random_number(char *at) {
  static const char *const signs[] = {"", "-", "+"};
  at = stpcpy(at, signs[below(3)]);
  const size_t whole = below(3) ? below(9) : below(30), part = below(3) ? below(9) : below(30);
  at = put_digits(at, whole);
  if (part > 0 || whole == 0) {
    *at++ = '.';
    at = put_digits(at, part + (whole + part == 0));
  } else if (below(2)) *at++ = '.';
  if (below(3) == 0) {
    *at++ = below(2) ? 'e' : 'E';
    at = stpcpy(at, signs[below(3)]);
    at += sprintf(at, "%d", (int)below(below(4) ? 30 : 420));
  }
  *at = 0;
}

static void numbers_are_those_of_the_library(void **state) {
  (void)state;
  seed = 41;
  for (int i = 0; i < 60000; i++) {
    char text[200] = "  ", *end;
    random_number(text + below(3));
    if (text[0] == 0) continue;
    const size_t n = strlen(text);
    memcpy(text + n, " 7", 3);
    CagTextScan s = {text, text + n};
    double x = -1;
    const double expected = strtod(text, &end);
    if (!cag_scan_number(&s, &x)) fail_msg("expected a number, found `%s`", text);
    if (memcmp(&x, &expected, sizeof x) != 0 && !(x == 0 && expected == 0))
      fail_msg("`%s` is %.17g, not %.17g", text, x, expected);
    assert_ptr_equal(s.at, end);
  }
}

// Integers and powers of ten that are exact doubles, up to 2^53 and 10^22, and slightly larger
// ones.
static void numbers_are_rounded_once(void **state) {
  (void)state;
  static const char *const texts[] = {"9007199254740991",
                                      "9007199254740992",
                                      "9007199254740993",
                                      "9007199254740995",
                                      "9007199254740993e-1",
                                      "9007199254740992e22",
                                      "9007199254740992e23",
                                      "1e22",
                                      "1e23",
                                      "3e-22",
                                      "3e-23",
                                      "0.1",
                                      "1e-22",
                                      "8.5e-23",
                                      "123456789012345678901",
                                      "12345678901234567890123e-5",
                                      "0.00000000000000000000000001234567890123456789",
                                      "1e400",
                                      "1e-400",
                                      "-0.0",
                                      "1e99999999999",
                                      "1e-99999999999",
                                      "0e99999999999",
                                      "00000000000000000000000000000000000012.5",
                                      "12.50000000000000000000000000000000000000000"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    CagTextScan s = {texts[i], texts[i] + strlen(texts[i])};
    double x;
    assert_true(cag_scan_number(&s, &x));
    if (x != strtod(texts[i], NULL)) fail_msg("%s is %.17g", texts[i], x);
  }
}

static void what_is_no_number_is_left(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool number;
    size_t read;
  } cases[] = {{"", false, 0},   {"-", false, 0},   {".", false, 0},    {"+.", false, 0},
               {"e5", false, 0}, {"nan", false, 0}, {"x", false, 0},    {"1e", true, 1},
               {"1e+", true, 1}, {"1E-x", true, 1}, {"1.5.2", true, 3}, {"-.5", true, 3},
               {"5.", true, 2},  {"1 2", true, 1},  {"0x10", true, 1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagTextScan s = {cases[i].text, cases[i].text + strlen(cases[i].text)};
    double x;
    if (cag_scan_number(&s, &x) != cases[i].number ||
        (size_t)(s.at - cases[i].text) != cases[i].read)
      fail_msg("`%s`: %zu characters", cases[i].text, (size_t)(s.at - cases[i].text));
  }
}

static void integers_have_up_to_18_digits(void **state) {
  (void)state;
  static const struct {
    const char *text;
    bool number;
    int64_t value;
  } cases[] = {{"0", true, 0},
               {"-7/", true, -7},
               {"+12 ", true, 12},
               {"  42", true, 42},
               {"999999999999999999", true, 999999999999999999},
               {"-123456789012345678", true, -123456789012345678},
               {"1000000000000000000", false, 0},
               {"", false, 0},
               {"-", false, 0},
               {"x1", false, 0},
               {"\n1", false, 0}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagTextScan s = {cases[i].text, cases[i].text + strlen(cases[i].text)};
    int64_t x = -1;
    assert_true(cag_scan_integer(&s, &x) == cases[i].number);
    if (cases[i].number) assert_true(x == cases[i].value);
  }
}

// Lines end with LF, CR LF, or CR.
static void lines_and_words_are_found(void **state) {
  (void)state;
  static const char text[] = " v 1\r\n\r\n\tfoo bar\rx\n\n  y";
  CagTextScan s = {text, text + strlen(text)};
  static const char *const lines[] = {"v 1", "", "foo bar", "x", "", "y"};
  for (size_t i = 0; i < 6; i++) {
    char found[40] = "";
    const char *word;
    for (size_t n; (n = cag_scan_word(&s, &word)) > 0;) {
      if (*found) strcat(found, " ");
      strncat(found, word, n);
    }
    if (strcmp(found, lines[i]) != 0) fail_msg("line %zu: `%s`", i, found);
    assert_true(cag_scan_at_line_end(&s));
    cag_scan_next_line(&s);
  }
  assert_ptr_equal(s.at, s.end);
  cag_scan_next_line(&s);
  assert_ptr_equal(s.at, s.end);
  s.at = text;
  size_t words = 0;
  const char *word;
  for (; cag_scan_to_word(&s); words++) assert_true(cag_scan_word(&s, &word) > 0);
  assert_int_equal(words, 6);
  assert_true(cag_scan_is("Facet", 5, "facet") && cag_scan_is("FACET", 5, "facet"));
  assert_false(cag_scan_is("face", 4, "facet") || cag_scan_is("facets", 6, "facet") ||
               cag_scan_is("faced", 5, "facet"));
}

// --- Polygons ---

static double turn_of(const CagVec3 *p, const CagVec3 *q, const CagVec3 *r, int x, int y) {
  const double *a = &p->x, *b = &q->x, *c = &r->x;
  return (b[x] - a[x]) * (c[y] - a[y]) - (b[y] - a[y]) * (c[x] - a[x]);
}

static int sign(double x) { return (x > 0) - (x < 0); }

// Compares all pairs of edges: crossings inside both, and touches except between neighbors.
static bool crosses(const CagVec3 *p, size_t n, int x, int y, size_t *touches) {
  *touches = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t k = i + 2; k < n - (i == 0); k++) {
      const CagVec3 *a = &p[i], *b = &p[(i + 1) % n], *c = &p[k], *d = &p[(k + 1) % n];
      const int s = sign(turn_of(a, b, c, x, y)), t = sign(turn_of(a, b, d, x, y));
      const int u = sign(turn_of(c, d, a, x, y)), v = sign(turn_of(c, d, b, x, y));
      if (s * t < 0 && u * v < 0) return true;
      *touches += s * t <= 0 && u * v <= 0;
    }
  return false;
}

// Stars of 129 to 220 corners with integer coordinates, in each of the three planes, unchanged and
// with one corner moved.
static void polygons_that_cross_themselves_are_found(void **state) {
  (void)state;
  seed = 42;
  int crossed = 0;
  const int rounds = 300;
  for (int round = 0; round < rounds; round++) {
    const size_t n = 129 + below(90);
    const int along = round % 3, x = (along + 1) % 3, y = (along + 2) % 3;
    CagVec3 p[220];
    uint32_t corners[220];
    for (size_t i = 0; i < n; i++) {
      const double a = 2 * M_PI * (double)i / (double)n, r = uniform(40000, 100000);
      p[i] = cag_vec3(0, 0, 0);
      (&p[i].x)[x] = floor(r * cos(a));
      (&p[i].x)[y] = floor((round % 2 ? -r : r) * sin(a));
      (&p[i].x)[along] = floor(uniform(-5, 5));
      corners[i] = (uint32_t)i;
    }
    if (round % 4) {
      const size_t i = below(n);
      (&p[i].x)[x] += floor(uniform(-20000, 20000));
      (&p[i].x)[y] += floor(uniform(-20000, 20000));
    }
    size_t touches;
    const bool expected = crosses(p, n, x, y, &touches);
    crossed += expected;
    if ((cag_tangle_of(p, corners, n) == CAG_TANGLE_CROSSED) != expected)
      fail_msg("round %d: %s", round, expected ? "a crossing is missed" : "there is none");
  }
  assert_true(crossed > 50 && crossed < 250);
}

// A polygon that runs back and forth along one line touches itself everywhere and is rejected, but
// a few bridges along the same line are accepted.
static void polygons_may_touch_themselves_a_little(void **state) {
  (void)state;
  enum { N = 160 };
  CagVec3 p[N];
  uint32_t corners[N];
  for (size_t i = 0; i < N; i++) {
    corners[i] = (uint32_t)i;
    p[i] = cag_vec3(i % 2 ? 10 : 0, 0, 0);
  }
  p[N - 1] = cag_vec3(5, 5, 0);
  assert_int_equal(cag_tangle_of(p, corners, N), CAG_TANGLE_CROSSED);
  // A circle whose last corners run to the center and back along the same line.
  for (size_t i = 0; i < N; i++) {
    const double a = 2 * M_PI * (double)i / (N - 4);
    p[i] = cag_vec3(1000 * cos(a), 1000 * sin(a), 0);
  }
  p[N - 4] = p[0];
  p[N - 3] = cag_vec3(500, 0, 0);
  p[N - 2] = cag_vec3(450, 50, 0);
  p[N - 1] = cag_vec3(500, 0, 0);
  assert_int_equal(cag_tangle_of(p, corners, N), CAG_TANGLE_NONE);
  // Polygons with few corners are not checked.
  for (size_t i = 0; i < 128; i++) p[i] = cag_vec3(i % 2 ? 10 : 0, 0, 0);
  assert_int_equal(cag_tangle_of(p, corners, 128), CAG_TANGLE_NONE);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(numbers_are_those_of_the_library),
      cmocka_unit_test(numbers_are_rounded_once),
      cmocka_unit_test(what_is_no_number_is_left),
      cmocka_unit_test(integers_have_up_to_18_digits),
      cmocka_unit_test(lines_and_words_are_found),
      cmocka_unit_test(polygons_that_cross_themselves_are_found),
      cmocka_unit_test(polygons_may_touch_themselves_a_little),
  };
  return cmocka_run_group_tests_name("text_scan", tests, NULL, NULL);
}
