// Filters, edges, and morphology of images.

#include "base/memory.h"
#include "geom/image/edges.h"
#include "geom/image/filter.h"
#include "geom/image/lines.h"
#include "geom/image/morphology.h"
#include "interp/builtin/image_calls.h"

// --- Filters ---

bool cag_filters_median(CagCall *call, const struct cag_filters_median *a, CagValue *result) {
  CagRaster *out = NULL;
  if (!cag_odd_size(call, 1, a->size)) return false;
  CagStatus status =
      cag_image_median(a->image, (size_t)a->size, (CagBorder)a->border, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_filters_majority(CagCall *call, const struct cag_filters_majority *a, CagValue *result) {
  CagRaster *out = NULL;
  CagStatus status = cag_image_majority(a->image, (CagBorder)a->border, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_filters_sharpen(CagCall *call, const struct cag_filters_sharpen *a, CagValue *result) {
  CagRaster *out = NULL;
  CagStatus status = cag_image_sharpen(a->image, a->k, (CagBorder)a->border, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_filters_stretch(CagCall *call, const struct cag_filters_stretch *a, CagValue *result) {
  CagRaster *out = NULL;
  double low = 0, high = 0;
  // An image without values is stretched to one without values.
  if (!cag_image_range(a->image, &low, &high)) low = high = 0;
  if (cag_given(call, 1)) low = a->low;
  if (cag_given(call, 2)) high = a->high;
  CagStatus status = cag_image_stretch(a->image, low, high, a->top, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_filters_blur(CagCall *call, const struct cag_filters_blur *a, CagValue *result) {
  CagRaster *out = NULL;
  CagStatus status = cag_image_blur(a->image, a->sigma, (CagBorder)a->border, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

// A kernel of numbers, in rows from the top.
typedef struct Kernel {
  const double *weights;
  size_t width, height;
} Kernel;

static bool kernel_of_rows(CagCall *call, int argument, Kernel *out) {
  CagList *rows;
  if (!cag_arg_list(call, argument, &rows)) return false;
  double *weights = NULL;
  for (size_t j = 0; j < rows->length; j++) {
    const CagValue row = cag_list_get(call->vm, rows, j);
    const double *numbers;
    size_t n;
    if (!cag_as_vector(row, &numbers, &n))
      return cag_fail_element(call, argument, j, row, "lists of numbers");
    if (j == 0) {
      *out = (Kernel){.width = n, .height = rows->length};
      if (n > CAG_WINDOW_MOST || rows->length > CAG_WINDOW_MOST) return true;
      weights = cag_hold_array(call, n * rows->length, sizeof *weights);
      out->weights = weights;
    }
    if (n != out->width)
      return cag_fail_call(call, argument, CAG_ERR_ragged_rows,
                           "expects rows of one length in the kernel, found %zu numbers in row 0 "
                           "and %zu in row %zu",
                           out->width, n, j);
    for (size_t i = 0; i < n; i++) weights[j * n + i] = numbers[i];
  }
  return true;
}

static bool arg_kernel(CagCall *call, int argument, Kernel *out) {
  *out = (Kernel){0};
  if (call->values[argument].type == CAG_IMAGE) {
    const CagRaster *r = CAG_AS_IMAGE(call->values[argument])->raster;
    *out = (Kernel){r->data, r->width, r->height};
    if (!cag_gray_image(call, argument, r)) return false;
  } else if (call->values[argument].type != CAG_LIST) {
    return cag_fail_type(call, argument, "an image or a list of rows");
  } else if (!kernel_of_rows(call, argument, out)) {
    return false;
  }
  if (out->width % 2 == 0 || out->height % 2 == 0 || out->width > CAG_WINDOW_MOST ||
      out->height > CAG_WINDOW_MOST)
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects a kernel of odd width and height, at most %d, found %zu x %zu",
                         CAG_WINDOW_MOST, out->width, out->height);
  return true;
}

bool cag_filters_convolve(CagCall *call, const struct cag_filters_convolve *a, CagValue *result) {
  CagRaster *out = NULL;
  Kernel k;
  if (!arg_kernel(call, 1, &k)) return false;
  CagStatus status = cag_image_convolve(a->image, k.weights, k.width, k.height,
                                        (CagBorder)a->border, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

// --- Morphology ---

bool cag_filters_dilate(CagCall *call, const struct cag_filters_dilate *a, CagValue *result) {
  CagRaster *out = NULL;
  if (!cag_odd_size(call, 1, a->size)) return false;
  CagStatus status = cag_image_dilate(a->image, (size_t)a->size, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_filters_erode(CagCall *call, const struct cag_filters_erode *a, CagValue *result) {
  CagRaster *out = NULL;
  if (!cag_odd_size(call, 1, a->size)) return false;
  CagStatus status = cag_image_erode(a->image, (size_t)a->size, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

bool cag_filters_distance_transform(CagCall *call, const struct cag_filters_distance_transform *a,
                                    CagValue *result) {
  CagRaster *out = NULL;
  if (!cag_gray_image(call, 0, a->image)) return false;
  CagStatus status = cag_distance_transform(a->image, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

// --- Edges ---

static bool polar_result(CagCall *call, CagStatus status, CagRaster **magnitude,
                         CagRaster **direction, CagValue *result) {
  static const char *const names[] = {"magnitude", "direction"};
  // Nothing allocates a value between the two, so the second one cannot be lost.
  if (!cag_hold_image(call, status, magnitude) || !cag_hold_image(call, status, direction))
    return false;
  CagValue values[2] = {cag_image_result(call, *magnitude)};
  values[1] = cag_image_result(call, *direction);
  *result = cag_record_new(call->vm, names, values, 2);
  return true;
}

bool cag_filters_roberts(CagCall *call, const struct cag_filters_roberts *a, CagValue *result) {
  CagRaster *magnitude = NULL, *direction = NULL;
  if (!cag_gray_image(call, 0, a->image)) return false;
  if (a->image->width < 2 || a->image->height < 2)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects an image of at least 2 x 2 pixels, found %zu x %zu",
                         a->image->width, a->image->height);
  CagStatus status = cag_edges_roberts(a->image, &magnitude, &direction, call->err);
  return polar_result(call, status, &magnitude, &direction, result);
}

bool cag_filters_sobel(CagCall *call, const struct cag_filters_sobel *a, CagValue *result) {
  CagRaster *magnitude = NULL, *direction = NULL;
  if (!cag_gray_image(call, 0, a->image)) return false;
  CagStatus status = cag_edges_sobel(a->image, &magnitude, &direction, call->err);
  return polar_result(call, status, &magnitude, &direction, result);
}

bool cag_filters_canny(CagCall *call, const struct cag_filters_canny *a, CagValue *result) {
  CagRaster *out = NULL;
  if (!cag_gray_image(call, 0, a->image)) return false;
  if (a->high < a->low) return cag_fail_value(call, 2, "a magnitude of at least `low`");
  CagStatus status = cag_edges_canny(a->image, a->low, a->high, a->sigma, &out, call->err);
  return cag_raster_result(call, status, &out, result);
}

// --- Lines and corners ---

bool cag_filters_hough_lines(CagCall *call, const struct cag_filters_hough_lines *a,
                             CagValue *result) {
  static const char *const names[] = {"theta", "distance", "pixels", "start", "end"};
  CagImageLine *lines = NULL;
  size_t count = 0;
  if (!cag_gray_image(call, 0, a->image) ||
      !cag_geometry_ok(call, cag_hough_lines(a->image, (size_t)a->n, &lines, &count, call->err)))
    return false;
  cag_hold(call, lines);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < count; i++) {
    const CagImageLine *l = &lines[i];
    const CagValue values[] = {cag_angle(l->theta), cag_number(l->distance),
                               cag_number((double)l->pixels), cag_point(call->vm, l->start, 2),
                               cag_point(call->vm, l->end, 2)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 5))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_filters_corners(CagCall *call, const struct cag_filters_corners *a, CagValue *result) {
  static const char *const names[] = {"at", "strength"};
  CagImageCorner *corners = NULL;
  size_t count = 0;
  if (!cag_gray_image(call, 0, a->image) ||
      !cag_geometry_ok(call,
                       cag_image_corners(a->image, (size_t)a->n, &corners, &count, call->err)))
    return false;
  if (corners) cag_hold(call, corners);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < count; i++) {
    const CagValue values[] = {cag_point(call->vm, corners[i].at, 2),
                               cag_number(corners[i].strength)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 2))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}
