// Knot removal, degree reduction, bases as data, approximation, offsets, and curves against
// surfaces.

#include "geom/basis/basis_table.h"
#include "geom/curve/approximate.h"
#include "geom/curve/intersect.h"
#include "geom/curve/nurbs_ops.h"
#include "geom/meet/meet_curve.h"
#include "meet_support.h"

static const CagVec3 zigzag[6] = {{0, 1, 0},  {1, 2, 1}, {2.5, 0, 0.5},
                                  {4, 2, -1}, {5, 0, 0}, {6, 3, 1}};
static const double weights[6] = {1, 2, 0.5, 3, 1, 1.5};
static const double uneven[10] = {0, 0, 0, 0, 0.3, 0.3, 1, 1, 1, 1};

static void same_curve(const CagCurve *a, const CagCurve *b, double tolerance) {
  double gap;
  assert_true(a->start == b->start && a->end == b->end);
  OK(cag_curve_deviation(a, b, &gap, &err));
  NEAR(gap, 0, tolerance);
}

static void removing_an_inserted_knot_gives_the_curve_back(void **state) {
  (void)state;
  for (int rational = 0; rational < 2; rational++) {
    CagCurve *c, *more, *back;
    CagNurbsView was, is;
    const double t[3] = {0.5, 0.5, 0.7};
    double deviation;
    OK(cag_curve_nurbs(zigzag, rational ? weights : NULL, 6, 3, uneven, 3, &c, &err));
    OK(cag_curve_insert_knots(c, t, 3, &more, &err));
    OK(cag_curve_remove_knot(more, 0.5, 2, 1e-9, &back, &deviation, &err));
    NEAR(deviation, 0, 1e-12);
    cag_curve_release(more);
    OK(cag_curve_remove_knot(back, 0.7, 1, 1e-9, &more, &deviation, &err));
    assert_true(cag_curve_nurbs_view(c, &was) && cag_curve_nurbs_view(more, &is));
    assert_int_equal(is.count, was.count);
    for (size_t i = 0; i < 4 * is.count; i++) NEAR(is.homogeneous[i], was.homogeneous[i], 1e-12);
    cag_curve_release(c);
    cag_curve_release(more);
    cag_curve_release(back);
  }
}

// The deviation of a removal is bounded by the reported one, and by the tolerance.
static void removing_a_knot_tells_what_it_moves(void **state) {
  (void)state;
  for (int rational = 0; rational < 2; rational++) {
    CagCurve *c, *less;
    double deviation, gap;
    OK(cag_curve_nurbs(zigzag, rational ? weights : NULL, 6, 3, uneven, 3, &c, &err));
    FAILS(cag_curve_remove_knot(c, 0.3, 1, 1e-3, &less, NULL, &err), "tolerance-exceeded");
    FAILS(cag_curve_remove_knot(c, 0.4, 1, 1, &less, NULL, &err), "no-such-knot");
    FAILS(cag_curve_remove_knot(c, 0.3, 3, 1, &less, NULL, &err), "no-such-knot");
    OK(cag_curve_remove_knot(c, 0.3, 1, INFINITY, &less, &deviation, &err));
    OK(cag_curve_deviation(c, less, &gap, &err));
    assert_true(gap > 0 && gap <= deviation * (1 + 1e-12));
    cag_curve_release(c);
    cag_curve_release(less);
  }
}

static void reducing_an_elevated_curve_gives_it_back(void **state) {
  (void)state;
  for (int rational = 0; rational < 2; rational++) {
    CagCurve *c, *up, *down;
    CagNurbsView was, is;
    double deviation;
    OK(cag_curve_nurbs(zigzag, rational ? weights : NULL, 6, 3, uneven, 3, &c, &err));
    OK(cag_curve_elevate(c, 1, &up, &err));
    OK(cag_curve_reduce_degree(up, 1e-9, &down, &deviation, &err));
    NEAR(deviation, 0, 1e-12);
    same_curve(c, down, 1e-12);
    assert_true(cag_curve_nurbs_view(c, &was) && cag_curve_nurbs_view(down, &is));
    assert_int_equal(is.degree, 3);
    assert_int_equal(is.count, was.count);
    cag_curve_release(c);
    cag_curve_release(up);
    cag_curve_release(down);
  }
}

// A parabola with a control point of height 2 has height 1, which is its largest distance from the
// chord. The control points differ by 2.
static void reducing_tells_what_it_moves(void **state) {
  (void)state;
  static const CagVec3 v[3] = {{0, 0, 0}, {1, 2, 0}, {2, 0, 0}};
  CagCurve *c, *down;
  double deviation, gap;
  OK(cag_curve_bezier(v, NULL, 3, 2, &c, &err));
  FAILS(cag_curve_reduce_degree(c, 0.5, &down, NULL, &err), "tolerance-exceeded");
  OK(cag_curve_reduce_degree(c, INFINITY, &down, &deviation, &err));
  OK(cag_curve_deviation(c, down, &gap, &err));
  NEAR(gap, 1, 1e-9);
  NEAR(deviation, 2, 1e-12);
  cag_curve_release(c);
  FAILS(cag_curve_reduce_degree(down, 1, &c, NULL, &err), "order-range");
  cag_curve_release(down);
}

// (t, t^3 - t) over [-1, 1] is farthest from (t, 0) at t = 1 / sqrt 3, between two samples.
static void the_largest_gap_lies_between_samples(void **state) {
  (void)state;
  static const CagVec3 wave[4] = {
      {-1, 0, 0}, {-1. / 3, 4. / 3, 0}, {1. / 3, -4. / 3, 0}, {1, 0, 0}};
  static const CagVec3 flat[2] = {{-1, 0, 0}, {1, 0, 0}};
  for (int k = 0; k < 3; k++) {
    CagCurve *made[2], *c[2];
    double gap;
    OK(cag_curve_bezier(wave, NULL, 4, 2, &made[0], &err));
    OK(cag_curve_bezier(flat, NULL, 2, 2, &made[1], &err));
    for (int i = 0; i < 2; i++) {
      OK(cag_curve_reparametrize(made[i], k - 1, k == 0 ? 1 : 2 * k + 3, &c[i], &err));
      cag_curve_release(made[i]);
    }
    OK(cag_curve_deviation(c[0], c[1], &gap, &err));
    NEAR(gap, 2 / (3 * sqrt(3)), 1e-9);
    cag_curve_release(c[0]);
    cag_curve_release(c[1]);
  }
}

static void midpoints_keep_uniform_and_closed_curves(void **state) {
  (void)state;
  CagCurve *c, *fine;
  CagNurbsView is;
  double knots[16];
  OK(cag_knots_make("periodic", 6, 3, NULL, knots, &err));
  OK(cag_curve_nurbs(zigzag, weights, 6, 3, knots, 3, &c, &err));
  OK(cag_curve_insert_midpoints(c, &fine, &err));
  assert_true(cag_curve_nurbs_view(fine, &is));
  assert_string_equal(cag_knots_class(is.knots, is.count, 3), "uniform");
  same_curve(c, fine, 1e-12);
  cag_curve_release(c);
  cag_curve_release(fine);
  for (int rational = 0; rational < 2; rational++) {
    OK(cag_curve_nurbs_closed(zigzag, rational ? weights : NULL, 6, 3, 3, &c, &err));
    OK(cag_curve_insert_midpoints(c, &fine, &err));
    assert_true(cag_curve_nurbs_view(fine, &is) && is.periodic);
    assert_int_equal(is.distinct, 12);
    same_curve(c, fine, 1e-12);
    cag_curve_release(c);
    cag_curve_release(fine);
  }
}

static void derivatives_of_the_basis_are_those_of_its_pieces(void **state) {
  (void)state;
  enum { P = 3, COUNT = 12, N = COUNT - P - 1 };
  static const double knots[COUNT] = {0, 0, 1, 2, 2, 3, 4.5, 5, 5, 6, 7, 7};
  for (double t = 0.05; t < 7; t += 0.3) {
    size_t at;
    double work[P + 2], value[N], piece[(P + 1) * (P + 1)];
    OK(cag_basis_interval(knots, COUNT, P, t, false, &at, &err));
    cag_basis_piece(knots, COUNT, P, at, true, piece);
    for (int d = 0; d <= P; d++) {
      cag_basis_derivative(knots, COUNT, P, at, t, d, work, value);
      for (size_t i = 0; i < N; i++) {
        double expected = 0;
        if (i + P >= at && i <= at)
          for (int k = P; k >= d; k--) {
            double falling = 1;
            for (int m = 0; m < d; m++) falling *= k - m;
            expected +=
                falling * piece[(i + P - at) * (P + 1) + (size_t)k] * pow(t - knots[at], k - d);
          }
        NEAR(value[i], expected, 1e-12);
      }
    }
  }
}

static void an_approximated_helix_is_within_the_tolerance(void **state) {
  (void)state;
  CagCurve *h, *c;
  double gap;
  OK(cag_curve_helix(10, 5, 3, 1, &h, &err));
  for (double tolerance = 1; tolerance > 1e-9; tolerance /= 30) {
    OK(cag_curve_approximate(h, tolerance, &c, &err));
    OK(cag_curve_deviation(h, c, &gap, &err));
    assert_true(gap <= tolerance);
    cag_curve_release(c);
  }
  FAILS(cag_curve_approximate(h, 0, &c, &err), "value");
  cag_curve_release(h);
}

// The largest deviation of the distance to c from |d|, over samples of the offset.
static double offset_error(const CagCurve *c, const CagCurve *o, double d) {
  double most = 0;
  for (int i = 0; i <= 400; i++) {
    CagVec3 p;
    double distance;
    OK(cag_curve_point(o, o->start + (o->end - o->start) * i / 400, &p, &err));
    OK(cag_curve_closest(c, p, NULL, NULL, &distance, &err));
    most = fmax(most, fabs(distance - fabs(d)));
  }
  return most;
}

static void offsets_keep_their_distance(void **state) {
  (void)state;
  static const CagVec3 v[4] = {{0, 0, 0}, {10, 8, 0}, {20, -8, 0}, {30, 0, 0}};
  CagCurve *c, *o;
  OK(cag_curve_bezier(v, NULL, 4, 2, &c, &err));
  for (int side = -1; side < 2; side += 2) {
    OK(cag_curve_offset(c, side * 0.8, 1e-6, &o, &err));
    NEAR(offset_error(c, o, 0.8), 0, 1e-6);
    cag_curve_release(o);
  }
  OK(cag_curve_offset(c, 0, 1e-6, &o, &err));
  assert_ptr_equal(o, c);
  cag_curve_release(o);
  cag_curve_release(c);
  OK(cag_curve_bezier(v, NULL, 4, 3, &c, &err));
  FAILS(cag_curve_offset(c, 1, 1e-6, &o, &err), "not-planar");
  cag_curve_release(c);
}

static void offsets_of_circles_are_circles(void **state) {
  (void)state;
  CagCurve *c, *o, *back;
  CagTransform frame = cag_translate(cag_vec3(3, -2, 0));
  frame.planar = true;
  double length;
  OK(cag_curve_arc(5, 5, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_curve_offset(c, 2, 1e-6, &o, &err)); // to the left is inward
  OK(cag_curve_length(o, o->start, o->end, &length, &err));
  NEAR(length, 6 * M_PI, 1e-12);
  assert_string_equal(o->kind->name, c->kind->name);
  cag_curve_release(o);
  OK(cag_curve_reverse(c, &back, &err));
  OK(cag_curve_offset(back, 2, 1e-6, &o, &err));
  OK(cag_curve_length(o, o->start, o->end, &length, &err));
  NEAR(length, 14 * M_PI, 1e-12);
  cag_curve_release(o);
  cag_curve_release(back);
  FAILS(cag_curve_offset(c, 5, 1e-6, &o, &err), "offset-collapses");
  cag_curve_release(c);
}

// A half disk of radius 5. The outer offset is a line, a half circle of radius 6, and two quarter
// circles. Inside, the line at y = 1 and the arc of radius 4 are trimmed where they meet.
static void corners_go_round_the_outside_and_are_cut_inside(void **state) {
  (void)state;
  static const CagVec3 v[4] = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}};
  CagCurve *side[2], *c, *o;
  CagTransform frame = cag_transform_identity();
  frame.planar = true;
  double length;
  OK(cag_curve_line(cag_vec3(-5, 0, 0), cag_vec3(5, 0, 0), 2, &side[0], &err));
  OK(cag_curve_arc(5, 5, 0, M_PI, &frame, &side[1], &err));
  OK(cag_curve_join(side, 2, &c, &err));
  OK(cag_curve_offset(c, -1, 1e-6, &o, &err));
  OK(cag_curve_length(o, o->start, o->end, &length, &err));
  NEAR(length, 10 + 7 * M_PI, 1e-11);
  assert_true(o->closed);
  cag_curve_release(o);
  OK(cag_curve_offset(c, 1, 1e-6, &o, &err));
  OK(cag_curve_length(o, o->start, o->end, &length, &err));
  NEAR(length, 2 * sqrt(15) + 4 * (M_PI - 2 * asin(0.25)), 1e-11);
  assert_true(o->closed);
  cag_curve_release(o);
  FAILS(cag_curve_offset(c, 5, 1e-6, &o, &err), "offset-collapses");
  cag_curve_release(c);
  for (int i = 0; i < 2; i++) cag_curve_release(side[i]);
  // For a polyline, the outer offset has corners, too.
  OK(cag_curve_polyline(v, 4, true, 2, &c, &err));
  OK(cag_curve_offset(c, -1, 1e-6, &o, &err));
  OK(cag_curve_length(o, o->start, o->end, &length, &err));
  NEAR(length, 48, 1e-11);
  cag_curve_release(o);
  cag_curve_release(c);
}

static void joining_keeps_the_knots_of_the_parts(void **state) {
  (void)state;
  static const CagVec3 v[4] = {{6, 3, 1}, {7, 4, 0}, {8, 1, 0}, {9, 2, 2}};
  CagCurve *part[2], *joined, *exact;
  CagNurbsView is;
  OK(cag_curve_nurbs(zigzag, weights, 6, 3, uneven, 3, &part[0], &err));
  OK(cag_curve_bezier(v, NULL, 4, 3, &part[1], &err));
  OK(cag_curve_join(part, 2, &joined, &err));
  OK(cag_curve_to_nurbs(joined, &exact, &err));
  same_curve(joined, exact, 1e-12);
  assert_true(cag_curve_nurbs_view(exact, &is));
  assert_int_equal(is.count, 9); // 6 + 4 minus the joint
  cag_curve_release(exact);
  cag_curve_release(joined);
  cag_curve_release(part[0]);
  cag_curve_release(part[1]);
}

// --- Curves against surfaces ---

static void lines_meet_a_torus_in_up_to_four_points(void **state) {
  (void)state;
  CagSurface *s;
  OK(cag_surface_torus(10, 3, &s, &err));
  // A line along x at various heights through a torus meets it in 4 points through the hole, 2 at
  // the side, and none beyond.
  static const struct {
    CagVec3 p, q;
    size_t n;
  } lines[] = {{{-20, 0.3, 0.1}, {20, 0.3, 0.2}, 4},
               {{-20, 9, 0}, {20, 9, 0}, 2},
               {{-20, 13.1, 0}, {20, 13.1, 0}, 0},
               {{-20, 0, 3.1}, {20, 0, 3.1}, 0},
               {{-20, 0, 2}, {20, 0, 2}, 4},
               {{10, 0, -9}, {10, 0, 9}, 2},
               {{0, 0, -9}, {0, 0, 9}, 0}};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    CagCurve *c;
    OK(cag_curve_line(lines[i].p, lines[i].q, 3, &c, &err));
    size_t n = meetings(s, c, 1e-7, 0);
    if (n != lines[i].n) fail_msg("line %zu: %zu meetings, not %zu", i, n, lines[i].n);
    cag_curve_release(c);
  }
  cag_surface_release(s);
}

// A helix of radius 3 about the y axis crosses a bicubic patch wherever its height does. The patch
// is a plane here, and the crossings are counted as sign changes of dense samples of y = f(x, z).
static void a_helix_meets_a_patch_as_often_as_its_plane(void **state) {
  (void)state;
  CagSurface *s;
  CagCurve *h, *c;
  OK(cag_surface_bilinear(cag_vec3(-20, -20, 4), cag_vec3(-20, 20, 6), cag_vec3(20, -20, 12),
                          cag_vec3(20, 20, 14), &s, &err));
  OK(cag_curve_helix(8, 2, 10, 0, &h, &err));
  CagPlane plane = {{-20, -20, 4}, {0, 0, 0}};
  plane.normal = cag_unit(cag_cross(cag_vec3(40, 0, 8), cag_vec3(0, 40, 2)));
  CagMeeting *m;
  size_t n;
  OK(cag_curve_intersect_plane(h, &plane, &m, &n, &err));
  assert_true(n >= 3);
  assert_int_equal(meetings(s, h, 1e-7, 0), n);
  free(m);
  cag_curve_release(h);
  // A line that lies in the surface.
  OK(cag_curve_line(cag_vec3(-20, -20, 4), cag_vec3(20, 20, 14), 3, &c, &err));
  CagSurfaceMeeting *none;
  FAILS(cag_surface_intersect_curve(s, c, &none, &n, &err), "overlap");
  cag_curve_release(c);
  cag_surface_release(s);
}

// The largest distance between two polylines is at a corner of one of them, at the same fraction of
// their domains.
static void deviations_of_polylines_are_at_their_corners(void **state) {
  (void)state;
  enum { MOST = 12 };
  seed = 861;
  for (int round = 0; round < 200; round++) {
    CagVec3 p[2][MOST];
    CagCurve *c[2];
    size_t n[2];
    for (int k = 0; k < 2; k++) {
      n[k] = 2 + (size_t)uniform(0, MOST - 2);
      for (size_t i = 0; i < n[k]; i++) {
        p[k][i].x = uniform(-3, 3);
        p[k][i].y = uniform(-3, 3);
        p[k][i].z = uniform(-3, 3);
      }
      OK(cag_curve_polyline(p[k], n[k], false, 3, &c[k], &err));
    }
    double expected = 0, gap;
    for (int k = 0; k < 2; k++)
      for (size_t i = 0; i < n[k]; i++) {
        const double part = (double)i / (double)(n[k] - 1);
        const double place = part * (double)(n[1 - k] - 1);
        const size_t from = place < (double)(n[1 - k] - 2) ? (size_t)place : n[1 - k] - 2;
        const CagVec3 there = cag_lerp(p[1 - k][from], p[1 - k][from + 1], place - (double)from);
        expected = fmax(expected, cag_norm(cag_sub(p[k][i], there)));
      }
    for (int k = 0; k < 2; k++) {
      OK(cag_curve_deviation(c[k], c[1 - k], &gap, &err));
      NEAR(gap, expected, 1e-13);
    }
    cag_curve_release(c[0]);
    cag_curve_release(c[1]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(removing_an_inserted_knot_gives_the_curve_back),
      cmocka_unit_test(removing_a_knot_tells_what_it_moves),
      cmocka_unit_test(reducing_an_elevated_curve_gives_it_back),
      cmocka_unit_test(reducing_tells_what_it_moves),
      cmocka_unit_test(the_largest_gap_lies_between_samples),
      cmocka_unit_test(midpoints_keep_uniform_and_closed_curves),
      cmocka_unit_test(derivatives_of_the_basis_are_those_of_its_pieces),
      cmocka_unit_test(an_approximated_helix_is_within_the_tolerance),
      cmocka_unit_test(offsets_keep_their_distance),
      cmocka_unit_test(offsets_of_circles_are_circles),
      cmocka_unit_test(corners_go_round_the_outside_and_are_cut_inside),
      cmocka_unit_test(joining_keeps_the_knots_of_the_parts),
      cmocka_unit_test(lines_meet_a_torus_in_up_to_four_points),
      cmocka_unit_test(a_helix_meets_a_patch_as_often_as_its_plane),
      cmocka_unit_test(deviations_of_polylines_are_at_their_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
