// Images made of numbers, their pixels, and figures of these.

#include "interp/builtin/images.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/image/arithmetic.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/vm/jet.h"
#include "interp/vm/vm.h"

bool cag_arg_image(CagCall *call, int argument, CagRaster **out) {
  const CagValue v = call->values[argument];
  if (v.type != CAG_IMAGE) return cag_fail_type(call, argument, "an image");
  *out = CAG_AS_IMAGE(v)->raster;
  return true;
}

static void release_raster(void *r) { cag_raster_release(r); }

CagRaster *cag_held_raster(CagCall *call, size_t width, size_t height, size_t channel_count) {
  CagRaster *r = NULL;
  if (!cag_geometry_ok(call, cag_raster_new(width, height, channel_count, &r, call->err)))
    return NULL;
  cag_hold_for(call, release_raster, r);
  return r;
}

CagValue cag_image_result(CagCall *call, CagRaster *r) {
  return cag_image_value(call->vm, cag_give_held(call, r));
}

static CagValue sample_value(double x) { return isnan(x) ? cag_none() : cag_number(x); }

// Whether a pixel has a value in any channel.
static bool has_value(const CagRaster *r, size_t x, size_t y) {
  for (size_t c = 0; c < r->channel_count; c++)
    if (!isnan(*cag_raster_at(r, c, x, y))) return true;
  return false;
}

CagValue cag_pixel_value(CagVm *vm, const CagRaster *r, size_t x, size_t y) {
  if (r->channel_count == 1) return sample_value(*cag_raster_at(r, 0, x, y));
  if (!has_value(r, x, y)) return cag_none();
  CagBuilder *channels = cag_builder_new(vm);
  for (size_t c = 0; c < r->channel_count; c++)
    cag_builder_add(vm, channels, sample_value(*cag_raster_at(r, c, x, y)));
  return cag_builder_finish(vm, channels);
}

CagRaster *cag_hold_raster(CagCall *call, CagRaster *r) {
  cag_hold_for(call, release_raster, r);
  return r;
}

bool cag_raster_result(CagCall *call, CagStatus status, CagRaster **made, CagValue *result) {
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_image_value(call->vm, *made);
  return true;
}

// --- Making ---

// An image that is being made: its number of channels is that of the first pixel with a value.
typedef struct Draft {
  CagCall *call;
  int source; // the argument that the pixels come from
  size_t width, height;
  CagRaster *raster; // held; NULL before the first pixel with a value
} Draft;

// Makes the raster, whose pixels have no values yet.
static bool draft_begin(Draft *d, size_t channels) {
  d->raster = cag_held_raster(d->call, d->width, d->height, channels);
  if (!d->raster) return false;
  for (size_t y = 0; y < d->height * channels; y++) {
    for (size_t x = 0; x < d->width; x++) d->raster->data[y * d->width + x] = NAN;
    if (!cag_keep_going(d->call->vm)) return false;
  }
  return true;
}

static bool read_sample(const Draft *d, CagValue v, double *out) {
  v = cag_plain(v);
  if (v.type != CAG_NUMBER && v.type != CAG_NONE)
    return cag_fail_call(d->call, d->source, CAG_ERR_type,
                         "expects numbers, lists of numbers, or none as pixels, found %s",
                         cag_type_article(v));
  if (v.type == CAG_NUMBER && !isfinite(v.as.number))
    return cag_fail_call(d->call, d->source, CAG_ERR_not_finite,
                         "expects finite numbers as pixels, found an infinite one; write none for "
                         "a pixel without a value");
  *out = v.type == CAG_NONE ? NAN : v.as.number;
  return true;
}

static bool draft_pixel(Draft *d, size_t x, size_t y, CagValue pixel) {
  const CagList *list = pixel.type == CAG_LIST ? CAG_AS_LIST(pixel) : NULL;
  const size_t n = list ? list->length : 1;
  if (pixel.type == CAG_NONE) return true; // in all channels
  if (n == 0) return cag_fail_value(d->call, d->source, "pixels of at least one number");
  if (!d->raster && !draft_begin(d, n)) return false;
  if (n != d->raster->channel_count)
    return cag_fail_call(d->call, d->source, CAG_ERR_ragged_rows,
                         "expects %zu channels in each pixel, found %zu at [%zu, %zu]",
                         d->raster->channel_count, n, x, y);
  for (size_t c = 0; c < n; c++) {
    const CagValue v = list ? cag_list_get(d->call->vm, list, c) : pixel;
    if (!read_sample(d, v, cag_raster_at(d->raster, c, x, y))) return false;
  }
  return true;
}

// Names the channels as is usual for their number.
static bool name_as_usual(CagCall *call, CagRaster *r) {
  static const char *const usual[] = {"r", "g", "b", "a"};
  const size_t n = r->channel_count;
  for (size_t c = 0; c < n && (n == 3 || n == 4); c++)
    if (!cag_geometry_ok(call, cag_raster_name(r, c, usual[c], call->err))) return false;
  return true;
}

// Names a channel, unless another one has the name.
static bool name_channel(CagCall *call, int argument, CagRaster *r, size_t c, CagValue name) {
  size_t other;
  if (name.type != CAG_TEXT || !cag_text_is_c(CAG_AS_TEXT(name)))
    return cag_fail_element(call, argument, c, name, "texts");
  const CagText *text = CAG_AS_TEXT(name);
  if (text->length > CAG_CHANNEL_NAME_MAX)
    return cag_fail_call(call, argument, CAG_ERR_image_channels,
                         "expects names of at most %d bytes, found one of %zu bytes",
                         CAG_CHANNEL_NAME_MAX, text->length);
  if (cag_raster_find(r, text->bytes, &other) && other < c)
    return cag_fail_call(call, argument, CAG_ERR_image_channels,
                         "expects different names, found \"%s\" twice", text->bytes);
  return cag_geometry_ok(call, cag_raster_name(r, c, text->bytes, call->err));
}

static bool name_channels(CagCall *call, int argument, CagRaster *r) {
  CagList *names;
  if (!cag_given(call, argument)) return name_as_usual(call, r);
  if (!cag_arg_list(call, argument, &names)) return false;
  if (names->length != r->channel_count)
    return cag_fail_call(call, argument, CAG_ERR_length, "expects %zu names of channels, found %zu",
                         r->channel_count, names->length);
  for (size_t c = 0; c < names->length; c++)
    if (!name_channel(call, argument, r, c, cag_list_get(call->vm, names, c))) return false;
  return true;
}

static bool draft_rows(Draft *d, const CagList *rows) {
  for (size_t y = 0; y < d->height; y++) {
    const CagValue row = cag_list_get(d->call->vm, rows, y);
    if (row.type != CAG_LIST) return cag_fail_element(d->call, d->source, y, row, "lists");
    const CagList *pixels = CAG_AS_LIST(row);
    if (y == 0) d->width = pixels->length;
    if (pixels->length != d->width)
      return cag_fail_call(d->call, d->source, CAG_ERR_ragged_rows,
                           "expects rows of one length, found %zu pixels in row 0 and %zu in row "
                           "%zu",
                           d->width, pixels->length, y);
    for (size_t x = 0; x < d->width; x++)
      if (!draft_pixel(d, x, y, cag_list_get(d->call->vm, pixels, x))) return false;
    if (!cag_keep_going(d->call->vm)) return false;
  }
  return true;
}

CagRaster *cag_held_rows(CagCall *call, int argument) {
  CagList *rows;
  if (!cag_arg_list(call, argument, &rows)) return NULL;
  Draft d = {.call = call, .source = argument, .height = rows->length};
  if (!draft_rows(&d, rows)) return NULL;
  if (d.width == 0) {
    cag_fail_call(call, argument, CAG_ERR_empty_image, "expects at least one row of pixels");
    return NULL;
  }
  return d.raster || draft_begin(&d, 1) ? d.raster : NULL;
}

static bool image_of_rows(CagCall *call, CagValue *result) {
  CagRaster *made = cag_held_rows(call, 0);
  if (!made || !name_channels(call, 1, made)) return false;
  *result = cag_image_result(call, made);
  return true;
}

// Calls f(x, y) for each pixel. It is rooted.
static bool draft_function(Draft *d, CagValue f) {
  for (size_t y = 0; y < d->height; y++)
    for (size_t x = 0; x < d->width; x++) {
      const CagValue at[2] = {cag_number((double)x), cag_number((double)y)};
      CagValue pixel;
      if (!cag_call(d->call->vm, f, at, 2, &pixel) || !draft_pixel(d, x, y, pixel)) return false;
    }
  return d->raster || draft_begin(d, 1);
}

static bool image_of_function(CagCall *call, CagValue *result) {
  long width, height;
  CagValue f;
  if (!cag_arg_integer(call, 0, 1, CAG_RASTER_SIDE_MAX, &width) ||
      !cag_arg_integer(call, 1, 1, CAG_RASTER_SIDE_MAX, &height) || !cag_arg_function(call, 2, &f))
    return false;
  Draft d = {.call = call, .source = 2, .width = (size_t)width, .height = (size_t)height};
  cag_root_push(call->vm, f);
  const bool good = draft_function(&d, f);
  cag_root_pop(call->vm, 1);
  if (!good || !name_channels(call, 3, d.raster)) return false;
  *result = cag_image_result(call, d.raster);
  return true;
}

bool cag_images_image(CagCall *call, CagValue *result) {
  return call->values[0].type == CAG_NUMBER ? image_of_function(call, result)
                                            : image_of_rows(call, result);
}

// Calls f(pixel) for each pixel that has a value. It is rooted.
static bool draft_map(Draft *d, const CagRaster *r, CagValue f) {
  for (size_t y = 0; y < d->height; y++) {
    for (size_t x = 0; x < d->width; x++) {
      if (!has_value(r, x, y)) continue;
      const CagValue v = cag_pixel_value(d->call->vm, r, x, y);
      CagValue pixel;
      if (!cag_call(d->call->vm, f, &v, 1, &pixel) || !draft_pixel(d, x, y, pixel)) return false;
    }
    if (!cag_keep_going(d->call->vm)) return false;
  }
  return d->raster || draft_begin(d, r->channel_count);
}

bool cag_images_map(CagCall *call, const struct cag_images_map *a, CagValue *result) {
  const CagRaster *r = a->image;
  Draft d = {.call = call, .source = 1, .width = r->width, .height = r->height};
  cag_root_push(call->vm, call->values[0]);
  cag_root_push(call->vm, a->f);
  const bool good = draft_map(&d, r, a->f);
  cag_root_pop(call->vm, 2);
  if (!good) return false;
  const bool same = d.raster->channel_count == r->channel_count;
  for (size_t c = 0; same && c < r->channel_count; c++)
    if (!cag_geometry_ok(call, cag_raster_name(d.raster, c, r->names[c], call->err))) return false;
  if (!same && !name_as_usual(call, d.raster)) return false;
  *result = cag_image_result(call, d.raster);
  return true;
}

// --- Pixels ---

bool cag_images_pixel(CagCall *call, const struct cag_images_pixel *a, CagValue *result) {
  const CagRaster *r = a->image;
  const size_t x = (size_t)a->x, y = (size_t)a->y;
  if (x >= r->width || y >= r->height)
    return cag_fail_call(call, x >= r->width ? 1 : 2, CAG_ERR_index,
                         "expects a pixel of the image, which is %zu x %zu, found [%zu, %zu]",
                         r->width, r->height, x, y);
  *result = cag_pixel_value(call->vm, r, x, y);
  return true;
}

bool cag_images_pixels(CagCall *call, const struct cag_images_pixels *a, CagValue *result) {
  const CagRaster *r = a->image;
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t y = 0; y < r->height; y++) {
    CagBuilder *row = cag_builder_new(call->vm);
    for (size_t x = 0; x < r->width; x++)
      if (!cag_builder_add(call->vm, row, cag_pixel_value(call->vm, r, x, y))) return false;
    if (!cag_builder_add(call->vm, rows, cag_builder_finish(call->vm, row)) ||
        !cag_geometry_ok(call, cag_stop_check(call->err)))
      return false;
  }
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

// --- Figures and codes ---

// Computes figures of the samples; false, with the error set.
static bool image_figures(CagCall *call, const CagRaster *r, CagRasterFigures *out) {
  return cag_geometry_ok(call, cag_raster_figures(r, out, call->err));
}

bool cag_images_min(CagCall *call, const struct cag_images_min *a, CagValue *result) {
  CagRasterFigures f;
  if (!image_figures(call, a->image, &f)) return false;
  *result = sample_value(f.least);
  return true;
}

bool cag_images_max(CagCall *call, const struct cag_images_max *a, CagValue *result) {
  CagRasterFigures f;
  if (!image_figures(call, a->image, &f)) return false;
  *result = sample_value(f.greatest);
  return true;
}

bool cag_images_sum(CagCall *call, const struct cag_images_sum *a, CagValue *result) {
  CagRasterFigures f;
  return image_figures(call, a->image, &f) && cag_give_number(call, f.sum, result);
}

typedef CagStatus RasterConversion(const CagRaster *r, int bits, double white, CagRaster **out,
                                   CagError *err);

// Converts an image or a number.
static bool convert(CagCall *call, CagValue v, int bits, double white, RasterConversion *image,
                    double (*number)(double, int, double), CagValue *result) {
  CagRaster *made = NULL;
  v = cag_plain(v);
  if (!isfinite(white)) return cag_fail_value(call, 2, "a finite number");
  if (v.type == CAG_NUMBER) return cag_give_number(call, number(v.as.number, bits, white), result);
  if (v.type != CAG_IMAGE) return cag_fail_type(call, 0, "an image or a number");
  return cag_raster_result(call, image(CAG_AS_IMAGE(v)->raster, bits, white, &made, call->err),
                           &made, result);
}

bool cag_images_quantize(CagCall *call, const struct cag_images_quantize *a, CagValue *result) {
  return convert(call, a->value, (int)a->bits, a->white, cag_raster_to_codes, cag_code_of, result);
}

bool cag_images_dequantize(CagCall *call, const struct cag_images_dequantize *a, CagValue *result) {
  return convert(call, a->code, (int)a->bits, a->white, cag_raster_from_codes, cag_value_of_code,
                 result);
}
