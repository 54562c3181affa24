// The nearest points of two shapes, with their parameters.

#include "geom/surface/nearest.h"
#include "interp/builtin/distances.h"
#include "interp/builtin/hulls.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/builtin/targets.h"

// The fields of the result.
typedef struct Fields {
  const char *names[9];
  CagValue values[9];
  size_t n;
} Fields;

// Parameters of the second shape have a 2 in their name if the first one has the same.
static void add_parameter(Fields *f, const char *name, const char *second, CagValue value) {
  bool taken = false;
  for (size_t i = 0; i < f->n; i++) taken = taken || f->names[i] == name;
  f->names[f->n] = taken ? second : name;
  f->values[f->n++] = value;
}

// The parameters of the point of a curve or surface. Others have none.
static bool add_parameters(CagCall *call, const CagShape *shape, CagValue v, CagVec3 p, Fields *f) {
  static const char *const names[] = {"t", "u", "v", "t2", "u2", "v2"};
  if (v.type == CAG_CURVE) {
    const CagCurve *c = shape->as.curve;
    double t;
    if (!cag_geometry_ok(call, cag_curve_closest(c, p, &t, NULL, NULL, call->err))) return false;
    add_parameter(f, names[0], names[3], cag_parameter_value(c->angular, t));
  }
  if (v.type == CAG_SURFACE) {
    const CagSurface *s = shape->as.surface;
    CagSurfaceNearest near;
    if (!cag_geometry_ok(call, cag_surface_closest(s, p, &near, call->err))) return false;
    add_parameter(f, names[1], names[4], cag_parameter_value(s->angular_u, near.u));
    add_parameter(f, names[2], names[5], cag_parameter_value(s->angular_v, near.v));
  }
  return true;
}

// Finds the shape of an argument to which the point belongs: its name and parameters.
static bool describe_end(CagCall *call, int argument, CagVec3 p, CagValue *part, int *dimension,
                         Fields *f) {
  const CagValue v = call->values[argument];
  const CagTarget *t;
  CagTargetNearest near;
  CagBounds box;
  *part = cag_none();
  if (!cag_is_shape(v) && !cag_is_list_of_shapes(call->vm, v))
    return cag_arg_vec(call, argument, &p, dimension);
  if (!cag_value_bounds(call, v, &box, dimension) || !cag_arg_near_target(call, argument, &t) ||
      !cag_target_closest(call, t, p, INFINITY, &near))
    return false;
  if (!near.found) return true;
  *part = cag_target_name(t, near.part);
  const CagValue shape =
      near.part < t->count ? t->parts[near.part].value : t->others[near.part - t->count];
  return add_parameters(call, CAG_AS_SHAPE(shape), shape, p, f);
}

bool cag_hulls_nearest(CagCall *call, CagValue *result) {
  Fields f = {.names = {"distance", "points", "parts"}, .n = 3};
  CagClosest closest;
  CagValue parts[2];
  int dimension[2];
  if (!cag_closest_of_arguments(call, true, &closest)) return false;
  for (int k = 0; k < 2; k++)
    if (!describe_end(call, k, closest.points[k], &parts[k], &dimension[k], &f)) return false;
  f.values[0] = cag_number(closest.distance);
  f.values[1] =
      cag_points_value(call->vm, closest.points, 2, dimension[0] == 2 && dimension[1] == 2 ? 2 : 3);
  f.values[2] = cag_list_values(call->vm, parts, 2);
  *result = cag_record_new(call->vm, f.names, f.values, f.n);
  return true;
}
