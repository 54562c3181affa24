// Transforms made of their own data: frames, turns, links, rows of numbers, pairs of points.

#include <string.h>

#include "interp/builtin/transforms.h"

bool cag_transform_result(CagCall *call, CagStatus status, CagTransform *made, bool planar,
                          CagValue *result) {
  if (!cag_geometry_ok(call, status)) return false;
  made->planar = planar;
  *result = cag_transform_value(call->vm, made);
  return true;
}

bool cag_transforms_reflect_line(CagCall *call, const struct cag_transforms_reflect_line *a,
                                 CagValue *result) {
  CagTransform t;
  return cag_transform_result(call, cag_reflect_line(a->P.at, a->Q.at, &t, call->err), &t,
                              a->P.dimension == 2 && a->Q.dimension == 2, result);
}

bool cag_transforms_reflect_point(CagCall *call, const struct cag_transforms_reflect_point *a,
                                  CagValue *result) {
  CagTransform t = cag_reflect_point(a->P.at);
  return cag_transform_result(call, CAG_OK, &t, a->P.dimension == 2, result);
}

// Rows of numbers, 2 to 4 of 2 to 4; *columns and *count tell the shape.
static bool read_rows(CagCall *call, double m[4][4], size_t *count, size_t *columns) {
  CagList *list;
  if (!cag_arg_list(call, 0, &list)) return false;
  *count = list->length;
  *columns = 0;
  for (size_t i = 0; i < list->length && i < 4; i++) {
    const double *x;
    size_t n;
    CagValue row = cag_list_get(call->vm, list, i);
    if (!cag_as_vector(row, &x, &n) || n < 2 || n > 4 || (i > 0 && n != *columns))
      return cag_fail_call(
          call, 0, CAG_ERR_type,
          "expects rows of the same length, 2 to 4 numbers; rows[%zu] is different", i);
    *columns = n;
    memcpy(m[i], x, n * sizeof *x);
  }
  return true;
}

bool cag_transforms_from_rows(CagCall *call, const struct cag_transforms_from_rows *a,
                              CagValue *result) {
  double m[4][4];
  size_t rows, columns;
  if (!read_rows(call, m, &rows, &columns)) return false;
  const bool linear = a->kind == 1, square = rows == columns && rows > 0;
  // Homogeneous in the plane: x, y and w; z stays as it is.
  const bool flat = square && rows == 3 && !linear;
  if (!(square || (rows == 3 && columns == 4)))
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects 2x2, 3x3, 3x4, or 4x4 numbers, found %zu rows of %zu", rows,
                         columns);
  CagTransform t = cag_transform_identity();
  static const size_t place[] = {0, 1, 3};
  for (size_t i = 0; i < rows; i++)
    for (size_t j = 0; j < columns; j++) t.m[flat ? place[i] : i][flat ? place[j] : j] = m[i][j];
  return cag_transform_result(call, CAG_OK, &t, flat || rows == 2, result);
}

bool cag_transforms_axes(CagCall *call, const struct cag_transforms_axes *a, CagValue *result) {
  CagTransform t;
  return cag_transform_result(call, cag_axes(a->origin.at, a->x.at, a->y.at, &t, call->err), &t,
                              false, result);
}

bool cag_transforms_look_at(CagCall *call, const struct cag_transforms_look_at *a,
                            CagValue *result) {
  CagTransform t;
  return cag_transform_result(call, cag_look_at(a->from.at, a->to.at, a->up.at, &t, call->err), &t,
                              false, result);
}

bool cag_transforms_euler(CagCall *call, const struct cag_transforms_euler *a, CagValue *result) {
  CagTransform t;
  return cag_transform_result(call, cag_euler(a->a, a->b, a->c, a->order, &t, call->err), &t, false,
                              result);
}

bool cag_transforms_rpy(CagCall *call, const struct cag_transforms_rpy *a, CagValue *result) {
  CagTransform t = cag_rpy(a->roll, a->pitch, a->yaw);
  return cag_transform_result(call, CAG_OK, &t, false, result);
}

bool cag_transforms_quaternion(CagCall *call, const struct cag_transforms_quaternion *a,
                               CagValue *result) {
  const double wxyz[] = {a->w, a->x, a->y, a->z};
  CagTransform t;
  return cag_transform_result(call, cag_quaternion(wxyz, &t, call->err), &t, false, result);
}

bool cag_transforms_axis_angle(CagCall *call, const struct cag_transforms_axis_angle *a,
                               CagValue *result) {
  CagTransform t;
  return cag_transform_result(call, cag_rotate(a->V.at, a->angle, cag_vec3(0, 0, 0), &t, call->err),
                              &t, false, result);
}

// Turn about Z by the first angle, then about the turned Y by the second, then a step along the
// turned axes; without `orient` only the position is kept.
static bool give_position(CagCall *call, double turn, double tilt, CagVec3 step, bool orient,
                          CagValue *result) {
  CagTransform place = cag_translate(step), tilted = cag_rpy(0, tilt, turn);
  CagTransform t = cag_transform_multiply(&tilted, &place);
  if (!orient) t = cag_translate(cag_vec3(t.m[0][3], t.m[1][3], t.m[2][3]));
  return cag_transform_result(call, CAG_OK, &t, false, result);
}

bool cag_transforms_cylindrical(CagCall *call, const struct cag_transforms_cylindrical *a,
                                CagValue *result) {
  return give_position(call, a->theta, 0, cag_vec3(a->r, 0, a->z), a->orient, result);
}

bool cag_transforms_spherical(CagCall *call, const struct cag_transforms_spherical *a,
                              CagValue *result) {
  return give_position(call, a->azimuth, a->polar, cag_vec3(0, 0, a->r), a->orient, result);
}

bool cag_transforms_dh(CagCall *call, const struct cag_transforms_dh *a, CagValue *result) {
  CagTransform t = cag_dh(a->theta, a->d, a->a, a->alpha);
  return cag_transform_result(call, CAG_OK, &t, false, result);
}

bool cag_transforms_mdh(CagCall *call, const struct cag_transforms_mdh *a, CagValue *result) {
  CagTransform t = cag_mdh(a->theta, a->d, a->a, a->alpha);
  return cag_transform_result(call, CAG_OK, &t, false, result);
}

bool cag_transforms_from_pairs(CagCall *call, const struct cag_transforms_from_pairs *a,
                               CagValue *result) {
  const size_t n = a->points.count;
  const bool planar = a->points.dimension == 2 && a->images.dimension == 2;
  CagTransform t;
  if (a->images.count != n)
    return cag_fail_call(call, 1, CAG_ERR_length,
                         "expects one image for each of %zu points, found %zu", n, a->images.count);
  return cag_transform_result(
      call, cag_transform_from(a->points.items, a->images.items, n, planar, &t, call->err), &t,
      planar, result);
}

// --- solve_frame ---

typedef struct Unknown {
  const char *name; // the frame that is not known; NULL: not met yet
  int side;
  size_t at;
} Unknown;

static bool read_side(CagCall *call, int side, const CagRecord *frames, Unknown *unknown) {
  CagList *names;
  if (!cag_arg_list(call, side, &names)) return false;
  call->values[side] = cag_object(CAG_LIST, names); // replaces an empty range with an empty list
  for (size_t i = 0; i < names->length; i++) {
    CagValue name = cag_list_get(call->vm, names, i);
    if (name.type != CAG_TEXT)
      return cag_fail_call(call, side, CAG_ERR_type, "expects names of frames, as texts");
    CagValue frame = cag_record_get_text(call->vm, frames, CAG_AS_TEXT(name));
    if (frame.type == CAG_TRANSFORM) continue;
    const char *bytes = CAG_AS_TEXT(name)->bytes;
    if (frame.type != CAG_UNSET)
      return cag_fail_call(call, 2, CAG_ERR_type, "expects a transform as the frame \"%s\"", bytes);
    if (unknown->name)
      return cag_fail_call(call, side, CAG_ERR_value,
                           "expects one unknown frame that occurs once, found \"%s\" and \"%s\"",
                           unknown->name, bytes);
    *unknown = (Unknown){bytes, side, i};
  }
  return true;
}

// Product of the frames of a side in [from, to), or up to its end.
static CagTransform product(CagCall *call, int side, size_t from, size_t to,
                            const CagRecord *frames) {
  const CagList *names = CAG_AS_LIST(call->values[side]);
  CagTransform t = cag_transform_identity();
  for (size_t i = from; i < to && i < names->length; i++) {
    CagValue name = cag_list_get(call->vm, names, i);
    CagValue frame = cag_record_get_text(call->vm, frames, CAG_AS_TEXT(name));
    t = cag_transform_multiply(&t, &CAG_AS_TRANSFORM(frame)->t);
  }
  return t;
}

bool cag_transforms_solve_frame(CagCall *call, const struct cag_transforms_solve_frame *a,
                                CagValue *result) {
  Unknown unknown = {0};
  if (!read_side(call, 0, a->frames, &unknown) || !read_side(call, 1, a->frames, &unknown))
    return false;
  if (!unknown.name)
    return cag_fail_call(call, 2, CAG_ERR_value, "expects all frames but one, found all frames");
  // before * X * after = other
  CagTransform before = product(call, unknown.side, 0, unknown.at, a->frames);
  CagTransform after = product(call, unknown.side, unknown.at + 1, SIZE_MAX, a->frames);
  CagTransform other = product(call, 1 - unknown.side, 0, SIZE_MAX, a->frames);
  CagTransform undo_before, undo_after;
  if (!cag_geometry_ok(call, cag_transform_inverse(&before, &undo_before, call->err)) ||
      !cag_geometry_ok(call, cag_transform_inverse(&after, &undo_after, call->err)))
    return false;
  CagTransform t = cag_transform_multiply(&undo_before, &other);
  t = cag_transform_multiply(&t, &undo_after);
  *result = cag_transform_value(call->vm, &t);
  return true;
}
