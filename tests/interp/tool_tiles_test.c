// Tiles of pictures, and names of frames: parsing, exact coverage of the picture, and invalid
// tiles.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#include "cli/frames.h"
#include "cli/tiles.h"
#include "interp/render/exr.h"
#include "interp/render/png.h"
#include "tests/fuzz/failing.h"
#include "tests/geom/random.h"

volatile int cag_tool_interrupt;

static char folder[] = "/tmp/cag-tiles-XXXXXX";

static int begin(void **state) {
  (void)state;
  assert_non_null(mkdtemp(folder));
  return chdir(folder);
}

static int end(void **state) {
  (void)state;
  static const char *const FILES[] = {"0.exr", "1.exr", "2.exr", "3.exr", "out.exr", "out.png"};
  for (size_t i = 0; i < sizeof FILES / sizeof *FILES; i++) remove(FILES[i]);
  return rmdir(folder);
}

static void test_texts(void **state) {
  (void)state;
  static const struct {
    const char *text;
    int columns, lines; // 0: rejected
  } rows[] = {
      {"4x3", 4, 3},  {"1x1", 1, 1},   {"64x64", 64, 64}, {"007x2", 7, 2},
      {"65x1", 0, 0}, {"1x65", 0, 0},  {"0x1", 0, 0},     {"1x0", 0, 0},
      {"4", 0, 0},    {"4x", 0, 0},    {"x4", 0, 0},      {"", 0, 0},
      {"4X3", 0, 0},  {"4x3x2", 0, 0}, {"-4x3", 0, 0},    {"99999999999x1", 0, 0},
      {"4x:", 0, 0},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    int columns = 0, lines = 0;
    const bool ok = cag_tiles_read(rows[i].text, &columns, &lines);
    assert_true(ok == (rows[i].columns > 0));
    if (ok) assert_true(columns == rows[i].columns && lines == rows[i].lines);
  }
}

// Each pixel is in exactly one tile, and inner edges are at multiples of the renderer's blocks.
static void test_cover(void **state) {
  (void)state;
  seed = 5;
  static unsigned char seen[300][300];
  for (int n = 0; n < 200; n++) {
    const int width = (int)uniform(1, 300), height = (int)uniform(1, 300);
    const int columns = (int)uniform(1, 10), lines = (int)uniform(1, 10);
    const bool fit = cag_tiles_fit(width, columns) && cag_tiles_fit(height, lines);
    assert_true(fit ==
                ((columns == 1 || width / 32 >= columns) && (lines == 1 || height / 32 >= lines)));
    if (!fit) continue;
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < columns * lines; i++) {
      const CagRenderRegion r = cag_tile(width, height, columns, lines, i);
      assert_true(r.x % 32 == 0 && r.y % 32 == 0 && r.width > 0 && r.height > 0);
      for (int y = r.y; y < r.y + r.height; y++)
        for (int x = r.x; x < r.x + r.width; x++) seen[y][x]++;
    }
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) assert_int_equal(seen[y][x], 1);
  }
}

// Writes a tile whose pixels are their positions in the whole picture, multiplied by a factor for
// each channel.
static void write_tile(const char *path, CagRenderRegion r, const char *const *channels,
                       size_t count) {
  CagImage image;
  CagError err;
  assert_true(cag_image_create(&image, (size_t)r.width, (size_t)r.height, count, &err));
  for (size_t c = 0; c < count; c++) {
    cag_image_set_name(&image, c, channels[c]);
    for (int y = 0; y < r.height; y++)
      for (int x = 0; x < r.width; x++)
        cag_image_plane(&image, c)[y * r.width + x] =
            (float)((channels[c][0] - 'A') * (r.x + x) + r.y + y);
  }
  assert_true(cag_exr_write(path, &image, CAG_EXR_FLOAT, NULL, &err));
  cag_image_free(&image);
}

#define WIDTH 70
#define HEIGHT 90
static const char *const TILES[] = {"0.exr", "1.exr", "2.exr", "3.exr"};
static const char *const RGB[] = {"R", "G", "B", "A"};

static void write_tiles(void) {
  for (int i = 0; i < 4; i++) write_tile(TILES[i], cag_tile(WIDTH, HEIGHT, 2, 2, i), RGB, 3);
}

static void test_join(void **state) {
  (void)state;
  CagError err = {0};
  CagImage image;
  write_tiles();
  assert_true(cag_tiles_join(TILES, 2, 2, WIDTH, HEIGHT, "out.exr", &err));
  assert_true(cag_exr_read("out.exr", &image, NULL, &err));
  assert_int_equal(image.width, WIDTH);
  assert_int_equal(image.height, HEIGHT);
  for (size_t c = 0; c < 3; c++) {
    size_t at;
    assert_true(cag_image_find(&image, RGB[c], &at));
    for (int y = 0; y < HEIGHT; y++)
      for (int x = 0; x < WIDTH; x++) { // half floats have 11 bits
        const double expected = (RGB[c][0] - 'A') * x + y;
        assert_true(fabs(cag_image_plane(&image, at)[y * WIDTH + x] - expected) <= expected / 2048);
      }
  }
  cag_image_free(&image);
  assert_true(cag_tiles_join(TILES, 2, 2, WIDTH, HEIGHT, "out.png", &err));
  assert_true(cag_png_read("out.png", &image, &err));
  assert_int_equal(image.width, WIDTH);
  cag_image_free(&image);
}

static void test_misfits(void **state) {
  (void)state;
  static const char *const OTHER[] = {"R", "G", "Z"};
  const CagRenderRegion third = cag_tile(WIDTH, HEIGHT, 2, 2, 2);
  const CagRenderRegion wide = {third.x, third.y, third.width + 1, third.height},
                        high = {third.x, third.y, third.width, third.height + 1};
  const struct {
    CagRenderRegion region;
    const char *const *channels;
    size_t count;
  } misfits[] = {
      {wide, RGB, 3}, {high, RGB, 3}, {third, RGB, 2}, {third, RGB, 4}, {third, OTHER, 3}};
  CagError err = {0};
  for (size_t i = 0; i < sizeof misfits / sizeof *misfits; i++) {
    write_tiles();
    write_tile("2.exr", misfits[i].region, misfits[i].channels, misfits[i].count);
    assert_false(cag_tiles_join(TILES, 2, 2, WIDTH, HEIGHT, "out.exr", &err));
    assert_string_equal(err.message, "the tile '2.exr' does not fit its picture");
  }
  write_tiles();
  remove("3.exr");
  assert_false(cag_tiles_join(TILES, 2, 2, WIDTH, HEIGHT, "out.exr", &err));
  assert_int_equal(err.status, CAG_E_FILE);
}

static void test_join_without_memory(void **state) {
  (void)state;
  CagError err = {0};
  write_tiles();
  made = 0;
  assert_true(cag_tiles_join(TILES, 2, 2, WIDTH, HEIGHT, "out.exr", &err));
  const size_t all = made;
  for (size_t at = 1; at <= all; at++) {
    made = 0;
    failing = at;
    const bool ok = cag_tiles_join(TILES, 2, 2, WIDTH, HEIGHT, "out.exr", &err);
    failing = 0;
    assert_true(ok || cag_exit_status(&err));
  }
}

// --- Frames ---

static void test_frames(void **state) {
  (void)state;
  static const struct {
    const char *pattern;
    int places;
    const char *name; // of frame 7
  } rows[] = {
      {"a.png", 0, "a.png"},
      {"a%d.png", 1, "a7.png"},
      {"a%04d.png", 1, "a0007.png"},
      {"a%3d.png", 1, "a  7.png"},
      {"%d%%.png", 1, "7%.png"},
      {"%d-%02d", 2, "7-07"},
      {"100%", -1, "100%"},
      {"a%s.png", -1, "a%s.png"},
      {"a%99d", -1, "a%99d"},
      {"a%0", -1, "a%0"},
      {"a%999999999999d", -1, "a%999999999999d"},
  };
  char name[64];
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    assert_int_equal(cag_frames_places(rows[i].pattern), rows[i].places);
    assert_true(cag_frames_name(rows[i].pattern, 7, name, sizeof name));
    assert_string_equal(name, rows[i].name);
  }
  assert_true(cag_frames_name("abc%d", 7, name, 5));
  assert_false(cag_frames_name("abcd%d", 7, name, 5));
  assert_false(cag_frames_name("abc%d", 10, name, 5));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_texts),
      cmocka_unit_test(test_cover),
      cmocka_unit_test(test_join),
      cmocka_unit_test(test_misfits),
      cmocka_unit_test(test_join_without_memory),
      cmocka_unit_test(test_frames),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
