// Bernstein polynomials, B-spline bases, knot vectors and quadrature.

#include "geom/basis/basis_table.h"
#include "geom/basis/bernstein.h"
#include "geom/basis/bspline.h"
#include "geom/basis/knots.h"
#include "geom/basis/quadrature.h"
#include "random.h"
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
  // Runs of equal points still result in valid knots. If all points are equal, the knots are open.
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
  // The tolerance is relative to the largest component; integrated alone, the kink is found.
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

// --- Random knot vectors ---

// The basis function i of degree q by its recursive definition, for t in the given interval.
static double function_at(const double *x, size_t interval, size_t i, int q, double t) {
  if (q == 0) return i == interval;
  const double a = x[i + (size_t)q] - x[i], b = x[i + (size_t)q + 1] - x[i + 1];
  const double left = a > 0 ? (t - x[i]) / a * function_at(x, interval, i, q - 1, t) : 0;
  return left +
         (b > 0 ? (x[i + (size_t)q + 1] - t) / b * function_at(x, interval, i + 1, q - 1, t) : 0);
}

static double derivative_at(const double *x, size_t interval, size_t i, int q, double t,
                            int order) {
  if (order == 0) return function_at(x, interval, i, q, t);
  if (q == 0) return 0;
  const double a = x[i + (size_t)q] - x[i], b = x[i + (size_t)q + 1] - x[i + 1];
  const double left = a > 0 ? q / a * derivative_at(x, interval, i, q - 1, t, order - 1) : 0;
  return left - (b > 0 ? q / b * derivative_at(x, interval, i + 1, q - 1, t, order - 1) : 0);
}

// Ascending knots for n functions of degree p, with inner repetitions up to the degree, clamped or
// not.
static void random_knots(double *x, size_t n, int p, bool clamp) {
  const size_t count = n + (size_t)p + 1;
  double t = uniform(-2, 2);
  size_t run = 0;
  for (size_t i = 0; i < count; i++) {
    const bool again =
        clamp && (i <= (size_t)p || i > n) ? i != 0 && i != n : i > 0 && uniform(0, 1) < 0.3;
    const double step = uniform(0.2, 1.5);
    if (i > 0 && (!again || (run >= (size_t)p && !(clamp && (i <= (size_t)p || i > n))))) {
      t += step;
      run = 0;
    }
    run++;
    x[i] = t;
  }
}

static void random_bases_follow_their_definition(void **state) {
  (void)state;
  seed = 81;
  for (int round = 0; round < 200; round++) {
    const int p = 1 + round % 4;
    const size_t n = (size_t)p + 1 + (size_t)(round % 6), count = n + (size_t)p + 1;
    double x[16], table[5 * 16], derived[16], work[8], piece[25];
    random_knots(x, n, p, round % 2);
    for (int s = 0; s < 12; s++) {
      // At the knots, at the ends, and between them.
      const size_t k = (size_t)(uniform(0, (double)count - 1e-9));
      const double t = s < 6 ? x[k] : uniform(x[0], x[count - 1]);
      const bool left = s % 2;
      size_t interval;
      OK(cag_basis_interval(x, count, p, t, left, &interval, &err));
      assert_true(x[interval] < x[interval + 1]);
      assert_true(x[interval] <= t && t <= x[interval + 1]);
      const bool inside = t > x[interval] && t < x[interval + 1];
      const bool ends = t == x[count - 1] || (n > (size_t)p && t == x[n]);
      if (!inside && t > x[0]) assert_true((left || ends) == (t == x[interval + 1]));
      if (t == x[0]) assert_true(x[interval] == t);
      cag_basis_triangle(x, count, p, interval, t, table);
      for (int q = 0; q <= p; q++)
        for (size_t i = 0; i + (size_t)q + 1 < count; i++)
          NEAR(table[(size_t)q * (count - 1) + i], function_at(x, interval, i, q, t), 1e-12);
      for (int order = 0; order <= p + 1; order++) {
        cag_basis_derivative(x, count, p, interval, t, order, work, derived);
        for (size_t i = 0; i < n; i++) {
          const double expected = derivative_at(x, interval, i, p, t, order);
          NEAR(derived[i], expected, 1e-10 * (1 + fabs(expected)));
        }
      }
      for (int local = 0; local < 2; local++) {
        cag_basis_piece(x, count, p, interval, local, piece);
        for (int j = 0; j <= p; j++) {
          const size_t i = interval + (size_t)j - (size_t)p;
          const bool real = interval + (size_t)j >= (size_t)p && i < n;
          for (int m = 0; m < 3; m++) {
            const double u = x[interval] + (x[interval + 1] - x[interval]) * m / 3;
            double sum = 0;
            for (int power = p; power >= 0; power--)
              sum = sum * (local ? u - x[interval] : u) + piece[j * (p + 1) + power];
            NEAR(sum, real ? function_at(x, interval, i, p, u) : 0, 1e-8);
          }
        }
      }
    }
    size_t interval;
    FAILS(cag_basis_interval(x, count, p, x[0] - 1e-9, false, &interval, &err), "parameter-range");
    FAILS(cag_basis_interval(x, count, p, x[count - 1] + 1e-9, false, &interval, &err),
          "parameter-range");
  }
}

// Curve evaluation follows the definition, and so do the pieces and an inserted knot.
static void random_splines_follow_their_definition(void **state) {
  (void)state;
  seed = 82;
  for (int round = 0; round < 200; round++) {
    const int p = 1 + round % 5;
    const size_t n = (size_t)p + 1 + (size_t)(round % 5);
    double x[18], h[4 * 12], basis[6], derived[6 * 8], b[4 * 6], d[4 * 8], e[4 * 8];
    random_knots(x, n, p, round % 2);
    // Some random vectors have no valid domain.
    if (cag_knots_check(x, n, p, &err)) continue;
    for (size_t i = 0; i < 4 * n; i++) h[i] = uniform(-2, 2);
    const double t = round % 3 ? uniform(x[p], x[n]) : x[p + 1];
    const size_t span = cag_knots_span(x, n, p, t, false, (size_t)(round % 7));
    assert_true(x[span] < x[span + 1] && span >= (size_t)p && span < n);
    assert_true(x[span] <= t && (t < x[span + 1] || t == x[n]));
    cag_bspline_basis(x, p, span, t, basis);
    cag_bspline_derivatives(x, p, span, t, p + 2, derived);
    const size_t first = span - (size_t)p;
    for (int j = 0; j <= p; j++) {
      NEAR(basis[j], function_at(x, span, first + (size_t)j, p, t), 1e-12);
      for (int k = 0; k <= p + 2; k++) {
        const double expected = derivative_at(x, span, first + (size_t)j, p, t, k);
        NEAR(derived[k * (p + 1) + j], expected, 1e-10 * (1 + fabs(expected)));
      }
    }
    // Value and derivatives of the spline, computed from its piece.
    cag_bspline_piece(h, x, p, span, b);
    cag_bspline_piece_derivatives(h, x, p, span, t, p + 2, d);
    const double length = x[span + 1] - x[span];
    cag_bezier_derivatives(b, p, (t - x[span]) / length, p + 2, e);
    double scale = 1;
    for (int k = 0; k <= p + 2; k++, scale /= length)
      for (int c = 0; c < 4; c++) {
        double sum = 0;
        for (int j = 0; j <= p; j++)
          sum += derived[k * (p + 1) + j] * h[4 * (first + (size_t)j) + (size_t)c];
        NEAR(d[4 * k + c], sum, 1e-9 * (1 + fabs(sum)));
        NEAR(e[4 * k + c] * scale, sum, 1e-9 * (1 + fabs(sum)));
      }
    // Knot insertion does not change the spline.
    if (cag_knots_multiplicity(x, n, p, t) >= p || t >= x[n]) continue;
    double y[19], g[4 * 13];
    memcpy(y, x, sizeof(double) * (n + (size_t)p + 1));
    memcpy(g, h, sizeof(double) * 4 * n);
    cag_bspline_insert(g, y, n, p, t);
    assert_int_equal(cag_knots_multiplicity(y, n + 1, p, t),
                     cag_knots_multiplicity(x, n, p, t) + 1);
    for (size_t i = 0; i < n + (size_t)p + 1; i++) assert_true(y[i] <= y[i + 1]);
    for (int s = 0; s < 5; s++) {
      const double u = uniform(x[p], x[n]);
      const size_t old = cag_knots_span(x, n, p, u, false, 0);
      const size_t now = cag_knots_span(y, n + 1, p, u, false, 0);
      for (int c = 0; c < 4; c++) {
        double before = 0, after = 0;
        for (size_t j = 0; j <= (size_t)p; j++) {
          before += function_at(x, old, old - (size_t)p + j, p, u) *
                    h[4 * (old - (size_t)p + j) + (size_t)c];
          after += function_at(y, now, now - (size_t)p + j, p, u) *
                   g[4 * (now - (size_t)p + j) + (size_t)c];
        }
        NEAR(after, before, 1e-11);
      }
    }
  }
}

// Each basis function is a combination of those on the refined knots.
static void random_refinements_add_up(void **state) {
  (void)state;
  seed = 83;
  for (int round = 0; round < 80; round++) {
    const int p = 1 + round % 3;
    const size_t n = (size_t)p + 2 + (size_t)(round % 3), count = n + (size_t)p + 1;
    double x[12], y[20], out[4 * 12 * 18];
    random_knots(x, n, p, round % 2);
    if (cag_knots_check(x, n, p, &err)) continue;
    size_t m = 0;
    for (size_t i = 0; i < count; i++) {
      y[m++] = x[i];
      if (i >= (size_t)p && i < n && x[i + 1] > x[i] && i % 2)
        y[m++] = uniform(x[i] + 0.01, x[i + 1] - 0.01);
    }
    OK(cag_basis_oslo(x, count, y, m, p, out, &err));
    const size_t fine = m - (size_t)p - 1;
    for (int s = 0; s < 6; s++) {
      const double t = uniform(x[p], x[n]);
      size_t coarse_interval, fine_interval;
      OK(cag_basis_interval(x, count, p, t, false, &coarse_interval, &err));
      OK(cag_basis_interval(y, m, p, t, false, &fine_interval, &err));
      for (size_t i = 0; i < n; i++) {
        const double *row = out + ((size_t)p * (count - 1) + i) * fine;
        double sum = 0;
        for (size_t j = 0; j < fine; j++) sum += row[j] * function_at(y, fine_interval, j, p, t);
        NEAR(sum, function_at(x, coarse_interval, i, p, t), 1e-12);
      }
    }
  }
}

static void spans_are_those_of_a_search(void **state) {
  (void)state;
  seed = 84;
  for (int round = 0; round < 300; round++) {
    const int p = 1 + round % 4;
    const size_t n = (size_t)p + 1 + (size_t)(round % 5);
    double x[16];
    random_knots(x, n, p, round % 2);
    if (cag_knots_check(x, n, p, &err)) continue;
    const double t =
        round % 3 ? x[p + (int)uniform(0, (double)(n - (size_t)p) + 0.999)] : uniform(x[p], x[n]);
    for (int left = 0; left < 2; left++)
      for (size_t hint = 0; hint <= n + 1; hint++) {
        const size_t span = cag_knots_span(x, n, p, t, left, hint);
        size_t expected = 0;
        for (size_t i = (size_t)p; i < n; i++) {
          if (!(x[i] < x[i + 1])) continue;
          const bool first = x[i] == x[p], last = x[i + 1] == x[n];
          const bool from = left ? t > x[i] || first : t >= x[i];
          const bool to = left || last ? t <= x[i + 1] : t < x[i + 1];
          if (from && to && expected == 0) expected = i;
        }
        assert_int_equal(span, expected);
      }
  }
}

// Parts, elevation and rational derivatives of random pieces.
static void random_pieces_keep_their_points(void **state) {
  (void)state;
  seed = 85;
  for (int round = 0; round < 150; round++) {
    const int p = 1 + round % 6;
    double b[4 * 7], part[4 * 7], up[4 * 8], value[4], other[4];
    for (int i = 0; i < 4 * (p + 1); i++) b[i] = uniform(-2, 2);
    static const double ends[5][2] = {{0, 1}, {0, 0.3}, {0.6, 1}, {0.2, 0.9}, {0.4, 0.4}};
    const double u = ends[round % 5][0], v = ends[round % 5][1], s = uniform(0, 1);
    cag_bezier_segment(b, p, u, v, part);
    cag_bezier_elevate(b, p, up);
    for (int k = 0; k < 3; k++) {
      const double t = k == 0 ? 0 : k == 1 ? 1 : s;
      cag_bezier_derivatives(part, p, t, 0, value);
      cag_bezier_derivatives(b, p, u + (v - u) * t, 0, other);
      for (int c = 0; c < 4; c++) NEAR(value[c], other[c], 1e-12);
      cag_bezier_derivatives(up, p + 1, t, 0, value);
      cag_bezier_derivatives(b, p, t, 0, other);
      for (int c = 0; c < 4; c++) {
        double basis[8], sum = 0;
        cag_bernstein(p, t, basis);
        for (int i = 0; i <= p; i++) sum += basis[i] * b[4 * i + c];
        NEAR(value[c], sum, 1e-12);
        NEAR(other[c], sum, 1e-12);
      }
    }
    // w P = the homogeneous point, so its derivatives follow from the Leibniz rule.
    double h[4 * 6];
    CagVec3 d[6];
    for (int i = 0; i < 24; i++) h[i] = uniform(-1, 1);
    h[3] = round % 4 ? uniform(0.5, 2) : 1;
    cag_rational_derivatives(h, 5, d);
    for (int k = 0; k < 6; k++) {
      CagVec3 sum = {0, 0, 0};
      for (int j = 0; j <= k; j++) sum = cag_madd(sum, cag_binomial(k, j) * h[4 * j + 3], d[k - j]);
      near_vec(sum, cag_vec3(h[4 * k], h[4 * k + 1], h[4 * k + 2]), 1e-9 * (1 + cag_norm(d[k])));
    }
  }
  for (int n = 0; n < 20; n++)
    for (int k = -2; k <= n + 2; k++) {
      const bool inside = k >= 0 && k <= n;
      NEAR(cag_binomial(n, k),
           inside ? round(exp(lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1))) : 0, 0);
    }
}

static void each_rule_for_knots_is_checked(void **state) {
  (void)state;
  const double good[8] = {0, 0, 0, 1, 1, 2, 2, 2}, triple[9] = {0, 0, 0, 1, 1, 1, 2, 2, 2};
  const double start[8] = {0, 0, 0, 0, 1, 2, 2, 2}, end[8] = {0, 0, 0, 1, 2, 2, 2, 2};
  const double falling[8] = {0, 0, 0, 1, 0.5, 2, 2, 2}, flat[6] = {0, 0, 1, 1, 2, 3};
  OK(cag_knots_check(good, 5, 2, &err));
  FAILS_AT(cag_knots_check(triple, 6, 2, &err), "knot-multiplicity", 5);
  FAILS_AT(cag_knots_check(start, 5, 2, &err), "knot-multiplicity", 3);
  FAILS_AT(cag_knots_check(end, 5, 2, &err), "knot-multiplicity", 7);
  FAILS_AT(cag_knots_check(falling, 5, 2, &err), "knots-not-monotone", 4);
  FAILS_AT(cag_knots_check(flat, 3, 2, &err), "empty-range", 2);
  OK(cag_degree_check(2, 1, &err));
  OK(cag_degree_check(5, 4, &err));
  FAILS(cag_degree_check(2000, CAG_MAX_DEGREE + 1, &err), "order-range");
  OK(cag_degree_check(2000, CAG_MAX_DEGREE, &err));
  // Knots count as uniform if they deviate by less than 1e-9 of the range.
  double knots[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int i = 0; i < 8; i++) {
    knots[i] += 1e-9;
    assert_string_equal(cag_knots_class(knots, 5, 2), "uniform");
    knots[i] += 1e-7;
    assert_string_equal(cag_knots_class(knots, 5, 2), "nonuniform");
    knots[i] = i;
  }
  double open[9] = {0, 0, 0, 1, 2, 3, 4, 4, 4};
  assert_string_equal(cag_knots_class(open, 6, 2), "open-uniform");
  open[8] = 4.5;
  assert_string_equal(cag_knots_class(open, 6, 2), "nonuniform");
  open[8] = 4;
  open[0] = -0.5;
  assert_string_equal(cag_knots_class(open, 6, 2), "nonuniform");
  open[0] = 0;
  open[4] = 2.1;
  assert_string_equal(cag_knots_class(open, 6, 2), "open-nonuniform");
}

// --- Knots by the control polygon ---

// The length of the polygon up to the fractional edge number q. Each edge counts at least `least`.
static double walked(const CagVec3 *p, size_t n, double q, double least) {
  double sum = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    const double part = fmin(1, fmax(0, q - (double)i));
    sum += part * fmax(least, cag_norm(cag_sub(p[i + 1], p[i])));
  }
  return sum;
}

// The i-th inner knot is at the fraction i / m of the edges. An edge between repeated points, which
// would break the curve, counts a thousandth of the mean edge.
static void chord_knots_walk_the_polygon(void **state) {
  (void)state;
  seed = 77;
  int torn_ones = 0, whole_ones = 0;
  for (int round = 0; round < 400; round++) {
    enum { MOST = 12 };
    CagVec3 v[MOST];
    double knots[2 * MOST], plain[2 * MOST];
    const size_t n = 3 + (size_t)uniform(0, MOST - 3);
    const int p = 1 + (int)uniform(0, fmin(4, (double)n - 1));
    const double repeated = round % 2 ? 0.6 : 0.1;
    for (size_t i = 0; i < n; i++) {
      const bool again = i > 0 && uniform(0, 1) < repeated;
      v[i].x = uniform(-2, 2);
      v[i].y = uniform(-2, 2);
      v[i].z = uniform(-2, 2);
      if (again) v[i] = v[i - 1];
    }
    const size_t m = n - (size_t)p;
    const double total = walked(v, n, (double)n, 0);
    cag_knots_chord(v, n, p, knots);
    for (int i = 0; i <= p; i++) assert_true(knots[i] == 0 && knots[n + (size_t)i] == (double)m);
    if (total == 0) {
      for (size_t i = 1; i < m; i++) assert_true(knots[(size_t)p + i] == (double)i);
      continue;
    }
    bool torn = false;
    size_t run = 1;
    for (size_t i = 1; i < m; i++) {
      const double q = (double)(i * (n - 1)) / (double)m;
      plain[i] = (double)m * walked(v, n, q, 0) / total;
      run = i > 1 && plain[i] - plain[i - 1] < 1e-12 ? run + 1 : 1;
      torn = torn || plain[i] < 1e-12 || plain[i] > (double)m - 1e-12 || run > (size_t)p;
    }
    const double least = torn ? 1e-3 * total / (double)(n - 1) : 0;
    const double all = walked(v, n, (double)n, least);
    for (size_t i = 1; i < m; i++) {
      const double q = (double)(i * (n - 1)) / (double)m;
      NEAR(knots[(size_t)p + i], (double)m * walked(v, n, q, least) / all, 1e-12);
    }
    CagError none;
    assert_int_equal(cag_knots_check(knots, n, p, &none), CAG_OK);
    if (m > 1) {
      torn_ones += torn;
      whole_ones += !torn;
    }
  }
  assert_true(torn_ones > 40 && whole_ones > 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_bases_follow_their_definition),
      cmocka_unit_test(random_splines_follow_their_definition),
      cmocka_unit_test(random_refinements_add_up),
      cmocka_unit_test(spans_are_those_of_a_search),
      cmocka_unit_test(random_pieces_keep_their_points),
      cmocka_unit_test(each_rule_for_knots_is_checked),
      cmocka_unit_test(chord_knots_walk_the_polygon),
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
