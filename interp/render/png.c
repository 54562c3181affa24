// PNG pictures: tone mapping, transfer function, and libpng.
//
// libpng reports errors by longjmp. Reading and writing each have one function that calls libpng
// and owns no resources; a struct of its caller holds everything that must be freed.

#include "interp/render/png.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/memory.h"

// The constants of IEC 61966-2-1.
#define SRGB_LINEAR_END 0.0031308
#define SRGB_ENCODED_END 0.04045
#define SRGB_SLOPE 12.92
#define SRGB_OFFSET 0.055
#define SRGB_GAMMA 2.4

double cag_png_srgb_encode(double linear) {
  if (linear <= SRGB_LINEAR_END) return SRGB_SLOPE * linear;
  return (1 + SRGB_OFFSET) * pow(linear, 1 / SRGB_GAMMA) - SRGB_OFFSET;
}

double cag_png_srgb_decode(double encoded) {
  if (encoded <= SRGB_ENCODED_END) return encoded / SRGB_SLOPE;
  return pow((encoded + SRGB_OFFSET) / (1 + SRGB_OFFSET), SRGB_GAMMA);
}

double cag_png_shoulder(double x) {
  const double s = CAG_PNG_SHOULDER, room = 1 - CAG_PNG_SHOULDER;
  return x <= s ? x : s + room * -expm1(-(x - s) / room);
}

typedef struct {
  char message[200];
  const char *shown;
  // writing
  CagAtomicFile *file;
  png_byte *row;
  // reading
  FILE *input;
  png_uint_16 *pixels;
  png_bytep *rows;
  png_structp png;
  png_infop info;
  CagImage image;
} Session;

static void on_error(png_structp png, png_const_charp message) {
  Session *s = png_get_error_ptr(png);
  snprintf(s->message, sizeof s->message, "%s", message);
  png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message) { (void)png, (void)message; }

// --- Writing ---

static void on_write(png_structp png, png_bytep data, png_size_t n) {
  CagAtomicFile *file = png_get_io_ptr(png);
  cag_atomic_file_write(file, data, n);
  if (cag_atomic_file_failed(file))
    png_error(png, "the data could not be written to the disk"); // commit reports
                                                                 // the reason
}

static void on_flush(png_structp png) { (void)png; }

// How samples are converted to numbers in the file.
typedef struct {
  const CagImage *image;
  size_t rgb[3];
  size_t alpha;
  bool has_alpha, clip;
  double gain;
  int bits;
} Tone;

static double unit(double x) { return x >= 1 ? 1 : x > 0 ? x : 0; } // NaN becomes 0

static double tone_map(const Tone *t, double linear) {
  const double x = linear * t->gain;
  if (!(x > 0)) return 0;
  return cag_png_srgb_encode(unit(t->clip ? x : cag_png_shoulder(x)));
}

static png_byte *put_sample(png_byte *at, double encoded, int bits) {
  const unsigned most = bits == 16 ? 65535 : 255;
  const unsigned value = (unsigned)(encoded * most + 0.5);
  if (bits == 16) *at++ = (png_byte)(value >> 8);
  *at++ = (png_byte)(value & 255);
  return at;
}

static void fill_row(const Tone *t, size_t y, png_byte *at) {
  const size_t width = t->image->width;
  for (size_t x = 0; x < width; x++) {
    const size_t i = y * width + x;
    double alpha = t->has_alpha ? unit(cag_image_plane(t->image, t->alpha)[i]) : 1;
    for (int c = 0; c < 3; c++) {
      double linear = cag_image_plane(t->image, t->rgb[c])[i];
      if (alpha > 0 && alpha < 1) linear /= alpha;
      at = put_sample(at, tone_map(t, linear), t->bits);
    }
    if (t->has_alpha) at = put_sample(at, alpha, t->bits);
  }
}

static void put_texts(Session *s, const CagPngText *texts, size_t count) {
  for (size_t i = 0; i < count; i++) {
    png_text chunk = {0};
    chunk.key = (char *)texts[i].key;
    chunk.text = (char *)texts[i].text;
    chunk.compression = PNG_ITXT_COMPRESSION_NONE;
    png_set_text(s->png, s->info, &chunk, 1);
  }
}

// Everything that libpng may leave by longjmp.
static bool encode(Session *s, const Tone *t, const CagPngText *texts, size_t text_count) {
  if (setjmp(png_jmpbuf(s->png))) return false;
  png_set_write_fn(s->png, s->file, on_write, on_flush);
  png_set_user_limits(s->png, (png_uint_32)CAG_IMAGE_SIDE_MAX, (png_uint_32)CAG_IMAGE_SIDE_MAX);
  png_set_IHDR(s->png, s->info, (png_uint_32)t->image->width, (png_uint_32)t->image->height,
               t->bits, t->has_alpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(s->png, s->info, PNG_sRGB_INTENT_PERCEPTUAL);
  put_texts(s, texts, text_count);
  png_write_info(s->png, s->info);
  for (size_t y = 0; y < t->image->height; y++) {
    fill_row(t, y, s->row);
    png_write_row(s->png, s->row);
  }
  png_write_end(s->png, s->info);
  return true;
}

static bool prepare_tone(const char *path, const CagImage *image, const CagPngOptions *options,
                         Tone *t, CagError *err) {
  *t = (Tone){.image = image, .gain = exp2(options->exposure), .clip = options->keep_linear};
  t->bits = options->bits ? options->bits : 8;
  if (t->bits != 8 && t->bits != 16)
    return cag_fail_io(err, CAG_E_USAGE, "use 8 or 16",
                       "cannot write '%s': PNG has no %d bits per channel here", path, t->bits);
  if (!cag_image_find_color(image, t->rgb))
    return cag_fail_io(err, CAG_E_USAGE, "name the channels R, G, and B, or Y",
                       "cannot write '%s': the image has no color channels", path);
  t->has_alpha = !options->drop_alpha && cag_image_find(image, "A", &t->alpha);
  return true;
}

bool cag_png_write(const char *path, const CagImage *image, const CagPngOptions *options,
                   const CagPngText *texts, size_t text_count, CagError *err) {
  static const CagPngOptions PLAIN = {0};
  Tone tone;
  if (!prepare_tone(path, image, options ? options : &PLAIN, &tone, err)) return false;
  Session s = {.shown = path};
  s.file = cag_atomic_file_open(path, err);
  if (!s.file) return false;
  s.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning);
  s.info = s.png ? png_create_info_struct(s.png) : NULL;
  s.row = cag_malloc(image->width * 4 * sizeof(png_uint_16));
  bool ok = s.info && s.row && encode(&s, &tone, texts, text_count);
  const bool refused = cag_atomic_file_failed(s.file);
  if (s.png) png_destroy_write_struct(&s.png, &s.info);
  cag_free(s.row);
  if (ok || refused) return cag_atomic_file_commit(s.file, err);
  cag_atomic_file_abort(s.file);
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot write '%s' as PNG: %s", path,
                     s.message[0] ? s.message : "no memory");
}

// --- Reading ---

static void on_read(png_structp png, png_bytep data, png_size_t n) {
  Session *s = png_get_io_ptr(png);
  if (fread(data, 1, n, s->input) != n) png_error(png, "the file ends too early");
}

// Decodes into s->pixels: 16-bit samples of `channels` (3 or 4) per pixel.
static bool decode(Session *s, size_t *width, size_t *height, size_t *channels, CagError *err) {
  if (setjmp(png_jmpbuf(s->png))) return false;
  png_set_read_fn(s->png, s, on_read);
  png_set_user_limits(s->png, (png_uint_32)CAG_IMAGE_SIDE_MAX, (png_uint_32)CAG_IMAGE_SIDE_MAX);
  png_read_info(s->png, s->info);
  png_set_expand_16(s->png);
  png_set_gray_to_rgb(s->png);
  png_set_swap(s->png); // PNG is big-endian
  png_set_interlace_handling(s->png);
  png_read_update_info(s->png, s->info);
  *width = png_get_image_width(s->png, s->info);
  *height = png_get_image_height(s->png, s->info);
  *channels = png_get_channels(s->png, s->info);
  // The limits of images apply to the decoded samples, too.
  if (!cag_image_create(&s->image, *width, *height, *channels, err)) return true;
  s->pixels = cag_malloc(*width * *height * *channels * sizeof *s->pixels);
  s->rows = cag_malloc(*height * sizeof *s->rows);
  if (!s->pixels || !s->rows) png_error(s->png, "no memory");
  for (size_t y = 0; y < *height; y++) s->rows[y] = (png_bytep)(s->pixels + y * *width * *channels);
  png_read_image(s->png, s->rows);
  png_read_end(s->png, NULL);
  return true;
}

static void to_linear(const Session *s) {
  static const char *const NAMES[4] = {"R", "G", "B", "A"};
  CagImage image = s->image;
  const size_t channels = image.channel_count;
  for (size_t c = 0; c < channels; c++) cag_image_set_name(&image, c, NAMES[c]);
  for (size_t i = 0; i < image.width * image.height; i++) {
    const png_uint_16 *from = s->pixels + i * channels;
    const double alpha = channels == 4 ? from[3] / 65535.0 : 1;
    for (size_t c = 0; c < 3; c++)
      cag_image_plane(&image, c)[i] = (float)(alpha * cag_png_srgb_decode(from[c] / 65535.0));
    if (channels == 4) cag_image_plane(&image, 3)[i] = (float)alpha;
  }
}

static bool fail_read(CagError *err, const char *path, const char *why) {
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot read '%s' as PNG: %s", path, why);
}

bool cag_png_read(const char *path, CagImage *out, CagError *err) {
  Session s = {.shown = path};
  s.input = fopen(path, "rbe");
  if (!s.input) return fail_read(err, path, strerror(errno));
  struct stat st;
  if (fstat(fileno(s.input), &st) == 0 && S_ISDIR(st.st_mode)) {
    fclose(s.input);
    return fail_read(err, path, "it is a folder");
  }
  size_t width = 0, height = 0, channels = 0;
  s.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &s, on_error, on_warning);
  s.info = s.png ? png_create_info_struct(s.png) : NULL;
  CagError inner = {0};
  bool ok = s.info && decode(&s, &width, &height, &channels, &inner);
  if (!ok) {
    fail_read(err, path, s.message[0] ? s.message : "no memory");
  } else if (!s.image.data) {
    ok = cag_fail_io(err, inner.status, inner.help, "cannot read '%s' as PNG: %.300s", path,
                     inner.message);
  } else {
    to_linear(&s);
    *out = s.image;
  }
  if (!ok) cag_image_free(&s.image);
  if (s.png) png_destroy_read_struct(&s.png, &s.info, NULL);
  cag_free(s.pixels);
  cag_free(s.rows);
  fclose(s.input);
  return ok;
}
