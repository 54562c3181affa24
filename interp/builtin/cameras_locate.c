// Positions from measurements: small motions, errors of poses, bearings, ranges, and seams.

#include <string.h>

#include "geom/camera/locate.h"
#include "interp/builtin/cameras.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"
#include "interp/builtin/transforms.h"
#include "interp/vm/vm.h"

static CagVec3 frame_column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static CagValue six_value(CagVm *vm, CagVec3 v, CagVec3 w) {
  const double x[] = {v.x + 0.0, v.y + 0.0, v.z + 0.0, w.x + 0.0, w.y + 0.0, w.z + 0.0}; // never -0
  return cag_vector(vm, x, 6);
}

// --- Transforms ---

bool cag_cameras_perspective(CagCall *call, const struct cag_cameras_perspective *a,
                             CagValue *result) {
  CagTransform t;
  return cag_transform_result(call, cag_perspective(a->f, a->keep_depth, &t, call->err), &t, false,
                              result);
}

// d' = R^T (r x p + d) and r' = R^T r (Paul 1981, section 4.3).
bool cag_cameras_move_twist(CagCall *call, const struct cag_cameras_move_twist *a,
                            CagValue *result) {
  CagTransform t;
  const double *x = a->D.items;
  if (a->D.count != 6)
    return cag_fail_call(
        call, 0, CAG_ERR_length,
        "expects 6 numbers, the translation [dx, dy, dz] and the rotation [rx, ry, "
        "rz] in radians, found %zu",
        a->D.count);
  if (!cag_arg_pose(call, 1, &t)) return false;
  const CagVec3 turn = cag_vec3(x[3], x[4], x[5]);
  const CagVec3 step = cag_add(cag_cross(turn, frame_column(&t, 3)), cag_vec3(x[0], x[1], x[2]));
  double d[3], r[3];
  for (int j = 0; j < 3; j++) {
    d[j] = cag_dot(frame_column(&t, j), step);
    r[j] = cag_dot(frame_column(&t, j), turn);
  }
  *result = six_value(call->vm, cag_vec3(d[0], d[1], d[2]), cag_vec3(r[0], r[1], r[2]));
  return true;
}

bool cag_cameras_pose_error(CagCall *call, const struct cag_cameras_pose_error *a,
                            CagValue *result) {
  static const char *const names[] = {"relative", "distance", "axis", "angle", "twist"};
  CagTransform nominal, actual, back;
  CagVec3 axis;
  double angle;
  bool singular;
  (void)a;
  if (!cag_arg_pose(call, 0, &nominal) || !cag_arg_pose(call, 1, &actual) ||
      !cag_geometry_ok(call, cag_transform_inverse(&nominal, &back, call->err)))
    return false;
  CagTransform relative = cag_transform_multiply(&back, &actual);
  if (!cag_geometry_ok(call, cag_axis_angle_of(&relative, &axis, &angle, &singular, call->err)))
    return false;
  const CagVec3 shift = frame_column(&relative, 3);
  if (!isfinite(cag_norm(shift)))
    return cag_fail_call(call, 1, CAG_ERR_not_finite, "overflows: the poses are too far apart");
  relative.planar = false;
  CagVm *vm = call->vm;
  const CagVec3 zero = {0, 0, 0}; // added to avoid -0
  const CagValue values[] = {cag_transform_value(vm, &relative), cag_number(cag_norm(shift)),
                             singular ? cag_none() : cag_point(vm, cag_add(axis, zero), 3),
                             cag_angle(cag_degrees_shown(angle)),
                             six_value(vm, shift, cag_scaled(axis, angle))};
  *result = cag_record_new(vm, names, values, 5);
  return true;
}

// --- Marks ---

static bool check_marks(CagCall *call, size_t marks, size_t found, const char *what) {
  return marks == found ||
         cag_fail_call(call, 1, CAG_ERR_length, "expects one %s for each of %zu marks, found %zu",
                       what, marks, found);
}

bool cag_cameras_locate_by_bearings(CagCall *call, const struct cag_cameras_locate_by_bearings *a,
                                    CagValue *result) {
  CagList *list;
  CagVec3 point;
  if (!cag_arg_list(call, 1, &list)) return false;
  if (a->marks.dimension != 2) return cag_fail_value(call, 0, "marks in the plane, [x, y],");
  if (!check_marks(call, a->marks.count, list->length, "bearing")) return false;
  double *bearings = cag_hold_array(call, list->length, sizeof *bearings);
  for (size_t i = 0; i < list->length; i++) {
    const CagValue v = cag_list_get(call->vm, list, i);
    if (v.type != CAG_ANGLE || !isfinite(v.as.number))
      return cag_fail_element(call, 1, i, v, "finite angles");
    bearings[i] = v.as.number * CAG_RADIANS_PER_DEGREE;
  }
  if (!cag_geometry_ok(call, cag_locate_by_bearings(a->marks.items, bearings, a->marks.count,
                                                    &point, call->err)))
    return false;
  *result = cag_point(call->vm, point, 2);
  return true;
}

bool cag_cameras_locate_by_ranges(CagCall *call, const struct cag_cameras_locate_by_ranges *a,
                                  CagValue *result) {
  CagVec3 point;
  if (!check_marks(call, a->marks.count, a->ranges.count, "range")) return false;
  for (size_t i = 0; i < a->ranges.count; i++)
    if (!(a->ranges.items[i] >= 0) || !isfinite(a->ranges.items[i]))
      return cag_fail_value(call, 1, "finite ranges of 0 or more");
  if (!cag_geometry_ok(call, cag_locate_by_ranges(a->marks.items, a->ranges.items, a->marks.count,
                                                  a->marks.dimension, &point, call->err)))
    return false;
  *result = cag_point(call->vm, point, a->marks.dimension);
  return true;
}

// --- Seams ---

// A sample [y, z], [y, none], or none.
static bool read_sample(CagCall *call, CagValue v, size_t index, CagProfileSample *out) {
  *out = (CagProfileSample){NAN, NAN};
  if (v.type == CAG_NONE) return true;
  const CagList *pair = v.type == CAG_LIST ? CAG_AS_LIST(v) : NULL;
  double *const fields[] = {&out->y, &out->z};
  for (size_t k = 0; pair && pair->length == 2 && k < 2; k++) {
    const CagValue x = cag_list_get(call->vm, pair, k);
    if (x.type == CAG_NUMBER && isfinite(x.as.number)) *fields[k] = x.as.number;
    else if (x.type != CAG_NONE || k == 0) pair = NULL;
  }
  return (pair && pair->length == 2) ||
         cag_fail_element(call, 0, index, v, "samples [y, z], [y, none], or none");
}

bool cag_cameras_seam(CagCall *call, const struct cag_cameras_seam *a, CagValue *result) {
  static const char *const names[] = {"at", "gap", "step"};
  const CagSeamKind kind = (CagSeamKind)a->kind;
  CagProfileSample *samples = cag_hold_array(call, a->profile->length, sizeof *samples);
  CagSeam seam;
  double last = -INFINITY;
  for (size_t i = 0; i < a->profile->length; i++) {
    const CagValue v = cag_list_get(call->vm, a->profile, i);
    if (!read_sample(call, v, i, &samples[i])) return false;
    if (samples[i].y < last)
      return cag_fail_call(call, 0, CAG_ERR_value,
                           "expects samples in order of y, found %g after %g at [%zu]",
                           samples[i].y, last, i);
    if (!isnan(samples[i].y)) last = samples[i].y;
  }
  if (!cag_geometry_ok(
          call, cag_find_seam(samples, a->profile->length, kind, a->limit, &seam, call->err)))
    return false;
  CagVm *vm = call->vm;
  const CagValue gap = cag_range_new(vm, seam.gap_least, seam.gap_most, 1, false, false, false);
  const CagValue values[] = {cag_vector(vm, (double[]){seam.y, seam.z}, 2),
                             kind == CAG_SEAM_BUTT ? gap : cag_none(),
                             kind == CAG_SEAM_LAP ? cag_number(seam.step) : cag_none()};
  *result = cag_record_new(vm, names, values, 3);
  return true;
}
