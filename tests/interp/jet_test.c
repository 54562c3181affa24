// Jets in one and two variables compared with closed forms, and functions that geometry calls after
// the script has ended.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "cag.h"
#include "interp/vm/jet.h"

#define NEAR(a, b, tolerance)                                                                      \
  do {                                                                                             \
    double near_a = (a), near_b = (b);                                                             \
    if (!(fabs(near_a - near_b) <= (tolerance)))                                                   \
      fail_msg("%s = %.17g is not %.17g", #a, near_a, near_b);                                     \
  } while (0)

static CagSeries variable(int variables, int order, int which, double x) {
  CagSeries like = {.variables = variables, .order = order}, s;
  cag_series_constant(&like, x, &s);
  s.c[1 + which] = 1;
  return s;
}

static double factorial(int n) { return n < 2 ? 1 : n * factorial(n - 1); }

// The partial derivative of order i by x and j by y.
static double partial(const CagSeries *s, int i, int j) {
  return s->c[cag_jet_offset(2, i + j) + (size_t)j] * factorial(i) * factorial(j);
}

// exp(2 x) sin(3 y) has the partial derivatives 2^i 3^j exp(2 x) sin(3 y + j pi / 2).
static void partials_of_a_product_of_two_variables(void **state) {
  (void)state;
  const double x0 = 0.3, y0 = -0.7;
  CagSeries x = variable(2, 8, 0, x0), y = variable(2, 8, 1, y0), e, s, c, out;
  cag_series_scale(&x, 2, &x);
  cag_series_scale(&y, 3, &y);
  cag_series_exp(&x, &e);
  cag_series_sin_cos(&y, false, sin(3 * y0), cos(3 * y0), &s, &c);
  cag_series_multiply(&e, &s, &out);
  for (int i = 0; i <= 8; i++)
    for (int j = 0; i + j <= 8; j++) {
      double expected = pow(2, i) * pow(3, j) * exp(2 * x0) * sin(3 * y0 + j * M_PI / 2);
      NEAR(partial(&out, i, j), expected, 1e-14 * pow(3, i + j) * exp(2 * x0) * 3);
    }
}

// 1 / (x + y)^2 has the partial derivatives (-1)^n (n + 1)! (x + y)^-(n + 2), n = i + j. It is
// computed in three ways.
static void quotients_and_powers_agree(void **state) {
  (void)state;
  CagSeries x = variable(2, 6, 0, 0.4), y = variable(2, 6, 1, 0.9), sum, one, q[3];
  cag_series_add(&x, 1, &y, &sum);
  cag_series_constant(&x, 1, &one);
  cag_series_divide(&one, &sum, &q[0]);
  cag_series_divide(&q[0], &sum, &q[0]);
  assert_true(cag_series_power(&sum, -2, &q[1]));
  cag_series_ln(&sum, &q[2]);
  cag_series_scale(&q[2], -2, &q[2]);
  cag_series_exp(&q[2], &q[2]);
  for (int i = 0; i <= 6; i++)
    for (int j = 0; i + j <= 6; j++) {
      const int n = i + j;
      double expected = (n % 2 ? -1 : 1) * factorial(n + 1) * pow(1.3, -(n + 2));
      for (int k = 0; k < 3; k++) NEAR(partial(&q[k], i, j), expected, 1e-12 * fabs(expected));
    }
}

// Integer powers are differentiable at 0, and others only up to their order.
static void powers_at_zero(void **state) {
  (void)state;
  CagSeries x = variable(1, 4, 0, 0), out;
  assert_true(cag_series_power(&x, 3, &out));
  for (int k = 0; k <= 4; k++) NEAR(out.c[k], k == 3, 0);
  assert_true(cag_series_power(&x, 1e9, &out) && cag_series_is_constant(&out));
  assert_true(cag_series_power(&x, 4.5, &out) && cag_series_is_constant(&out));
  assert_false(cag_series_power(&x, 3.5, &out));
  assert_false(cag_series_power(&x, -1, &out));
  x = variable(1, 16, 0, -2); // a negative base with an integer exponent
  assert_true(cag_series_power(&x, 5, &out));
  NEAR(out.c[0], -32, 0);
  NEAR(out.c[1], 80, 0);
  NEAR(out.c[5], 1, 1e-15);
  NEAR(out.c[6], 0, 1e-15);
}

// x^2 y composed with x = s^2, y = s t: s^5 t.
static void composition_is_the_chain_rule(void **state) {
  (void)state;
  CagSeries s = variable(2, 4, 0, 1.5), t = variable(2, 4, 1, 2), x, y, out, expected;
  cag_series_multiply(&s, &s, &x);
  cag_series_multiply(&s, &t, &y);
  const double x0 = 2.25, y0 = 3;
  double d[25] = {0}; // partial derivatives of x^2 y at (x0, y0)
  d[cag_partial(4, 0, 0)] = x0 * x0 * y0;
  d[cag_partial(4, 1, 0)] = 2 * x0 * y0;
  d[cag_partial(4, 2, 0)] = 2 * y0;
  d[cag_partial(4, 0, 1)] = x0 * x0;
  d[cag_partial(4, 1, 1)] = 2 * x0;
  d[cag_partial(4, 2, 1)] = 2;
  cag_series_compose_2(&x, &y, d, 1, &out);
  assert_true(cag_series_power(&s, 5, &expected));
  cag_series_multiply(&expected, &t, &expected);
  for (size_t k = 0; k < cag_jet_count(2, 4); k++)
    NEAR(out.c[k], expected.c[k], 1e-14 * fabs(expected.c[k]));
}

// --- Exports ---

static CagSession *run_text(const char *text) {
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.out = options.messages = fopen("/dev/null", "w");
  options.max_memory = (size_t)64 << 20;
  CagSession *s = cag_session_new(&options);
  assert_int_equal(cag_session_run_text(s, "formula.cag", text, strlen(text)), CAG_STATUS_OK);
  return s;
}

static int export_to(CagSession *s, const char *name, char *path) {
  snprintf(path, 128, "/tmp/cag-jet-%d-%s", (int)getpid(), name);
  return cag_session_export(s, path, NULL);
}

static void a_formula_is_evaluated_when_the_script_has_ended(void **state) {
  (void)state;
  char path[128];
  CagSession *s = run_text("show surface((u, v) => [u, v, u * v * v], u: 0..2)");
  assert_int_equal(export_to(s, "good.stl", path), CAG_STATUS_OK);
  assert_int_equal(access(path, R_OK), 0);
  unlink(path);
  cag_session_free(s);
}

static void an_export_that_meets_an_error_leaves_no_file(void **state) {
  (void)state;
  static const struct {
    const char *text, *reason;
    int status;
  } scripts[] = {
      {"show surface((u, v) => [u, v, if u > 0.26 and u < 0.49 and v > 0.26 and v < 0.49 "
       "then sqrt(-u) else u * v^2])",
       "not-finite", CAG_STATUS_SCRIPT},
      {"show surface((u, v) => [u, v, abs(v - 0.5)])", "not-differentiable", CAG_STATUS_SCRIPT},
      {"show surface((u, v) => [u, v, if u > 0.26 and u < 0.49 and v > 0.26 and v < 0.49 "
       "then len([for i in 0..1e7: [{a: i}]]) else u * v^2])",
       "memory-limit", CAG_STATUS_LIMIT},
      {"f(n) = 1 + f(n + 1)\nshow surface((u, v) => [u, v, if u > 0.26 and u < 0.49 and v > 0.26 "
       "and v < 0.49 then f(0) else u * v^2])",
       "depth-limit", CAG_STATUS_LIMIT},
  };
  for (size_t i = 0; i < sizeof scripts / sizeof *scripts; i++) {
    char path[128];
    CagErrorView error;
    CagSession *s = run_text(scripts[i].text);
    assert_int_equal(export_to(s, "bad.stl", path), scripts[i].status);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(cag_session_error_count(s), 1);
    cag_session_error(s, 0, &error);
    assert_string_equal(error.reason, scripts[i].reason);
    assert_true(error.line > 0); // a location in the function
    cag_session_free(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(partials_of_a_product_of_two_variables),
      cmocka_unit_test(quotients_and_powers_agree),
      cmocka_unit_test(powers_at_zero),
      cmocka_unit_test(composition_is_the_chain_rule),
      cmocka_unit_test(a_formula_is_evaluated_when_the_script_has_ended),
      cmocka_unit_test(an_export_that_meets_an_error_leaves_no_file),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
