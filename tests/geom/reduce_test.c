// Degree reduction and knot removal, which are optimal in the least squares sense: residuals are
// orthogonal to all changes that are possible.

#include "curve_random.h"
#include "geom/curve/nurbs_ops.h"

enum { MOST = 24 };

static double coordinate(const CagNurbsView *v, size_t i, int c) {
  return v->homogeneous[4 * i + c];
}

// The largest distance between points at the same parameter, from samples.
static double apart(const CagCurve *a, const CagCurve *b) {
  double gap = 0;
  for (int i = 0; i <= 200; i++) {
    const double t = fmin(a->end, a->start + (a->end - a->start) * i / 200);
    gap = fmax(gap, cag_norm(cag_sub(at(a, t), at(b, t))));
  }
  return gap;
}

static void random_net(CagVec3 *p, double *w, size_t n) {
  for (size_t i = 0; i < n; i++) {
    p[i] = random_point(4);
    w[i] = uniform(0.4, 2.5);
  }
}

// The elevated control points are (i / p) g[i - 1] + (1 - i / p) g[i], where p is the degree.
static void lower_degrees_are_nearest(void **state) {
  (void)state;
  seed = 831;
  int seen[2] = {0};
  for (int round = 0; round < 120; round++) {
    const int p = 2 + round % 9;
    const bool rational = round / 9 % 2;
    CagVec3 net[MOST];
    double w[MOST], rest[MOST + 1][4] = {{0}}, most = 0, deviation;
    CagCurve *c, *down;
    CagNurbsView was, is;
    random_net(net, w, (size_t)p + 1);
    OK(cag_curve_bezier(net, rational ? w : NULL, (size_t)p + 1, 3, &c, &err));
    if (cag_curve_reduce_degree(c, INFINITY, &down, &deviation, &err) != CAG_OK) {
      assert_true(rational); // a weight may become negative
      cag_curve_release(c);
      continue;
    }
    assert_true(cag_curve_nurbs_view(c, &was) && cag_curve_nurbs_view(down, &is));
    assert_int_equal(is.degree, p - 1);
    assert_int_equal(is.count, p);
    for (int i = 0; i <= p; i++) {
      double square = 0;
      for (int k = 0; k < 4; k++) {
        const double part = (double)i / p;
        const double raised = (i > 0 ? part * coordinate(&is, (size_t)i - 1, k) : 0) +
                              (i < p ? (1 - part) * coordinate(&is, (size_t)i, k) : 0);
        rest[i][k] = raised - coordinate(&was, (size_t)i, k);
        square += k < 3 ? rest[i][k] * rest[i][k] : 0;
      }
      most = fmax(most, sqrt(square));
    }
    for (int k = 0; k < 4; k++) {
      NEAR(rest[0][k], 0, 1e-14);
      NEAR(rest[p][k], 0, 1e-14);
      for (int i = 1; i + 1 < p; i++)
        NEAR(rest[i][k] * (1 - (double)i / p) + rest[i + 1][k] * (i + 1) / p, 0, 1e-9);
    }
    if (!rational) NEAR(deviation, most, 1e-11);
    assert_true(apart(c, down) <= deviation * (1 + 1e-12));
    cag_curve_release(down);
    seen[rational]++;
    // The tolerance decides.
    FAILS(cag_curve_reduce_degree(c, deviation * 0.999, &down, NULL, &err), "tolerance-exceeded");
    OK(cag_curve_reduce_degree(c, deviation * 1.001, &down, NULL, &err));
    cag_curve_release(down);
    cag_curve_release(c);
  }
  assert_true(seen[0] > 50 && seen[1] > 20);
}

static CagCurve *spline_of(const CagNurbsView *v, const double *homogeneous) {
  CagVec3 p[MOST];
  CagCurve *c;
  for (size_t i = 0; i < v->count; i++)
    p[i] = cag_vec3(homogeneous[4 * i], homogeneous[4 * i + 1], homogeneous[4 * i + 2]);
  OK(cag_curve_nurbs(p, NULL, v->count, v->degree, v->knots, 3, &c, &err));
  return c;
}

// The control points of a spline after the knot is inserted again.
static void inserted(const CagNurbsView *v, const double *homogeneous, double t, double *out) {
  CagCurve *c = spline_of(v, homogeneous), *fine;
  CagNurbsView f;
  OK(cag_curve_insert_knots(c, &t, 1, &fine, &err));
  assert_true(cag_curve_nurbs_view(fine, &f));
  memcpy(out, f.homogeneous, sizeof(double) * 4 * f.count);
  cag_curve_release(fine);
  cag_curve_release(c);
}

static void removed_knots_leave_the_nearest_curve(void **state) {
  (void)state;
  seed = 832;
  size_t moved_points = 0;
  for (int round = 0; round < 100; round++) {
    const int p = 1 + round % 5, times = 1 + round / 5 % p;
    enum { INNER = 5 };
    const size_t n = (size_t)(p + 1 + INNER - 1 + times);
    CagVec3 net[MOST];
    double w[MOST], knots[2 * MOST], t = 0, deviation;
    // Inner knots 1, .., one of them with a higher multiplicity.
    size_t m = 0;
    const int chosen = round % INNER;
    for (int i = 0; i <= p; i++) knots[m++] = 0;
    for (int i = 0; i < INNER; i++) {
      const double knot = 1 + i + uniform(-0.4, 0.4);
      for (int k = 0; k < (i == chosen ? times : 1); k++) knots[m++] = knot;
      if (i == chosen) t = knot;
    }
    for (int i = 0; i <= p; i++) knots[m++] = INNER + 1;
    assert_int_equal(m, n + (size_t)p + 1);
    random_net(net, w, n);
    CagCurve *c, *less;
    CagNurbsView was, is;
    OK(cag_curve_nurbs(net, NULL, n, p, knots, 3, &c, &err));
    OK(cag_curve_remove_knot(c, t, 1, INFINITY, &less, &deviation, &err));
    assert_true(cag_curve_nurbs_view(c, &was) && cag_curve_nurbs_view(less, &is));
    assert_int_equal(is.count, n - 1);
    double back[4 * MOST], changed[4 * MOST], rest[4 * MOST], most = 0;
    inserted(&is, is.homogeneous, t, back);
    for (size_t i = 0; i < 4 * n; i++) rest[i] = back[i] - was.homogeneous[i];
    for (size_t i = 0; i < n; i++)
      most = fmax(most, cag_norm(cag_vec3(rest[4 * i], rest[4 * i + 1], rest[4 * i + 2])));
    NEAR(deviation, most, 1e-11);
    assert_true(apart(c, less) <= deviation * (1 + 1e-12));
    // A control point that affects two points after the insertion, neither of them entirely, is
    // free. The residual is orthogonal to its effect.
    for (size_t k = 0; k + 1 < n; k++) {
      double net_moved[4 * MOST], along[3] = {0};
      int acts = 0;
      memcpy(net_moved, is.homogeneous, sizeof(double) * 4 * is.count);
      for (int j = 0; j < 3; j++) net_moved[4 * k + j] += 1;
      inserted(&is, net_moved, t, changed);
      for (size_t i = 0; i < n; i++) {
        const double part = changed[4 * i] - back[4 * i];
        acts += part > 1e-9 && part < 1 - 1e-9;
        for (int j = 0; j < 3; j++) along[j] += part * rest[4 * i + j];
      }
      if (acts < 2) continue;
      moved_points++;
      for (int j = 0; j < 3; j++) NEAR(along[j], 0, 1e-10);
    }
    cag_curve_release(less);
    FAILS(cag_curve_remove_knot(c, t, times + 1, INFINITY, &less, NULL, &err), "no-such-knot");
    FAILS(cag_curve_remove_knot(c, t, 0, INFINITY, &less, NULL, &err), "no-such-knot");
    FAILS(cag_curve_remove_knot(c, 0, 1, INFINITY, &less, NULL, &err), "no-such-knot");
    FAILS(cag_curve_remove_knot(c, c->end, 1, INFINITY, &less, NULL, &err), "no-such-knot");
    FAILS(cag_curve_remove_knot(c, t, 1, deviation * 0.999, &less, NULL, &err),
          "tolerance-exceeded");
    OK(cag_curve_remove_knot(c, t, 1, deviation * 1.001, &less, NULL, &err));
    cag_curve_release(less);
    cag_curve_release(c);
  }
  assert_true(moved_points > 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lower_degrees_are_nearest),
      cmocka_unit_test(removed_knots_leave_the_nearest_curve),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
