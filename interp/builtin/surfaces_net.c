// Bezier and B-spline surfaces of nets of control points, given by rows of u.

#include <limits.h>
#include <string.h>

#include "base/memory.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

// --- Grids of points ---

bool cag_read_vector(CagValue v, CagVec3 *out) {
  const double *x;
  size_t n;
  if (!cag_as_vector(v, &x, &n) || n < 2 || n > 3) return false;
  *out = cag_vec3(x[0], x[1], n == 3 ? x[2] : 0);
  return isfinite(out->x) && isfinite(out->y) && isfinite(out->z);
}

static bool read_row(CagCall *call, const CagList *row, size_t i, CagVec3 *out) {
  for (size_t j = 0; j < row->length; j++) {
    const CagValue p = cag_list_get(call->vm, row, j);
    if (!cag_read_vector(p, &out[j]))
      return cag_fail_call(call, 0, CAG_ERR_type,
                           "expects points of 2 or 3 finite numbers, found %s at [%zu][%zu]",
                           cag_type_article(p), i, j);
  }
  return true;
}

bool cag_arg_grid(CagCall *call, CagVec3 **points, size_t *rows, size_t *columns) {
  CagList *list;
  *columns = 0;
  if (!cag_arg_list(call, 0, &list)) return false;
  *rows = list->length;
  for (size_t i = 0; i < *rows; i++) {
    const CagValue v = cag_list_get(call->vm, list, i);
    if (v.type != CAG_LIST) return cag_fail_element(call, 0, i, v, "rows of points");
    const CagList *row = CAG_AS_LIST(v);
    if (i == 0) {
      *columns = row->length;
      *points = cag_hold(call, cag_malloc((*rows * *columns + 1) * sizeof **points));
    }
    if (row->length != *columns) {
      const char *name = cag_parameter_name(call, 0);
      return cag_geometry_ok(
          call,
          cag_fail(
              call->err, CAG_E_ARGUMENT, CAG_ERR_net_not_rectangular, name, (long)i,
              "`%s` must have rows of the same length: row 0 has %zu points, and row %zu has %zu",
              name, *columns, i, row->length));
    }
    if (!read_row(call, row, i, *points + i * *columns)) return false;
  }
  return (*rows > 0 && *columns > 0) ||
         cag_fail_call(call, 0, CAG_ERR_value, "expects at least one row of points");
}

CagValue cag_one_of_two(CagCall *call, int argument, int direction) {
  const CagValue v = call->values[argument];
  if (v.type != CAG_LIST || CAG_AS_LIST(v)->length != 2) return v;
  return cag_list_get(call->vm, CAG_AS_LIST(v), (size_t)direction);
}

bool cag_arg_closed(CagCall *call, int argument, bool closed[2]) {
  for (int k = 0; k < 2; k++) {
    const CagValue v = cag_one_of_two(call, argument, k);
    closed[k] = v.type == CAG_BOOL && v.as.boolean;
    if (v.type != CAG_BOOL && v.type != CAG_UNSET)
      return cag_fail_type(call, argument, "a bool, or two for u and v");
  }
  return true;
}

// --- Nets of control points ---

typedef struct Net {
  CagVec3 *points; // held, as the weights
  double *weights; // NULL: none
  size_t nu, nv;
} Net;

// The first argument, and the weights where they are given.
static bool read_net(CagCall *call, int argument, Net *net) {
  CagList *rows;
  *net = (Net){0};
  if (!cag_arg_grid(call, &net->points, &net->nu, &net->nv)) return false;
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
  return fits || cag_geometry_ok(
                     call, cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_weight_count, "weights", -1,
                                    "`weights` must be %zu rows of %zu numbers, like the points",
                                    net->nu, net->nv));
}

bool cag_surfaces_bezier_surface(CagCall *call, CagValue *result) {
  Net net;
  CagSurface *s = NULL;
  if (!read_net(call, 1, &net)) return false;
  CagStatus status = cag_surface_bezier(net.points, net.weights, net.nu, net.nv, &s, call->err);
  return cag_surface_result(call, status, &s, result);
}

// --- B-splines: degree, knots and closed are one value for both directions, or a list of two ---

// `degree`, or one less than `order`.
static bool read_degree(CagCall *call, int degree, int order, int direction, int *out) {
  bool by_order = cag_given(call, order);
  *out = 3;
  if (by_order && cag_given(call, degree))
    return cag_fail_call(call, order, CAG_ERR_value, "takes `degree` or `order`, not both");
  int argument = by_order ? order : degree;
  if (!cag_given(call, argument)) return true;
  CagValue v = cag_one_of_two(call, argument, direction);
  if (v.type != CAG_NUMBER || v.as.number != floor(v.as.number) || fabs(v.as.number) > 1000)
    return cag_fail_type(call, argument, "a whole number, or two for u and v");
  *out = (int)v.as.number - (by_order ? 1 : 0);
  return true;
}

// Knots of n points; *out is held.
static bool read_knots(CagCall *call, int argument, int direction, size_t n, int degree,
                       double **out) {
  const double *x;
  size_t count, wanted = n + (size_t)degree + 1;
  const char *type = "open";
  const CagValue v = cag_one_of_two(call, argument, direction);
  if (v.type == CAG_TEXT) type = CAG_AS_TEXT(v)->bytes;
  bool list = v.type == CAG_LIST;
  if (!list && v.type != CAG_TEXT && v.type != CAG_UNSET)
    return cag_fail_type(call, argument,
                         "\"open\", \"periodic\", or knots, or two of these for u and v");
  if (!list && strcmp(type, "open") != 0 && strcmp(type, "periodic") != 0)
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects \"open\", \"periodic\", or a list as `knots`, found \"%s\"",
                         type);
  CagStatus status = CAG_OK;
  if (n < 2)
    status =
        cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_order_range, "net", direction,
                 "a surface needs at least 2 rows of at least 2 points, but in %c there is %zu",
                 "uv"[direction], n);
  else if (degree < 1 || n <= (size_t)degree)
    status = cag_fail(
        call->err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", direction,
        "`degree` in %c must lie in 1..%zu for %zu points, found %d; add points, or lower the degree",
        "uv"[direction], n - 1, n, degree);
  else if (list && (!cag_as_vector(v, &x, &count) || count != wanted))
    status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_knot_count, "knots", -1,
                      "%zu points of degree %d need %zu `knots` in %c (points + degree + 1)", n,
                      degree, wanted, "uv"[direction]);
  if (!cag_geometry_ok(call, status)) return false;
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
  if (!read_net(call, 4, &net) || !cag_arg_closed(call, 3, closed)) return false;
  for (int k = 0; k < 2; k++)
    if (!read_degree(call, 1, 5, k, &degree[k]) ||
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
  cag_fail_call(call, -1, CAG_ERR_arity, "expects `weights`, in rows like the points");
  cag_fail_help(call->vm, "without weights, use `bspline_surface`");
  return false;
}
