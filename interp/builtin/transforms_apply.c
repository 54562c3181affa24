// `T * x`: the image of points, planes, shapes, cameras and lights, and of lists of these.

#include <string.h>

#include "interp/builtin/shapes.h"
#include "interp/builtin/types.h"
#include "interp/vm/jet.h"
#include "interp/vm/vm.h"

static bool apply(CagCall *call, const CagTransform *t, CagValue v, CagValue *result);

// n vectors of 2, 3 or 4 numbers. Those of 2 stay plane under a planar transform.
static bool apply_vectors(CagCall *call, const CagTransform *t, const double *x, size_t n,
                          size_t dim, size_t out_dim, double *out) {
  for (size_t i = 0; i < n; i++, x += dim, out += out_dim) {
    if (dim == 4) {
      cag_transform_homogeneous(t, x, out);
      continue;
    }
    CagVec3 p = cag_transform_point(t, cag_vec3(x[0], x[1], dim == 3 ? x[2] : 0));
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

static bool apply(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  const CagValueType *type = cag_value_type(v);
  if (v.type == CAG_LIST) return cag_move_list(call, t, v, result);
  if (type->transform) return type->transform(call, t, v, result);
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
  // The operator is `moved` by another name.
  size_t rows;
  CagValue values[] = {v, cag_unset()};
  CagCall call = {vm, cag_builtin_rows(cag_builtin_find("moved"), &rows), values, 2,
                  &vm->core_error};
  return apply(&call, t, v, result);
}
