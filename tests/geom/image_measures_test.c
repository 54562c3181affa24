// Labels, measures, contours, and moments of images, against the reference's numbers, closed
// formulas, and slow algorithms.

#include "geom/image/contour.h"
#include "geom/image/moments.h"
#include "geom/image/silhouette.h"
#include "image_support.h"

static CagMeasures measure(const CagRaster *r, int connectivity, CagMass mass) {
  CagLabels l;
  CagMeasures m;
  OK(cag_labels_new(r, connectivity, &l, &err));
  OK(cag_measure_figure(r, &l, 0, mass, &m, &err));
  cag_labels_free(&l);
  return m;
}

// --- Labels ---

static void labels_are_in_raster_order(void **state) {
  (void)state;
  CagRaster *r = picture(PICTURE_SCENE);
  CagLabels l;
  OK(cag_labels_new(r, 8, &l, &err));
  assert_int_equal(l.count, 4);
  assert_int_equal(l.at[4 * 7 + 3], 2); // touches the ring at a corner
  assert_int_equal(l.at[5 * 7 + 1], 3);
  cag_labels_free(&l);
  OK(cag_labels_new(r, 4, &l, &err));
  assert_int_equal(l.count, 6);
  assert_int_equal(l.at[4 * 7 + 3], 4);
  cag_labels_free(&l);
  cag_raster_release(r);
}

// Fills the region of [x, y] by searching neighbors.
static void flood(const CagRaster *r, uint32_t *at, uint32_t label, int connectivity, long x,
                  long y) {
  if (pixel_or(r, x, y, 0) == 0 || at[(size_t)y * r->width + (size_t)x]) return;
  at[(size_t)y * r->width + (size_t)x] = label;
  for (int k = 0; k < 8; k += connectivity == 4 ? 2 : 1)
    flood(r, at, label, connectivity, x + cag_contour_step[k][0], y + cag_contour_step[k][1]);
}

static void labels_agree_with_flood_fill(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 60; round++) {
    const int connectivity = round % 2 ? 4 : 8;
    CagRaster *r = random_picture(1 + (size_t)uniform(0, 40), 1 + (size_t)uniform(0, 40), 1,
                                  uniform(0.1, 0.9));
    CagLabels l;
    uint32_t count = 0, *at = calloc(r->width * r->height, sizeof *at);
    OK(cag_labels_new(r, connectivity, &l, &err));
    for (size_t i = 0; i < r->width * r->height; i++) {
      if (r->data[i] > 0 && !at[i])
        flood(r, at, ++count, connectivity, (long)(i % r->width), (long)(i / r->width));
    }
    assert_int_equal(l.count, count);
    assert_memory_equal(l.at, at, r->width * r->height * sizeof *at);
    free(at);
    cag_labels_free(&l);
    cag_raster_release(r);
  }
}

// --- Measures ---

static void an_l_has_the_measures_of_the_reference(void **state) {
  (void)state;
  CagRaster *r = picture(PICTURE_L);
  const CagMeasures m = measure(r, 8, CAG_MASS_AREA), p = measure(r, 8, CAG_MASS_POINT);
  NEAR(m.area, 18, 0);
  NEAR(m.centroid[0], 17.0 / 6, 1e-14);
  NEAR(m.centroid[1], 10.0 / 3, 1e-14);
  NEAR(m.center[0], 2.5, 1e-14);
  NEAR(m.center[1], 2.8, 1e-14);
  NEAR(m.xx, 67.0 / 36, 1e-14);
  NEAR(m.yy, 3, 1e-14);
  NEAR(m.xy, -10.0 / 9, 1e-14);
  NEAR(m.theta, -58.567569811038446, 1e-12);
  NEAR(m.least, 1.1820224656683833, 1e-13);
  NEAR(m.greatest, 3.6790886454427283, 1e-13);
  NEAR(m.roundness, 0.27006172839506176, 1e-15);
  NEAR(m.thinness, 0.5136821855535795, 1e-14);
  NEAR(m.perimeter, 22, 0);
  NEAR(m.chain_length, 16 + sqrt(2), 1e-14);
  NEAR(m.r_min, 1.0 / 6, 1e-14);
  NEAR(m.r_max, 4.099457958749614, 1e-14);
  NEAR(p.r_min, 0.372677996249965, 1e-14);
  NEAR(p.r_max, 3.435921354681384, 1e-14);
  NEAR(p.xx, 16.0 / 9, 1e-14);
  assert_true(m.holes == 0 && m.euler == 1 && !m.touches_border && m.has_direction);
  // The figure is longer upward: theta points down.
  NEAR(m.direction, 180 - 58.567569811038446, 1e-12);
  cag_raster_release(r);
}

static void undefined_measures_are_marked(void **state) {
  (void)state;
  CagRaster *square = picture("00000/01110/01110/01110/00000"), *pixel = picture("001/000");
  const CagMeasures s = measure(square, 8, CAG_MASS_AREA), p = measure(pixel, 8, CAG_MASS_POINT);
  assert_false(s.has_theta);
  NEAR(s.thinness, 0, 0);
  NEAR(s.roundness, 1.0 / 6, 1e-15);
  assert_true(!p.has_theta && !p.has_thinness && !p.has_direction && p.touches_border);
  NEAR(measure(pixel, 8, CAG_MASS_AREA).roundness, 1.0 / 6, 1e-15);
  cag_raster_release(square);
  cag_raster_release(pixel);
}

static void a_gap_at_the_median_is_halved(void **state) {
  (void)state;
  CagRaster *r = picture("1100011");
  NEAR(measure(r, 8, CAG_MASS_AREA).center[0], 3.5, 0);
  cag_raster_release(r);
}

static void pixels_without_a_value_are_skipped(void **state) {
  (void)state;
  CagRaster *r = picture("-1-/-11");
  const CagMeasures m = measure(r, 8, CAG_MASS_AREA);
  NEAR(m.area, 3, 0);
  NEAR(m.centroid[0], 11.0 / 6, 1e-15);
  cag_raster_release(r);
}

static void figures_without_pixels_and_bad_weights_fail(void **state) {
  (void)state;
  CagRaster *r = picture("00/00");
  CagLabels l;
  CagMeasures m;
  double moment;
  const CagMassOf of = {.raster = r};
  OK(cag_labels_new(r, 8, &l, &err));
  FAILS(cag_measure_figure(r, &l, 0, CAG_MASS_AREA, &m, &err), "empty-image");
  FAILS(cag_moment(&of, 1, 1, &moment, &err), "empty-image");
  cag_labels_free(&l);
  r->data[3] = -1;
  FAILS(cag_labels_new(r, 8, &l, &err), "gray-weight");
  FAILS(cag_moment(&of, 1, 1, &moment, &err), "gray-weight");
  r->data[3] = INFINITY;
  FAILS(cag_labels_new(r, 8, &l, &err), "gray-weight");
  cag_raster_release(r);
}

// Euler's number by counting 2 x 2 windows with one, three, and two diagonal pixels (Gray 1971).
static long euler_of_windows(const CagRaster *r, int connectivity) {
  long one = 0, three = 0, diagonal = 0;
  for (long y = -1; y < (long)r->height; y++)
    for (long x = -1; x < (long)r->width; x++) {
      const bool a = pixel_or(r, x, y, 0) > 0, b = pixel_or(r, x + 1, y, 0) > 0;
      const bool c = pixel_or(r, x, y + 1, 0) > 0, d = pixel_or(r, x + 1, y + 1, 0) > 0;
      one += a + b + c + d == 1;
      three += a + b + c + d == 3;
      diagonal += a + b + c + d == 2 && a == d;
    }
  return (one - three + (connectivity == 8 ? -2 : 2) * diagonal) / 4;
}

static void euler_and_holes_agree_with_other_counts(void **state) {
  (void)state;
  seed = 2;
  for (int round = 0; round < 100; round++) {
    const int connectivity = round % 2 ? 4 : 8;
    CagRaster *r = random_picture(1 + (size_t)uniform(0, 30), 1 + (size_t)uniform(0, 30), 1,
                                  uniform(0.1, 0.7));
    CagLabels l;
    CagContours c;
    CagMeasures m, part;
    long holes = 0, hole_contours = 0, perimeter = 0;
    double chain = 0;
    OK(cag_labels_new(r, connectivity, &l, &err));
    if (l.count > 0) {
      OK(cag_measure_figure(r, &l, 0, CAG_MASS_AREA, &m, &err));
      OK(cag_contours_new(&l, &c, &err));
      for (size_t k = 1; k <= l.count; k++) {
        OK(cag_measure_figure(r, &l, k, CAG_MASS_AREA, &part, &err));
        holes += part.holes;
        perimeter += (long)part.perimeter;
        chain += part.chain_length;
        assert_int_equal(part.euler, 1 - part.holes);
      }
      for (size_t i = 0; i < c.count; i++) hole_contours += c.items[i].hole;
      assert_int_equal(m.euler, euler_of_windows(r, connectivity));
      assert_int_equal(m.holes, holes);
      assert_int_equal(hole_contours, holes);
      assert_int_equal(c.count, l.count + (size_t)holes);
      assert_int_equal((long)m.perimeter, perimeter);
      NEAR(m.chain_length, chain, 1e-9);
      cag_contours_free(&c);
    }
    cag_labels_free(&l);
    cag_raster_release(r);
  }
}

// --- Contours ---

static void a_contour_of_an_l_is_that_of_the_reference(void **state) {
  (void)state;
  static const uint8_t code[] = {6, 6, 6, 6, 6, 0, 0, 0, 0, 2, 4, 4, 3, 2, 2, 2, 4};
  CagRaster *r = picture(PICTURE_L);
  CagLabels l;
  CagContours c;
  OK(cag_labels_new(r, 8, &l, &err));
  OK(cag_contours_new(&l, &c, &err));
  assert_int_equal(c.count, 1);
  assert_true(c.items[0].x == 1 && c.items[0].y == 1 && !c.items[0].hole);
  assert_int_equal(c.items[0].count, sizeof code);
  assert_memory_equal(c.items[0].code, code, sizeof code);
  NEAR(c.items[0].area, 8.5, 0);
  NEAR(c.items[0].length, 16 + sqrt(2), 1e-14);
  cag_contours_free(&c);
  cag_labels_free(&l);
  cag_raster_release(r);
}

// Pick's theorem: a simple path through the centers of pixels encloses area + steps / 2 + 1 of
// them, those on the path included.
static void contours_of_disks_obey_pick(void **state) {
  (void)state;
  for (int radius = 2; radius < 30; radius += 3) {
    const double center = radius + 1.5;
    size_t pixels = 0;
    CagRaster *r;
    OK(cag_raster_new((size_t)(2 * radius + 3), (size_t)(2 * radius + 3), 1, &r, &err));
    for (size_t i = 0; i < r->width * r->height; i++) {
      const double x = (double)(i % r->width) + 0.5, y = (double)(i / r->width) + 0.5;
      r->data[i] = hypot(x - center, y - center) <= radius;
      pixels += r->data[i] > 0;
    }
    CagLabels l;
    CagContours c;
    OK(cag_labels_new(r, 8, &l, &err));
    OK(cag_contours_new(&l, &c, &err));
    NEAR(c.items[0].area + (double)c.items[0].count / 2 + 1, (double)pixels, 0);
    cag_contours_free(&c);
    cag_labels_free(&l);
    cag_raster_release(r);
  }
}

static void holes_run_clockwise(void **state) {
  (void)state;
  CagRaster *r = picture("111/101/111");
  CagLabels l;
  CagContours c;
  // The path around the hole cuts the corners if diagonal neighbors connect.
  for (int k = 0; k < 2; k++) {
    OK(cag_labels_new(r, k ? 4 : 8, &l, &err));
    OK(cag_contours_new(&l, &c, &err));
    assert_int_equal(c.count, 2);
    assert_true(c.items[1].hole);
    assert_int_equal(c.items[1].count, k ? 8 : 4);
    // Both start at the pixel on the left of the hole.
    assert_true(c.items[1].x == 0 && c.items[1].y == 1);
    int turn = 0;
    for (size_t i = 0; i < c.items[1].count; i++) {
      const int a = c.items[1].code[i], b = c.items[1].code[(i + 1) % c.items[1].count];
      turn += (b - a + 12) % 8 - 4;
    }
    assert_int_equal(turn, -8);
    NEAR(c.items[1].area, k ? 4 : 2, 0);
    cag_contours_free(&c);
    cag_labels_free(&l);
  }
  cag_raster_release(r);
}

// --- Moments ---

#define PICTURE_FLAG "0000000/0111110/0111110/0110010/0110000/0110000/0000000"

static void moments_are_those_of_the_reference(void **state) {
  (void)state;
  CagRaster *r = picture(PICTURE_FLAG);
  CagMassOf of = {.raster = r};
  double m, p[2];
  OK(cag_moment(&of, 0, 0, &m, &err));
  NEAR(m, 17, 0);
  OK(cag_moment(&of, 1, 0, &m, &err));
  NEAR(m, 0, 0);
  OK(cag_moment(&of, 2, 0, &m, &err));
  NEAR(m, 37.53431372549019, 1e-12);
  OK(cag_moment(&of, 1, 2, &m, &err));
  NEAR(m, -14.04152249134948, 1e-12);
  OK(cag_polar_moment(&of, 3, 3, p, &err));
  NEAR(p[0], 68.9273356401384, 1e-11);
  NEAR(p[1], 37.993079584775074, 1e-11);
  OK(cag_polar_moment(&of, 4, 4, p, &err));
  NEAR(p[0], -61.84409050817561, 1e-11);
  OK(cag_polar_moment(&of, 2, 4, p, &err));
  NEAR(p[1], 185.26847140240181, 1e-11);
  of.mass = CAG_MASS_POINT;
  OK(cag_moment(&of, 0, 2, &m, &err));
  NEAR(m, 30.235294117647058, 1e-12);
  cag_raster_release(r);
}

static CagRegion *circle_region(double radius, double hole) {
  CagCurve *outer, *inner = NULL;
  CagTransform frame = cag_translate(cag_vec3(3, -2, 0));
  frame.planar = true;
  CagRegion *r;
  OK(cag_curve_arc(radius, radius, 0, 2 * M_PI, &frame, &outer, &err));
  if (hole > 0) OK(cag_curve_arc(hole, hole, 0, 2 * M_PI, &frame, &inner, &err));
  OK(cag_region_new(outer, &inner, inner ? 1 : 0, &r, &err));
  cag_curve_release(outer);
  if (inner) cag_curve_release(inner);
  return r;
}

// The moment x^4 of a disk is pi r^6 / 8.
static void moments_of_a_disk_are_exact(void **state) {
  (void)state;
  CagRegion *r = circle_region(1.5, 0);
  const CagMassOf of = {.region = r};
  double m;
  OK(cag_moment(&of, 4, 0, &m, &err));
  NEAR(m, M_PI * pow(1.5, 6) / 8, 1e-11);
  OK(cag_moment(&of, 2, 2, &m, &err));
  NEAR(m, M_PI * pow(1.5, 6) / 24, 1e-11);
  cag_region_release(r);
}

static CagRegion *polygon_region(const double (*xy)[2], size_t n) {
  CagVec3 p[16];
  CagCurve *c;
  CagRegion *r;
  for (size_t i = 0; i < n; i++) p[i] = cag_vec3(xy[i][0], xy[i][1], 0);
  OK(cag_curve_polyline(p, n, true, 2, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  cag_curve_release(c);
  return r;
}

static void a_turn_is_found_modulo_the_order(void **state) {
  (void)state;
  static const double part[6][2] = {{0, 0}, {6, 0}, {6, 1}, {2, 1}, {2, 3}, {0, 3}};
  const double angle = 205 * M_PI / 180;
  double turned[6][2];
  for (int i = 0; i < 6; i++) {
    turned[i][0] = 9 + cos(angle) * part[i][0] - sin(angle) * part[i][1];
    turned[i][1] = -4 + sin(angle) * part[i][0] + cos(angle) * part[i][1];
  }
  CagRegion *a = polygon_region(part, 6), *b = polygon_region(turned, 6);
  const CagMassOf of_a = {.region = a}, of_b = {.region = b};
  for (int m = 1; m <= 7; m++) {
    bool defined;
    double found;
    OK(cag_turn_between(&of_a, &of_b, m, &defined, &found, &err));
    assert_true(defined);
    NEAR(found, fmod(205, 360.0 / m), 1e-9);
  }
  cag_region_release(a);
  cag_region_release(b);
}

static void a_symmetric_part_has_no_turn(void **state) {
  (void)state;
  static const double bar[4][2] = {{-4, -1}, {4, -1}, {4, 1}, {-4, 1}};
  CagRegion *a = polygon_region(bar, 4);
  CagRaster *r = picture("0000/0111/0111/0111");
  const CagMassOf of = {.region = a}, square = {.raster = r};
  bool defined;
  double angle;
  OK(cag_turn_between(&of, &of, 1, &defined, &angle, &err));
  assert_false(defined);
  OK(cag_turn_between(&of, &of, 2, &defined, &angle, &err));
  assert_true(defined);
  OK(cag_turn_between(&square, &square, 3, &defined, &angle, &err));
  assert_false(defined);
  OK(cag_turn_between(&square, &square, 4, &defined, &angle, &err));
  assert_true(defined);
  cag_region_release(a);
  cag_raster_release(r);
}

// --- Silhouettes ---

static void a_ring_has_the_measures_of_closed_formulas(void **state) {
  (void)state;
  CagRegion *r = circle_region(5, 4);
  CagMeasures m;
  OK(cag_measure_region(r, &m, &err));
  NEAR(m.area, 9 * M_PI, 1e-11);
  NEAR(m.xx, 10.25, 1e-10);
  NEAR(m.roundness, 41 / (18 * M_PI), 1e-11);
  NEAR(m.r_min, 4, 1e-12);
  NEAR(m.r_max, 5, 1e-12);
  NEAR(m.center[0], 3, 1e-9);
  NEAR(m.center[1], -2, 1e-9);
  NEAR(m.perimeter, 18 * M_PI, 1e-9);
  assert_true(m.holes == 1 && m.euler == 0 && !m.of_pixels && !m.has_theta);
  cag_region_release(r);
}

// The lines that halve a triangle parallel to a side are at 1 - sqrt(1/2) of its height.
static void a_median_of_a_triangle_halves_the_area(void **state) {
  (void)state;
  static const double corners[3][2] = {{0, 0}, {4, 0}, {0, 2}};
  CagRegion *r = polygon_region(corners, 3);
  CagMeasures m;
  OK(cag_measure_region(r, &m, &err));
  NEAR(m.center[0], 4 * (1 - sqrt(0.5)), 1e-10);
  NEAR(m.center[1], 2 * (1 - sqrt(0.5)), 1e-10);
  NEAR(m.r_max, hypot(4 - 4.0 / 3, 2.0 / 3), 1e-13);
  assert_true(m.has_direction);
  cag_region_release(r);
}

static void an_ellipse_reaches_its_vertices(void **state) {
  (void)state;
  CagCurve *c;
  CagRegion *r;
  CagMeasures m;
  CagTransform frame;
  OK(cag_rotate(cag_vec3(0, 0, 1), 0.3, cag_vec3(0, 0, 0), &frame, &err));
  frame.planar = true;
  OK(cag_curve_arc(4, 1.5, 0, 2 * M_PI, &frame, &c, &err));
  OK(cag_region_new(c, NULL, 0, &r, &err));
  OK(cag_measure_region(r, &m, &err));
  NEAR(m.r_max, 4, 1e-12);
  NEAR(m.r_min, 1.5, 1e-12);
  NEAR(m.theta, 0.3 * 180 / M_PI, 1e-8);
  NEAR(m.greatest, 4, 1e-9);
  NEAR(m.least, 0.5625, 1e-9);
  assert_false(m.has_direction);
  cag_curve_release(c);
  cag_region_release(r);
}

static void regions_without_area_fail(void **state) {
  (void)state;
  CagRegion *r;
  CagMeasures m;
  double p[2];
  OK(cag_region_empty(&r, &err));
  const CagMassOf of = {.region = r};
  FAILS(cag_measure_region(r, &m, &err), "empty-silhouette");
  FAILS(cag_polar_moment(&of, 2, 2, p, &err), "empty-silhouette");
  cag_region_release(r);
}

static void comparisons_count_pixels_and_areas(void **state) {
  (void)state;
  static const double left[4][2] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  static const double right[4][2] = {{1, 0}, {4, 0}, {4, 1}, {1, 1}};
  CagRaster *a = picture("0110/0110/0110"), *b = picture("0011/0110/1100"), *c = picture("01");
  CagRegion *p = polygon_region(left, 4), *q = polygon_region(right, 4);
  double different, overlap;
  OK(cag_compare_figures(a, b, &different, &overlap, &err));
  NEAR(different, 4, 0);
  NEAR(overlap, 0.5, 0);
  FAILS(cag_compare_figures(a, c, &different, &overlap, &err), "compared-sizes");
  OK(cag_compare_regions(p, q, &different, &overlap, &err));
  NEAR(different, 3, 1e-12);
  NEAR(overlap, 0.25, 1e-12);
  cag_region_release(p);
  cag_region_release(q);
  cag_raster_release(a);
  cag_raster_release(b);
  cag_raster_release(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(labels_are_in_raster_order),
      cmocka_unit_test(labels_agree_with_flood_fill),
      cmocka_unit_test(an_l_has_the_measures_of_the_reference),
      cmocka_unit_test(undefined_measures_are_marked),
      cmocka_unit_test(a_gap_at_the_median_is_halved),
      cmocka_unit_test(pixels_without_a_value_are_skipped),
      cmocka_unit_test(figures_without_pixels_and_bad_weights_fail),
      cmocka_unit_test(euler_and_holes_agree_with_other_counts),
      cmocka_unit_test(a_contour_of_an_l_is_that_of_the_reference),
      cmocka_unit_test(contours_of_disks_obey_pick),
      cmocka_unit_test(holes_run_clockwise),
      cmocka_unit_test(moments_are_those_of_the_reference),
      cmocka_unit_test(moments_of_a_disk_are_exact),
      cmocka_unit_test(a_turn_is_found_modulo_the_order),
      cmocka_unit_test(a_symmetric_part_has_no_turn),
      cmocka_unit_test(a_ring_has_the_measures_of_closed_formulas),
      cmocka_unit_test(a_median_of_a_triangle_halves_the_area),
      cmocka_unit_test(an_ellipse_reaches_its_vertices),
      cmocka_unit_test(regions_without_area_fail),
      cmocka_unit_test(comparisons_count_pixels_and_areas),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
