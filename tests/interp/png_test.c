// PNG pictures: exposure, roll-off, the sRGB transfer, transparency, and invalid files.
//
// Expected values are computed by hand from the formula of IEC 61966-2-1.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "interp/render/png.h"

static char path[64];

static int make_file(void **state) {
  (void)state;
  strcpy(path, "/tmp/cag-png-XXXXXX");
  int fd = mkstemp(path);
  return fd < 0 ? -1 : close(fd);
}

static int remove_file(void **state) {
  (void)state;
  return unlink(path);
}

// A picture of one row with R = G = B.
static CagImage gray_row(const float *values, size_t n) {
  CagImage image;
  assert_true(cag_image_create(&image, n, 1, 3, NULL));
  for (size_t c = 0; c < 3; c++) {
    cag_image_set_name(&image, c, (const char *[]){"R", "G", "B"}[c]);
    memcpy(cag_image_plane(&image, c), values, n * sizeof *values);
  }
  return image;
}

// The file as decoded by libpng's simple interface to 8 bits RGBA; to be freed.
static unsigned char *stored(size_t *width) {
  png_image png = {.version = PNG_IMAGE_VERSION};
  assert_true(png_image_begin_read_from_file(&png, path));
  png.format = PNG_FORMAT_RGBA;
  unsigned char *pixels = malloc(PNG_IMAGE_SIZE(png));
  assert_true(png_image_finish_read(&png, NULL, pixels, 0, NULL));
  *width = png.width;
  return pixels;
}

static void linear_light_gets_the_srgb_transfer(void **state) {
  (void)state;
  // 0.5 -> 0.735357 -> 187.5; 0.18 -> 0.461356 -> 117.6; 0.002 -> 0.02584 -> 6.6; 0.8 -> 0.906332
  // -> 231.1
  const float light[4] = {0.5f, 0.18f, 0.002f, 0.8f};
  const unsigned char expected[4] = {188, 118, 7, 231};
  CagImage image = gray_row(light, 4);
  assert_true(cag_png_write(path, &image, NULL, NULL, 0, NULL));
  size_t width;
  unsigned char *pixels = stored(&width);
  assert_int_equal(width, 4);
  for (size_t i = 0; i < 4; i++)
    for (size_t c = 0; c < 3; c++) assert_int_equal(pixels[4 * i + c], expected[i]);
  free(pixels);
  cag_image_free(&image);
}

static void highlights_roll_off_and_odd_values_are_tamed(void **state) {
  (void)state;
  // 1 -> 0.8 + 0.2 (1 - 1/e) = 0.926424 -> sRGB 0.966918 -> 246.6; infinity -> 255; NaN and -1 -> 0
  const float light[4] = {1, INFINITY, NAN, -1};
  const unsigned char rolled[4] = {247, 255, 0, 0}, clipped[4] = {255, 255, 0, 0};
  CagImage image = gray_row(light, 4);
  for (int clip = 0; clip < 2; clip++) {
    const CagPngOptions options = {.keep_linear = clip};
    assert_true(cag_png_write(path, &image, &options, NULL, 0, NULL));
    size_t width;
    unsigned char *pixels = stored(&width);
    for (size_t i = 0; i < 4; i++) assert_int_equal(pixels[4 * i], clip ? clipped[i] : rolled[i]);
    free(pixels);
  }
  cag_image_free(&image);
}

static void the_roll_off_is_smooth(void **state) {
  (void)state;
  const double h = 1e-6, s = CAG_PNG_SHOULDER;
  assert_true(cag_png_shoulder(s) == s);
  // The slope is 1 on both sides, up to the curvature 1 / 0.2 times h.
  assert_true(fabs((cag_png_shoulder(s + h) - s) / h - 1) < 10 * h);
  assert_true(cag_png_shoulder(INFINITY) == 1);
}

static void a_stop_doubles_the_light(void **state) {
  (void)state;
  const float light[1] = {0.125f};
  CagImage image = gray_row(light, 1);
  const CagPngOptions options = {.exposure = 2}; // 0.125 * 4 = 0.5
  assert_true(cag_png_write(path, &image, &options, NULL, 0, NULL));
  size_t width;
  unsigned char *pixels = stored(&width);
  assert_int_equal(pixels[0], 188);
  free(pixels);
  cag_image_free(&image);
}

static void sixteen_bits_come_back_as_light(void **state) {
  (void)state;
  float light[256];
  for (int i = 0; i < 256; i++) light[i] = 0.8f * (float)i / 255;
  CagImage image = gray_row(light, 256), again;
  const CagPngOptions options = {.bits = 16};
  assert_true(cag_png_write(path, &image, &options, NULL, 0, NULL));
  assert_true(cag_png_read(path, &again, NULL));
  assert_int_equal(again.channel_count, 3);
  // Half a step of 1/65535 times the decoder's slope, which is below 2.3.
  for (size_t i = 0; i < 256; i++)
    assert_true(fabsf(again.data[i] - light[i]) < 1.2f * 2.3f / 65535);
  cag_image_free(&image);
  cag_image_free(&again);
}

static void alpha_is_kept_and_colors_are_unmultiplied(void **state) {
  (void)state;
  CagImage image, again;
  assert_true(cag_image_create(&image, 2, 1, 4, NULL));
  for (size_t c = 0; c < 4; c++) {
    cag_image_set_name(&image, c, (const char *[]){"A", "B", "G", "R"}[c]);
    cag_image_plane(&image, c)[0] = c ? 0.25f : 0.5f; // light 0.5 at coverage 0.5
  }
  assert_true(cag_png_write(path, &image, NULL, NULL, 0, NULL));
  size_t width;
  unsigned char *pixels = stored(&width);
  assert_int_equal(pixels[0], 188);
  assert_int_equal(pixels[3], 128);
  assert_int_equal(pixels[7], 0);
  free(pixels);
  assert_true(cag_png_read(path, &again, NULL));
  assert_int_equal(again.channel_count, 4);
  // One step of 1/255 in the coverage, and half a step in the color.
  assert_true(fabsf(again.data[0] - 0.25f) < 0.005f);
  cag_image_free(&image);
  cag_image_free(&again);
}

static void texts_are_stored(void **state) {
  (void)state;
  const float light[1] = {0};
  const CagPngText texts[2] = {{"Software", "cag 0.1.0"}, {"Title", "Vase mit Öhr"}};
  CagImage image = gray_row(light, 1);
  assert_true(cag_png_write(path, &image, NULL, texts, 2, NULL));
  FILE *f = fopen(path, "rb");
  char bytes[1024] = {0};
  size_t n = fread(bytes, 1, sizeof bytes, f);
  fclose(f);
  assert_non_null(memmem(bytes, n, "cag 0.1.0", 9));
  assert_non_null(memmem(bytes, n, "Vase mit Öhr", strlen("Vase mit Öhr")));
  cag_image_free(&image);
}

static void bad_requests_and_files_are_errors(void **state) {
  (void)state;
  CagImage image, out;
  CagError err = {0};
  assert_true(cag_image_create(&image, 2, 2, 2, NULL));
  cag_image_set_name(&image, 0, "Z");
  assert_false(cag_png_write(path, &image, NULL, NULL, 0, &err));
  assert_non_null(strstr(err.message, "no color channels"));
  cag_image_set_name(&image, 0, "Y");
  const CagPngOptions odd = {.bits = 12};
  assert_false(cag_png_write(path, &image, &odd, NULL, 0, &err));
  assert_int_equal(err.status, CAG_E_USAGE);
  assert_false(cag_png_write("/dev/full", &image, NULL, NULL, 0, &err));
  assert_non_null(strstr(err.message, "No space left"));
  assert_false(cag_png_read("/nowhere.png", &out, &err));
  assert_int_equal(err.status, CAG_E_FILE);
  assert_false(cag_png_read("/tmp", &out, &err));
  FILE *f = fopen(path, "wb");
  fputs("no picture at all", f);
  fclose(f);
  assert_false(cag_png_read(path, &out, &err));
  assert_non_null(strstr(err.message, path));
  cag_image_free(&image);
}

// The library only warns of keywords that PNG does not allow.
static void texts_with_odd_keywords_do_no_harm(void **state) {
  (void)state;
  const float light[1] = {1};
  char long_key[120] = {0};
  memset(long_key, 'k', sizeof long_key - 1);
  const CagPngText texts[3] = {{" Two  spaces ", "a"}, {long_key, "b"}, {"Title", "c"}};
  CagImage image = gray_row(light, 1), again;
  CagError err = {0};
  if (!cag_png_write(path, &image, NULL, texts, 3, &err)) fail_msg("%s", err.message);
  assert_true(cag_png_read(path, &again, NULL));
  assert_int_equal(again.width, 1);
  cag_image_free(&again);
  cag_image_free(&image);
}

// The cyclic redundancy check of PNG (ISO 3309), bit by bit.
static uint32_t crc(const unsigned char *bytes, size_t n) {
  uint32_t c = ~0u;
  for (size_t i = 0; i < n; i++) {
    c ^= bytes[i];
    for (int k = 0; k < 8; k++) c = c & 1 ? c >> 1 ^ 0xedb88320u : c >> 1;
  }
  return ~c;
}

static void put_chunk(FILE *f, const char *type, const void *data, size_t n) {
  unsigned char bytes[64] = {0};
  memcpy(bytes, type, 4);
  memcpy(bytes + 4, data, n);
  const uint32_t numbers[2] = {(uint32_t)n, crc(bytes, n + 4)};
  for (int k = 24; k >= 0; k -= 8) fputc((int)(numbers[0] >> k & 255), f);
  fwrite(bytes, 1, n + 4, f);
  for (int k = 24; k >= 0; k -= 8) fputc((int)(numbers[1] >> k & 255), f);
}

// File headers: a picture with too many pixels is rejected before memory is allocated.
static void a_png_too_large_is_refused(void **state) {
  (void)state;
  static const struct {
    unsigned width, height;
    const char *says;
  } ROWS[] = {{60000, 60000, "too large"}, {200000, 1, ""}, {0, 1, ""}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const unsigned w = ROWS[i].width, h = ROWS[i].height;
    const unsigned char head[13] = {(unsigned char)(w >> 24),
                                    (unsigned char)(w >> 16),
                                    (unsigned char)(w >> 8),
                                    (unsigned char)w,
                                    (unsigned char)(h >> 24),
                                    (unsigned char)(h >> 16),
                                    (unsigned char)(h >> 8),
                                    (unsigned char)h,
                                    8,
                                    2};
    FILE *f = fopen(path, "wb");
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, f);
    put_chunk(f, "IHDR", head, sizeof head);
    put_chunk(f, "IDAT", "\0\0\0\0", 4);
    put_chunk(f, "IEND", "", 0);
    fclose(f);
    CagImage out;
    CagError err = {0};
    assert_false(cag_png_read(path, &out, &err));
    if (!strstr(err.message, path) || !strstr(err.message, ROWS[i].says))
      fail_msg("%u by %u: %s", w, h, err.message);
  }
}

// A full disk is detected while rows are written, if they exceed the buffer.
static void a_full_disk_is_told_under_way(void **state) {
  (void)state;
  enum { SIDE = 900 };
  CagImage image;
  assert_true(cag_image_create(&image, SIDE, SIDE, 4, NULL));
  for (size_t c = 0; c < 4; c++)
    cag_image_set_name(&image, c, (const char *[]){"R", "G", "B", "A"}[c]);
  uint32_t x = 1;
  for (size_t i = 0; i < 4 * SIDE * SIDE; i++)
    image.data[i] = (float)((x = x * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
  const CagPngOptions deep = {.bits = 16, .drop_alpha = true};
  CagError err = {0};
  assert_false(cag_png_write("/dev/full", &image, &deep, NULL, 0, &err));
  assert_non_null(strstr(err.message, "No space left"));
  assert_false(cag_png_write("/nowhere/a.png", &image, &deep, NULL, 0, &err));
  assert_non_null(strstr(err.message, "/nowhere/a.png"));
  cag_image_free(&image);
}

static void a_png_cut_anywhere_is_an_error(void **state) {
  (void)state;
  float light[50];
  for (int i = 0; i < 50; i++) light[i] = (float)(i * i % 50) / 50;
  CagImage image = gray_row(light, 50), out;
  assert_true(cag_png_write(path, &image, NULL, NULL, 0, NULL));
  unsigned char bytes[4096];
  FILE *f = fopen(path, "rb");
  size_t size = fread(bytes, 1, sizeof bytes, f);
  fclose(f);
  for (size_t n = 0; n < size; n += 3) {
    f = fopen(path, "wb");
    fwrite(bytes, 1, n, f);
    fclose(f);
    CagError err = {0};
    assert_false(cag_png_read(path, &out, &err));
    assert_int_equal(err.status, CAG_E_FILE);
  }
  cag_image_free(&image);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(linear_light_gets_the_srgb_transfer),
      cmocka_unit_test(highlights_roll_off_and_odd_values_are_tamed),
      cmocka_unit_test(the_roll_off_is_smooth),
      cmocka_unit_test(a_stop_doubles_the_light),
      cmocka_unit_test(sixteen_bits_come_back_as_light),
      cmocka_unit_test(alpha_is_kept_and_colors_are_unmultiplied),
      cmocka_unit_test(texts_are_stored),
      cmocka_unit_test(bad_requests_and_files_are_errors),
      cmocka_unit_test(a_png_cut_anywhere_is_an_error),
      cmocka_unit_test(texts_with_odd_keywords_do_no_harm),
      cmocka_unit_test(a_png_too_large_is_refused),
      cmocka_unit_test(a_full_disk_is_told_under_way),
  };
  return cmocka_run_group_tests(tests, make_file, remove_file);
}
