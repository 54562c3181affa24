// Intersections of surfaces with curves, planes, and surfaces, closest points, and feet.

#include "base/memory.h"
#include "geom/meet/meet_curve.h"
#include "geom/meet/meet_surface.h"
#include "geom/surface/feet.h"
#include "geom/surface/nearest.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/surfaces.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

bool cag_meetings_closest_shape(CagCall *call, const struct cag_meetings_closest_shape *a,
                                CagValue *result) {
  static const char *const names[] = {"point", "distance", "part"};
  const CagTarget *t;
  CagTargetNearest near;
  if (!cag_arg_near_target(call, 0, &t) || !cag_target_closest(call, t, a->P.at, INFINITY, &near))
    return false;
  if (!near.found)
    return cag_fail_call(call, 0, CAG_ERR_empty_shape, "expects a shape that is not empty");
  const CagValue values[] = {cag_point(call->vm, near.point, 3), cag_number(near.distance),
                             cag_target_name(t, near.part)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_meetings_closest(CagCall *call, const struct cag_meetings_closest *a, CagValue *result) {
  static const char *const names[] = {"u", "v", "point", "distance"};
  CagSurfaceNearest found;
  if (!cag_geometry_ok(call, cag_surface_closest(a->S, a->P.at, &found, call->err))) return false;
  CagValue values[] = {cag_parameter_value(a->S->angular_u, found.u),
                       cag_parameter_value(a->S->angular_v, found.v),
                       cag_point(call->vm, found.point, 3), cag_number(found.distance)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

bool cag_meetings_extrema(CagCall *call, const struct cag_meetings_extrema *a, CagValue *result) {
  static const char *const names[] = {"u", "v", "point", "distance", "kind"};
  CagFoot *feet;
  size_t n;
  if (!cag_geometry_ok(call, cag_surface_feet(a->S, a->P.at, &feet, &n, call->err))) return false;
  cag_hold_for(call, cag_free, feet);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    const CagValue values[] = {cag_parameter_value(a->S->angular_u, feet[i].at[0]),
                               cag_parameter_value(a->S->angular_v, feet[i].at[1]),
                               cag_point(call->vm, feet[i].point, 3), cag_number(feet[i].distance),
                               cag_foot_kind_value(call->vm, feet[i].kind)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 5))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

static bool with_curve(CagCall *call, const CagSurface *s, const CagCurve *c, CagValue *result) {
  static const char *const names[] = {"point", "u", "v", "t", "multiplicity"};
  CagSurfaceMeeting *found;
  size_t n;
  if (!cag_geometry_ok(call, cag_surface_intersect_curve(s, c, &found, &n, call->err)))
    return false;
  cag_hold_for(call, cag_free, found);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    CagValue values[] = {
        cag_point(call->vm, found[i].point, 3), cag_parameter_value(s->angular_u, found[i].u),
        cag_parameter_value(s->angular_v, found[i].v), cag_parameter_value(c->angular, found[i].t),
        cag_number(found[i].multiplicity)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 5))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_meetings_intersect(CagCall *call, const struct cag_meetings_intersect *a,
                            CagValue *result) {
  CagStatus status;
  const CagValue other = a->A;
  if (other.type == CAG_CURVE) return with_curve(call, a->S, CAG_AS_SHAPE(other)->as.curve, result);
  CagCurveList *list = cag_hold_curve_list(call);
  if (other.type == CAG_PLANE)
    status = cag_surface_section(a->S, &CAG_AS_PLANE(other)->plane, a->tolerance, list, call->err);
  else if (other.type == CAG_SURFACE)
    status = cag_surface_intersect(a->S, CAG_AS_SHAPE(other)->as.surface, a->tolerance,
                                   cag_vm_stop(call->vm), list, call->err);
  else return cag_fail_type(call, 1, "a curve, a surface, or a plane");
  if (!cag_geometry_ok(call, status)) return false;
  *result = cag_curve_list_value(call->vm, list);
  return true;
}
