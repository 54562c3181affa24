// Functions shared by the geometry built-ins: parameters that may be angles, points of the plane or
// space, results as records, and reading of shapes.

#include "interp/builtin/shapes.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geom/solid/csg.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// The conversion to radians rounds by at most half an ulp, so the decimal searched for is within
// one ulp of the stored double.
static bool same_angle(double degrees, double radians) {
  return fabs(degrees * CAG_RADIANS_PER_DEGREE - radians) <= DBL_EPSILON * fabs(radians);
}

double cag_degrees_shown(double radians) {
  double degrees = radians / CAG_RADIANS_PER_DEGREE;
  double whole = round(degrees);
  if (same_angle(whole, radians)) return whole;
  char text[40];
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, degrees);
    double shown = strtod(text, NULL);
    if (same_angle(shown, radians)) return shown;
  }
  return degrees;
}

CagValue cag_parameter_value(bool angular, double t) {
  return angular ? cag_angle(cag_degrees_shown(t)) : cag_number(t);
}

CagValue cag_domain_value(CagVm *vm, bool angular, double start, double end) {
  if (angular) {
    start = cag_degrees_shown(start);
    end = cag_degrees_shown(end);
  }
  return cag_range_new(vm, start, end, 1, angular, false, false);
}

bool cag_arg_parameter(CagCall *call, int argument, bool angular, double start, double end,
                       bool unit, double *out) {
  CagValue v = call->values[argument];
  if (unit) {
    double share;
    if (!cag_arg_finite(call, argument, &share)) return false;
    if (share < 0 || share > 1)
      return cag_fail_call(call, argument, CAG_ERR_value,
                           "expects a fraction in 0..1 with `unit: true`, found %.17g", share);
    *out = share == 1 ? end : start + share * (end - start);
    return true;
  }
  if (angular) {
    if (v.type != CAG_ANGLE) {
      cag_fail_type(call, argument, "an angle");
      if (v.type == CAG_NUMBER)
        cag_fail_help(call->vm,
                      "this parameter is an angle: write 30deg, or `unit: true` for 0..1");
      return false;
    }
    *out = v.as.number * CAG_RADIANS_PER_DEGREE;
    return true;
  }
  return cag_arg_finite(call, argument, out);
}

bool cag_arg_parameter_range(CagCall *call, int argument, bool angular, double *from, double *to) {
  bool angle;
  if (!cag_arg_interval(call, argument, from, to, &angle)) return false;
  if (angle != angular)
    return cag_fail_type(call, argument, angular ? "a range of angles" : "a range of numbers");
  if (angle) {
    *from *= CAG_RADIANS_PER_DEGREE;
    *to *= CAG_RADIANS_PER_DEGREE;
  }
  return true;
}

CagValue cag_numbers_value(CagVm *vm, const double *x, size_t n) {
  double *numbers;
  CagValue list = cag_list_numbers(vm, n, &numbers);
  if (n > 0) memcpy(numbers, x, n * sizeof *x);
  return list;
}

CagValue cag_points_value(CagVm *vm, const CagVec3 *points, size_t n, int dimension) {
  double *numbers;
  if (n == 0) return cag_list_values(vm, NULL, 0);
  CagValue list = cag_list_vectors(vm, n, (size_t)dimension, &numbers);
  for (size_t i = 0; i < n; i++) {
    *numbers++ = points[i].x;
    *numbers++ = points[i].y;
    if (dimension == 3) *numbers++ = points[i].z;
  }
  return list;
}

CagValue cag_bounds_value(CagVm *vm, const CagBounds *b, int dimension) {
  static const char *const names[] = {"min", "max", "size", "center"};
  CagValue values[] = {cag_point(vm, b->min, dimension), cag_point(vm, b->max, dimension),
                       cag_point(vm, cag_sub(b->max, b->min), dimension),
                       cag_point(vm, cag_lerp(b->min, b->max, 0.5), dimension)};
  return cag_record_new(vm, names, values, 4);
}

void cag_shape_say_alike(CagValue to, CagValue from) {
  CagShape *a = CAG_AS_SHAPE(to);
  const CagShape *b = CAG_AS_SHAPE(from);
  a->material = b->material;
  a->name = b->name;
  a->frames = b->frames;
  a->line = b->line;
  a->tolerance = b->tolerance;
  a->hidden = b->hidden;
  a->drawn = b->drawn;
  a->origin.last = b->origin.last;
}

bool cag_arg_several(CagCall *call, CagValue **items, size_t *n) {
  *items = call->values;
  *n = call->count;
  if (*n > 1 || call->values[0].type != CAG_LIST) return true;
  // The items of a list can be used directly unless it is packed, which lists of shapes never are.
  CagList *list = CAG_AS_LIST(call->values[0]);
  if (list->dim != 0) return cag_fail_type(call, 0, "shapes, or one list of them");
  *items = list->as.items;
  *n = list->length;
  return true;
}

// Applies the attributes of a group to a shape in it that does not have its own.
static CagValue inherit(CagVm *vm, CagValue item, const CagShape *group) {
  const CagShape *own = CAG_AS_SHAPE(item);
  CagRecord *material = cag_material_combine(vm, own->material, group->material);
  bool more = material != own->material || (!own->name && group->name) ||
              (!own->origin.definition && group->origin.definition) ||
              (own->tolerance == 0 && group->tolerance > 0) ||
              (!own->line.set && group->line.set) || (!own->hidden && group->hidden);
  if (!more) return item;
  CagValue copy = cag_shape_copy(vm, item);
  CagShape *s = CAG_AS_SHAPE(copy);
  s->material = material;
  if (!s->name) s->name = group->name;
  if (!s->origin.definition) s->origin.definition = group->origin.definition;
  if (!s->line.set) s->line = group->line;
  if (s->tolerance == 0) s->tolerance = group->tolerance;
  s->hidden = s->hidden || group->hidden;
  return copy;
}

bool cag_shapes_collect(CagCall *call, CagValue v, CagBuilder *into) {
  if (!cag_may_go_deeper(call->vm, "collected")) return false;
  if (v.type == CAG_LIST) {
    CagList *list = CAG_AS_LIST(v);
    for (size_t i = 0; i < list->length; i++)
      if (!cag_shapes_collect(call, cag_list_get(call->vm, list, i), into)) return false;
    return true;
  }
  if (v.type == CAG_GROUP) {
    const CagShape *group = CAG_AS_SHAPE(v);
    for (size_t i = 0; i < group->as.items->length; i++) {
      CagValue item = inherit(call->vm, cag_list_get(call->vm, group->as.items, i), group);
      if (!cag_shapes_collect(call, item, into)) return false;
    }
    return true;
  }
  if (v.type == CAG_ROBOT) {
    CagValue group;
    return cag_robot_at_home(call->vm, v, &group) && cag_shapes_collect(call, group, into);
  }
  if (!cag_is_shape(v)) {
    CagString *found = cag_held_string(call);
    cag_describe_value(call->vm, found, v);
    return cag_fail_call(call, -1, CAG_ERR_type, "expects shapes, or lists of shapes, found %s",
                         found->bytes);
  }
  return cag_builder_add(call->vm, into, v);
}

// --- Results ---

static CagValue region_in_plane(CagVm *vm, CagRegion *r) { return cag_region_value(vm, r, NULL); }
#define cag_region_value(vm, r) region_in_plane(vm, r)
#define X(Type, name)                                                                              \
  bool cag_##name##_result(CagCall *call, CagStatus status, Type **made, CagValue *result) {       \
    if (!cag_geometry_ok(call, status)) return false;                                              \
    *result = cag_##name##_value(call->vm, *made);                                                 \
    return true;                                                                                   \
  }                                                                                                \
  bool cag_changed_##name##_result(CagCall *call, CagStatus status, Type **made,                   \
                                   CagValue *result) {                                             \
    if (!cag_##name##_result(call, status, made, result)) return false;                            \
    cag_shape_say_alike(*result, call->values[0]);                                                 \
    return true;                                                                                   \
  }
CAG_SHAPE_RESULTS(X)
#undef X
#undef cag_region_value

// --- Reading ---

bool cag_arg_direction(CagCall *call, int argument, CagVec3 fallback, CagVec3 *out,
                       int *dimension) {
  if (!cag_arg_vec_or(call, argument, fallback, out, dimension)) return false;
  if (out->x == 0 && out->y == 0 && out->z == 0)
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects a direction, found the zero vector");
  return true;
}

bool cag_arg_plane(CagCall *call, int argument, CagPlane *out) {
  if (call->values[argument].type != CAG_PLANE) return cag_fail_type(call, argument, "a plane");
  *out = CAG_AS_PLANE(call->values[argument])->plane;
  return true;
}

bool cag_arg_region(CagCall *call, int argument, CagRegion **out, CagTransform *placement) {
  CagValue v = call->values[argument];
  *placement = cag_transform_identity();
  if (v.type == CAG_REGION) {
    *placement = CAG_AS_SHAPE(v)->placement[0];
    *out = cag_region_retain(CAG_AS_SHAPE(v)->as.region);
    return true;
  }
  if (v.type == CAG_CURVE)
    return cag_geometry_ok(call,
                           cag_region_new(CAG_AS_SHAPE(v)->as.curve, NULL, 0, out, call->err));
  if (v.type != CAG_LIST)
    return cag_fail_type(call, argument, "a region, a closed plane curve, or a list of points");
  CagVec3 *points;
  size_t n;
  int dimension;
  if (!cag_arg_points(call, argument, &points, &n, &dimension)) return false;
  cag_hold(call, points);
  CagCurve *outline = NULL;
  if (!cag_geometry_ok(call, cag_curve_polyline(points, n, true, dimension, &outline, call->err)))
    return false;
  cag_release_held(call, points);
  cag_hold_curve(call, outline);
  return cag_geometry_ok(call, cag_region_new(outline, NULL, 0, out, call->err));
}

static void bounds_join(CagBounds *into, const CagBounds *b) {
  if (b->min.x > b->max.x) return;
  cag_bounds_add(into, b->min);
  cag_bounds_add(into, b->max);
}

// The exact bounds of a placed region are those of its transformed boundary.
static CagStatus region_bounds(const CagShape *shape, CagBounds *out, int *dimension,
                               CagError *err) {
  const CagTransform *place = shape->placement;
  *dimension = place->planar ? 2 : 3;
  *out = CAG_BOUNDS_EMPTY;
  if (cag_region_is_empty(shape->as.region)) return cag_region_bounds(shape->as.region, out, err);
  for (size_t i = 0; i < shape->as.region->count; i++) {
    CagCurve *moved = NULL;
    CagBounds loop;
    CagStatus status = cag_curve_transform(shape->as.region->loops[i], place, &moved, err);
    if (!status) status = cag_curve_bounds(moved, &loop, err);
    cag_curve_release(moved);
    if (status) return status;
    bounds_join(out, &loop);
  }
  return CAG_OK;
}

// If the shape is empty, sets *empty; `err` explains why.
static CagStatus shape_bounds(CagValue v, CagBounds *out, int *dimension, bool *empty,
                              CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagStatus status = CAG_OK;
  *dimension = 3;
  switch (v.type) {
  case CAG_CURVE:
    *dimension = shape->as.curve->dimension;
    status = cag_curve_bounds(shape->as.curve, out, err);
    break;
  case CAG_REGION: status = region_bounds(shape, out, dimension, err); break;
  case CAG_SURFACE: status = cag_surface_bounds(shape->as.surface, out, err); break;
  case CAG_SOLID: status = cag_solid_bounds(shape->as.solid, out, err); break;
  case CAG_LABEL:
    *out = CAG_BOUNDS_EMPTY;
    cag_bounds_add(out, shape->as.label->at);
    break;
  default:
    *out = cag_mesh_bounds(shape->as.mesh);
    if (shape->as.mesh->triangle_count == 0)
      status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
                        "the mesh is empty: it has no triangles");
  }
  *empty = status && cag_is_empty_shape(err);
  return *empty ? CAG_OK : status;
}

bool cag_value_is_empty(CagCall *call, CagValue v, bool *out) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagStatus status = CAG_OK;
  *out = false;
  if (v.type == CAG_REGION) *out = cag_region_is_empty(shape->as.region);
  if (v.type == CAG_MESH) *out = shape->as.mesh->triangle_count == 0;
  if (v.type == CAG_SOLID) status = cag_solid_is_empty(shape->as.solid, out, call->err);
  return cag_geometry_ok(call, status);
}

bool cag_value_bounds(CagCall *call, CagValue v, CagBounds *out, int *dimension) {
  CagBuilder *shapes = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, v, shapes)) return false;
  CagValue list = cag_builder_finish(call->vm, shapes);
  *out = CAG_BOUNDS_EMPTY;
  *dimension = 2;
  size_t n = CAG_AS_LIST(list)->length;
  cag_fail(call->err, CAG_E_DEGENERATE, CAG_ERR_empty_shape, "", -1,
           "the group contains no shapes");
  bool all_empty = true;
  for (size_t i = 0; i < n; i++) {
    CagBounds one;
    bool empty;
    int d;
    if (i % CAG_LOOK_UP == 0 && !cag_keep_going(call->vm)) return false;
    const CagValue shape = cag_list_get(call->vm, CAG_AS_LIST(list), i);
    CagStatus status = shape_bounds(shape, &one, &d, &empty, call->err);
    if (status) return cag_geometry_ok(call, status);
    if (empty) continue;
    all_empty = false;
    bounds_join(out, &one);
    if (d == 3) *dimension = 3;
  }
  return !all_empty || cag_fail_geometry(call, call->err);
}
