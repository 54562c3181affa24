// Approximates any surface by a bicubic B-spline.
//
// Lines of both parameters divide the surface into cells. Each cell becomes the bicubic patch that
// has the surface's points and its first and mixed partial derivatives at the corners. So neighbors
// agree in value and slope, and together form a control net with double knots (triple at breaks of
// the surface, where the two sides may differ). The error decreases with the fourth power of the
// size of the cells. If a cell is too inaccurate, the lines are halved in the direction with the
// larger error.

#include "geom/surface/approximate.h"

#include <math.h>
#include <stdint.h>

#include "base/memory.h"
#include "geom/surface/family.h"

// The maximum number of cells in one direction. If it is exceeded, the surface has a point that no
// polynomial approximates.
#define LINES_MAX 2048
// If a cell of this fraction of the domain is still too inaccurate, it contains a jump or a corner,
// and more divisions would not help.
#define NARROWEST 0x1p-40
// The number of points in a cell and on its edges, in each direction, at which the error is
// measured.
#define PROBES 5
// The probes may miss the maximum error, but the largest error at the probes is at least this
// fraction of it for a bicubic.
#define SAFETY 0.8

typedef struct Lines {
  double *t;
  bool *broken; // a break of the surface
  size_t n;
} Lines;

static void lines_free(Lines *l) {
  cag_free(l->t);
  cag_free(l->broken);
}

static CagStatus lines_first(const CagSurface *s, int direction, Lines *out, CagError *err) {
  size_t breaks = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  double lo = direction == 0 ? s->u0 : s->v0, hi = direction == 0 ? s->u1 : s->v1;
  // With few pieces, the ends of a full turn could not be distinguished from its middle.
  const size_t least = 4;
  *out = (Lines){cag_malloc((breaks + least + 2) * sizeof *out->t),
                 cag_calloc(breaks + least + 2, sizeof *out->broken), 0};
  if (!out->t || !out->broken) return cag_fail_memory(err);
  out->t[out->n++] = lo;
  if (breaks > 0) {
    s->kind->breaks(s, direction, out->t + 1, breaks);
    for (size_t i = 1; i <= breaks; i++) out->broken[i] = true;
    out->n += breaks;
  } else {
    for (size_t i = 1; i < least; i++) out->t[out->n++] = lo + (hi - lo) * (double)i / least;
  }
  out->t[out->n++] = hi;
  return CAG_OK;
}

// Halves the marked intervals.
static CagStatus lines_halve(Lines *l, const bool *marked, CagError *err) {
  const double narrowest = NARROWEST * (l->t[l->n - 1] - l->t[0]);
  bool jumps = false;
  size_t more = 0;
  for (size_t i = 0; i + 1 < l->n; i++) {
    more += marked[i];
    jumps |= marked[i] && l->t[i + 1] - l->t[i] <= narrowest;
  }
  if (jumps || l->n + more > LINES_MAX)
    return cag_fail(
        err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "surface", -1,
        "the surface is not smooth enough to be approximated within the tolerance; use a larger tolerance, or split the surface where it is sharp");
  double *t = cag_malloc((l->n + more) * sizeof *t);
  bool *broken = cag_calloc(l->n + more, sizeof *broken);
  if (!t || !broken) {
    cag_free(t);
    cag_free(broken);
    return cag_fail_memory(err);
  }
  size_t n = 0;
  for (size_t i = 0; i < l->n; i++) {
    broken[n] = l->broken[i];
    t[n++] = l->t[i];
    if (i + 1 < l->n && marked[i]) t[n++] = (l->t[i] + l->t[i + 1]) / 2;
  }
  lines_free(l);
  *l = (Lines){t, broken, n};
  return CAG_OK;
}

// --- One cell ---

typedef struct Cell {
  double u0, u1, v0, v1;
  CagVec3 b[4][4]; // Bezier points, by u then v
} Cell;

// Computes the Bezier points that a corner determines, two in each direction.
static CagStatus corner(const CagSurface *s, Cell *c, int i, int j, CagError *err) {
  CagVec3 d[9];
  CagStatus status = cag_surface_eval(s, i ? c->u1 : c->u0, j ? c->v1 : c->v0, 2,
                                      i ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                      j ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  double a = (c->u1 - c->u0) / 3 * (i ? -1 : 1), b = (c->v1 - c->v0) / 3 * (j ? -1 : 1);
  CagVec3 p = d[0], pu = cag_scaled(d[cag_partial(2, 1, 0)], a);
  CagVec3 pv = cag_scaled(d[cag_partial(2, 0, 1)], b);
  CagVec3 puv = cag_scaled(d[cag_partial(2, 1, 1)], a * b);
  int k = i ? 3 : 0, l = j ? 3 : 0, k1 = i ? 2 : 1, l1 = j ? 2 : 1;
  c->b[k][l] = p;
  c->b[k1][l] = cag_add(p, pu);
  c->b[k][l1] = cag_add(p, pv);
  c->b[k1][l1] = cag_add(cag_add(p, pu), cag_add(pv, puv));
  return CAG_OK;
}

static CagStatus make_cell(const CagSurface *s, Cell *c, CagError *err) {
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 4; k++) status = corner(s, c, k / 2, k % 2, err);
  return status;
}

static CagVec3 cubic(const CagVec3 b[4], double t) {
  double s = 1 - t;
  CagVec3 p = cag_scaled(b[0], s * s * s);
  p = cag_madd(p, 3 * s * s * t, b[1]);
  p = cag_madd(p, 3 * s * t * t, b[2]);
  return cag_madd(p, t * t * t, b[3]);
}

static CagVec3 cell_point(const Cell *c, double a, double b) {
  CagVec3 row[4];
  for (int i = 0; i < 4; i++) row[i] = cubic(c->b[i], b);
  return cubic(row, a);
}

// Computes the largest error inside, and along the edges in each direction, which show the worse
// direction.
static CagStatus cell_errors(const CagSurface *s, const Cell *c, double out[3], CagError *err) {
  out[0] = out[1] = out[2] = 0;
  for (int i = 0; i < PROBES; i++)
    for (int j = 0; j < PROBES; j++) {
      double a = (double)i / (PROBES - 1), b = (double)j / (PROBES - 1);
      CagVec3 p;
      CagStatus status =
          cag_surface_point(s, c->u0 + a * (c->u1 - c->u0), c->v0 + b * (c->v1 - c->v0), &p, err);
      if (status) return status;
      double off = cag_norm(cag_sub(p, cell_point(c, a, b)));
      out[0] = fmax(out[0], off);
      if (j == 0 || j == PROBES - 1) out[1] = fmax(out[1], off);
      if (i == 0 || i == PROBES - 1) out[2] = fmax(out[2], off);
    }
  return CAG_OK;
}

// --- The whole surface ---

// Marks the intervals to be halved. *good: there are none.
static CagStatus judge_cells(const CagSurface *s, const Lines *u, const Lines *v, double tolerance,
                             bool *mark_u, bool *mark_v, bool *good, CagError *err) {
  *good = true;
  for (size_t i = 0; i + 1 < u->n; i++)
    for (size_t j = 0; j + 1 < v->n; j++) {
      Cell c = {.u0 = u->t[i], .u1 = u->t[i + 1], .v0 = v->t[j], .v1 = v->t[j + 1]};
      double off[3];
      CagStatus status = make_cell(s, &c, err);
      if (!status) status = cell_errors(s, &c, off, err);
      if (status) return status;
      if (off[0] <= SAFETY * tolerance) continue;
      *good = false;
      if (off[1] >= off[2] / 2) mark_u[i] = true;
      if (off[2] >= off[1] / 2) mark_v[j] = true;
    }
  return CAG_OK;
}

// Determines which Bezier lines are part of the net. If both sides of a line have the same
// derivative, the line follows from its neighbors and a double knot (out[k]: index in the net,
// SIZE_MAX: none). *n: their number.
static size_t *net_lines(const Lines *l, size_t *n) {
  size_t lines = 3 * (l->n - 1) + 1, *out = cag_malloc(lines * sizeof *out);
  *n = 0;
  for (size_t k = 0; out && k < lines; k++) {
    bool between = k % 3 == 0 && k > 0 && k + 1 < lines && !l->broken[k / 3];
    out[k] = between ? SIZE_MAX : (*n)++;
  }
  return out;
}

static double *net_knots(const Lines *l, size_t n) {
  double *out = cag_malloc((n + 4) * sizeof *out);
  size_t at = 0;
  for (size_t i = 0; out && i < l->n; i++) {
    bool end = i == 0 || i + 1 == l->n;
    for (int k = 0; k < (end ? 4 : l->broken[i] ? 3 : 2); k++) out[at++] = l->t[i];
  }
  return out;
}

typedef struct Net {
  size_t nu, nv, *line_u, *line_v;
  double *knots_u, *knots_v;
  CagVec3 *points;
} Net;

static void put_cell(Net *n, const Cell *c, size_t i, size_t j) {
  for (size_t k = 0; k < 4; k++)
    for (size_t l = 0; l < 4; l++) {
      size_t a = n->line_u[3 * i + k], b = n->line_v[3 * j + l];
      if (a != SIZE_MAX && b != SIZE_MAX) n->points[a * n->nv + b] = c->b[k][l];
    }
}

static CagStatus fill_net(const CagSurface *s, const Lines *u, const Lines *v, Net *n,
                          CagError *err) {
  for (size_t i = 0; i + 1 < u->n; i++)
    for (size_t j = 0; j + 1 < v->n; j++) {
      Cell c = {.u0 = u->t[i], .u1 = u->t[i + 1], .v0 = v->t[j], .v1 = v->t[j + 1]};
      CagStatus status = make_cell(s, &c, err);
      if (status) return status;
      put_cell(n, &c, i, j);
    }
  // Opposite edges that coincide, and edges that are a point, stay exactly so.
  for (size_t j = 0; s->closed_u && j < n->nv; j++)
    n->points[(n->nu - 1) * n->nv + j] = n->points[j];
  for (size_t i = 0; s->closed_v && i < n->nu; i++)
    n->points[i * n->nv + n->nv - 1] = n->points[i * n->nv];
  size_t last_u = (n->nu - 1) * n->nv, last_v = n->nv - 1;
  for (size_t j = 1; j < n->nv; j++) {
    if (s->pole_u0) n->points[j] = n->points[0];
    if (s->pole_u1) n->points[last_u + j] = n->points[last_u];
  }
  for (size_t i = 1; i < n->nu; i++) {
    if (s->pole_v0) n->points[i * n->nv] = n->points[0];
    if (s->pole_v1) n->points[i * n->nv + last_v] = n->points[last_v];
  }
  return CAG_OK;
}

static CagStatus make_net(const CagSurface *s, const Lines *u, const Lines *v, CagSurface **out,
                          CagError *err) {
  Net n = {0};
  n.line_u = net_lines(u, &n.nu);
  n.line_v = net_lines(v, &n.nv);
  n.knots_u = net_knots(u, n.nu);
  n.knots_v = net_knots(v, n.nv);
  n.points = cag_malloc(n.nu * n.nv * sizeof *n.points);
  bool room = n.line_u && n.line_v && n.knots_u && n.knots_v && n.points;
  CagStatus status = room ? fill_net(s, u, v, &n, err) : cag_fail_memory(err);
  if (!status)
    status = cag_surface_nurbs(n.points, NULL, n.nu, n.nv, 3, 3, n.knots_u, n.knots_v, out, err);
  cag_free(n.line_u);
  cag_free(n.line_v);
  cag_free(n.knots_u);
  cag_free(n.knots_v);
  cag_free(n.points);
  return status;
}

CagStatus cag_surface_approximate(const CagSurface *s, double tolerance, CagSurface **out,
                                  CagError *err) {
  Lines u = {0}, v = {0};
  CagStatus status = lines_first(s, 0, &u, err);
  if (!status) status = lines_first(s, 1, &v, err);
  for (bool good = false; !status && !good;) {
    bool *mark_u = cag_calloc(u.n, sizeof *mark_u), *mark_v = cag_calloc(v.n, sizeof *mark_v);
    status = mark_u && mark_v ? judge_cells(s, &u, &v, tolerance, mark_u, mark_v, &good, err)
                              : cag_fail_memory(err);
    if (!status && !good) status = lines_halve(&u, mark_u, err);
    if (!status && !good) status = lines_halve(&v, mark_v, err);
    cag_free(mark_u);
    cag_free(mark_v);
  }
  if (!status) status = make_net(s, &u, &v, out, err);
  lines_free(&u);
  lines_free(&v);
  return status;
}
