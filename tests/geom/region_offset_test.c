// Offsets of regions with loops of all kinds, compared with the distances of points.

#include "tests/geom/random.h"
#include "tests/geom/region_support.h"

static CagVec3 polar(CagVec3 center, double radius, double angle) {
  return cag_madd(center, radius, cag_vec3(cos(angle), sin(angle), 0));
}

// A single piece whose ends meet at a corner.
static CagCurve *drop_at(CagVec3 center) {
  const double turn = uniform(-M_PI, M_PI), open = uniform(0.3, 1.4), longest = uniform(3, 6);
  const CagVec3 p[4] = {center, polar(center, longest, turn - open),
                        polar(center, 0.8 * longest, turn + open), center};
  CagCurve *c;
  OK(cag_curve_bezier(p, NULL, 4, 2, &c, &err));
  return c;
}

// A closed spline of degree 2 or 3 with a smooth seam.
static CagCurve *blob_at(CagVec3 center, int degree) {
  enum { POINTS = 7 };
  CagVec3 p[POINTS];
  double w[POINTS];
  for (int i = 0; i < POINTS; i++) {
    p[i] = polar(center, uniform(1, 2.5), 2 * M_PI * i / POINTS);
    w[i] = uniform(0.5, 2);
  }
  CagCurve *c;
  OK(cag_curve_nurbs_closed(p, degree == 2 ? w : NULL, POINTS, degree, 2, &c, &err));
  return c;
}

// An ellipse, rotated and possibly reflected, with any start.
static CagCurve *ellipse_at(CagVec3 center, bool mirrored) {
  const double turn = uniform(-M_PI, M_PI), a = uniform(1, 3), from = uniform(-3, 3);
  const double b = a * uniform(0.3, 1), c = cos(turn), s = sin(turn), sense = mirrored ? -1 : 1;
  CagTransform frame = cag_translate(center);
  frame.m[0][0] = c;
  frame.m[1][0] = s;
  frame.m[0][1] = -sense * s;
  frame.m[1][1] = sense * c;
  frame.planar = true;
  CagCurve *out;
  OK(cag_curve_arc(a, b, from, from + 2 * M_PI, &frame, &out, &err));
  return out;
}

// A part of a circle or an ellipse, closed by its chord or by two lines to the center.
static CagCurve *segment_at(CagVec3 center, bool round, bool sector) {
  const double from = uniform(-3, 3), turn = uniform(0.8, 5.5), a = uniform(1.5, 2.5);
  const double b = round ? a : a * uniform(0.4, 1);
  CagTransform frame = cag_translate(center);
  frame.planar = true;
  CagCurve *parts[2], *out;
  OK(cag_curve_arc(a, b, from, from + turn, &frame, &parts[0], &err));
  CagVec3 p[3] = {{0, 0, 0}, center, {0, 0, 0}};
  OK(cag_curve_point(parts[0], parts[0]->end, &p[0], &err));
  OK(cag_curve_point(parts[0], parts[0]->start, &p[2], &err));
  if (!sector) p[1] = p[2];
  OK(cag_curve_polyline(p, sector ? 3 : 2, false, 2, &parts[1], &err));
  OK(cag_curve_join(parts, 2, &out, &err));
  cag_curve_release(parts[0]);
  cag_curve_release(parts[1]);
  return out;
}

enum { LOOPS = 8 };

static CagCurve *loop_at(CagVec3 center, int kind) {
  switch (kind) {
  case 0: return drop_at(center);
  case 1: return blob_at(center, 3);
  case 2: return blob_at(center, 2);
  case 3: return ellipse_at(center, false);
  case 4: return ellipse_at(center, true);
  case 5: return segment_at(center, true, false);
  case 6: return segment_at(center, false, true);
  default: return segment_at(center, true, true);
  }
}

static CagRegion *within(CagCurve *loop) {
  CagRegion *r;
  OK(cag_region_new(loop, NULL, 0, &r, &err));
  cag_curve_release(loop);
  return r;
}

static void loops_of_all_kinds_keep_the_distance(void **state) {
  (void)state;
  seed = 311;
  for (int round = 0; round < 4 * LOOPS; round++) {
    CagVec3 center = {0, 0, 0};
    center.x = uniform(-5, 5);
    center.y = uniform(-5, 5);
    CagCurve *loop = loop_at(center, round % LOOPS);
    if (round / LOOPS % 2) { // the reversed loop bounds the same region
      CagCurve *back;
      OK(cag_curve_reverse(loop, &back, &err));
      cag_curve_release(loop);
      loop = back;
    }
    CagRegion *r = within(loop);
    const double grow = uniform(0.05, 2), shrink = uniform(-0.8, -0.05);
    check_distances(r, grow, 1e-6);
    check_distances(r, shrink, 1e-6);
    cag_region_release(r);
  }
}

// In a large disk, the loop is a hole, which shrinks as the region grows.
static void holes_of_all_kinds_keep_the_distance(void **state) {
  (void)state;
  seed = 312;
  for (int round = 0; round < 2 * LOOPS; round++) {
    CagTransform frame = cag_transform_identity();
    CagCurve *around, *hole = loop_at(cag_vec3(0.5, -0.5, 0), round % LOOPS);
    CagRegion *r;
    OK(cag_curve_arc(9, 9, 0, 2 * M_PI, &frame, &around, &err));
    OK(cag_region_new(around, &hole, 1, &r, &err));
    const double grow = uniform(0.05, 0.8), shrink = uniform(-1.5, -0.05);
    check_distances(r, grow, 1e-6);
    check_distances(r, shrink, 1e-6);
    cag_region_release(r);
    cag_curve_release(hole);
    cag_curve_release(around);
  }
}

// The area A of a convex loop of length L becomes A + L d + pi d^2, with or without corners.
static void convex_loops_grow_by_steiners_formula(void **state) {
  (void)state;
  seed = 313;
  for (int round = 0; round < 40; round++) {
    CagVec3 zero = {0, 0, 0};
    CagCurve *c = round % 3 == 0   ? drop_at(zero)
                  : round % 3 == 1 ? ellipse_at(zero, round % 2)
                                   : segment_at(zero, round % 2, false);
    CagRegion *r = within(c), *grown;
    double area, around, after;
    const double d = uniform(0.01, 3);
    OK(cag_region_area(r, &area, NULL, &err));
    OK(cag_region_perimeter(r, &around, &err));
    OK(cag_region_offset(r, d, 1e-8, &grown, &err));
    OK(cag_region_area(grown, &after, NULL, &err));
    NEAR(after, area + around * d + M_PI * d * d, 1e-6);
    assert_int_equal(grown->count, 1);
    cag_region_release(grown);
    cag_region_release(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(loops_of_all_kinds_keep_the_distance),
      cmocka_unit_test(holes_of_all_kinds_keep_the_distance),
      cmocka_unit_test(convex_loops_grow_by_steiners_formula),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
