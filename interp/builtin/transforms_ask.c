// Questions to transforms: inverses, angles, classes, and homogeneous coordinates.

#include <string.h>

#include "interp/builtin/transforms.h"

bool cag_transforms_inverse(CagCall *call, const struct cag_transforms_inverse *a,
                            CagValue *result) {
  CagTransform out;
  return cag_transform_result(call, cag_transform_inverse(&a->T, &out, call->err), &out,
                              a->T.planar, result);
}

bool cag_transforms_determinant(CagCall *call, const struct cag_transforms_determinant *a,
                                CagValue *result) {
  (void)call;
  *result = cag_number(cag_transform_determinant(&a->T));
  return true;
}

bool cag_transforms_transpose(CagCall *call, const struct cag_transforms_transpose *a,
                              CagValue *result) {
  CagTransform out;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) out.m[i][j] = a->T.m[j][i];
  return cag_transform_result(call, CAG_OK, &out, a->T.planar, result);
}

bool cag_transforms_position(CagCall *call, const struct cag_transforms_position *a,
                             CagValue *result) {
  const CagVec3 origin = cag_vec3(a->T.m[0][3], a->T.m[1][3], a->T.m[2][3]);
  *result = cag_point(call->vm, origin, a->T.planar ? 2 : 3);
  return true;
}

bool cag_transforms_rotation(CagCall *call, const struct cag_transforms_rotation *a,
                             CagValue *result) {
  CagTransform t = a->T;
  for (int i = 0; i < 3; i++) t.m[i][3] = 0;
  *result = cag_transform_value(call->vm, &t);
  return true;
}

static CagValue shown_angle(double radians) { return cag_angle(cag_degrees_shown(radians)); }

static bool angles_result(CagCall *call, CagStatus status, const char *const *names,
                          const double *angles, const bool *singular, CagValue *result) {
  if (!cag_geometry_ok(call, status)) return false;
  CagValue values[] = {shown_angle(angles[0]), shown_angle(angles[1]), shown_angle(angles[2]),
                       cag_bool(*singular)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_transforms_euler_of(CagCall *call, const struct cag_transforms_euler_of *a,
                             CagValue *result) {
  static const char *const names[] = {"a", "b", "c", "singular"};
  double angles[3];
  bool singular;
  return angles_result(call, cag_euler_of(&a->T, a->order, angles, &singular, call->err), names,
                       angles, &singular, result);
}

bool cag_transforms_rpy_of(CagCall *call, const struct cag_transforms_rpy_of *a, CagValue *result) {
  static const char *const names[] = {"roll", "pitch", "yaw", "singular"};
  double angles[3];
  bool singular;
  return angles_result(call, cag_rpy_of(&a->T, angles, &singular, call->err), names, angles,
                       &singular, result);
}

bool cag_transforms_axis_angle_of(CagCall *call, const struct cag_transforms_axis_angle_of *a,
                                  CagValue *result) {
  static const char *const names[] = {"axis", "angle", "singular"};
  CagVec3 axis;
  double angle;
  bool singular;
  if (!cag_geometry_ok(call, cag_axis_angle_of(&a->T, &axis, &angle, &singular, call->err)))
    return false;
  CagValue values[] = {cag_point(call->vm, axis, 3), shown_angle(angle), cag_bool(singular)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_transforms_quaternion_of(CagCall *call, const struct cag_transforms_quaternion_of *a,
                                  CagValue *result) {
  double wxyz[4];
  if (!cag_geometry_ok(call, cag_quaternion_of(&a->T, wxyz, call->err))) return false;
  *result = cag_vector(call->vm, wxyz, 4);
  return true;
}

bool cag_transforms_classify(CagCall *call, const struct cag_transforms_classify *a,
                             CagValue *result) {
  static const char *const names[] = {"class", "scale",       "axis",           "angle",
                                      "fixed", "fixed_point", "fixed_direction"};
  CagTransformClass c;
  if (!cag_geometry_ok(call, cag_transform_classify(&a->T, &c, call->err))) return false;
  bool has_point = strcmp(c.fixed, "none") != 0 && strcmp(c.fixed, "all") != 0;
  bool has_direction = !strcmp(c.fixed, "line") || !strcmp(c.fixed, "plane");
  CagValue values[] = {
      cag_text_c(call->vm, c.name),
      cag_number(c.scale),
      c.has_rotation ? cag_point(call->vm, c.axis, 3) : cag_none(),
      c.has_rotation ? shown_angle(c.angle) : cag_none(),
      cag_text_c(call->vm, c.fixed),
      has_point ? cag_point(call->vm, c.fixed_point, 3) : cag_none(),
      has_direction ? cag_point(call->vm, c.fixed_direction, 3) : cag_none(),
  };
  *result = cag_record_new(call->vm, names, values, 7);
  return true;
}

bool cag_transforms_homogeneous(CagCall *call, const struct cag_transforms_homogeneous *a,
                                CagValue *result) {
  // A point at infinity keeps its direction; any other is scaled, so that dividing gives it back.
  double scale = a->w == 0 ? 1 : a->w;
  double h[] = {scale * a->P.at.x, scale * a->P.at.y, scale * a->P.at.z, a->w};
  for (int i = 0; i < 4; i++)
    if (!isfinite(h[i])) return cag_fail_call(call, 1, CAG_ERR_not_finite, "overflows");
  *result = cag_vector(call->vm, h, 4);
  return true;
}

bool cag_transforms_dehomogenize(CagCall *call, const struct cag_transforms_dehomogenize *a,
                                 CagValue *result) {
  const double *h = a->h.items;
  const size_t n = a->h.count;
  if (n != 3 && n != 4)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects [x, y, w] or [x, y, z, w], found %zu numbers", n);
  bool zero = true;
  for (size_t i = 0; i < n; i++) zero = zero && h[i] == 0;
  if (zero)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects homogeneous coordinates that are not all 0");
  const double w = h[n - 1] == 0 ? 1 : h[n - 1];
  const CagVec3 p = cag_vec3(h[0] / w, h[1] / w, n == 4 ? h[2] / w : 0);
  if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
    return cag_fail_call(call, 0, CAG_ERR_not_finite, "overflows");
  *result = cag_point(call->vm, p, n == 4 ? 3 : 2);
  return true;
}

bool cag_transforms_mix(CagCall *call, const struct cag_transforms_mix *a, CagValue *result) {
  CagTransform out;
  return cag_transform_result(call, cag_transform_mix(&a->A, &a->B, a->t, &out, call->err), &out,
                              a->A.planar && a->B.planar, result);
}
