// Images made of numbers, and their pixels.

#include "interp/builtin/images.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
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

CagValue cag_pixel_value(CagVm *vm, const CagRaster *r, size_t x, size_t y) {
  if (r->channel_count == 1) return sample_value(*cag_raster_at(r, 0, x, y));
  CagBuilder *channels = cag_builder_new(vm);
  for (size_t c = 0; c < r->channel_count; c++)
    cag_builder_add(vm, channels, sample_value(*cag_raster_at(r, c, x, y)));
  return cag_builder_finish(vm, channels);
}

// --- Making ---

// An image that is being made: its size in channels is that of the first pixel.
typedef struct Draft {
  CagCall *call;
  int source; // the argument that the pixels come from
  size_t width, height;
  CagRaster *raster; // held; NULL before the first pixel
} Draft;

// The number of channels of a pixel; 0, with the error set, if it is not one.
static size_t count_channels(const Draft *d, CagValue pixel) {
  if (pixel.type != CAG_LIST) return 1;
  const size_t n = CAG_AS_LIST(pixel)->length;
  if (n == 0) cag_fail_value(d->call, d->source, "pixels of at least one number");
  return n;
}

static bool read_sample(const Draft *d, CagValue v, double *out) {
  v = cag_plain(v);
  if (v.type != CAG_NUMBER && v.type != CAG_NONE)
    return cag_fail_call(d->call, d->source, CAG_ERR_type,
                         "expects numbers, lists of numbers, or none as pixels, found %s",
                         cag_type_article(v));
  *out = v.type == CAG_NONE ? NAN : v.as.number;
  return true;
}

static bool draft_pixel(Draft *d, size_t x, size_t y, CagValue pixel) {
  const size_t n = count_channels(d, pixel);
  if (n == 0) return false;
  if (!d->raster && !(d->raster = cag_held_raster(d->call, d->width, d->height, n))) return false;
  if (n != d->raster->channel_count)
    return cag_fail_call(d->call, d->source, CAG_ERR_ragged_rows,
                         "expects %zu channels in each pixel, found %zu at [%zu, %zu]",
                         d->raster->channel_count, n, x, y);
  for (size_t c = 0; c < n; c++) {
    const CagValue v =
        pixel.type == CAG_LIST ? cag_list_get(d->call->vm, CAG_AS_LIST(pixel), c) : pixel;
    if (!read_sample(d, v, cag_raster_at(d->raster, c, x, y))) return false;
  }
  return true;
}

// Names the channels by an argument, or as is usual for their number.
static bool name_channels(CagCall *call, int argument, CagRaster *r) {
  static const char *const usual[] = {"r", "g", "b", "a"};
  const size_t n = r->channel_count;
  if (!cag_given(call, argument)) {
    for (size_t c = 0; c < n && (n == 3 || n == 4); c++)
      if (!cag_geometry_ok(call, cag_raster_name(r, c, usual[c], call->err))) return false;
    return true;
  }
  CagList *names;
  if (!cag_arg_list(call, argument, &names)) return false;
  if (names->length != n)
    return cag_fail_call(call, argument, CAG_ERR_length, "expects %zu names of channels, found %zu",
                         n, names->length);
  for (size_t c = 0; c < n; c++) {
    const CagValue name = cag_list_get(call->vm, names, c);
    if (name.type != CAG_TEXT || !cag_text_is_c(CAG_AS_TEXT(name)))
      return cag_fail_element(call, argument, c, name, "texts");
    if (!cag_geometry_ok(call, cag_raster_name(r, c, CAG_AS_TEXT(name)->bytes, call->err)))
      return false;
  }
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

static bool image_of_rows(CagCall *call, CagValue *result) {
  CagList *rows;
  if (!cag_arg_list(call, 0, &rows)) return false;
  Draft d = {.call = call, .height = rows->length};
  if (!draft_rows(&d, rows)) return false;
  if (!d.raster)
    return cag_fail_call(call, 0, CAG_ERR_empty_image, "expects at least one row of pixels");
  if (!name_channels(call, 1, d.raster)) return false;
  *result = cag_image_result(call, d.raster);
  return true;
}

static bool image_of_function(CagCall *call, CagValue *result) {
  long width, height;
  CagValue f, pixel;
  if (!cag_arg_integer(call, 0, 1, CAG_RASTER_SIDE_MAX, &width) ||
      !cag_arg_integer(call, 1, 1, CAG_RASTER_SIDE_MAX, &height) || !cag_arg_function(call, 2, &f))
    return false;
  Draft d = {.call = call, .source = 2, .width = (size_t)width, .height = (size_t)height};
  for (size_t y = 0; y < d.height; y++)
    for (size_t x = 0; x < d.width; x++) {
      const CagValue at[2] = {cag_number((double)x), cag_number((double)y)};
      if (!cag_call(call->vm, f, at, 2, &pixel) || !draft_pixel(&d, x, y, pixel)) return false;
    }
  if (!name_channels(call, 3, d.raster)) return false;
  *result = cag_image_result(call, d.raster);
  return true;
}

bool cag_images_image(CagCall *call, CagValue *result) {
  return call->values[0].type == CAG_NUMBER ? image_of_function(call, result)
                                            : image_of_rows(call, result);
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
    if (!cag_builder_add(call->vm, rows, cag_builder_finish(call->vm, row))) return false;
  }
  *result = cag_builder_finish(call->vm, rows);
  return true;
}
