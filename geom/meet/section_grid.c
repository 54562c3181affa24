// The grid of a patch, its crossings, and their links (see section_grid.h).

#include "geom/meet/section_grid.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geom/linalg/tolerance.h"

// Minimum number of cells between two breaks, and maximum number along a direction.
#define CELLS_BETWEEN_BREAKS 4
#define CELLS_MOST 400
// Maximum number of grid lines added for loops smaller than a cell.
#define FOLLOWED_MOST 32
// The tangent is undefined at a point if its two terms cancel to this fraction, or if the function
// changes by less than a number of rounding errors over the whole surface.
#define FLAT CAG_COINCIDENT
#define FLAT_ROUNDINGS 1e4
#define ROOT_ROUNDS 80

static double value_at(CagTracer *t, double u, double v) {
  double f = 0;
  if (!t->status) t->status = cag_patch_value(&t->patch, u, v, &f, NULL, NULL, t->err);
  return f;
}

// The bound of rounding at this point.
double cag_tracer_zero(const CagTracer *t, double u, double v) {
  return t->level->sided && cag_patch_is_beside(&t->patch, u, v) ? t->zero_beside : t->level->zero;
}

// The value, or 0 if it is within rounding.
double cag_tracer_settled(CagTracer *t, double u, double v) {
  double f = value_at(t, u, v);
  return fabs(f) <= cag_tracer_zero(t, u, v) ? 0 : f;
}

// Sets point and tangent at the node's parameters; returns the value and its gradient.
double cag_tracer_inspect(CagTracer *t, CagTraceNode *node, double gradient[2]) {
  CagVec3 d[4] = {0};
  double f = 0;
  gradient[0] = gradient[1] = 0;
  node->regular = false;
  if (!t->status) t->status = cag_patch_value(&t->patch, node->u, node->v, &f, gradient, d, t->err);
  if (t->status) return 0;
  CagVec3 su = d[cag_partial(1, 1, 0)], sv = d[cag_partial(1, 0, 1)];
  CagVec3 along = cag_madd(cag_scaled(su, -gradient[1]), gradient[0], sv);
  double magnitude = fabs(gradient[1]) * cag_norm(su) + fabs(gradient[0]) * cag_norm(sv);
  const double *lo = t->patch.lo, *hi = t->patch.hi;
  double level = fabs(gradient[0]) * (hi[0] - lo[0]) + fabs(gradient[1]) * (hi[1] - lo[1]);
  node->p = d[0];
  node->flat = level <= FLAT_ROUNDINGS * t->level->zero;
  node->regular = cag_norm(along) > FLAT * magnitude && !node->flat &&
                  !cag_patch_is_collapsed(&t->patch, node->u, node->v);
  node->t = node->regular ? cag_unit(along) : cag_vec3(0, 0, 0);
  return f;
}

// --- The grid ---

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// The ends of the smooth intervals of the patch along a direction; n is their number.
static double *stretch_ends(const CagTracer *t, int direction, size_t *n) {
  const CagSurface *s = t->s;
  double lo = t->patch.lo[direction], hi = t->patch.hi[direction];
  size_t inner = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0, kept = 1;
  double *ends = cag_malloc((inner + 2) * sizeof *ends);
  if (!ends) return NULL;
  if (inner > 0) s->kind->breaks(s, direction, ends + 1, inner);
  ends[0] = lo;
  for (size_t i = 1; i <= inner; i++)
    if (ends[i] > lo && ends[i] < hi) ends[kept++] = ends[i];
  ends[kept] = hi;
  *n = kept;
  return ends;
}

static bool make_lines(CagTracer *t, int direction, size_t cells, const double *extra,
                       size_t extra_count) {
  double lo = t->patch.lo[direction], hi = t->patch.hi[direction];
  size_t stretches = 0, n = 0;
  double *ends = stretch_ends(t, direction, &stretches);
  if (!ends) return false;
  size_t between = cells / stretches;
  if (between < CELLS_BETWEEN_BREAKS) between = CELLS_BETWEEN_BREAKS;
  if (between * stretches > CELLS_MOST) between = CELLS_MOST / stretches + 1;
  double *lines = cag_malloc((stretches * between + 1 + extra_count) * sizeof *lines);
  if (lines) {
    for (size_t i = 0; i < stretches; i++)
      for (size_t k = 0; k < between; k++)
        lines[n++] = ends[i] + (ends[i + 1] - ends[i]) * (double)k / (double)between;
    lines[n++] = hi;
    for (size_t i = 0; i < extra_count; i++) lines[n++] = extra[i];
    qsort(lines, n, sizeof *lines, by_size);
    // Merge nearly equal lines.
    size_t kept = 1;
    for (size_t i = 1; i < n; i++)
      if (lines[i] - lines[kept - 1] > 1e-9 * (hi - lo)) lines[kept++] = lines[i];
    lines[kept - 1] = hi;
    t->n[direction] = kept;
  }
  cag_free(ends);
  cag_free(t->lines[direction]);
  t->lines[direction] = lines;
  return lines != NULL;
}

static double *value_of(const CagTracer *t, size_t i, size_t j) {
  return &t->values[j * t->n[0] + i];
}

bool cag_tracer_fill(CagTracer *t) {
  cag_free(t->values);
  t->values = cag_malloc(t->n[0] * t->n[1] * sizeof *t->values);
  if (!t->values) t->status = cag_fail_memory(t->err);
  for (size_t j = 0; j < t->n[1] && !t->status; j++)
    for (size_t i = 0; i < t->n[0] && !t->status; i++)
      *value_of(t, i, j) = cag_tracer_settled(t, t->lines[0][i], t->lines[1][j]);
  return !t->status;
}

// A contour's values have no natural unit: rounding is relative to the largest.
double cag_tracer_largest(const CagTracer *t) {
  double largest = 0;
  for (size_t k = 0; k < t->n[0] * t->n[1]; k++) largest = fmax(largest, fabs(t->values[k]));
  return largest;
}

// The largest deviation of the function inside some cells from the interpolation of the corners, as
// a fraction of its largest value: near 1 if it oscillates within a cell. The points are not at
// simple fractions of the cells, where a wave could hide.
static double roughness(CagTracer *t) {
  const size_t tried = 8;
  const double x = 0.3719, y = 0.6173;
  double worst = 0, largest = cag_tracer_largest(t);
  for (size_t a = 0; a < tried; a++)
    for (size_t b = 0; b < tried && !t->status; b++) {
      size_t i = a * (t->n[0] - 2) / (tried - 1), j = b * (t->n[1] - 2) / (tried - 1);
      const double *u = &t->lines[0][i], *v = &t->lines[1][j];
      double low = (1 - x) * *value_of(t, i, j) + x * *value_of(t, i + 1, j);
      double high = (1 - x) * *value_of(t, i, j + 1) + x * *value_of(t, i + 1, j + 1);
      double f = value_at(t, u[0] + x * (u[1] - u[0]), v[0] + y * (v[1] - v[0]));
      worst = fmax(worst, fabs(f - ((1 - y) * low + y * high)));
      largest = fmax(largest, fabs(f));
    }
  return largest > 0 ? worst / largest : 0;
}

// Lines added to the uniform ones, by direction.
typedef struct Extra {
  double at[2][FOLLOWED_MOST];
  size_t n[2];
} Extra;

static void add_extra(Extra *e, int direction, double x) {
  if (e->n[direction] < FOLLOWED_MOST) e->at[direction][e->n[direction]++] = x;
}

static bool make_all_lines(CagTracer *t, const Extra *e) {
  return make_lines(t, 0, t->cells[0] * t->finer, e->at[0], e->n[0]) &&
         make_lines(t, 1, t->cells[1] * t->finer, e->at[1], e->n[1]) && cag_tracer_fill(t);
}

// Refines by halving until the function is smooth from one line to the next.
bool cag_tracer_make_grid(CagTracer *t, size_t finer) {
  const double smooth = 0.1;
  const Extra none = {.n = {0, 0}};
  for (t->finer = finer;; t->finer *= 2) {
    if (!make_all_lines(t, &none)) return false;
    if (t->finer >> CAG_TRACER_HALVINGS || roughness(t) <= smooth) return !t->status;
  }
}

static double inside(double x, double lo, double hi) { return fmin(fmax(x, lo), hi); }

// Finds a critical point of the function by Newton's method from the node, within hu and hv of it.
// Returns the determinant of the second derivatives, which is negative at a saddle.
bool cag_tracer_critical(CagTracer *t, CagTraceNode *node, double hu, double hv, double *bend,
                         double *determinant) {
  const double part = 1e-3;
  const int rounds = 8;
  double u = node->u, v = node->v;
  for (int round = 0; round < rounds; round++) {
    double g[2], gu[2], gv[2];
    double du = node->u + part * hu > t->patch.hi[0] ? -part * hu : part * hu;
    double dv = node->v + part * hv > t->patch.hi[1] ? -part * hv : part * hv;
    CagTraceNode beside = *node;
    cag_tracer_inspect(t, node, g);
    beside.u += du;
    cag_tracer_inspect(t, &beside, gu);
    beside = *node;
    beside.v += dv;
    cag_tracer_inspect(t, &beside, gv);
    double a = (gu[0] - g[0]) / du, b = (gu[1] - g[1]) / du, c = (gv[1] - g[1]) / dv;
    *bend = a;
    *determinant = a * c - b * b;
    if (t->status || !(fabs(*determinant) > 0)) return false;
    double su = (c * g[0] - b * g[1]) / *determinant, sv = (a * g[1] - b * g[0]) / *determinant;
    const double *lo = t->patch.lo, *hi = t->patch.hi;
    node->u = inside(node->u - su, fmax(u - hu, lo[0]), fmin(u + hu, hi[0]));
    node->v = inside(node->v - sv, fmax(v - hv, lo[1]), fmin(v + hv, hi[1]));
  }
  return true;
}

// The distance from a line to its nearer neighbor.
static double width_at(const CagTracer *t, int direction, size_t i) {
  const double *x = t->lines[direction] + i;
  const double before = i > 0 ? x[0] - x[-1] : INFINITY;
  return i + 1 < t->n[direction] ? fmin(before, x[1] - x[0]) : before;
}

// Minimizes the function's magnitude from a node that is nearest to 0 among its neighbors; returns
// true if it has the other sign at its extremum.
static bool follow(CagTracer *t, size_t i, size_t j, double *u, double *v) {
  double sign = *value_of(t, i, j) < 0 ? -1 : 1, bend, determinant;
  CagTraceNode here = {.u = t->lines[0][i], .v = t->lines[1][j]};
  // The extremum of a narrow oblique dip may lie more than one cell away.
  const double hu = 2 * width_at(t, 0, i), hv = 2 * width_at(t, 1, j);
  if (!cag_tracer_critical(t, &here, hu, hv, &bend, &determinant)) return false;
  *u = here.u;
  *v = here.v;
  return determinant > 0 && bend * sign > 0 && cag_tracer_settled(t, here.u, here.v) * sign < 0;
}

static bool nearest_to_zero(const CagTracer *t, size_t i, size_t j) {
  double f = *value_of(t, i, j), sign = f < 0 ? -1 : 1;
  for (size_t k = i > 0 ? i - 1 : 0; k <= i + 1 && k < t->n[0]; k++)
    for (size_t l = j > 0 ? j - 1 : 0; l <= j + 1 && l < t->n[1]; l++)
      if (*value_of(t, k, l) * sign < f * sign) return false;
  return f != 0;
}

static void find_small_loops(CagTracer *t, Extra *e) {
  double u, v;
  for (size_t j = 0; j < t->n[1]; j++)
    for (size_t i = 0; i < t->n[0] && e->n[0] < FOLLOWED_MOST && !t->status; i++)
      if (nearest_to_zero(t, i, j) && follow(t, i, j, &u, &v)) {
        add_extra(e, 0, u);
        add_extra(e, 1, v);
      }
}

// Between two ends along direction k at which the function has the same sign: a point with the
// other sign, searched where it is nearest to 0. A curve leaves the rectangle there and returns.
static bool find_dip(CagTracer *t, int k, double fixed, double lo, double hi, double *out) {
  const int rounds = 30;
  double sign = 0, slopes[2] = {0, 0};
  for (int round = 0; round < rounds && !t->status; round++) {
    // The ends first, then points between them: secant and bisection of the slope alternately.
    double way = slopes[1] - slopes[0];
    double x = round == 0                  ? lo
               : round == 1                ? hi
               : round % 2 == 0 && way > 0 ? lo - (hi - lo) * slopes[0] / way
                                           : (lo + hi) / 2;
    double f = 0, g[2] = {0, 0};
    t->status = cag_patch_value(&t->patch, k ? fixed : x, k ? x : fixed, &f, g, NULL, t->err);
    if (fabs(f) <= cag_tracer_zero(t, k ? fixed : x, k ? x : fixed)) f = 0;
    if (round == 0) sign = f < 0 ? -1 : 1;
    if (f * sign < 0) {
      *out = x;
      return round > 1;
    }
    if (round < 2) {
      slopes[round] = sign * g[k];
      if (round == 0 ? slopes[0] >= 0 : slopes[1] <= 0) return false;
    } else if (sign * g[k] < 0) {
      lo = x;
      slopes[0] = sign * g[k];
    } else {
      hi = x;
      slopes[1] = sign * g[k];
    }
  }
  return false;
}

static void find_dips(CagTracer *t, Extra *e) {
  for (int k = 0; k < 2; k++)
    for (int end = 0; end < 2; end++)
      for (size_t i = 0; i + 1 < t->n[k] && e->n[k] < FOLLOWED_MOST && !t->status; i++) {
        const double *x = &t->lines[k][i];
        double fixed = end ? t->patch.hi[1 - k] : t->patch.lo[1 - k], found;
        if (find_dip(t, k, fixed, x[0], x[1], &found)) add_extra(e, k, found);
      }
}

static bool add_lines(CagTracer *t) {
  Extra e = {.n = {0, 0}};
  find_small_loops(t, &e);
  find_dips(t, &e);
  if (e.n[0] + e.n[1] == 0) return !t->status;
  return !t->status && make_all_lines(t, &e);
}

// --- Crossings ---

static size_t edge_along_u(const CagTracer *t, size_t i, size_t j) { return j * (t->n[0] - 1) + i; }
static size_t edge_along_v(const CagTracer *t, size_t i, size_t j) {
  return (t->n[0] - 1) * t->n[1] + i * (t->n[1] - 1) + j;
}

static bool negative(double f) { return f < 0; }

// The zero between two nodes, one of which is negative: false position with halved weights (the
// Illinois variant), which keeps it bracketed.
void cag_tracer_crossing(CagTracer *t, double u0, double v0, double f0, double u1, double v1,
                         double f1, CagTraceNode *out) {
  double a = 0, b = 1, fa = f0, fb = f1, x = f0 / (f0 - f1);
  for (int round = 0; f0 != 0 && f1 != 0 && round < ROOT_ROUNDS && b - a > DBL_EPSILON; round++) {
    x = a + (b - a) * fa / (fa - fb);
    if (!(x > a && x < b)) x = (a + b) / 2;
    double f = cag_tracer_settled(t, u0 + x * (u1 - u0), v0 + x * (v1 - v0));
    if (f == 0 || t->status) break;
    bool left = negative(f) == negative(fa);
    if (left) {
      a = x;
      fa = f;
      fb /= 2;
    } else {
      b = x;
      fb = f;
      fa /= 2;
    }
    // Every third round bisects the bracket, whatever the function looks like.
    if (round % 3 == 2) {
      double m = (a + b) / 2, fm = value_at(t, u0 + m * (u1 - u0), v0 + m * (v1 - v0));
      if (negative(fm) == negative(f0)) {
        a = m;
        fa = fm;
      } else {
        b = m;
        fb = fm;
      }
    }
  }
  double gradient[2];
  out->u = u0 + x * (u1 - u0);
  out->v = v0 + x * (v1 - v0);
  cag_tracer_inspect(t, out, gradient);
}

// Whether two branches cross at a node without a tangent: the gradient vanishes there as at a
// saddle.
static bool is_saddle(CagTracer *t, const CagTraceNode *node) {
  const double same = 1e-6; // fraction of a cell
  double bend, determinant;
  double hu = (t->patch.hi[0] - t->patch.lo[0]) / (double)t->n[0];
  double hv = (t->patch.hi[1] - t->patch.lo[1]) / (double)t->n[1];
  CagTraceNode here = *node;
  return !cag_patch_is_collapsed(&t->patch, node->u, node->v) &&
         cag_tracer_critical(t, &here, hu, hv, &bend, &determinant) && determinant < 0 &&
         fabs(here.u - node->u) <= same * hu && fabs(here.v - node->v) <= same * hv;
}

static void cross_edge(CagTracer *t, size_t edge, size_t i0, size_t j0, size_t i1, size_t j1) {
  double f0 = *value_of(t, i0, j0), f1 = *value_of(t, i1, j1);
  t->links[edge][0] = t->links[edge][1] = -1;
  if (negative(f0) == negative(f1)) return;
  CagTraceNode *node = &t->crossings[edge];
  cag_tracer_crossing(t, t->lines[0][i0], t->lines[1][j0], f0, t->lines[0][i1], t->lines[1][j1], f1,
                      node);
  if (!node->regular && !t->status) node->branching = is_saddle(t, node);
}

static void link_pair(CagTracer *t, size_t a, size_t b) {
  t->links[a][t->links[a][0] >= 0] = (int32_t)b;
  t->links[b][t->links[b][0] >= 0] = (int32_t)a;
}

// The value at the saddle of a cell all of whose edges are crossed; at its middle if none is found.
static double saddle_value(CagTracer *t, size_t i, size_t j) {
  const double *u = &t->lines[0][i], *v = &t->lines[1][j];
  double hu = (u[1] - u[0]) / 2, hv = (v[1] - v[0]) / 2, bend, determinant;
  CagTraceNode middle = {.u = u[0] + hu, .v = v[0] + hv}, saddle = middle;
  bool found = cag_tracer_critical(t, &saddle, hu, hv, &bend, &determinant) && determinant < 0;
  const CagTraceNode *at = found ? &saddle : &middle;
  return cag_tracer_settled(t, at->u, at->v);
}

static void link_cell(CagTracer *t, size_t i, size_t j) {
  const bool corner[4] = {negative(*value_of(t, i, j)), negative(*value_of(t, i + 1, j)),
                          negative(*value_of(t, i + 1, j + 1)), negative(*value_of(t, i, j + 1))};
  // In the order of the corners: the edge from each to the next.
  const size_t edge[4] = {edge_along_u(t, i, j), edge_along_v(t, i + 1, j),
                          edge_along_u(t, i, j + 1), edge_along_v(t, i, j)};
  size_t crossed[4], n = 0;
  for (int k = 0; k < 4; k++)
    if (corner[k] != corner[(k + 1) % 4]) crossed[n++] = edge[k];
  if (n == 2) link_pair(t, crossed[0], crossed[1]);
  if (n != 4) return;
  // The saddle connects the two corners of its sign; the others are cut off.
  bool with_first = negative(saddle_value(t, i, j)) == corner[0];
  link_pair(t, edge[0], edge[with_first ? 1 : 3]);
  link_pair(t, edge[2], edge[with_first ? 3 : 1]);
}

static bool find_crossings(CagTracer *t) {
  size_t nu = t->n[0], nv = t->n[1];
  t->edge_count = (nu - 1) * nv + nu * (nv - 1);
  t->crossings = cag_calloc(t->edge_count, sizeof *t->crossings);
  t->links = cag_malloc(t->edge_count * sizeof *t->links);
  if (!t->crossings || !t->links) return false;
  for (size_t j = 0; j < nv; j++)
    for (size_t i = 0; i + 1 < nu; i++) cross_edge(t, edge_along_u(t, i, j), i, j, i + 1, j);
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j + 1 < nv; j++) cross_edge(t, edge_along_v(t, i, j), i, j, i, j + 1);
  for (size_t j = 0; j + 1 < nv; j++)
    for (size_t i = 0; i + 1 < nu; i++) link_cell(t, i, j);
  return !t->status;
}

bool cag_tracer_link(CagTracer *t) { return add_lines(t) && find_crossings(t); }
