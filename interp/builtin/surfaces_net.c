// Bezier and B-spline surfaces of nets of control points, given by rows of u.

#include <limits.h>
#include <string.h>

#include "base/memory.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

typedef struct Net {
  CagVec3 *points; // held, as the weights
  double *weights; // NULL: none
  size_t nu, nv;
} Net;

bool cag_fail_rows(CagCall *call, size_t wanted, size_t row, size_t found) {
  cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_net_not_rectangular, cag_parameter_name(call, 0),
           (long)row, "`%s` must have rows of one length: row 0 has %zu points, row %zu has %zu",
           cag_parameter_name(call, 0), wanted, row, found);
  return cag_fail_geometry(call, call->err);
}

static bool read_row(CagCall *call, const CagList *row, size_t i, Net *net) {
  for (size_t j = 0; j < net->nv; j++) {
    const double *x;
    size_t n;
    CagValue p = cag_list_get(call->vm, row, j);
    if (!cag_as_vector(p, &x, &n) || n < 2 || n > 3 || !isfinite(x[0]) || !isfinite(x[1]) ||
        (n == 3 && !isfinite(x[2])))
      return cag_fail_call(call, 0, CAG_ERR_type,
                           "expects points of 2 or 3 finite numbers, found %s at [%zu][%zu]",
                           cag_type_article(p), i, j);
    net->points[i * net->nv + j] = cag_vec3(x[0], x[1], n == 3 ? x[2] : 0);
  }
  return true;
}

// Rows of one length.
static bool read_net(CagCall *call, Net *net) {
  CagList *rows;
  *net = (Net){0};
  if (!cag_arg_list(call, 0, &rows)) return false;
  net->nu = rows->length;
  for (size_t i = 0; i < net->nu; i++) {
    CagValue row = cag_list_get(call->vm, rows, i);
    if (row.type != CAG_LIST)
      return cag_fail_call(call, 0, CAG_ERR_type, "expects rows of points, found %s as row %zu",
                           cag_type_article(row), i);
    size_t n = CAG_AS_LIST(row)->length;
    if (i == 0) {
      net->nv = n;
      net->points = cag_hold(call, cag_malloc((net->nu * n + 1) * sizeof *net->points));
    }
    if (n != net->nv) return cag_fail_rows(call, net->nv, i, n);
    if (!read_row(call, CAG_AS_LIST(row), i, net)) return false;
  }
  if (net->nu == 0 || net->nv == 0)
    return cag_fail_call(call, 0, CAG_ERR_value, "expects at least one row of points");
  return true;
}

static bool read_weights(CagCall *call, int argument, Net *net) {
  CagList *rows;
  if (!cag_given(call, argument)) return true;
  if (!cag_arg_list(call, argument, &rows)) return false;
  net->weights = cag_hold(call, cag_malloc(net->nu * net->nv * sizeof *net->weights));
  bool fits = rows->length == net->nu;
  for (size_t i = 0; fits && i < net->nu; i++) {
    const double *x;
    size_t n;
    fits = cag_as_vector(cag_list_get(call->vm, rows, i), &x, &n) && n == net->nv;
    if (fits) memcpy(net->weights + i * net->nv, x, n * sizeof *x);
  }
  if (fits) return true;
  cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_weight_count, "weights", -1,
           "`weights` must be %zu rows of %zu numbers, as the points", net->nu, net->nv);
  return cag_fail_geometry(call, call->err);
}

bool cag_surfaces_bezier_surface(CagCall *call, CagValue *result) {
  Net net;
  CagSurface *s = NULL;
  if (!read_net(call, &net) || !read_weights(call, 1, &net)) return false;
  CagStatus status = cag_surface_bezier(net.points, net.weights, net.nu, net.nv, &s, call->err);
  return cag_surface_result(call, status, &s, result);
}

// --- B-splines: degree, knots and closed are one value for both directions, or a list of two ---

static CagValue one_of_two(CagCall *call, int argument, int direction) {
  CagValue v = call->values[argument];
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->length != 2) return v;
  return cag_list_get(call->vm, CAG_AS_LIST(v), (size_t)direction);
}

// `degree`, or one less than `order`.
static bool read_degree(CagCall *call, int degree, int order, int direction, int *out) {
  bool by_order = cag_given(call, order);
  *out = 3;
  if (by_order && cag_given(call, degree))
    return cag_fail_call(call, order, CAG_ERR_value, "takes `degree` or `order`, not both");
  int argument = by_order ? order : degree;
  if (!cag_given(call, argument)) return true;
  CagValue v = one_of_two(call, argument, direction);
  if (v.type != CAG_NUMBER || v.as.number != floor(v.as.number) || fabs(v.as.number) > 1000)
    return cag_fail_type(call, argument, "a whole number, or two for u and v");
  *out = (int)v.as.number - (by_order ? 1 : 0);
  return true;
}

static bool read_closed(CagCall *call, int argument, int direction, bool *out) {
  *out = false;
  if (!cag_given(call, argument)) return true;
  CagValue v = one_of_two(call, argument, direction);
  if (v.type != CAG_BOOL) return cag_fail_type(call, argument, "a bool, or two for u and v");
  *out = v.as.boolean;
  return true;
}

// Knots of n points; *out is held.
static bool read_knots(CagCall *call, int argument, int direction, size_t n, int degree,
                       double **out) {
  const double *x;
  size_t count, wanted = n + (size_t)degree + 1;
  const char *type = "open";
  CagValue v = cag_given(call, argument) ? one_of_two(call, argument, direction) : cag_unset();
  if (v.type == CAG_TEXT) type = CAG_AS_TEXT(v)->bytes;
  bool list = v.type == CAG_LIST;
  if (!list && v.type != CAG_TEXT && v.type != CAG_UNSET)
    return cag_fail_type(call, argument, "\"open\", \"periodic\" or knots, or two for u and v");
  if (!list && strcmp(type, "open") != 0 && strcmp(type, "periodic") != 0)
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects \"open\", \"periodic\" or a list as `knots`, found \"%s\"", type);
  if (n < 2) {
    cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_order_range, "net", direction,
             "a surface needs at least 2 rows of at least 2 points, by %s there is %zu",
             direction ? "v" : "u", n);
    return cag_fail_geometry(call, call->err);
  }
  if (degree < 1 || n <= (size_t)degree) {
    cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", direction,
             "`degree` in %s must lie in 1..%zu for %zu points, it is %d; add points or lower it",
             direction ? "v" : "u", n - 1, n, degree);
    return cag_fail_geometry(call, call->err);
  }
  if (list && (!cag_as_vector(v, &x, &count) || count != wanted)) {
    cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_knot_count, "knots", -1,
             "%zu points of degree %d need %zu `knots` in %s (points + degree + 1)", n, degree,
             wanted, direction ? "v" : "u");
    return cag_fail_geometry(call, call->err);
  }
  *out = cag_hold_array(call, wanted, sizeof **out);
  if (!list) return cag_geometry_ok(call, cag_knots_make(type, n, degree, NULL, *out, call->err));
  memcpy(*out, x, wanted * sizeof *x);
  return true;
}

// net, degree, knots, closed, weights, order
bool cag_surfaces_bspline_surface(CagCall *call, CagValue *result) {
  Net net;
  int degree[2];
  bool closed[2];
  double *knots[2] = {NULL, NULL};
  CagSurface *s = NULL;
  if (!read_net(call, &net) || !read_weights(call, 4, &net)) return false;
  for (int k = 0; k < 2; k++)
    if (!read_degree(call, 1, 5, k, &degree[k]) || !read_closed(call, 3, k, &closed[k]) ||
        (!closed[k] && !read_knots(call, 2, k, k ? net.nv : net.nu, degree[k], &knots[k])))
      return false;
  CagStatus status =
      closed[0] || closed[1]
          ? cag_surface_nurbs_closed(net.points, net.weights, net.nu, net.nv, degree[0], degree[1],
                                     knots[0], knots[1], closed[0], closed[1], &s, call->err)
          : cag_surface_nurbs(net.points, net.weights, net.nu, net.nv, degree[0], degree[1],
                              knots[0], knots[1], &s, call->err);
  return cag_surface_result(call, status, &s, result);
}

bool cag_surfaces_nurbs_surface(CagCall *call, CagValue *result) {
  if (cag_given(call, 4)) return cag_surfaces_bspline_surface(call, result);
  cag_fail_call(call, -1, CAG_ERR_arity, "expects `weights`, in rows as the points");
  cag_fail_help(call->vm, "without weights it is a `bspline_surface`");
  return false;
}
