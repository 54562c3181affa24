// What curves answer at one parameter, and their data.

#include "geom/basis/bernstein.h"
#include "interp/builtin/curves.h"

static bool give_point(CagCall *call, const CagCurve *c, double t, CagValue *result) {
  CagVec3 p;
  if (!cag_geometry_ok(call, cag_curve_point(c, t, &p, call->err))) return false;
  *result = cag_point(call->vm, p, c->dimension);
  return true;
}

bool cag_curves_at(CagCall *call, const struct cag_curves_at *a, CagValue *result) {
  const CagCurve *c = a->C;
  double t;
  return cag_arg_parameter(call, 1, c->angular, c->start, c->end, a->unit, &t) &&
         give_point(call, c, t, result);
}

bool cag_curves_derivative(CagCall *call, const struct cag_curves_derivative *a, CagValue *result) {
  const int order = (int)a->order;
  CagVec3 out[CAG_MAX_DERIVATIVE + 1];
  double t;
  if (!cag_arg_at(call, a->C, &t) ||
      !cag_geometry_ok(call, cag_curve_eval(a->C, t, order, (CagSide)a->side, out, call->err)))
    return false;
  *result = cag_point(call->vm, out[order], a->C->dimension);
  return true;
}

bool cag_curves_tangent(CagCall *call, const struct cag_curves_tangent *a, CagValue *result) {
  CagVec3 v;
  double t;
  if (!cag_arg_at(call, a->C, &t) ||
      !cag_geometry_ok(call, cag_curve_tangent(a->C, t, (CagSide)a->side, &v, call->err)))
    return false;
  *result = cag_point(call->vm, v, a->C->dimension);
  return true;
}

// The frame at the parameter; `bent`: it must have a normal.
static bool frame_at(CagCall *call, const CagCurve *c, bool bent, CagFrenet *out) {
  double t;
  if (!cag_arg_at(call, c, &t) || !cag_geometry_ok(call, cag_curve_frenet(c, t, out, call->err)))
    return false;
  return !bent || out->has_normal ||
         cag_fail_core(call, CAG_E_DEGENERATE, CAG_ERR_no_normal, "", -1,
                       "the curvature is 0 here, so there is neither normal nor binormal");
}

bool cag_curves_normal(CagCall *call, const struct cag_curves_normal *a, CagValue *result) {
  CagFrenet f;
  if (!frame_at(call, a->C, true, &f)) return false;
  *result = cag_point(call->vm, f.normal, a->C->dimension);
  return true;
}

bool cag_curves_binormal(CagCall *call, const struct cag_curves_binormal *a, CagValue *result) {
  CagFrenet f;
  if (!frame_at(call, a->C, true, &f)) return false;
  *result = cag_point(call->vm, f.binormal, 3);
  return true;
}

bool cag_curves_curvature(CagCall *call, const struct cag_curves_curvature *a, CagValue *result) {
  CagFrenet f;
  if (!frame_at(call, a->C, false, &f)) return false;
  *result = cag_number(f.curvature);
  return true;
}

bool cag_curves_torsion(CagCall *call, const struct cag_curves_torsion *a, CagValue *result) {
  CagFrenet f;
  if (!frame_at(call, a->C, true, &f)) return false;
  *result = cag_number(f.torsion);
  return true;
}

static CagValue plane_at(CagCall *call, CagVec3 point, CagVec3 normal, bool there) {
  CagPlane plane = {point, normal};
  return there ? cag_plane_value(call->vm, &plane) : cag_none();
}

bool cag_curves_frenet(CagCall *call, const struct cag_curves_frenet *a, CagValue *result) {
  static const char *const names[] = {
      "point",   "tangent",          "normal",       "binormal",        "curvature",
      "torsion", "osculating_plane", "normal_plane", "rectifying_plane"};
  const int dimension = a->C->dimension;
  CagFrenet f;
  if (!frame_at(call, a->C, false, &f)) return false;
  CagValue values[] = {cag_point(call->vm, f.point, dimension),
                       cag_point(call->vm, f.tangent, dimension),
                       f.has_normal ? cag_point(call->vm, f.normal, dimension) : cag_none(),
                       f.has_normal ? cag_point(call->vm, f.binormal, 3) : cag_none(),
                       cag_number(f.curvature),
                       f.has_normal ? cag_number(f.torsion) : cag_none(),
                       plane_at(call, f.point, f.binormal, f.has_normal),
                       plane_at(call, f.point, f.tangent, true),
                       plane_at(call, f.point, f.normal, f.has_normal)};
  *result = cag_record_new(call->vm, names, values, 9);
  return true;
}

// --- Domain and data ---

bool cag_curves_domain(CagCall *call, const struct cag_curves_domain *a, CagValue *result) {
  *result = cag_domain_value(call->vm, a->C->angular, a->C->start, a->C->end);
  return true;
}

bool cag_curves_start(CagCall *call, CagValue *result) {
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  *result = cag_parameter_value(c->angular, c->start);
  return true;
}

bool cag_curves_end(CagCall *call, CagValue *result) {
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  *result = cag_parameter_value(c->angular, c->end);
  return true;
}

bool cag_curves_start_point(CagCall *call, const struct cag_curves_start_point *a,
                            CagValue *result) {
  return give_point(call, a->C, a->C->start, result);
}

bool cag_curves_end_point(CagCall *call, const struct cag_curves_end_point *a, CagValue *result) {
  return give_point(call, a->C, a->C->end, result);
}

bool cag_fail_no_data(CagCall *call, const CagCurve *c, const char *what) {
  return cag_fail_core(
      call, CAG_E_UNSUPPORTED, CAG_ERR_no_control_points, "", -1,
      "a curve of kind %s has no %s; `to_nurbs` returns its rational form if there is one",
      c->kind->name, what);
}

bool cag_curves_degree(CagCall *call, const struct cag_curves_degree *a, CagValue *result) {
  CagNurbsView nurbs;
  const CagVec3 *points;
  size_t n;
  bool closed;
  if (cag_curve_nurbs_view(a->C, &nurbs)) *result = cag_number(nurbs.degree);
  else if (cag_curve_vertices(a->C, &points, &n, &closed)) *result = cag_number(1);
  else if (cag_curve_resting_view(a->C, NULL)) *result = cag_number(0);
  else return cag_fail_no_data(call, a->C, "degree");
  return true;
}

bool cag_curves_points(CagCall *call, const struct cag_curves_points *a, CagValue *result) {
  const CagCurve *c = a->C;
  CagNurbsView nurbs;
  const CagVec3 *points;
  CagVec3 rest;
  size_t n = 1;
  bool closed;
  const bool rests = cag_curve_resting_view(c, &rest);
  if (rests) points = &rest;
  if (rests || cag_curve_vertices(c, &points, &n, &closed)) {
    *result = cag_points_value(call->vm, points, n, c->dimension);
    return true;
  }
  if (!cag_curve_nurbs_view(c, &nurbs)) return cag_fail_no_data(call, c, "control points");
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < nurbs.distinct; i++) {
    const double *h = nurbs.homogeneous + 4 * i;
    // A point of weight 0 has no place.
    CagValue p = h[3] > 0 ? cag_point(call->vm, cag_project(h), c->dimension) : cag_none();
    if (!cag_builder_add(call->vm, list, p)) return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_curves_weights(CagCall *call, const struct cag_curves_weights *a, CagValue *result) {
  CagNurbsView nurbs;
  double *out;
  if (!cag_curve_nurbs_view(a->C, &nurbs)) return cag_fail_no_data(call, a->C, "weights");
  *result = cag_list_numbers(call->vm, nurbs.distinct, &out);
  for (size_t i = 0; i < nurbs.distinct; i++) out[i] = nurbs.homogeneous[4 * i + 3];
  return true;
}

bool cag_curves_knots(CagCall *call, const struct cag_curves_knots *a, CagValue *result) {
  CagNurbsView nurbs;
  if (!cag_curve_nurbs_view(a->C, &nurbs)) return cag_fail_no_data(call, a->C, "knots");
  *result = cag_numbers_value(call->vm, nurbs.knots, nurbs.count + (size_t)nurbs.degree + 1);
  return true;
}

bool cag_curves_is_closed(CagCall *call, CagValue *result) {
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  *result = cag_bool(c->closed);
  return true;
}

bool cag_curves_is_planar(CagCall *call, const struct cag_curves_is_planar *a, CagValue *result) {
  bool is;
  if (!cag_geometry_ok(call, cag_curve_is_planar(a->C, &is, NULL, call->err))) return false;
  *result = cag_bool(is);
  return true;
}

bool cag_curves_is_straight(CagCall *call, const struct cag_curves_is_straight *a,
                            CagValue *result) {
  bool is;
  if (!cag_geometry_ok(call, cag_curve_is_straight(a->C, &is, call->err))) return false;
  *result = cag_bool(is);
  return true;
}
