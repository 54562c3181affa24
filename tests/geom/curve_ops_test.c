// Splitting, elevating, refining and intersecting curves.

#include "geom/curve/intersect.h"
#include "geom/curve/nurbs_ops.h"
#include "support.h"

static const CagVec3 zigzag[6] = {{0, 1, 0},  {1, 2, 1}, {2.5, 0, 0.5},
                                  {4, 2, -1}, {5, 0, 0}, {6, 3, 1}};
static const double weights[6] = {1, 2, 0.5, 3, 1, 1.5};

static CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

static void same_curve(const CagCurve *a, const CagCurve *b) {
  assert_true(a->start == b->start && a->end == b->end);
  for (int k = 0; k <= 40; k++) {
    double t = k == 40 ? a->end : a->start + (a->end - a->start) * k / 40.0;
    near_vec(at(a, t), at(b, t), 1e-12);
  }
}

static size_t splines(CagCurve *out[6]) {
  static const double uneven[10] = {0, 0, 0, 0, 0.3, 0.3, 1, 1, 1, 1};
  double knots[16];
  OK(cag_curve_bezier(zigzag, weights, 6, 3, &out[0], &err));
  OK(cag_curve_nurbs(zigzag, NULL, 6, 3, uneven, 3, &out[1], &err));
  OK(cag_curve_nurbs(zigzag, weights, 6, 3, uneven, 3, &out[2], &err));
  OK(cag_knots_make("periodic", 6, 2, NULL, knots, &err));
  OK(cag_curve_nurbs(zigzag, weights, 6, 2, knots, 3, &out[3], &err));
  OK(cag_curve_nurbs_closed(zigzag, NULL, 6, 3, 3, &out[4], &err));
  OK(cag_curve_polyline(zigzag, 6, false, 3, &out[5], &err));
  return 6;
}

static void splitting_keeps_the_points(void **state) {
  (void)state;
  CagCurve *c[6], *half[2];
  size_t n = splines(c);
  for (size_t i = 0; i < n; i++) {
    double t = c[i]->start + 0.3 * (c[i]->end - c[i]->start);
    OK(cag_curve_split(c[i], t, half, &err));
    for (int k = 0; k < 2; k++)
      for (int s = 0; s < 10; s++) {
        double u = half[k]->start + (half[k]->end - half[k]->start) * s / 10.0;
        near_vec(at(half[k], u), at(c[i], u), 1e-12);
      }
    FAILS(cag_curve_split(c[i], c[i]->start, half, &err), "parameter-range");
    cag_curve_release(half[0]);
    cag_curve_release(half[1]);
    cag_curve_release(c[i]);
  }
}

static void elevating_keeps_the_points_and_the_smoothness(void **state) {
  (void)state;
  CagCurve *c[6], *up;
  size_t n = splines(c);
  for (size_t i = 0; i < n; i++) {
    for (int times = 0; times < 4; times++) {
      CagNurbsView v;
      OK(cag_curve_elevate(c[i], times, &up, &err));
      same_curve(up, c[i]);
      assert_true(cag_curve_nurbs_view(up, &v));
      CagCurve *exact;
      CagNurbsView w;
      OK(cag_curve_to_nurbs(c[i], &exact, &err));
      cag_curve_nurbs_view(exact, &w);
      assert_int_equal(v.degree, w.degree + times);
      cag_curve_release(exact);
      cag_curve_release(up);
    }
    cag_curve_release(c[i]);
  }
}

// Reference 05b, 5: example 18's curve elevated.
static void elevation_of_a_spline_is_that_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 b[4] = {{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}};
  static const double knots[7] = {0, 0, 0, 1, 2, 2, 2};
  static const double z[10] = {0, 0, 0, 0, 1, 1, 2, 2, 2, 2};
  static const double q[6][2] = {{0, 0},        {2.0 / 3, 2.0 / 3}, {7.0 / 6, 1},
                                 {11.0 / 6, 1}, {7.0 / 3, 2.0 / 3}, {3, 0}};
  CagCurve *c, *up;
  CagNurbsView v;
  OK(cag_curve_nurbs(b, NULL, 4, 2, knots, 2, &c, &err));
  OK(cag_curve_elevate(c, 1, &up, &err));
  assert_true(cag_curve_nurbs_view(up, &v));
  assert_int_equal(v.count, 6);
  assert_memory_equal(v.knots, z, sizeof z);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 2; k++) NEAR(v.homogeneous[4 * i + k], q[i][k], 1e-15);
  cag_curve_release(c);
  cag_curve_release(up);
}

// Reference 05b, example 18: midpoints into [0 0 0 2 4 4 4].
static void midpoints_give_the_points_of_the_reference(void **state) {
  (void)state;
  static const CagVec3 b[4] = {{0, 0, 0}, {1, 1, 0}, {2, 1, 0}, {3, 0, 0}};
  static const double knots[7] = {0, 0, 0, 2, 4, 4, 4}, y[9] = {0, 0, 0, 1, 2, 3, 4, 4, 4};
  static const double q[6][2] = {{0, 0}, {0.5, 0.5}, {1.25, 1}, {1.75, 1}, {2.5, 0.5}, {3, 0}};
  CagCurve *c, *fine;
  CagNurbsView v;
  OK(cag_curve_nurbs(b, NULL, 4, 2, knots, 2, &c, &err));
  OK(cag_curve_insert_midpoints(c, &fine, &err));
  assert_true(cag_curve_nurbs_view(fine, &v));
  assert_int_equal(v.count, 6);
  assert_memory_equal(v.knots, y, sizeof y);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 2; k++) NEAR(v.homogeneous[4 * i + k], q[i][k], 1e-15);
  cag_curve_release(fine);
  const double twice[3] = {1, 1, 1}, outside = 5;
  FAILS_AT(cag_curve_insert_knots(c, twice, 3, &fine, &err), "knot-multiplicity", 2);
  FAILS(cag_curve_insert_knots(c, &outside, 1, &fine, &err), "parameter-range");
  cag_curve_release(c);
}

static void insertion_keeps_the_points(void **state) {
  (void)state;
  CagCurve *c[6], *fine;
  size_t n = splines(c);
  for (size_t i = 0; i < n; i++) {
    double t[3];
    for (int k = 0; k < 3; k++) t[k] = c[i]->start + (c[i]->end - c[i]->start) * (0.71 - 0.2 * k);
    OK(cag_curve_insert_knots(c[i], t, 3, &fine, &err));
    same_curve(fine, c[i]);
    cag_curve_release(fine);
    cag_curve_release(c[i]);
  }
}

static void bezier_pieces_are_the_curve(void **state) {
  (void)state;
  CagCurve *c[6], **pieces;
  size_t n = splines(c), m;
  for (size_t i = 0; i < n; i++) {
    OK(cag_curve_to_bezier(c[i], &pieces, &m, &err));
    double cuts[16];
    size_t breaks = c[i]->kind->breaks(c[i], cuts + 1, 14);
    assert_int_equal(m, breaks + 1);
    cuts[0] = c[i]->start;
    cuts[m] = c[i]->end;
    for (size_t k = 0; k < m; k++) {
      near_vec(at(pieces[k], 0.3), at(c[i], cuts[k] + 0.3 * (cuts[k + 1] - cuts[k])), 1e-12);
      assert_string_equal(pieces[k]->kind->name, "bezier");
      cag_curve_release(pieces[k]);
    }
    free(pieces);
    cag_curve_release(c[i]);
  }
}

// --- Intersections ---

static CagCurve *circle(double r, double x, double y) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

// A helix of 3 turns and pitch 2 crosses the plane x = 0 at the odd quarter turns, and the plane
// x = radius touches it at the whole turns.
static void a_helix_meets_planes(void **state) {
  (void)state;
  CagCurve *c;
  CagPlane plane;
  CagMeeting *m;
  size_t n;
  OK(cag_curve_helix(1.5, 2, 3, 0, &c, &err));
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
  assert_int_equal(n, 6);
  for (size_t i = 0; i < n; i++) NEAR(m[i].t, M_PI / 2 + (double)i * M_PI, 1e-12);
  free(m);
  OK(cag_plane(cag_vec3(1.5, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) NEAR(m[i].t, 2 * M_PI * (double)i, 1e-6);
  free(m);
  OK(cag_plane(cag_vec3(2, 0, 0), cag_vec3(1, 0, 0), &plane, &err));
  OK(cag_curve_intersect_plane(c, &plane, &m, &n, &err));
  assert_int_equal(n, 0);
  free(m);
  cag_curve_release(c);
  c = circle(1, 0, 0);
  OK(cag_plane(cag_vec3(0, 0, 0), cag_vec3(0, 0, 1), &plane, &err));
  FAILS(cag_curve_intersect_plane(c, &plane, &m, &n, &err), "overlap");
  cag_curve_release(c);
}

// Circles of radius 5 about (0, 0) and (6, 0) meet at (3, +-4); tangent ones once.
static void circles_meet(void **state) {
  (void)state;
  CagCurve *a = circle(5, 0, 0), *b = circle(5, 6, 0), *t = circle(2, 7, 0),
           *far = circle(1, 20, 0);
  CagMeeting *m;
  size_t n;
  OK(cag_curve_intersect(a, b, &m, &n, &err));
  assert_int_equal(n, 2);
  near_vec(m[0].point, cag_vec3(3, 4, 0), 1e-12);
  near_vec(m[1].point, cag_vec3(3, -4, 0), 1e-12);
  NEAR(m[0].t2, M_PI - atan2(4, 3), 1e-12);
  free(m);
  OK(cag_curve_intersect(a, t, &m, &n, &err));
  assert_int_equal(n, 1); // the seam of the first counts once
  near_vec(m[0].point, cag_vec3(5, 0, 0), 1e-6);
  free(m);
  OK(cag_curve_intersect(a, far, &m, &n, &err));
  assert_int_equal(n, 0);
  free(m);
  FAILS(cag_curve_intersect(a, a, &m, &n, &err), "overlap");
  CagCurve *all[4] = {a, b, t, far};
  for (int i = 0; i < 4; i++) cag_curve_release(all[i]);
}

// Two cubics with nine intersections (Bezout's bound), on y = x^3 - x and x = y^3 - y scaled to
// meet nine times: T3(x) = y, T3(y) = x with the Chebyshev polynomial T3 has all nine at cosines.
static void two_cubics_meet_nine_times(void **state) {
  (void)state;
  CagVec3 p[4], q[4];
  // (x, 4 x^3 - 3 x) over -1.1..1.1 by blossoms: y = 4 abc - (a + b + c).
  for (int i = 0; i < 4; i++) {
    double a = i > 0 ? 1.1 : -1.1, b = i > 1 ? 1.1 : -1.1, c = i > 2 ? 1.1 : -1.1;
    p[i] = cag_vec3((a + b + c) / 3, 4 * a * b * c - (a + b + c), 0);
    q[i] = cag_vec3(p[i].y, p[i].x, 0);
  }
  CagCurve *a, *b;
  CagMeeting *m;
  size_t n;
  OK(cag_curve_bezier(p, NULL, 4, 2, &a, &err));
  OK(cag_curve_bezier(q, NULL, 4, 2, &b, &err));
  OK(cag_curve_intersect(a, b, &m, &n, &err));
  assert_int_equal(n, 9);
  for (size_t i = 0; i < n; i++) {
    double x = m[i].point.x, y = m[i].point.y;
    NEAR(4 * x * x * x - 3 * x, y, 1e-11);
    NEAR(4 * y * y * y - 3 * y, x, 1e-11);
    if (i > 0) assert_true(m[i].t > m[i - 1].t + 1e-3);
  }
  free(m);
  cag_curve_release(a);
  cag_curve_release(b);
}

static void polylines_meet_at_vertices_once(void **state) {
  (void)state;
  static const CagVec3 v[3] = {{0, 0, 0}, {1, 1, 0}, {2, 0, 0}};
  CagCurve *a, *b;
  CagMeeting *m;
  size_t n;
  OK(cag_curve_polyline(v, 3, false, 2, &a, &err));
  OK(cag_curve_line(cag_vec3(1, -1, 0), cag_vec3(1, 3, 0), 2, &b, &err));
  OK(cag_curve_intersect(a, b, &m, &n, &err));
  assert_int_equal(n, 1);
  NEAR(m[0].t, 1, 1e-14);
  NEAR(m[0].t2, 0.5, 1e-14);
  free(m);
  cag_curve_release(a);
  cag_curve_release(b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(splitting_keeps_the_points),
      cmocka_unit_test(elevating_keeps_the_points_and_the_smoothness),
      cmocka_unit_test(elevation_of_a_spline_is_that_of_the_reference),
      cmocka_unit_test(midpoints_give_the_points_of_the_reference),
      cmocka_unit_test(insertion_keeps_the_points),
      cmocka_unit_test(bezier_pieces_are_the_curve),
      cmocka_unit_test(a_helix_meets_planes),
      cmocka_unit_test(circles_meet),
      cmocka_unit_test(two_cubics_meet_nine_times),
      cmocka_unit_test(polylines_meet_at_vertices_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
