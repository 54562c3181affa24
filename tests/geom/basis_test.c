// Bernstein polynomials, B-spline bases, knot vectors and quadrature.

#include "geom/basis/basis_table.h"
#include "geom/basis/bspline.h"
#include "geom/basis/knots.h"
#include "geom/basis/quadrature.h"
#include "support.h"

// Vector bezier-curve.partition-of-unity, n = 6 at t = 0.1.
static void bernstein_polynomials_are_those_of_the_reference(void **state) {
  (void)state;
  static const double expected[7] = {0.531441, 0.354294, 0.098415, 0.01458,
                                     0.001215, 5.4e-05,  1e-06};
  double b[61], sum = 0;
  cag_bernstein(6, 0.1, b);
  for (int i = 0; i < 7; i++) NEAR(b[i], expected[i], 1e-15);
  cag_bernstein(60, 0.37, b);
  for (int i = 0; i <= 60; i++) {
    NEAR(b[i], cag_binomial(60, i) * pow(0.37, i) * pow(0.63, 60 - i), 1e-15);
    sum += b[i];
  }
  NEAR(sum, 1, 1e-14);
  assert_true(cag_binomial(10, 3) == 120 && cag_binomial(5, 6) == 0 &&
              cag_binomial(40, 20) == 137846528820.0);
}

// Vector bezier-curve.elevate-3: (1,1) (2,3) (4,3) (3,1) from degree 3 to 6.
static void elevation_gives_the_points_of_the_reference(void **state) {
  (void)state;
  static const double expected[7][2] = {{1, 1},     {1.5, 2},   {2.2, 2.6}, {2.9, 2.8},
                                        {3.4, 2.6}, {3.5, 2.0}, {3, 1}};
  double b[2][4 * 7] = {{1, 1, 0, 1, 2, 3, 0, 1, 4, 3, 0, 1, 3, 1, 0, 1}};
  int from = 0;
  for (int p = 3; p < 6; p++, from = !from) cag_bezier_elevate(b[from], p, b[!from]);
  for (int i = 0; i < 7; i++) {
    NEAR(b[from][4 * i], expected[i][0], 1e-15);
    NEAR(b[from][4 * i + 1], expected[i][1], 1e-15);
    NEAR(b[from][4 * i + 3], 1, 0);
  }
}

// Vector bezier-curve.split-0.3.
static void segments_are_the_halves_of_a_split(void **state) {
  (void)state;
  static const double b[16] = {1, 1, 0, 1, 2, 3, 0, 1, 4, 3, 0, 1, 3, 1, 0, 1};
  static const double left[4][2] = {{1, 1}, {1.3, 1.6}, {1.69, 2.02}, {2.062, 2.26}};
  static const double right[4][2] = {{2.062, 2.26}, {2.93, 2.82}, {3.7, 2.4}, {3, 1}};
  double part[16];
  cag_bezier_segment(b, 3, 0, 0.3, part);
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 2; k++) NEAR(part[4 * i + k], left[i][k], 1e-14);
  cag_bezier_segment(b, 3, 0.3, 1, part);
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 2; k++) NEAR(part[4 * i + k], right[i][k], 1e-14);
}

// Example 10 of reference 05b: knots 0 0 0 1 2 2 2 at t = 1/4.
static void basis_functions_are_those_of_the_reference(void **state) {
  (void)state;
  static const double knots[7] = {0, 0, 0, 1, 2, 2, 2};
  double n[3], t = 0.25, d[12];
  size_t span = cag_knots_span(knots, 4, 2, t, false, 0);
  assert_int_equal(span, 2);
  cag_bspline_basis(knots, 2, span, t, n);
  NEAR(n[0], (1 - t) * (1 - t), 1e-16);
  NEAR(n[1], t * (1 - t) + t * (2 - t) / 2, 1e-16);
  NEAR(n[2], t * t / 2, 1e-16);
  cag_bspline_derivatives(knots, 2, span, t, 3, d);
  const double expected[12] = {n[0], n[1], n[2], -2 * (1 - t), 2 - 3 * t, t, 2, -3, 1, 0, 0, 0};
  for (int i = 0; i < 12; i++) NEAR(d[i], expected[i], 1e-15);
}

static void spans_follow_the_end_rule(void **state) {
  (void)state;
  static const double knots[9] = {0, 0, 0, 1, 1, 2, 3, 3, 3};
  assert_int_equal(cag_knots_span(knots, 6, 2, 0, false, 0), 2);
  assert_int_equal(cag_knots_span(knots, 6, 2, 1, false, 0), 4);
  assert_int_equal(cag_knots_span(knots, 6, 2, 1, true, 0), 2);
  assert_int_equal(cag_knots_span(knots, 6, 2, 2, true, 5), 4);
  assert_int_equal(cag_knots_span(knots, 6, 2, 3, false, 0), 5);
  assert_int_equal(cag_knots_span(knots, 6, 2, 2.5, false, 5), 5);
  assert_int_equal(cag_knots_multiplicity(knots, 6, 2, 1), 2);
}

static void near_knots(const double *a, const double *b, int n) {
  for (int i = 0; i < n; i++) NEAR(a[i], b[i], 1e-9);
}

// Vectors bspline.ex14.knots, bspline.eq86.equidistant-k3, -k4.
static void chord_knots_are_those_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 p[5] = {{0, 0, 0}, {2, 6, 0}, {4, 3, 0}, {6, 6, 0}, {8, 6, 0}};
  static const CagVec3 even[6] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  static const double ex14[8] = {0, 0, 0, 1.4533801802006419, 2.381709396855943, 3, 3, 3};
  static const double k3[9] = {0, 0, 0, 1, 2, 3, 4, 4, 4};
  static const double k4[10] = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  double knots[16];
  cag_knots_chord(p, 5, 2, knots);
  near_knots(knots, ex14, 8);
  cag_knots_chord(even, 6, 2, knots);
  near_knots(knots, k3, 9);
  cag_knots_chord(even, 6, 3, knots);
  near_knots(knots, k4, 10);
  // Runs of equal points still give good knots; points that are all equal give open ones.
  static const CagVec3 run[8] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                 {0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
  cag_knots_chord(run, 8, 2, knots);
  OK(cag_knots_check(knots, 8, 2, &err));
  static const CagVec3 same[6] = {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
  cag_knots_chord(same, 6, 2, knots);
  near_knots(knots, k3, 9);
}

// Vectors bspline.knots.open-c, class-1, class-3.
static void knot_vectors_are_classified(void **state) {
  (void)state;
  static const double open[9] = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  static const double doubled[8] = {0, 0, 0, 1, 1, 2, 2, 2};
  static const double uneven[5] = {0, 0.28, 0.5, 0.72, 1};
  double knots[16];
  cag_knots_open(5, 3, knots);
  near_knots(knots, open, 9);
  assert_string_equal(cag_knots_class(knots, 5, 3), "open-uniform");
  assert_string_equal(cag_knots_class(doubled, 5, 2), "open-nonuniform");
  assert_string_equal(cag_knots_class(uneven, 3, 1), "nonuniform");
  for (int i = 0; i < 8; i++) knots[i] = 0.1 * i;
  assert_string_equal(cag_knots_class(knots, 5, 2), "uniform");
}

// Vector bspline.ex19: (0,0) (1,1) (2,1) (3,0) with the knot 1 inserted.
static void insertion_gives_the_points_of_the_reference(void **state) {
  (void)state;
  double h[20] = {0, 0, 0, 1, 1, 1, 0, 1, 2, 1, 0, 1, 3, 0, 0, 1};
  double knots[8] = {0, 0, 0, 1, 2, 2, 2};
  static const double expected[5][2] = {{0, 0}, {1, 1}, {1.5, 1}, {2, 1}, {3, 0}};
  static const double after[8] = {0, 0, 0, 1, 1, 2, 2, 2};
  cag_bspline_insert(h, knots, 4, 2, 1);
  near_knots(knots, after, 8);
  for (int i = 0; i < 5; i++)
    for (int k = 0; k < 2; k++) NEAR(h[4 * i + k], expected[i][k], 1e-15);
}

static CagStatus powers(void *context, double t, double *out, CagError *e) {
  (void)context;
  (void)e;
  out[0] = pow(t, 20);
  out[1] = fabs(t - 0.3);
  out[2] = exp(t);
  return CAG_OK;
}

// int t^20 = (2^21 + 1) / 21, int |t - 0.3| = (1.3^2 + 1.7^2) / 2, int e^t = e^2 - 1/e over -1..2.
static void integrals_are_accurate_through_kinks(void **state) {
  (void)state;
  const double cuts[3] = {-1, 0.5, 2};
  double sum[3];
  OK(cag_integrate(powers, NULL, cuts, 3, 3, 1e-13, sum, &err));
  NEAR(sum[0], (pow(2, 21) + 1) / 21, 1e-9);
  NEAR(sum[2], exp(2) - exp(-1), 1e-10);
  // The tolerance is that of the largest part; asked alone the kink is found.
  OK(cag_integrate(powers, NULL, cuts, 3, 2, 1e-13, sum, &err));
  NEAR(sum[1], (1.3 * 1.3 + 1.7 * 1.7) / 2, 1e-8);
}

static void what_no_refinement_is_is_refused(void **state) {
  (void)state;
  static const double knots[8] = {0, 0, 0, 0, 1, 1, 1, 1};
  static const double falling[10] = {0, 0, 0, 0, 0.5, 0.3, 1, 1, 1, 1};
  static const double repeated[10] = {0, 0, 0, 0, 0, 0.3, 1, 1, 1, 1};
  static const double early[9] = {-1, 0, 0, 0, 0, 1, 1, 1, 1};
  static const double missing[9] = {0, 0, 0, 0, 0.5, 0.7, 1, 1, 1};
  double out[4 * 7 * 8];
  CagError err;
  FAILS_AT(cag_basis_oslo(knots, 8, falling, 10, 3, out, &err), "knots-not-monotone", 5);
  FAILS_AT(cag_basis_oslo(knots, 8, repeated, 10, 3, out, &err), "knot-multiplicity", 4);
  FAILS_AT(cag_basis_oslo(knots, 8, early, 9, 3, out, &err), "parameter-range", 0);
  FAILS_AT(cag_basis_oslo(knots, 8, missing, 9, 3, out, &err), "not-a-refinement", 7);
}

static void degrees_and_knots_are_checked(void **state) {
  (void)state;
  static const double knots[8] = {0, 0, 0, 0, 1, 1, 1, INFINITY};
  CagError err;
  FAILS(cag_degree_check(1, 1, &err), "too-few-points");
  FAILS(cag_degree_check(4, 0, &err), "order-range");
  FAILS(cag_degree_check(4, 4, &err), "order-range");
  FAILS_AT(cag_knots_check(knots, 4, 3, &err), "not-finite", 7);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bernstein_polynomials_are_those_of_the_reference),
      cmocka_unit_test(elevation_gives_the_points_of_the_reference),
      cmocka_unit_test(segments_are_the_halves_of_a_split),
      cmocka_unit_test(basis_functions_are_those_of_the_reference),
      cmocka_unit_test(spans_follow_the_end_rule),
      cmocka_unit_test(chord_knots_are_those_of_the_reference),
      cmocka_unit_test(knot_vectors_are_classified),
      cmocka_unit_test(insertion_gives_the_points_of_the_reference),
      cmocka_unit_test(integrals_are_accurate_through_kinks),
      cmocka_unit_test(what_no_refinement_is_is_refused),
      cmocka_unit_test(degrees_and_knots_are_checked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
