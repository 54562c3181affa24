// EXR files: written files can be read, foreign layouts are supported, and damaged files are
// errors.
//
// Expected pixels are from closed forms. A file written byte by byte according to the OpenEXR
// documentation, and tiled and multi-part files written with the library, represent other programs.

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
#include <unistd.h>

#include "interp/render/exr.h"

static char folder[64];

static int make_folder(void **state) {
  (void)state;
  strcpy(folder, "/tmp/cag-exr-XXXXXX");
  return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  return rmdir(folder);
}

static const char *file_path(const char *name) {
  static char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void *read_bytes(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  fseek(f, 0, SEEK_END);
  *size = (size_t)ftell(f);
  rewind(f);
  void *bytes = malloc(*size + 1);
  assert_int_equal(fread(bytes, 1, *size, f), *size);
  fclose(f);
  return bytes;
}

// A picture whose samples are exact as half floats: multiples of 1/64 below 16.
static CagImage ramp(size_t width, size_t height) {
  CagImage image;
  assert_true(cag_image_create(&image, width, height, 3, NULL));
  cag_image_set_name(&image, 0, "R");
  cag_image_set_name(&image, 1, "depth.Z");
  cag_image_set_name(&image, 2, "A");
  for (size_t i = 0; i < 3 * width * height; i++) image.data[i] = (float)((i * 7) % 1024) / 64.0f;
  return image;
}

static void assert_ramp(const CagImage *image, size_t width, size_t height) {
  static const char *const NAMES[3] = {"R", "depth.Z", "A"};
  assert_int_equal(image->width, width);
  assert_int_equal(image->height, height);
  assert_int_equal(image->channel_count, 3);
  for (size_t n = 0; n < 3; n++) {
    size_t c;
    assert_true(cag_image_find(image, NAMES[n], &c));
    for (size_t i = 0; i < width * height; i++)
      assert_true(cag_image_plane(image, c)[i] ==
                  (float)(((n * width * height + i) * 7) % 1024) / 64.0f);
  }
}

static void what_is_written_is_read_back(void **state) {
  (void)state;
  for (int pixels = CAG_EXR_HALF; pixels <= CAG_EXR_FLOAT; pixels++) {
    CagImage image = ramp(37, 50), again;
    const char *path = file_path("a.exr");
    CagError err = {0};
    assert_true(cag_exr_write(path, &image, (CagExrPixels)pixels, NULL, &err));
    assert_true(cag_exr_read(path, &again, NULL, &err));
    assert_ramp(&again, 37, 50);
    cag_image_free(&image);
    cag_image_free(&again);
    unlink(path);
  }
}

static void infinities_and_nans_survive(void **state) {
  (void)state;
  CagImage image, again;
  assert_true(cag_image_create(&image, 3, 1, 1, NULL));
  cag_image_set_name(&image, 0, "Y");
  image.data[0] = INFINITY;
  image.data[1] = -INFINITY;
  image.data[2] = NAN;
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_FLOAT, NULL, NULL));
  assert_true(cag_exr_read(file_path("a.exr"), &again, NULL, NULL));
  assert_true(again.data[0] == INFINITY && again.data[1] == -INFINITY && isnan(again.data[2]));
  cag_image_free(&image);
  cag_image_free(&again);
  unlink(file_path("a.exr"));
}

static void metadata_is_kept(void **state) {
  (void)state;
  CagImage image = ramp(4, 4), again;
  CagExrMetadata facts = {0}, found = {0};
  // A quarter turn about z and a translation by (1, 2, 3).
  const double camera[16] = {0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
  assert_true(cag_exr_metadata_text(&facts, "cag.script", "old", NULL));
  assert_true(cag_exr_metadata_text(&facts, "cag.script", "vase.cag", NULL));
  assert_true(
      cag_exr_metadata_text(&facts, "an_attribute_with_a_name_longer_than_31_bytes", "", NULL));
  assert_true(cag_exr_metadata_number(&facts, "cag.tolerance", 0.1, NULL));
  assert_true(cag_exr_metadata_matrix(&facts, "worldToCamera", camera, NULL));
  assert_int_equal(facts.count, 4);
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_HALF, &facts, NULL));
  assert_true(cag_exr_read(file_path("a.exr"), &again, &found, NULL));
  assert_string_equal(cag_exr_metadata_find(&found, "cag.script")->text, "vase.cag");
  assert_string_equal(
      cag_exr_metadata_find(&found, "an_attribute_with_a_name_longer_than_31_bytes")->text, "");
  assert_true(cag_exr_metadata_find(&found, "cag.tolerance")->number == 0.1);
  const CagExrAttribute *matrix = cag_exr_metadata_find(&found, "worldToCamera");
  for (int i = 0; i < 16; i++) assert_true(matrix->matrix[i] == camera[i]);
  assert_null(cag_exr_metadata_find(&found, "channels"));
  cag_exr_metadata_free(&facts);
  cag_exr_metadata_free(&found);
  cag_image_free(&image);
  cag_image_free(&again);
  unlink(file_path("a.exr"));
}

static void the_stored_matrix_is_for_row_vectors(void **state) {
  (void)state;
  CagImage image = ramp(1, 1);
  CagExrMetadata facts = {0};
  const double shift[16] = {1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1};
  assert_true(cag_exr_metadata_matrix(&facts, "m", shift, NULL));
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_HALF, &facts, NULL));
  exr_context_t file;
  exr_attr_m44f_t stored;
  assert_int_equal(exr_start_read(&file, file_path("a.exr"), NULL), EXR_ERR_SUCCESS);
  assert_int_equal(exr_attr_get_m44f(file, 0, "m", &stored), EXR_ERR_SUCCESS);
  // Imath: p' = p M, so the translation is the last row.
  assert_true(stored.m[12] == 5 && stored.m[13] == 6 && stored.m[14] == 7 && stored.m[3] == 0);
  exr_finish(&file);
  cag_exr_metadata_free(&facts);
  cag_image_free(&image);
  unlink(file_path("a.exr"));
}

static void names_that_exr_needs_are_refused(void **state) {
  (void)state;
  CagExrMetadata facts = {0};
  CagError err = {0};
  assert_false(cag_exr_metadata_number(&facts, "channels", 1, &err));
  assert_int_equal(err.status, CAG_E_USAGE);
  assert_false(cag_exr_metadata_text(&facts, "", "x", &err));
  assert_int_equal(facts.count, 0);
  cag_exr_metadata_free(&facts);
}

static void a_rewrite_keeps_pixels_and_adds_facts(void **state) {
  (void)state;
  CagImage image = ramp(20, 33), picture, again;
  CagExrMetadata facts = {0}, found = {0};
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_HALF, NULL, NULL));
  size_t size;
  void *bytes = read_bytes(file_path("a.exr"), &size);
  assert_true(cag_exr_metadata_text(&facts, "version", "no", NULL) == false);
  assert_true(cag_exr_metadata_text(&facts, "cag.version", "1", NULL));
  assert_true(cag_exr_rewrite(bytes, size, "render", file_path("a.exr"), &facts, &picture, NULL));
  assert_true(cag_exr_read(file_path("a.exr"), &again, &found, NULL));
  assert_ramp(&picture, 20, 33);
  assert_ramp(&again, 20, 33);
  assert_string_equal(cag_exr_metadata_find(&found, "cag.version")->text, "1");
  free(bytes);
  cag_exr_metadata_free(&facts);
  cag_exr_metadata_free(&found);
  cag_image_free(&image);
  cag_image_free(&picture);
  cag_image_free(&again);
  unlink(file_path("a.exr"));
}

// A file in memory to which numbers are appended, in little-endian order as in EXR.
typedef struct {
  unsigned char bytes[4096];
  size_t size;
} Bytes;

static void put(Bytes *b, const void *data, size_t n) {
  memcpy(b->bytes + b->size, data, n);
  b->size += n;
}
static void put_text(Bytes *b, const char *text) { put(b, text, strlen(text) + 1); }
static void put_u32(Bytes *b, uint32_t v) { put(b, &v, 4); }
static void put_f32(Bytes *b, float v) { put(b, &v, 4); }
static void put_head(Bytes *b, const char *name, const char *type, uint32_t size) {
  put_text(b, name);
  put_text(b, type);
  put_u32(b, size);
}

// An uncompressed file of 2 by 2 pixels according to "OpenEXR File Layout": channels A (float), H
// (half), U (uint). Its data window is (1,1)-(2,2), in a display window of (0,0)-(3,2).
static Bytes file_by_hand(void) {
  Bytes b = {.size = 0};
  put_u32(&b, 20000630);
  put_u32(&b, 2);
  put_head(&b, "channels", "chlist", 3 * 18 + 1);
  const uint32_t types[3] = {2, 1, 0};
  for (int c = 0; c < 3; c++) {
    put_text(&b, (const char *[]){"A", "H", "U"}[c]);
    put_u32(&b, types[c]);
    put_u32(&b, 0);
    put_u32(&b, 1);
    put_u32(&b, 1);
  }
  put(&b, "", 1);
  put_head(&b, "compression", "compression", 1);
  put(&b, "\0", 1);
  const uint32_t data[4] = {1, 1, 2, 2}, display[4] = {0, 0, 3, 2};
  put_head(&b, "dataWindow", "box2i", 16);
  put(&b, data, 16);
  put_head(&b, "displayWindow", "box2i", 16);
  put(&b, display, 16);
  put_head(&b, "lineOrder", "lineOrder", 1);
  put(&b, "\0", 1);
  put_head(&b, "pixelAspectRatio", "float", 4);
  put_f32(&b, 1);
  put_head(&b, "screenWindowCenter", "v2f", 8);
  put_f32(&b, 0);
  put_f32(&b, 0);
  put_head(&b, "screenWindowWidth", "float", 4);
  put_f32(&b, 1);
  put(&b, "", 1);
  const uint32_t line = 2 * (4 + 2 + 4);
  uint64_t offset = b.size + 16;
  put(&b, &offset, 8);
  offset += 8 + line;
  put(&b, &offset, 8);
  for (uint32_t y = 1; y <= 2; y++) {
    put_u32(&b, y);
    put_u32(&b, line);
    put_f32(&b, 0.1f * (float)y);
    put_f32(&b, -3.5f);
    const uint16_t halves[2] = {0x3c00, 0xc500}; // 1 and -5 in IEEE 754 binary16
    put(&b, halves, 4);
    put_u32(&b, 7 * y);
    put_u32(&b, 16777216);
  }
  return b;
}

static void a_file_made_by_hand_is_read(void **state) {
  (void)state;
  Bytes b = file_by_hand();
  CagImage image;
  CagError err = {0};
  if (!cag_exr_read_memory(b.bytes, b.size, "hand.exr", &image, NULL, &err))
    fail_msg("%s", err.message);
  assert_int_equal(image.width, 4);
  assert_int_equal(image.height, 3);
  const float *a = cag_image_plane(&image, 0), *h = cag_image_plane(&image, 1),
              *u = cag_image_plane(&image, 2);
  assert_string_equal(image.channels[2].name, "U");
  assert_true(a[4 + 1] == 0.1f && a[4 + 2] == -3.5f && a[8 + 1] == 0.2f && a[0] == 0 && a[7] == 0);
  assert_true(h[4 + 1] == 1 && h[4 + 2] == -5);
  assert_true(u[4 + 1] == 7 && u[8 + 1] == 14 && u[8 + 2] == 16777216);
  cag_image_free(&image);
}

// An uncompressed file of 4 by 2 pixels: Y at every pixel (10 y + x), C (0.5, 0.75) for blocks of 2
// by 2.
static Bytes file_with_coarse_channel(uint32_t sampling) {
  Bytes b = {.size = 0};
  put_u32(&b, 20000630);
  put_u32(&b, 2);
  put_head(&b, "channels", "chlist", 2 * 18 + 1);
  for (int c = 0; c < 2; c++) {
    put_text(&b, c ? "Y" : "C");
    put_u32(&b, 2);
    put_u32(&b, 0);
    put_u32(&b, c ? 1 : sampling);
    put_u32(&b, c ? 1 : sampling);
  }
  put(&b, "", 1);
  put_head(&b, "compression", "compression", 1);
  put(&b, "\0", 1);
  const uint32_t window[4] = {0, 0, 3, 1};
  put_head(&b, "dataWindow", "box2i", 16);
  put(&b, window, 16);
  put_head(&b, "displayWindow", "box2i", 16);
  put(&b, window, 16);
  put_head(&b, "lineOrder", "lineOrder", 1);
  put(&b, "\0", 1);
  put_head(&b, "pixelAspectRatio", "float", 4);
  put_f32(&b, 1);
  put_head(&b, "screenWindowCenter", "v2f", 8);
  put_f32(&b, 0);
  put_f32(&b, 0);
  put_head(&b, "screenWindowWidth", "float", 4);
  put_f32(&b, 1);
  put(&b, "", 1);
  uint64_t offset = b.size + 16;
  put(&b, &offset, 8);
  offset += 8 + 24;
  put(&b, &offset, 8);
  for (uint32_t y = 0; y < 2; y++) {
    put_u32(&b, y);
    put_u32(&b, y ? 16 : 24);
    for (int x = 0; x < 2 && y == 0; x++) put_f32(&b, 0.5f + 0.25f * (float)x);
    for (uint32_t x = 0; x < 4; x++) put_f32(&b, (float)(10 * y + x));
  }
  return b;
}

static void a_coarse_channel_is_repeated(void **state) {
  (void)state;
  Bytes b = file_with_coarse_channel(2);
  CagImage image;
  CagError err = {0};
  if (!cag_exr_read_memory(b.bytes, b.size, "c.exr", &image, NULL, &err))
    fail_msg("%s", err.message);
  for (size_t i = 0; i < 8; i++) {
    assert_true(cag_image_plane(&image, 0)[i] == (i % 4 < 2 ? 0.5f : 0.75f));
    assert_true(cag_image_plane(&image, 1)[i] == (float)(i / 4 * 10 + i % 4));
  }
  cag_image_free(&image);
  const uint32_t bad[3] = {0, 0x80000000u, 0x7fffffffu};
  for (int i = 0; i < 3; i++) {
    b = file_with_coarse_channel(bad[i]);
    if (cag_exr_read_memory(b.bytes, b.size, "c.exr", &image, NULL, &err)) cag_image_free(&image);
  }
}

// Writes the float channel "Y" with the values 100 y + x, tiled, using the library.
static void write_tiled(const char *path, int width, int height, exr_compression_t compression) {
  exr_context_t file;
  int part;
  assert_int_equal(exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, NULL), 0);
  assert_int_equal(exr_add_part(file, "t", EXR_STORAGE_TILED, &part), 0);
  assert_int_equal(exr_initialize_required_attr_simple(file, 0, width, height, compression), 0);
  assert_int_equal(exr_set_tile_descriptor(file, 0, 16, 8, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN),
                   0);
  assert_int_equal(
      exr_add_channel(file, 0, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
  assert_int_equal(exr_write_header(file), 0);
  for (int ty = 0; ty * 8 < height; ty++) {
    for (int tx = 0; tx * 16 < width; tx++) {
      float tile[16 * 8];
      for (int i = 0; i < 128; i++) tile[i] = (float)(100 * (ty * 8 + i / 16) + tx * 16 + i % 16);
      exr_chunk_info_t chunk;
      exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
      assert_int_equal(exr_write_tile_chunk_info(file, 0, tx, ty, 0, 0, &chunk), 0);
      assert_int_equal(exr_encoding_initialize(file, 0, &chunk, &encoder), 0);
      encoder.channels[0].user_pixel_stride = 4;
      encoder.channels[0].user_line_stride = 64;
      encoder.channels[0].user_bytes_per_element = 4;
      encoder.channels[0].user_data_type = EXR_PIXEL_FLOAT;
      encoder.channels[0].encode_from_ptr = (const uint8_t *)tile;
      assert_int_equal(exr_encoding_choose_default_routines(file, 0, &encoder), 0);
      assert_int_equal(exr_encoding_run(file, 0, &encoder), 0);
      exr_encoding_destroy(file, &encoder);
    }
  }
  assert_int_equal(exr_finish(&file), 0);
}

static void tiles_are_put_together(void **state) {
  (void)state;
  const exr_compression_t kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                     EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                     EXR_COMPRESSION_PIZ};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    write_tiled(file_path("t.exr"), 37, 21, kinds[k]);
    CagImage image;
    CagError err = {0};
    if (!cag_exr_read(file_path("t.exr"), &image, NULL, &err))
      fail_msg("%d: %s", kinds[k], err.message);
    assert_int_equal(image.width, 37);
    for (size_t y = 0; y < 21; y++)
      for (size_t x = 0; x < 37; x++) assert_true(image.data[37 * y + x] == (float)(100 * y + x));
    cag_image_free(&image);
    unlink(file_path("t.exr"));
  }
}

static void what_the_library_would_decode_wrongly_is_refused(void **state) {
  (void)state;
  write_tiled(file_path("t.exr"), 37, 21, EXR_COMPRESSION_B44);
  CagImage image;
  CagError err = {0};
  assert_false(cag_exr_read(file_path("t.exr"), &image, NULL, &err));
  assert_non_null(strstr(err.message, "compression"));
  assert_int_equal(err.status, CAG_E_FILE);
  unlink(file_path("t.exr"));
}

static void parts_become_named_layers(void **state) {
  (void)state;
  exr_context_t file;
  assert_int_equal(exr_start_write(&file, file_path("m.exr"), EXR_WRITE_FILE_DIRECTLY, NULL), 0);
  for (int p = 0; p < 2; p++) {
    int part;
    assert_int_equal(exr_add_part(file, p ? "right" : "left", EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(file, p, 5, 3, EXR_COMPRESSION_ZIPS), 0);
    assert_int_equal(
        exr_add_channel(file, p, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
  }
  assert_int_equal(exr_write_header(file), 0);
  for (int p = 0; p < 2; p++) {
    for (int y = 0; y < 3; y++) {
      float row[5];
      for (int x = 0; x < 5; x++) row[x] = (float)(1000 * p + 10 * y + x);
      exr_chunk_info_t chunk;
      exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
      assert_int_equal(exr_write_scanline_chunk_info(file, p, y, &chunk), 0);
      assert_int_equal(exr_encoding_initialize(file, p, &chunk, &encoder), 0);
      encoder.channels[0].user_pixel_stride = 4;
      encoder.channels[0].user_line_stride = 20;
      encoder.channels[0].user_bytes_per_element = 4;
      encoder.channels[0].user_data_type = EXR_PIXEL_FLOAT;
      encoder.channels[0].encode_from_ptr = (const uint8_t *)row;
      assert_int_equal(exr_encoding_choose_default_routines(file, p, &encoder), 0);
      assert_int_equal(exr_encoding_run(file, p, &encoder), 0);
      exr_encoding_destroy(file, &encoder);
    }
  }
  assert_int_equal(exr_finish(&file), 0);
  CagImage image;
  CagError err = {0};
  if (!cag_exr_read(file_path("m.exr"), &image, NULL, &err)) fail_msg("%s", err.message);
  assert_int_equal(image.channel_count, 2);
  assert_string_equal(image.channels[0].name, "Y");
  assert_string_equal(image.channels[1].name, "right.Y");
  assert_true(cag_image_plane(&image, 0)[14] == 24 && cag_image_plane(&image, 1)[14] == 1024);
  cag_image_free(&image);
  unlink(file_path("m.exr"));
}

static void bad_files_are_named_with_their_fault(void **state) {
  (void)state;
  CagImage image;
  CagError err = {0};
  assert_false(cag_exr_read("/nowhere/a.exr", &image, NULL, &err));
  assert_non_null(strstr(err.message, "/nowhere/a.exr"));
  assert_int_equal(err.status, CAG_E_FILE);
  assert_false(cag_exr_read(folder, &image, NULL, &err));
  assert_non_null(strstr(err.message, "folder"));
  assert_false(cag_exr_read_memory("", 0, "e.exr", &image, NULL, &err));
  assert_non_null(strstr(err.message, "'e.exr' as EXR: the file is empty"));
  assert_false(cag_exr_read_memory("\x89PNG\r\n\x1a\n", 8, "p.exr", &image, NULL, &err));
  assert_non_null(strstr(err.message, "not an EXR file"));
}

// The library must not print anything, so standard error must be empty while f runs.
static void a_file_cut_anywhere_is_an_error(void **state) {
  (void)state;
  CagImage image = ramp(40, 40);
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_FLOAT, NULL, NULL));
  size_t size;
  unsigned char *bytes = read_bytes(file_path("a.exr"), &size);
  int saved = dup(2);
  assert_non_null(freopen(file_path("stderr"), "w", stderr));
  for (size_t n = 0; n < size; n += 1 + n / 97) {
    unsigned char *cut =
        malloc(n ? n : 1); // a separate block, so that out-of-bounds reads are detected
    memcpy(cut, bytes, n);
    CagImage out;
    CagError err = {0};
    assert_false(cag_exr_read_memory(cut, n, "cut.exr", &out, NULL, &err));
    assert_non_null(strstr(err.message, "'cut.exr'"));
    assert_int_equal(err.status, CAG_E_FILE);
    free(cut);
  }
  fflush(stderr);
  struct stat st;
  assert_int_equal(stat(file_path("stderr"), &st), 0);
  dup2(saved, 2);
  close(saved);
  unlink(file_path("stderr"));
  assert_int_equal(st.st_size, 0);
  free(bytes);
  cag_image_free(&image);
  unlink(file_path("a.exr"));
}

// The table of chunks is written last. Until then, the file counts as incomplete.
static void a_file_is_whole_when_all_of_it_is_there(void **state) {
  (void)state;
  CagImage image = ramp(37, 50);
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_HALF, NULL, NULL));
  size_t size;
  unsigned char *bytes = read_bytes(file_path("a.exr"), &size);
  assert_true(cag_exr_is_whole(bytes, size));
  for (size_t n = 0; n < size; n++) assert_false(cag_exr_is_whole(bytes, n));
  // With ZIP, a chunk has 16 lines. The offsets of the 4 chunks precede the first chunk.
  uint64_t first;
  size_t table = 0;
  for (size_t i = 0; !table && i + 8 <= size; i++) {
    memcpy(&first, bytes + i, 8);
    if (first == i + 4 * 8) table = i;
  }
  assert_true(table > 0);
  memset(bytes + table + 3 * 8, 0, 8);
  assert_false(cag_exr_is_whole(bytes, size));
  free(bytes);
  cag_image_free(&image);
  unlink(file_path("a.exr"));
}

// Flips random bytes, a third of the time in the header, and reads the file. Both success and
// failure are valid, but not a crash.
static void flip_and_read(const unsigned char *bytes, size_t size, unsigned seed, int rounds) {
  uint64_t random = seed * 2654435761u + 1;
  unsigned char *damaged = malloc(size);
  for (int round = 0; round < rounds; round++) {
    memcpy(damaged, bytes, size);
    for (int k = 0; k <= round % 4; k++) {
      random = random * 6364136223846793005u + 1442695040888963407u;
      size_t range = round % 3 == 0 && size > 400 ? 400 : size;
      damaged[(random >> 33) % range] ^= (unsigned char)(1u << (random >> 61));
    }
    CagImage out;
    CagExrMetadata facts = {0};
    CagError err = {0};
    if (cag_exr_read_memory(damaged, size, "flip.exr", &out, &facts, &err)) cag_image_free(&out);
    else assert_true(err.message[0] && cag_exit_status(&err));
    cag_exr_metadata_free(&facts);
  }
  free(damaged);
}

static void damaged_files_never_crash(void **state) {
  (void)state;
  CagImage image = ramp(40, 40);
  CagExrMetadata facts = {0};
  const double m[16] = {1};
  assert_true(cag_exr_metadata_text(&facts, "text", "some text", NULL));
  assert_true(cag_exr_metadata_matrix(&facts, "matrix", m, NULL));
  size_t size;
  for (int pixels = CAG_EXR_HALF; pixels <= CAG_EXR_FLOAT; pixels++) {
    assert_true(cag_exr_write(file_path("a.exr"), &image, (CagExrPixels)pixels, &facts, NULL));
    unsigned char *bytes = read_bytes(file_path("a.exr"), &size);
    flip_and_read(bytes, size, 1, 600);
    free(bytes);
    unlink(file_path("a.exr"));
  }
  cag_exr_metadata_free(&facts);
  cag_image_free(&image);
  const exr_compression_t kinds[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                     EXR_COMPRESSION_PIZ};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    write_tiled(file_path("t.exr"), 37, 21, kinds[k]);
    unsigned char *bytes = read_bytes(file_path("t.exr"), &size);
    flip_and_read(bytes, size, 2, 600);
    free(bytes);
    unlink(file_path("t.exr"));
  }
}

static void a_refused_image_leaves_the_old_file(void **state) {
  (void)state;
  CagImage image = ramp(2, 2), again;
  CagError err = {0};
  assert_true(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_HALF, NULL, NULL));
  cag_image_set_name(&image, 1, "R");
  assert_false(cag_exr_write(file_path("a.exr"), &image, CAG_EXR_HALF, NULL, &err));
  assert_non_null(strstr(err.message, "two channels are named 'R'"));
  assert_true(cag_exr_read(file_path("a.exr"), &again, NULL, NULL));
  assert_ramp(&again, 2, 2);
  assert_false(cag_exr_write("/dev/full", &again, CAG_EXR_HALF, NULL, &err));
  assert_non_null(strstr(err.message, "No space left"));
  cag_image_free(&image);
  cag_image_free(&again);
  unlink(file_path("a.exr"));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_written_is_read_back),
      cmocka_unit_test(infinities_and_nans_survive),
      cmocka_unit_test(metadata_is_kept),
      cmocka_unit_test(the_stored_matrix_is_for_row_vectors),
      cmocka_unit_test(names_that_exr_needs_are_refused),
      cmocka_unit_test(a_rewrite_keeps_pixels_and_adds_facts),
      cmocka_unit_test(a_file_made_by_hand_is_read),
      cmocka_unit_test(a_coarse_channel_is_repeated),
      cmocka_unit_test(tiles_are_put_together),
      cmocka_unit_test(what_the_library_would_decode_wrongly_is_refused),
      cmocka_unit_test(parts_become_named_layers),
      cmocka_unit_test(bad_files_are_named_with_their_fault),
      cmocka_unit_test(a_file_cut_anywhere_is_an_error),
      cmocka_unit_test(a_file_is_whole_when_all_of_it_is_there),
      cmocka_unit_test(damaged_files_never_crash),
      cmocka_unit_test(a_refused_image_leaves_the_old_file),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
