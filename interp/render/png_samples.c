// Samples of PNG pictures, through libpng.
//
// libpng reports errors by longjmp. Reading and writing each have one function that calls libpng
// and owns no resources; a struct of its caller holds everything that must be freed.

#include "interp/render/png_samples.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "base/atomic_file.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/raster.h"

typedef struct {
  char message[200];
  // reading
  const uint8_t *bytes;
  size_t size, at;
  CagError *err; // set: the error is complete
  bool failed;
  // writing
  CagAtomicFile *file;
  png_structp png;
  png_infop info;
  CagPngSamples samples;
} Session;

static void on_error(png_structp png, png_const_charp message) {
  Session *s = png_get_error_ptr(png);
  snprintf(s->message, sizeof s->message, "%s", message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

static size_t row_size(const CagPngSamples *s) {
  return s->width * s->channels * (size_t)(s->bits / 8);
}

bool cag_png_samples_create(CagPngSamples *s, CagError *err) {
  s->bytes = NULL;
  if (s->width > CAG_RASTER_SIDE_MAX || s->height > CAG_RASTER_SIDE_MAX ||
      s->width * s->height > CAG_RASTER_SAMPLES_MAX / s->channels)
    return cag_fail_io(err, CAG_E_LIMIT, "make it smaller",
                       "an image of %zu by %zu pixels with %zu channels is too large (at most %zu "
                       "samples, %zu pixels on a side)",
                       s->width, s->height, s->channels, CAG_RASTER_SAMPLES_MAX,
                       CAG_RASTER_SIDE_MAX);
  s->bytes = cag_malloc(row_size(s) * s->height);
  return s->bytes ||
         cag_fail_io(err, CAG_E_MEMORY, "make it smaller",
                     "no memory for an image of %zu by %zu pixels", s->width, s->height);
}

void cag_png_samples_free(CagPngSamples *s) {
  cag_free(s->bytes);
  s->bytes = NULL;
}

// --- Reading ---

static void on_read(png_structp png, png_bytep data, png_size_t n) {
  Session *s = png_get_io_ptr(png);
  if (n > s->size - s->at) png_error(png, "the file ends too early");
  memcpy(data, s->bytes + s->at, n);
  s->at += n;
}

// Decodes into s->samples. Everything in it that libpng may leave by longjmp is in the session.
static bool decode(Session *s) {
  if (setjmp(png_jmpbuf(s->png))) return false;
  png_set_read_fn(s->png, s, on_read);
  png_set_user_limits(s->png, (png_uint_32)CAG_RASTER_SIDE_MAX, (png_uint_32)CAG_RASTER_SIDE_MAX);
  png_read_info(s->png, s->info);
  png_set_expand(s->png); // palettes, grays of few bits, and transparent colors
  const int passes = png_set_interlace_handling(s->png);
  png_read_update_info(s->png, s->info);
  s->samples = (CagPngSamples){.width = png_get_image_width(s->png, s->info),
                               .height = png_get_image_height(s->png, s->info),
                               .channels = png_get_channels(s->png, s->info),
                               .bits = png_get_bit_depth(s->png, s->info)};
  s->failed = !cag_png_samples_create(&s->samples, s->err);
  if (s->failed) return false;
  const size_t row = row_size(&s->samples);
  if (png_get_rowbytes(s->png, s->info) != row) png_error(s->png, "its rows have another length");
  for (int pass = 0; pass < passes; pass++)
    for (size_t y = 0; y < s->samples.height; y++) {
      if (cag_stopped()) png_error(s->png, "it was stopped");
      png_read_row(s->png, s->samples.bytes + y * row, NULL);
    }
  png_read_end(s->png, NULL);
  return true;
}

bool cag_png_read_samples(const void *bytes, size_t size, const char *shown, CagPngSamples *out,
                          CagError *err) {
  CagError inner = {0};
  Session s = {.bytes = bytes, .size = size, .err = &inner};
  s.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning);
  s.info = s.png ? png_create_info_struct(s.png) : NULL;
  const bool ok = s.info && decode(&s);
  if (s.png) png_destroy_read_struct(&s.png, &s.info, NULL);
  if (ok) {
    *out = s.samples;
    return true;
  }
  cag_png_samples_free(&s.samples);
  if (cag_stopped()) return cag_fail_io(err, CAG_E_CALLBACK, NULL, "reading was stopped");
  if (s.failed)
    return cag_fail_io(err, inner.status, inner.help, "cannot read '%s' as PNG: %.300s", shown,
                       inner.message);
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot read '%s' as PNG: %s", shown,
                     s.message[0] ? s.message : "no memory");
}

// --- Writing ---

static void on_write(png_structp png, png_bytep data, png_size_t n) {
  CagAtomicFile *file = png_get_io_ptr(png);
  cag_atomic_file_write(file, data, n);
  if (cag_atomic_file_failed(file)) png_error(png, "the disk refused the data");
}

static void on_flush(png_structp png) { (void)png; }

static bool encode(Session *s, const CagPngSamples *from) {
  static const int COLORS[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                               PNG_COLOR_TYPE_RGB_ALPHA};
  if (setjmp(png_jmpbuf(s->png))) return false;
  png_set_write_fn(s->png, s->file, on_write, on_flush);
  png_set_user_limits(s->png, (png_uint_32)CAG_RASTER_SIDE_MAX, (png_uint_32)CAG_RASTER_SIDE_MAX);
  png_set_IHDR(s->png, s->info, (png_uint_32)from->width, (png_uint_32)from->height, from->bits,
               COLORS[from->channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(s->png, s->info);
  for (size_t y = 0; y < from->height; y++) {
    if (cag_stopped()) png_error(s->png, "it was stopped");
    png_write_row(s->png, from->bytes + y * row_size(from));
  }
  png_write_end(s->png, s->info);
  return true;
}

bool cag_png_write_samples(const char *path, const CagPngSamples *from, CagError *err) {
  Session s = {.file = cag_atomic_file_open(path, err)};
  if (!s.file) return false;
  s.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning);
  s.info = s.png ? png_create_info_struct(s.png) : NULL;
  const bool ok = s.info && encode(&s, from);
  const bool refused = cag_atomic_file_failed(s.file);
  if (s.png) png_destroy_write_struct(&s.png, &s.info);
  if (ok || refused) return cag_atomic_file_commit(s.file, err);
  cag_atomic_file_abort(s.file);
  if (cag_stopped()) return cag_fail_io(err, CAG_E_CALLBACK, NULL, "writing was stopped");
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot write '%s' as PNG: %s", path,
                     s.message[0] ? s.message : "no memory");
}
