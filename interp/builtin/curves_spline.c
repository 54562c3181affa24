// Bezier and B-spline curves, and their bases as data.

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "geom/basis/bspline.h"
#include "interp/builtin/curves.h"

// `made` is read after the call that fills it: pass its address.
static bool give(CagCall *call, CagStatus status, const CagError *err, CagCurve **made,
                 CagValue *result) {
  if (!cag_geometry_ok(call, status, err)) return false;
  *result = cag_curve_value(call->vm, *made);
  return true;
}

static bool is_set(CagCall *call, int argument) {
  return cag_given(call, argument) && call->values[argument].type != CAG_NONE;
}

bool cag_arg_degree(CagCall *call, int degree, int order, long fallback, int *out) {
  long given;
  if (is_set(call, order)) {
    if (cag_given(call, degree))
      return cag_fail_call(call, order, CAG_ERR_value,
                           "takes `degree` or `order` (one more than the degree), not both");
    if (!cag_arg_integer(call, order, 2, INT_MAX, &given)) return false;
    *out = (int)given - 1;
    return true;
  }
  if (!cag_arg_integer_or(call, degree, fallback, 0, INT_MAX - 1, &given)) return false;
  *out = (int)given;
  return true;
}

// Weights as many as points; NULL where there are none.
static bool read_weights(CagCall *call, int argument, size_t n, const double **out) {
  size_t count;
  *out = NULL;
  if (!is_set(call, argument)) return true;
  if (!cag_arg_numbers(call, argument, out, &count)) return false;
  if (count == n) return true;
  return cag_fail_call(call, argument, CAG_ERR_length,
                       "expects one of `weights` for each of %zu points, found %zu", n, count);
}

bool cag_curves_bezier(CagCall *call, CagValue *result) {
  CagVec3 *points;
  const double *weights;
  size_t n;
  int dimension;
  CagCurve *c = NULL;
  CagError err;
  if (!cag_arg_points(call, 0, &points, &n, &dimension)) return false;
  bool ok = read_weights(call, 1, n, &weights);
  CagStatus status = ok ? cag_curve_bezier(points, weights, n, dimension, &c, &err) : CAG_OK;
  free(points);
  return ok && give(call, status, &err, &c, result);
}

// Knots from a name or a list; *own is to be freed.
static bool read_knots(CagCall *call, int argument, size_t n, int degree, const CagVec3 *points,
                       double **own, const double **knots) {
  CagError err;
  *own = NULL;
  const char *type = "open";
  if (cag_given(call, argument) && call->values[argument].type != CAG_TEXT) {
    size_t count;
    if (!cag_arg_numbers(call, argument, knots, &count)) return false;
    if (count == n + (size_t)degree + 1) return true;
    cag_fail(&err, CAG_E_ARGUMENT, "knot-count", "knots", -1,
             "%zu points of degree %d want %zu `knots` (points + degree + 1), found %zu", n, degree,
             n + (size_t)degree + 1, count);
    return cag_fail_geometry(call, &err);
  }
  if (cag_given(call, argument) && !cag_arg_text(call, argument, &type)) return false;
  if (n <= (size_t)degree || degree < 1) {
    cag_fail(&err, CAG_E_ARGUMENT, "degree-too-high", "degree", -1,
             "a degree of %d wants at least %d points, found %zu", degree, degree + 1, n);
    return cag_fail_geometry(call, &err);
  }
  *own = malloc((n + (size_t)degree + 1) * sizeof **own);
  if (!*own) return cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory");
  *knots = *own;
  return cag_geometry_ok(call, cag_knots_make(type, n, degree, points, *own, &err), &err);
}

// points, degree, knots, closed, weights, order
static bool make_bspline(CagCall *call, const CagVec3 *points, size_t n, int dimension,
                         CagValue *result) {
  int degree = 0;
  bool closed;
  const double *weights, *knots = NULL;
  double *own = NULL;
  CagCurve *c = NULL;
  CagError err;
  CagStatus status;
  if (!cag_arg_degree(call, 1, 5, 3, &degree) || !cag_arg_bool_or(call, 3, false, &closed) ||
      !read_weights(call, 4, n, &weights))
    return false;
  if (closed) {
    if (cag_given(call, 2) && call->values[2].type != CAG_TEXT)
      return cag_fail_call(call, 2, CAG_ERR_value,
                           "takes no list of `knots` for a closed curve: they are uniform");
    status = cag_curve_nurbs_closed(points, weights, n, degree, dimension, &c, &err);
    return give(call, status, &err, &c, result);
  }
  bool ok = read_knots(call, 2, n, degree, points, &own, &knots);
  status = ok ? cag_curve_nurbs(points, weights, n, degree, knots, dimension, &c, &err) : CAG_OK;
  free(own);
  return ok && give(call, status, &err, &c, result);
}

bool cag_curves_bspline(CagCall *call, CagValue *result) {
  CagVec3 *points;
  size_t n;
  int dimension;
  if (!cag_arg_points(call, 0, &points, &n, &dimension)) return false;
  bool ok = make_bspline(call, points, n, dimension, result);
  free(points);
  return ok;
}

bool cag_curves_nurbs(CagCall *call, CagValue *result) {
  if (is_set(call, 4)) return cag_curves_bspline(call, result);
  cag_fail_call(call, -1, CAG_ERR_arity, "wants `weights`, one for each point");
  cag_fail_help(call->vm, "without weights it is a `bspline`");
  return false;
}

// --- Bases as data ---

bool cag_curves_knot_vector(CagCall *call, CagValue *result) {
  long count;
  int degree;
  CagVec3 *points = NULL;
  size_t n = 0;
  const char *type = "chord";
  CagError err;
  if (!cag_arg_integer(call, 0, 2, INT_MAX, &count) || !cag_arg_degree(call, 1, 3, 3, &degree))
    return false;
  if (cag_given(call, 2) && call->values[2].type == CAG_LIST) {
    if (!cag_arg_points(call, 2, &points, &n, NULL)) return false;
    if (n != (size_t)count) {
      free(points);
      return cag_fail_call(call, 2, CAG_ERR_length, "expects %ld points, found %zu", count, n);
    }
  } else if (!cag_given(call, 2)) type = "open";
  else if (!cag_arg_text(call, 2, &type)) return false;
  bool ok = degree >= 1 && count > degree;
  if (!ok)
    cag_fail_call(call, 1, CAG_ERR_value, "wants a degree of at least 1 and less than the count");
  double *knots = NULL;
  if (ok) {
    size_t size = (size_t)count + (size_t)degree + 1;
    *result = cag_list_numbers(call->vm, size, &knots);
    ok = cag_geometry_ok(call, cag_knots_make(type, (size_t)count, degree, points, knots, &err),
                         &err);
  }
  free(points);
  return ok;
}

static CagStatus basis_values(const double *knots, size_t n, int degree, double t, int derivative,
                              double *out, CagError *err) {
  CagStatus status = cag_knots_check(knots, n, degree, err);
  if (status != CAG_OK) return status;
  if (t < knots[degree] || t > knots[n])
    return cag_fail(err, CAG_E_DOMAIN, "parameter-range", "t", -1,
                    "`t` must be in %.17g..%.17g, the usable range of the knots; found %.17g",
                    knots[degree], knots[n], t);
  size_t width = (size_t)degree + 1;
  double *rows = malloc((size_t)(derivative + 1) * width * sizeof *rows);
  if (!rows) return cag_fail_memory(err);
  size_t span = cag_knots_span(knots, n, degree, t, false, (size_t)degree);
  cag_bspline_derivatives(knots, degree, span, t, derivative, rows);
  memset(out, 0, n * sizeof *out);
  memcpy(out + span - (size_t)degree, rows + (size_t)derivative * width, width * sizeof *out);
  free(rows);
  return CAG_OK;
}

bool cag_curves_basis(CagCall *call, CagValue *result) {
  const double *knots;
  size_t count;
  int degree;
  long derivative;
  double t, *out;
  CagError err;
  if (!cag_arg_numbers(call, 0, &knots, &count) || !cag_arg_degree(call, 1, 4, 3, &degree) ||
      !cag_arg_finite(call, 2, &t) ||
      !cag_arg_integer_or(call, 3, 0, 0, CAG_MAX_DERIVATIVE, &derivative))
    return false;
  if (degree < 1 || count < 2 * ((size_t)degree + 1))
    return cag_fail_call(call, 0, CAG_ERR_value,
                         "wants at least 2 (degree + 1) knots, found %zu of degree %d", count,
                         degree);
  size_t n = count - (size_t)degree - 1;
  *result = cag_list_numbers(call->vm, n, &out);
  return cag_geometry_ok(call, basis_values(knots, n, degree, t, (int)derivative, out, &err), &err);
}

// A higher degree has no values that a double can tell apart.
#define BERNSTEIN_MAX 1000

bool cag_curves_bernstein(CagCall *call, CagValue *result) {
  long n;
  double t, *b;
  if (!cag_arg_integer(call, 0, 0, BERNSTEIN_MAX, &n) || !cag_arg_finite(call, 1, &t)) return false;
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
