// `T * x`: the image of points, planes, shapes, cameras, and lights, and of lists of these.

#include <string.h>

#include "interp/builtin/assemblies.h"
#include "interp/builtin/types.h"
#include "interp/vm/jet.h"
#include "interp/vm/vm.h"

// Whether the mesh of a shape that only moves is worth keeping. Solids with a frame of their own
// tell by it that they only moved, and regions are meshed in their plane.
static bool keeps_mesh(CagValue v) {
  return v.type == CAG_CURVE || v.type == CAG_SURFACE || v.type == CAG_MESH ||
         (v.type == CAG_SOLID && !cag_solid_has_own_frame(CAG_AS_SHAPE(v)->as.solid));
}

static bool apply(CagCall *call, const CagTransform *t, CagValue v, CagValue *result);

// The factor that the image of a point is divided by.
static double point_divisor(const CagTransform *t, CagVec3 p) {
  return t->m[3][0] * p.x + t->m[3][1] * p.y + t->m[3][2] * p.z + t->m[3][3];
}

// A perspective has images of the points in front of its center only.
static bool fail_behind(CagCall *call) {
  cag_vm_fail_at(call->vm, 0, CAG_ERR_point_not_in_front,
                 "the point is not in front of the center of this perspective");
  return cag_fail_help(call->vm, "use `T * homogeneous(P)`, whose w is 0 or less for such points");
}

// Maps n vectors of 2, 3, or 4 numbers. Those of 2 stay in the plane if the transform is planar.
static bool apply_vectors(CagCall *call, const CagTransform *t, const double *x, size_t n,
                          size_t dim, size_t out_dim, double *out) {
  for (size_t i = 0; i < n; i++, x += dim, out += out_dim) {
    if (dim == 4) {
      cag_transform_homogeneous(t, x, out);
      continue;
    }
    CagVec3 p = cag_vec3(x[0], x[1], dim == 3 ? x[2] : 0);
    if (t->in_front && !(point_divisor(t, p) > 0)) return fail_behind(call);
    p = cag_transform_point(t, p);
    if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z)) {
      cag_vm_fail_at(call->vm, 0, CAG_ERR_not_finite, "the transform maps this point to infinity");
      return cag_fail_help(call->vm, "use `T * homogeneous(P)`, which keeps points at infinity");
    }
    out[0] = p.x;
    out[1] = p.y;
    if (out_dim == 3) out[2] = p.z;
  }
  return true;
}

bool cag_move_list(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  CagList *list = CAG_AS_LIST(v);
  if (!cag_may_go_deeper(call->vm, "moved")) return false;
  size_t dim = list->dim == 1 ? list->length : list->dim;
  if (list->length == 0) {
    *result = v;
    return true;
  }
  if (dim >= 2 && dim <= 4) {
    size_t out_dim = dim == 2 && !t->planar ? 3 : dim, n = list->dim == 1 ? 1 : list->length;
    double *out;
    *result = list->dim == 1 ? cag_list_numbers(call->vm, out_dim, &out)
                             : cag_list_vectors(call->vm, n, out_dim, &out);
    return apply_vectors(call, t, list->as.numbers, n, dim, out_dim, out);
  }
  if (dim != 0)
    return cag_fail_call(call, 0, CAG_ERR_operand,
                         "accepts points of 2, 3, or 4 numbers, found vectors of %zu", dim);
  CagBuilder *b = cag_builder_new(call->vm);
  for (size_t i = 0; i < list->length; i++) {
    CagValue moved;
    if (!apply(call, t, cag_list_get(call->vm, list, i), &moved)) return false;
    if (!cag_builder_add(call->vm, b, moved)) return false;
  }
  *result = cag_builder_finish(call->vm, b);
  return true;
}

// A shape is in front if the corners of its box are.
static bool check_in_front(CagCall *call, const CagTransform *t, CagValue v) {
  CagBounds box;
  int dimension;
  bool empty = v.type == CAG_LABEL;
  if (!empty && v.type != CAG_GROUP && !cag_value_is_empty(call, v, &empty)) return false;
  if (empty) return true;
  if (!cag_value_bounds(call, v, &box, &dimension)) return false;
  for (int k = 0; k < 8; k++) {
    const CagVec3 corner = cag_vec3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                                    k & 4 ? box.max.z : box.min.z);
    if (!(point_divisor(t, corner) > 0)) return fail_behind(call);
  }
  return true;
}

// What a shape has beside its geometry follows it. Frames that have no image are lost.
static void carry_along(CagVm *vm, CagValue moved, const CagShape *from, const CagTransform *t) {
  CagShape *to = CAG_AS_SHAPE(moved);
  to->model = from->model ? from->model : from->origin.definition;
  to->frames = from->frames ? cag_frames_moved(vm, from->frames, t) : NULL;
}

static bool apply(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  const CagValueType *type = cag_value_type(v);
  if (v.type == CAG_LIST) return cag_move_list(call, t, v, result);
  if (t->in_front && cag_is_shape(v) && !check_in_front(call, t, v)) return false;
  if (type->transform) {
    if (!type->transform(call, t, v, result)) return false;
    if (cag_is_shape(v)) carry_along(call->vm, *result, CAG_AS_SHAPE(v), t);
    if (cag_is_shape(v)) cag_shape_note_motion(call->vm, *result, v, t);
    if (keeps_mesh(v) && cag_transform_is_rigid(t)) cag_shape_moved(call->vm, *result, v, t);
    if (cag_is_shape(v) && CAG_AS_SHAPE(v)->limb && cag_transform_is_affine(t))
      cag_limb_moved(call->vm, *result, v, t);
    return true;
  }
  if (cag_holds_jet(v)) return cag_fail_differentiate(call, 0);
  CagString found = {0};
  cag_describe_value(call->vm, &found, v);
  cag_fail_call(call, 0, CAG_ERR_operand,
                "accepts points, planes, shapes, cameras, lights, and lists of these, found %s",
                found.bytes ? found.bytes : "");
  cag_string_free(&found);
  return false;
}

bool cag_transform_apply(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result) {
  // The operator is another name for the built-in `moved`.
  size_t rows;
  CagValue values[] = {v, cag_unset()};
  CagCall call = {vm, cag_builtin_rows(cag_builtin_find("moved"), &rows), values, 2,
                  &vm->core_error};
  return apply(&call, t, v, result);
}
