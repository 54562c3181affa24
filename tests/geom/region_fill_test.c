// Regions of outlines that cross themselves and each other, compared with closed forms.

#include "tests/geom/support.h"

#include "geom/curve/region_fill.h"
#include "tests/geom/region_support.h"

static CagCurve *polygon(const CagVec3 *p, size_t n) {
  CagCurve *c;
  OK(cag_curve_polyline(p, n, true, 2, &c, &err));
  return c;
}

static CagCurve *circle(double x, double y, double radius, double start, double end) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(radius, radius, start, end, &frame, &c, &err));
  return c;
}

// Takes ownership of the loops.
static CagRegion *filled(CagCurve **loops, size_t n, CagFill fill) {
  CagRegion *r;
  OK(cag_region_fill((const CagCurve *const *)loops, n, fill, &r, &err));
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  return r;
}

static void check(CagRegion *r, double area, size_t loops) {
  double found;
  OK(cag_region_area(r, &found, NULL, &err));
  NEAR(found, area, 1e-12 * (1 + area));
  assert_int_equal(r->count, loops);
  cag_region_release(r);
}

static CagCurve *pentagram(bool clockwise) {
  CagVec3 p[5];
  for (int i = 0; i < 5; i++) {
    const double a = 4 * M_PI * (clockwise ? -i : i) / 5;
    p[i] = cag_vec3(cos(a), sin(a), 0);
  }
  return polygon(p, 5);
}

// The inner pentagon of the unit pentagram has the radius 1/phi^2, where phi is the golden ratio.
// The star is the decagon of both radii: 5 r sin 36 deg.
static void rules_differ_in_the_middle_of_a_pentagram(void **state) {
  (void)state;
  const double phi = (1 + sqrt(5)) / 2, r = 1 / (phi * phi);
  const double star = 5 * r * sin(M_PI / 5), middle = 2.5 * r * r * sin(2 * M_PI / 5);
  CagCurve *c = pentagram(false);
  check(filled(&c, 1, CAG_FILL_NONZERO), star, 1);
  c = pentagram(false);
  check(filled(&c, 1, CAG_FILL_POSITIVE), star, 1);
  // The tips touch each other in the corners of the pentagon.
  c = pentagram(false);
  CagRegion *tips = filled(&c, 1, CAG_FILL_EVEN_ODD);
  assert_int_equal(holds(tips, 0, 0), 0);
  check(tips, star - middle, 5);
  c = pentagram(true);
  check(filled(&c, 1, CAG_FILL_NONZERO), star, 1);
  c = pentagram(true);
  check(filled(&c, 1, CAG_FILL_POSITIVE), 0, 0);
}

static void arcs_that_cross_stay_arcs(void **state) {
  (void)state;
  // Two unit circles at distance 1 share 2 pi / 3 - sqrt(3) / 2.
  const double lens = 2 * M_PI / 3 - sqrt(3) / 2;
  CagCurve *c[2] = {circle(0, 0, 1, 0, 2 * M_PI), circle(1, 0, 1, 0, 2 * M_PI)};
  check(filled(c, 2, CAG_FILL_NONZERO), 2 * M_PI - lens, 1);
  c[0] = circle(0, 0, 1, 0, 2 * M_PI);
  c[1] = circle(1, 0, 1, 0, 2 * M_PI);
  check(filled(c, 2, CAG_FILL_EVEN_ODD), 2 * M_PI - 2 * lens, 2);
  // The second one runs clockwise: it takes away its inside from the first.
  c[0] = circle(0, 0, 1, 0, 2 * M_PI);
  CagCurve *forward = circle(1, 0, 1, 0, 2 * M_PI);
  OK(cag_curve_reverse(forward, &c[1], &err));
  cag_curve_release(forward);
  CagRegion *r = filled(c, 2, CAG_FILL_POSITIVE);
  double length;
  OK(cag_region_perimeter(r, &length, &err));
  NEAR(length, 2 * M_PI, 1e-12); // 4 pi / 3 of the first, 2 pi / 3 of the second
  check(r, M_PI - lens, 1);
}

static void splines_may_cross_themselves(void **state) {
  (void)state;
  // A closed curve whose control polygon is a bow tie: the lobes have opposite orientations.
  const CagVec3 p[] = {{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 0}};
  CagCurve *c;
  OK(cag_curve_bezier(p, NULL, 5, 2, &c, &err));
  double signed_area, area;
  OK(cag_curve_area(c, &signed_area, NULL, &err));
  CagRegion *nonzero, *positive, *odd;
  const CagCurve *const loops[] = {c};
  OK(cag_region_fill(loops, 1, CAG_FILL_NONZERO, &nonzero, &err));
  OK(cag_region_fill(loops, 1, CAG_FILL_POSITIVE, &positive, &err));
  OK(cag_region_fill(loops, 1, CAG_FILL_EVEN_ODD, &odd, &err));
  double all, left;
  OK(cag_region_area(nonzero, &all, NULL, &err));
  OK(cag_region_area(positive, &left, NULL, &err));
  OK(cag_region_area(odd, &area, NULL, &err));
  NEAR(area, all, 1e-12);
  // The signed area is that of the positive lobe minus that of the other.
  NEAR(left - (all - left), signed_area, 1e-10);
  cag_region_release(nonzero);
  cag_region_release(positive);
  cag_region_release(odd);
  cag_curve_release(c);
}

static void outlines_without_an_inside_add_nothing(void **state) {
  (void)state;
  const CagVec3 back[] = {{0, 0, 0}, {2, 0, 0}, {5, 0, 0}, {2, 0, 0}};
  const CagVec3 spike[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 5, 0}, {2, 2, 0}, {0, 2, 0}};
  const CagVec3 twice[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {1, 0, 0}};
  for (int fill = CAG_FILL_EVEN_ODD; fill <= CAG_FILL_POSITIVE; fill++) {
    CagCurve *c = polygon(back, 4);
    check(filled(&c, 1, fill), 0, 0);
    c = polygon(spike, 6);
    check(filled(&c, 1, fill), 4, 1);
    c = polygon(twice, 6);
    check(filled(&c, 1, fill), 0, 0);
    check(filled(NULL, 0, fill), 0, 0);
  }
}

static void coincident_and_repeated_outlines_are_counted(void **state) {
  (void)state;
  const CagVec3 square[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const CagVec3 beside[] = {{2, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}};
  const CagVec3 repeated[] = {{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  CagCurve *c[2] = {polygon(square, 4), polygon(square, 4)};
  check(filled(c, 2, CAG_FILL_EVEN_ODD), 0, 0);
  c[0] = polygon(square, 4);
  c[1] = polygon(repeated, 6);
  check(filled(c, 2, CAG_FILL_NONZERO), 4, 1);
  c[0] = polygon(square, 4);
  c[1] = polygon(beside, 4);
  check(filled(c, 2, CAG_FILL_EVEN_ODD), 8, 1);
}

// The same shape at any scale and location, up to the rounding of its coordinates.
static void sizes_and_locations_do_not_matter(void **state) {
  (void)state;
  static const double scales[] = {1e-100, 1e-12, 1, 1e12, 1e99};
  for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
    const double s = scales[i];
    const CagVec3 bow[] = {{0, 0, 0}, {2 * s, 2 * s, 0}, {2 * s, 0, 0}, {0, 2 * s, 0}};
    CagCurve *c = polygon(bow, 4);
    CagRegion *r = filled(&c, 1, CAG_FILL_NONZERO);
    assert_int_equal(r->count, 2);
    CagBounds box;
    OK(cag_region_bounds(r, &box, &err));
    NEAR(box.max.x / s, 2, 1e-12);
    cag_region_release(r);
  }
  const double far = 1e6;
  const CagVec3 bow[] = {
      {far, far, 0}, {far + 2, far + 2, 0}, {far + 2, far, 0}, {far, far + 2, 0}};
  CagCurve *c = polygon(bow, 4);
  CagRegion *r = filled(&c, 1, CAG_FILL_EVEN_ODD);
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  NEAR(area, 2, 1e-8);
  cag_region_release(r);
}

static void open_outlines_are_refused(void **state) {
  (void)state;
  CagCurve *c[2] = {circle(0, 0, 1, 0, 2 * M_PI), circle(0, 0, 1, 0, M_PI)};
  CagRegion *r;
  FAILS_AT(cag_region_fill((const CagCurve *const *)c, 2, CAG_FILL_NONZERO, &r, &err),
           "region-not-closed", 1);
  for (int i = 0; i < 2; i++) cag_curve_release(c[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rules_differ_in_the_middle_of_a_pentagram),
      cmocka_unit_test(arcs_that_cross_stay_arcs),
      cmocka_unit_test(splines_may_cross_themselves),
      cmocka_unit_test(outlines_without_an_inside_add_nothing),
      cmocka_unit_test(coincident_and_repeated_outlines_are_counted),
      cmocka_unit_test(sizes_and_locations_do_not_matter),
      cmocka_unit_test(open_outlines_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
