#include "interp/formats/raster_file.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "base/string.h"
#include "geom/image/arithmetic.h"
#include "interp/render/exr.h"
#include "interp/render/png_samples.h"

// Attributes of the header: the names of the channels in the file and of the image, a line each, in
// the order of the image.
#define FILE_NAMES "cag.fileChannels"
#define OWN_NAMES "cag.channels"

// Our names of the channels of colors, and those of EXR.
static const char *const OWN_COLORS[] = {"r", "g", "b", "a"};
static const char *const EXR_COLORS[] = {"R", "G", "B", "A"};
#define COLORS 4

static bool fail_core(CagError *err, const char *shown, const CagError *inner) {
  return cag_fail_io(err, inner->status, NULL, "cannot read '%s': %.300s", shown, inner->message);
}

// --- Names of channels in EXR ---

static bool has_name(const CagRaster *r, const char *name) {
  size_t c;
  return cag_raster_find(r, name, &c);
}

// The name of channel c in a file. Channels without a name are numbered.
static void exr_name(const CagRaster *r, size_t c, char *out, size_t size) {
  const char *name = r->names[c];
  for (size_t i = 0; i < COLORS; i++)
    if (!strcmp(name, OWN_COLORS[i]) && !has_name(r, EXR_COLORS[i])) name = EXR_COLORS[i];
  if (*name) snprintf(out, size, "%s", name);
  else if (r->channel_count == 1) snprintf(out, size, "Y");
  else snprintf(out, size, "channel%zu", c);
}

static const char *own_name(const CagImage *image, size_t c) {
  const char *name = image->channels[c].name;
  if (image->channel_count == 1 && !strcmp(name, "Y")) return "";
  size_t other;
  for (size_t i = 0; i < COLORS; i++)
    if (!strcmp(name, EXR_COLORS[i]) && !cag_image_find(image, OWN_COLORS[i], &other))
      return OWN_COLORS[i];
  return name;
}

// --- Reading EXR ---

// Which channel of a file becomes each channel of the image, and its name.
typedef struct Order {
  size_t *from;
  char (*names)[CAG_CHANNEL_NAME_MAX + 1];
} Order;

// Copies the line at *at to `out`, and moves behind it. False: there is none, or it is too long.
static bool next_line(const char **at, char *out, size_t size) {
  const size_t n = strcspn(*at, "\n");
  if ((*at)[n] != '\n' || n >= size) return false;
  memcpy(out, *at, n);
  out[n] = '\0';
  *at += n + 1;
  return true;
}

// The order of the attributes. False: they are missing, or do not fit the channels.
static bool order_as_written(const CagImage *image, const CagExrMetadata *m, Order *order) {
  const CagExrAttribute *file = cag_exr_metadata_find(m, FILE_NAMES);
  const CagExrAttribute *own = cag_exr_metadata_find(m, OWN_NAMES);
  if (!file || !own || file->kind != CAG_EXR_TEXT || own->kind != CAG_EXR_TEXT) return false;
  const char *at = file->text, *named = own->text;
  char name[CAG_IMAGE_NAME_MAX + 1];
  for (size_t c = 0; c < image->channel_count; c++) {
    if (!next_line(&at, name, sizeof name) ||
        !next_line(&named, order->names[c], sizeof order->names[c]) ||
        !cag_image_find(image, name, &order->from[c]))
      return false;
    for (size_t i = 0; i < c; i++)
      if (order->from[i] == order->from[c] || !strcmp(order->names[i], order->names[c]))
        return false;
  }
  return !*at && !*named;
}

// The order for other files: colors first.
static void order_as_usual(const CagImage *image, Order *order) {
  size_t n = 0, c;
  for (size_t i = 0; i < COLORS; i++)
    if (cag_image_find(image, EXR_COLORS[i], &c)) order->from[n++] = c;
  const size_t colors = n;
  for (c = 0; c < image->channel_count && n < image->channel_count; c++) {
    bool taken = false;
    for (size_t i = 0; i < colors; i++) taken = taken || order->from[i] == c;
    if (!taken) order->from[n++] = c;
  }
  for (c = 0; c < n; c++)
    snprintf(order->names[c], sizeof order->names[c], "%s", own_name(image, order->from[c]));
}

static CagStatus copy_samples(const CagImage *image, const Order *order, CagRaster *r,
                              CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t c = 0; !status && c < r->channel_count; c++) {
    const float *from = cag_image_plane(image, order->from[c]);
    status = cag_raster_name(r, c, order->names[c], err);
    for (size_t y = 0; !status && y < r->height; y++) {
      double *to = cag_raster_at(r, c, 0, y);
      for (size_t x = 0; x < r->width; x++, from++) to[x] = isfinite(*from) ? (double)*from : NAN;
      status = cag_stop_check(err);
    }
  }
  return status;
}

static CagStatus raster_of_exr(const CagImage *image, const CagExrMetadata *m, CagRaster **out,
                               CagError *err) {
  const size_t n = image->channel_count;
  CagRaster *made;
  CagStatus status = cag_raster_new(image->width, image->height, n, &made, err);
  if (status) return status;
  Order order = {cag_calloc(n, sizeof *order.from), cag_calloc(n, sizeof *order.names)};
  if (!order.from || !order.names) status = cag_fail_memory(err);
  if (!status) {
    if (!order_as_written(image, m, &order)) order_as_usual(image, &order);
    status = copy_samples(image, &order, made, err);
  }
  cag_free(order.from);
  cag_free(order.names);
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

static bool read_exr(const void *bytes, size_t size, const char *shown, CagRaster **out,
                     CagError *err) {
  CagImage image;
  CagExrMetadata metadata = {0};
  CagError inner = {0};
  bool ok = cag_exr_read_memory(bytes, size, shown, &image, &metadata, err);
  if (ok) {
    ok = !raster_of_exr(&image, &metadata, out, &inner) || fail_core(err, shown, &inner);
    cag_image_free(&image);
  }
  cag_exr_metadata_free(&metadata);
  return ok;
}

// --- Reading PNG ---

static CagStatus raster_of_png(const CagPngSamples *s, CagRaster **out, CagError *err) {
  static const char *const names[4][4] = {{""}, {"y", "a"}, {"r", "g", "b"}, {"r", "g", "b", "a"}};
  const double most = s->bits == 8 ? 255 : 65535;
  CagRaster *made;
  CagStatus status = cag_raster_new(s->width, s->height, s->channels, &made, err);
  if (status) return status;
  for (size_t c = 0; !status && c < s->channels; c++) {
    status = cag_raster_name(made, c, names[s->channels - 1][c], err);
    for (size_t y = 0; !status && y < s->height; y++) {
      double *to = cag_raster_at(made, c, 0, y);
      for (size_t x = 0; x < s->width; x++)
        to[x] = cag_png_sample(s, (y * s->width + x) * s->channels + c) / most;
      status = cag_stop_check(err);
    }
  }
  if (status) cag_raster_release(made);
  else *out = made;
  return status;
}

static bool read_png(const void *bytes, size_t size, const char *shown, CagRaster **out,
                     CagError *err) {
  CagPngSamples samples;
  CagError inner = {0};
  if (!cag_png_read_samples(bytes, size, shown, &samples, err)) return false;
  const bool ok = !raster_of_png(&samples, out, &inner) || fail_core(err, shown, &inner);
  cag_png_samples_free(&samples);
  return ok;
}

bool cag_raster_read(const void *bytes, size_t size, const char *shown, CagRaster **out,
                     CagError *err) {
  // The first four bytes of the formats.
  static const unsigned char EXR[4] = {0x76, 0x2f, 0x31, 0x01}, PNG[4] = {0x89, 'P', 'N', 'G'};
  if (size >= 4 && !memcmp(bytes, EXR, 4)) return read_exr(bytes, size, shown, out, err);
  if (size >= 4 && !memcmp(bytes, PNG, 4)) return read_png(bytes, size, shown, out, err);
  return cag_fail_io(err, CAG_E_FILE, NULL,
                     size ? "cannot read '%s': expected an EXR or PNG picture, found other bytes"
                          : "cannot read '%s': the file is empty",
                     shown);
}

// --- Writing ---

static float nearest_float(double x) {
  if (isnan(x)) return NAN;
  return fabs(x) > (double)FLT_MAX ? (float)copysign(INFINITY, x) : (float)x;
}

static bool image_of_raster(const CagRaster *r, CagImage *out, CagError *err) {
  char name[CAG_IMAGE_NAME_MAX + 1];
  if (!cag_image_create(out, r->width, r->height, r->channel_count, err)) return false;
  for (size_t c = 0; c < r->channel_count; c++) {
    const double *from = cag_raster_plane(r, c);
    float *to = cag_image_plane(out, c);
    exr_name(r, c, name, sizeof name);
    cag_image_set_name(out, c, name);
    for (size_t y = 0; y < r->height && !cag_stopped(); y++)
      for (size_t x = 0; x < r->width; x++) *to++ = nearest_float(*from++);
  }
  return true;
}

// Adds the attributes, unless names contain line ends.
static bool add_names(CagExrMetadata *m, const CagRaster *r, const CagImage *image, CagError *err) {
  CagString file = {0}, own = {0};
  bool plain = true;
  for (size_t c = 0; c < r->channel_count; c++) {
    plain = plain && !strchr(r->names[c], '\n');
    cag_string_printf(&file, "%s\n", image->channels[c].name);
    cag_string_printf(&own, "%s\n", r->names[c]);
  }
  bool ok = !file.failed && !own.failed;
  if (!ok) cag_fail_io(err, CAG_E_MEMORY, NULL, "no memory for the names of channels");
  if (ok && plain)
    ok = cag_exr_metadata_text(m, FILE_NAMES, file.bytes, err) &&
         cag_exr_metadata_text(m, OWN_NAMES, own.bytes, err);
  cag_string_free(&file);
  cag_string_free(&own);
  return ok;
}

bool cag_raster_write_exr(const char *path, const CagRaster *r, CagError *err) {
  CagImage image;
  CagExrMetadata metadata = {0};
  if (!image_of_raster(r, &image, err)) return false;
  const bool ok = add_names(&metadata, r, &image, err) &&
                  cag_exr_write(path, &image, CAG_EXR_FLOAT, &metadata, err);
  cag_exr_metadata_free(&metadata);
  cag_image_free(&image);
  return ok;
}

static bool has_png_channels(const CagRaster *r) {
  const size_t n = r->channel_count;
  return n == 1 || n == 3 || n == 4 || (n == 2 && !strcmp(r->names[1], "a"));
}

static void png_row(const CagRaster *r, const CagRasterRange *range, size_t c, size_t y,
                    CagPngSamples *s) {
  const double *from = cag_raster_at(r, c, 0, y), white = range->high - range->low;
  for (size_t x = 0; x < r->width; x++) {
    const double code = cag_code_of(from[x] - range->low, range->bits, white);
    cag_png_set_sample(s, (y * r->width + x) * r->channel_count + c,
                       isnan(code) ? 0 : (unsigned)code);
  }
}

bool cag_raster_write_png(const char *path, const CagRaster *r, const CagRasterRange *range,
                          CagError *err) {
  CagPngSamples s = {r->width, r->height, r->channel_count, range->bits, NULL};
  if (!has_png_channels(r)) {
    cag_fail_io(err, CAG_E_USAGE,
                "write .exr, or show one of the channels: show channel(image, name)",
                "cannot write '%s': a PNG has 1, 3, or 4 channels, the image has %zu", path,
                r->channel_count);
    err->id = CAG_ERR_image_channels;
    return false;
  }
  if (!cag_png_samples_create(&s, err)) return false;
  for (size_t c = 0; c < r->channel_count; c++)
    for (size_t y = 0; y < r->height && !cag_stopped(); y++) png_row(r, range, c, y, &s);
  const bool ok = cag_png_write_samples(path, &s, err);
  cag_png_samples_free(&s);
  return ok;
}
