// Minkowski sums, compared with closed forms, offsets, and unions of moved copies.

#include "tests/geom/support.h"

#include "geom/curve/minkowski.h"
#include "tests/geom/random.h"
#include "tests/geom/region_support.h"

static CagCurve *path(const CagVec3 *p, size_t n) {
  CagCurve *c;
  OK(cag_curve_polyline(p, n, true, 2, &c, &err));
  return c;
}

// Takes ownership of the curves; inner may be NULL.
static CagRegion *region(CagCurve *outer, CagCurve *inner) {
  CagRegion *r;
  OK(cag_region_new(outer, &inner, inner ? 1 : 0, &r, &err));
  cag_curve_release(outer);
  cag_curve_release(inner);
  return r;
}

static CagCurve *circle(double x, double y, double radius) {
  CagTransform frame = cag_translate(cag_vec3(x, y, 0));
  frame.planar = true;
  CagCurve *c;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

static CagRegion *sum(const CagRegion *a, const CagRegion *b) {
  CagRegion *r;
  OK(cag_region_minkowski(a, b, 1e-7, &r, &err));
  return r;
}

static double area_of(const CagRegion *r) {
  double area;
  OK(cag_region_area(r, &area, NULL, &err));
  return area;
}

static double free_area(CagRegion *r) {
  const double area = area_of(r);
  cag_region_release(r);
  return area;
}

static void rectangles_add_their_sides(void **state) {
  (void)state;
  CagRegion *a, *b;
  OK(cag_region_rectangle(3, 2, 0, &a, &err));
  OK(cag_region_rectangle(1, 5, 0, &b, &err));
  CagRegion *r = sum(a, b);
  assert_int_equal(r->count, 1);
  NEAR(free_area(r), 28, 1e-12);
  cag_region_release(a);
  cag_region_release(b);
}

// A triangle and its image under a half turn add up to a hexagon with six times its area; twice the
// same to one with the double size.
static void triangles_add_up_to_hexagons(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {4, 1, 0}, {1, 3, 0}},
                q[] = {{0, 0, 0}, {-4, -1, 0}, {-1, -3, 0}};
  CagRegion *a = region(path(p, 3), NULL), *b = region(path(q, 3), NULL);
  const double area = area_of(a);
  NEAR(free_area(sum(a, b)), 6 * area, 1e-12);
  NEAR(free_area(sum(a, a)), 4 * area, 1e-12);
  cag_region_release(a);
  cag_region_release(b);
}

static void discs_add_their_radii(void **state) {
  (void)state;
  CagRegion *a = region(circle(1, 2, 3), NULL), *b = region(circle(4, 0, 0.5), NULL),
            *r = sum(a, b);
  double length;
  OK(cag_region_perimeter(r, &length, &err));
  NEAR(length, 7 * M_PI, 1e-11);
  assert_true(holds(r, 5 + 3.49, 2));
  NEAR(free_area(r), M_PI * 3.5 * 3.5, 1e-11);
  cag_region_release(a);
  cag_region_release(b);
}

// A star-shaped polygon with random corners.
static CagCurve *star(double x, double y, int n, double low, double high) {
  CagVec3 p[16];
  for (int i = 0; i < n; i++) {
    const double r = uniform(low, high), a = 2 * M_PI * (i + uniform(-0.3, 0.3)) / n;
    p[i] = cag_vec3(x + r * cos(a), y + r * sin(a), 0);
  }
  return path(p, (size_t)n);
}

static CagCurve *blob(double low, double high) {
  enum { POINTS = 7 };
  CagVec3 p[POINTS];
  for (int i = 0; i < POINTS; i++) {
    const double r = uniform(low, high), a = 2 * M_PI * i / POINTS;
    p[i] = cag_vec3(r * cos(a), r * sin(a), 0);
  }
  CagCurve *c;
  OK(cag_curve_nurbs_closed(p, NULL, POINTS, 3, 2, &c, &err));
  return c;
}

// The sum with a disc is the offset.
static void sums_with_discs_are_offsets(void **state) {
  (void)state;
  seed = 7;
  for (int round = 0; round < 40; round++) {
    CagRegion *r;
    const int kind = round % 5;
    if (kind == 0) r = region(star(0, 0, 9, 1, 4), NULL);
    else if (kind == 1) r = region(star(0, 0, 9, 3, 5), star(0, 0, 5, 0.5, 2));
    else if (kind == 2) r = region(blob(1, 4), NULL);
    else if (kind == 3) OK(cag_region_rectangle(5, 3, 0.7, &r, &err));
    else {
      CagRegion *bitten, *bite = region(circle(1, 1, uniform(0.5, 1.5)), NULL);
      OK(cag_region_rectangle(4, 3, 0, &bitten, &err));
      OK(cag_region_boolean(CAG_REGION_DIFFERENCE, bitten, bite, &r, &err));
      cag_region_release(bitten);
      cag_region_release(bite);
    }
    const double d = uniform(0.1, 1.5);
    CagRegion *disc = region(circle(0, 0, d), NULL), *offset;
    OK(cag_region_offset(r, d, 1e-7, &offset, &err));
    const double tolerance = kind == 2 ? 1e-5 : 1e-9;
    NEAR(free_area(sum(r, disc)), area_of(offset), tolerance);
    NEAR(free_area(sum(disc, r)), free_area(offset), tolerance);
    cag_region_release(disc);
    cag_region_release(r);
  }
}

static CagRegion *moved(const CagRegion *r, CagVec3 by) {
  CagTransform t = cag_translate(by);
  t.planar = true;
  CagRegion *out;
  OK(cag_region_transform(r, &t, &out, &err));
  return out;
}

// A parallelogram; NULL if it has no area.
static CagRegion *swept(CagVec3 p, CagVec3 along, CagVec3 by) {
  const CagVec3 v[] = {p, cag_add(p, along), cag_add(cag_add(p, along), by), cag_add(p, by)};
  if (fabs(cag_cross(along, by).z) < 1e-9) return NULL;
  return region(path(v, 4), NULL);
}

// The sum by its definition: sides moved along sides, and copies at one corner of each loop.
static CagRegion *sum_of_copies(const CagRegion *a, const CagRegion *b) {
  CagRegion *all[1024] = {NULL}, *r;
  size_t n = 0;
  for (size_t i = 0; i < a->count; i++)
    for (size_t k = 0; k < b->count; k++) {
      const CagVec3 *p, *q;
      size_t np, nq;
      bool closed;
      assert_true(cag_curve_vertices(a->loops[i], &p, &np, &closed));
      assert_true(cag_curve_vertices(b->loops[k], &q, &nq, &closed));
      all[n++] = moved(a, q[0]);
      all[n++] = moved(b, p[0]);
      for (size_t u = 0; u < np; u++)
        for (size_t v = 0; v < nq; v++) {
          all[n] = swept(cag_add(p[u], q[v]), cag_sub(p[(u + 1) % np], p[u]),
                         cag_sub(q[(v + 1) % nq], q[v]));
          n += all[n] != NULL;
        }
    }
  OK(cag_region_combine(CAG_REGION_UNION, (const CagRegion *const *)all, n, &r, &err));
  for (size_t i = 0; i < n; i++) cag_region_release(all[i]);
  return r;
}

static void sums_of_polygons_are_unions_of_copies(void **state) {
  (void)state;
  seed = 19;
  for (int round = 0; round < 60; round++) {
    CagRegion *a = round % 3 == 0 ? region(star(0, 0, 7, 3, 6), star(0, 0, 4, 0.5, 2.5))
                                  : region(star(1, 0, 8, 1, 4), NULL);
    CagRegion *b = round % 4 == 1 ? region(star(0, 0, 6, 2, 3), star(0, 0, 4, 0.3, 1.2))
                                  : region(star(0, 2, 5, 0.2, 1.5), NULL);
    CagRegion *r = sum(a, b), *copies = sum_of_copies(a, b);
    NEAR(area_of(r), area_of(copies), 1e-7);
    assert_int_equal(r->count, copies->count);
    cag_region_release(r);
    cag_region_release(copies);
    cag_region_release(a);
    cag_region_release(b);
  }
}

static CagRegion *as_polygon(const CagRegion *r) {
  double *t;
  size_t n;
  const CagCurve *c = r->loops[0];
  OK(cag_curve_discretize(c, 1e-3, 0.5, &t, &n, &err));
  CagVec3 *p = test_malloc(n * sizeof *p);
  OK(cag_curve_eval_many(c, t, n, 0, p, &err));
  CagRegion *out = region(path(p, n - 1), NULL);
  test_free(p);
  free(t);
  return out;
}

// The sums of fine polygons, whose areas differ by the tolerance times the perimeter.
static void sums_of_splines_are_those_of_fine_polygons(void **state) {
  (void)state;
  seed = 29;
  for (int round = 0; round < 6; round++) {
    CagRegion *a = region(blob(1, 4), NULL), *b = region(blob(0.5, 2), NULL);
    CagRegion *fine_a = as_polygon(a), *fine_b = as_polygon(b), *r = sum(fine_a, fine_b);
    CagRegion *smooth;
    OK(cag_region_minkowski(a, b, 1e-5, &smooth, &err));
    NEAR(free_area(smooth), free_area(r), 0.05);
    cag_region_release(fine_a);
    cag_region_release(fine_b);
    cag_region_release(a);
    cag_region_release(b);
  }
}

// A hole with parallel sides all around is filled when the other region just fits into it.
static void frames_lose_their_hole(void **state) {
  (void)state;
  CagRegion *frame = NULL, *outer, *inner, *b;
  OK(cag_region_rectangle(10, 8, 0, &outer, &err));
  OK(cag_region_rectangle(4, 2, 0, &inner, &err));
  OK(cag_region_boolean(CAG_REGION_DIFFERENCE, outer, inner, &frame, &err));
  static const double sizes[] = {1, 2, 3};
  for (size_t i = 0; i < 3; i++) {
    const double s = sizes[i];
    OK(cag_region_rectangle(s, s, 0, &b, &err));
    CagRegion *r = sum(frame, b);
    const double hole = s < 2 ? (4 - s) * (2 - s) : 0;
    assert_int_equal(r->count, s < 2 ? 2 : 1);
    NEAR(free_area(r), (10 + s) * (8 + s) - hole, 1e-11);
    cag_region_release(b);
  }
  cag_region_release(frame);
  cag_region_release(outer);
  cag_region_release(inner);
}

static void sums_with_the_empty_region_are_empty(void **state) {
  (void)state;
  CagRegion *none, *a, *r;
  OK(cag_region_empty(&none, &err));
  OK(cag_region_rectangle(1, 1, 0, &a, &err));
  r = sum(none, a);
  assert_true(cag_region_is_empty(r));
  cag_region_release(r);
  r = sum(a, none);
  assert_true(cag_region_is_empty(r));
  cag_region_release(r);
  cag_region_release(none);
  cag_region_release(a);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rectangles_add_their_sides),
      cmocka_unit_test(triangles_add_up_to_hexagons),
      cmocka_unit_test(discs_add_their_radii),
      cmocka_unit_test(sums_with_discs_are_offsets),
      cmocka_unit_test(sums_of_polygons_are_unions_of_copies),
      cmocka_unit_test(sums_of_splines_are_those_of_fine_polygons),
      cmocka_unit_test(frames_lose_their_hole),
      cmocka_unit_test(sums_with_the_empty_region_are_empty),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
