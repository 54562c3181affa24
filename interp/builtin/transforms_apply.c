// `T * x`: the image of points, planes, shapes, cameras and lights, and of lists of these.

#include <string.h>

#include "interp/builtin/shapes.h"
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
      cag_vm_fail_at(call->vm, 0, CAG_ERR_not_finite, "the transform takes this point to infinity");
      return cag_fail_help(call->vm, "use `T * homogeneous(P)`, which keeps points at infinity");
    }
    out[0] = p.x;
    out[1] = p.y;
    if (out_dim == 3) out[2] = p.z;
  }
  return true;
}

static bool apply_list(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
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
                         "takes points of 2, 3 or 4 numbers, found vectors of %zu", dim);
  CagBuilder *b = cag_builder_new(call->vm);
  for (size_t i = 0; i < list->length; i++) {
    CagValue moved;
    if (!apply(call, t, cag_list_get(call->vm, list, i), &moved)) return false;
    if (!cag_builder_add(call->vm, b, moved)) return false;
  }
  *result = cag_builder_finish(call->vm, b);
  return true;
}

// Cameras and lights are moved by their points and directions; sizes follow a uniform scale.
static bool apply_scene(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  static const char *const points[] = {"eye", "target", "position"};
  static const char *const vectors[] = {"up", "direction"};
  static const char *const sizes[] = {"width", "focus", "aperture"};
  const CagSceneValue *old = CAG_AS_SCENE(v);
  size_t n = old->fields->layout->count;
  double scale = 1;
  CagVec3 images[3] = {{0, 0, 0}}; // of `points`
  bool is_flat = !cag_transform_is_affine(t);
  cag_transform_is_similarity(t, &scale);
  CagValue fields[32];
  if (n > 32) return cag_fail_call(call, 0, CAG_ERR_internal, "met too many fields");
  for (size_t i = 0; i < n; i++) {
    const char *name = old->fields->layout->names[i]->bytes;
    CagValue f = fields[i] = old->fields->fields[i];
    const double *x;
    size_t count;
    bool vector = f.type == CAG_LIST && cag_as_vector(f, &x, &count) && count >= 2;
    CagVec3 p = vector ? cag_vec3(x[0], x[1], count > 2 ? x[2] : 0) : cag_vec3(0, 0, 0);
    for (size_t k = 0; vector && k < sizeof points / sizeof *points; k++)
      if (!strcmp(name, points[k]))
        fields[i] = cag_point(call->vm, images[k] = cag_transform_point(t, p), 3);
    for (size_t k = 0; vector && k < sizeof vectors / sizeof *vectors; k++)
      if (!strcmp(name, vectors[k])) {
        const CagVec3 image = cag_transform_vector(t, p);
        is_flat |= cag_norm(image) == 0;
        fields[i] = cag_point(call->vm, image, 3);
      }
    for (size_t k = 0; f.type == CAG_NUMBER && k < sizeof sizes / sizeof *sizes; k++)
      if (!strcmp(name, sizes[k])) fields[i] = cag_number(f.as.number * scale);
  }
  // A camera needs a direction to look and one that is up.
  if (is_flat || (v.type == CAG_CAMERA && cag_norm(cag_sub(images[0], images[1])) == 0))
    return cag_fail_call(call, 0, CAG_ERR_operand, "takes no camera or light with a projection");
  CagValue record = cag_record_from_texts(call->vm, old->fields->layout->names, fields, n);
  *result = cag_scene_value(call->vm, v.type, old->kind, record);
  CAG_AS_SCENE(*result)->placement = cag_transform_identity();
  CAG_AS_SCENE(*result)->mirrored = old->mirrored != cag_transform_mirrors(t);
  return true;
}

static bool apply_region(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagTransform place = cag_transform_multiply(t, &shape->placement);
  if (t->planar && shape->placement.planar) {
    CagRegion *moved;
    return cag_region_result(
        call, cag_region_transform(shape->as.region, &place, &moved, call->err), &moved, result);
  }
  place.planar = false;
  *result = cag_region_value(call->vm, cag_region_retain(shape->as.region), &place);
  return true;
}

static bool apply_shape(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagError *err = call->err;
  CagCurve *curve;
  CagSurface *surface;
  CagSolid *solid;
  CagMesh *mesh;
  CagValue items;
  switch (v.type) {
  case CAG_CURVE:
    return cag_curve_result(call, cag_curve_transform(shape->as.curve, t, &curve, err), &curve,
                            result);
  case CAG_REGION: return apply_region(call, t, v, result);
  case CAG_SURFACE:
    return cag_surface_result(call, cag_surface_transform(shape->as.surface, t, &surface, err),
                              &surface, result);
  case CAG_SOLID:
    return cag_solid_result(call, cag_solid_transform(shape->as.solid, t, &solid, err), &solid,
                            result);
  case CAG_MESH:
    return cag_mesh_result(call, cag_mesh_transform(shape->as.mesh, t, &mesh, err), &mesh, result);
  default:
    if (!apply_list(call, t, cag_object(CAG_LIST, shape->as.items), &items)) return false;
    *result = cag_group_value(call->vm, items);
    return true;
  }
}

static bool apply(CagCall *call, const CagTransform *t, CagValue v, CagValue *result) {
  if (v.type == CAG_LIST) return apply_list(call, t, v, result);
  if (v.type == CAG_TRANSFORM) {
    CagTransform product = cag_transform_multiply(t, &CAG_AS_TRANSFORM(v)->t);
    *result = cag_transform_value(call->vm, &product);
    return true;
  }
  if (v.type == CAG_PLANE) {
    CagPlane moved;
    const CagPlane *plane = &CAG_AS_PLANE(v)->plane;
    if (!cag_geometry_ok(call, cag_plane_transform(plane, t, &moved, call->err))) return false;
    *result = cag_plane_value(call->vm, &moved);
    return true;
  }
  if (v.type == CAG_CAMERA || v.type == CAG_LIGHT) return apply_scene(call, t, v, result);
  if (cag_is_shape(v)) {
    if (!apply_shape(call, t, v, result)) return false;
    cag_shape_say_alike(*result, v);
    return true;
  }
  if (cag_holds_jet(v)) return cag_fail_differentiate(call, 0);
  CagString found = {0};
  cag_describe_value(call->vm, &found, v);
  cag_fail_call(call, 0, CAG_ERR_operand,
                "takes points, planes, shapes, cameras, lights and lists of these, found %s",
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
