// The control net of a fit to a grid of points, by Householder QR. If all lines share their
// parameters, the matrix is a product of one in u and one in v, which are solved one after the
// other; otherwise it is solved as a whole.
//
// With fixed edges the corners are those of the data, and each edge is fitted only to its border of
// the data; known values move to the right-hand sides. That is also a product if the matrix is,
// since the residual of an edge is orthogonal to the rest of its basis.

#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/basis/bspline.h"
#include "geom/basis/knots.h"
#include "geom/linalg/dense.h"
#include "geom/surface/family.h"
#include "geom/surface/grid_fit.h"

// Maximum size of the matrix of a fit whose lines have separate parameters.
#define DENSE_MOST 50000000

// Values of the basis at t, folded onto the distinct points: entries of `row` with a stride.
static void fill_row(const CagGridAxis *a, double t, double *row, size_t stride) {
  double basis[CAG_GRID_DEGREE_MOST + 1];
  size_t p = (size_t)a->degree;
  size_t span = cag_knots_span(a->knots, a->stored, a->degree, t, t >= cag_grid_end(a), p);
  cag_bspline_basis(a->knots, a->degree, span, t, basis);
  for (size_t i = 0; i <= p; i++) row[(span - p + i) % a->count * stride] += basis[i];
}

static CagStatus fail_singular(CagError *err) {
  return cag_fail(
      err, CAG_E_DEGENERATE, CAG_ERR_fit_singular, "count", -1,
      "the data do not determine all control points: use fewer, a lower degree, other knots, or data that are spread more evenly");
}

// Least squares of a column-major matrix; the first `columns` rows of `right` become the solution.
static CagStatus solve(double *matrix, size_t rows, size_t columns, double *right, size_t sides,
                       CagError *err) {
  if (columns == 0) return CAG_OK;
  lapack_int info = 0;
  if ((double)rows * (double)columns * (double)(columns + sides) > CAG_LAPACK_MOST) {
    CagStatus status = cag_least_squares(matrix, rows, columns, right, rows, sides, NULL, err);
    if (status) return status;
  } else {
    info = LAPACKE_dgels(LAPACK_COL_MAJOR, 'N', (lapack_int)rows, (lapack_int)columns,
                         (lapack_int)sides, matrix, (lapack_int)rows, right, (lapack_int)rows);
  }
  double most = 0, least = INFINITY;
  for (size_t i = 0; i < columns; i++) {
    double r = fabs(matrix[i * rows + i]);
    most = fmax(most, r);
    least = fmin(least, r);
  }
  return info == 0 && least > CAG_GRID_RANK * most ? CAG_OK : fail_singular(err);
}

// All lines have the same parameters in both directions: the matrix is a product of two small ones.
static bool is_product(const CagGridFit *f) {
  size_t s = f->g->s;
  for (size_t i = 0; i < f->rows; i++)
    if (f->parameters[0][i] != f->parameters[0][i / s * s] ||
        f->parameters[1][i] != f->parameters[1][i % s])
      return false;
  return true;
}

// --- One direction ---

static bool keeps_ends(const CagGridFit *f, int k) { return f->edges && !f->axis[k].closed; }

// Replaces the first rows of `lines` lines of n data each (data[i * lines + line]) by their control
// points. With `ends` the first and last are the first and last data.
static CagStatus solve_lines(const CagGridAxis *a, bool ends, const double *parameters,
                             size_t stride, size_t n, CagVec3 *data, size_t lines, CagError *err) {
  const size_t skip = ends ? 1 : 0, unknown = a->count - 2 * skip;
  double *matrix = cag_calloc(n * a->count, sizeof *matrix);
  double *right = cag_malloc(3 * n * lines * sizeof *right);
  CagVec3 *last = cag_malloc(lines * sizeof *last);
  CagStatus status = matrix && right && last ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    if ((status = cag_stop_check(err)) != CAG_OK) break;
    double *row = matrix + i, known[2] = {0, 0};
    fill_row(a, parameters[i * stride], row, n);
    if (ends) {
      known[0] = row[0];
      known[1] = row[(a->count - 1) * n];
    }
    for (size_t l = 0; l < lines; l++) {
      CagVec3 value = cag_madd(data[i * lines + l], -known[0], data[l]);
      value = cag_madd(value, -known[1], data[(n - 1) * lines + l]);
      right[(3 * l) * n + i] = value.x;
      right[(3 * l + 1) * n + i] = value.y;
      right[(3 * l + 2) * n + i] = value.z;
    }
  }
  if (!status) status = solve(matrix + skip * n, n, unknown, right, 3 * lines, err);
  if (!status) memcpy(last, data + (n - 1) * lines, lines * sizeof *last);
  for (size_t i = 0; !status && i < unknown; i++)
    for (size_t l = 0; l < lines; l++)
      data[(i + skip) * lines + l] =
          cag_vec3(right[(3 * l) * n + i], right[(3 * l + 1) * n + i], right[(3 * l + 2) * n + i]);
  if (!status && ends) memcpy(data + (a->count - 1) * lines, last, lines * sizeof *last);
  cag_free(matrix);
  cag_free(right);
  cag_free(last);
  return status;
}

static CagStatus solve_product(CagGridFit *f, CagError *err) {
  size_t r = f->g->r, s = f->g->s, nu = f->axis[0].count, nv = f->axis[1].count;
  CagVec3 *data = cag_malloc(r * s * sizeof *data), *turned = cag_malloc(nu * s * sizeof *turned);
  CagStatus status = data && turned ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    memcpy(data, f->g->points, r * s * sizeof *data);
    status = solve_lines(&f->axis[0], keeps_ends(f, 0), f->parameters[0], s, r, data, s, err);
  }
  for (size_t i = 0; !status && i < nu; i++)
    for (size_t q = 0; q < s; q++) turned[q * nu + i] = data[i * s + q];
  if (!status)
    status = solve_lines(&f->axis[1], keeps_ends(f, 1), f->parameters[1], 1, s, turned, nu, err);
  for (size_t i = 0; !status && i < nu; i++)
    for (size_t j = 0; j < nv; j++) f->net[i * nv + j] = turned[j * nu + i];
  cag_free(data);
  cag_free(turned);
  return status;
}

// --- As a whole ---

// The edge with direction k at its first or last row, as a curve in the other direction.
static CagStatus solve_edge(CagGridFit *f, int k, bool last, CagVec3 *line, CagError *err) {
  const size_t s = f->g->s, nv = f->axis[1].count;
  const size_t n = k == 0 ? s : f->g->r, stride = k == 0 ? 1 : s;
  const size_t first = !last ? 0 : k == 0 ? (f->g->r - 1) * s : s - 1;
  for (size_t i = 0; i < n; i++) line[i] = f->g->points[first + i * stride];
  CagStatus status = solve_lines(&f->axis[1 - k], keeps_ends(f, 1 - k),
                                 f->parameters[1 - k] + first, stride, n, line, 1, err);
  const size_t corner = !last ? 0 : k == 0 ? (f->axis[0].count - 1) * nv : nv - 1;
  for (size_t i = 0; !status && i < f->axis[1 - k].count; i++)
    f->net[corner + i * (k == 0 ? 1 : nv)] = line[i];
  return status;
}

static CagStatus solve_edges(CagGridFit *f, CagError *err) {
  CagVec3 *line = cag_malloc((f->g->r + f->g->s) * sizeof *line);
  CagStatus status = line ? CAG_OK : cag_fail_memory(err);
  for (int k = 0; k < 2; k++)
    for (int last = 0; !status && keeps_ends(f, k) && last < 2; last++)
      status = solve_edge(f, k, last, line, err);
  cag_free(line);
  return status;
}

// Whether a control point belongs to an edge that has been solved already.
static bool on_edge(const CagGridFit *f, size_t i, size_t j) {
  return (keeps_ends(f, 0) && (i == 0 || i + 1 == f->axis[0].count)) ||
         (keeps_ends(f, 1) && (j == 0 || j + 1 == f->axis[1].count));
}

// The row of a data point; known values go to the right-hand side.
static void fill_dense(const CagGridFit *f, size_t row, double *basis, double *matrix,
                       double *right) {
  const size_t nu = f->axis[0].count, nv = f->axis[1].count, rows = f->rows;
  double *bu = basis, *bv = basis + nu;
  CagVec3 value = f->g->points[row];
  memset(basis, 0, (nu + nv) * sizeof *basis);
  fill_row(&f->axis[0], f->parameters[0][row], bu, 1);
  fill_row(&f->axis[1], f->parameters[1][row], bv, 1);
  size_t column = 0;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      if (on_edge(f, i, j)) value = cag_madd(value, -bu[i] * bv[j], f->net[i * nv + j]);
      else matrix[column++ * rows + row] = bu[i] * bv[j];
    }
  right[row] = value.x;
  right[rows + row] = value.y;
  right[2 * rows + row] = value.z;
}

static CagStatus solve_dense(CagGridFit *f, CagError *err) {
  size_t nu = f->axis[0].count, nv = f->axis[1].count, columns = nu * nv, rows = f->rows;
  if (rows > DENSE_MOST / columns)
    return cag_fail(
        err, CAG_E_LIMIT, CAG_ERR_fit_too_large, "count", -1,
        "the fit is too large, with %zu unknowns for %zu points; use fewer control points, fit parts of the data, or use the \"mean\" parameters",
        columns, rows);
  double *matrix = cag_malloc(rows * columns * sizeof *matrix);
  double *right = cag_malloc(3 * rows * sizeof *right),
         *basis = cag_malloc((nu + nv) * sizeof *basis);
  CagStatus status = matrix && right && basis ? CAG_OK : cag_fail_memory(err);
  if (!status) status = solve_edges(f, err);
  for (size_t row = 0; !status && row < rows; row++) {
    fill_dense(f, row, basis, matrix, right);
    status = cag_stop_check(err);
  }
  size_t unknown = 0;
  for (size_t i = 0; i < columns; i++) unknown += !on_edge(f, i / nv, i % nv);
  if (!status) status = solve(matrix, rows, unknown, right, 3, err);
  for (size_t i = 0, k = 0; !status && i < columns; i++) {
    if (on_edge(f, i / nv, i % nv)) continue;
    f->net[i] = cag_vec3(right[k], right[rows + k], right[2 * rows + k]);
    k++;
  }
  cag_free(matrix);
  cag_free(right);
  cag_free(basis);
  return status;
}

// Edges end in the data only if knots are clamped and the border has the end parameters.
static CagStatus check_edges(const CagGridFit *f, CagError *err) {
  for (int k = 0; k < 2; k++) {
    const CagGridAxis *a = &f->axis[k];
    const size_t p = (size_t)a->degree;
    if (!keeps_ends(f, k)) continue;
    if (a->knots[0] != a->knots[p] || a->knots[a->count] != a->knots[a->count + p])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_fit_ends, "knots", k,
                      "the edges stay fixed only where the end knots in %c occur %zu times; repeat "
                      "them, give the control points `planes`, or set `fixed` to \"none\"",
                      "uv"[k], p + 1);
    for (size_t i = 0; i < f->rows; i++) {
      const size_t line = k == 0 ? i / f->g->s : i % f->g->s;
      const bool first = line == 0, last = line + 1 == (k == 0 ? f->g->r : f->g->s);
      if ((first && f->parameters[k][i] != cag_grid_start(a)) ||
          (last && f->parameters[k][i] != cag_grid_end(a)))
        return cag_fail(
            err, CAG_E_ARGUMENT, CAG_ERR_fit_ends, "parameters", (long)i,
            "the edges stay fixed only where the data's border has the first and last parameter in %c, but point [%zu, %zu] does not; give the control points `planes`, or set `fixed` to \"none\"",
            "uv"[k], i / f->g->s, i % f->g->s);
    }
  }
  return CAG_OK;
}

CagStatus cag_grid_solve(CagGridFit *f, CagError *err) {
  CagStatus status = check_edges(f, err);
  if (status) return status;
  status = is_product(f) ? solve_product(f, err) : solve_dense(f, err);
  for (size_t i = 0; !status && f->held && i < f->axis[0].count * f->axis[1].count; i++)
    *cag_grid_coordinate(f, &f->net[i]) = f->held[i];
  return status;
}

CagStatus cag_grid_surface(CagGridFit *f, CagSurface **out, CagError *err) {
  const CagGridAxis *u = &f->axis[0], *v = &f->axis[1];
  CagStatus status = cag_grid_solve(f, err);
  if (status) return status;
  return cag_surface_nurbs_closed(f->net, NULL, u->count, v->count, u->degree, v->degree,
                                  u->closed ? NULL : u->knots, v->closed ? NULL : v->knots,
                                  u->closed, v->closed, out, err);
}
