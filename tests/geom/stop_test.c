// Operations end when the flag of their thread is set, with CAG_E_CALLBACK and "interrupted", and
// without leaks.

#include "base/stop.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "geom/curve/curve.h"
#include "geom/curve/intersect.h"

static volatile int flag;

static void lend(void) {
  flag = 0;
  cag_stop_lend(&flag);
}

static int take_back(void **state) {
  (void)state;
  cag_stop_lend(NULL);
  return 0;
}

static void assert_stopped(CagStatus status, const CagError *err) {
  assert_int_equal(status, CAG_E_CALLBACK);
  assert_string_equal(cag_error_info(err->id)->reason, "interrupted");
}

static CagCurve *wave(double phase) {
  CagVec3 p[40];
  CagError err;
  CagCurve *c;
  for (int i = 0; i < 40; i++) p[i] = cag_vec3(i, 10 * sin(i + phase), 0);
  assert_int_equal(cag_curve_bezier(p, NULL, 40, 2, &c, &err), CAG_OK);
  return c;
}

static void a_thread_without_a_flag_is_not_stopped(void **state) {
  (void)state;
  CagError err;
  cag_stop_lend(NULL);
  assert_false(cag_stopped());
  assert_int_equal(cag_stop_check(&err), CAG_OK);
}

static void flags_are_lent_and_taken_back(void **state) {
  (void)state;
  volatile int other = 1;
  lend();
  assert_false(cag_stopped());
  const volatile int *before = cag_stop_lend(&other);
  assert_ptr_equal(before, &flag);
  assert_true(cag_stopped());
  assert_ptr_equal(cag_stop_lend(before), &other);
  assert_false(cag_stopped());
}

static void questions_about_curves_end(void **state) {
  (void)state;
  CagError err;
  double length, t, *parameters;
  size_t n;
  CagVec3 at;
  CagMeeting *meetings;
  CagCurve *a = wave(0), *b = wave(1);
  lend();
  assert_int_equal(cag_curve_length(a, a->start, a->end, &length, &err), CAG_OK);
  flag = 1;
  assert_stopped(cag_curve_length(a, a->start, a->end, &length, &err), &err);
  assert_stopped(cag_curve_closest(a, cag_vec3(3, 40, 0), &t, &at, NULL, &err), &err);
  assert_stopped(cag_curve_discretize(a, 1e-3, 1, &parameters, &n, &err), &err);
  assert_stopped(cag_curve_intersect(a, b, &meetings, &n, &err), &err);
  flag = 0;
  assert_int_equal(cag_curve_closest(a, cag_vec3(3, 40, 0), &t, &at, NULL, &err), CAG_OK);
  cag_curve_release(a);
  cag_curve_release(b);
}

static void curves_of_high_degree_end_while_they_are_made(void **state) {
  (void)state;
  enum { N = 1100, DEGREE = 999 };
  CagError err;
  CagCurve *c;
  CagVec3 *p = calloc(N, sizeof *p);
  for (int i = 0; i < N; i++) p[i] = cag_vec3(i, i % 7, 0);
  double *knots = calloc(N + DEGREE + 1, sizeof *knots);
  for (int i = 0; i <= N + DEGREE; i++) knots[i] = i;
  lend();
  flag = 1;
  assert_stopped(cag_curve_nurbs(p, NULL, N, DEGREE, knots, 2, &c, &err), &err);
  free(p);
  free(knots);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_teardown(a_thread_without_a_flag_is_not_stopped, take_back),
      cmocka_unit_test_teardown(flags_are_lent_and_taken_back, take_back),
      cmocka_unit_test_teardown(questions_about_curves_end, take_back),
      cmocka_unit_test_teardown(curves_of_high_degree_end_while_they_are_made, take_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
