// Intersections of curves with curves, surfaces, and planes, and feet of perpendiculars.

#include "base/memory.h"
#include "geom/curve/feet.h"
#include "geom/curve/intersect.h"
#include "geom/meet/meet_curve.h"
#include "interp/builtin/curves.h"

static bool with_curve(CagCall *call, const CagCurve *a, const CagCurve *b, CagBuilder *list) {
  static const char *const names[] = {"point", "t", "t2", "multiplicity"};
  CagMeeting *found;
  size_t n;
  if (!cag_geometry_ok(call, cag_curve_intersect(a, b, &found, &n, call->err))) return false;
  const int dimension = a->dimension == 2 && b->dimension == 2 ? 2 : 3;
  cag_hold_for(call, cag_free, found);
  for (size_t i = 0; i < n; i++) {
    CagValue values[] = {
        cag_point(call->vm, found[i].point, dimension), cag_parameter_value(a->angular, found[i].t),
        cag_parameter_value(b->angular, found[i].t2), cag_number(found[i].multiplicity)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 4))) return false;
  }
  return true;
}

static bool with_plane(CagCall *call, const CagCurve *c, const CagPlane *plane, CagBuilder *list) {
  static const char *const names[] = {"point", "t", "multiplicity"};
  CagMeeting *found;
  size_t n;
  if (!cag_geometry_ok(call, cag_curve_intersect_plane(c, plane, &found, &n, call->err)))
    return false;
  cag_hold_for(call, cag_free, found);
  for (size_t i = 0; i < n; i++) {
    CagValue values[] = {cag_point(call->vm, found[i].point, c->dimension),
                         cag_parameter_value(c->angular, found[i].t),
                         cag_number(found[i].multiplicity)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 3))) return false;
  }
  return true;
}

static bool with_surface(CagCall *call, const CagCurve *c, const CagSurface *s, CagBuilder *list) {
  static const char *const names[] = {"point", "t", "u", "v", "multiplicity"};
  CagSurfaceMeeting *found;
  size_t n;
  if (!cag_geometry_ok(call, cag_surface_intersect_curve(s, c, &found, &n, call->err)))
    return false;
  cag_hold_for(call, cag_free, found);
  for (size_t i = 0; i < n; i++) {
    CagValue values[] = {
        cag_point(call->vm, found[i].point, 3), cag_parameter_value(c->angular, found[i].t),
        cag_parameter_value(s->angular_u, found[i].u),
        cag_parameter_value(s->angular_v, found[i].v), cag_number(found[i].multiplicity)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 5))) return false;
  }
  return true;
}

bool cag_bsplines_intersect(CagCall *call, const struct cag_bsplines_intersect *a,
                            CagValue *result) {
  CagBuilder *list = cag_builder_new(call->vm);
  bool ok;
  if (a->A.type == CAG_CURVE) ok = with_curve(call, a->C, CAG_AS_SHAPE(a->A)->as.curve, list);
  else if (a->A.type == CAG_PLANE) ok = with_plane(call, a->C, &CAG_AS_PLANE(a->A)->plane, list);
  else if (a->A.type == CAG_SURFACE)
    ok = with_surface(call, a->C, CAG_AS_SHAPE(a->A)->as.surface, list);
  else return cag_fail_type(call, 1, "a curve, a surface, or a plane");
  if (ok) *result = cag_builder_finish(call->vm, list);
  return ok;
}

CagValue cag_foot_kind_value(CagVm *vm, CagFootKind kind) {
  static const char *const names[] = {"minimum", "maximum", "saddle", "inflection"};
  return cag_text_c(vm, names[kind]);
}

bool cag_curves_extrema(CagCall *call, const struct cag_curves_extrema *a, CagValue *result) {
  static const char *const names[] = {"t", "point", "distance", "kind"};
  CagFoot *feet;
  size_t n;
  const int dimension = a->C->dimension == 2 ? 2 : 3;
  if (!cag_geometry_ok(call, cag_curve_feet(a->C, a->P.at, &feet, &n, call->err))) return false;
  cag_hold_for(call, cag_free, feet);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < n; i++) {
    const CagValue values[] = {cag_parameter_value(a->C->angular, feet[i].at[0]),
                               cag_point(call->vm, feet[i].point, dimension),
                               cag_number(feet[i].distance),
                               cag_foot_kind_value(call->vm, feet[i].kind)};
    if (!cag_builder_add(call->vm, list, cag_record_new(call->vm, names, values, 4))) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}
