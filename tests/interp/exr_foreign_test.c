// EXR files of other programs, written byte by byte according to "OpenEXR File Layout": number
// formats, windows, attributes, parts, and invalid headers. Also pipes, files of all sizes, and
// failing allocations in the EXR library.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "interp/render/exr.h"

// --- Files written by hand ---

// A file in memory to which numbers are appended, in little-endian order as in EXR.
typedef struct {
  unsigned char bytes[8192];
  size_t size;
} Bytes;

static void put(Bytes *b, const void *data, size_t n) {
  assert_true(b->size + n <= sizeof b->bytes);
  memcpy(b->bytes + b->size, data, n);
  b->size += n;
}
static void put_text(Bytes *b, const char *text) { put(b, text, strlen(text) + 1); }
static void put_u32(Bytes *b, uint32_t v) { put(b, &v, 4); }
static void put_f32(Bytes *b, float v) { put(b, &v, 4); }
static void put_f64(Bytes *b, double v) { put(b, &v, 8); }
static void put_u64(Bytes *b, uint64_t v) { put(b, &v, 8); }
static void put_head(Bytes *b, const char *name, const char *type, size_t size) {
  put_text(b, name);
  put_text(b, type);
  put_u32(b, (uint32_t)size);
}

enum { UINT, HALF, FLOAT }; // number formats, as numbered in EXR
enum { NONE = 0, RLE = 1, ZIP = 3, PIZ = 4, PXR24 = 5, B44 = 6, B44A = 7, NOT_SAID = 99 };
#define TILED 0x200u
#define DEEP 0x800u
#define PARTS 0x1000u

typedef struct {
  const char *name;
  uint32_t type, x_sampling, y_sampling;
} Channel;

// The header of a part. The windows are minimum x and y, and maximum x and y.
typedef struct {
  const char *part, *type; // NULL: omitted
  Channel channels[4];
  size_t count;
  unsigned char compression;
  int32_t data[4], display[4];
  uint32_t tile; // the side of a tile; 0: scan lines
  void (*attributes)(Bytes *b);
} Header;

static void put_header(Bytes *b, const Header *h) {
  size_t size = 1;
  for (size_t i = 0; i < h->count; i++) size += strlen(h->channels[i].name) + 1 + 16;
  put_head(b, "channels", "chlist", size);
  for (size_t i = 0; i < h->count; i++) {
    put_text(b, h->channels[i].name);
    put_u32(b, h->channels[i].type);
    put_u32(b, 0);
    put_u32(b, h->channels[i].x_sampling);
    put_u32(b, h->channels[i].y_sampling);
  }
  put(b, "", 1);
  if (h->compression != NOT_SAID) {
    put_head(b, "compression", "compression", 1);
    put(b, &h->compression, 1);
  }
  put_head(b, "dataWindow", "box2i", 16);
  put(b, h->data, 16);
  put_head(b, "displayWindow", "box2i", 16);
  put(b, h->display, 16);
  put_head(b, "lineOrder", "lineOrder", 1);
  put(b, "\0", 1);
  put_head(b, "pixelAspectRatio", "float", 4);
  put_f32(b, 1);
  put_head(b, "screenWindowCenter", "v2f", 8);
  put_f32(b, 0);
  put_f32(b, 0);
  put_head(b, "screenWindowWidth", "float", 4);
  put_f32(b, 1);
  if (h->tile) {
    put_head(b, "tiles", "tiledesc", 9);
    put_u32(b, h->tile);
    put_u32(b, h->tile);
    put(b, "\0", 1);
  }
  if (h->part) {
    put_head(b, "name", "string", strlen(h->part));
    put(b, h->part, strlen(h->part));
  }
  if (h->type) {
    put_head(b, "type", "string", strlen(h->type));
    put(b, h->type, strlen(h->type));
    put_head(b, "chunkCount", "int", 4);
    put_u32(b, 1);
  }
  if (h->attributes) h->attributes(b);
  put(b, "", 1);
}

static void put_begin(Bytes *b, uint32_t flags) {
  *b = (Bytes){.size = 0};
  put_u32(b, 20000630);
  put_u32(b, 2 | flags);
}

// One row of uncompressed half floats at the line y.
static void put_row(Bytes *b, int32_t y, const uint16_t *halves, uint32_t count) {
  put_u64(b, b->size + 8);
  put(b, &y, 4);
  put_u32(b, 2 * count);
  put(b, halves, 2 * count);
}

static CagImage read_file(const Bytes *b, CagExrMetadata *facts) {
  CagImage image;
  CagError err = {0};
  if (!cag_exr_read_memory(b->bytes, b->size, "hand.exr", &image, facts, &err))
    fail_msg("%s", err.message);
  return image;
}

static void halves_have_the_values_of_ieee_754(void **state) {
  (void)state;
  static const struct {
    uint16_t half;
    float value;
  } ROWS[] = {
      {0x0000, 0},           {0x8000, -0.0f},     {0x3c00, 1},        {0xc000, -2},
      {0x3555, 0x1.554p-2f}, {0x7bff, 65504},     {0x0400, 0x1p-14f}, {0x03ff, 0x3ffp-24f},
      {0x0001, 0x1p-24f},    {0x8001, -0x1p-24f}, {0x7c00, INFINITY}, {0xfc00, -INFINITY},
      {0x7e00, NAN},
  };
  enum { COUNT = sizeof ROWS / sizeof *ROWS };
  uint16_t halves[COUNT];
  for (size_t i = 0; i < COUNT; i++) halves[i] = ROWS[i].half;
  const Header h = {.channels = {{"Y", HALF, 1, 1}},
                    .count = 1,
                    .data = {0, 0, COUNT - 1, 0},
                    .display = {0, 0, COUNT - 1, 0}};
  Bytes b;
  put_begin(&b, 0);
  put_header(&b, &h);
  put_row(&b, 0, halves, COUNT);
  CagImage image = read_file(&b, NULL);
  for (size_t i = 0; i < COUNT; i++) {
    const float x = image.data[i], want = ROWS[i].value;
    if (isnan(want) ? !isnan(x) : x != want || signbit(x) != signbit(want))
      fail_msg("%04x is %a", ROWS[i].half, (double)x);
  }
  cag_image_free(&image);
}

// The five samples 1 2 3 4 5 in the data window, with a display window of 4 columns and 2 rows.
static void the_display_window_cuts_the_data(void **state) {
  (void)state;
  static const struct {
    int32_t x, y; // the start of the data
    float expected[8];
  } ROWS[] = {
      {0, 0, {1, 2, 3, 4, 0, 0, 0, 0}},
      {-2, 0, {3, 4, 5, 0, 0, 0, 0, 0}},
      {2, 1, {0, 0, 0, 0, 0, 0, 1, 2}},
      {-9, 1, {0}},
      {7, 0, {0}},
      {0, -1, {0}},
      {-1, 1, {0, 0, 0, 0, 2, 3, 4, 5}},
  };
  static const uint16_t HALVES[] = {0x3c00, 0x4000, 0x4200, 0x4400, 0x4500};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const int32_t x = ROWS[i].x, y = ROWS[i].y;
    const Header h = {.channels = {{"Y", HALF, 1, 1}},
                      .count = 1,
                      .data = {x, y, x + 4, y},
                      .display = {0, 0, 3, 1}};
    Bytes b;
    put_begin(&b, 0);
    put_header(&b, &h);
    put_row(&b, y, HALVES, 5);
    CagImage image = read_file(&b, NULL);
    for (size_t k = 0; k < 8; k++)
      if (image.data[k] != ROWS[i].expected[k])
        fail_msg("from (%d, %d), sample %zu is %g", x, y, k, (double)image.data[k]);
    cag_image_free(&image);
  }
}

static void put_attributes(Bytes *b) {
  put_head(b, "frame", "int", 4);
  put_u32(b, 48);
  put_head(b, "exposure", "float", 4);
  put_f32(b, 0.25f);
  put_head(b, "seconds", "double", 8);
  put_f64(b, 0.1);
  put_head(b, "owner", "string", 5);
  put(b, "Grace", 5);
  put_head(b, "nothing", "string", 0);
  put_head(b, "crop", "box2i", 16); // of an ignored type
  for (int i = 0; i < 4; i++) put_u32(b, 7);
  // Matrices for row vectors: the translation is in the last row.
  put_head(b, "near", "m44f", 64);
  for (int i = 0; i < 16; i++) put_f32(b, i % 5 == 0 ? 1 : i == 12 ? 5 : 0);
  put_head(b, "far", "m44d", 128);
  for (int i = 0; i < 16; i++) put_f64(b, i % 5 == 0 ? 1 : i == 13 ? 6 : 0);
}

static void facts_of_the_header_are_read(void **state) {
  (void)state;
  const Header h = {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .attributes = put_attributes};
  Bytes b;
  put_begin(&b, 0);
  put_header(&b, &h);
  put_row(&b, 0, (const uint16_t[]){0x3c00}, 1);
  CagExrMetadata facts = {0};
  CagImage image = read_file(&b, &facts);
  assert_int_equal(facts.count, 7);
  assert_true(cag_exr_metadata_find(&facts, "frame")->number == 48);
  assert_true(cag_exr_metadata_find(&facts, "exposure")->number == 0.25);
  assert_true(cag_exr_metadata_find(&facts, "seconds")->number == 0.1);
  assert_string_equal(cag_exr_metadata_find(&facts, "owner")->text, "Grace");
  assert_string_equal(cag_exr_metadata_find(&facts, "nothing")->text, "");
  assert_true(cag_exr_metadata_find(&facts, "near")->matrix[3] == 5);
  assert_true(cag_exr_metadata_find(&facts, "far")->matrix[7] == 6);
  cag_exr_metadata_free(&facts);
  cag_image_free(&image);
}

// Channels of the second part are named "part.channel", unless that is already their name.
static void parts_give_their_names_to_channels(void **state) {
  (void)state;
  static const struct {
    const char *part, *channel, *name;
  } ROWS[] = {{"right", "Y", "right.Y"},
              {"right", "right.Y", "right.Y"},
              {"right", "rightY", "right.rightY"},
              {"r", "right.Y", "r.right.Y"}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const Header left = {
        .part = "left", .type = "scanlineimage", .channels = {{"Y", HALF, 1, 1}}, .count = 1};
    Header right = left;
    right.part = ROWS[i].part;
    right.channels[0].name = ROWS[i].channel;
    Bytes b;
    put_begin(&b, PARTS);
    put_header(&b, &left);
    put_header(&b, &right);
    put(&b, "", 1);
    const uint64_t first = b.size + 16;
    put_u64(&b, first);
    put_u64(&b, first + 14);
    for (uint32_t p = 0; p < 2; p++) {
      put_u32(&b, p);
      put_u32(&b, 0);
      put_u32(&b, 2);
      put(&b, p ? "\0\x40" : "\0\x3c", 2); // 2 and 1
    }
    CagImage image = read_file(&b, NULL);
    assert_int_equal(image.channel_count, 2);
    assert_string_equal(image.channels[0].name, "Y");
    assert_string_equal(image.channels[1].name, ROWS[i].name);
    assert_true(image.data[0] == 1 && image.data[1] == 2);
    cag_image_free(&image);
  }
}

static void put_deep_attributes(Bytes *b) {
  put_head(b, "version", "int", 4);
  put_u32(b, 1);
  put_head(b, "maxSamplesPerPixel", "int", 4);
  put_u32(b, 1);
}

static void headers_that_cannot_be_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *what;
    uint32_t flags;
    Header header;
    const char *says; // "": anything
  } ROWS[] = {
      {"no channels", 0, {.count = 0}, ""},
      {"sampling 0", 0, {.channels = {{"Y", HALF, 0, 1}}, .count = 1}, ""},
      {"sampling 0 in y", 0, {.channels = {{"Y", HALF, 1, 0}}, .count = 1}, ""},
      {"coarse tiles",
       TILED,
       {.channels = {{"Y", HALF, 2, 2}},
        .count = 1,
        .data = {0, 0, 3, 3},
        .display = {0, 0, 3, 3},
        .tile = 4},
       ""},
      {"coarse in PIZ",
       0,
       {.channels = {{"Y", HALF, 2, 2}},
        .count = 1,
        .compression = PIZ,
        .data = {0, 0, 3, 3},
        .display = {0, 0, 3, 3}},
       "compression"},
      {"coarse in PXR24",
       0,
       {.channels = {{"Y", HALF, 1, 2}},
        .count = 1,
        .compression = PXR24,
        .data = {0, 0, 3, 3},
        .display = {0, 0, 3, 3}},
       "compression"},
      {"float in B44A",
       0,
       {.channels = {{"Y", FLOAT, 1, 1}}, .count = 1, .compression = B44A},
       "compression"},
      {"unknown compression",
       0,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .compression = 77},
       ""},
      {"no compression said",
       0,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .compression = NOT_SAID},
       "compression"},
      {"deep data",
       DEEP,
       {.type = "deepscanline",
        .channels = {{"Y", HALF, 1, 1}},
        .count = 1,
        .attributes = put_deep_attributes},
       "deep data"},
      {"tiles of a negative size",
       TILED,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .tile = 0x80000000u},
       ""},
      {"empty display window",
       0,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .display = {0, 0, -1, 0}},
       ""},
      {"empty display window in y",
       0,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .display = {0, 0, 0, -5}},
       ""},
      {"empty data window",
       0,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .data = {0, 0, -1, 0}},
       ""},
      {"too wide",
       0,
       {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .display = {0, 0, 0x7ffffff0, 0}},
       ""},
      {"origin between coarse samples",
       0,
       {.channels = {{"Y", HALF, 2, 1}}, .count = 1, .data = {1, 0, 4, 0}, .display = {0, 0, 4, 0}},
       ""},
      {"width between coarse samples",
       0,
       {.channels = {{"Y", HALF, 2, 1}}, .count = 1, .data = {0, 0, 2, 0}, .display = {0, 0, 2, 0}},
       ""},
      {"tiles without size", TILED, {.channels = {{"Y", HALF, 1, 1}}, .count = 1}, ""},
  };
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    Bytes b;
    put_begin(&b, ROWS[i].flags);
    put_header(&b, &ROWS[i].header);
    put_row(&b, 0, (const uint16_t[]){0x3c00, 0x3c00, 0x3c00, 0x3c00}, 4);
    CagImage image;
    CagError err = {0};
    if (cag_exr_read_memory(b.bytes, b.size, "hand.exr", &image, NULL, &err))
      fail_msg("read: %s", ROWS[i].what);
    if (!strstr(err.message, "'hand.exr'") || !strstr(err.message, ROWS[i].says))
      fail_msg("%s: %s", ROWS[i].what, err.message);
  }
}

// A chunk must have as many bytes as its pixels need, or fewer if it is compressed.
static void chunks_of_a_wrong_size_are_refused(void **state) {
  (void)state;
  static const struct {
    unsigned char compression;
    uint32_t size;
  } ROWS[] = {{NONE, 0}, {NONE, 2}, {NONE, 6}, {ZIP, 0}, {ZIP, 6}, {ZIP, 3}, {RLE, 1}, {NONE, ~0u}};
  for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
    const Header h = {.channels = {{"Y", HALF, 1, 1}},
                      .count = 1,
                      .compression = ROWS[i].compression,
                      .data = {0, 0, 1, 0},
                      .display = {0, 0, 1, 0}};
    Bytes b;
    put_begin(&b, 0);
    put_header(&b, &h);
    put_u64(&b, b.size + 8);
    put_u32(&b, 0);
    put_u32(&b, ROWS[i].size);
    put(&b, "\1\2\3\4\5\6\7\10", 8);
    CagImage image;
    CagError err = {0};
    if (cag_exr_read_memory(b.bytes, b.size, "hand.exr", &image, NULL, &err))
      fail_msg("read: %u bytes, compression %u", ROWS[i].size, ROWS[i].compression);
  }
}

static void a_tiled_file_is_not_whole_as_rows(void **state) {
  (void)state;
  const Header h = {.channels = {{"Y", HALF, 1, 1}}, .count = 1, .tile = 1};
  Bytes b;
  put_begin(&b, TILED);
  put_header(&b, &h);
  put_row(&b, 0, (const uint16_t[]){0x3c00}, 1);
  assert_false(cag_exr_is_whole(b.bytes, b.size));
  assert_false(cag_exr_is_whole("no picture", 10));
  memcpy(b.bytes + 8, "\xff\xff\xff\xff", 4); // an invalid name
  assert_false(cag_exr_is_whole(b.bytes, b.size));
}

// --- Names of metadata ---

static void names_of_facts_have_1_to_255_bytes(void **state) {
  (void)state;
  char name[300];
  const double matrix[16] = {1};
  static const size_t LENGTHS[] = {0, 1, 255, 256, 299};
  for (size_t i = 0; i < sizeof LENGTHS / sizeof *LENGTHS; i++) {
    memset(name, 'n', LENGTHS[i]);
    name[LENGTHS[i]] = 0;
    CagExrMetadata facts = {0};
    CagError err = {0};
    const bool good = LENGTHS[i] >= 1 && LENGTHS[i] <= 255;
    assert_true(cag_exr_metadata_matrix(&facts, name, matrix, &err) == good);
    assert_true(cag_exr_metadata_text(&facts, name, "x", &err) == good);
    assert_int_equal(facts.count, good);
    assert_int_equal(err.status, good ? 0 : CAG_E_USAGE);
    cag_exr_metadata_free(&facts);
  }
}

// --- Pipes, and files that are too large ---

static CagImage noise(size_t side) {
  CagImage image;
  assert_true(cag_image_create(&image, side, side, 3, NULL));
  for (size_t c = 0; c < 3; c++) cag_image_set_name(&image, c, (const char *[]){"B", "G", "R"}[c]);
  uint32_t x = 1;
  for (size_t i = 0; i < 3 * side * side; i++)
    image.data[i] = (float)((x = x * 1664525u + 1013904223u) >> 8);
  return image;
}

static char path[] = "/tmp/cag-exr-foreign-XXXXXX";

static int make_file(void **state) {
  (void)state;
  const int fd = mkstemp(path);
  return fd < 0 ? -1 : close(fd);
}

static int remove_file(void **state) {
  (void)state;
  return unlink(path);
}

static void standard_input_may_be_a_pipe(void **state) {
  (void)state;
  CagImage image = noise(480), again; // more than 1 MiB, the first block
  assert_true(cag_exr_write(path, &image, CAG_EXR_FLOAT, NULL, NULL));
  struct stat st;
  assert_int_equal(stat(path, &st), 0);
  assert_true(st.st_size > 1 << 20);
  char command[64];
  snprintf(command, sizeof command, "cat %s", path);
  const int saved = dup(STDIN_FILENO);
  FILE *pipe = popen(command, "r");
  dup2(fileno(pipe), STDIN_FILENO);
  CagError err = {0};
  const bool good = cag_exr_read("-", &again, NULL, &err);
  dup2(saved, STDIN_FILENO);
  close(saved);
  pclose(pipe);
  if (!good) fail_msg("%s", err.message);
  assert_memory_equal(again.data, image.data, 3 * 480 * 480 * sizeof *image.data);
  cag_image_free(&again);
  cag_image_free(&image);
}

static void what_cannot_be_read_is_named(void **state) {
  (void)state;
  CagImage image;
  CagError err = {0};
  const int saved = dup(STDIN_FILENO);
  close(STDIN_FILENO);
  const bool good = cag_exr_read("-", &image, NULL, &err);
  dup2(saved, STDIN_FILENO);
  close(saved);
  assert_false(good);
  assert_non_null(strstr(err.message, "'standard input': Bad file descriptor"));
  // A sparse file of 9 GiB, and one that is memory of the process.
  if (truncate(path, (off_t)9 << 30) == 0) {
    assert_false(cag_exr_read(path, &image, NULL, &err));
    assert_non_null(strstr(err.message, "too large"));
    assert_int_equal(truncate(path, 0), 0);
  }
  assert_false(cag_exr_read("/proc/self/mem", &image, NULL, &err));
  assert_non_null(strstr(err.message, "/proc/self/mem"));
}

// --- Failing allocations in the library ---

static size_t allocations,
    failing; // failing: the number of the allocation that fails, from 1; 0: none

static void *allocate(size_t n) { return ++allocations == failing ? NULL : malloc(n); }

// Each allocation of the library fails once: the picture must be correct, or there is an error.
static void without_memory_there_is_an_error(void **state) {
  (void)state;
  CagImage image = noise(20), again;
  CagExrMetadata facts = {0}, found = {0};
  const double matrix[16] = {1};
  assert_true(cag_exr_metadata_text(&facts, "a", "some text", NULL));
  assert_true(cag_exr_metadata_number(&facts, "b", 3, NULL));
  assert_true(cag_exr_metadata_matrix(&facts, "c", matrix, NULL));
  assert_true(cag_exr_metadata_text(&facts, "a_name_of_more_than_31_bytes_is_long", "", NULL));
  exr_set_default_memory_routines(allocate, free);
  size_t failures[2] = {0}, last = 1;
  for (failing = 1; failing <= last + 1; failing++) {
    CagError err = {0};
    allocations = 0;
    if (!cag_exr_write(path, &image, CAG_EXR_FLOAT, &facts, &err)) {
      failures[0]++;
      assert_int_equal(err.status, CAG_E_FILE);
      assert_non_null(strstr(err.message, path));
    } else {
      const size_t now = failing;
      failing = 0;
      assert_true(cag_exr_read(path, &again, NULL, NULL));
      failing = now;
      assert_memory_equal(again.data, image.data, 3 * 20 * 20 * sizeof *image.data);
      cag_image_free(&again);
    }
    if (allocations > last) last = allocations;
  }
  failing = 0;
  assert_true(cag_exr_write(path, &image, CAG_EXR_FLOAT, &facts, NULL));
  last = 1;
  for (failing = 1; failing <= last + 1; failing++) {
    CagError err = {0};
    allocations = 0;
    if (!cag_exr_read(path, &again, &found, &err)) {
      failures[1]++;
      assert_non_null(strstr(err.message, path));
    } else {
      assert_memory_equal(again.data, image.data, 3 * 20 * 20 * sizeof *image.data);
      cag_image_free(&again);
    }
    cag_exr_metadata_free(&found);
    if (allocations > last) last = allocations;
  }
  exr_set_default_memory_routines(NULL, NULL);
  assert_true(failures[0] > 10 && failures[1] > 10);
  cag_exr_metadata_free(&facts);
  cag_image_free(&image);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(halves_have_the_values_of_ieee_754),
      cmocka_unit_test(the_display_window_cuts_the_data),
      cmocka_unit_test(facts_of_the_header_are_read),
      cmocka_unit_test(parts_give_their_names_to_channels),
      cmocka_unit_test(headers_that_cannot_be_are_refused),
      cmocka_unit_test(chunks_of_a_wrong_size_are_refused),
      cmocka_unit_test(a_tiled_file_is_not_whole_as_rows),
      cmocka_unit_test(names_of_facts_have_1_to_255_bytes),
      cmocka_unit_test(standard_input_may_be_a_pipe),
      cmocka_unit_test(what_cannot_be_read_is_named),
      cmocka_unit_test(without_memory_there_is_an_error),
  };
  return cmocka_run_group_tests(tests, make_file, remove_file);
}
