// B-spline surfaces from grids of points (reference 06b, 4): interpolation by two banded solutions,
// least squares by QR.

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geom/basis/bspline.h"
#include "geom/surface/family.h"
#include "geom/surface/loft.h"
#include "geom/surface/net.h"

// A diagonal element of R below this part of the largest means dependent columns.
#define RANK 1e-12
// Most numbers in the matrix of a fit whose lines have parameters of their own.
#define DENSE_MOST 50000000

// Parameters 0..end of n points with a stride; a line without length gets even ones.
static void line_parameters(const CagVec3 *p, size_t n, size_t stride, bool even, double end,
                            double *out) {
  double total = 0;
  out[0] = 0;
  for (size_t i = 1; i < n; i++) {
    total += even ? 1 : cag_norm(cag_sub(p[i * stride], p[(i - 1) * stride]));
    out[i] = total;
  }
  for (size_t i = 1; i < n; i++)
    out[i] = i + 1 == n  ? end
             : total > 0 ? out[i] / total * end
                         : end * (double)i / (double)(n - 1);
}

// out[i]: mean over all lines of a direction (0: along u).
static CagStatus mean_parameters(const CagGridData *g, int direction, double end, double *out,
                                 CagError *err) {
  size_t n = direction == 0 ? g->r : g->s, lines = direction == 0 ? g->s : g->r;
  double *one = malloc(n * sizeof *one);
  if (!one) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) out[i] = 0;
  for (size_t k = 0; k < lines; k++) {
    const CagVec3 *p = direction == 0 ? g->points + k : g->points + k * g->s;
    line_parameters(p, n, direction == 0 ? g->s : 1, g->spacing == CAG_GRID_UNIFORM, end, one);
    for (size_t i = 0; i < n; i++) out[i] += one[i] / (double)lines;
  }
  out[n - 1] = end;
  free(one);
  return CAG_OK;
}

static CagStatus check(const CagGridData *g, size_t nu, size_t nv, CagError *err) {
  const size_t points[2] = {g->r, g->s}, net[2] = {nu, nv};
  const int degree[2] = {g->degree_u, g->degree_v};
  for (int k = 0; k < 2; k++) {
    if (degree[k] < 1 || (size_t)degree[k] >= net[k])
      return cag_fail(err, CAG_E_ARGUMENT, "order-range", "degree", k,
                      "`degree` in %c must lie in 1..%zu for %zu control points, it is %d", "uv"[k],
                      net[k] - 1, net[k], degree[k]);
    if (net[k] > points[k])
      return cag_fail(err, CAG_E_ARGUMENT, "fit-underdetermined", "count", k,
                      "`count` in %c must be at most the %zu data points, it is %zu", "uv"[k],
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

CagStatus cag_surface_interpolate(const CagGridData *g, CagSurface **out, CagError *err) {
  CagStatus status = check(g, g->r, g->s, err);
  if (status) return status;
  CagNet net, across = {0};
  CagSurface *half = NULL;
  double *at = malloc((g->r + g->s) * sizeof *at);
  if (!at) return cag_fail_memory(err);
  status = mean_parameters(g, 0, 1, at, err);
  if (!status) status = mean_parameters(g, 1, 1, at + g->r, err);
  if (!status) status = cag_net_new(g->degree_u, g->r, 4 * g->s, &net, err);
  if (status) {
    free(at);
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
    // The weights were interpolated too: they are 1.
    for (size_t i = 3; !status && i < net.count * net.width; i += 4) net.data[i] = 1;
    if (!status) status = cag_net_to_surface(&net, 1, &across, out, err);
    cag_net_free(&net);
    cag_net_free(&across);
  }
  free(at);
  return status;
}

// --- Least squares ---

typedef struct Fit {
  const CagGridData *g;
  size_t nu, nv, rows, columns;
  double *ku, *kv;        // knots
  double *u, *v;          // parameters of all data
  double *matrix, *right; // column-major; right: 3 columns
  CagVec3 *net;
} Fit;

static void parameters(Fit *f) {
  const CagGridData *g = f->g;
  bool even = g->spacing == CAG_GRID_UNIFORM;
  double eu = f->ku[f->nu], ev = f->kv[f->nv];
  for (size_t p = 0; p < g->r; p++)
    line_parameters(g->points + p * g->s, g->s, 1, even, ev, f->v + p * g->s);
  // Columns are gathered into the matrix's room, which is not yet used.
  for (size_t q = 0; q < g->s; q++) {
    line_parameters(g->points + q, g->r, g->s, even, eu, f->matrix);
    for (size_t p = 0; p < g->r; p++) f->u[p * g->s + q] = f->matrix[p];
  }
  if (g->spacing != CAG_GRID_MEAN) return;
  for (size_t p = 0; p < g->r; p++) {
    double sum = 0;
    for (size_t q = 0; q < g->s; q++) sum += f->u[p * g->s + q];
    for (size_t q = 0; q < g->s; q++) f->u[p * g->s + q] = p + 1 == g->r ? eu : sum / (double)g->s;
  }
  for (size_t q = 0; q < g->s; q++) {
    double sum = 0;
    for (size_t p = 0; p < g->r; p++) sum += f->v[p * g->s + q];
    for (size_t p = 0; p < g->r; p++) f->v[p * g->s + q] = q + 1 == g->s ? ev : sum / (double)g->r;
  }
}

static void fill(Fit *f) {
  const CagGridData *g = f->g;
  size_t p = (size_t)g->degree_u, q = (size_t)g->degree_v;
  double bu[32], bv[32];
  memset(f->matrix, 0, f->rows * f->columns * sizeof *f->matrix);
  for (size_t row = 0; row < f->rows; row++) {
    double u = f->u[row], v = f->v[row];
    size_t su = cag_knots_span(f->ku, f->nu, g->degree_u, u, u >= f->ku[f->nu], p);
    size_t sv = cag_knots_span(f->kv, f->nv, g->degree_v, v, v >= f->kv[f->nv], q);
    cag_bspline_basis(f->ku, g->degree_u, su, u, bu);
    cag_bspline_basis(f->kv, g->degree_v, sv, v, bv);
    for (size_t i = 0; i <= p; i++)
      for (size_t j = 0; j <= q; j++) {
        size_t column = (su - p + i) * f->nv + sv - q + j;
        f->matrix[column * f->rows + row] = bu[i] * bv[j];
      }
    f->right[row] = g->points[row].x;
    f->right[f->rows + row] = g->points[row].y;
    f->right[2 * f->rows + row] = g->points[row].z;
  }
}

static CagStatus solve(Fit *f, CagError *err) {
  lapack_int info =
      LAPACKE_dgels(LAPACK_COL_MAJOR, 'N', (lapack_int)f->rows, (lapack_int)f->columns, 3,
                    f->matrix, (lapack_int)f->rows, f->right, (lapack_int)f->rows);
  double most = 0, least = INFINITY;
  for (size_t i = 0; i < f->columns; i++) {
    double r = fabs(f->matrix[i * f->rows + i]);
    most = fmax(most, r);
    least = fmin(least, r);
  }
  if (info != 0 || !(least > RANK * most))
    return cag_fail(err, CAG_E_DEGENERATE, "fit-singular", "count", -1,
                    "the data do not determine all control points: take fewer, a lower degree, or "
                    "data that are spread more evenly");
  for (size_t i = 0; i < f->columns; i++)
    f->net[i] = cag_vec3(f->right[i], f->right[f->rows + i], f->right[2 * f->rows + i]);
  return CAG_OK;
}

static CagStatus deviations(const Fit *f, const CagSurface *s, double *rms, double *largest,
                            CagError *err) {
  double sum = 0, most = 0;
  for (size_t i = 0; i < f->rows; i++) {
    CagVec3 p;
    CagStatus status = cag_surface_point(s, f->u[i], f->v[i], &p, err);
    if (status) return status;
    double d = cag_norm(cag_sub(p, f->g->points[i]));
    sum += d * d;
    most = fmax(most, d);
  }
  if (rms) *rms = sqrt(sum / (double)f->rows);
  if (largest) *largest = most;
  return CAG_OK;
}

CagStatus cag_surface_fit(const CagGridData *g, size_t nu, size_t nv, CagSurface **out, double *rms,
                          double *largest, CagError *err) {
  CagStatus status = check(g, nu, nv, err);
  if (status) return status;
  Fit f = {.g = g, .nu = nu, .nv = nv, .rows = g->r * g->s, .columns = nu * nv};
  if (f.rows > DENSE_MOST / f.columns)
    return cag_fail(err, CAG_E_LIMIT, "fit-too-large", "count", -1,
                    "`count` times the data are more than can be solved at once: %zu unknowns for "
                    "%zu points; take fewer control points or fit parts",
                    f.columns, f.rows);
  f.ku = malloc((nu + (size_t)g->degree_u + 1) * sizeof *f.ku);
  f.kv = malloc((nv + (size_t)g->degree_v + 1) * sizeof *f.kv);
  f.u = malloc(f.rows * sizeof *f.u);
  f.v = malloc(f.rows * sizeof *f.v);
  f.matrix = malloc(f.rows * f.columns * sizeof *f.matrix);
  f.right = malloc(3 * f.rows * sizeof *f.right);
  f.net = malloc(f.columns * sizeof *f.net);
  if (!f.ku || !f.kv || !f.u || !f.v || !f.matrix || !f.right || !f.net)
    status = cag_fail_memory(err);
  if (!status) {
    cag_knots_open(nu, g->degree_u, f.ku);
    cag_knots_open(nv, g->degree_v, f.kv);
    parameters(&f);
    fill(&f);
    status = solve(&f, err);
  }
  if (!status)
    status = cag_surface_nurbs(f.net, NULL, nu, nv, g->degree_u, g->degree_v, f.ku, f.kv, out, err);
  if (!status && (rms || largest)) {
    status = deviations(&f, *out, rms, largest, err);
    if (status) cag_surface_release(*out);
  }
  free(f.ku);
  free(f.kv);
  free(f.u);
  free(f.v);
  free(f.matrix);
  free(f.right);
  free(f.net);
  return status;
}
