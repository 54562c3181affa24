// The figures of comparing pictures, on pictures small enough to compute them by hand.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "interp/render/compare.h"
#include "tests/geom/random.h"

static CagImage picture(size_t width, size_t height, const char *const *names, size_t channels) {
  CagImage image;
  assert_true(cag_image_create(&image, width, height, channels, NULL));
  for (size_t c = 0; c < channels; c++) cag_image_set_name(&image, c, names[c]);
  return image;
}

static const char *const RGB[] = {"R", "G", "B"};
static const char *const BGR[] = {"B", "G", "R"};
static const char *const Z[] = {"Z"};

static void equal_pictures_have_no_difference(void **state) {
  (void)state;
  CagImage a = picture(4, 3, RGB, 3), b = picture(4, 3, BGR, 3);
  for (size_t i = 0; i < 12; i++) cag_image_plane(&a, 0)[i] = cag_image_plane(&b, 2)[i] = (float)i;
  CagCompareReport r;
  assert_true(cag_compare_images(&a, "a", &b, "b", 0, &r, NULL));
  assert_int_equal(r.differing_pixels, 0);
  assert_true(r.channels[0].rmse == 0 && r.channels[0].psnr == INFINITY);
  assert_true(r.has_color && r.delta_e_mean == 0 && r.delta_e_largest == 0);
  cag_compare_report_free(&r);
  cag_image_free(&a);
  cag_image_free(&b);
}

static void figures_are_those_of_hand_calculation(void **state) {
  (void)state;
  CagImage a = picture(2, 2, Z, 1), b = picture(2, 2, Z, 1);
  const float x[4] = {0, 0.5f, 1, -0.25f}, y[4] = {0, 0.25f, 1.5f, -0.25f};
  memcpy(a.data, x, sizeof x);
  memcpy(b.data, y, sizeof y);
  CagCompareReport r;
  assert_true(cag_compare_images(&a, "a", &b, "b", 0.25, &r, NULL));
  const CagCompareChannel *z = &r.channels[0];
  // Squares: 0, 1/16, 1/4, 0; mean 5/64. Peak 1, so PSNR = -10 log10(5/64).
  assert_true(fabs(z->rmse - sqrt(5.0 / 64)) < 1e-15);
  assert_true(fabs(z->psnr - 10 * log10(64.0 / 5)) < 1e-12);
  assert_true(z->largest == 0.5 && z->largest_x == 0 && z->largest_y == 1 && z->peak == 1);
  assert_int_equal(r.differing_pixels, 1); // 0.25 is not more than 0.25
  cag_compare_report_free(&r);
  cag_image_free(&a);
  cag_image_free(&b);
}

static const char *const FOUR[] = {"R", "G", "B", "Z"};
static const char *const MIXED[] = {"Z", "B", "R", "G"};
static const size_t AT[] = {2, 3, 1, 0}; // of the channels of the first in the second

// Random pictures whose channels stand in another order, against the definitions. Some rows are
// equal, some samples are not finite.
static void figures_are_those_of_their_definitions(void **state) {
  (void)state;
  enum { W = 37, H = 23, N = W * H };
  seed = 61;
  for (int round = 0; round < 10; round++) {
    CagImage a = picture(W, H, FOUR, 4), b = picture(W, H, MIXED, 4), map;
    const double size = round % 2 ? 1 : 7, threshold = 0.6 * size;
    for (size_t i = 0; i < N; i++)
      for (size_t c = 0; c < 4; c++) {
        float *p = &cag_image_plane(&a, c)[i], *q = &cag_image_plane(&b, AT[c])[i];
        *p = (float)uniform(-0.2, size);
        *q = i / W % 3 == 0 ? *p : (float)uniform(-0.2, size);
        if (round > 5 && c == 3 && i % 50 == 7) *p = i % 100 == 7 ? NAN : INFINITY;
        if (round > 5 && c == 3 && i % 75 == 7) *q = *p;
      }
    CagCompareReport r;
    assert_true(cag_compare_images(&a, "a", &b, "b", threshold, &r, NULL));
    assert_true(cag_compare_heatmap(&a, &b, &map, NULL));
    assert_true(r.width == W && r.height == H && r.channel_count == 4);
    double most[N] = {0}, worst = 0, sum = 0, largest = 0;
    size_t differing = 0;
    for (size_t c = 0; c < 4; c++) {
      const CagCompareChannel *found = &r.channels[c];
      CagCompareChannel own = {.peak = 1};
      double squares = 0;
      for (size_t i = 0; i < N; i++) {
        const double p = cag_image_plane(&a, c)[i], q = cag_image_plane(&b, AT[c])[i];
        const bool same = p == q || (isnan(p) && isnan(q));
        const double d = same ? 0 : isfinite(p) && isfinite(q) ? fabs(p - q) : INFINITY;
        own.not_finite[0] += !isfinite(p);
        own.not_finite[1] += !isfinite(q);
        own.unlike += isinf(d);
        if (isfinite(p)) own.peak = fmax(own.peak, fabs(p));
        most[i] = fmax(most[i], d);
        if (!isfinite(p) || !isfinite(q)) continue;
        own.samples++;
        squares += d * d;
        if (d > own.largest) own.largest = d, own.largest_x = i % W, own.largest_y = i / W;
      }
      assert_string_equal(found->name, FOUR[c]);
      const double rmse = sqrt(squares / (double)own.samples);
      assert_true(fabs(found->rmse - rmse) < 1e-12 * size);
      assert_true(fabs(found->psnr - 20 * log10(own.peak / rmse)) < 1e-9);
      assert_true(found->largest == own.largest && found->largest_x == own.largest_x &&
                  found->largest_y == own.largest_y && found->peak == own.peak);
      assert_true(found->samples == own.samples && found->unlike == own.unlike &&
                  found->not_finite[0] == own.not_finite[0] &&
                  found->not_finite[1] == own.not_finite[1]);
    }
    for (size_t i = 0; i < N; i++) {
      double x[3], y[3], lab_x[3], lab_y[3];
      for (size_t c = 0; c < 3; c++) {
        x[c] = cag_image_plane(&a, c)[i];
        y[c] = cag_image_plane(&b, AT[c])[i];
      }
      cag_compare_lab(x, lab_x);
      cag_compare_lab(y, lab_y);
      const double e = cag_compare_delta_e(lab_x, lab_y);
      sum += e;
      largest = fmax(largest, e);
      differing += most[i] > threshold;
      if (isfinite(most[i])) worst = fmax(worst, most[i]);
    }
    assert_int_equal(r.differing_pixels, differing);
    assert_true(r.has_color && fabs(r.delta_e_largest - largest) < 1e-12);
    assert_true(fabs(r.delta_e_mean - sum / N) < 1e-9);
    for (size_t i = 0; i < N; i++) {
      const bool unlike = isinf(most[i]);
      const double t = 3 * most[i] / worst;
      const double rgb[3] = {unlike ? 1 : fmin(t, 1), unlike ? 0 : fmin(fmax(t - 1, 0), 1),
                             unlike ? 1 : fmin(fmax(t - 2, 0), 1)};
      for (size_t c = 0; c < 3; c++) assert_true(fabs(cag_image_plane(&map, c)[i] - rgb[c]) < 1e-6);
      assert_true(unlike ? isinf(cag_image_plane(&map, 3)[i])
                         : cag_image_plane(&map, 3)[i] == (float)most[i]);
    }
    cag_compare_report_free(&r);
    cag_image_free(&a);
    cag_image_free(&b);
    cag_image_free(&map);
  }
}

// CIEDE2000 is symmetric, zero for equal colors, and continuous where hues pass 0.
static void color_differences_are_symmetric_and_continuous(void **state) {
  (void)state;
  seed = 62;
  for (int i = 0; i < 3000; i++) {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; k++) {
      x[k] = k ? uniform(-80, 80) : uniform(0, 100);
      y[k] = k ? uniform(-80, 80) : uniform(0, 100);
      if (i % 3 == 0 && k == 2) y[k] = i % 2 ? 1e-9 : -1e-9; // on both sides of hue 0
      z[k] = y[k];
    }
    if (i % 3 == 0) y[1] = fabs(y[1]), z[1] = y[1], z[2] = -y[2];
    const double e = cag_compare_delta_e(x, y);
    assert_true(fabs(e - cag_compare_delta_e(y, x)) < 1e-9 && e > 0);
    // The formula jumps only where hues are opposite.
    const double turn =
        fabs(remainder(atan2(x[2], x[1]) - atan2(y[2], y[1]), 2 * 3.14159265358979));
    if (i % 3 == 0 && turn < 3) assert_true(fabs(e - cag_compare_delta_e(x, z)) < 1e-6);
    assert_true(cag_compare_delta_e(x, x) == 0);
  }
}

static void sides_and_channels_have_limits(void **state) {
  (void)state;
  CagImage image;
  CagError err;
  assert_true(cag_image_create(&image, CAG_IMAGE_SIDE_MAX, 1, 1, &err));
  cag_image_free(&image);
  assert_true(cag_image_create(&image, 1, CAG_IMAGE_SIDE_MAX, 1, &err));
  cag_image_free(&image);
  assert_true(cag_image_create(&image, 1, 1, CAG_IMAGE_CHANNELS_MAX, &err));
  cag_image_free(&image);
  assert_false(cag_image_create(&image, CAG_IMAGE_SIDE_MAX + 1, 1, 1, &err));
  assert_false(cag_image_create(&image, 1, CAG_IMAGE_SIDE_MAX + 1, 1, &err));
  assert_false(cag_image_create(&image, 1, 1, CAG_IMAGE_CHANNELS_MAX + 1, &err));
  assert_false(cag_image_create(&image, 0, 1, 1, &err));
  assert_false(cag_image_create(&image, 1, 0, 1, &err));
  assert_false(cag_image_create(&image, 1, 1, 0, &err));
}

static void the_peak_of_bright_channels_is_their_largest_value(void **state) {
  (void)state;
  CagImage a = picture(1, 1, Z, 1), b = picture(1, 1, Z, 1);
  a.data[0] = 100;
  b.data[0] = 99;
  CagCompareReport r;
  assert_true(cag_compare_images(&a, "a", &b, "b", 0, &r, NULL));
  assert_true(fabs(r.channels[0].psnr - 40) < 1e-12); // 20 log10(100 / 1)
  cag_compare_report_free(&r);
  cag_image_free(&a);
  cag_image_free(&b);
}

static void nan_and_infinity_are_counted_apart(void **state) {
  (void)state;
  CagImage a = picture(6, 1, Z, 1), b = picture(6, 1, Z, 1);
  const float x[6] = {NAN, NAN, INFINITY, INFINITY, 1, 2},
              y[6] = {NAN, 1, INFINITY, -INFINITY, 1, 5};
  memcpy(a.data, x, sizeof x);
  memcpy(b.data, y, sizeof y);
  CagCompareReport r;
  assert_true(cag_compare_images(&a, "a", &b, "b", 100, &r, NULL));
  const CagCompareChannel *z = &r.channels[0];
  assert_int_equal(z->not_finite[0], 4);
  assert_int_equal(z->not_finite[1], 3);
  assert_int_equal(z->unlike, 2);
  assert_int_equal(z->samples, 2);
  assert_true(fabs(z->rmse - 3 / sqrt(2)) < 1e-15);
  assert_int_equal(r.differing_pixels, 2);
  CagImage map;
  assert_true(cag_compare_heatmap(&a, &b, &map, NULL));
  assert_true(cag_image_plane(&map, 0)[1] == 1 && cag_image_plane(&map, 1)[1] == 0 &&
              cag_image_plane(&map, 2)[1] == 1 && isinf(cag_image_plane(&map, 3)[1]));
  cag_image_free(&map);
  cag_compare_report_free(&r);
  cag_image_free(&a);
  cag_image_free(&b);
}

static void pictures_of_other_shape_are_refused(void **state) {
  (void)state;
  CagImage a = picture(2, 2, RGB, 3), b = picture(2, 3, RGB, 3), c = picture(2, 2, Z, 1);
  CagCompareReport r;
  CagError err;
  assert_false(cag_compare_images(&a, "a.exr", &b, "b.exr", 0, &r, &err));
  assert_string_equal(err.message, "'a.exr' is 2 by 2 pixels, but 'b.exr' is 2 by 3");
  assert_int_equal(err.status, CAG_E_ARGUMENT);
  assert_false(cag_compare_images(&a, "a.exr", &c, "c.exr", 0, &r, &err));
  assert_non_null(strstr(err.message, "'a.exr' has a channel 'R', but 'c.exr' has none"));
  CagImage d = picture(2, 2, (const char *const[]){"R", "G", "B", "A"}, 4), map;
  assert_false(cag_compare_images(&a, "a.exr", &d, "d.exr", 0, &r, &err));
  assert_non_null(strstr(err.message, "'d.exr' has a channel 'A', but 'a.exr' has none"));
  assert_false(cag_compare_heatmap(&a, &d, &map, &err));
  cag_image_free(&d);
  cag_image_free(&a);
  cag_image_free(&b);
  cag_image_free(&c);
}

// Rows of the table of test data in Sharma, Wu, Dalal 2005.
static void ciede2000_is_that_of_the_published_data(void **state) {
  (void)state;
  static const struct {
    double lab1[3], lab2[3], expected;
  } ROWS[] = {
      {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
      {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
      {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
      {{50, 0, 0}, {50, -1, 2}, 2.3669},
      {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
      {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
      {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
      {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
      {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    // The table has four decimals.
    assert_true(fabs(cag_compare_delta_e(ROWS[i].lab1, ROWS[i].lab2) - ROWS[i].expected) < 6e-5);
    assert_true(fabs(cag_compare_delta_e(ROWS[i].lab2, ROWS[i].lab1) - ROWS[i].expected) < 6e-5);
  }
}

static void black_against_white_is_a_hundred(void **state) {
  (void)state;
  CagImage a = picture(2, 1, RGB, 3), b = picture(2, 1, RGB, 3);
  for (size_t c = 0; c < 3; c++) cag_image_plane(&b, c)[1] = 7; // clipped to white
  CagCompareReport r;
  assert_true(cag_compare_images(&a, "a", &b, "b", 0, &r, NULL));
  assert_true(fabs(r.delta_e_largest - 100) < 1e-9 && fabs(r.delta_e_mean - 50) < 1e-9);
  cag_compare_report_free(&r);
  cag_image_free(&a);
  cag_image_free(&b);
}

static void middle_gray_has_lightness_50(void **state) {
  (void)state;
  // L* = 50 is at Y = ((50 + 16) / 116)^3.
  const double y = pow(66.0 / 116, 3), rgb[3] = {y, y, y};
  double lab[3];
  cag_compare_lab(rgb, lab);
  assert_true(fabs(lab[0] - 50) < 1e-12 && fabs(lab[1]) < 1e-12 && fabs(lab[2]) < 1e-12);
}

static void assert_print(const CagCompareReport *r, const char *expected) {
  char *text = NULL;
  size_t n;
  FILE *out = open_memstream(&text, &n);
  cag_compare_print(r, out);
  fclose(out);
  if (!strstr(text, expected)) fail_msg("expected %s in:\n%s", expected, text);
  free(text);
}

static void the_table_tells_what_cannot_be_compared(void **state) {
  (void)state;
  static const struct {
    float x[2], y[2];
    const char *row;
  } ROWS[] = {
      {{1, 2}, {1, 2}, "Z                       0            0              -       same\n"},
      {{1, 0}, {0, 0}, "Z                0.707107            1           0, 0    3.01 dB\n"},
      {{NAN, NAN}, {NAN, NAN}, "-       same\n"},
      {{NAN, NAN}, {1, 2}, "-          -\n"},
      {{1, 2}, {INFINITY, 2}, "-          -\n"},
      {{NAN, 2}, {1, INFINITY}, "NaN or infinite: 1 in the first, 1 in the second, 2 different\n"},
      {{1, 2}, {1, NAN}, "NaN or infinite: 0 in the first, 1 in the second, 1 different\n"},
      {{1, 2}, {1, 3}, "pixels that differ by more than 0.5: 1 of 2 (50%)\n"},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    CagImage a = picture(2, 1, Z, 1), b = picture(2, 1, Z, 1);
    memcpy(a.data, ROWS[i].x, sizeof ROWS[i].x);
    memcpy(b.data, ROWS[i].y, sizeof ROWS[i].y);
    CagCompareReport r;
    assert_true(cag_compare_images(&a, "a", &b, "b", 0.5, &r, NULL));
    assert_print(&r, ROWS[i].row);
    cag_compare_report_free(&r);
    cag_image_free(&a);
    cag_image_free(&b);
  }
}

static void pictures_without_colors_have_no_color_difference(void **state) {
  (void)state;
  static const char *const DATA[] = {"depth", "id"}, *const GRAY[] = {"Y", "id"};
  for (int gray = 0; gray < 2; gray++) {
    CagImage a = picture(2, 1, gray ? GRAY : DATA, 2), b = picture(2, 1, gray ? GRAY : DATA, 2);
    CagCompareReport r;
    assert_true(cag_compare_images(&a, "a", &b, "b", 0, &r, NULL));
    assert_true(r.has_color == (gray == 1));
    assert_print(&r, gray ? "(CIEDE2000): mean 0, largest 0\n" : "0 of 2 (0%)");
    cag_compare_report_free(&r);
    cag_image_free(&a);
    cag_image_free(&b);
  }
}

static void the_heatmap_of_equal_pictures_is_black(void **state) {
  (void)state;
  CagImage a = picture(2, 2, Z, 1), map;
  assert_true(cag_compare_heatmap(&a, &a, &map, NULL));
  for (size_t i = 0; i < 4 * 4; i++) assert_true(map.data[i] == 0);
  cag_image_free(&map);
  cag_image_free(&a);
}

static void the_heatmap_runs_to_white_at_the_worst_pixel(void **state) {
  (void)state;
  CagImage a = picture(4, 1, Z, 1), b = picture(4, 1, Z, 1), map;
  const float y[4] = {0, 1, 2, 3};
  memcpy(b.data, y, sizeof y);
  assert_true(cag_compare_heatmap(&a, &b, &map, NULL));
  static const float COLORS[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  for (size_t i = 0; i < 4; i++) {
    for (size_t c = 0; c < 3; c++)
      assert_true(fabsf(cag_image_plane(&map, c)[i] - COLORS[i][c]) < 1e-6f);
    assert_true(cag_image_plane(&map, 3)[i] == y[i]);
  }
  cag_image_free(&map);
  cag_image_free(&a);
  cag_image_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(equal_pictures_have_no_difference),
      cmocka_unit_test(figures_are_those_of_hand_calculation),
      cmocka_unit_test(figures_are_those_of_their_definitions),
      cmocka_unit_test(color_differences_are_symmetric_and_continuous),
      cmocka_unit_test(sides_and_channels_have_limits),
      cmocka_unit_test(the_peak_of_bright_channels_is_their_largest_value),
      cmocka_unit_test(nan_and_infinity_are_counted_apart),
      cmocka_unit_test(pictures_of_other_shape_are_refused),
      cmocka_unit_test(ciede2000_is_that_of_the_published_data),
      cmocka_unit_test(black_against_white_is_a_hundred),
      cmocka_unit_test(middle_gray_has_lightness_50),
      cmocka_unit_test(the_heatmap_runs_to_white_at_the_worst_pixel),
      cmocka_unit_test(the_heatmap_of_equal_pictures_is_black),
      cmocka_unit_test(the_table_tells_what_cannot_be_compared),
      cmocka_unit_test(pictures_without_colors_have_no_color_difference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
