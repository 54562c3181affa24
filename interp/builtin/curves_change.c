// Curves made of other curves: backwards, in parts, joined, in another form.

#include <stdlib.h>

#include "interp/builtin/curves.h"

// The new curve, with what was said about the old one.
// `made` is read after the call that fills it: pass its address.
static bool give(CagCall *call, CagStatus status, const CagError *err, CagCurve **made,
                 CagValue *result) {
  if (!cag_geometry_ok(call, status, err)) return false;
  *result = cag_curve_value(call->vm, *made);
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}

bool cag_curves_reverse(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  CagError err;
  if (!cag_arg_curve(call, 0, &c)) return false;
  return give(call, cag_curve_reverse(c, &out, &err), &err, &out, result);
}

bool cag_curves_trim(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  CagError err;
  double from, to;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_parameter_range(call, 1, c->angular, &from, &to))
    return false;
  CagStatus status = cag_curve_trim(c, from, to, &out, &err);
  return give(call, status, &err, &out, result);
}

bool cag_curves_reparametrize(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  CagError err;
  double from, to;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_parameter_range(call, 1, c->angular, &from, &to))
    return false;
  CagStatus status = cag_curve_reparametrize(c, from, to, &out, &err);
  return give(call, status, &err, &out, result);
}

bool cag_curves_split(CagCall *call, CagValue *result) {
  CagCurve *c, *first = NULL, *second = NULL;
  CagError err;
  CagValue parts[2];
  double t;
  if (!cag_arg_curve(call, 0, &c) ||
      !cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, &t))
    return false;
  CagStatus status = cag_curve_trim(c, c->start, t, &first, &err);
  if (!give(call, status, &err, &first, &parts[0])) return false;
  status = cag_curve_trim(c, t, c->end, &second, &err);
  if (!give(call, status, &err, &second, &parts[1])) return false;
  *result = cag_list_values(call->vm, parts, 2);
  return true;
}

bool cag_curves_join_curves(CagCall *call, CagValue *result) {
  CagValue *items;
  size_t n;
  CagCurve *out = NULL;
  CagError err;
  if (!cag_arg_several(call, 0, &items, &n)) return false;
  if (n == 0) return cag_fail_call(call, 0, CAG_ERR_value, "expects at least one curve");
  CagCurve **curves = malloc(n * sizeof *curves);
  bool ok = curves != NULL;
  if (!ok) cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory than there is");
  for (size_t i = 0; ok && i < n; i++) {
    ok = items[i].type == CAG_CURVE;
    if (ok) curves[i] = CAG_AS_SHAPE(items[i])->as.curve;
    else
      cag_fail_call(call, items == call->values ? (int)i : 0, CAG_ERR_type,
                    "expects curves, found %s as number %zu", cag_type_article(items[i]), i);
  }
  ok = ok && cag_geometry_ok(call, cag_curve_join(curves, n, &out, &err), &err);
  free(curves);
  if (!ok) return false;
  *result = cag_curve_value(call->vm, out);
  cag_shape_say_alike(*result, items[0]);
  return true;
}

bool cag_curves_to_nurbs(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  CagError err;
  if (!cag_arg_curve(call, 0, &c)) return false;
  return give(call, cag_curve_to_nurbs(c, &out, &err), &err, &out, result);
}

// No limit of the turn: only the distance counts.
#define ANY_TURN 3.14159265358979323846

bool cag_curves_polygonize(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  CagError err;
  double tolerance, *t = NULL;
  size_t n;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_positive(call, 1, &tolerance) ||
      !cag_geometry_ok(call, cag_curve_discretize(c, tolerance, ANY_TURN, &t, &n, &err), &err))
    return false;
  CagVec3 *points = malloc(n * sizeof *points);
  CagStatus status = points ? cag_curve_eval_many(c, t, n, 0, points, &err) : cag_fail_memory(&err);
  if (status == CAG_OK)
    status = cag_curve_polyline(points, c->closed ? n - 1 : n, c->closed, c->dimension, &out, &err);
  free(points);
  free(t);
  return give(call, status, &err, &out, result);
}
