// B-spline surfaces from grids of points (Piegl and Tiller 1997, chapter 9): interpolation by two
// banded solutions, least squares by alternating between solving for the control net and moving the
// parameters.

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/knots.h"
#include "geom/surface/family.h"
#include "geom/surface/grid_fit.h"
#include "geom/surface/net.h"

// Parameters 0..end of n points with a stride; equally spaced for a line of zero length. For a
// closed line the distance back to the first point counts too, so that the last parameter is less
// than the end.
static void line_parameters(const CagVec3 *p, size_t n, size_t stride, bool even, bool closed,
                            double end, double *out, size_t step) {
  double total = 0;
  out[0] = 0;
  for (size_t i = 1; i < n; i++) {
    total += even ? 1 : cag_norm(cag_sub(p[i * stride], p[(i - 1) * stride]));
    out[i * step] = total;
  }
  if (closed) total += even ? 1 : cag_norm(cag_sub(p[0], p[(n - 1) * stride]));
  size_t parts = closed ? n : n - 1;
  for (size_t i = 1; i < n; i++)
    out[i * step] = i == parts  ? end
                    : total > 0 ? out[i * step] / total * end
                                : end * (double)i / (double)parts;
}

// out[i]: mean over all lines of a direction (0: along u).
static CagStatus mean_parameters(const CagGridData *g, int direction, double end, double *out,
                                 CagError *err) {
  size_t n = direction == 0 ? g->r : g->s, lines = direction == 0 ? g->s : g->r;
  double *one = cag_malloc(n * sizeof *one);
  if (!one) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) out[i] = 0;
  for (size_t k = 0; k < lines; k++) {
    const CagVec3 *p = direction == 0 ? g->points + k : g->points + k * g->s;
    line_parameters(p, n, direction == 0 ? g->s : 1, g->spacing == CAG_GRID_UNIFORM, false, end,
                    one, 1);
    for (size_t i = 0; i < n; i++) out[i] += one[i] / (double)lines;
  }
  out[n - 1] = end;
  cag_free(one);
  return CAG_OK;
}

static CagStatus check(const CagGridData *g, size_t nu, size_t nv, CagError *err) {
  const size_t points[2] = {g->r, g->s}, net[2] = {nu, nv};
  const int degree[2] = {g->degree_u, g->degree_v};
  for (int k = 0; k < 2; k++) {
    if (points[k] < 2)
      return cag_fail(
          err, CAG_E_ARGUMENT, CAG_ERR_order_range, "grid", k,
          "a surface needs at least 2 rows of at least 2 points, but in %c there %s %zu", "uv"[k],
          points[k] == 1 ? "is" : "are", points[k]);
    if (net[k] < 2)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "count", k,
                      "a surface needs at least 2 control points in %c, found a `count` of %zu",
                      "uv"[k], net[k]);
    if (degree[k] < 1 || degree[k] > CAG_GRID_DEGREE_MOST || (size_t)degree[k] >= net[k])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", k,
                      "`degree` in %c must lie in 1..%zu for %zu control points, found %d", "uv"[k],
                      net[k] - 1, net[k], degree[k]);
    if (net[k] > points[k])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_fit_underdetermined, "count", k,
                      "`count` in %c must be at most the %zu data points, found %zu", "uv"[k],
                      points[k], net[k]);
  }
  return CAG_OK;
}

static void load(CagNet *net, const CagVec3 *points, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double *h = net->data + 4 * i;
    h[0] = points[i].x;
    h[1] = points[i].y;
    h[2] = points[i].z;
    h[3] = 1;
  }
}

// For open directions and parameters shared by all lines: two banded solutions.
static CagStatus interpolate_banded(const CagGridData *g, CagSurface **out, CagError *err) {
  CagStatus status;
  CagNet net, across = {0};
  CagSurface *half = NULL;
  double *at = cag_malloc((g->r + g->s) * sizeof *at);
  if (!at) return cag_fail_memory(err);
  status = mean_parameters(g, 0, 1, at, err);
  if (!status) status = mean_parameters(g, 1, 1, at + g->r, err);
  if (!status) status = cag_net_new(g->degree_u, g->r, 4 * g->s, &net, err);
  if (status) {
    cag_free(at);
    return status;
  }
  status = cag_net_new(g->degree_v, g->s, 0, &across, err);
  if (!status) {
    load(&net, g->points, g->r * g->s);
    cag_net_averaged_knots(at, g->r, g->degree_u, net.knots);
    cag_net_averaged_knots(at + g->r, g->s, g->degree_v, across.knots);
    status = cag_net_interpolate(&net, at, err);
  }
  if (!status) status = cag_net_to_surface(&net, 0, &across, &half, err);
  cag_net_free(&net);
  cag_net_free(&across);
  if (!status) status = cag_net_of_surface(half, 1, &net, &across, err);
  cag_surface_release(half);
  if (!status) {
    status = cag_net_interpolate(&net, at + g->r, err);
    // The weights were interpolated too; set them to exactly 1.
    for (size_t i = 3; !status && i < net.count * net.width; i += 4) net.data[i] = 1;
    if (!status) status = cag_net_to_surface(&net, 1, &across, out, err);
    cag_net_free(&net);
    cag_net_free(&across);
  }
  cag_free(at);
  return status;
}

// --- Parameters ---

static void spread(double *x, size_t r, size_t s, size_t i, size_t j, bool rows) {
  for (size_t k = 0; k < (rows ? s : r); k++) x[rows ? i * s + k : k * s + j] = x[i * s + j];
}

// Replaces the parameters of all lines by their mean.
static void average(double *x, size_t r, size_t s, bool over_columns, bool closed, double end) {
  for (size_t i = 0; i < (over_columns ? r : s); i++) {
    size_t lines = over_columns ? s : r, n = over_columns ? r : s;
    double sum = 0;
    for (size_t k = 0; k < lines; k++) sum += x[over_columns ? i * s + k : k * s + i];
    size_t first = over_columns ? i * s : i;
    x[first] = i + 1 == n && !closed ? end : sum / (double)lines;
    if (over_columns) spread(x, r, s, i, 0, true);
    else spread(x, r, s, 0, i, false);
  }
}

void cag_grid_parameters(const CagGridData *g, const double end[2], double *u, double *v) {
  bool even = g->spacing == CAG_GRID_UNIFORM;
  for (size_t q = 0; q < g->s; q++)
    line_parameters(g->points + q, g->r, g->s, even, g->closed[0], end[0], u + q, g->s);
  for (size_t p = 0; p < g->r; p++)
    line_parameters(g->points + p * g->s, g->s, 1, even, g->closed[1], end[1], v + p * g->s, 1);
  if (g->spacing != CAG_GRID_MEAN) return;
  average(u, g->r, g->s, true, g->closed[0], end[0]);
  average(v, g->r, g->s, false, g->closed[1], end[1]);
}

void cag_grid_report_free(CagGridReport *report) {
  cag_free(report->u);
  cag_free(report->v);
  cag_free(report->planes);
  *report = (CagGridReport){0};
}

// --- Least squares ---

// The first parameter of a closed direction, determined by its spacing.
static double phase(const CagGridAxis *a) { return a->degree % 2 == 0 ? 0.5 : 0; }

static CagStatus make_axis(const CagGridData *g, int k, size_t count, CagGridAxis *a,
                           CagError *err) {
  int degree = k ? g->degree_v : g->degree_u;
  *a = (CagGridAxis){degree, count, count, g->closed[k], NULL};
  if (a->closed) a->stored += (size_t)degree;
  size_t n = a->stored + (size_t)degree + 1;
  a->knots = cag_malloc(n * sizeof *a->knots);
  if (!a->knots) return cag_fail_memory(err);
  if (a->closed)
    for (size_t i = 0; i < n; i++) a->knots[i] = (double)i - degree;
  else if (g->knots[k]) memcpy(a->knots, g->knots[k], n * sizeof *a->knots);
  else cag_knots_open(count, degree, a->knots);
  return a->closed ? CAG_OK : cag_knots_check(a->knots, count, degree, err);
}

static CagStatus deviations(const CagGridFit *f, const CagSurface *s, CagGridReport *report,
                            CagError *err) {
  double sum = 0, most = 0;
  for (size_t i = 0; i < f->rows; i++) {
    CagVec3 p;
    CagStatus status = cag_surface_point(s, f->parameters[0][i], f->parameters[1][i], &p, err);
    if (status) return status;
    double d = cag_norm(cag_sub(p, f->g->points[i]));
    sum += d * d;
    most = fmax(most, d);
  }
  report->rms = sqrt(sum / (double)f->rows);
  report->largest = most;
  return CAG_OK;
}

// --- Parameter correction ---

double cag_grid_moved(const CagGridAxis *a, double t, double step) {
  double lo = cag_grid_start(a), hi = cag_grid_end(a);
  if (a->closed) {
    t = fmod(t + step - lo, hi - lo);
    return lo + (t < 0 ? t + hi - lo : t);
  }
  return fmin(fmax(t + step, lo), hi);
}

bool cag_grid_on_border(const CagGridFit *f, size_t i, int direction) {
  const size_t line = direction == 0 ? i / f->g->s : i % f->g->s;
  return !f->axis[direction].closed &&
         (line == 0 || line + 1 == (direction == 0 ? f->g->r : f->g->s));
}

// If the square of a partial is below this fraction of the other's, the row has collapsed to a
// point.
#define AT_ONE_PLACE (CAG_GRID_RANK * CAG_GRID_RANK)

// One Gauss-Newton step of all data towards the nearest points. Data on an open border stay there,
// so that the surface keeps its edges.
static CagStatus correct(CagGridFit *f, const CagSurface *s, CagError *err) {
  const CagGridAxis *au = &f->axis[0], *av = &f->axis[1];
  for (size_t i = 0; i < f->rows; i++) {
    CagVec3 d[4];
    double *u = &f->parameters[0][i], *v = &f->parameters[1][i];
    CagStatus status = cag_surface_eval(s, *u, *v, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    CagVec3 gap = cag_sub(f->g->points[i], d[0]), du = d[cag_partial(1, 1, 0)],
            dv = d[cag_partial(1, 0, 1)];
    bool fixed_u = cag_grid_on_border(f, i, 0), fixed_v = cag_grid_on_border(f, i, 1);
    double e = cag_dot(du, du), m = cag_dot(du, dv), g = cag_dot(dv, dv);
    double p = cag_dot(gap, du), q = cag_dot(gap, dv), det = e * g - m * m;
    if (fixed_u && fixed_v) continue;
    if (fixed_u) *v = cag_grid_moved(av, *v, g > AT_ONE_PLACE * e ? q / g : 0);
    else if (fixed_v) *u = cag_grid_moved(au, *u, e > AT_ONE_PLACE * g ? p / e : 0);
    else if (det > CAG_GRID_RANK * e * g) {
      *u = cag_grid_moved(au, *u, (p * g - q * m) / det);
      *v = cag_grid_moved(av, *v, (q * e - p * m) / det);
    }
  }
  return CAG_OK;
}

// Iteration stops when the residual decreases by less than this fraction.
#define LEAST_GAIN 1e-6

static CagStatus move_parameters(CagGridFit *f, const CagSurface *s, CagError *err) {
  return f->held ? cag_grid_correct_held(f, s, err) : correct(f, s, err);
}

static CagStatus improve(CagGridFit *f, CagSurface **s, CagGridReport *report, CagError *err) {
  double *kept[2];
  CagStatus status = CAG_OK;
  for (int k = 0; k < 2; k++) kept[k] = cag_malloc(f->rows * sizeof(double));
  if (!kept[0] || !kept[1]) status = cag_fail_memory(err);
  for (int round = 0; !status && round < f->g->corrections; round++) {
    CagGridReport next = {0};
    CagSurface *better;
    CagError ignored;
    for (int k = 0; k < 2; k++) memcpy(kept[k], f->parameters[k], f->rows * sizeof(double));
    bool good = !move_parameters(f, *s, &ignored) && !cag_grid_surface(f, &better, &ignored);
    if (good) status = deviations(f, better, &next, err);
    if (!good || status || !(next.rms < report->rms * (1 - LEAST_GAIN))) {
      if (good) cag_surface_release(better);
      for (int k = 0; k < 2; k++) memcpy(f->parameters[k], kept[k], f->rows * sizeof(double));
      break;
    }
    cag_surface_release(*s);
    *s = better;
    report->rms = next.rms;
    report->largest = next.largest;
    report->rounds++;
  }
  cag_free(kept[0]);
  cag_free(kept[1]);
  return status;
}

// --- The complete fit ---

static CagStatus take_parameters(CagGridFit *f, CagError *err) {
  const CagGridData *g = f->g;
  double end[2];
  for (int k = 0; k < 2; k++) end[k] = cag_grid_end(&f->axis[k]) - cag_grid_start(&f->axis[k]);
  cag_grid_parameters(g, end, f->parameters[0], f->parameters[1]);
  for (int k = 0; k < 2; k++) {
    const CagGridAxis *a = &f->axis[k];
    double lo = cag_grid_start(a), hi = cag_grid_end(a), same = CAG_GRID_RANK * (hi - lo);
    for (size_t i = 0; i < f->rows; i++) {
      double *t = &f->parameters[k][i];
      char text[32], from[32], to[32];
      // The last is exactly the end, which the sum may miss by rounding.
      *t = g->parameters[k] ? g->parameters[k][i]
           : a->closed      ? cag_grid_moved(a, lo + *t, phase(a))
           : *t == end[k]   ? hi
                            : lo + *t;
      if (!(*t >= lo - same && *t <= hi + same))
        return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "parameters", (long)i,
                        "`parameters` in %c must lie in %s..%s, but that of point [%zu, %zu] is %s",
                        "uv"[k], cag_number_text(lo, from), cag_number_text(hi, to), i / g->s,
                        i % g->s, cag_number_text(*t, text));
      *t = fmin(fmax(*t, lo), hi);
    }
  }
  return CAG_OK;
}

static void fit_free(CagGridFit *f) {
  for (int k = 0; k < 2; k++) {
    cag_free(f->axis[k].knots);
    cag_free(f->parameters[k]);
  }
  cag_free(f->net);
  cag_free(f->held);
  cag_free(f->planes);
}

CagStatus cag_surface_fit(const CagGridData *g, size_t nu, size_t nv, CagSurface **out,
                          CagGridReport *report, CagError *err) {
  CagStatus status = check(g, nu, nv, err);
  if (status) return status;
  CagGridFit f = {.g = g, .rows = g->r * g->s};
  CagGridReport own = {0};
  status = make_axis(g, 0, nu, &f.axis[0], err);
  if (!status) status = make_axis(g, 1, nv, &f.axis[1], err);
  for (int k = 0; k < 2; k++) f.parameters[k] = cag_malloc(f.rows * sizeof(double));
  f.net = cag_malloc(nu * nv * sizeof *f.net);
  if (!status && (!f.parameters[0] || !f.parameters[1] || !f.net)) status = cag_fail_memory(err);
  if (!status) status = take_parameters(&f, err);
  CagSurface *s = NULL;
  if (!status && g->hold) status = cag_grid_hold(&f, &own.rounds, err);
  if (!status) status = cag_grid_surface(&f, &s, err);
  if (!status) status = deviations(&f, s, &own, err);
  if (!status) status = improve(&f, &s, &own, err);
  if (!status && report) {
    own.u = f.parameters[0];
    own.v = f.parameters[1];
    own.planes = f.planes;
    own.planes_along = f.planes_along;
    f.parameters[0] = f.parameters[1] = f.planes = NULL;
    *report = own;
  }
  if (!status) *out = s;
  else if (s) cag_surface_release(s);
  fit_free(&f);
  return status;
}

// Knots of an open direction suitable for interpolation: means of the parameters, which are those
// of the first line if they were given.
static CagStatus interpolation_knots(const CagGridData *g, int k, double **out, CagError *err) {
  size_t n = k ? g->s : g->r;
  int degree = k ? g->degree_v : g->degree_u;
  double *at = cag_malloc(n * sizeof *at);
  *out = cag_malloc((n + (size_t)degree + 1) * sizeof **out);
  CagStatus status = at && *out ? CAG_OK : cag_fail_memory(err);
  if (!status && !g->parameters[k]) status = mean_parameters(g, k, 1, at, err);
  for (size_t i = 0; !status && g->parameters[k] && i < n; i++) {
    at[i] = g->parameters[k][k ? i : i * g->s];
    if (i > 0 && !(at[i] > at[i - 1]))
      status =
          cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone, "parameters", (long)i,
                   "`parameters` in %c must increase from point to point, but number %zu does not",
                   "uv"[k], i);
  }
  if (!status) cag_net_averaged_knots(at, n, degree, *out);
  cag_free(at);
  return status;
}

CagStatus cag_surface_interpolate_report(const CagGridData *g, CagSurface **out,
                                         CagGridReport *report, CagError *err) {
  CagGridData all = *g;
  double *knots[2] = {NULL, NULL};
  CagStatus status = check(g, g->r, g->s, err);
  if (status) return status;
  if (all.spacing == CAG_GRID_CHORD) all.spacing = CAG_GRID_MEAN;
  all.corrections = 0;
  all.hold = CAG_GRID_HOLD_NONE;
  for (int k = 0; !status && k < 2; k++)
    if (!g->closed[k] && !g->knots[k]) {
      status = interpolation_knots(g, k, &knots[k], err);
      all.knots[k] = knots[k];
    }
  if (!status) status = cag_surface_fit(&all, g->r, g->s, out, report, err);
  cag_free(knots[0]);
  cag_free(knots[1]);
  return status;
}

CagStatus cag_surface_interpolate(const CagGridData *g, CagSurface **out, CagError *err) {
  CagStatus status = check(g, g->r, g->s, err);
  if (status) return status;
  bool plain = true;
  for (int k = 0; k < 2; k++) plain = plain && !g->closed[k] && !g->knots[k] && !g->parameters[k];
  return plain ? interpolate_banded(g, out, err)
               : cag_surface_interpolate_report(g, out, NULL, err);
}
