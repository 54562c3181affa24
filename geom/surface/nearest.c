// The place of a surface that is nearest to a point.
//
// The parameter rectangle is cut into cells, each smooth patch into some and bent ones into more. A
// cell lies in a ball about its middle, which tells how near it may come; from cells that may beat
// the best place so far, the nearest first, Newton's method goes to where the line from the point
// is normal to the surface. Edges, seams and poles are kept by taking steps within the rectangle,
// or around it where the surface is closed.

#include "geom/surface/nearest.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "geom/surface/curve_on.h"
#include "geom/surface/trimmed.h"

// Cells of a patch in each direction, for a whole surface of one patch and for one of many.
#define CELLS_FEW 8
#define CELLS_MANY 2
#define PATCHES_FEW 16
// A cell whose inside leaves the mean of its corners by more than this part of its radius is
// quartered, so often at most.
#define BENT 0.2
#define QUARTERINGS 5
#define CELLS_MOST 60000
// The ball holds the samples of a cell; its surface may reach out of it by this much.
#define BALL_SAFETY 1.2
#define STEPS 60

typedef struct Cell {
  double u[2], v[2];
  double bound; // the distance of its ball
} Cell;

typedef struct Search {
  const CagSurface *s;
  CagVec3 p;
  const CagRegion *region; // only its inside counts; NULL: all
  Cell *cells;
  size_t count, capacity;
  CagSurfaceNearest best;
  double size; // of the farthest sample from the point: what rounding is a part of
} Search;

// --- Cells ---

static CagStatus push(Search *f, const Cell *cell, CagError *err) {
  if (f->count == f->capacity) {
    size_t capacity = f->capacity ? 2 * f->capacity : 256;
    Cell *grown = realloc(f->cells, capacity * sizeof *grown);
    if (!grown) return cag_fail_memory(err);
    f->cells = grown;
    f->capacity = capacity;
  }
  f->cells[f->count++] = *cell;
  return CAG_OK;
}

static CagStatus add_cell(Search *f, Cell cell, int depth, CagError *err) {
  enum { SIDE = 3 };
  CagVec3 g[SIDE][SIDE];
  const double us[SIDE] = {cell.u[0], cell.u[0] + (cell.u[1] - cell.u[0]) / 2, cell.u[1]};
  const double vs[SIDE] = {cell.v[0], cell.v[0] + (cell.v[1] - cell.v[0]) / 2, cell.v[1]};
  CagStatus status = cag_surface_eval_grid(f->s, us, SIDE, vs, SIDE, &g[0][0], NULL, NULL, err);
  if (status) return status;
  double radius = 0, bend = 0;
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) {
      radius = fmax(radius, cag_norm(cag_sub(g[i][j], g[1][1])));
      f->size = fmax(f->size, cag_norm(cag_sub(g[i][j], f->p)));
      CagVec3 mean = cag_lerp(cag_lerp(g[0][0], g[2][0], i / 2.0),
                              cag_lerp(g[0][2], g[2][2], i / 2.0), j / 2.0);
      bend = fmax(bend, cag_norm(cag_sub(g[i][j], mean)));
    }
  if (bend > BENT * radius && depth < QUARTERINGS && f->count < CELLS_MOST) {
    for (int k = 0; !status && k < 4; k++) {
      Cell part = {.u = {us[k & 1], us[(k & 1) + 1]}, .v = {vs[k >> 1], vs[(k >> 1) + 1]}};
      status = add_cell(f, part, depth + 1, err);
    }
    return status;
  }
  cell.bound = cag_norm(cag_sub(g[1][1], f->p)) - BALL_SAFETY * radius - bend;
  return push(f, &cell, err);
}

// Breaks of one direction with both ends; malloc'd.
static CagStatus cuts_of(const CagSurface *s, int direction, double **out, size_t *n,
                         CagError *err) {
  const size_t inner = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  double *cuts = malloc(sizeof(double) * (inner + 2));
  if (!cuts) return cag_fail_memory(err);
  cuts[0] = direction ? s->v0 : s->u0;
  if (inner) s->kind->breaks(s, direction, cuts + 1, inner);
  cuts[inner + 1] = direction ? s->v1 : s->u1;
  *out = cuts;
  *n = inner + 1;
  return CAG_OK;
}

static double between(const double *cuts, size_t k, size_t parts) {
  const size_t i = k / parts, part = k % parts;
  return part ? cuts[i] + (cuts[i + 1] - cuts[i]) * (double)part / (double)parts : cuts[i];
}

static CagStatus make_cells(Search *f, CagError *err) {
  double *uc = NULL, *vc = NULL;
  size_t nu = 0, nv = 0;
  CagStatus status = cuts_of(f->s, 0, &uc, &nu, err);
  if (!status) status = cuts_of(f->s, 1, &vc, &nv, err);
  const size_t parts = nu * nv <= PATCHES_FEW ? CELLS_FEW : CELLS_MANY;
  for (size_t i = 0; !status && i < nu * parts; i++)
    for (size_t j = 0; !status && j < nv * parts; j++) {
      Cell cell = {.u = {between(uc, i, parts), between(uc, i + 1, parts)},
                   .v = {between(vc, j, parts), between(vc, j + 1, parts)}};
      status = add_cell(f, cell, 0, err);
    }
  free(uc);
  free(vc);
  return status;
}

// --- Newton's method ---

// x + d within [low, high], or around where the direction is closed.
static double stepped(double x, double d, double low, double high, bool closed) {
  double range = high - low, y = x + fmin(fmax(d, -range / 2), range / 2);
  if (closed && y < low) return y + range;
  if (closed && y > high) return y - range;
  return fmin(fmax(y, low), high);
}

// The step of the squared distance's second-order model where that has a minimum, else of the one
// that takes the surface for flat. `fixed`: the parameter stays.
static void model_step(const CagVec3 *d, CagVec3 r, const bool fixed[2], double out[2]) {
  const CagVec3 du = d[cag_partial(2, 1, 0)], dv = d[cag_partial(2, 0, 1)];
  const double g[2] = {cag_dot(r, du), cag_dot(r, dv)};
  const double flat[3] = {cag_dot(du, du), cag_dot(du, dv), cag_dot(dv, dv)};
  double h[3] = {flat[0] + cag_dot(r, d[cag_partial(2, 2, 0)]),
                 flat[1] + cag_dot(r, d[cag_partial(2, 1, 1)]),
                 flat[2] + cag_dot(r, d[cag_partial(2, 0, 2)])};
  const double little = 1e-12;
  out[0] = out[1] = 0;
  for (int k = 0; k < 2; k++)
    if (fixed[1 - k]) {
      if (fixed[k]) return;
      const double slope = h[2 * k] > little * flat[2 * k] ? h[2 * k] : flat[2 * k];
      if (slope > 0) out[k] = -g[k] / slope;
      return;
    }
  double det = h[0] * h[2] - h[1] * h[1];
  if (!(h[0] > 0 && h[2] > 0 && det > little * flat[0] * flat[2])) {
    const double damping = little * (flat[0] + flat[2]) + DBL_MIN;
    h[0] = flat[0] + damping;
    h[1] = flat[1];
    h[2] = flat[2] + damping;
    det = h[0] * h[2] - h[1] * h[1];
  }
  if (!(det > 0)) return;
  out[0] = -(h[2] * g[0] - h[1] * g[1]) / det;
  out[1] = -(h[0] * g[1] - h[1] * g[0]) / det;
}

// A parameter at an end, from which the distance falls only beyond it.
static bool held(double x, double low, double high, bool closed, double slope) {
  return !closed && ((x <= low && slope > 0) || (x >= high && slope < 0));
}

static CagStatus descend(const Search *f, double u, double v, CagSurfaceNearest *out,
                         CagError *err) {
  const CagSurface *s = f->s;
  CagVec3 d[9];
  CagStatus status = cag_surface_eval(s, u, v, 2, u >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                      v >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
  for (int i = 0; !status && i < STEPS; i++) {
    const CagVec3 r = cag_sub(d[0], f->p);
    const double distance = cag_norm(r);
    *out = (CagSurfaceNearest){u, v, distance, d[0]};
    const bool fixed[2] = {held(u, s->u0, s->u1, s->closed_u, cag_dot(r, d[cag_partial(2, 1, 0)])),
                           held(v, s->v0, s->v1, s->closed_v, cag_dot(r, d[cag_partial(2, 0, 1)]))};
    double step[2];
    model_step(d, r, fixed, step);
    // Shorter steps until the distance falls.
    bool nearer = false;
    for (double share = 1; !status && !nearer && share > 1e-4; share /= 4) {
      const double a = stepped(u, share * step[0], s->u0, s->u1, s->closed_u);
      const double b = stepped(v, share * step[1], s->v0, s->v1, s->closed_v);
      if (a == u && b == v) break;
      CagVec3 e[9];
      status = cag_surface_eval(s, a, b, 2, a >= s->u1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT,
                                b >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, e, err);
      if (status || !(cag_norm(cag_sub(e[0], f->p)) < distance)) continue;
      nearer = true;
      u = a;
      v = b;
      for (int k = 0; k < 9; k++) d[k] = e[k];
    }
    if (!nearer) break;
  }
  return status;
}

static CagStatus try_place(Search *f, const Cell *cell, CagError *err) {
  CagSurfaceNearest found = {0};
  CagStatus status =
      descend(f, (cell->u[0] + cell->u[1]) / 2, (cell->v[0] + cell->v[1]) / 2, &found, err);
  if (status || !(found.distance < f->best.distance)) return status;
  bool inside = true;
  if (f->region)
    status = cag_region_contains(f->region, cag_vec3(found.u, found.v, 0), &inside, err);
  if (!status && inside) f->best = found;
  return status;
}

static int by_bound(const void *a, const void *b) {
  const Cell *x = a, *y = b;
  return (x->bound > y->bound) - (x->bound < y->bound);
}

// --- Outlines ---

static CagStatus try_loops(Search *f, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < f->region->count; i++) {
    const CagCurve *loop = f->region->loops[i];
    CagCurve *curve;
    CagVec3 flat, point;
    double t, distance;
    status = cag_curve_on_surface(f->s, loop, &curve, err);
    if (status) return status;
    status = cag_curve_closest(curve, f->p, &t, &point, &distance, err);
    cag_curve_release(curve);
    if (!status && distance < f->best.distance) status = cag_curve_point(loop, t, &flat, err);
    if (!status && distance < f->best.distance)
      f->best = (CagSurfaceNearest){flat.x, flat.y, distance, point};
  }
  return status;
}

CagStatus cag_surface_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out,
                              CagError *err) {
  Search f = {.s = s, .p = p, .best = {.distance = INFINITY}};
  if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
    return cag_fail(err, CAG_E_ARGUMENT, "not-finite", "P", -1, "`P` must be finite");
  if (!cag_surface_planar_view(s, &f.region, NULL)) cag_surface_trimmed_view(s, NULL, &f.region);
  CagStatus status = make_cells(&f, err);
  if (f.count) qsort(f.cells, f.count, sizeof *f.cells, by_bound);
  // Cells that cannot be nearer by more than rounding are not looked at.
  for (size_t i = 0; !status && i < f.count; i++) {
    if (f.cells[i].bound > f.best.distance - DBL_EPSILON * f.size) break;
    status = try_place(&f, &f.cells[i], err);
  }
  if (!status && f.region) status = try_loops(&f, err);
  free(f.cells);
  // A seam is at the start.
  if (s->closed_u && f.best.u >= s->u1) f.best.u = s->u0;
  if (s->closed_v && f.best.v >= s->v1) f.best.v = s->v0;
  if (!status) *out = f.best;
  return status;
}
