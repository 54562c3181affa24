// Coverage of pixels: against areas by closed formulas, the areas of intersections with squares, and
// centers by the distance from a circle.

#include "geom/curve/region.h"
#include "geom/image/arithmetic.h"
#include "geom/image/coverage.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static CagRegion *region_of(CagCurve *outline) {
  CagRegion *r;
  OK(cag_region_new(outline, NULL, 0, &r, &err));
  cag_curve_release(outline);
  return r;
}

static CagCurve *circle_at(double x, double y, double radius) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  frame.m[0][3] = x;
  frame.m[1][3] = y;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

static CagRegion *polygon(const CagVec3 *points, size_t n) {
  CagCurve *c;
  OK(cag_curve_polyline(points, n, true, 2, &c, &err));
  return region_of(c);
}

static double sum_of(const CagRaster *r) {
  CagRasterFigures f;
  OK(cag_raster_figures(r, &f, &err));
  return f.sum;
}

static CagRaster *covered(const CagRegion *region, CagGrid grid, CagPixelRule rule) {
  CagRaster *r;
  OK(cag_raster_of_region(region, &grid, rule, &r, &err));
  return r;
}

static void a_triangle_covers_known_fractions(void **state) {
  (void)state;
  const CagVec3 points[] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  CagRegion *region = polygon(points, 3);
  CagRaster *r = covered(region, (CagGrid){0, 0, 1, 3, 3}, CAG_PIXEL_COVERAGE);
  const double expected[] = {0, 0, 0, 0.5, 0, 0, 1, 0.5, 0};
  assert_memory_equal(r->data, expected, sizeof expected);
  cag_raster_release(r);
  // In one coarse pixel, and in a pixel that the slanted side halves.
  r = covered(region, (CagGrid){-1, -1, 3, 1, 1}, CAG_PIXEL_COVERAGE);
  NEAR(r->data[0], 2.0 / 9, 1e-15);
  cag_raster_release(r);
  r = covered(region, (CagGrid){0.5, 0.5, 1, 1, 1}, CAG_PIXEL_COVERAGE);
  NEAR(r->data[0], 0.5, 1e-15);
  cag_raster_release(r);
  cag_region_release(region);
}

// The fraction of a pixel is the area of its intersection with the region.
static void fractions_are_areas_of_intersections(void **state) {
  (void)state;
  seed = 61;
  for (int round = 0; round < 6; round++) {
    CagRegion *region = region_of(circle_at(uniform(2, 4), uniform(2, 4), uniform(1, 3)));
    const CagGrid grid = {uniform(-1, 1), uniform(-1, 1), uniform(0.7, 1.5), 5, 4};
    CagRaster *r = covered(region, grid, CAG_PIXEL_COVERAGE);
    for (size_t y = 0; y < grid.height; y++)
      for (size_t x = 0; x < grid.width; x++) {
        const double left = grid.x + (double)x * grid.pixel;
        const double low = grid.y + (double)(grid.height - 1 - y) * grid.pixel;
        const double right = left + grid.pixel, high = low + grid.pixel;
        const CagVec3 corners[] = {
            {left, low, 0}, {right, low, 0}, {right, high, 0}, {left, high, 0}};
        CagRegion *pixel = polygon(corners, 4), *both;
        double area = 0;
        OK(cag_region_boolean(CAG_REGION_INTERSECTION, region, pixel, &both, &err));
        if (!cag_region_is_empty(both)) OK(cag_region_area(both, &area, NULL, &err));
        NEAR(*cag_raster_at(r, 0, x, y), area / (grid.pixel * grid.pixel), 1e-9);
        cag_region_release(pixel);
        cag_region_release(both);
      }
    cag_raster_release(r);
    cag_region_release(region);
  }
}

static void a_disk_adds_up_to_its_area(void **state) {
  (void)state;
  seed = 62;
  for (int round = 0; round < 40; round++) {
    const double radius = pow(10, uniform(-2, 2));
    const double pixel = radius * pow(10, uniform(-2, 1));
    const double x = uniform(-1, 1), y = uniform(-1, 1);
    CagRegion *region = region_of(circle_at(x, y, radius));
    const size_t n = (size_t)(2 * radius / pixel) + 3;
    const CagGrid grid = {x - radius - pixel * uniform(0, 1), y - radius - pixel * uniform(0, 1),
                          pixel, n, n};
    CagRaster *r = covered(region, grid, CAG_PIXEL_COVERAGE);
    NEAR(sum_of(r) * pixel * pixel / (M_PI * radius * radius), 1, 1e-12);
    cag_raster_release(r);
    cag_region_release(region);
  }
}

// A half disk in one pixel, and parts of the disk outside of the grid: the segment of height h has
// the area R^2 acos(1 - h / R) - (R - h) sqrt(2 R h - h^2).
static void parts_outside_of_the_grid_are_cut_off(void **state) {
  (void)state;
  CagRegion *region = region_of(circle_at(0, 0, 5));
  CagRaster *r = covered(region, (CagGrid){-5, 0, 10, 1, 1}, CAG_PIXEL_COVERAGE);
  NEAR(r->data[0], M_PI * 25 / 2 / 100, 1e-15);
  cag_raster_release(r);
  const double segment = 25 * acos(1 - 2 / 5.0) - 3 * 4; // h = 2
  const CagGrid grids[] = {
      {3, -5, 0.5, 4, 20}, {-5, -5, 0.5, 4, 20}, {-5, 3, 0.5, 20, 4}, {-5, -5, 0.5, 20, 4}};
  for (int i = 0; i < 4; i++) {
    r = covered(region, grids[i], CAG_PIXEL_COVERAGE);
    NEAR(sum_of(r) / 4, segment, 1e-12);
    cag_raster_release(r);
  }
  r = covered(region, (CagGrid){-1, -1, 0.25, 8, 8}, CAG_PIXEL_COVERAGE);
  for (int i = 0; i < 64; i++) assert_true(r->data[i] == 1);
  cag_raster_release(r);
  r = covered(region, (CagGrid){6, 6, 1, 3, 3}, CAG_PIXEL_COVERAGE);
  for (int i = 0; i < 9; i++) assert_true(r->data[i] == 0);
  cag_raster_release(r);
  cag_region_release(region);
}

// Coordinates far outside of the range of integers.
static void huge_shapes_are_cut_off(void **state) {
  (void)state;
  const CagVec3 points[] = {{-1e30, 0.5, 0}, {1e30, 0.5, 0}, {0, 1e30, 0}};
  CagRegion *region = polygon(points, 3);
  CagRaster *r = covered(region, (CagGrid){-2, -1, 1, 4, 3}, CAG_PIXEL_COVERAGE);
  for (size_t x = 0; x < 4; x++) {
    NEAR(*cag_raster_at(r, 0, x, 0), 1, 1e-12);
    NEAR(*cag_raster_at(r, 0, x, 1), 0.5, 1e-12);
    NEAR(*cag_raster_at(r, 0, x, 2), 0, 1e-12);
  }
  cag_raster_release(r);
  cag_region_release(region);
}

// A curve that wriggles along a line of the grid, and one whose extremes lie on lines.
static void splines_add_up_to_their_area(void **state) {
  (void)state;
  seed = 63;
  for (int round = 0; round < 30; round++) {
    enum { N = 9 };
    CagVec3 points[N];
    for (int i = 0; i < N; i++) {
      const double angle = 2 * M_PI * i / N, reach = uniform(1, 4);
      points[i] = cag_vec3(reach * cos(angle), i % 2 ? reach * sin(angle) : rint(sin(angle)), 0);
    }
    CagCurve *c;
    CagRegion *region;
    double area;
    OK(cag_curve_nurbs_closed(points, NULL, N, 2 + round % 3, 2, &c, &err));
    const CagStatus simple = cag_region_new(c, NULL, 0, &region, &err);
    cag_curve_release(c);
    if (simple) continue; // it crosses itself
    OK(cag_region_area(region, &area, NULL, &err));
    CagRaster *r = covered(region, (CagGrid){-4, -4, 0.25, 32, 32}, CAG_PIXEL_COVERAGE);
    NEAR(sum_of(r) / 16, area, 1e-11);
    for (int i = 0; i < 32 * 32; i++) assert_true(r->data[i] >= 0 && r->data[i] <= 1);
    cag_raster_release(r);
    cag_region_release(region);
  }
}

// The reference's ring: radii 3 and 7 about (8, 8) on 16 x 16 pixels, 124 centers inside.
static void centers_of_a_ring_are_counted(void **state) {
  (void)state;
  CagCurve *outer = circle_at(8, 8, 7), *inner = circle_at(8, 8, 3);
  CagRegion *region;
  OK(cag_region_new(outer, &inner, 1, &region, &err));
  const CagGrid grid = {0, 0, 1, 16, 16};
  CagRaster *r = covered(region, grid, CAG_PIXEL_CENTER);
  assert_true(sum_of(r) == 124);
  for (size_t y = 0; y < 16; y++)
    for (size_t x = 0; x < 16; x++) {
      const double d = hypot((double)x - 7.5, (double)y - 7.5);
      assert_true(*cag_raster_at(r, 0, x, y) == (d > 3 && d < 7 ? 1 : 0));
    }
  cag_raster_release(r);
  r = covered(region, grid, CAG_PIXEL_COVERAGE);
  NEAR(sum_of(r), 40 * M_PI, 1e-12);
  cag_raster_release(r);
  cag_region_release(region);
  cag_curve_release(outer);
  cag_curve_release(inner);
}

// Adjoining polygons share no center, and miss none: left and lower edges are inside.
static void centers_on_edges_belong_to_one_side(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    const CagVec3 square[] = {
        {k * 2 + 0.5, 0.5, 0}, {k * 2 + 2.5, 0.5, 0}, {k * 2 + 2.5, 2.5, 0}, {k * 2 + 0.5, 2.5, 0}};
    CagRegion *region = polygon(square, 4);
    CagRaster *r = covered(region, (CagGrid){0, 0, 1, 5, 3}, CAG_PIXEL_CENTER);
    for (size_t y = 0; y < 3; y++)
      for (size_t x = 0; x < 5; x++)
        assert_true(*cag_raster_at(r, 0, x, y) ==
                    ((int)x >= 2 * k && (int)x < 2 * k + 2 && y >= 1 ? 1 : 0));
    cag_raster_release(r);
    cag_region_release(region);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_triangle_covers_known_fractions),
      cmocka_unit_test(fractions_are_areas_of_intersections),
      cmocka_unit_test(a_disk_adds_up_to_its_area),
      cmocka_unit_test(parts_outside_of_the_grid_are_cut_off),
      cmocka_unit_test(huge_shapes_are_cut_off),
      cmocka_unit_test(splines_add_up_to_their_area),
      cmocka_unit_test(centers_of_a_ring_are_counted),
      cmocka_unit_test(centers_on_edges_belong_to_one_side),
  };
  return cmocka_run_group_tests_name("coverage of pixels", tests, NULL, NULL);
}
