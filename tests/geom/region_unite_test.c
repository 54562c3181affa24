// The union of many regions, compared with the union of all of them at once.

#include "tests/geom/support.h"

#include "geom/curve/region_unite.h"
#include "tests/geom/random.h"
#include "tests/geom/region_support.h"

static CagCurve *rectangle(double x, double y, double w, double h) {
  const CagVec3 p[] = {{x, y, 0}, {x + w, y, 0}, {x + w, y + h, 0}, {x, y + h, 0}};
  CagCurve *c;
  OK(cag_curve_polyline(p, 4, true, 2, &c, &err));
  return c;
}

static CagCurve *circle(double x, double y, double r) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

// Releases the loops.
static CagRegion *region_of(CagCurve **loops, size_t n) {
  CagRegion *r;
  OK(cag_region_from_loops(loops, n, &r, &err));
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  return r;
}

static double area_of(const CagRegion *r) {
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  return area;
}

// Compares the union with that of cag_region_combine, releases the regions, and returns it.
static CagRegion *united(CagRegion **regions, size_t n) {
  CagRegion *few, *all;
  OK(cag_regions_unite_few(regions, n, &few, &err));
  OK(cag_region_combine(CAG_REGION_UNION, (const CagRegion *const *)regions, n, &all, &err));
  NEAR(area_of(few), area_of(all), 1e-12 * (1 + area_of(all)));
  assert_int_equal(few->count, all->count);
  for (int i = 0; i < 400; i++) {
    const double x = uniform(-1, 12), y = uniform(-1, 12);
    if (distance_to_boundary(all, cag_vec3(x, y, 0)) > 1e-9)
      assert_int_equal(holds(few, x, y), holds(all, x, y));
  }
  cag_region_release(all);
  for (size_t i = 0; i < n; i++) cag_region_release(regions[i]);
  return few;
}

// A cross whose second bar is the second outline of its region: the areas are 1 + 4 + 4 - 1.
static void each_outline_is_looked_at(void **state) {
  (void)state;
  CagCurve *two[] = {rectangle(6, 6, 1, 1), rectangle(0, 1, 4, 1)};
  CagCurve *one[] = {rectangle(1.5, 0, 1, 4)};
  for (int reversed = 0; reversed < 2; reversed++) {
    CagCurve *first[] = {cag_curve_retain(two[reversed]), cag_curve_retain(two[!reversed])};
    CagCurve *second[] = {cag_curve_retain(one[0])};
    CagRegion *regions[] = {region_of(first, 2), region_of(second, 1)};
    CagRegion *r = united(regions, 2);
    NEAR(area_of(r), 8, 1e-12);
    assert_int_equal(r->count, 2);
    cag_region_release(r);
  }
  cag_curve_release(two[0]);
  cag_curve_release(two[1]);
  cag_curve_release(one[0]);
}

static void regions_that_nothing_touches_keep_their_boundaries(void **state) {
  (void)state;
  CagCurve *ring[] = {circle(2, 2, 2), circle(2, 2, 1.5)}, *island[] = {rectangle(1.5, 1.5, 1, 1)},
           *beside[] = {circle(8, 2, 1)};
  CagRegion *regions[] = {region_of(ring, 2), region_of(island, 1), region_of(beside, 1)};
  const CagCurve *last = regions[2]->loops[0];
  CagRegion *r = united(regions, 3);
  assert_int_equal(r->count, 4);
  assert_ptr_equal(r->loops[3], last);
  cag_region_release(r);
}

static void regions_inside_of_others_vanish(void **state) {
  (void)state;
  CagCurve *inner[] = {circle(2, 2, 0.5)}, *outer[] = {rectangle(0, 0, 4, 4)};
  CagRegion *regions[] = {region_of(inner, 1), region_of(outer, 1)};
  CagRegion *r = united(regions, 2);
  assert_int_equal(r->count, 1);
  cag_region_release(r);
}

static CagRegion *random_region(void) {
  CagCurve *loops[3];
  const double x = uniform(0, 8), y = uniform(0, 8), r = uniform(0.3, 1);
  loops[0] = circle(x, y, r);
  loops[1] = circle(x, y, r * uniform(0.2, 0.9));
  loops[2] = rectangle(x + 1.1 * r, y, uniform(0.1, 3), uniform(0.1, 1));
  return region_of(loops, 3);
}

static void unions_are_those_of_all_regions_at_once(void **state) {
  (void)state;
  enum { CASES = 60, MOST = 14 };
  for (int i = 0; i < CASES; i++) {
    CagRegion *regions[MOST];
    const size_t n = 2 + (size_t)i % (MOST - 1);
    for (size_t k = 0; k < n; k++) regions[k] = random_region();
    cag_region_release(united(regions, n));
  }
}

static void nothing_is_empty(void **state) {
  (void)state;
  CagRegion *r, *none[2];
  OK(cag_regions_unite_few(NULL, 0, &r, &err));
  assert_true(cag_region_is_empty(r));
  cag_region_release(r);
  OK(cag_region_empty(&none[0], &err));
  OK(cag_region_empty(&none[1], &err));
  r = united(none, 2);
  assert_true(cag_region_is_empty(r));
  cag_region_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_outline_is_looked_at),
      cmocka_unit_test(regions_that_nothing_touches_keep_their_boundaries),
      cmocka_unit_test(regions_inside_of_others_vanish),
      cmocka_unit_test(unions_are_those_of_all_regions_at_once),
      cmocka_unit_test(nothing_is_empty),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
