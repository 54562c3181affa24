// Surfaces from grids of points, and what can be unrolled.

#include <stdlib.h>

#include "geom/surface/loft.h"
#include "geom/surface/reshape.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

static bool give(CagCall *call, CagStatus status, const CagError *err, CagSurface **made,
                 CagValue *result) {
  if (!cag_geometry_ok(call, status, err)) return false;
  *result = cag_surface_value(call->vm, *made);
  return true;
}

// Two whole numbers, or one for both.
static bool read_pair(CagCall *call, int argument, long fallback, long low, long high,
                      long out[2]) {
  CagValue v = call->values[argument];
  out[0] = out[1] = fallback;
  if (v.type == CAG_UNSET) return true;
  if (v.type == CAG_NUMBER) {
    if (!cag_arg_integer(call, argument, low, high, &out[0])) return false;
    out[1] = out[0];
    return true;
  }
  const double *x;
  size_t n;
  if (!cag_as_vector(v, &x, &n) || n != 2)
    return cag_fail_type(call, argument, "a whole number, or two for u and v");
  for (int k = 0; k < 2; k++) {
    if (x[k] != floor(x[k]) || x[k] < (double)low || x[k] > (double)high)
      return cag_fail_call(call, argument, CAG_ERR_value, "expects whole numbers from %ld to %ld",
                           low, high);
    out[k] = (long)x[k];
  }
  return true;
}

static bool fail_memory(CagCall *call) {
  return cag_fail_call(call, 0, CAG_ERR_limit_memory, "needs more memory than there is");
}

// *points is to be freed even when the call fails.
static bool read_grid(CagCall *call, CagVec3 **points, size_t *r, size_t *s) {
  CagList *rows;
  *points = NULL;
  if (!cag_arg_list(call, 0, &rows)) return false;
  *r = rows->length;
  for (size_t i = 0; i < *r; i++) {
    CagValue row = cag_list_get(call->vm, rows, i);
    if (row.type != CAG_LIST) return cag_fail_element(call, 0, i, row, "rows of points");
    const CagList *line = CAG_AS_LIST(row);
    if (i == 0) {
      *s = line->length;
      *points = malloc((*r * *s + 1) * sizeof **points);
      if (!*points) return fail_memory(call);
    }
    if (line->length != *s)
      return cag_fail_call(call, 0, CAG_ERR_length,
                           "expects rows of one length: row 0 has %zu points, row %zu has %zu", *s,
                           i, line->length);
    for (size_t j = 0; j < *s; j++) {
      const double *x;
      size_t n;
      CagValue p = cag_list_get(call->vm, line, j);
      if (!cag_as_vector(p, &x, &n) || n < 2 || n > 3 || !isfinite(x[0] + x[1] + x[n - 1]))
        return cag_fail_call(call, 0, CAG_ERR_type,
                             "expects points of 2 or 3 finite numbers, found %s at [%zu][%zu]",
                             cag_type_article(p), i, j);
      (*points)[i * *s + j] = cag_vec3(x[0], x[1], n == 3 ? x[2] : 0);
    }
  }
  if (*r > 0 && *s > 0) return true;
  return cag_fail_value(call, 0, "rows of points");
}

static bool read_data(CagCall *call, int parameters, CagVec3 **points, CagGridData *g) {
  static const char *const spacings[] = {"chord", "mean", "uniform", NULL};
  long degree[2];
  int spacing;
  if (!read_grid(call, points, &g->r, &g->s) || !read_pair(call, 1, 3, 1, 25, degree) ||
      !cag_arg_choice(call, parameters, spacings, &spacing))
    return false;
  g->points = *points;
  g->degree_u = (int)degree[0];
  g->degree_v = (int)degree[1];
  g->spacing = (CagGridSpacing)spacing;
  return true;
}

bool cag_surfaces_interpolate_surface(CagCall *call, CagValue *result) {
  CagVec3 *points;
  CagGridData g = {0};
  CagSurface *s = NULL;
  CagError err;
  bool ok = read_data(call, 2, &points, &g) &&
            give(call, cag_surface_interpolate(&g, &s, &err), &err, &s, result);
  free(points);
  return ok;
}

static bool fit(CagCall *call, bool report, CagValue *result) {
  static const char *const names[] = {"surface", "rms", "largest"};
  CagVec3 *points;
  CagGridData g = {0};
  CagSurface *s = NULL;
  CagError err;
  long count[2];
  double rms, largest;
  bool ok = read_data(call, 3, &points, &g) && read_pair(call, 2, 0, 2, 10000, count);
  if (ok) {
    CagStatus status = cag_surface_fit(&g, (size_t)count[0], (size_t)count[1], &s,
                                       report ? &rms : NULL, report ? &largest : NULL, &err);
    ok = give(call, status, &err, &s, result);
  }
  if (ok && report) {
    CagValue values[] = {*result, cag_number(rms), cag_number(largest)};
    *result = cag_record_new(call->vm, names, values, 3);
  }
  free(points);
  return ok;
}

bool cag_surfaces_fit_surface(CagCall *call, CagValue *result) { return fit(call, false, result); }

bool cag_surfaces_fit_surface_report(CagCall *call, CagValue *result) {
  return fit(call, true, result);
}

// --- Developable surfaces ---

// Places in each direction at which the Gaussian curvature is looked at, besides the breaks.
#define PROBES 24

bool cag_surfaces_is_developable(CagCall *call, CagValue *result) {
  CagSurface *s;
  CagBounds box;
  CagError err;
  double tolerance, worst = 0;
  if (!cag_arg_surface(call, 0, &s) || !cag_arg_number_or(call, 1, 1e-9, &tolerance) ||
      !cag_geometry_ok(call, cag_surface_bounds(s, &box, &err), &err))
    return false;
  double size = cag_norm(cag_sub(box.max, box.min));
  for (int i = 0; i < PROBES; i++)
    for (int j = 0; j < PROBES; j++) {
      // Off the ends, where poles lie, and off the middles, where knots like to be.
      double u = s->u0 + (s->u1 - s->u0) * (i + 0.431) / PROBES;
      double v = s->v0 + (s->v1 - s->v0) * (j + 0.567) / PROBES;
      CagVec3 d[9];
      CagStatus status = cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err);
      if (!cag_geometry_ok(call, status, &err)) return false;
      CagVec3 n = cag_cross(d[cag_partial(2, 1, 0)], d[cag_partial(2, 0, 1)]);
      double length = cag_norm(n);
      if (length == 0) continue;
      double a = cag_dot(n, d[cag_partial(2, 2, 0)]), b = cag_dot(n, d[cag_partial(2, 1, 1)]);
      double c = cag_dot(n, d[cag_partial(2, 0, 2)]);
      double k = (a * c - b * b) / (length * length * length * length);
      worst = fmax(worst, fabs(k) * size * size);
    }
  *result = cag_bool(worst <= tolerance);
  return true;
}

bool cag_surfaces_unroll(CagCall *call, CagValue *result) {
  CagSurface *s, *out = NULL;
  CagError err;
  if (!cag_arg_surface(call, 0, &s) ||
      !give(call, cag_surface_unroll(s, &out, &err), &err, &out, result))
    return false;
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}
