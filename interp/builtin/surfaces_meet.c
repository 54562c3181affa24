// Where surfaces meet curves, planes and each other, and where they are nearest to a point.

#include "base/memory.h"
#include "geom/meet/meet_curve.h"
#include "geom/meet/meet_surface.h"
#include "geom/surface/nearest.h"
#include "interp/builtin/surfaces.h"
#include "interp/vm/vm.h"

static const char MEETINGS[] = "Surfaces: near and across";

static bool call_closest(CagCall *call, CagValue *result) {
  struct {
    CagSurface *s;
    CagPoint p;
  } a;
  static const char *const names[] = {"u", "v", "point", "distance"};
  CagError err;
  CagSurfaceNearest found;
  if (!cag_bind(call, &a, sizeof a) ||
      !cag_geometry_ok(call, cag_surface_closest(a.s, a.p.at, &found, &err), &err))
    return false;
  CagValue values[] = {cag_parameter_value(a.s->angular_u, found.u),
                       cag_parameter_value(a.s->angular_v, found.v),
                       cag_point(call->vm, found.point, 3), cag_number(found.distance)};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

static bool with_curve(CagCall *call, const CagSurface *s, const CagCurve *c, CagValue *result) {
  static const char *const names[] = {"point", "u", "v", "t", "multiplicity"};
  CagSurfaceMeeting *found;
  CagError err;
  size_t n;
  if (!cag_geometry_ok(call, cag_surface_intersect_curve(s, c, &found, &n, &err), &err))
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

static bool call_intersect(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagError err;
  CagStatus status;
  double tolerance = 0;
  const CagValue other = call->values[1];
  if (!cag_arg_surface(call, 0, &s)) return false;
  if (cag_given(call, 2) && call->values[2].type != CAG_NONE &&
      !cag_arg_positive(call, 2, &tolerance))
    return false;
  if (other.type == CAG_CURVE) return with_curve(call, s, CAG_AS_SHAPE(other)->as.curve, result);
  CagCurveList *list = cag_hold_curve_list(call);
  if (other.type == CAG_PLANE)
    status = cag_surface_section(s, &CAG_AS_PLANE(other)->plane, tolerance, list, &err);
  else if (other.type == CAG_SURFACE)
    status = cag_surface_intersect(s, CAG_AS_SHAPE(other)->as.surface, tolerance,
                                   cag_vm_stop(call->vm), list, &err);
  else return cag_fail_type(call, 1, "a curve, a surface or a plane");
  if (!cag_geometry_ok(call, status, &err)) return false;
  *result = cag_curve_list_value(call->vm, list);
  return true;
}

const CagBuiltin cag_builtins_meetings[] = {
    {"closest(S: surface, P: point)", call_closest, "record",
     "Returns the point of the surface nearest to P, with u, v, point, and distance (mm). If "
     "several points are equally near, returns one of them. The result is guaranteed by bounds "
     "for surfaces with an exact NURBS form, and for tubes, sweeps, and twisted extrusions of "
     "lines, arcs, helices, splines, and curves joined from them; for points outside of offsets "
     "and away from their ends as well. Other surfaces, such as formulas, are sampled as finely "
     "as they bend. For a guaranteed result, use `interpolate_surface(sample(S, nu, nv))`, a "
     "NURBS surface near S.",
     "c = closest(sphere_surface(2), [0, 5, 0])\n"
     "print near(c.point, [0, 2, 0]), near(c.distance, 3), c.u, c.v // expect: true true 90deg "
     "90deg",
     CAG_TAKES(SURFACE), MEETINGS},
    {"intersect(S: surface, A: curve or surface or plane, tolerance: length = none)",
     call_intersect, "list",
     "Returns the points in which the surface meets a curve: records of point, u, v, t of the "
     "curve, and multiplicity (2 where they touch), sorted by t. For another surface or a plane, "
     "returns the curves in which they cross or touch: lines and conics are exact, and others "
     "are cubics within the tolerance (none: a millionth of the size). Edges and creases of the "
     "surface that lie in a plane are included. Isolated points of contact are not. Very small "
     "loops that are close together may be missed. It is an error if the surfaces share a piece "
     "(overlap).",
     "c = intersect(sphere_surface(5), translate([0, 0, 3]) * bilinear([-9, -9], [-9, 9], [9, -9], "
     "[9, 9]))\n"
     "print len(c), near(length(c[0]), 8 * pi) // expect: 1 true\n"
     "m = intersect(sphere_surface(3), line([-9, 0, 0], [9, 0, 0]))\n"
     "print len(m), near(m[0].point, [-3, 0, 0]), near(m[0].t, 1/3) // expect: 2 true true\n"
     "touch = intersect(sphere_surface(2), elliptic_cylinder(2, 2, within: -5..5))\n"
     "print len(touch), near(length(touch[0]), 4 * pi) // expect: 1 true",
     CAG_TAKES(SURFACE), MEETINGS},
    {0}};
