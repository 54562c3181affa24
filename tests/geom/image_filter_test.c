// Filters, morphology, histograms, and edges of images, against the reference's numbers and slow
// algorithms.

#include "geom/image/edges.h"
#include "geom/image/filter.h"
#include "geom/image/histogram.h"
#include "geom/image/lines.h"
#include "geom/image/morphology.h"
#include "image_support.h"

static void near_rows(const CagRaster *r, const double *expected, double tolerance) {
  for (size_t i = 0; i < r->width * r->height; i++) {
    if (isnan(expected[i])) assert_true(isnan(r->data[i]));
    else NEAR(r->data[i], expected[i], tolerance);
  }
}

static CagRaster *gray(size_t width, size_t height, const double *values) {
  CagRaster *r;
  OK(cag_raster_new(width, height, 1, &r, &err));
  memcpy(r->data, values, width * height * sizeof *values);
  return r;
}

// --- Filters ---

static void a_median_removes_noise(void **state) {
  (void)state;
  static const double given[] = {10, 10, 10, 80, 80, 10, 200, 10, 80, 80,
                                 10, 10, 10, 80, 0,  10, 10,  10, 80, 80};
  static const double expected[] = {10, 10, 10, 80, 80, 10, 10, 10, 80, 80,
                                    10, 10, 10, 80, 80, 10, 10, 10, 80, 80};
  CagRaster *r = gray(5, 4, given), *m;
  OK(cag_image_median(r, 3, CAG_BORDER_REPLICATE, &m, &err));
  near_rows(m, expected, 0);
  cag_raster_release(m);
  cag_raster_release(r);
}

static int by_value(const void *a, const void *b) {
  const double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

static void medians_agree_with_sorted_windows(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 60; round++) {
    const long reach = round % 4, size = 2 * reach + 1;
    const CagBorder border = (CagBorder)(round % 3);
    CagRaster *r = random_picture(1 + (size_t)uniform(0, 300), 1 + (size_t)uniform(0, 9), 20, 0.1);
    if (round % 2)
      for (size_t i = 0; i < r->width * r->height; i += 3) r->data[i] = NAN;
    CagRaster *m;
    OK(cag_image_median(r, (size_t)size, border, &m, &err));
    for (size_t i = 0; i < r->width * r->height; i++) {
      double window[49];
      size_t n = 0;
      for (long k = 0; k < size * size; k++) {
        const long x = cag_border_index((long)(i % r->width) + k % size - reach, r->width, border);
        const long y = cag_border_index((long)(i / r->width) + k / size - reach, r->height, border);
        const double v = x < 0 || y < 0 ? 0 : pixel_or(r, x, y, NAN);
        if (!isnan(v)) window[n++] = v;
      }
      qsort(window, n, sizeof *window, by_value);
      if (n == 0) assert_true(isnan(m->data[i]));
      else NEAR(m->data[i], (window[n / 2] + window[(n - 1) / 2]) / 2, 0);
    }
    cag_raster_release(m);
    cag_raster_release(r);
  }
}

static void borders_replicate_reflect_or_are_zero(void **state) {
  (void)state;
  assert_int_equal(cag_border_index(-2, 4, CAG_BORDER_REPLICATE), 0);
  assert_int_equal(cag_border_index(5, 4, CAG_BORDER_REPLICATE), 3);
  assert_int_equal(cag_border_index(-1, 4, CAG_BORDER_ZERO), -1);
  const long reflected[] = {3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0};
  for (long i = 0; i < 13; i++)
    assert_int_equal(cag_border_index(i - 5, 4, CAG_BORDER_REFLECT), reflected[i]);
}

static void sharpening_raises_a_step(void **state) {
  (void)state;
  static const double given[] = {10, 10, 10, 80, 80, 80}, expected[] = {10, 10, -25, 115, 80, 80};
  CagRaster *r = gray(6, 1, given), *s;
  OK(cag_image_sharpen(r, 0.5, CAG_BORDER_REPLICATE, &s, &err));
  near_rows(s, expected, 1e-12);
  cag_raster_release(s);
  cag_raster_release(r);
}

static void a_convolution_reproduces_its_kernel(void **state) {
  (void)state;
  static const double kernel[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  CagRaster *r = picture("00000/00000/00100/00000/00000"), *c;
  OK(cag_image_convolve(r, kernel, 3, 3, CAG_BORDER_ZERO, &c, &err));
  for (size_t i = 0; i < 9; i++) NEAR(*cag_raster_at(c, 0, 1 + i % 3, 1 + i / 3), kernel[i], 0);
  cag_raster_release(c);
  // A pixel without a value removes those of the windows that contain it.
  *cag_raster_at(r, 0, 0, 0) = NAN;
  OK(cag_image_convolve(r, kernel, 3, 3, CAG_BORDER_ZERO, &c, &err));
  assert_true(isnan(*cag_raster_at(c, 0, 1, 1)) && !isnan(*cag_raster_at(c, 0, 2, 2)));
  cag_raster_release(c);
  cag_raster_release(r);
}

// The variance of a blurred point is that of the Gaussian, less the part beyond 4 sigma.
static void a_blur_spreads_by_its_sigma(void **state) {
  (void)state;
  const double sigma = 3;
  CagRaster *r, *b;
  double sum = 0, square = 0;
  OK(cag_raster_new(61, 61, 1, &r, &err));
  *cag_raster_at(r, 0, 30, 30) = 1;
  OK(cag_image_blur(r, sigma, CAG_BORDER_ZERO, &b, &err));
  for (size_t i = 0; i < 61 * 61; i++) {
    const double x = (double)(i % 61) - 30;
    sum += b->data[i];
    square += b->data[i] * x * x;
  }
  NEAR(sum, 1, 1e-12);
  NEAR(square, sigma * sigma, 0.02);
  cag_raster_release(b);
  cag_raster_release(r);
}

static void thresholds_keep_equal_values(void **state) {
  (void)state;
  static const double given[] = {10, 120, NAN, 119}, binary[] = {0, 1, NAN, 0};
  static const double kept[] = {0, 120, NAN, 0};
  CagRaster *r = gray(4, 1, given), *t;
  OK(cag_image_threshold(r, 120, false, &t, &err));
  near_rows(t, binary, 0);
  cag_raster_release(t);
  OK(cag_image_threshold(r, 120, true, &t, &err));
  near_rows(t, kept, 0);
  cag_raster_release(t);
  cag_raster_release(r);
}

// --- Morphology ---

static void dilation_and_erosion_agree_with_windows(void **state) {
  (void)state;
  seed = 4;
  for (int round = 0; round < 60; round++) {
    const long reach = (long)uniform(0, 12);
    CagRaster *r = random_picture(1 + (size_t)uniform(0, 40), 1 + (size_t)uniform(0, 40), 99, 0.3);
    CagRaster *most, *least;
    for (size_t i = 0; i < r->width * r->height; i += 2) r->data[i] = NAN;
    OK(cag_image_dilate(r, (size_t)(2 * reach + 1), &most, &err));
    OK(cag_image_erode(r, (size_t)(2 * reach + 1), &least, &err));
    for (long y = 0; y < (long)r->height; y++)
      for (long x = 0; x < (long)r->width; x++) {
        double high = NAN, low = NAN; // fmax and fmin skip NaN
        for (long v = y - reach; v <= y + reach; v++)
          for (long u = x - reach; u <= x + reach; u++) {
            high = fmax(high, pixel_or(r, u, v, NAN));
            low = fmin(low, pixel_or(r, u, v, NAN));
          }
        const double a = pixel_or(most, x, y, 0), b = pixel_or(least, x, y, 0);
        assert_true(isnan(high) ? isnan(a) : a == high);
        assert_true(isnan(low) ? isnan(b) : b == low);
      }
    cag_raster_release(most);
    cag_raster_release(least);
    cag_raster_release(r);
  }
}

static void distances_agree_with_all_pairs(void **state) {
  (void)state;
  seed = 5;
  for (int round = 0; round < 60; round++) {
    CagRaster *d, *r = random_picture(1 + (size_t)uniform(0, 30), 1 + (size_t)uniform(0, 30), 1,
                                      round % 2 ? 0.02 : 0.4);
    const size_t w = r->width, n = w * r->height;
    OK(cag_distance_transform(r, &d, &err));
    for (size_t i = 0; i < n; i++) {
      double nearest = INFINITY;
      for (size_t k = 0; k < n; k++) {
        if (r->data[k] != 0) continue;
        nearest = fmin(nearest,
                       hypot((double)(i % w) - (double)(k % w), (double)(i / w) - (double)(k / w)));
      }
      if (isinf(nearest)) assert_true(isnan(d->data[i]));
      else NEAR(d->data[i], nearest, 1e-13);
    }
    cag_raster_release(d);
    cag_raster_release(r);
  }
}

// --- Histograms ---

static void otsu_finds_the_threshold_of_the_reference(void **state) {
  (void)state;
  static const int bins[][2] = {{20, 3}, {22, 6}, {25, 2}, {150, 1}, {198, 7}, {200, 12}, {203, 4}};
  double counts[256] = {0};
  CagOtsu o;
  for (int i = 0; i < 7; i++) counts[bins[i][0]] = bins[i][1];
  OK(cag_otsu(counts, 256, &o, &err));
  NEAR(o.low, 26, 0);
  NEAR(o.high, 150, 0);
  NEAR(o.threshold, 88, 0);
  NEAR(o.variance, 6663.006802721089, 1e-9);
  NEAR(o.below, 11, 0);
  NEAR(o.above, 24, 0);
  memset(counts, 0, sizeof counts);
  FAILS(cag_otsu(counts, 256, &o, &err), "single-level-histogram");
  counts[3] = 9;
  FAILS(cag_otsu(counts, 256, &o, &err), "single-level-histogram");
}

static void histograms_count_codes_only(void **state) {
  (void)state;
  static const double codes[] = {0, 3, 3, NAN}, half[] = {0, 0.5, 1, 1};
  CagRaster *a = gray(2, 2, codes), *b = gray(2, 2, half);
  double counts[4] = {0};
  OK(cag_histogram(a, 4, counts, &err));
  assert_true(counts[0] == 1 && counts[1] == 0 && counts[2] == 0 && counts[3] == 2);
  FAILS(cag_histogram(a, 3, counts, &err), "image-codes");
  FAILS(cag_histogram(b, 4, counts, &err), "image-codes");
  cag_raster_release(a);
  cag_raster_release(b);
}

// --- Edges ---

static void roberts_finds_a_diagonal_step(void **state) {
  (void)state;
  static const double given[] = {10, 10, 10, 10, 10, 10, 10, 10, 50, 50,
                                 10, 10, 50, 50, 50, 10, 50, 50, 50, 50};
  const double magnitudes[] = {0, 0, 40, 40 * sqrt(2), 0, 40, 40, 0, 40, 40, 0, 0};
  const double directions[] = {NAN, NAN, -45, -90, NAN, -45, -45, NAN, -45, -45, NAN, NAN};
  CagRaster *r = gray(5, 4, given), *m, *d;
  OK(cag_edges_roberts(r, &m, &d, &err));
  assert_true(m->width == 4 && m->height == 3);
  near_rows(m, magnitudes, 1e-13);
  near_rows(d, directions, 1e-13);
  cag_raster_release(m);
  cag_raster_release(d);
  cag_raster_release(r);
}

// The plane a x + b y has the gradient [a, b].
static void directions_are_those_of_ramps(void **state) {
  (void)state;
  for (int k = -7; k <= 8; k++) {
    const double angle = k * M_PI / 8, a = cos(angle), b = sin(angle);
    CagRaster *r, *m, *d;
    OK(cag_raster_new(5, 5, 1, &r, &err));
    for (size_t i = 0; i < 25; i++) r->data[i] = a * (double)(i % 5) - b * (double)(i / 5);
    for (int sobel = 0; sobel < 2; sobel++) {
      if (sobel) OK(cag_edges_sobel(r, &m, &d, &err));
      else OK(cag_edges_roberts(r, &m, &d, &err));
      NEAR(*cag_raster_at(m, 0, 2, 2), sobel ? 8 : sqrt(2), 1e-13);
      NEAR(remainder(*cag_raster_at(d, 0, 2, 2) - 22.5 * k, 360), 0, 1e-12);
      cag_raster_release(m);
      cag_raster_release(d);
    }
    cag_raster_release(r);
  }
}

// The edge of a disk is a closed curve one pixel wide near its circle.
static void canny_follows_a_circle(void **state) {
  (void)state;
  const double radius = 20, center = 32;
  CagRaster *r, *e;
  size_t n = 0;
  OK(cag_raster_new(64, 64, 1, &r, &err));
  for (size_t i = 0; i < 64 * 64; i++)
    r->data[i] = hypot((double)(i % 64) + 0.5 - center, (double)(i / 64) + 0.5 - center) <= radius;
  OK(cag_edges_canny(r, 0.5, 2, 1, &e, &err));
  for (size_t i = 0; i < 64 * 64; i++) {
    if (e->data[i] == 0) continue;
    n++;
    NEAR(hypot((double)(i % 64) + 0.5 - center, (double)(i / 64) + 0.5 - center), radius, 1.1);
  }
  // A digital circle has 4 sqrt(2) r pixels if it is connected by 8 neighbors, and 8 r if by 4.
  assert_true((double)n > 4 * sqrt(2) * radius - 4 && (double)n < 8 * radius + 4);
  cag_raster_release(e);
  cag_raster_release(r);
}

static void weak_edges_need_a_strong_one(void **state) {
  (void)state;
  CagRaster *r, *e;
  OK(cag_raster_new(30, 11, 1, &r, &err));
  // A step of 1 on the left; on the right, one of 1 that grows to 10.
  for (size_t i = 0; i < 30 * 11; i++) {
    const size_t x = i % 30, y = i / 30;
    r->data[i] = x < 8 ? 0 : x < 20 ? 1 : 2 + 0.9 * (double)y;
  }
  OK(cag_edges_canny(r, 2, 10, 0, &e, &err));
  for (size_t y = 1; y < 10; y++) {
    NEAR(*cag_raster_at(e, 0, 7, y) + *cag_raster_at(e, 0, 8, y), 0, 0);
    NEAR(*cag_raster_at(e, 0, 19, y) + *cag_raster_at(e, 0, 20, y), 1, 0);
  }
  cag_raster_release(e);
  cag_raster_release(r);
}

// --- Lines and corners ---

static void lines_are_fitted_to_their_pixels(void **state) {
  (void)state;
  CagRaster *r;
  CagImageLine *lines;
  size_t n;
  OK(cag_raster_new(120, 80, 1, &r, &err));
  for (size_t x = 0; x < 120; x++) { // y up: y = 10 + x / 2, and the column x = 100
    const double up = floor(10 + ((double)x + 0.5) / 2);
    if (up < 80) *cag_raster_at(r, 0, x, 79 - (size_t)up) = 1;
  }
  for (size_t y = 0; y < 40; y++) *cag_raster_at(r, 0, 100, y) = 1;
  OK(cag_hough_lines(r, 5, &lines, &n, &err));
  assert_int_equal(n, 2);
  NEAR(lines[0].theta, atan(0.5) * 180 / M_PI, 0.1);
  NEAR(lines[0].distance, 10 * cos(atan(0.5)), 0.4);
  NEAR(lines[0].start.x, 0.5, 0.5);
  NEAR(lines[0].end.x, 119.5, 0.5);
  NEAR(fabs(lines[1].theta), 90, 1e-9);
  NEAR(lines[1].start.x, 100.5, 1e-9);
  NEAR(lines[1].end.x, 100.5, 1e-9);
  // Pixels near the crossing belong to the first line.
  assert_in_range(lines[0].pixels, 120, 123);
  assert_in_range(lines[1].pixels, 36, 39);
  free(lines);
  cag_raster_release(r);
}

static void corners_are_where_edges_meet(void **state) {
  (void)state;
  CagRaster *r;
  CagImageCorner *c;
  size_t n;
  OK(cag_raster_new(40, 30, 1, &r, &err));
  for (size_t y = 8; y < 20; y++)
    for (size_t x = 10; x < 31; x++) *cag_raster_at(r, 0, x, y) = 5;
  OK(cag_image_corners(r, 10, &c, &n, &err));
  assert_int_equal(n, 4);
  for (size_t i = 0; i < n; i++) { // y up: 10..31 x 10..22
    NEAR(fmin(fabs(c[i].at.x - 10), fabs(c[i].at.x - 31)), 0, 0.3);
    NEAR(fmin(fabs(c[i].at.y - 10), fabs(c[i].at.y - 22)), 0, 0.3);
  }
  free(c);
  cag_raster_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_median_removes_noise),
      cmocka_unit_test(medians_agree_with_sorted_windows),
      cmocka_unit_test(borders_replicate_reflect_or_are_zero),
      cmocka_unit_test(sharpening_raises_a_step),
      cmocka_unit_test(a_convolution_reproduces_its_kernel),
      cmocka_unit_test(a_blur_spreads_by_its_sigma),
      cmocka_unit_test(thresholds_keep_equal_values),
      cmocka_unit_test(dilation_and_erosion_agree_with_windows),
      cmocka_unit_test(distances_agree_with_all_pairs),
      cmocka_unit_test(otsu_finds_the_threshold_of_the_reference),
      cmocka_unit_test(histograms_count_codes_only),
      cmocka_unit_test(roberts_finds_a_diagonal_step),
      cmocka_unit_test(directions_are_those_of_ramps),
      cmocka_unit_test(canny_follows_a_circle),
      cmocka_unit_test(weak_edges_need_a_strong_one),
      cmocka_unit_test(lines_are_fitted_to_their_pixels),
      cmocka_unit_test(corners_are_where_edges_meet),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
