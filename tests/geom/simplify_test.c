// Simplified curves and regions: their distance from the given ones, and their topology.

#include "tests/geom/support.h"

#include "geom/curve/approximate.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/curve/simplify.h"
#include "tests/geom/random.h"
#include "tests/geom/region_support.h"

static size_t vertices_of(const CagCurve *c) {
  const CagVec3 *v;
  size_t n;
  bool closed;
  assert_true(cag_curve_vertices(c, &v, &n, &closed));
  return n;
}

static CagCurve *path(const CagVec3 *p, size_t n, bool closed, int dimension) {
  CagCurve *c;
  OK(cag_curve_polyline(p, n, closed, dimension, &c, &err));
  return c;
}

static size_t count_after(CagCurve *c, double tolerance) {
  CagCurve *s;
  OK(cag_curve_simplify(c, tolerance, &s, &err));
  const size_t n = vertices_of(s);
  assert_int_equal(s->closed, c->closed);
  cag_curve_release(s);
  cag_curve_release(c);
  return n;
}

// The cases of GEOS's TestSimplify (simplifyDP).
static void vertices_within_the_tolerance_are_dropped(void **state) {
  (void)state;
  const CagVec3 line[] = {{10, 10, 0}, {20, 21, 0}, {30, 30, 0}};
  assert_int_equal(count_after(path(line, 3, false, 2), 10), 2);
  assert_int_equal(count_after(path(line, 3, false, 2), 0.5), 3);
  const CagVec3 flat[] = {{0, 5, 0}, {1, 5, 0}, {2, 5, 0}, {5, 5, 0}};
  assert_int_equal(count_after(path(flat, 4, false, 2), 0), 2);
  const CagVec3 bent[] = {{10, 60, 0}, {39, 50, 0}, {70, 60, 0}, {90, 50, 0}};
  assert_int_equal(count_after(path(bent, 4, false, 2), 10), 2);
  const CagVec3 space[] = {{0, 0, 0}, {1, 0, 1}, {2, 0, 0}};
  assert_int_equal(count_after(path(space, 3, false, 3), 0.9), 3);
  assert_int_equal(count_after(path(space, 3, false, 3), 1.1), 2);
}

static void closed_polylines_keep_three_vertices(void **state) {
  (void)state;
  enum { SIDES = 100 };
  CagVec3 p[SIDES];
  for (int i = 0; i < SIDES; i++)
    p[i] = cag_vec3(cos(2 * M_PI * i / SIDES), sin(2 * M_PI * i / SIDES), 0);
  assert_int_equal(count_after(path(p, SIDES, true, 2), 10), 3);
  const size_t n = count_after(path(p, SIDES, true, 2), 0.01);
  // A chord of a circle with the sagitta s spans 2 acos(1 - s): at least 23 for s = 0.01.
  assert_in_range(n, 22, 50);
}

static void points_stay_within_the_tolerance(void **state) {
  (void)state;
  enum { POINTS = 200, LOOKS = 300 };
  seed = 3;
  for (int round = 0; round < 8; round++) {
    CagVec3 p[POINTS];
    for (int i = 0; i < POINTS; i++)
      p[i] = cag_vec3(i * 0.1 + uniform(-0.1, 0.1), sin(i * 0.2) + uniform(-0.2, 0.2), 0);
    CagCurve *c = path(p, POINTS, round % 2, 2), *s;
    const double tolerance = uniform(0.05, 0.5);
    OK(cag_curve_simplify(c, tolerance, &s, &err));
    assert_true(vertices_of(s) < POINTS);
    for (int i = 0; i < LOOKS; i++) {
      CagVec3 q, near;
      double t, distance;
      OK(cag_curve_point(c, c->start + (c->end - c->start) * i / LOOKS, &q, &err));
      OK(cag_curve_closest(s, q, &t, &near, &distance, &err));
      assert_true(distance <= tolerance * (1 + 1e-12));
    }
    cag_curve_release(s);
    cag_curve_release(c);
  }
}

static void splines_lose_knots_that_they_do_not_need(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {1, 2, 0}, {3, 3, 0}, {4, 0, 0}, {6, 1, 0}};
  const double knots[] = {0, 0, 0, 0, 1, 2, 2, 2, 2}, more[] = {0.2, 0.4, 0.4, 1.5, 1.7};
  CagCurve *c, *refined, *s;
  CagNurbsView view;
  double off;
  OK(cag_curve_nurbs(p, NULL, 5, 3, knots, 2, &c, &err));
  OK(cag_curve_insert_knots(c, more, 5, &refined, &err));
  OK(cag_curve_simplify(refined, 1e-9, &s, &err));
  assert_true(cag_curve_nurbs_view(s, &view));
  assert_int_equal(view.count, 5);
  OK(cag_curve_deviation(c, s, &off, &err));
  assert_true(off <= 1e-9);
  cag_curve_release(s);
  OK(cag_curve_simplify(refined, 10, &s, &err));
  assert_true(cag_curve_nurbs_view(s, &view));
  assert_int_equal(view.count, 4);
  OK(cag_curve_deviation(c, s, &off, &err));
  assert_true(off <= 10);
  cag_curve_release(s);
  cag_curve_release(refined);
  cag_curve_release(c);
}

// A band with ragged sides: simplified on their own, its sides would cross.
static void regions_keep_their_topology(void **state) {
  (void)state;
  enum { TEETH = 40, N = 2 * TEETH };
  seed = 11;
  for (int round = 0; round < 20; round++) {
    CagVec3 outer[N], inner[N];
    for (int i = 0; i < N; i++) {
      const double a = 2 * M_PI * i / N, r = 3 + uniform(0, 1.5);
      outer[i] = cag_vec3(r * cos(a), r * sin(a), 0);
      inner[i] = cag_vec3((r - 0.2) * cos(a), (r - 0.2) * sin(a), 0);
    }
    CagCurve *c = path(outer, N, true, 2), *h = path(inner, N, true, 2);
    CagRegion *r, *s, *again;
    OK(cag_region_new(c, &h, 1, &r, &err));
    OK(cag_region_simplify(r, 0.8, &s, &err));
    assert_int_equal(s->count, 2);
    assert_true(vertices_of(s->loops[0]) + vertices_of(s->loops[1]) < 2 * N);
    // The constructor checks that loops do not cross, and where holes are.
    OK(cag_region_new(s->loops[0], &s->loops[1], 1, &again, &err));
    cag_region_release(again);
    cag_region_release(s);
    cag_region_release(r);
    cag_curve_release(c);
    cag_curve_release(h);
  }
}

// The bay below [0, 0] and [4, 0] is within the tolerance of its chord, but the hole is in it.
static void holes_stay_inside(void **state) {
  (void)state;
  const CagVec3 outline[] = {{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {4, 9, 0}, {0, 9, 0}};
  const CagVec3 hole[] = {{1.8, -0.8, 0}, {2.2, -0.8, 0}, {2, -0.2, 0}};
  CagCurve *c = path(outline, 5, true, 2), *h = path(hole, 3, true, 2);
  CagRegion *r, *s;
  OK(cag_region_new(c, NULL, 0, &r, &err));
  OK(cag_region_simplify(r, 1.5, &s, &err));
  assert_int_equal(vertices_of(s->loops[0]), 4);
  assert_int_equal(holds(s, 2, -0.5), 0);
  cag_region_release(s);
  cag_region_release(r);
  OK(cag_region_new(c, &h, 1, &r, &err));
  OK(cag_region_simplify(r, 1.5, &s, &err));
  assert_int_equal(s->count, 2);
  assert_int_equal(holds(s, 2, -0.9), 1);
  cag_region_release(s);
  cag_region_release(r);
  cag_curve_release(c);
  cag_curve_release(h);
}

static void arcs_of_regions_are_kept(void **state) {
  (void)state;
  CagRegion *r, *s;
  double area, after;
  OK(cag_region_rectangle(4, 3, 0.5, &r, &err));
  OK(cag_region_simplify(r, 0.1, &s, &err));
  OK(cag_region_area(r, &area, NULL, &err));
  OK(cag_region_area(s, &after, NULL, &err));
  NEAR(area, after, 0);
  cag_region_release(s);
  cag_region_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(vertices_within_the_tolerance_are_dropped),
      cmocka_unit_test(closed_polylines_keep_three_vertices),
      cmocka_unit_test(points_stay_within_the_tolerance),
      cmocka_unit_test(splines_lose_knots_that_they_do_not_need),
      cmocka_unit_test(regions_keep_their_topology),
      cmocka_unit_test(holes_stay_inside),
      cmocka_unit_test(arcs_of_regions_are_kept),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
