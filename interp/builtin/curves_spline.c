// Bezier and B-spline curves, and their bases as data.

#include <limits.h>
#include <string.h>

#include "geom/basis/bspline.h"
#include "interp/builtin/curves.h"

bool cag_arg_degree(CagCall *call, int degree, int order, long fallback, int *out) {
  const bool by_order = cag_given(call, order);
  long given;
  if (by_order && cag_given(call, degree))
    return cag_fail_call(call, order, CAG_ERR_value,
                         "takes `degree` or `order` (one more than the degree), not both");
  if (by_order ? !cag_arg_integer(call, order, 0, INT_MAX, &given)
               : !cag_arg_integer_or(call, degree, fallback, -1, INT_MAX - 1, &given))
    return false;
  *out = (int)given - by_order;
  return true;
}

static bool check_weights(CagCall *call, int argument, const CagNumbers *weights, size_t n) {
  return !cag_given(call, argument) || weights->count == n ||
         cag_fail_core(call, CAG_E_ARGUMENT, CAG_ERR_weight_count, "weights", -1,
                       "expects one of `weights` for each of %zu points, found %zu", n,
                       weights->count);
}

bool cag_curves_bezier(CagCall *call, const struct cag_curves_bezier *a, CagValue *result) {
  const CagPoints *p = &a->points;
  CagCurve *c = NULL;
  if (!check_weights(call, 1, &a->weights, p->count)) return false;
  CagStatus status =
      cag_curve_bezier(p->items, a->weights.items, p->count, p->dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// Knots from a name or a list, the third argument.
static bool read_knots(CagCall *call, size_t n, int degree, const CagVec3 *points,
                       const double **knots) {
  const size_t wanted = n + (size_t)degree + 1;
  const CagType type = call->values[2].type;
  const char *name = "open";
  if (type != CAG_UNSET && type != CAG_TEXT) {
    size_t count;
    if (!cag_arg_numbers(call, 2, knots, &count)) return false;
    return count == wanted ||
           cag_fail_core(
               call, CAG_E_ARGUMENT, CAG_ERR_knot_count, "knots", -1,
               "%zu points of degree %d need %zu `knots` (points + degree + 1), found %zu", n,
               degree, wanted, count);
  }
  if ((type == CAG_TEXT && !cag_arg_text(call, 2, &name)) ||
      !cag_geometry_ok(call, cag_degree_check(n, degree, call->err)))
    return false;
  double *made = cag_hold_array(call, wanted, sizeof *made);
  *knots = made;
  return cag_geometry_ok(call, cag_knots_make(name, n, degree, points, made, call->err));
}

bool cag_curves_bspline(CagCall *call, const struct cag_curves_bspline *a, CagValue *result) {
  const CagVec3 *points = a->points.items;
  const size_t n = a->points.count;
  const int dimension = a->points.dimension;
  int degree = 0;
  const double *weights = a->weights.items, *knots = NULL;
  CagCurve *c = NULL;
  CagStatus status;
  if (!cag_arg_degree(call, 1, 5, 3, &degree) || !check_weights(call, 4, &a->weights, n))
    return false;
  if (a->closed) {
    if (cag_given(call, 2) && a->knots.type != CAG_TEXT)
      return cag_fail_call(call, 2, CAG_ERR_value,
                           "takes no list of `knots` for a closed curve: they are uniform");
    // A polygon that comes back to its first point has that once.
    const CagVec3 first = points[0], last = points[n - 1];
    const bool again = n > 2 && first.x == last.x && first.y == last.y && first.z == last.z;
    status = cag_curve_nurbs_closed(points, weights, n - again, degree, dimension, &c, call->err);
  } else {
    if (!read_knots(call, n, degree, points, &knots)) return false;
    status = cag_curve_nurbs(points, weights, n, degree, knots, dimension, &c, call->err);
  }
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_nurbs(CagCall *call, const struct cag_curves_nurbs *a, CagValue *result) {
  if (cag_given(call, 4)) {
    const struct cag_curves_bspline same = {a->points, a->degree,  a->knots,
                                            a->closed, a->weights, a->order};
    return cag_curves_bspline(call, &same, result);
  }
  cag_fail_call(call, -1, CAG_ERR_arity, "expects `weights`, one for each point");
  cag_fail_help(call->vm, "without weights, use `bspline`");
  return false;
}

// --- Bases as data ---

// Knots so that their usable range is from..to.
static void remap_knots(double *knots, size_t n, int degree, double from, double to) {
  const double a = knots[degree], b = knots[n];
  for (size_t i = 0; i < n + (size_t)degree + 1; i++)
    knots[i] = knots[i] == b ? to : from + (knots[i] - a) / (b - a) * (to - from);
}

// count, degree, kind, order, over
bool cag_curves_knot_vector(CagCall *call, CagValue *result) {
  long count;
  int degree;
  CagVec3 *points = NULL;
  size_t n = 0;
  const char *type = "chord";
  double from = 0, to = 1, *knots;
  bool angle;
  if (!cag_arg_integer(call, 0, 1, INT_MAX, &count) || !cag_arg_degree(call, 1, 3, 3, &degree))
    return false;
  if (cag_given(call, 4)) {
    if (!cag_arg_interval(call, 4, &from, &to, &angle)) return false;
    if (angle || !isfinite(from) || !isfinite(to) || !(from < to))
      return cag_fail_type(call, 4, "an increasing range of numbers");
  }
  if (!cag_geometry_ok(call, cag_degree_check((size_t)count, degree, call->err))) return false;
  if (cag_given(call, 2) && call->values[2].type == CAG_LIST) {
    if (!cag_arg_points(call, 2, &points, &n, NULL)) return false;
    cag_hold(call, points);
    if (n != (size_t)count)
      return cag_fail_call(call, 2, CAG_ERR_length, "expects %ld points, found %zu", count, n);
  } else if (!cag_given(call, 2)) type = "open";
  else if (!cag_arg_text(call, 2, &type)) return false;
  *result = cag_list_numbers(call->vm, (size_t)count + (size_t)degree + 1, &knots);
  CagStatus status = cag_knots_make(type, (size_t)count, degree, points, knots, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  if (cag_given(call, 4)) remap_knots(knots, (size_t)count, degree, from, to);
  return true;
}

bool cag_curves_bernstein(CagCall *call, const struct cag_curves_bernstein *a, CagValue *result) {
  const long n = a->n;
  const double t = a->t;
  double *b;
  *result = cag_list_numbers(call->vm, (size_t)n + 1, &b);
  // B(i, k) = (1 - t) B(i, k - 1) + t B(i - 1, k - 1)
  b[0] = 1;
  for (long k = 1; k <= n; k++) {
    b[k] = t * b[k - 1];
    for (long i = k - 1; i > 0; i--) b[i] = (1 - t) * b[i] + t * b[i - 1];
    b[0] *= 1 - t;
  }
  return true;
}
