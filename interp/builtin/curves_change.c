// Curves made of other curves: backwards, in parts, joined, in another form.

#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/nurbs_ops.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/holds.h"

bool cag_curves_reverse(CagCall *call, const struct cag_curves_reverse *a, CagValue *result) {
  CagCurve *out = NULL;
  return cag_changed_curve_result(call, cag_curve_reverse(a->C, &out, call->err), &out, result);
}

bool cag_curves_trim(CagCall *call, const struct cag_curves_trim *a, CagValue *result) {
  CagCurve *out = NULL;
  double from, to;
  if (!cag_arg_parameter_range(call, 1, a->C->angular, &from, &to)) return false;
  CagStatus status = cag_curve_trim(a->C, from, to, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_curves_reparametrize(CagCall *call, const struct cag_curves_reparametrize *a,
                              CagValue *result) {
  CagCurve *out = NULL;
  double from, to;
  const bool angle = a->range.type == CAG_RANGE && CAG_AS_RANGE(a->range)->angle;
  if (!cag_arg_parameter_range(call, 1, angle, &from, &to)) return false;
  CagStatus status = cag_curve_reparametrize_as(a->C, from, to, angle, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// The parts, with what was said about the whole.
static CagValue parts_value(CagCall *call, const CagCurveList *parts) {
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < parts->count; i++) {
    CagValue part = cag_curve_value(call->vm, cag_curve_retain(parts->items[i]));
    cag_shape_say_alike(part, call->values[0]);
    cag_builder_add(call->vm, list, part);
  }
  return cag_builder_finish(call->vm, list);
}

bool cag_curves_split(CagCall *call, const struct cag_curves_split *a, CagValue *result) {
  double t;
  if (!cag_arg_at(call, a->C, &t)) return false;
  CagCurveList *halves = cag_hold_curve_list(call);
  halves->items = cag_give_held(call, cag_hold_array(call, 2, sizeof *halves->items));
  if (!cag_geometry_ok(call, cag_curve_halves(a->C, t, halves->items, call->err))) return false;
  halves->count = 2;
  *result = parts_value(call, halves);
  return true;
}

bool cag_curves_join_curves(CagCall *call, CagValue *result) {
  CagValue *items;
  size_t n;
  CagCurve *out = NULL;
  if (!cag_arg_several(call, &items, &n)) return false;
  if (n == 0) return cag_fail_call(call, 0, CAG_ERR_too_few_curves, "expects at least one curve");
  CagCurve **curves = cag_hold_array(call, n, sizeof *curves);
  for (size_t i = 0; i < n; i++) {
    if (items[i].type != CAG_CURVE)
      return cag_fail_call(call, items == call->values ? (int)i : 0, CAG_ERR_type,
                           "expects curves, found %s as number %zu", cag_type_article(items[i]), i);
    curves[i] = CAG_AS_SHAPE(items[i])->as.curve;
  }
  if (!cag_geometry_ok(call, cag_curve_join(curves, n, &out, call->err))) return false;
  *result = cag_curve_value(call->vm, out);
  cag_shape_say_alike(*result, items[0]);
  return true;
}

bool cag_curves_to_nurbs(CagCall *call, const struct cag_curves_to_nurbs *a, CagValue *result) {
  CagCurve *out = NULL;
  return cag_changed_curve_result(call, cag_curve_to_nurbs(a->C, &out, call->err), &out, result);
}

// No limit of the turn: only the distance counts.
#define ANY_TURN 3.14159265358979323846

bool cag_curves_polygonize(CagCall *call, const struct cag_curves_polygonize *a, CagValue *result) {
  CagCurve *out = NULL;
  double *t = NULL;
  size_t n;
  if (!cag_geometry_ok(call, cag_curve_discretize(a->C, a->tolerance, ANY_TURN, &t, &n, call->err)))
    return false;
  cag_hold(call, t);
  CagVec3 *points = cag_hold(call, cag_malloc(n * sizeof *points));
  CagStatus status = cag_curve_eval_many(a->C, t, n, 0, points, call->err);
  if (!status)
    status = cag_curve_polyline(points, a->C->closed ? n - 1 : n, a->C->closed, a->C->dimension,
                                &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// --- Another form of the same points ---

bool cag_bsplines_to_bezier(CagCall *call, const struct cag_bsplines_to_bezier *a,
                            CagValue *result) {
  CagCurveList *p = cag_hold_curve_list(call);
  CagStatus status = cag_curve_to_bezier(a->C, &p->items, &p->count, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  *result = parts_value(call, p);
  return true;
}

// Most times that a degree is raised or a knot inserted or taken away at once, as rows say.
#define TIMES_MAX 1000

bool cag_bsplines_elevate(CagCall *call, const struct cag_bsplines_elevate *a, CagValue *result) {
  CagCurve *out = NULL;
  CagStatus status = cag_curve_elevate(a->C, (int)a->times, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_reduce_degree(CagCall *call, const struct cag_bsplines_reduce_degree *a,
                                CagValue *result) {
  CagCurve *out = NULL;
  CagStatus status = cag_curve_reduce_degree(a->C, a->tolerance, &out, NULL, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_insert_knot(CagCall *call, const struct cag_bsplines_insert_knot *a,
                              CagValue *result) {
  CagCurve *out = NULL;
  double t, knots[TIMES_MAX];
  if (!cag_arg_at(call, a->C, &t)) return false;
  for (long i = 0; i < a->times; i++) knots[i] = t;
  CagStatus status = cag_curve_insert_knots(a->C, knots, (size_t)a->times, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// Part of the size of the curve within which a knot counts as one without effect.
#define WITHOUT_EFFECT 1e-9

// Where no tolerance is given, it is a part of the size.
static bool tolerance_of_size(CagCall *call, const CagCurve *c, double part, double *tolerance) {
  CagBounds box;
  if (cag_given(call, 2)) return true;
  if (!cag_geometry_ok(call, cag_curve_bounds(c, &box, call->err))) return false;
  *tolerance = part * cag_norm(cag_sub(box.max, box.min));
  return true;
}

bool cag_bsplines_remove_knot(CagCall *call, const struct cag_bsplines_remove_knot *a,
                              CagValue *result) {
  CagCurve *out = NULL;
  double t, tolerance = a->tolerance;
  if (!cag_arg_at(call, a->C, &t) || !tolerance_of_size(call, a->C, WITHOUT_EFFECT, &tolerance))
    return false;
  CagStatus status =
      cag_curve_remove_knot(a->C, t, (int)a->times, tolerance, &out, NULL, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_refine(CagCall *call, const struct cag_bsplines_refine *a, CagValue *result) {
  static const char *const ways[] = {"midpoints", NULL};
  CagCurve *out = NULL;
  CagNumbers knots;
  CagStatus status;
  int way;
  if (a->knots.type != CAG_UNSET && a->knots.type != CAG_TEXT) {
    if (!cag_arg_numbers(call, 1, &knots.items, &knots.count)) return false;
    status = cag_curve_insert_knots(a->C, knots.items, knots.count, &out, call->err);
  } else {
    if (!cag_arg_choice(call, 1, ways, &way)) return false;
    status = cag_curve_insert_midpoints(a->C, &out, call->err);
  }
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_clamp_ends(CagCall *call, const struct cag_bsplines_clamp_ends *a,
                             CagValue *result) {
  CagCurve *out = NULL;
  return cag_changed_curve_result(call, cag_curve_clamp(a->C, &out, call->err), &out, result);
}

// --- Curves near it ---

bool cag_bsplines_deviation(CagCall *call, const struct cag_bsplines_deviation *a,
                            CagValue *result) {
  double most;
  if (!cag_geometry_ok(call, cag_curve_deviation(a->C, a->D, &most, call->err))) return false;
  *result = cag_number(most);
  return true;
}

bool cag_bsplines_approximate(CagCall *call, const struct cag_bsplines_approximate *a,
                              CagValue *result) {
  CagCurve *out = NULL;
  CagStatus status = cag_curve_approximate(a->C, a->tolerance, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// How exact an offset is where nothing is said, as part of its curve's size.
#define OFFSET_TOLERANCE 1e-6

bool cag_bsplines_offset(CagCall *call, const struct cag_bsplines_offset *a, CagValue *result) {
  CagCurve *out = NULL;
  double tolerance = a->tolerance;
  if (!tolerance_of_size(call, a->C, OFFSET_TOLERANCE, &tolerance)) return false;
  if (!(tolerance > 0))
    return cag_fail_call(call, 2, CAG_ERR_value,
                         tolerance < 0 ? "expects a `tolerance` of at least 0"
                                       : "expects a positive `tolerance`");
  CagStatus status = cag_curve_offset(a->C, a->d, tolerance, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}
