// Images made of others: parts, other sizes, turned, fields.

#include <math.h>

#include "geom/image/layout.h"
#include "geom/image/resample.h"
#include "interp/builtin/images.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// --- Channels ---

// Fails with a help that lists the channels.
static bool fail_channel(CagCall *call, int argument, const CagRaster *r, const char *name) {
  // More names than this make the help unreadable.
  enum { NAMES_LISTED = 12 };
  CagString names = {0};
  for (size_t c = 0; c < r->channel_count && c < NAMES_LISTED; c++)
    cag_string_printf(&names, "%s\"%s\"", c ? ", " : "", r->names[c]);
  if (r->channel_count > NAMES_LISTED) cag_string_printf(&names, ", ...");
  cag_string_check(call->vm, &names);
  cag_fail_call(call, argument, CAG_ERR_no_channel, "expects a channel of the image, found \"%s\"",
                name);
  if (r->channel_count == 1 && !*r->names[0])
    cag_fail_help(call->vm, "the image has a single channel, which has no name");
  else cag_fail_help(call->vm, "its channels are %s", names.bytes);
  cag_string_free(&names);
  return false;
}

bool cag_channel_find(CagCall *call, int argument, const CagRaster *r, const char *name,
                      size_t *channel) {
  return cag_raster_find(r, name, channel) || fail_channel(call, argument, r, name);
}

bool cag_images_channel(CagCall *call, const struct cag_images_channel *a, CagValue *result) {
  size_t c;
  CagRaster *made = NULL;
  return cag_channel_find(call, 1, a->image, a->name, &c) &&
         cag_raster_result(call, cag_raster_select(a->image, &c, 1, &made, call->err), &made,
                           result);
}

// --- Parts and sizes ---

// Whether `size` pixels from `from` on lie within the side of an image. The arguments follow each
// other.
static bool check_part(CagCall *call, int argument, long from, long size, size_t side) {
  if ((size_t)from < side && (size_t)size <= side - (size_t)from) return true;
  return cag_fail_call(call, argument, CAG_ERR_index,
                       "expects a part of the image, whose %s is %zu, found %ld pixels from %ld on",
                       argument == 1 ? "width" : "height", side, size, from);
}

bool cag_images_crop(CagCall *call, const struct cag_images_crop *a, CagValue *result) {
  CagRaster *made = NULL;
  if (!check_part(call, 1, a->x, a->width, a->image->width) ||
      !check_part(call, 2, a->y, a->height, a->image->height))
    return false;
  return cag_raster_result(call,
                           cag_raster_crop(a->image, (size_t)a->x, (size_t)a->y, (size_t)a->width,
                                           (size_t)a->height, &made, call->err),
                           &made, result);
}

bool cag_images_resize(CagCall *call, const struct cag_images_resize *a, CagValue *result) {
  CagRaster *made = NULL;
  return cag_raster_result(
      call, cag_raster_resize(a->image, (size_t)a->width, (size_t)a->height, &made, call->err),
      &made, result);
}

bool cag_images_enlarge(CagCall *call, const struct cag_images_enlarge *a, CagValue *result) {
  CagRaster *made = NULL;
  return cag_raster_result(call, cag_raster_enlarge(a->image, (size_t)a->n, &made, call->err),
                           &made, result);
}

bool cag_images_turned(CagCall *call, const struct cag_images_turned *a, CagValue *result) {
  CagRaster *made = NULL;
  const double outside = cag_given(call, 2) ? a->outside : NAN;
  if (!isfinite(a->angle)) return cag_fail_value(call, 1, "a finite angle");
  return cag_raster_result(call, cag_raster_turn(a->image, a->angle, outside, &made, call->err),
                           &made, result);
}

bool cag_images_flipped(CagCall *call, const struct cag_images_flipped *a, CagValue *result) {
  CagRaster *made = NULL;
  return cag_raster_result(call, cag_raster_flip(a->image, a->axis == 0, &made, call->err), &made,
                           result);
}

// --- Fields ---

bool cag_images_split_fields(CagCall *call, const struct cag_images_split_fields *a,
                             CagValue *result) {
  static const char *const names[] = {"odd", "even"};
  CagValue fields[2] = {cag_none(), cag_none()};
  for (int even = 0; even < 2 && (size_t)even < a->image->height; even++) {
    CagRaster *made = NULL;
    if (!cag_raster_result(call, cag_raster_field(a->image, even == 1, &made, call->err), &made,
                           &fields[even]))
      return false;
  }
  *result = cag_record_new(call->vm, names, fields, 2);
  return true;
}

bool cag_images_weave(CagCall *call, const struct cag_images_weave *a, CagValue *result) {
  CagRaster *made = NULL, *even = NULL;
  if (a->even.type != CAG_NONE && !cag_arg_image(call, 1, &even)) return false;
  return cag_raster_result(call, cag_raster_weave(a->odd, even, &made, call->err), &made, result);
}

// Calls f(t), which must return an image. Holds the field of it.
static bool take_field(CagCall *call, CagValue f, double t, bool even, CagRaster **frame,
                       CagRaster **out) {
  const CagValue at = cag_number(t);
  CagValue v;
  if (!cag_call(call->vm, f, &at, 1, &v)) return false;
  if (v.type != CAG_IMAGE)
    return cag_fail_call(call, 0, CAG_ERR_type,
                         "expects a function that returns an image, found "
                         "that it returns %s",
                         cag_type_article(v));
  *frame = cag_hold_raster(call, cag_raster_retain(CAG_AS_IMAGE(v)->raster));
  *out = NULL;
  if (even && (*frame)->height == 1) return true;
  if (!cag_geometry_ok(call, cag_raster_field(*frame, even, out, call->err))) return false;
  cag_hold_raster(call, *out);
  return true;
}

bool cag_images_interlaced(CagCall *call, const struct cag_images_interlaced *a, CagValue *result) {
  CagRaster *first, *second, *odd, *even, *made = NULL;
  cag_root_push(call->vm, a->f);
  const bool good = take_field(call, a->f, 0, false, &first, &odd) &&
                    take_field(call, a->f, a->period / 2, true, &second, &even);
  cag_root_pop(call->vm, 1);
  if (!good) return false;
  if (first->width != second->width || first->height != second->height)
    return cag_fail_call(call, 0, CAG_ERR_image_sizes,
                         "expects images of one size, found %zu x %zu and %zu x %zu", first->width,
                         first->height, second->width, second->height);
  return cag_raster_result(call, cag_raster_weave(odd, even, &made, call->err), &made, result);
}
