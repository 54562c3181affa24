// Interpolation and least squares: example 17 of the reference (05b), curves recovered from their
// own points, and invalid data.

#include "geom/basis/bspline.h"
#include "geom/basis/regression.h"
#include "geom/curve/fit.h"
#include "random.h"
#include "support.h"

static const CagVec3 hump[5] = {{0, 0, 0}, {1.5, 2, 0}, {3, 2.5, 0}, {4.5, 2, 0}, {6, 0, 0}};

static CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

static CagVec3 control(const CagCurve *c, size_t i) {
  CagNurbsView v;
  assert_true(cag_curve_nurbs_view(c, &v));
  return cag_vec3(v.homogeneous[4 * i], v.homogeneous[4 * i + 1], v.homogeneous[4 * i + 2]);
}

static void example_17_is_interpolated(void **state) {
  (void)state;
  const CagFitData d = {.points = hump, .n = 5, .degree = 2, .dimension = 2, .kind = CAG_FIT_OPEN};
  CagCurve *c;
  OK(cag_curve_interpolate(&d, NULL, 0, &c, &err));
  near_vec(control(c, 1), cag_vec3(0.40881519451030174, 1.3769113842979592, 0), 1e-13);
  near_vec(control(c, 2), cag_vec3(3, 2.87436287190068, 0), 1e-13);
  cag_curve_release(c);
}

static void example_17_is_fitted(void **state) {
  (void)state;
  const CagFitData d = {.points = hump, .n = 5, .degree = 2, .dimension = 2, .kind = CAG_FIT_OPEN};
  CagCurve *c;
  CagFitReport r;
  OK(cag_curve_fit(&d, 4, false, -1, 0, &c, &r, &err));
  near_vec(control(c, 0), cag_vec3(0, -0.007589704531225728, 0), 1e-13);
  near_vec(control(c, 1), cag_vec3(0.7884875264621146, 2.414049971171124, 0), 1e-13);
  NEAR(r.rms, 0.05023185501160643, 1e-13);
  NEAR(r.parameters[1], 0.6125741132772069, 1e-14);
  cag_fit_report_free(&r);
  cag_curve_release(c);
  OK(cag_curve_fit(&d, 4, true, -1, 0, &c, NULL, &err));
  near_vec(control(c, 1), cag_vec3(0.7884875264621146, 2.4132578686686488, 0), 1e-13);
  near_vec(control(c, 3), hump[4], 0);
  cag_curve_release(c);
}

static void a_held_coordinate_agrees_at_every_point(void **state) {
  (void)state;
  const CagVec3 p[5] = {{0, 0, 0}, {1, 0.4, 0}, {2, 1.2, 0}, {3, 2.6, 0}, {4, 5, 0}};
  const CagFitData d = {.points = p, .n = 5, .degree = 2, .dimension = 2, .kind = CAG_FIT_OPEN};
  CagCurve *c;
  CagFitReport r;
  OK(cag_curve_fit(&d, 4, true, 0, 1e-12, &c, &r, &err));
  for (int i = 0; i < 5; i++) NEAR(at(c, r.parameters[i]).x, p[i].x, 1e-12);
  // Vector bspline.fit.fixed-x
  near_vec(control(c, 1), cag_vec3(1.675296579381261, 0.4973494632220339, 0), 1e-8);
  assert_true(r.rounds > 0 && r.rounds < CAG_FIT_ROUNDS);
  cag_fit_report_free(&r);
  cag_curve_release(c);
  const CagVec3 back[5] = {{0, 0, 0}, {2, 1, 0}, {1, 2, 0}, {2, 3, 0}, {0, 4, 0}};
  const CagFitData bad = {.points = back, .n = 5, .degree = 2, .dimension = 2};
  FAILS_AT(cag_curve_fit(&bad, 4, true, 0, 1e-12, &c, NULL, &err), "fit-no-convergence", 2);
}

#define MANY 200

// For points of a B-spline with the same knots and parameters, least squares recovers the spline.
static void a_spline_is_found_again_from_its_points(void **state) {
  (void)state;
  const CagVec3 net[7] = {{0, 0, 0}, {1, 3, 1},  {3, -2, 2}, {4, 4, 0},
                          {6, 1, 1}, {7, 0, -2}, {9, 1, 1}};
  for (int degree = 1; degree <= 6; degree++) {
    double knots[14], u[MANY];
    CagVec3 p[MANY];
    CagCurve *c, *again;
    CagFitReport r;
    cag_knots_open(7, degree, knots);
    OK(cag_curve_nurbs(net, NULL, 7, degree, knots, 3, &c, &err));
    for (int i = 0; i < MANY; i++) {
      const double s = (double)i / (MANY - 1);
      u[i] = c->end * s * s;
      p[i] = at(c, u[i]);
    }
    const CagFitData d = {.points = p,
                          .n = MANY,
                          .parameters = u,
                          .kind = CAG_FIT_GIVEN,
                          .knots = knots,
                          .degree = degree,
                          .dimension = 3};
    for (int keep = 0; keep < 2; keep++) {
      OK(cag_curve_fit(&d, 7, keep == 1, -1, 0, &again, &r, &err));
      for (size_t i = 0; i < 7; i++) near_vec(control(again, i), net[i], 1e-11);
      assert_true(r.largest < 1e-12);
      cag_fit_report_free(&r);
      cag_curve_release(again);
    }
    cag_curve_release(c);
  }
}

static void interpolation_passes_uneven_points_at_any_degree(void **state) {
  (void)state;
  CagVec3 p[40];
  for (int i = 0; i < 40; i++) p[i] = cag_vec3(i * i * 0.01, sin(i), i % 3);
  for (int degree = 1; degree <= 7; degree++) {
    const CagFitData d = {.points = p, .n = 40, .degree = degree, .dimension = 3};
    double total = 0, walked = 0;
    CagCurve *c;
    OK(cag_curve_interpolate(&d, NULL, 0, &c, &err));
    for (int i = 1; i < 40; i++) total += cag_norm(cag_sub(p[i], p[i - 1]));
    for (int i = 0; i < 40; i++) {
      if (i > 0) walked += cag_norm(cag_sub(p[i], p[i - 1]));
      near_vec(at(c, fmin(c->end, c->end * walked / total)), p[i], 1e-10);
    }
    cag_curve_release(c);
  }
}

static void tangents_are_kept_at_the_ends_and_everywhere(void **state) {
  (void)state;
  const double u[5] = {0, 1, 2.5, 3, 4};
  const CagVec3 v[5] = {{1, 5, 0}, {2, 0, 0}, {1, -1, 0}, {0, -2, 0}, {3, 1, 0}};
  const CagVec3 ends[2] = {{1, 5, 0}, {3, 1, 0}};
  for (int degree = 2; degree <= 5; degree++) {
    const CagFitData d = {
        .points = hump, .n = 5, .parameters = u, .degree = degree, .dimension = 2};
    CagCurve *c;
    CagVec3 e[2];
    OK(cag_curve_interpolate(&d, ends, 2, &c, &err));
    for (int i = 0; i < 5; i++) near_vec(at(c, u[i]), hump[i], 1e-12);
    for (int i = 0; i < 2; i++) {
      OK(cag_curve_eval(c, u[4 * i], 1, CAG_SIDE_LEFT, e, &err));
      near_vec(e[1], ends[i], 1e-11);
    }
    cag_curve_release(c);
    if (degree < 3) continue;
    OK(cag_curve_interpolate(&d, v, 5, &c, &err));
    for (int i = 0; i < 5; i++) {
      OK(cag_curve_eval(c, u[i], 1, CAG_SIDE_LEFT, e, &err));
      near_vec(e[0], hump[i], 1e-11);
      near_vec(e[1], v[i], 1e-10);
    }
    cag_curve_release(c);
  }
}

static void bad_data_are_told(void **state) {
  (void)state;
  const CagVec3 same[4] = {{1, 1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
  const CagVec3 pair[4] = {{0, 0, 0}, {1, 1, 0}, {1, 1, 0}, {3, 0, 0}};
  const double crowded[5] = {0, 0.1, 0.2, 0.3, 3}, falling[5] = {0, 2, 1, 2.5, 3};
  CagCurve *c;
  CagFitData d = {.points = same, .n = 4, .degree = 2, .dimension = 2};
  FAILS(cag_curve_interpolate(&d, NULL, 0, &c, &err), "zero-chord-total");
  FAILS(cag_curve_fit(&d, 3, true, -1, 0, &c, NULL, &err), "zero-chord-total");
  d.points = pair;
  FAILS_AT(cag_curve_interpolate(&d, NULL, 0, &c, &err), "fit-singular", 2);
  OK(cag_curve_fit(&d, 3, true, -1, 0, &c, NULL, &err));
  cag_curve_release(c);
  d = (CagFitData){.points = hump, .n = 5, .degree = 2, .dimension = 2, .kind = CAG_FIT_OPEN};
  FAILS(cag_curve_fit(&d, 6, true, -1, 0, &c, NULL, &err), "fit-underdetermined");
  d.parameters = crowded;
  FAILS_AT(cag_curve_interpolate(&d, NULL, 0, &c, &err), "fit-singular", 3);
  FAILS_AT(cag_curve_fit(&d, 5, false, -1, 0, &c, NULL, &err), "fit-singular", 3);
  d.kind = CAG_FIT_AUTO;
  OK(cag_curve_interpolate(&d, NULL, 0, &c, &err));
  for (int i = 0; i < 5; i++) near_vec(at(c, crowded[i]), hump[i], 1e-11);
  cag_curve_release(c);
  OK(cag_curve_fit(&d, 4, true, -1, 0, &c, NULL, &err));
  cag_curve_release(c);
  d.parameters = falling;
  FAILS_AT(cag_curve_interpolate(&d, NULL, 0, &c, &err), "bad-parameter", 2);
  d.parameters = NULL;
  d.degree = 5;
  FAILS(cag_curve_interpolate(&d, NULL, 0, &c, &err), "order-range");
  const CagVec3 broken[2] = {{0, 0, 0}, {NAN, 0, 0}};
  d = (CagFitData){.points = broken, .n = 2, .degree = 1, .dimension = 2};
  FAILS_AT(cag_curve_interpolate(&d, NULL, 0, &c, &err), "not-finite", 1);
}

// --- Random data ---

static CagVec3 random_point(void) {
  CagVec3 p;
  p.x = uniform(-3, 3);
  p.y = uniform(-3, 3);
  p.z = uniform(-3, 3);
  return p;
}

// The parameters of the points over [from, to], according to the spacing.
static void spaced_parameters(const CagVec3 *p, size_t n, CagSpacing spacing, double from,
                              double to, double *out) {
  double sum = 0;
  out[0] = 0;
  for (size_t i = 1; i < n; i++) {
    const double chord = cag_norm(cag_sub(p[i], p[i - 1]));
    sum += spacing == CAG_SPACING_UNIFORM       ? 1
           : spacing == CAG_SPACING_CENTRIPETAL ? sqrt(chord)
                                                : chord;
    out[i] = sum;
  }
  for (size_t i = 0; i < n; i++) out[i] = from + (to - from) * out[i] / sum;
}

// The residuals of a least squares fit are orthogonal to each basis function with a free control
// point, for any knots.
static void random_fits_are_least_squares(void **state) {
  (void)state;
  seed = 901;
  static const CagSpacing spacings[3] = {CAG_SPACING_UNIFORM, CAG_SPACING_CHORD,
                                         CAG_SPACING_CENTRIPETAL};
  static const CagFitKnots kinds[3] = {CAG_FIT_AUTO, CAG_FIT_OPEN, CAG_FIT_AVERAGED};
  int gaps = 0;
  for (int round = 0; round < 360; round++) {
    enum { MOST = 40 };
    CagVec3 p[MOST];
    double given[MOST], expected[MOST];
    const int degree = 1 + round % 4;
    const size_t count = (size_t)degree + 1 + (size_t)(round % 5),
                 n = count + (size_t)(round % 3) * 12;
    const bool keep = round % 2, own = round % 7 == 0;
    double walked = uniform(-2, 2);
    for (size_t i = 0; i < n; i++) {
      p[i] = random_point();
      walked += own && round % 2 ? pow(10, uniform(-2, 0.5)) : uniform(0.9, 1.1);
      given[i] = walked;
    }
    const CagFitData d = {.points = p,
                          .n = n,
                          .spacing = spacings[round % 3],
                          .parameters = own ? given : NULL,
                          .kind = !own        ? kinds[round / 3 % 3]
                                  : round % 2 ? CAG_FIT_AUTO
                                              : CAG_FIT_AVERAGED,
                          .degree = degree,
                          .dimension = 3};
    CagCurve *c;
    CagFitReport r;
    CagNurbsView v;
    if (cag_curve_fit(&d, count, keep, -1, 0, &c, &r, &err)) {
      // Uniform knots may have a span without data.
      assert_string_equal(cag_error_info(err.id)->reason, "fit-singular");
      assert_true(d.kind == CAG_FIT_OPEN);
      continue;
    }
    assert_true(cag_curve_nurbs_view(c, &v) && !v.rational);
    assert_true(v.degree == degree && v.count == count);
    if (own) memcpy(expected, given, n * sizeof *given);
    else spaced_parameters(p, n, d.spacing, 0, (double)(count - (size_t)degree), expected);
    double sum = 0, largest = 0, dots[12][3] = {{0}};
    for (size_t i = 0; i < n; i++) {
      double basis[8];
      NEAR(r.parameters[i], expected[i], 1e-12);
      const double u = fmin(c->end, r.parameters[i]);
      const CagVec3 e = cag_sub(at(c, u), p[i]);
      near_vec(r.residuals[i], e, 1e-12);
      sum += cag_dot(e, e);
      largest = fmax(largest, cag_norm(e));
      const size_t span = cag_knots_span(v.knots, count, degree, u, false, (size_t)degree);
      cag_bspline_basis(v.knots, degree, span, u, basis);
      for (int j = 0; j <= degree; j++) {
        dots[span - (size_t)degree + (size_t)j][0] += basis[j] * e.x;
        dots[span - (size_t)degree + (size_t)j][1] += basis[j] * e.y;
        dots[span - (size_t)degree + (size_t)j][2] += basis[j] * e.z;
      }
    }
    NEAR(r.rms, sqrt(sum / (double)n), 1e-12);
    NEAR(r.largest, largest, 1e-12);
    assert_int_equal(r.rounds, 0);
    for (size_t j = keep; j < count - keep; j++)
      for (int k = 0; k < 3; k++) NEAR(dots[j][k], 0, 1e-9);
    if (keep) {
      near_vec(control(c, 0), p[0], 0);
      near_vec(control(c, count - 1), p[n - 1], 0);
    }
    // Clamped knots: uniform, with the same number of data in each span, or averages of parameters.
    const double from = expected[0], to = expected[n - 1];
    const size_t spans = count - (size_t)degree;
    bool filled = true; // each span of uniform knots contains a parameter
    for (size_t j = 0; j < spans; j++) {
      const double low = from + (to - from) * (double)j / (double)spans - 1e-12,
                   high = from + (to - from) * (double)(j + 1) / (double)spans + 1e-12;
      bool any = false;
      for (size_t i = 0; i < n; i++) any = any || (expected[i] >= low && expected[i] <= high);
      filled = filled && any;
    }
    gaps += d.kind == CAG_FIT_AUTO && !filled;
    for (int k = 0; k <= degree; k++) {
      NEAR(v.knots[k], from, 1e-12);
      NEAR(v.knots[count + (size_t)k], to, 1e-12);
    }
    for (size_t j = 1; j + (size_t)degree < count; j++) {
      const double even = from + (to - from) * (double)j / (double)(count - (size_t)degree);
      double other = 0;
      if (n == count) {
        for (int k = 0; k < degree; k++) other += expected[j + (size_t)k] / degree;
      } else {
        const double place = (double)(j * n) / (double)(count - (size_t)degree);
        const size_t i = (size_t)(place + 1e-12);
        other = expected[i - 1] + (place - (double)i) * (expected[i] - expected[i - 1]);
      }
      const double knot = v.knots[(size_t)degree + j];
      if (d.kind == CAG_FIT_OPEN) NEAR(knot, even, 1e-9);
      else if (d.kind == CAG_FIT_AVERAGED) NEAR(knot, other, 1e-9);
      else NEAR(knot, filled ? even : other, 1e-9);
    }
    cag_fit_report_free(&r);
    cag_curve_release(c);
  }
  assert_true(gaps > 5);
}

static void random_points_are_passed_at_their_parameters(void **state) {
  (void)state;
  seed = 902;
  static const CagSpacing spacings[3] = {CAG_SPACING_UNIFORM, CAG_SPACING_CHORD,
                                         CAG_SPACING_CENTRIPETAL};
  for (int round = 0; round < 60; round++) {
    CagVec3 p[12], v[12];
    double u[12];
    const int degree = 1 + round % 5;
    const size_t n = (size_t)degree + 1 + (size_t)(round % 4);
    for (size_t i = 0; i < n; i++) {
      p[i] = random_point();
      v[i] = random_point();
    }
    const CagFitData d = {.points = p,
                          .n = n,
                          .spacing = spacings[round % 3],
                          .kind = round % 2 ? CAG_FIT_AVERAGED : CAG_FIT_AUTO,
                          .degree = degree,
                          .dimension = 3};
    CagCurve *c;
    CagVec3 e[2];
    OK(cag_curve_interpolate(&d, NULL, 0, &c, &err));
    spaced_parameters(p, n, d.spacing, c->start, c->end, u);
    assert_true(c->start == 0 && c->end == (double)(n - (size_t)degree));
    for (size_t i = 0; i < n; i++) near_vec(at(c, fmin(c->end, u[i])), p[i], 1e-9);
    cag_curve_release(c);
    if (degree < 3) continue;
    // Tangents at the ends, or at all points.
    const bool all = round % 2;
    OK(cag_curve_interpolate(&d, v, all ? n : 2, &c, &err));
    spaced_parameters(p, n, d.spacing, c->start, c->end, u);
    for (size_t i = 0; i < n; i++) {
      OK(cag_curve_eval(c, fmin(c->end, u[i]), 1, CAG_SIDE_LEFT, e, &err));
      near_vec(e[0], p[i], 1e-7);
      if (all) near_vec(e[1], v[i], 1e-5);
      else if (i == 0 || i + 1 == n) near_vec(e[1], v[i > 0], 1e-5);
    }
    cag_curve_release(c);
    FAILS(cag_curve_interpolate(&d, v, 1, &c, &err), "point-count");
    FAILS(cag_curve_interpolate(&d, v, n + 1, &c, &err), "point-count");
  }
}

// x increases along the data. With x fixed, the curve is a graph that has each point's x at its
// parameter.
static void random_coordinates_are_held(void **state) {
  (void)state;
  seed = 903;
  for (int round = 0; round < 30; round++) {
    CagVec3 p[14];
    const int axis = round % 3;
    double grown = 0;
    for (int i = 0; i < 14; i++) {
      const double step = uniform(0.8, 1.2), other = uniform(-0.3, 0.3), third = uniform(-0.3, 0.3);
      p[i] = axis == 0   ? cag_vec3(grown, other, third)
             : axis == 1 ? cag_vec3(third, grown, other)
                         : cag_vec3(other, third, grown);
      grown += step;
    }
    const CagFitData d = {.points = p, .n = 14, .degree = 3, .dimension = 3};
    CagCurve *c;
    CagFitReport r;
    OK(cag_curve_fit(&d, 6, false, axis, 1e-10, &c, &r, &err));
    near_vec(control(c, 0), p[0], 0);
    near_vec(control(c, 5), p[13], 0);
    for (int i = 0; i < 14; i++) {
      const CagVec3 q = at(c, r.parameters[i]);
      NEAR(axis == 0   ? q.x
           : axis == 1 ? q.y
                       : q.z,
           axis == 0   ? p[i].x
           : axis == 1 ? p[i].y
                       : p[i].z,
           1e-10);
      near_vec(r.residuals[i], cag_sub(q, p[i]), 1e-12);
    }
    cag_fit_report_free(&r);
    cag_curve_release(c);
    const CagFitData flat = {.points = p, .n = 14, .degree = 3, .dimension = 2};
    FAILS(cag_curve_fit(&flat, 6, false, 2, 1e-10, &c, NULL, &err), "bad-order");
  }
  const CagVec3 p[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  const double open[7] = {0, 0.1, 1, 2, 3, 4, 5}, outside[3] = {0, 1, 9};
  CagFitData d = {
      .points = p, .n = 3, .degree = 2, .dimension = 2, .kind = CAG_FIT_GIVEN, .knots = open};
  CagCurve *c;
  FAILS(cag_curve_fit(&d, 3, true, -1, 0, &c, NULL, &err), "fit-ends");
  d.parameters = outside;
  FAILS_AT(cag_curve_fit(&d, 3, false, -1, 0, &c, NULL, &err), "bad-parameter", 0);
  d.kind = CAG_FIT_AUTO;
  d.n = 1;
  FAILS(cag_curve_interpolate(&d, NULL, 0, &c, &err), "too-few-points");
  d.n = 3;
  d.degree = 0;
  FAILS(cag_curve_interpolate(&d, NULL, 0, &c, &err), "order-range");
}

// Evenly spaced data of degree 2 get uniform knots. If a point would not have a basis function of
// its own on uniform knots, averaged knots are used.
static void even_knots_are_for_even_data(void **state) {
  (void)state;
  const double even[7] = {0, 1, 2, 3, 4, 5, 6}, crowded[7] = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 6};
  CagVec3 p[7];
  for (int i = 0; i < 7; i++) p[i] = cag_vec3(i, i % 2, 0);
  CagFitData d = {.points = p, .n = 7, .parameters = even, .degree = 2, .dimension = 2};
  CagCurve *c;
  CagNurbsView v;
  OK(cag_curve_interpolate(&d, NULL, 0, &c, &err));
  assert_true(cag_curve_nurbs_view(c, &v));
  for (int j = 1; j < 5; j++) NEAR(v.knots[2 + j], 1.2 * j, 1e-12);
  cag_curve_release(c);
  d.parameters = crowded;
  OK(cag_curve_interpolate(&d, NULL, 0, &c, &err));
  assert_true(cag_curve_nurbs_view(c, &v));
  for (int j = 1; j < 5; j++) NEAR(v.knots[2 + j], (crowded[j] + crowded[j + 1]) / 2, 1e-12);
  cag_curve_release(c);
}

static void formulas_fit_in_the_least_squares_sense(void **state) {
  (void)state;
  const double x[5] = {0, 1, 2, 3, 4}, y[5] = {1, 2, 2, 4, 3};
  const double px[4] = {1, 2, 3, 4}, py[4] = {2, 5.656854249492381, 10.392304845413264, 16};
  double c[6], rest;
  OK(cag_fit_formula(x, y, 5, CAG_MODEL_POLYNOMIAL, 2, c, &rest, &err));
  NEAR(c[0], 32.0 / 35, 1e-13);
  NEAR(c[1], 41.0 / 35, 1e-13);
  NEAR(c[2], -1.0 / 7, 1e-13);
  NEAR(rest, 46.0 / 35, 1e-13);
  OK(cag_fit_formula(px, py, 4, CAG_MODEL_POWER, 0, c, &rest, &err));
  NEAR(c[0], 2, 1e-12);
  NEAR(c[1], 1.5, 1e-12);
  FAILS_AT(cag_fit_formula(x, y, 5, CAG_MODEL_POWER, 0, c, &rest, &err), "domain", 0);
  FAILS(cag_fit_formula(x, y, 2, CAG_MODEL_POLYNOMIAL, 2, c, &rest, &err), "underdetermined");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(formulas_fit_in_the_least_squares_sense),
      cmocka_unit_test(even_knots_are_for_even_data),
      cmocka_unit_test(random_fits_are_least_squares),
      cmocka_unit_test(random_points_are_passed_at_their_parameters),
      cmocka_unit_test(random_coordinates_are_held),
      cmocka_unit_test(example_17_is_interpolated),
      cmocka_unit_test(example_17_is_fitted),
      cmocka_unit_test(a_held_coordinate_agrees_at_every_point),
      cmocka_unit_test(a_spline_is_found_again_from_its_points),
      cmocka_unit_test(interpolation_passes_uneven_points_at_any_degree),
      cmocka_unit_test(tangents_are_kept_at_the_ends_and_everywhere),
      cmocka_unit_test(bad_data_are_told),
  };
  return cmocka_run_group_tests_name("fit", tests, NULL, NULL);
}
