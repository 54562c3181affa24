// Images: arithmetic, parts, turns, fields, and means over areas, against their definitions.

#include <float.h>

#include "geom/image/arithmetic.h"
#include "geom/image/layout.h"
#include "geom/image/resample.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// A raster of one channel with these samples in rows.
static CagRaster *raster_of(size_t width, size_t height, const double *samples) {
  CagRaster *r;
  OK(cag_raster_new(width, height, 1, &r, &err));
  memcpy(r->data, samples, width * height * sizeof *samples);
  return r;
}

static CagRaster *random_raster(size_t width, size_t height, size_t channels) {
  CagRaster *r;
  OK(cag_raster_new(width, height, channels, &r, &err));
  for (size_t i = 0; i < width * height * channels; i++)
    r->data[i] = uniform(0, 1) < 0.1 ? NAN : uniform(-10, 10);
  return r;
}

static bool same_number(double a, double b) { return a == b || (isnan(a) && isnan(b)); }

static void assert_same(const CagRaster *a, const CagRaster *b) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  assert_int_equal(a->channel_count, b->channel_count);
  for (size_t i = 0; i < a->width * a->height * a->channel_count; i++)
    if (!same_number(a->data[i], b->data[i]))
      fail_msg("sample %zu: %.17g is not %.17g", i, a->data[i], b->data[i]);
}

static void operators_apply_to_each_sample(void **state) {
  (void)state;
  seed = 51;
  CagRaster *a = random_raster(7, 5, 3), *b = random_raster(7, 5, 3), *made;
  for (int op = CAG_RASTER_ADD; op <= CAG_RASTER_DIVIDE; op++) {
    OK(cag_raster_combine((CagRasterOp)op, a, b, &made, &err));
    for (size_t i = 0; i < 7 * 5 * 3; i++) {
      const double x = a->data[i], y = b->data[i];
      const double expected[] = {x + y, x - y, x * y, x / y};
      assert_true(same_number(made->data[i], expected[op]));
    }
    cag_raster_release(made);
    OK(cag_raster_with_number((CagRasterOp)op, a, 2.5, true, &made, &err));
    for (size_t i = 0; i < 7 * 5 * 3; i++) {
      const double y = a->data[i], expected[] = {2.5 + y, 2.5 - y, 2.5 * y, 2.5 / y};
      assert_true(same_number(made->data[i], expected[op]));
    }
    cag_raster_release(made);
  }
  cag_raster_release(a);
  cag_raster_release(b);
}

static void a_single_channel_applies_to_all(void **state) {
  (void)state;
  seed = 52;
  CagRaster *a = random_raster(4, 3, 1), *b = random_raster(4, 3, 2), *made;
  OK(cag_raster_name(b, 1, "z", &err));
  OK(cag_raster_combine(CAG_RASTER_SUBTRACT, a, b, &made, &err));
  assert_string_equal(made->names[1], "z");
  for (size_t c = 0; c < 2; c++)
    for (size_t i = 0; i < 12; i++)
      assert_true(same_number(made->data[12 * c + i], a->data[i] - b->data[12 * c + i]));
  cag_raster_release(a);
  cag_raster_release(b);
  cag_raster_release(made);
}

static void undefined_and_infinite_results_have_no_value(void **state) {
  (void)state;
  CagRaster *a = raster_of(3, 1, (double[]){0, 1, DBL_MAX}), *made;
  CagRaster *b = raster_of(3, 1, (double[]){0, 0, 0.5});
  OK(cag_raster_combine(CAG_RASTER_DIVIDE, a, b, &made, &err));
  for (int i = 0; i < 3; i++) assert_true(isnan(made->data[i]));
  cag_raster_release(made);
  cag_raster_release(a);
  cag_raster_release(b);
}

static void other_sizes_are_refused(void **state) {
  (void)state;
  CagRaster *a = raster_of(3, 2, (double[]){1, 2, 3, 4, 5, 6}), *made;
  CagRaster *b = raster_of(2, 3, (double[]){1, 2, 3, 4, 5, 6}), *two, *three;
  FAILS(cag_raster_combine(CAG_RASTER_ADD, a, b, &made, &err), "image-sizes");
  FAILS(cag_raster_weave(a, b, &made, &err), "image-sizes");
  OK(cag_raster_new(3, 2, 2, &two, &err));
  OK(cag_raster_new(3, 2, 3, &three, &err));
  FAILS(cag_raster_combine(CAG_RASTER_ADD, two, three, &made, &err), "image-channels");
  FAILS(cag_raster_enlarge(a, 1 << 20, &made, &err), "image-size");
  FAILS(cag_raster_resize(a, 1 << 15, 1 << 15, &made, &err), "image-size");
  FAILS(cag_raster_resize(a, 0, 1, &made, &err), "empty-image");
  cag_raster_release(a);
  cag_raster_release(b);
  cag_raster_release(two);
  cag_raster_release(three);
}

static void figures_skip_samples_without_a_value(void **state) {
  (void)state;
  CagRasterFigures f;
  // A naive sum of these is 0.
  CagRaster *r = raster_of(3, 2, (double[]){NAN, 1e100, 1, 3, -1e100, NAN});
  OK(cag_raster_figures(r, &f, &err));
  assert_int_equal(f.count, 4);
  assert_true(f.least == -1e100 && f.greatest == 1e100 && f.sum == 4);
  for (int i = 0; i < 6; i++) r->data[i] = NAN;
  OK(cag_raster_figures(r, &f, &err));
  assert_true(f.count == 0 && isnan(f.least) && isnan(f.greatest) && f.sum == 0);
  cag_raster_release(r);
}

// floor(clamp(v / white, 0, 1) m + 1/2), m = 2^bits - 1.
static void codes_are_those_of_a_converter(void **state) {
  (void)state;
  assert_true(cag_code_of(0, 8, 1) == 0 && cag_code_of(1, 8, 1) == 255);
  assert_true(cag_code_of(-3, 8, 1) == 0 && cag_code_of(7, 8, 1) == 255);
  assert_true(cag_code_of(0.49, 1, 1) == 0 && cag_code_of(0.5, 1, 1) == 1);
  assert_true(cag_code_of(0.5, 8, 1) == 128 && cag_code_of(50, 4, 100) == 8);
  assert_true(isnan(cag_code_of(NAN, 8, 1)));
  for (int bits = 1; bits <= 16; bits++)
    for (double code = 0; code < ldexp(1, bits); code++)
      assert_true(cag_code_of(cag_value_of_code(code, bits, 0.3), bits, 0.3) == code);
}

static void parts_and_copies_have_the_samples_of_their_pixels(void **state) {
  (void)state;
  seed = 53;
  CagRaster *r = random_raster(23, 17, 2), *made;
  OK(cag_raster_crop(r, 5, 3, 11, 7, &made, &err));
  for (size_t c = 0; c < 2; c++)
    for (size_t y = 0; y < 7; y++)
      for (size_t x = 0; x < 11; x++)
        assert_true(same_number(*cag_raster_at(made, c, x, y), *cag_raster_at(r, c, 5 + x, 3 + y)));
  cag_raster_release(made);
  OK(cag_raster_enlarge(r, 3, &made, &err));
  for (size_t c = 0; c < 2; c++)
    for (size_t y = 0; y < 51; y++)
      for (size_t x = 0; x < 69; x++)
        assert_true(same_number(*cag_raster_at(made, c, x, y), *cag_raster_at(r, c, x / 3, y / 3)));
  cag_raster_release(made);
  OK(cag_raster_select(r, (size_t[]){1, 0}, 2, &made, &err));
  assert_memory_equal(cag_raster_plane(made, 0), cag_raster_plane(r, 1), 23 * 17 * sizeof(double));
  assert_memory_equal(cag_raster_plane(made, 1), cag_raster_plane(r, 0), 23 * 17 * sizeof(double));
  cag_raster_release(made);
  cag_raster_release(r);
}

static void quarter_turns_are_counter_clockwise(void **state) {
  (void)state;
  CagRaster *r = raster_of(3, 2, (double[]){1, 2, 3, 4, 5, 6}), *made;
  const double expected[4][6] = {
      {1, 2, 3, 4, 5, 6}, {3, 6, 2, 5, 1, 4}, {6, 5, 4, 3, 2, 1}, {4, 1, 5, 2, 6, 3}};
  for (int turns = -5; turns < 9; turns++) {
    OK(cag_raster_turn(r, turns * M_PI_2, NAN, &made, &err));
    assert_int_equal(made->width, turns % 2 ? 2 : 3);
    assert_memory_equal(made->data, expected[(turns + 8) % 4], sizeof expected[0]);
    cag_raster_release(made);
  }
  cag_raster_release(r);
}

static void turns_and_flips_compose(void **state) {
  (void)state;
  seed = 54;
  CagRaster *r = random_raster(41, 19, 2), *a, *b, *c, *d;
  OK(cag_raster_quarter_turns(r, 1, &a, &err)); // flip across, then turn = turn, then flip along
  OK(cag_raster_flip(a, false, &b, &err));
  OK(cag_raster_flip(r, true, &c, &err));
  OK(cag_raster_quarter_turns(c, 1, &d, &err));
  assert_same(b, d);
  cag_raster_release(a);
  OK(cag_raster_quarter_turns(d, 3, &a, &err));
  assert_same(a, c);
  cag_raster_release(a);
  cag_raster_release(b);
  cag_raster_release(c);
  cag_raster_release(d);
  cag_raster_release(r);
}

// Bilinear interpolation keeps a linear function of the position; the turned image has it at the
// turned positions. Only within half a pixel of the edge, values are continued.
static void a_turned_ramp_is_a_turned_ramp(void **state) {
  (void)state;
  seed = 55;
  for (int round = 0; round < 50; round++) {
    const size_t w = 3 + (size_t)uniform(0, 20), h = 3 + (size_t)uniform(0, 20);
    const double p = uniform(-2, 2), q = uniform(-2, 2), angle = uniform(-7, 7);
    CagRaster *r, *made;
    OK(cag_raster_new(w, h, 1, &r, &err));
    for (size_t y = 0; y < h; y++)
      for (size_t x = 0; x < w; x++)
        *cag_raster_at(r, 0, x, y) =
            p * ((double)x + 0.5 - (double)w / 2) + q * ((double)h / 2 - (double)y - 0.5);
    OK(cag_raster_turn(r, angle, -99, &made, &err));
    const double width = (double)w * fabs(cos(angle)) + (double)h * fabs(sin(angle));
    assert_true((double)made->width >= width - 1e-6 && (double)made->width < width + 1);
    for (size_t y = 0; y < made->height; y++)
      for (size_t x = 0; x < made->width; x++) {
        const double u = (double)x + 0.5 - (double)made->width / 2;
        const double v = (double)made->height / 2 - (double)y - 0.5;
        const double a = u * cos(angle) + v * sin(angle), b = v * cos(angle) - u * sin(angle);
        if (fabs(a) > (double)w / 2 + 1e-9 || fabs(b) > (double)h / 2 + 1e-9)
          assert_true(*cag_raster_at(made, 0, x, y) == -99);
        if (fabs(a) <= (double)w / 2 - 0.5 && fabs(b) <= (double)h / 2 - 0.5)
          NEAR(*cag_raster_at(made, 0, x, y), p * a + q * b, 1e-12 * 100);
      }
    cag_raster_release(r);
    cag_raster_release(made);
  }
}

static void fields_are_woven_again(void **state) {
  (void)state;
  seed = 56;
  for (size_t h = 1; h < 8; h++) {
    CagRaster *r = random_raster(4, h, 2), *odd, *even = NULL, *made;
    OK(cag_raster_field(r, false, &odd, &err));
    if (h > 1) OK(cag_raster_field(r, true, &even, &err));
    assert_int_equal(odd->height, (h + 1) / 2);
    assert_int_equal(even ? even->height : 0, h / 2);
    OK(cag_raster_weave(odd, even, &made, &err));
    assert_same(made, r);
    cag_raster_release(r);
    cag_raster_release(odd);
    cag_raster_release(even);
    cag_raster_release(made);
  }
}

// The integral of the image over the unit square, of samples that all have values, is kept.
static void means_keep_the_integral(void **state) {
  (void)state;
  seed = 57;
  for (int round = 0; round < 60; round++) {
    const size_t w = 1 + (size_t)uniform(0, 30), h = 1 + (size_t)uniform(0, 30);
    const size_t m = 1 + (size_t)uniform(0, 30), n = 1 + (size_t)uniform(0, 30);
    CagRaster *r, *made;
    OK(cag_raster_new(w, h, 1, &r, &err));
    for (size_t i = 0; i < w * h; i++) r->data[i] = uniform(-1, 1);
    OK(cag_raster_resize(r, m, n, &made, &err));
    CagRasterFigures before, after;
    OK(cag_raster_figures(r, &before, &err));
    OK(cag_raster_figures(made, &after, &err));
    NEAR(after.sum / (double)(m * n), before.sum / (double)(w * h), 1e-14);
    cag_raster_release(r);
    cag_raster_release(made);
  }
}

static void means_are_over_the_area_of_a_pixel(void **state) {
  (void)state;
  // 3 pixels to 2: the middle one is halved.
  CagRaster *r = raster_of(3, 1, (double[]){0, 3, 9}), *made;
  OK(cag_raster_resize(r, 2, 1, &made, &err));
  NEAR(made->data[0], 1, 1e-15);
  NEAR(made->data[1], 7, 1e-15);
  cag_raster_release(made);
  r->data[1] = NAN; // left out
  OK(cag_raster_resize(r, 2, 1, &made, &err));
  assert_true(made->data[0] == 0 && made->data[1] == 9);
  cag_raster_release(made);
  OK(cag_raster_resize(r, 6, 2, &made, &err));
  assert_true(made->data[0] == 0 && isnan(made->data[2]) && made->data[11] == 9);
  cag_raster_release(made);
  cag_raster_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operators_apply_to_each_sample),
      cmocka_unit_test(a_single_channel_applies_to_all),
      cmocka_unit_test(undefined_and_infinite_results_have_no_value),
      cmocka_unit_test(other_sizes_are_refused),
      cmocka_unit_test(figures_skip_samples_without_a_value),
      cmocka_unit_test(codes_are_those_of_a_converter),
      cmocka_unit_test(parts_and_copies_have_the_samples_of_their_pixels),
      cmocka_unit_test(quarter_turns_are_counter_clockwise),
      cmocka_unit_test(turns_and_flips_compose),
      cmocka_unit_test(a_turned_ramp_is_a_turned_ramp),
      cmocka_unit_test(fields_are_woven_again),
      cmocka_unit_test(means_keep_the_integral),
      cmocka_unit_test(means_are_over_the_area_of_a_pixel),
  };
  return cmocka_run_group_tests_name("images", tests, NULL, NULL);
}
