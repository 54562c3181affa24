// Best motions, means of rotations, and twists.

#include "geom/linalg/rigid.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/support.h"
#include "interp/builtin/transforms.h"

bool cag_transforms_best_motion(CagCall *call, const struct cag_transforms_best_motion *a,
                                CagValue *result) {
  static const char *const names[] = {"T", "scale", "error", "deviation"};
  const CagPoints *p = &a->points, *q = &a->images;
  CagMotionFit fit;
  if (p->count != q->count)
    return cag_fail_core(call, CAG_E_ARGUMENT, CAG_ERR_point_count, "images", -1,
                         "expected as many images as points, found %zu points and %zu images",
                         p->count, q->count);
  const bool planar = p->dimension == 2 && q->dimension == 2;
  CagStatus status =
      cag_best_motion(p->items, q->items, p->count, planar, a->scale, &fit, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  CagValue values[] = {cag_transform_value(call->vm, &fit.transform), cag_number(fit.scale),
                       cag_number(fit.rms), cag_number(fit.largest)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_transforms_orthonormal(CagCall *call, const struct cag_transforms_orthonormal *a,
                                CagValue *result) {
  CagTransform out;
  CagStatus status = cag_orthonormal(&a->T, &out, call->err);
  return cag_transform_result(call, status, &out, a->T.planar, result);
}

bool cag_transforms_mean_rotation(CagCall *call, const struct cag_transforms_mean_rotation *a,
                                  CagValue *result) {
  (void)a;
  CagList *list;
  CagTransform out;
  if (!cag_arg_list(call, 0, &list)) return false;
  const size_t n = list->length;
  if (n == 0) return cag_fail_value(call, 0, "at least one transform");
  CagTransform *t = cag_hold_array(call, n, sizeof *t);
  for (size_t i = 0; i < n; i++) {
    const CagValue v = cag_list_get(call->vm, list, i);
    if (v.type != CAG_TRANSFORM) return cag_fail_element(call, 0, i, v, "transforms");
    t[i] = CAG_AS_TRANSFORM(v)->t;
  }
  CagStatus status = cag_mean_rotation(t, n, &out, call->err);
  return cag_transform_result(call, status, &out, !status && out.planar, result);
}

bool cag_transforms_twist_of(CagCall *call, const struct cag_transforms_twist_of *a,
                             CagValue *result) {
  double twist[6];
  if (!cag_geometry_ok(call, cag_twist_of(&a->T, twist, call->err))) return false;
  *result = cag_vector(call->vm, twist, 6);
  return true;
}

bool cag_transforms_motion_of(CagCall *call, const struct cag_transforms_motion_of *a,
                              CagValue *result) {
  CagTransform out;
  if (a->twist.count != 6)
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "expects the 6 numbers of a twist, found %zu numbers", a->twist.count);
  CagStatus status = cag_motion_of(a->twist.items, &out, call->err);
  return cag_transform_result(call, status, &out, false, result);
}
