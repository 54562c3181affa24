// Cells of a surface with lower bounds of their distances from a point.

#include "geom/surface/nearest_cells.h"

#include <float.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/basis/bspline.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/nearest_swept.h"

// Number of cells of a sampled patch in each direction, for surfaces with few and with many
// patches.
#define CELLS_FEW 6
#define CELLS_MANY 2
#define PATCHES_FEW 16
// Samples of a cell in each direction. The biquadratic polynomial interpolates the first, the
// third, and the last; the others are placed away from common nodes of waves.
#define SAMPLES 5
static const double SAMPLE[SAMPLES] = {0, 0.21, 0.5, 0.83, 1};
// Safety factor for the difference between the sampled distance and the polynomial.
#define SAFETY 2
// Rounding of a squared distance, in units of that of the largest term.
#define ROUNDING (8 * DBL_EPSILON)

// --- The heap and its blocks ---

static void sink(CagDistanceCells *c, size_t i) {
  const CagDistanceCell moved = c->items[i];
  for (size_t child; (child = 2 * i + 1) < c->count; i = child) {
    if (child + 1 < c->count && c->items[child + 1].bound < c->items[child].bound) child++;
    if (!(c->items[child].bound < moved.bound)) break;
    c->items[i] = c->items[child];
  }
  c->items[i] = moved;
}

CagStatus cag_distance_cells_push(CagDistanceCells *c, const CagDistanceCell *cell, CagError *err) {
  if (!CAG_RESERVE(c->items, c->capacity, c->count + 1)) return cag_fail_memory(err);
  size_t i = c->count++;
  for (; i > 0 && cell->bound < c->items[(i - 1) / 2].bound; i = (i - 1) / 2)
    c->items[i] = c->items[(i - 1) / 2];
  c->items[i] = *cell;
  return CAG_OK;
}

// Allocates a block for the control points of a cell. Blocks may move when their number grows.
static CagStatus take_block(CagDistanceCells *c, size_t *block, CagError *err) {
  if (c->unused_count > 0) {
    *block = c->unused[--c->unused_count];
    return CAG_OK;
  }
  if (c->block_count == c->block_capacity) {
    const size_t capacity = c->block_capacity ? 2 * c->block_capacity : 32;
    double *grown = cag_realloc(c->blocks, capacity * c->block_size * sizeof *grown);
    if (!grown) return cag_fail_memory(err);
    c->blocks = grown;
    if (!CAG_RESIZE(c->unused, capacity)) return cag_fail_memory(err);
    c->block_capacity = capacity;
  }
  *block = c->block_count++;
  return CAG_OK;
}

void cag_distance_cells_drop(CagDistanceCells *c, const CagDistanceCell *cell) {
  if (c->exact && !cell->raw) c->unused[c->unused_count++] = cell->block;
}

// --- Bezier patches ---

static double squared(const double *h) { return h[0] * h[0] + h[1] * h[1] + h[2] * h[2]; }

// Coefficients of the squared distance times the squared weight, and of the squared weight.
static void square_patch(const CagDistanceCells *c, const double *x, double *distance,
                         double *weight) {
  const int p = c->p_degree, q = c->q_degree, columns = 2 * q + 1;
  const size_t n = (size_t)(2 * p + 1) * (size_t)columns;
  const double *bp = c->binomials[0], *bq = c->binomials[1];
  double *y = c->work;
  for (int i = 0; i <= p; i++)
    for (int j = 0; j <= q; j++)
      for (int k = 0; k < 4; k++) {
        const int at = 4 * (i * (q + 1) + j) + k;
        y[at] = x[at] * bp[i] * bq[j];
      }
  memset(distance, 0, n * sizeof *distance);
  if (c->rational) memset(weight, 0, n * sizeof *weight);
  for (int i = 0; i <= p; i++)
    for (int k = i; k <= p; k++) {
      const double twice = i == k ? 1 : 2;
      const double *a = y + 4 * i * (q + 1), *b = y + 4 * k * (q + 1);
      double *to = distance + (i + k) * columns, *to_weight = weight + (i + k) * columns;
      for (int j = 0; j <= q; j++) {
        const double x0 = twice * a[4 * j], x1 = twice * a[4 * j + 1], x2 = twice * a[4 * j + 2];
        for (int l = 0; l <= q; l++)
          to[j + l] += x0 * b[4 * l] + x1 * b[4 * l + 1] + x2 * b[4 * l + 2];
        const double w = twice * a[4 * j + 3];
        for (int l = 0; c->rational && l <= q; l++) to_weight[j + l] += w * b[4 * l + 3];
      }
    }
  for (int i = 0; i <= 2 * p; i++)
    for (int j = 0; j < columns; j++) {
      const double scale = c->binomials[2][i] * c->binomials[3][j];
      distance[i * columns + j] /= scale;
      if (c->rational) weight[i * columns + j] /= scale;
    }
}

// Whether the coefficients bend more in v than in u; that direction is halved.
static bool bends_across(const double *d, int rows, int columns) {
  double along_u = 0, along_v = 0;
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) {
      const double *at = d + i * columns + j;
      if (i > 0 && i + 1 < rows) along_u += fabs(at[-columns] - 2 * at[0] + at[columns]);
      if (j > 0 && j + 1 < columns) along_v += fabs(at[-1] - 2 * at[0] + at[1]);
    }
  // Second differences of n + 1 coefficients are those of the parameter over n (n - 1).
  const double per_u = rows - 1, per_v = columns - 1;
  return along_v * per_v * per_v > along_u * per_u * per_u;
}

static void bound_patch(const CagDistanceCells *c, CagDistanceCell *cell) {
  const int p = c->p_degree, q = c->q_degree, rows = 2 * p + 1, columns = 2 * q + 1;
  const double *x = c->blocks + cell->block * c->block_size;
  double *distance = c->work + c->block_size, *weight = distance + rows * columns, most = 0;
  square_patch(c, x, distance, weight);
  cell->bound = cell->least = INFINITY;
  for (int i = 0; i < rows; i++)
    for (int j = 0; j < columns; j++) {
      const int at = i * columns + j;
      if (c->rational) distance[at] /= weight[at];
      most = fmax(most, fabs(distance[at]));
      const double u = cell->u[0] + (cell->u[1] - cell->u[0]) * i / (2 * p);
      const double v = cell->v[0] + (cell->v[1] - cell->v[0]) * j / (2 * q);
      if (distance[at] < cell->bound) {
        cell->bound = distance[at];
        cell->low_at[0] = u;
        cell->low_at[1] = v;
      }
      if ((i > 0 && i < 2 * p) || (j > 0 && j < 2 * q) || !(distance[at] < cell->least)) continue;
      const double *h = x + 4 * (i / 2 * (q + 1) + j / 2);
      cell->least = squared(h) / (h[3] * h[3]);
      cell->least_at[0] = u;
      cell->least_at[1] = v;
      cell->least_point = cag_madd(c->p, 1 / h[3], cag_vec3(h[0], h[1], h[2]));
    }
  cell->bound -= ROUNDING * (most + c->size * sqrt(most));
  cell->across = bends_across(distance, rows, columns);
}

// De Casteljau halving along one line; `stride` numbers from one point to the next.
static void halve_line(const double *from, int degree, size_t stride, double *left, double *right) {
  memcpy(right, from, 4 * sizeof *right);
  for (int i = 0; i <= degree; i++)
    for (int k = 0; k < 4; k++)
      right[(size_t)i * stride + (size_t)k] = from[(size_t)i * stride + (size_t)k];
  for (int step = 0; step <= degree; step++) {
    for (int k = 0; k < 4; k++) left[(size_t)step * stride + (size_t)k] = right[k];
    for (int i = 0; i < degree - step; i++)
      for (int k = 0; k < 4; k++) {
        double *at = right + (size_t)i * stride + (size_t)k;
        *at = (*at + at[stride]) / 2;
      }
  }
}

static CagStatus halve_patch(CagDistanceCells *c, const CagDistanceCell *cell,
                             CagDistanceCell half[2], CagError *err) {
  const int p = c->p_degree, q = c->q_degree;
  CagStatus status = take_block(c, &half[0].block, err);
  if (status) return status;
  half[1].block = cell->block;
  const double *from = c->blocks + cell->block * c->block_size;
  double *left = c->blocks + half[0].block * c->block_size, *right = c->work;
  const size_t row = 4 * (size_t)(q + 1);
  for (int i = 0; cell->across && i <= p; i++) {
    const size_t at = (size_t)i * row;
    halve_line(from + at, q, 4, left + at, right + at);
  }
  for (int j = 0; !cell->across && j <= q; j++) {
    const size_t at = 4 * (size_t)j;
    halve_line(from + at, p, row, left + at, right + at);
  }
  memcpy(c->blocks + cell->block * c->block_size, right, c->block_size * sizeof *right);
  return CAG_OK;
}

// The bounding box of a patch's control points, its distance from p, and its farthest point.
static void box_patch(CagDistanceCells *c, const CagSurfaceNurbsView *is, size_t u, size_t v,
                      double *bound) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int i = 0; i <= c->p_degree; i++)
    for (int j = 0; j <= c->q_degree; j++)
      cag_bounds_add(
          &box, cag_project(is->homogeneous + 4 * ((u - (size_t)c->p_degree + (size_t)i) * is->nv +
                                                   v - (size_t)c->q_degree + (size_t)j)));
  const CagVec3 low = cag_sub(box.min, c->p), high = cag_sub(c->p, box.max);
  const CagVec3 out = {fmax(0, fmax(low.x, high.x)), fmax(0, fmax(low.y, high.y)),
                       fmax(0, fmax(low.z, high.z))};
  const CagVec3 far = {fmin(low.x, high.x), fmin(low.y, high.y), fmin(low.z, high.z)};
  *bound = cag_dot(out, out);
  c->size = fmax(c->size, cag_norm(far));
}

static CagStatus push_patches(CagDistanceCells *c, CagError *err) {
  CagSurfaceNurbsView is;
  cag_surface_nurbs_view(c->exact, &is);
  CagStatus status = CAG_OK;
  for (size_t i = (size_t)is.degree_u; !status && i < is.nu; i++)
    for (size_t j = (size_t)is.degree_v; !status && j < is.nv; j++) {
      CagDistanceCell cell = {.u = {is.knots_u[i], is.knots_u[i + 1]},
                              .v = {is.knots_v[j], is.knots_v[j + 1]},
                              .whole = true,
                              .raw = true,
                              .block = i * is.nv + j};
      if (!(cell.u[0] < cell.u[1] && cell.v[0] < cell.v[1])) continue;
      box_patch(c, &is, i, j, &cell.bound);
      status = cag_distance_cells_push(c, &cell, err);
    }
  return status;
}

// Computes the control points of a patch that was known only by its box.
static CagStatus open_patch(CagDistanceCells *c, CagDistanceCell *cell, CagError *err) {
  CagSurfaceNurbsView is;
  cag_surface_nurbs_view(c->exact, &is);
  const size_t u = cell->block / is.nv, v = cell->block % is.nv;
  const int p = c->p_degree, q = c->q_degree;
  CagStatus status = take_block(c, &cell->block, err);
  if (status) return status;
  double *x = c->blocks + cell->block * c->block_size, *line = c->work;
  for (int i = 0; i <= p; i++) {
    const size_t row = u - (size_t)p + (size_t)i;
    cag_bspline_piece(is.homogeneous + 4 * row * is.nv, is.knots_v, q, v,
                      x + (size_t)i * 4 * (size_t)(q + 1));
  }
  double *made = line + 4 * (p + 1);
  for (int j = 0; j <= q; j++) {
    for (int i = 0; i <= p; i++) memcpy(line + 4 * i, x + 4 * (i * (q + 1) + j), 4 * sizeof *line);
    // The 2 p + 2 knots around the span suffice.
    cag_bspline_piece(line, is.knots_u + (u - (size_t)p), p, (size_t)p, made);
    for (int i = 0; i <= p; i++) {
      double *h = x + 4 * (i * (q + 1) + j);
      memcpy(h, made + 4 * i, 4 * sizeof *h);
      h[0] -= h[3] * c->p.x;
      h[1] -= h[3] * c->p.y;
      h[2] -= h[3] * c->p.z;
    }
  }
  bound_patch(c, cell);
  return CAG_OK;
}

// --- Samples ---

// Coefficients of a parabola through three values at 0, 1/2 and 1.
static double middle_coefficient(double a, double middle, double b) {
  return 2 * middle - (a + b) / 2;
}

static double parabola(double a, double b, double c, double t) {
  return a * (1 - t) * (1 - t) + 2 * b * t * (1 - t) + c * t * t;
}

static CagStatus bound_samples(CagDistanceCells *c, CagDistanceCell *cell, CagError *err) {
  double us[SAMPLES], vs[SAMPLES], d[SAMPLES][SAMPLES], fit[9], miss = 0, most = 0;
  CagVec3 points[SAMPLES * SAMPLES];
  for (int i = 0; i < SAMPLES; i++) {
    us[i] = i == SAMPLES - 1 ? cell->u[1] : cell->u[0] + SAMPLE[i] * (cell->u[1] - cell->u[0]);
    vs[i] = i == SAMPLES - 1 ? cell->v[1] : cell->v[0] + SAMPLE[i] * (cell->v[1] - cell->v[0]);
  }
  CagStatus status = cag_surface_eval_grid(c->s, us, SAMPLES, vs, SAMPLES, points, NULL, NULL, err);
  if (status) return status;
  cell->least = cell->bound = INFINITY;
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) {
      const CagVec3 r = cag_sub(points[i * SAMPLES + j], c->p);
      d[i][j] = cag_dot(r, r);
      most = fmax(most, d[i][j]);
      if (!(d[i][j] < cell->least)) continue;
      cell->least = d[i][j];
      cell->least_at[0] = us[i];
      cell->least_at[1] = vs[j];
      cell->least_point = points[i * SAMPLES + j];
    }
  c->size = fmax(c->size, sqrt(most));
  double rows[3][SAMPLES]; // of the polynomial's coefficients by u, at the samples of v
  for (int j = 0; j < SAMPLES; j++) {
    rows[0][j] = d[0][j];
    rows[1][j] = middle_coefficient(d[0][j], d[2][j], d[4][j]);
    rows[2][j] = d[4][j];
  }
  for (int i = 0; i < 3; i++) {
    fit[3 * i] = rows[i][0];
    fit[3 * i + 1] = middle_coefficient(rows[i][0], rows[i][2], rows[i][4]);
    fit[3 * i + 2] = rows[i][4];
  }
  for (int i = 0; i < SAMPLES; i++)
    for (int j = 0; j < SAMPLES; j++) {
      double line[3];
      for (int k = 0; k < 3; k++) line[k] = parabola(fit[k], fit[3 + k], fit[6 + k], SAMPLE[i]);
      miss = fmax(miss, fabs(parabola(line[0], line[1], line[2], SAMPLE[j]) - d[i][j]));
    }
  for (int k = 0; k < 9; k++) cell->bound = fmin(cell->bound, fit[k]);
  cell->low_at[0] = cell->least_at[0];
  cell->low_at[1] = cell->least_at[1];
  cell->across = bends_across(fit, 3, 3);
  cell->bound -= SAFETY * miss + ROUNDING * (most + c->size * sqrt(most));
  return CAG_OK;
}

static CagStatus push_samples(CagDistanceCells *c, CagError *err) {
  double *uc = NULL, *vc = NULL;
  size_t nu = 0, nv = 0;
  CagStatus status = cag_surface_cuts(c->s, 0, &uc, &nu, err);
  if (!status) status = cag_surface_cuts(c->s, 1, &vc, &nv, err);
  const size_t parts = nu * nv <= PATCHES_FEW ? CELLS_FEW : CELLS_MANY;
  for (size_t i = 0; !status && i < nu * parts; i++)
    for (size_t j = 0; !status && j < nv * parts; j++) {
      CagDistanceCell cell = {.u = {cag_cut_part(uc, i, parts), cag_cut_part(uc, i + 1, parts)},
                              .v = {cag_cut_part(vc, j, parts), cag_cut_part(vc, j + 1, parts)},
                              .whole = true};
      status = bound_samples(c, &cell, err);
      if (!status) status = cag_distance_cells_push(c, &cell, err);
    }
  cag_free(uc);
  cag_free(vc);
  return status;
}

// --- All cells ---

static CagStatus prepare_patches(CagDistanceCells *c, const CagSurfaceNurbsView *is,
                                 CagError *err) {
  const int p = is->degree_u, q = is->degree_v, degree[4] = {p, q, 2 * p, 2 * q};
  c->p_degree = p;
  c->q_degree = q;
  c->rational = is->rational;
  c->block_size = 4 * (size_t)(p + 1) * (size_t)(q + 1);
  // A patch, its two products, and rows of control points.
  c->work =
      cag_malloc(sizeof(double) * (c->block_size + 2 * (size_t)(2 * p + 1) * (size_t)(2 * q + 1) +
                                   8 * (size_t)(p + 1)));
  if (!c->work) return cag_fail_memory(err);
  for (int k = 0; k < 4; k++) {
    c->binomials[k] = cag_malloc(sizeof(double) * (size_t)(degree[k] + 1));
    if (!c->binomials[k]) return cag_fail_memory(err);
    for (int i = 0; i <= degree[k]; i++) c->binomials[k][i] = cag_binomial(degree[k], i);
  }
  return CAG_OK;
}

// Whether the parameters of the exact form are those of the surface, up to an affine map.
static bool same_parameters(const CagSurface *s, const CagSurface *exact) {
  static const double at[3][2] = {{0.137, 0.871}, {0.583, 0.391}, {0.711, 0.094}};
  CagError ignored;
  for (int k = 0; k < 3; k++) {
    CagVec3 a, b;
    const double x = at[k][0], y = at[k][1];
    if (cag_surface_point(s, s->u0 + x * (s->u1 - s->u0), s->v0 + y * (s->v1 - s->v0), &a,
                          &ignored) ||
        cag_surface_point(exact, exact->u0 + x * (exact->u1 - exact->u0),
                          exact->v0 + y * (exact->v1 - exact->v0), &b, &ignored))
      return false;
    const double same = CAG_ROUNDING; // rounding of both, relative to their size
    if (cag_norm(cag_sub(a, b)) > same * (cag_norm(a) + cag_norm(b))) return false;
  }
  return true;
}

// c->exact stays NULL if there is no usable exact form.
static CagStatus exact_form(CagDistanceCells *c, const CagSurface *s, bool own_parameters,
                            CagError *err) {
  CagSurfaceNurbsView is;
  const CagStatus status = cag_surface_to_nurbs(s, &c->exact, err);
  if (status) {
    c->exact = NULL;
    return cag_is_final(status) ? status : CAG_OK;
  }
  bool serves = cag_surface_nurbs_view(c->exact, &is);
  for (size_t k = 0; serves && k < is.nu * is.nv; k++) serves = is.homogeneous[4 * k + 3] > 0;
  c->same = serves && same_parameters(s, c->exact);
  if (serves && (c->same || !own_parameters)) return CAG_OK;
  cag_surface_release(c->exact);
  c->exact = NULL;
  return CAG_OK;
}

CagStatus cag_distance_cells_make(CagDistanceCells *c, const CagSurface *s, CagVec3 p,
                                  bool own_parameters, CagError *err) {
  *c = (CagDistanceCells){.s = s, .p = p, .hint = {NAN, NAN}};
  CagStatus status = exact_form(c, s, own_parameters, err);
  if (status) return status;
  if (!c->exact) {
    c->same = true;
    status = cag_swept_cells_begin(c, own_parameters, &c->certain, err);
    if (status) return status;
    return c->certain ? cag_swept_cells_push(c, err) : push_samples(c, err);
  }
  c->certain = true;
  CagSurfaceNurbsView is;
  cag_surface_nurbs_view(c->exact, &is);
  status = prepare_patches(c, &is, err);
  return status ? status : push_patches(c, err);
}

void cag_distance_cells_free(CagDistanceCells *c) {
  cag_surface_release(c->exact);
  for (int k = 0; k < 4; k++) cag_free(c->binomials[k]);
  cag_free(c->work);
  cag_free(c->items);
  cag_free(c->blocks);
  cag_free(c->unused);
}

CagStatus cag_distance_cells_next(CagDistanceCells *c, double below, CagDistanceCell *out,
                                  bool *found, CagError *err) {
  *found = false;
  while (c->count > 0 && c->items[0].bound < below) {
    *out = c->items[0];
    c->items[0] = c->items[--c->count];
    if (c->count > 0) sink(c, 0);
    *found = true;
    if (!out->raw) return CAG_OK;
    out->raw = false;
    CagStatus status = c->exact ? open_patch(c, out, err) : cag_swept_cell_bound(c, out, err);
    if (status) return status;
    // The patch may be farther away than its box.
    if (!(c->count > 0 && c->items[0].bound < out->bound)) return CAG_OK;
    *found = false;
    status = cag_distance_cells_push(c, out, err);
    if (status) return status;
  }
  return CAG_OK;
}

CagStatus cag_distance_cells_halve(CagDistanceCells *c, const CagDistanceCell *cell, double below,
                                   CagError *err) {
  CagDistanceCell half[2] = {*cell, *cell};
  const double *range = cell->across ? cell->v : cell->u;
  const double middle = range[0] + (range[1] - range[0]) / 2;
  if (!(range[0] < middle && middle < range[1])) {
    cag_distance_cells_drop(c, cell);
    return CAG_OK;
  }
  (cell->across ? half[0].v : half[0].u)[1] = middle;
  (cell->across ? half[1].v : half[1].u)[0] = middle;
  half[0].whole = half[1].whole = false;
  CagStatus status = c->exact ? halve_patch(c, cell, half, err) : CAG_OK;
  for (int k = 0; !status && k < 2; k++) {
    if (c->exact) bound_patch(c, &half[k]);
    else if (c->certain) status = cag_swept_cell_bound(c, &half[k], err);
    else status = bound_samples(c, &half[k], err);
    if (status) break;
    if (half[k].bound < below) status = cag_distance_cells_push(c, &half[k], err);
    else cag_distance_cells_drop(c, &half[k]);
  }
  return status;
}
