// Tessellation, step 1: measures counts on the surface.
//
// For some quadrilaterals of a leaf's grid, spread from the first to the last, measures the
// distance of their triangles from the surface, and the length of their edges and the turn of the
// normal along them.

#include "geom/tessellate/trial.h"

#include <stdlib.h>

#include "base/memory.h"
#include "geom/mesh/distance.h"
#include "geom/surface/frames.h"
#include "geom/surface/trimmed.h"

enum {
  TRIED = 8,       // quadrilaterals measured along each direction of a leaf
  TRIED_WELL = 12, // with so few, that suffices
  TRIED_LAST = 16, // in the last check, only at their midpoints
  EDGES = 24       // whose edges are measured along each direction
};

// --- Sheared parameters ---

// Evaluates the surface at the trial's parameters as cag_surface_eval_frames does. normals may be
// NULL.
static CagStatus evaluate_line(const TessTrial *t, const double *us, size_t nu, const double *vs,
                               size_t nv, CagVec3 *points, CagVec3 *normals, CagError *err) {
  return normals
             ? cag_surface_eval_frames(t->surface, us, nu, vs, nv, points, NULL, NULL, normals, err)
             : cag_surface_eval_grid(t->surface, us, nu, vs, nv, points, NULL, NULL, err);
}

static CagStatus evaluate_sheared(const TessTrial *t, const double *us, size_t nu, const double *vs,
                                  size_t nv, CagVec3 *points, CagVec3 *normals, CagError *err) {
  const bool along_v = t->along == 1;
  const size_t n = along_v ? nv : nu, lines = along_v ? nu : nv;
  double *shifted = cag_malloc((n + 1) * sizeof *shifted);
  CagVec3 *line = cag_malloc((2 * n + 1) * sizeof *line),
          *line_normals = line && normals ? line + n : NULL;
  CagStatus status = shifted && line ? CAG_OK : cag_fail_memory(err);
  for (size_t k = 0; !status && k < lines; k++) {
    const double *across = along_v ? us + k : vs + k, *along = along_v ? vs : us;
    const double shift = t->slope * (*across - t->from[1 - t->along]);
    for (size_t i = 0; i < n; i++) shifted[i] = along[i] + shift;
    status = along_v ? evaluate_line(t, across, 1, shifted, n, line, line_normals, err)
                     : evaluate_line(t, shifted, n, across, 1, line, line_normals, err);
    for (size_t i = 0; !status && i < n; i++) {
      const size_t at = along_v ? k * nv + i : i * nv + k;
      points[at] = line[i];
      if (normals) normals[at] = line_normals[i];
    }
  }
  cag_free(shifted);
  cag_free(line);
  return status;
}

static CagStatus evaluate(const TessTrial *t, const double *us, size_t nu, const double *vs,
                          size_t nv, CagVec3 *points, CagVec3 *normals, CagError *err) {
  return t->slope == 0 ? evaluate_line(t, us, nu, vs, nv, points, normals, err)
                       : evaluate_sheared(t, us, nu, vs, nv, points, normals, err);
}

// Indices of at most `most` of n quadrilaterals, spread from first to last.
static int spread(double n, int most, double *out) {
  int count = n < most ? (int)n : most;
  for (int k = 0; k < count; k++) out[k] = count == 1 ? 0 : floor(k * (n - 1) / (count - 1));
  return count;
}

enum { AT_0, AT_THIRD, AT_HALF, AT_TWO_THIRDS, AT_1, PLACES };
static const double place[PLACES] = {0, 1.0 / 3, 0.5, 2.0 / 3, 1};

#define AT(i, j) at[(i)*stride + (j)]
// Largest distance from points of the surface over one quadrilateral to its triangles, for one cut.
// A point may lie over either, since parameters are not equally spaced. worst: the previous
// maximum; smaller distances are ignored.
static double cut_distance(const CagVec3 *at, int stride, bool cut_ac, double worst) {
  CagVec3 a = AT(AT_0, AT_0), b = AT(AT_1, AT_0), c = AT(AT_1, AT_1), d = AT(AT_0, AT_1);
  CagVec3 tried[3] = {AT(AT_HALF, AT_HALF), AT(cut_ac ? AT_TWO_THIRDS : AT_THIRD, AT_THIRD),
                      AT(cut_ac ? AT_THIRD : AT_TWO_THIRDS, AT_TWO_THIRDS)};
  CagVec3 end = cut_ac ? c : d, start = cut_ac ? a : b;
  for (int k = 0; k < 3; k++) {
    // The last of them lies over the other triangle.
    bool first = k < 2;
    double off = first ? cag_distance_to_triangle(tried[k], a, b, end)
                       : cag_distance_to_triangle(tried[k], start, c, d);
    if (off <= worst) continue;
    off = tess_smaller(off, first ? cag_distance_to_triangle(tried[k], start, c, d)
                                  : cag_distance_to_triangle(tried[k], a, b, end));
    worst = tess_larger(worst, off);
  }
  return worst;
}

// Distance off the mesh of p, which lies over the middle of the edge a b of a triangle a b c.
// Beside the edge the neighbor counts, whose plane is rotated by up to that angle; chords.c handles
// the border of a face.
static double off_edge(CagVec3 p, CagVec3 a, CagVec3 b, CagVec3 c, double sine) {
  CagVec3 ab = cag_sub(b, a), ac = cag_sub(c, a), ap = cag_sub(p, a), n = cag_cross(ab, ac);
  if (cag_triangle_is_thin(a, ab, ac, n)) return cag_distance_to_triangle(p, a, b, c);
  double area = cag_norm(n), length = cag_norm(ab);
  double off = fabs(cag_dot(ap, n)) / area,
         outside = cag_dot(ap, cag_cross(ab, n)) / (area * length);
  if (outside <= 0) return off;
  return tess_smaller(off + outside * sine, sqrt(off * off + outside * outside));
}

// At the border of a leaf triangles may be cut either way when they are stitched to their
// neighbors. sine: of the angle between neighbors along u and v.
static double quad_distance(const CagVec3 *at, int stride, const double sine[2], bool border,
                            double worst) {
  CagVec3 a = AT(AT_0, AT_0), b = AT(AT_1, AT_0), c = AT(AT_1, AT_1), d = AT(AT_0, AT_1);
  bool cut_ac = tess_cut_ac(a, b, c, d);
  worst = tess_larger(worst, off_edge(AT(AT_HALF, AT_0), a, b, cut_ac ? c : d, sine[1]));
  worst = tess_larger(worst, off_edge(AT(AT_HALF, AT_1), c, d, cut_ac ? a : b, sine[1]));
  worst = tess_larger(worst, off_edge(AT(AT_0, AT_HALF), d, a, cut_ac ? c : b, sine[0]));
  worst = tess_larger(worst, off_edge(AT(AT_1, AT_HALF), b, c, cut_ac ? a : d, sine[0]));
  worst = cut_distance(at, stride, cut_ac, worst);
  return border ? cut_distance(at, stride, !cut_ac, worst) : worst;
}
#undef AT

typedef struct Grid {
  int count[2];
  int rows;
  CagVec3 points[TRIED_LAST * TRIED_LAST * 9]; // also room for TRIED and PLACES
} Grid;

// Points of the surface over some quadrilaterals of a leaf, at the given positions in each.
static CagStatus evaluate_places(const TessTrial *t, int most, const double *places,
                                 int place_count, Grid *grid, CagError *err) {
  double ts[2][TRIED_LAST * TRIED_LAST * 3], chosen[TRIED_LAST * TRIED_LAST];
  for (int d = 0; d < 2; d++) {
    // Strips get additional samples along them for those not needed across.
    int across = t->n[1 - d] < most ? (int)t->n[1 - d] : most;
    grid->count[d] = spread(t->n[d], most * most / across, chosen);
    for (int k = 0; k < grid->count[d]; k++)
      for (int p = 0; p < place_count; p++) {
        double x = t->from[d] + (t->to[d] - t->from[d]) * ((chosen[k] + places[p]) / t->n[d]);
        ts[d][k * place_count + p] = x < t->to[d] ? x : t->to[d];
      }
  }
  grid->rows = grid->count[1] * place_count;
  return evaluate(t, ts[0], (size_t)(grid->count[0] * place_count), ts[1], (size_t)grid->rows,
                  grid->points, NULL, err);
}

CagStatus cag_tess_try_distance(const TessTrial *trial, const double sine[2], double *distance,
                                CagError *err) {
  Grid grid;
  CagStatus status = evaluate_places(trial, TRIED, place, PLACES, &grid, err);
  if (status) return status;
  *distance = 0;
  for (int i = 0; i < grid.count[0]; i++)
    for (int j = 0; j < grid.count[1]; j++) {
      const CagVec3 *corner = grid.points + (i * grid.rows + j) * PLACES;
      bool border = i == 0 || j == 0 || i + 1 == grid.count[0] || j + 1 == grid.count[1];
      *distance = quad_distance(corner, grid.rows, sine, border, *distance);
    }
  return CAG_OK;
}

CagStatus cag_tess_try_middles(const TessTrial *trial, double *distance, CagError *err) {
  static const double ends_and_middle[3] = {0, 0.5, 1};
  Grid grid;
  *distance = 0;
  if (tess_larger(trial->n[0], trial->n[1]) <= TRIED_WELL) return CAG_OK;
  CagStatus status = evaluate_places(trial, TRIED_LAST, ends_and_middle, 3, &grid, err);
  if (status) return status;
  for (int i = 0; i < grid.count[0]; i++)
    for (int j = 0; j < grid.count[1]; j++) {
      const CagVec3 *at = grid.points + (i * grid.rows + j) * 3, *far = at + 2 * grid.rows;
      CagVec3 middle = at[grid.rows + 1], a = at[0], b = far[0], c = far[2], d = at[2];
      bool cut_ac = tess_cut_ac(a, b, c, d);
      double off = cag_distance_to_triangle(middle, a, b, cut_ac ? c : d);
      if (off <= *distance) continue;
      off = tess_smaller(off, cag_distance_to_triangle(middle, cut_ac ? a : b, c, d));
      *distance = tess_larger(*distance, off);
    }
  return CAG_OK;
}

// --- Edges ---

typedef struct EdgeLimits {
  double angle, free, longest;
} EdgeLimits;

// An edge along which the normal turns by more than this crosses a cusp. More edges would not help
// there, so its angle does not count. An unknown normal is a zero vector: its angle is 0 or pi,
// which does not count either.
#define TURNED_AT_ONCE 1.0

static bool is_free(const EdgeLimits *most, const CagVec3 *p, size_t a, size_t b) {
  CagVec3 ab = cag_sub(p[b], p[a]);
  return cag_dot(ab, ab) <= most->free * most->free;
}

static double excess_of(const EdgeLimits *most, const CagVec3 *p, const CagVec3 *q, size_t a,
                        size_t b) {
  double length = cag_norm(cag_sub(p[b], p[a])), excess = 0;
  if (most->longest > 0) excess = length / most->longest;
  if (!(most->angle > 0) || length <= most->free) return excess;
  double turn = atan2(cag_norm(cag_cross(q[a], q[b])), cag_dot(q[a], q[b]));
  return turn > TURNED_AT_ONCE ? excess : tess_larger(excess, turn / most->angle);
}

// Parameters of the corners of at most EDGES quadrilaterals along direction d; `step` is the offset
// from one to the next.
static size_t corners_along(const TessTrial *t, int d, double *out, size_t *step) {
  // Normals at breaks are those of the inner side.
  const double inside = 1e-6; // of the leaf
  double chosen[EDGES], length = t->to[d] - t->from[d];
  int count = spread(t->n[d], EDGES, chosen);
  bool all = count == t->n[d];
  size_t n = all ? (size_t)count + 1 : 2 * (size_t)count;
  for (size_t k = 0; k < n; k++) {
    double x = (all ? (double)k : chosen[k / 2] + (double)(k % 2)) / t->n[d];
    out[k] = t->from[d] + length * tess_smaller(tess_larger(x, inside), 1 - inside);
  }
  *step = all ? 1 : 2;
  return n;
}

CagStatus cag_tess_try_edges(const TessTrial *trial, double angle, double free, double longest,
                             TessExcess *out, CagError *err) {
  const EdgeLimits most = {angle, free, longest};
  double ts[2][2 * EDGES];
  CagVec3 p[4 * EDGES * EDGES], q[4 * EDGES * EDGES]; // points and normals
  size_t n[2], step[2];
  for (int d = 0; d < 2; d++) n[d] = corners_along(trial, d, ts[d], &step[d]);
  CagStatus status = evaluate(trial, ts[0], n[0], ts[1], n[1], p, q, err);
  if (status) return status;
  *out = (TessExcess){{0, 0}, 0};
  for (size_t i = 0; i + 1 < n[0]; i += step[0])
    for (size_t j = 0; j + 1 < n[1]; j += step[1]) {
      size_t a = i * n[1] + j, b = a + n[1], c = b + 1, d = a + 1;
      double u = tess_larger(excess_of(&most, p, q, a, b), excess_of(&most, p, q, d, c));
      double v = tess_larger(excess_of(&most, p, q, a, d), excess_of(&most, p, q, b, c));
      bool cut_ac = tess_cut_ac(p[a], p[b], p[c], p[d]);
      // If a side is exempt from the angle limit, its turn appears in the diagonal as well. Strips
      // may be cut either way.
      const bool strip = trial->slope != 0;
      EdgeLimits across = most;
      if (is_free(&most, p, a, b) || is_free(&most, p, a, d)) across.angle = 0;
      double ac = cut_ac || strip ? excess_of(&across, p, q, a, c) : 0,
             bd = !cut_ac || strip ? excess_of(&across, p, q, b, d) : 0;
      out->along[0] = tess_larger(out->along[0], u);
      out->along[1] = tess_larger(out->along[1], v);
      out->diagonal = tess_larger(out->diagonal, tess_larger(ac, bd));
    }
  return CAG_OK;
}

// --- Scattered points ---

bool cag_tess_is_known_by_points(const CagSurface *s) {
  CagTransform map;
  while (cag_surface_placed_view(s, &s, &map)) continue;
  return !s->kind->to_nurbs && !cag_surface_trimmed_view(s, NULL, NULL);
}

// SCATTERED rows of points over the domain, each with SCATTERED_ALONG of them. Consecutive rows are
// shifted by the golden section of the spacing, so that no two rows use the same v, and lines along
// u are found as well.
enum { SCATTERED = 128, SCATTERED_ALONG = 32 };

typedef struct Scatter {
  const TessTrial *trial;
  size_t n[2];
  CagVec3 *corners; // of all quadrilaterals: (n[0] + 1) x (n[1] + 1)
} Scatter;

// Distance to the nearest of the quadrilaterals around the cell (i, j), or to that one only if it
// is close enough.
static double distance_to_cells(const Scatter *s, size_t i, size_t j, CagVec3 p, double enough) {
  size_t stride = s->n[1] + 1;
  double least = INFINITY;
  for (int around = 0; around < 2 && least > enough; around++)
    for (size_t x = i - (around && i > 0); x <= i + around && x < s->n[0]; x++)
      for (size_t y = j - (around && j > 0); y <= j + around && y < s->n[1]; y++) {
        const CagVec3 *c = s->corners + x * stride + y;
        CagVec3 a = c[0], b = c[stride], e = c[stride + 1], d = c[1];
        bool cut = tess_cut_ac(a, b, e, d);
        double off = tess_smaller(cag_distance_to_triangle(p, a, b, cut ? e : d),
                                  cag_distance_to_triangle(p, cut ? a : b, e, d));
        least = tess_smaller(least, off);
      }
  return least;
}

// Index of the quadrilateral along a direction in which a parameter lies.
static size_t cell_of(const TessTrial *t, int d, double x) {
  double k = floor((x - t->from[d]) / (t->to[d] - t->from[d]) * t->n[d]);
  return k < 0 ? 0 : k >= t->n[d] ? (size_t)t->n[d] - 1 : (size_t)k;
}

static CagStatus evaluate_corners(const Scatter *s, CagError *err) {
  // A row may have as many quadrilaterals as there are points.
  enum { MOST = 4 * SCATTERED * SCATTERED_ALONG + 1 };
  double us[MOST], vs[MOST];
  double *at[2] = {us, vs};
  for (int d = 0; d < 2; d++)
    for (size_t k = 0; k <= s->n[d]; k++)
      at[d][k] = tess_mix(s->trial->from[d], s->trial->to[d], k, s->n[d]);
  return evaluate(s->trial, us, s->n[0] + 1, vs, s->n[1] + 1, s->corners, NULL, err);
}

// One row of points, as far as they lie in the leaf.
static CagStatus try_row(const Scatter *s, double u, double shift, double tolerance, bool *missed,
                         CagError *err) {
  const TessTrial *t = s->trial;
  const double v0 = t->surface->v0, length = t->surface->v1 - v0;
  double vs[SCATTERED_ALONG];
  CagVec3 p[SCATTERED_ALONG];
  size_t n = 0, cell[SCATTERED_ALONG][2];
  for (int j = 0; j < SCATTERED_ALONG; j++) {
    const double v = v0 + length * (j + shift) / SCATTERED_ALONG;
    double at[2] = {u, v};
    at[t->along] -= t->slope * (at[1 - t->along] - t->from[1 - t->along]);
    if (!(at[0] >= t->from[0] && at[0] < t->to[0] && at[1] >= t->from[1] && at[1] < t->to[1]))
      continue;
    for (int d = 0; d < 2; d++) cell[n][d] = cell_of(t, d, at[d]);
    vs[n++] = v;
  }
  if (n == 0) return CAG_OK;
  CagStatus status = cag_surface_eval_grid(t->surface, &u, 1, vs, n, p, NULL, NULL, err);
  for (size_t k = 0; !status && !*missed && k < n; k++)
    *missed = distance_to_cells(s, cell[k][0], cell[k][1], p[k], tolerance) > tolerance;
  return status;
}

CagStatus cag_tess_try_scattered(const TessTrial *trial, double tolerance, bool *missed,
                                 CagError *err) {
  const double golden = 0.6180339887498949;
  static const double beside[] = {0.5, 0, 0.25, 0.75}; // of the way from row to row
  const CagSurface *f = trial->surface;
  const int sets = trial->suspect ? 4 : 1;
  double fraction = (trial->to[0] - trial->from[0]) / (f->u1 - f->u0) *
                    ((trial->to[1] - trial->from[1]) / (f->v1 - f->v0));
  Scatter s = {.trial = trial, .n = {(size_t)trial->n[0], (size_t)trial->n[1]}};
  *missed = false;
  if (trial->n[0] * trial->n[1] > fraction * sets * SCATTERED * SCATTERED_ALONG) return CAG_OK;
  s.corners = cag_malloc((s.n[0] + 1) * (s.n[1] + 1) * sizeof *s.corners);
  if (!s.corners) return cag_fail_memory(err);
  CagStatus status = evaluate_corners(&s, err);
  for (int k = 0; k < sets; k++)
    for (int i = 0; !status && !*missed && i < SCATTERED; i++) {
      double u = f->u0 + (f->u1 - f->u0) * (i + beside[k]) / SCATTERED;
      double shift = (i + beside[k] - beside[0]) * golden;
      status = try_row(&s, u, shift - floor(shift), tolerance, missed, err);
    }
  cag_free(s.corners);
  return status;
}
