// Regions: orientation, holes, measures, and points inside.

#include "geom/curve/region.h"
#include "support.h"

static CagCurve *circle(double r, double x, double y) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

static CagCurve *square(double half, double x, double y, bool clockwise) {
  CagVec3 p[4] = {{x - half, y - half, 0},
                  {x + half, y - half, 0},
                  {x + half, y + half, 0},
                  {x - half, y + half, 0}};
  if (clockwise) {
    CagVec3 q = p[1];
    p[1] = p[3];
    p[3] = q;
  }
  CagCurve *c;
  OK(cag_curve_polyline(p, 4, true, 2, &c, &err));
  return c;
}

static bool contains(const CagRegion *r, double x, double y) {
  bool in;
  OK(cag_region_contains(r, cag_vec3(x, y, 0), &in, &err));
  return in;
}

static void holes_take_their_area_away(void **state) {
  (void)state;
  CagCurve *outer = square(5, 0, 0, true), *hole = circle(2, 1, 0);
  CagRegion *r;
  double area, length;
  CagVec3 centroid;
  OK(cag_region_new(outer, &hole, 1, &r, &err));
  OK(cag_region_area(r, &area, &centroid, &err));
  NEAR(area, 100 - 4 * M_PI, 1e-11);
  NEAR(centroid.x, -4 * M_PI / (100 - 4 * M_PI), 1e-12);
  OK(cag_region_perimeter(r, &length, &err));
  NEAR(length, 40 + 4 * M_PI, 1e-12);
  assert_true(r->outer[0] == 0 && r->outer[1] == 0);
  double a;
  OK(cag_curve_area(r->loops[0], &a, NULL, &err));
  assert_true(a > 0);
  OK(cag_curve_area(r->loops[1], &a, NULL, &err));
  assert_true(a < 0);
  assert_true(contains(r, -4, 4) && !contains(r, 1, 0) && !contains(r, 6, 0));
  assert_true(contains(r, 3, 0) && contains(r, 5, 5) && contains(r, -5, 0)); // boundary
  assert_true(!contains(r, 3 - 1e-6, 0) && contains(r, 3 + 1e-6, 0));
  assert_true(!contains(r, 5 + 1e-6, 0));
  cag_region_release(r);
  cag_curve_release(outer);
  cag_curve_release(hole);
}

static void bad_holes_are_named(void **state) {
  (void)state;
  CagCurve *outer = square(5, 0, 0, false), *open, *bow;
  CagCurve *in = circle(1, 0, 0), *out = circle(1, 20, 0), *across = circle(2, 5, 0);
  CagCurve *near = circle(1, 1.5, 0), *within = circle(0.5, 0, 0);
  CagRegion *r;
  CagCurve *const pair[2] = {in, out}, *const overlap[2] = {in, near},
                  *const nested[2] = {in, within};
  FAILS(cag_region_new(outer, pair, 2, &r, &err), "hole-outside");
  assert_int_equal(err.index, 1);
  FAILS(cag_region_new(outer, &across, 1, &r, &err), "region-crossing");
  assert_int_equal(err.index, 0);
  FAILS(cag_region_new(outer, overlap, 2, &r, &err), "region-crossing");
  assert_int_equal(err.index, 1);
  FAILS(cag_region_new(outer, nested, 2, &r, &err), "region-crossing");
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), 2, &open, &err));
  FAILS(cag_region_new(open, NULL, 0, &r, &err), "region-not-closed");
  FAILS(cag_region_new(outer, &open, 1, &r, &err), "region-not-closed");
  static const CagVec3 eight[4] = {{0, 0, 0}, {2, 1, 0}, {2, 0, 0}, {0, 2, 0}};
  OK(cag_curve_polyline(eight, 4, true, 2, &bow, &err));
  FAILS(cag_region_new(bow, NULL, 0, &r, &err), "region-crossing");
  CagCurve *all[8] = {outer, in, out, across, near, within, open, bow};
  for (int i = 0; i < 8; i++) cag_curve_release(all[i]);
}

// A square in a ring in a square: even depths are outer loops.
static void loops_nest_by_the_even_odd_rule(void **state) {
  (void)state;
  CagCurve *loops[4] = {square(1, 0, 0, false), circle(2, 0, 0), square(3, 0, 0, true),
                        circle(1, 10, 0)};
  CagRegion *r;
  double area;
  OK(cag_region_from_loops(loops, 4, &r, &err));
  assert_int_equal(r->count, 4);
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 4 + (36 - 4 * M_PI) + M_PI, 1e-11);
  assert_true(contains(r, 0, 0) && !contains(r, 1.5, 0) && contains(r, 2.5, 0) &&
              contains(r, 10, 0));
  int holes = 0;
  for (size_t i = 0; i < 4; i++) holes += r->outer[i] != i;
  assert_int_equal(holes, 1);
  cag_region_release(r);
  for (int i = 0; i < 4; i++) cag_curve_release(loops[i]);
}

static void rounded_rectangles_are_exact(void **state) {
  (void)state;
  CagRegion *r;
  double area, length;
  CagBounds b;
  OK(cag_region_rectangle(10, 6, 2, &r, &err));
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 60 - (4 - M_PI) * 4, 1e-11);
  OK(cag_region_perimeter(r, &length, &err));
  NEAR(length, 2 * (6 + 2) + 4 * M_PI, 1e-12);
  OK(cag_region_bounds(r, &b, &err));
  near_vec(b.min, cag_vec3(-5, -3, 0), 1e-14);
  near_vec(b.max, cag_vec3(5, 3, 0), 1e-14);
  assert_true(contains(r, 5, 1) && !contains(r, 5, 3) && contains(r, 4.4, 2.4) &&
              !contains(r, 4.5, 2.5));
  cag_region_release(r);
  OK(cag_region_rectangle(4, 2, 1, &r, &err)); // a stadium: the short sides are gone
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 4 + M_PI, 1e-12);
  cag_region_release(r);
  OK(cag_region_rectangle(2, 2, 1, &r, &err));
  assert_string_equal(r->loops[0]->kind->name, "circle");
  cag_region_release(r);
  FAILS(cag_region_rectangle(4, 2, 1.5, &r, &err), "radius-too-large");
  FAILS(cag_region_rectangle(0, 2, 0, &r, &err), "size-not-positive");
}

// A regular n-gon of radius r has the area n r^2 sin(2 pi / n) / 2.
static void regular_polygons_have_their_area(void **state) {
  (void)state;
  CagRegion *r;
  double area;
  for (size_t n = 3; n < 20; n++) {
    OK(cag_region_regular_polygon(n, 2, &r, &err));
    OK(cag_region_area(r, &area, NULL, &err));
    NEAR(area, 2 * (double)n * sin(2 * M_PI / (double)n), 1e-13);
    cag_region_release(r);
  }
  FAILS(cag_region_regular_polygon(2, 1, &r, &err), "too-few-points");
}

static void mirrors_keep_the_orientation(void **state) {
  (void)state;
  CagCurve *outer = square(5, 0, 0, false), *hole = circle(2, 1, 0);
  CagRegion *r, *image;
  CagTransform mirror;
  double area, a;
  OK(cag_region_new(outer, &hole, 1, &r, &err));
  OK(cag_reflect_line(cag_vec3(0, 0, 0), cag_vec3(1, 2, 0), &mirror, &err));
  OK(cag_region_transform(r, &mirror, &image, &err));
  OK(cag_region_area(image, &area, NULL, &err));
  NEAR(area, 100 - 4 * M_PI, 1e-11);
  OK(cag_curve_area(image->loops[0], &a, NULL, &err));
  assert_true(a > 0);
  cag_region_release(image);
  CagTransform lift = cag_translate(cag_vec3(0, 0, 1));
  FAILS(cag_region_transform(r, &lift, &image, &err), "not-planar");
  cag_region_release(r);
  cag_curve_release(outer);
  cag_curve_release(hole);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(holes_take_their_area_away),
      cmocka_unit_test(bad_holes_are_named),
      cmocka_unit_test(loops_nest_by_the_even_odd_rule),
      cmocka_unit_test(rounded_rectangles_are_exact),
      cmocka_unit_test(regular_polygons_have_their_area),
      cmocka_unit_test(mirrors_keep_the_orientation),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
