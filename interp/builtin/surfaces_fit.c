// Surfaces from grids of points, and the test for developable surfaces.

#include <string.h>

#include "base/memory.h"
#include "geom/surface/loft.h"
#include "geom/surface/reshape.h"
#include "interp/builtin/support.h"
#include "interp/builtin/surfaces.h"

// Reads two whole numbers, or one for both.
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
      return cag_fail_call(call, argument, CAG_ERR_value,
                           "expects whole numbers from %ld to %ld for u and v, found %g", low, high,
                           x[k]);
    out[k] = (long)x[k];
  }
  return true;
}

// Reads the knots for `count` points. Without them, the core chooses the knots.
static bool read_knots(CagCall *call, int argument, const size_t count[2], CagGridData *g) {
  for (int k = 0; k < 2; k++) {
    CagValue v = cag_one_of_two(call, argument, k);
    const double *x;
    size_t n, wanted = count[k] + (size_t)(k ? g->degree_v : g->degree_u) + 1;
    if (v.type == CAG_UNSET || v.type == CAG_NONE || g->closed[k]) continue;
    if (!cag_as_vector(v, &x, &n))
      return cag_fail_type(call, argument, "none, or two lists of knots for u and v");
    if (n != wanted)
      return cag_geometry_ok(
          call, cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_knot_count, "knots", k,
                         "%zu control points of degree %d need %zu `knots` in %c, found %zu",
                         count[k], k ? g->degree_v : g->degree_u, wanted, "uv"[k], n));
    g->knots[k] = x;
  }
  return true;
}

// Reads the parameters for u or v: one for each row or column, or a table with one for each point.
static bool read_table(CagCall *call, int argument, CagValue v, int k, const CagGridData *g,
                       double *out) {
  const double *x;
  size_t n, lines = k == 0 ? g->r : g->s;
  if (v.type == CAG_RANGE && !cag_as_list(call->vm, v, &v)) return false;
  if (cag_as_vector(v, &x, &n) && n == lines) {
    for (size_t i = 0; i < g->r * g->s; i++) out[i] = x[k == 0 ? i / g->s : i % g->s];
    return true;
  }
  bool good = v.type == CAG_LIST && CAG_AS_LIST(v)->length == g->r;
  for (size_t i = 0; good && i < g->r; i++) {
    good = cag_as_vector(cag_list_get(call->vm, CAG_AS_LIST(v), i), &x, &n) && n == g->s;
    if (good) memcpy(out + i * g->s, x, n * sizeof *x);
  }
  return good || cag_fail_call(call, argument, CAG_ERR_length,
                               "expects as `parameters` in %c %zu numbers, or %zu rows of %zu",
                               k ? 'v' : 'u', lines, g->r, g->s);
}

// Reads a spacing, or a record of parameters u and v. If one of the two is missing, it is computed
// from chords.
static bool read_parameters(CagCall *call, int argument, CagGridData *g) {
  static const char *const spacings[] = {"chord", "mean", "uniform", NULL};
  static const char *const names[] = {"u", "v"};
  int spacing;
  if (call->values[argument].type != CAG_RECORD) {
    if (!cag_arg_choice(call, argument, spacings, &spacing)) return false;
    g->spacing = (CagGridSpacing)spacing;
    return true;
  }
  for (int k = 0; k < 2; k++) {
    CagValue v = cag_record_get(CAG_AS_RECORD(call->values[argument]), names[k]);
    if (v.type == CAG_UNSET || v.type == CAG_NONE) continue;
    double *table = cag_hold_array(call, g->r * g->s, sizeof *table);
    if (!read_table(call, argument, v, k, g, table)) return false;
    g->parameters[k] = table;
  }
  return true;
}

// Reads the grid, its degrees, and the arguments with these indices.
static bool read_data(CagCall *call, int parameters, int closed, CagGridData *g) {
  CagVec3 *points;
  long degree[2];
  if (!cag_arg_grid(call, &points, &g->r, &g->s) || !read_pair(call, 1, 3, 0, 1000, degree) ||
      !cag_arg_closed(call, closed, g->closed))
    return false;
  g->points = points;
  g->degree_u = (int)degree[0];
  g->degree_v = (int)degree[1];
  return read_parameters(call, parameters, g);
}

// Reads the positions of planes in one direction, or "auto".
static bool read_positions(CagCall *call, int argument, CagValue v, CagGridData *g) {
  if (v.type == CAG_TEXT && strcmp(CAG_AS_TEXT(v)->bytes, "auto") == 0) return true;
  if (v.type == CAG_RANGE && !cag_as_list(call->vm, v, &v)) return false;
  return cag_as_vector(v, &g->planes, &g->plane_count) ||
         cag_fail_type(call, argument,
                       "\"auto\", a list of positions (of rows of control points), or a record "
                       "with one of these as u or v");
}

static bool read_planes(CagCall *call, int argument, CagGridData *g) {
  CagValue v = call->values[argument];
  g->lines = CAG_GRID_PLANES_NONE;
  if (!cag_given(call, argument)) return true;
  if (g->hold == CAG_GRID_HOLD_NONE)
    return cag_fail_call(
        call, argument, CAG_ERR_value,
        "expects `fixed` with `planes`: the coordinate \"x\", \"y\", or \"z\" of which they are values");
  if (v.type != CAG_RECORD) {
    g->lines = v.type == CAG_TEXT ? CAG_GRID_PLANES_EITHER : CAG_GRID_PLANES_U;
    return read_positions(call, argument, v, g);
  }
  CagValue by[2] = {cag_record_get(CAG_AS_RECORD(v), "u"), cag_record_get(CAG_AS_RECORD(v), "v")};
  bool said[2];
  for (int k = 0; k < 2; k++) said[k] = by[k].type != CAG_UNSET && by[k].type != CAG_NONE;
  if (said[0] == said[1])
    return cag_fail_value(call, argument,
                          "the planes of one direction, of rows as {u: ...} or of columns as "
                          "{v: ...}");
  g->lines = said[0] ? CAG_GRID_PLANES_U : CAG_GRID_PLANES_V;
  return read_positions(call, argument, by[said[0] ? 0 : 1], g);
}

static CagValue table_value(CagVm *vm, const double *x, size_t r, size_t s) {
  CagBuilder *rows = cag_builder_new(vm);
  for (size_t i = 0; i < r; i++) cag_builder_add(vm, rows, cag_numbers_value(vm, x + i * s, s));
  return cag_builder_finish(vm, rows);
}

static CagValue pair_value(CagVm *vm, const double *u, const double *v, size_t r, size_t s) {
  return cag_uv_value(vm, table_value(vm, u, r, s), table_value(vm, v, r, s));
}

// The points of the surface minus the data.
static bool residuals(CagCall *call, const CagSurface *s, const CagGridData *g,
                      const CagGridReport *report, CagValue *out) {
  CagBuilder *rows = cag_builder_new(call->vm);
  CagVec3 *line = cag_hold_array(call, g->s, sizeof *line);
  for (size_t i = 0; i < g->r; i++) {
    for (size_t j = 0; j < g->s; j++) {
      size_t k = i * g->s + j;
      CagStatus status = cag_surface_point(s, report->u[k], report->v[k], &line[j], call->err);
      if (!cag_geometry_ok(call, status)) return false;
      line[j] = cag_sub(line[j], g->points[k]);
    }
    if (!cag_builder_add(call->vm, rows, cag_points_value(call->vm, line, g->s, 3))) return false;
  }
  *out = cag_builder_finish(call->vm, rows);
  return true;
}

// The planes, in the form in which they can be passed as an argument.
static CagValue planes_value(CagVm *vm, const CagGridReport *report, const size_t net[2]) {
  CagValue by[] = {cag_none(), cag_none()};
  if (!report->planes) return cag_none();
  const int k = report->planes_along;
  by[k] = cag_numbers_value(vm, report->planes, net[k]);
  return cag_uv_value(vm, by[0], by[1]);
}

static bool report_result(CagCall *call, const CagSurface *s, const CagGridData *g,
                          const size_t net[2], const CagGridReport *report, CagValue *result) {
  static const char *const names[] = {"surface", "parameters", "residuals", "rms",
                                      "largest", "rounds",     "planes"};
  CagValue values[] = {*result,
                       pair_value(call->vm, report->u, report->v, g->r, g->s),
                       cag_none(),
                       cag_number(report->rms),
                       cag_number(report->largest),
                       cag_number(report->rounds),
                       planes_value(call->vm, report, net)};
  if (!residuals(call, s, g, report, &values[2])) return false;
  *result = cag_record_new(call->vm, names, values, 7);
  return true;
}

// Arguments: grid, degree, parameters, knots, closed.
bool cag_surfaces_interpolate_surface(CagCall *call, CagValue *result) {
  CagGridData g = {0};
  CagSurface *s = NULL;
  return read_data(call, 2, 4, &g) && read_knots(call, 3, (const size_t[]){g.r, g.s}, &g) &&
         cag_surface_result(call, cag_surface_interpolate(&g, &s, call->err), &s, result);
}

static void release_report(void *report) { cag_grid_report_free(report); }

// Arguments: grid, degree, count, parameters, knots, closed, ..., planes.
static bool fit(CagCall *call, long corrections, int fixed, double error, bool report,
                CagValue *result) {
  CagGridData g = {.corrections = (int)corrections, .hold = (CagGridHold)fixed, .slack = error};
  CagSurface *s = NULL;
  long count[2];
  if (!read_data(call, 3, 5, &g) || !read_pair(call, 2, 0, 0, 10000, count)) return false;
  const size_t net[2] = {(size_t)count[0], (size_t)count[1]};
  if (!read_planes(call, 8, &g) || !read_knots(call, 4, net, &g)) return false;
  CagGridReport *found = cag_hold_array(call, 1, sizeof *found);
  cag_hold_for(call, release_report, found);
  CagStatus status = cag_surface_fit(&g, net[0], net[1], &s, found, call->err);
  return cag_surface_result(call, status, &s, result) &&
         (!report || report_result(call, s, &g, net, found, result));
}

bool cag_surfaces_fit_surface(CagCall *call, const struct cag_surfaces_fit_surface *a,
                              CagValue *result) {
  return fit(call, a->corrections, a->fixed, a->error, false, result);
}

bool cag_surfaces_fit_surface_report(CagCall *call, const struct cag_surfaces_fit_surface_report *a,
                                     CagValue *result) {
  return fit(call, a->corrections, a->fixed, a->error, true, result);
}

bool cag_surfaces_grid_parameters(CagCall *call, const struct cag_surfaces_grid_parameters *a,
                                  CagValue *result) {
  CagVec3 *points = NULL;
  CagGridData g = {.spacing = (CagGridSpacing)a->parameters};
  const double *end = (const double[]){1, 1};
  size_t n;
  if (!cag_arg_grid(call, &points, &g.r, &g.s) || !cag_arg_closed(call, 3, g.closed)) return false;
  if (cag_given(call, 2) && (!cag_as_vector(a->ends, &end, &n) || n != 2 ||
                             !(end[0] > 0 && end[1] > 0) || !isfinite(end[0] + end[1])))
    return cag_fail_value(call, 2, "two positive numbers, the last parameters in u and v");
  double *u = cag_hold_array(call, 2 * g.r * g.s, sizeof *u), *v = u + g.r * g.s;
  g.points = points;
  cag_grid_parameters(&g, end, u, v);
  *result = pair_value(call->vm, u, v, g.r, g.s);
  return true;
}

// --- Developable surfaces ---

// The Gaussian curvature is sampled at this many parameters in each direction, besides the breaks.
#define PROBES 24

bool cag_surfaces_is_developable(CagCall *call, const struct cag_surfaces_is_developable *a,
                                 CagValue *result) {
  CagBounds box;
  double worst = 0;
  if (!cag_geometry_ok(call, cag_surface_bounds(a->S, &box, call->err))) return false;
  double size = cag_norm(cag_sub(box.max, box.min));
  for (int i = 0; i < PROBES; i++)
    for (int j = 0; j < PROBES; j++) {
      // The offset avoids the ends, where poles are, and the middles, where knots often are.
      double u = a->S->u0 + (a->S->u1 - a->S->u0) * (i + 0.431) / PROBES;
      double v = a->S->v0 + (a->S->v1 - a->S->v0) * (j + 0.567) / PROBES;
      CagVec3 d[9];
      CagStatus status =
          cag_surface_eval(a->S, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, call->err);
      if (!cag_geometry_ok(call, status)) return false;
      CagVec3 n = cag_cross(d[cag_partial(2, 1, 0)], d[cag_partial(2, 0, 1)]);
      double length = cag_norm(n);
      if (length == 0) continue;
      double uu = cag_dot(n, d[cag_partial(2, 2, 0)]), uv = cag_dot(n, d[cag_partial(2, 1, 1)]);
      double vv = cag_dot(n, d[cag_partial(2, 0, 2)]);
      double k = (uu * vv - uv * uv) / (length * length * length * length);
      worst = fmax(worst, fabs(k) * size * size);
    }
  *result = cag_bool(worst <= a->tolerance);
  return true;
}

bool cag_surfaces_unroll(CagCall *call, const struct cag_surfaces_unroll *a, CagValue *result) {
  CagSurface *out = NULL;
  const CagStatus status = cag_surface_unroll(a->S, &out, call->err);
  if (!cag_changed_surface_result(call, status, &out, result)) return false;
  CAG_AS_SHAPE(*result)->frames = NULL; // what is bent has no rigid frame
  return true;
}
