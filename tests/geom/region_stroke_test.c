// Strokes, and offsets with corners of all kinds, compared with closed forms and distances.

#include "tests/geom/support.h"

#include "geom/curve/region_stroke.h"
#include "tests/geom/random.h"
#include "tests/geom/region_support.h"

#define LIMIT 2 // of miters

// The area that a join adds to the two strips of width d at a corner that turns by the angle.
static double join_area(CagJoin join, double turn, double d) {
  switch (join) {
  case CAG_JOIN_ROUND: return d * d * turn / 2;
  case CAG_JOIN_BEVEL: return d * d * sin(turn) / 2;
  case CAG_JOIN_MITER:
    if (1 / cos(turn / 2) <= LIMIT * (1 + 1e-12)) return d * d * tan(turn / 2);
    break;
  case CAG_JOIN_SQUARE: break;
  }
  return 2 * d * d * tan(turn / 4); // both extended strips, and the triangle between them
}

static CagCurve *path(const CagVec3 *p, size_t n, bool closed) {
  CagCurve *c;
  OK(cag_curve_polyline(p, n, closed, 2, &c, &err));
  return c;
}

static CagCurve *arc(double radius, double start, double end) {
  CagTransform frame = cag_transform_identity();
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(radius, radius, start, end, &frame, &c, &err));
  return c;
}

static double free_area(CagRegion *r) {
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  cag_region_release(r);
  return area;
}

// Takes ownership of the curve.
static CagRegion *stroked(CagCurve *c, double width, CagCap cap, CagJoin join) {
  const CagStroke s = {width, 1e-7, cap, {join, LIMIT}};
  CagRegion *r;
  const CagCurve *const curves[] = {c};
  OK(cag_region_stroke(curves, 1, &s, &r, &err));
  cag_curve_release(c);
  return r;
}

static void corners_of_offsets_have_the_chosen_join(void **state) {
  (void)state;
  for (size_t n = 3; n <= 8; n++)
    for (int join = CAG_JOIN_ROUND; join <= CAG_JOIN_SQUARE; join++) {
      const double radius = 3, d = 0.7, turn = 2 * M_PI / (double)n;
      const CagJoins joins = {join, LIMIT};
      CagRegion *r, *grown;
      double area, perimeter;
      OK(cag_region_regular_polygon(n, radius, &r, &err));
      OK(cag_region_area(r, &area, NULL, &err));
      OK(cag_region_perimeter(r, &perimeter, &err));
      OK(cag_region_offset_joined(r, d, 1e-7, &joins, &grown, &err));
      NEAR(free_area(grown), area + perimeter * d + (double)n * join_area(join, turn, d), 1e-11);
      cag_region_release(r);
    }
}

static void shrunk_holes_and_grown_notches_have_joins_too(void **state) {
  (void)state;
  const double s = 6, hole = 2, d = 0.5;
  const CagVec3 outline[] = {{0, 0, 0}, {s, 0, 0}, {s, s, 0}, {0, s, 0}},
                inner[] = {{2, 2, 0}, {2 + hole, 2, 0}, {2 + hole, 2 + hole, 0}, {2, 2 + hole, 0}};
  CagCurve *c = path(outline, 4, true), *h = path(inner, 4, true);
  CagRegion *r, *smaller;
  OK(cag_region_new(c, &h, 1, &r, &err));
  for (int join = CAG_JOIN_ROUND; join <= CAG_JOIN_SQUARE; join++) {
    const CagJoins joins = {join, LIMIT};
    OK(cag_region_offset_joined(r, -d, 1e-7, &joins, &smaller, &err));
    const double grown = hole * hole + 4 * hole * d + 4 * join_area(join, M_PI / 2, d);
    NEAR(free_area(smaller), (s - 2 * d) * (s - 2 * d) - grown, 1e-11);
  }
  cag_region_release(r);
  cag_curve_release(c);
  cag_curve_release(h);
}

static void a_segment_has_the_area_of_its_caps(void **state) {
  (void)state;
  const CagVec3 p[] = {{1, 2, 0}, {4, 6, 0}}; // length 5
  const double w = 0.8, caps[] = {M_PI * w * w / 4, 0, w * w};
  for (int cap = CAG_CAP_ROUND; cap <= CAG_CAP_SQUARE; cap++)
    NEAR(free_area(stroked(path(p, 2, false), w, cap, CAG_JOIN_ROUND)), 5 * w + caps[cap], 1e-12);
}

static void corners_of_strokes_have_the_chosen_join(void **state) {
  (void)state;
  // Both strips cover a kite at the inner side: h^2 tan(turn / 2).
  static const double turns[] = {0.3, 1, M_PI / 2, 2, 2.5};
  const double h = 0.2, length = 3;
  for (size_t i = 0; i < sizeof turns / sizeof *turns; i++)
    for (int side = -1; side <= 1; side += 2)
      for (int join = CAG_JOIN_ROUND; join <= CAG_JOIN_SQUARE; join++) {
        const double a = side * turns[i];
        const CagVec3 p[] = {
            {0, 0, 0}, {length, 0, 0}, {length + length * cos(a), length * sin(a), 0}};
        const double area = free_area(stroked(path(p, 3, false), 2 * h, CAG_CAP_BUTT, join));
        NEAR(area, 4 * h * length - h * h * tan(turns[i] / 2) + join_area(join, turns[i], h),
             1e-12);
      }
  // Straight back: the join is a cap.
  const CagVec3 back[] = {{0, 0, 0}, {3, 0, 0}, {1, 0, 0}};
  NEAR(free_area(stroked(path(back, 3, false), 2 * h, CAG_CAP_BUTT, CAG_JOIN_ROUND)),
       6 * h + M_PI * h * h / 2, 1e-12);
}

static void closed_curves_have_no_caps(void **state) {
  (void)state;
  const CagVec3 square[] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
  CagRegion *r = stroked(path(square, 4, true), 1, CAG_CAP_SQUARE, CAG_JOIN_MITER);
  assert_int_equal(r->count, 2);
  NEAR(free_area(r), 16 - 4, 1e-12);
  r = stroked(arc(2, 0, 2 * M_PI), 1, CAG_CAP_SQUARE, CAG_JOIN_MITER);
  assert_int_equal(r->count, 2);
  NEAR(free_area(r), M_PI * (2.5 * 2.5 - 1.5 * 1.5), 1e-11);
}

static void strokes_wider_than_a_circle_cover_its_center(void **state) {
  (void)state;
  NEAR(free_area(stroked(arc(1, 0, 2 * M_PI), 3, CAG_CAP_BUTT, CAG_JOIN_ROUND)), M_PI * 2.5 * 2.5,
       1e-11);
  // The normals of an arc sweep the sector of r + h, and the opposite one of h - r.
  const double r = 1, h = 1.5, turn = 1.2;
  NEAR(free_area(stroked(arc(r, 0.3, 0.3 + turn), 2 * h, CAG_CAP_BUTT, CAG_JOIN_ROUND)),
       turn * ((r + h) * (r + h) + (h - r) * (h - r)) / 2, 1e-11);
  CagCurve *c = arc(r, 0.3, 0.3 + turn), *back;
  OK(cag_curve_reverse(c, &back, &err));
  cag_curve_release(c);
  NEAR(free_area(stroked(back, 2 * h, CAG_CAP_BUTT, CAG_JOIN_ROUND)),
       turn * ((r + h) * (r + h) + (h - r) * (h - r)) / 2, 1e-11);
}

static void points_have_round_and_square_caps(void **state) {
  (void)state;
  const double areas[] = {M_PI, 0, 4};
  for (int cap = CAG_CAP_ROUND; cap <= CAG_CAP_SQUARE; cap++) {
    CagCurve *c;
    OK(cag_curve_resting(cag_vec3(1, 1, 0), 2, 0, 1, false, &c, &err));
    NEAR(free_area(stroked(c, 2, cap, CAG_JOIN_ROUND)), areas[cap], 1e-12);
    OK(cag_curve_line(cag_vec3(1, 1, 0), cag_vec3(1, 1, 0), 2, &c, &err));
    NEAR(free_area(stroked(c, 2, cap, CAG_JOIN_ROUND)), areas[cap], 1e-12);
  }
}

// A round stroke consists of the points within half of its width, whether the curve crosses itself
// or bends with a smaller radius.
static void round_strokes_are_the_points_within_half_of_the_width(void **state) {
  (void)state;
  enum { POINTS = 6, LOOKS = 20 };
  seed = 5;
  for (int round = 0; round < 12; round++) {
    CagVec3 p[POINTS];
    for (int i = 0; i < POINTS; i++) p[i] = cag_vec3(uniform(0, 4), uniform(0, 4), 0);
    CagCurve *c;
    double knots[POINTS + 4];
    if (round % 3 == 0) OK(cag_curve_polyline(p, POINTS, round % 2, 2, &c, &err));
    else if (round % 3 == 1) OK(cag_curve_nurbs_closed(p, NULL, POINTS, 3, 2, &c, &err));
    else {
      OK(cag_knots_make("open", POINTS, 3, p, knots, &err));
      OK(cag_curve_nurbs(p, NULL, POINTS, 3, knots, 2, &c, &err));
    }
    const double width = uniform(0.2, 1.6), tolerance = 1e-6;
    CagRegion *r = stroked(cag_curve_retain(c), width, CAG_CAP_ROUND, CAG_JOIN_ROUND);
    for (int i = 0; i < LOOKS * LOOKS; i++) {
      const CagVec3 q = {-1 + 6 * (i % LOOKS + 0.43) / LOOKS, -1 + 6 * (i / LOOKS + 0.57) / LOOKS,
                         0};
      double t, distance;
      CagVec3 there;
      OK(cag_curve_closest(c, q, &t, &there, &distance, &err));
      if (fabs(distance - width / 2) < 4 * tolerance) continue;
      assert_int_equal(holds(r, q.x, q.y), distance < width / 2);
    }
    cag_region_release(r);
    cag_curve_release(c);
  }
}

// Whether a normal of the curve reaches the point within the distance. *clear is false if that
// depends on a normal at an end of the curve or of the distance, or at a center of curvature.
static bool is_on_normal(const CagCurve *c, CagVec3 p, double most, bool *clear) {
  enum { STEPS = 4000 };
  const double near = 5e-3;
  bool found = false;
  double before = 0;
  *clear = true;
  for (int i = 0; i <= STEPS; i++) {
    CagVec3 d[2];
    OK(cag_curve_eval(c, c->start + (c->end - c->start) * i / STEPS, 1, CAG_SIDE_RIGHT, d, &err));
    const CagVec3 r = cag_sub(p, d[0]);
    const double f = cag_dot(r, cag_unit(d[1])), distance = cag_norm(r);
    const bool end = i == 0 || i == STEPS;
    // At a center of curvature, the component along the curve touches zero.
    if (fabs(f) < near && distance < most + near)
      *clear = *clear && !end && fabs(distance - most) > near && fabs(f - before) > 1e-5;
    if (i > 0 && (f > 0) != (before > 0) && distance <= most) found = true;
    before = f;
  }
  return found;
}

static void butt_strokes_consist_of_normals(void **state) {
  (void)state;
  enum { LOOKS = 40 };
  // y = x^2, whose radius of curvature is 1/2 at the origin; and a part of it that bends everywhere.
  const CagVec3 whole[] = {{-1, 1, 0}, {0, -1, 0}, {1, 1, 0}},
                part[] = {{-0.2, 0.04, 0}, {0.1, -0.08, 0}, {0.4, 0.16, 0}};
  for (int k = 0; k < 4; k++) {
    CagCurve *c;
    const double width = k / 2 ? 3 : 1.6;
    int looks = 0;
    OK(cag_curve_bezier(k % 2 ? whole : part, NULL, 3, 2, &c, &err));
    CagRegion *r = stroked(cag_curve_retain(c), width, CAG_CAP_BUTT, CAG_JOIN_ROUND);
    for (int i = 0; i < LOOKS * LOOKS; i++) {
      const CagVec3 p = {-2.5 + 5 * (i % LOOKS + 0.43) / LOOKS, -2 + 5 * (i / LOOKS + 0.57) / LOOKS,
                         0};
      bool clear;
      const bool in = is_on_normal(c, p, width / 2, &clear);
      if (!clear) continue;
      looks++;
      if (holds(r, p.x, p.y) != in) fail_msg("stroke %d at [%g, %g]: %d", k, p.x, p.y, !in);
    }
    assert_true(looks > LOOKS * LOOKS / 2);
    cag_region_release(r);
    cag_curve_release(c);
  }
}

// A notch whose bottom bends with a radius below the distance.
static void offsets_of_tight_bends_have_the_chosen_join(void **state) {
  (void)state;
  const CagVec3 bottom[] = {{1, 2, 0}, {0.9, 1, 0}, {0.1, 1, 0}, {0, 2, 0}};
  const CagVec3 rest[] = {{0, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {3, -2, 0}, {3, 2, 0}, {1, 2, 0}};
  CagCurve *parts[2], *loop;
  OK(cag_curve_bezier(bottom, NULL, 4, 2, &parts[0], &err));
  OK(cag_curve_polyline(rest, 6, false, 2, &parts[1], &err));
  OK(cag_curve_join(parts, 2, &loop, &err));
  CagRegion *r, *grown;
  OK(cag_region_new(loop, NULL, 0, &r, &err));
  const double d = 1;
  for (int join = CAG_JOIN_MITER; join <= CAG_JOIN_SQUARE; join++) {
    const CagJoins joins = {join, LIMIT};
    OK(cag_region_offset_joined(r, d, 1e-6, &joins, &grown, &err));
    assert_int_equal(grown->count, 1);
    double area;
    OK(cag_region_area(grown, &area, NULL, &err));
    // The notch is filled. Between its corners, which are nearly right angles, bevels leave a right
    // triangle with the hypotenuse 1 open, and squares one with 1 - 2 tan(22.5 deg).
    const double base = join == CAG_JOIN_BEVEL ? 1 : 1 - 2 * tan(M_PI / 8),
                 open = join == CAG_JOIN_MITER ? 0 : base * base / 4;
    NEAR(area, 5 * 4 + 18 * d + 4 * join_area(join, M_PI / 2, d) - open, 0.05);
    cag_region_release(grown);
  }
  cag_region_release(r);
  cag_curve_release(loop);
  for (int i = 0; i < 2; i++) cag_curve_release(parts[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corners_of_offsets_have_the_chosen_join),
      cmocka_unit_test(shrunk_holes_and_grown_notches_have_joins_too),
      cmocka_unit_test(a_segment_has_the_area_of_its_caps),
      cmocka_unit_test(corners_of_strokes_have_the_chosen_join),
      cmocka_unit_test(closed_curves_have_no_caps),
      cmocka_unit_test(strokes_wider_than_a_circle_cover_its_center),
      cmocka_unit_test(points_have_round_and_square_caps),
      cmocka_unit_test(butt_strokes_consist_of_normals),
      cmocka_unit_test(offsets_of_tight_bends_have_the_chosen_join),
      cmocka_unit_test(round_strokes_are_the_points_within_half_of_the_width),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
