// Curves made of other curves: backwards, in parts, joined, in another form.

#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/nurbs_ops.h"
#include "interp/builtin/curves.h"

bool cag_curves_reverse(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  if (!cag_arg_curve(call, 0, &c)) return false;
  return cag_changed_curve_result(call, cag_curve_reverse(c, &out, call->err), &out, result);
}

bool cag_curves_trim(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  double from, to;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_parameter_range(call, 1, c->angular, &from, &to))
    return false;
  CagStatus status = cag_curve_trim(c, from, to, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_curves_reparametrize(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  double from, to;
  bool angle;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_interval(call, 1, &from, &to, &angle)) return false;
  if (angle) {
    from *= CAG_RADIANS_PER_DEGREE;
    to *= CAG_RADIANS_PER_DEGREE;
  }
  CagStatus status = cag_curve_reparametrize_as(c, from, to, angle, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// Parts of a curve, held.
typedef struct Pieces {
  CagCurve **curves;
  size_t n;
} Pieces;

static void free_pieces(void *what) {
  Pieces *p = what;
  for (size_t i = 0; i < p->n; i++) cag_curve_release(p->curves[i]);
  cag_free(p->curves);
  cag_free(p);
}

static Pieces *pieces_new(CagCall *call) {
  Pieces *p = cag_hold_array(call, 1, sizeof *p);
  cag_hold_for(call, free_pieces, cag_give_held(call, p));
  return p;
}

// The parts, with what was said about the whole.
static CagValue pieces_value(CagCall *call, const Pieces *p) {
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < p->n; i++) {
    CagValue piece = cag_curve_value(call->vm, cag_curve_retain(p->curves[i]));
    cag_shape_say_alike(piece, call->values[0]);
    cag_builder_add(call->vm, list, piece);
  }
  return cag_builder_finish(call->vm, list);
}

bool cag_curves_split(CagCall *call, CagValue *result) {
  CagCurve *c;
  double t;
  if (!cag_arg_curve(call, 0, &c) ||
      !cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, &t))
    return false;
  Pieces *halves = pieces_new(call);
  halves->curves = cag_malloc(2 * sizeof *halves->curves);
  CagStatus status = halves->curves ? cag_curve_halves(c, t, halves->curves, call->err)
                                    : cag_fail_memory(call->err);
  if (!cag_geometry_ok(call, status)) return false;
  halves->n = 2;
  *result = pieces_value(call, halves);
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

bool cag_curves_to_nurbs(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  if (!cag_arg_curve(call, 0, &c)) return false;
  return cag_changed_curve_result(call, cag_curve_to_nurbs(c, &out, call->err), &out, result);
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
  if (status == CAG_OK)
    status = cag_curve_polyline(points, a->C->closed ? n - 1 : n, a->C->closed, a->C->dimension,
                                &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// --- Another form of the same points ---

bool cag_bsplines_to_bezier(CagCall *call, CagValue *result) {
  CagCurve *c;
  if (!cag_arg_curve(call, 0, &c)) return false;
  Pieces *p = pieces_new(call);
  if (!cag_geometry_ok(call, cag_curve_to_bezier(c, &p->curves, &p->n, call->err))) return false;
  *result = pieces_value(call, p);
  return true;
}

// Most times that a degree is raised or a knot inserted or taken away at once.
#define TIMES_MAX 1000

bool cag_bsplines_elevate(CagCall *call, const struct cag_bsplines_elevate *a, CagValue *result) {
  CagCurve *out = NULL;
  CagStatus status = cag_curve_elevate(a->C, (int)a->times, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// A tolerance in mm, positive or inf.
static bool read_tolerance(CagCall *call, int argument, double *out) {
  if (!cag_arg_number(call, argument, out)) return false;
  return *out >= 0 ||
         cag_fail_call(call, argument, CAG_ERR_value, "expects a `tolerance` of 0 or more");
}

bool cag_bsplines_reduce_degree(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  double tolerance;
  if (!cag_arg_curve(call, 0, &c) || !read_tolerance(call, 1, &tolerance)) return false;
  CagStatus status = cag_curve_reduce_degree(c, tolerance, &out, NULL, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_insert_knot(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  double t;
  long times;
  if (!cag_arg_curve(call, 0, &c) ||
      !cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, &t) ||
      !cag_arg_integer_or(call, 2, 1, 1, TIMES_MAX, &times))
    return false;
  double knots[TIMES_MAX];
  for (long i = 0; i < times; i++) knots[i] = t;
  CagStatus status = cag_curve_insert_knots(c, knots, (size_t)times, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

// Part of the size of the curve within which a knot counts as one without effect.
#define WITHOUT_EFFECT 1e-9

static bool tolerance_of_size(CagCall *call, const CagCurve *c, int argument, double part,
                              double *out) {
  CagBounds box;
  if (cag_given(call, argument)) return read_tolerance(call, argument, out);
  if (!cag_geometry_ok(call, cag_curve_bounds(c, &box, call->err))) return false;
  *out = part * cag_norm(cag_sub(box.max, box.min));
  return true;
}

// C, t, tolerance, times
bool cag_bsplines_remove_knot(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  double t, tolerance;
  long times;
  if (!cag_arg_curve(call, 0, &c) ||
      !cag_arg_parameter(call, 1, c->angular, c->start, c->end, false, &t) ||
      !tolerance_of_size(call, c, 2, WITHOUT_EFFECT, &tolerance) ||
      !cag_arg_integer_or(call, 3, 1, 1, TIMES_MAX, &times))
    return false;
  CagStatus status = cag_curve_remove_knot(c, t, (int)times, tolerance, &out, NULL, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_refine(CagCall *call, CagValue *result) {
  static const char *const ways[] = {"midpoints", NULL};
  CagCurve *c, *out = NULL;
  CagStatus status;
  const double *knots;
  size_t n;
  int way;
  if (!cag_arg_curve(call, 0, &c)) return false;
  if (cag_given(call, 1) && call->values[1].type != CAG_TEXT) {
    if (!cag_arg_numbers(call, 1, &knots, &n)) return false;
    status = cag_curve_insert_knots(c, knots, n, &out, call->err);
  } else {
    if (!cag_arg_choice(call, 1, ways, &way)) return false;
    status = cag_curve_insert_midpoints(c, &out, call->err);
  }
  return cag_changed_curve_result(call, status, &out, result);
}

bool cag_bsplines_clamp_ends(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  if (!cag_arg_curve(call, 0, &c)) return false;
  return cag_changed_curve_result(call, cag_curve_clamp(c, &out, call->err), &out, result);
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

bool cag_bsplines_offset(CagCall *call, CagValue *result) {
  CagCurve *c, *out = NULL;
  double d, tolerance;
  if (!cag_arg_curve(call, 0, &c) || !cag_arg_finite(call, 1, &d) ||
      !tolerance_of_size(call, c, 2, OFFSET_TOLERANCE, &tolerance))
    return false;
  if (!(tolerance > 0))
    return cag_fail_call(call, 2, CAG_ERR_value, "expects a positive `tolerance`");
  CagStatus status = cag_curve_offset(c, d, tolerance, &out, call->err);
  return cag_changed_curve_result(call, status, &out, result);
}
