// Fits of models to pictures, and calibration of cameras.

#include <string.h>

#include "geom/camera/model_fit.h"
#include "interp/builtin/cameras.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// --- Arguments ---

// Points of the plane, one for each of `count` points.
static bool check_images(CagCall *call, int argument, CagPoints images, size_t count) {
  if (images.dimension != 2) return cag_fail_value(call, argument, "points of the plane, [x, y],");
  return images.count == count ||
         cag_fail_call(call, argument, CAG_ERR_length,
                       "expects one image for each of %zu points, found %zu", count, images.count);
}

// --- Fits ---

// Fits an affine or projective map. scales: one number for each point.
static CagStatus fit_model(bool projective, const CagPoints *points, const CagPoints *images,
                           CagModelFit *fit, double *scales, CagError *err) {
  if (projective)
    return cag_model_fit_projective(points->items, images->items, points->count, fit, scales, err);
  for (size_t i = 0; i < points->count; i++) scales[i] = 1;
  return cag_model_fit_affine(points->items, images->items, points->count, fit, err);
}

// The record of a fit; index: of best_model, else negative.
static CagValue fit_value(CagVm *vm, const CagModelFit *fit, const double *scales, size_t n,
                          long index) {
  static const char *const names[] = {"index", "rows", "scales", "error", "rms"};
  const CagValue values[] = {cag_number((double)index), cag_rows_value(vm, fit->rows[0], 3, 4),
                             cag_vector(vm, scales, n), cag_number(fit->error),
                             cag_number(fit->rms)};
  const size_t first = index < 0;
  return cag_record_new(vm, names + first, values + first, 5 - first);
}

static bool fit_result(CagCall *call, bool projective, CagPoints points, CagPoints images,
                       CagValue *result) {
  CagModelFit fit;
  if (!check_images(call, 1, images, points.count)) return false;
  double *scales = cag_hold_array(call, points.count, sizeof *scales);
  if (!cag_geometry_ok(call, fit_model(projective, &points, &images, &fit, scales, call->err)))
    return false;
  *result = fit_value(call->vm, &fit, scales, points.count, -1);
  return true;
}

bool cag_cameras_fit_affine(CagCall *call, const struct cag_cameras_fit_affine *a,
                            CagValue *result) {
  return fit_result(call, false, a->points, a->images, result);
}

bool cag_cameras_fit_projective(CagCall *call, const struct cag_cameras_fit_projective *a,
                                CagValue *result) {
  return fit_result(call, true, a->points, a->images, result);
}

bool cag_cameras_match_error(CagCall *call, const struct cag_cameras_match_error *a,
                             CagValue *result) {
  double rows[3][4], error, rms;
  if (!cag_arg_camera_rows(call, 0, rows) || !check_images(call, 2, a->images, a->points.count) ||
      !cag_geometry_ok(call, cag_model_error(rows, a->points.items, a->images.items,
                                             a->points.count, &error, &rms, call->err)))
    return false;
  return cag_give_number(call, error, result);
}

// --- The best of several models ---

// Reads one model as points of space.
static bool read_model(CagCall *call, CagValue v, size_t index, const CagPoints *images,
                       CagVec3 *out) {
  const CagList *list = v.type == CAG_LIST ? CAG_AS_LIST(v) : NULL;
  if (!list) return cag_fail_element(call, 0, index, v, "lists of points");
  if (list->length != images->count)
    return cag_fail_call(call, 0, CAG_ERR_length,
                         "expects %zu points in each model, one for each image, found %zu in [%zu]",
                         images->count, list->length, index);
  for (size_t i = 0; i < list->length; i++) {
    const double *x;
    size_t n;
    const CagValue point = cag_list_get(call->vm, list, i);
    if (!cag_as_vector(point, &x, &n) || n < 2 || n > 3 || !isfinite(x[0] + x[1] + x[n - 1]))
      return cag_fail_call(call, 0, CAG_ERR_type,
                           "expects lists of points as models; models[%zu][%zu] is not a point",
                           index, i);
    out[i] = cag_vec3(x[0], x[1], n == 3 ? x[2] : 0);
  }
  return true;
}

// Adds which model it was to the message of a failed fit.
static bool fail_model(CagCall *call, size_t index) {
  char message[sizeof call->err->message];
  memcpy(message, call->err->message, sizeof message);
  snprintf(call->err->message, sizeof call->err->message, "models[%zu]: %.480s", index, message);
  strcpy(call->err->argument, "models");
  call->err->index = (long)index;
  return cag_fail_geometry(call, call->err);
}

bool cag_cameras_best_model(CagCall *call, const struct cag_cameras_best_model *a,
                            CagValue *result) {
  const CagPoints images = a->images;
  const size_t n = images.count;
  CagList *models;
  if (!cag_arg_list(call, 0, &models) || !check_images(call, 1, images, n)) return false;
  if (models->length == 0) return cag_fail_value(call, 0, "at least one model");
  CagVec3 *points = cag_hold_array(call, n, sizeof *points);
  double *scales = cag_hold_array(call, n, sizeof *scales);
  double *best_scales = cag_hold_array(call, n, sizeof *best_scales);
  CagModelFit fit, best = {.error = INFINITY};
  size_t index = 0;
  for (size_t i = 0; i < models->length; i++) {
    const CagPoints model = {points, n, 3};
    if (!read_model(call, cag_list_get(call->vm, models, i), i, &images, points)) return false;
    if (fit_model(a->kind == 1, &model, &images, &fit, scales, call->err))
      return fail_model(call, i);
    if (!cag_keep_going(call->vm)) return false;
    if (!(fit.error < best.error)) continue;
    best = fit;
    index = i;
    memcpy(best_scales, scales, n * sizeof *scales);
  }
  *result = fit_value(call->vm, &best, best_scales, n, (long)index);
  return true;
}

// --- Calibration ---

// The size of a picture that contains all pixels and whose middle is the principal point, if it can
// be.
static void usual_size(const CagPoints *pixels, const CagCameraParts *parts, double size[2]) {
  double most[2] = {1, 1};
  for (size_t i = 0; i < pixels->count; i++) {
    most[0] = fmax(most[0], ceil(pixels->items[i].x));
    most[1] = fmax(most[1], ceil(pixels->items[i].y));
  }
  for (int k = 0; k < 2; k++)
    size[k] = fmin(CAG_PICTURE_PIXELS_MAX, fmax(most[k], round(2 * parts->k[k][2])));
}

bool cag_cameras_calibrate(CagCall *call, const struct cag_cameras_calibrate *a, CagValue *result) {
  static const char *const names[] = {"P", "K", "rotation", "center", "error", "camera"};
  CagVm *vm = call->vm;
  CagCameraMap map;
  CagCameraParts parts;
  double size[2], rms;
  if (!check_images(call, 1, a->pixels, a->points.count) ||
      (cag_given(call, 2) && !cag_picture_size(call, 2, a->size, size)) ||
      !cag_geometry_ok(call, cag_calibrate(a->points.items, a->pixels.items, a->points.count, &map,
                                           &rms, call->err)))
    return false;
  cag_camera_split(&map, &parts);
  if (!cag_given(call, 2)) usual_size(&a->pixels, &parts, size);
  const CagVec3 center = cag_add(map.center, cag_vec3(0, 0, 0)); // never -0
  const CagValue values[] = {cag_rows_value(vm, map.p[0], 3, 4),
                             cag_rows_value(vm, parts.k[0], 3, 3),
                             cag_rows_value(vm, parts.r[0], 3, 3),
                             map.parallel ? cag_none() : cag_point(vm, center, 3),
                             cag_number(rms),
                             map.parallel ? cag_none()
                                          : cag_pinhole_value(vm, &parts, center, a->pitch, size)};
  *result = cag_record_new(vm, names, values, 6);
  return true;
}
