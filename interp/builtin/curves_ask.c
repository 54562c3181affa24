// What curves answer at one parameter, and their data.

#include "geom/basis/bernstein.h"
#include "interp/builtin/curves.h"

// The curve of the first argument and the parameter of the second.
static bool read_at(CagCall *call, CagCurve **c, double *t) {
  return cag_arg_curve(call, 0, c) &&
         cag_arg_parameter(call, 1, (*c)->angular, (*c)->start, (*c)->end, false, t);
}

static bool read_side(CagCall *call, int argument, CagSide *out) {
  static const char *const sides[] = {"right", "left", NULL};
  int side;
  if (!cag_arg_choice(call, argument, sides, &side)) return false;
  *out = side == 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  return true;
}

bool cag_curves_at(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagVec3 p;
  double t;
  bool unit;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_bool_or(call, 2, false, &unit) ||
      !cag_arg_parameter(call, 1, c->angular, c->start, c->end, unit, &t) ||
      !cag_geometry_ok(call, cag_curve_point(c, t, &p, call->err)))
    return false;
  *result = cag_point(call->vm, p, c->dimension);
  return true;
}

bool cag_curves_derivative(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagVec3 out[CAG_MAX_DERIVATIVE + 1];
  double t;
  long order;
  CagSide side;
  if (!read_at(call, &c, &t) || !cag_arg_integer_or(call, 2, 1, 0, CAG_MAX_DERIVATIVE, &order) ||
      !read_side(call, 3, &side) ||
      !cag_geometry_ok(call, cag_curve_eval(c, t, (int)order, side, out, call->err)))
    return false;
  *result = cag_point(call->vm, out[order], c->dimension);
  return true;
}

bool cag_curves_tangent(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagVec3 v;
  double t;
  CagSide side;
  if (!read_at(call, &c, &t) || !read_side(call, 2, &side) ||
      !cag_geometry_ok(call, cag_curve_tangent(c, t, side, &v, call->err)))
    return false;
  *result = cag_point(call->vm, v, c->dimension);
  return true;
}

static bool read_frenet(CagCall *call, CagCurve **c, CagFrenet *frame) {
  double t;
  return read_at(call, c, &t) && cag_geometry_ok(call, cag_curve_frenet(*c, t, frame, call->err));
}

static bool fail_straight(CagCall *call) {
  cag_fail(call->err, CAG_E_DEGENERATE, CAG_ERR_no_normal, "", -1,
           "the curvature is 0 here, so there is neither normal nor binormal");
  return cag_fail_geometry(call, call->err);
}

bool cag_curves_normal(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagFrenet f;
  if (!read_frenet(call, &c, &f)) return false;
  if (!f.has_normal) return fail_straight(call);
  *result = cag_point(call->vm, f.normal, c->dimension);
  return true;
}

bool cag_curves_binormal(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagFrenet f;
  if (!read_frenet(call, &c, &f)) return false;
  if (!f.has_normal) return fail_straight(call);
  *result = cag_point(call->vm, f.binormal, 3);
  return true;
}

bool cag_curves_curvature(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagFrenet f;
  if (!read_frenet(call, &c, &f)) return false;
  *result = cag_number(f.curvature);
  return true;
}

bool cag_curves_torsion(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagFrenet f;
  if (!read_frenet(call, &c, &f)) return false;
  if (!f.has_normal) return fail_straight(call);
  *result = cag_number(f.torsion);
  return true;
}

static CagValue plane_at(CagCall *call, CagVec3 point, CagVec3 normal, bool there) {
  CagPlane plane = {point, normal};
  return there ? cag_plane_value(call->vm, &plane) : cag_none();
}

bool cag_curves_frenet(CagCall *call, CagValue *result) {
  static const char *const names[] = {
      "point",   "tangent",          "normal",       "binormal",        "curvature",
      "torsion", "osculating_plane", "normal_plane", "rectifying_plane"};
  CagCurve *c;
  CagFrenet f;
  if (!read_frenet(call, &c, &f)) return false;
  CagValue values[] = {cag_point(call->vm, f.point, c->dimension),
                       cag_point(call->vm, f.tangent, c->dimension),
                       f.has_normal ? cag_point(call->vm, f.normal, c->dimension) : cag_none(),
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

bool cag_curves_domain(CagCall *call, CagValue *result) {
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  *result = cag_domain_value(call->vm, c->angular, c->start, c->end);
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

static bool give_point(CagCall *call, const CagCurve *c, double t, CagValue *result) {
  CagVec3 p;
  if (!cag_geometry_ok(call, cag_curve_point(c, t, &p, call->err))) return false;
  *result = cag_point(call->vm, p, c->dimension);
  return true;
}

bool cag_curves_start_point(CagCall *call, CagValue *result) {
  CagCurve *c;
  return cag_arg_curve(call, 0, &c) && give_point(call, c, c->start, result);
}

bool cag_curves_end_point(CagCall *call, CagValue *result) {
  CagCurve *c;
  return cag_arg_curve(call, 0, &c) && give_point(call, c, c->end, result);
}

static bool fail_no_data(CagCall *call, const CagCurve *c, const char *what) {
  cag_fail(call->err, CAG_E_UNSUPPORTED, CAG_ERR_no_control_points, "", -1,
           "a curve of kind %s has no %s; `to_nurbs` gives its rational form where there is one",
           c->kind->name, what);
  return cag_fail_geometry(call, call->err);
}

bool cag_curves_degree(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagNurbsView nurbs;
  const CagVec3 *points;
  size_t n;
  bool closed;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (cag_curve_nurbs_view(c, &nurbs)) *result = cag_number(nurbs.degree);
  else if (cag_curve_vertices(c, &points, &n, &closed)) *result = cag_number(1);
  else if (cag_curve_resting_view(c, NULL)) *result = cag_number(0);
  else return fail_no_data(call, c, "degree");
  return true;
}

bool cag_curves_points(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagNurbsView nurbs;
  const CagVec3 *points;
  size_t n;
  bool closed;
  CagVec3 rest;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (cag_curve_vertices(c, &points, &n, &closed)) {
    *result = cag_points_value(call->vm, points, n, c->dimension);
    return true;
  }
  if (cag_curve_resting_view(c, &rest)) {
    *result = cag_points_value(call->vm, &rest, 1, c->dimension);
    return true;
  }
  if (!cag_curve_nurbs_view(c, &nurbs)) return fail_no_data(call, c, "control points");
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

bool cag_curves_weights(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagNurbsView nurbs;
  double *out;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (!cag_curve_nurbs_view(c, &nurbs)) return fail_no_data(call, c, "weights");
  *result = cag_list_numbers(call->vm, nurbs.distinct, &out);
  for (size_t i = 0; i < nurbs.distinct; i++) out[i] = nurbs.homogeneous[4 * i + 3];
  return true;
}

bool cag_curves_knots(CagCall *call, CagValue *result) {
  CagCurve *c;
  CagNurbsView nurbs;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (!cag_curve_nurbs_view(c, &nurbs)) return fail_no_data(call, c, "knots");
  *result = cag_numbers_value(call->vm, nurbs.knots, nurbs.count + (size_t)nurbs.degree + 1);
  return true;
}

bool cag_curves_is_closed(CagCall *call, CagValue *result) {
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  *result = cag_bool(c->closed);
  return true;
}

bool cag_curves_is_planar(CagCall *call, CagValue *result) {
  CagCurve *c;
  bool is;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (!cag_geometry_ok(call, cag_curve_is_planar(c, &is, NULL, call->err))) return false;
  *result = cag_bool(is);
  return true;
}

bool cag_curves_is_straight(CagCall *call, CagValue *result) {
  CagCurve *c;
  bool is;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (!cag_geometry_ok(call, cag_curve_is_straight(c, &is, call->err))) return false;
  *result = cag_bool(is);
  return true;
}
