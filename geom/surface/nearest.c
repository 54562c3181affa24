// The point of a surface nearest to a given one.
//
// Cells of the surface are processed in the order of their lower bounds and halved until none can
// contain a closer point than the best one found. Newton's method finds candidates: from the point
// with the lowest bound of each patch, and from any known point that is closer than the best one.
// It stays within a smooth piece of the surface; if it ends at a crease or a seam, it continues in
// the adjacent piece as long as the distance decreases.

#include "geom/surface/nearest.h"

#include <float.h>
#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/curve_on.h"
#include "geom/surface/nearest_cells.h"
#include "geom/surface/nearest_core.h"
#include "geom/surface/nearest_revolved.h"
#include "geom/surface/quadric_nearest.h"
#include "geom/surface/trimmed.h"

#define STEPS 60
// Points are equally near if their distances differ by less than this fraction of the size: for
// surfaces with rigorous bounds, and for sampled ones.
#define EQUALLY_NEAR 1e-13
#define EQUALLY_NEAR_SAMPLED 1e-10
// Number of cells after which the best point is returned: surfaces with a constant distance, up to
// rounding, never run out of cells.
#define MOST_CELLS 20000
#define MOST_CELLS_SAMPLED 3000
// Distances within this fraction of the size are equal up to rounding.
#define ROUNDING (4 * DBL_EPSILON)
// Cells that intersect the outline of a region are halved down to this fraction of the domain.
#define FINEST 1e-6

// A part of the parameter rectangle on which the surface is smooth. A ring is an entire closed
// direction without breaks.
typedef struct Piece {
  double low[2], high[2];
  bool ring[2];
} Piece;

typedef struct Search {
  const CagSurface *s;
  CagVec3 p;
  const CagRegion *region; // only its inside counts; NULL: the whole surface
  CagDistanceCells cells;
  double *cuts[2]; // breaks and both ends
  size_t pieces[2];
  CagSurfaceNearest best;
} Search;

// --- Pieces ---

static bool is_closed(const Search *f, int k) { return k ? f->s->closed_v : f->s->closed_u; }

static Piece piece_of(const Search *f, const size_t at[2]) {
  Piece out;
  for (int k = 0; k < 2; k++) {
    out.low[k] = f->cuts[k][at[k]];
    out.high[k] = f->cuts[k][at[k] + 1];
    out.ring[k] = is_closed(f, k) && f->pieces[k] == 1;
  }
  return out;
}

static size_t piece_at(const Search *f, int k, double x) {
  size_t low = 0, high = f->pieces[k];
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    if (f->cuts[k][middle] <= x) low = middle;
    else high = middle;
  }
  return low;
}

static CagStatus find_cuts(Search *f, CagError *err) {
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 2; k++)
    status = cag_surface_cuts(f->s, k, &f->cuts[k], &f->pieces[k], err);
  return status;
}

// --- Newton's method ---

// x + d, clamped to the piece, or wrapped around it.
static double stepped(const Piece *in, int k, double x, double d) {
  const double low = in->low[k], high = in->high[k], range = high - low;
  const double y = x + fmin(fmax(d, -range / 2), range / 2);
  if (in->ring[k] && y < low) return y + range;
  if (in->ring[k] && y > high) return y - range;
  return fmin(fmax(y, low), high);
}

// The step to the minimum of the second-order model of the squared distance, or if there is none,
// of the model for a flat surface. `fixed`: the parameter stays.
static void model_step(const CagVec3 *d, CagVec3 r, const bool fixed[2], double out[2]) {
  const CagVec3 du = d[cag_partial(2, 1, 0)], dv = d[cag_partial(2, 0, 1)];
  const double g[2] = {cag_dot(r, du), cag_dot(r, dv)};
  const double flat[3] = {cag_dot(du, du), cag_dot(du, dv), cag_dot(dv, dv)};
  double h[3] = {flat[0] + cag_dot(r, d[cag_partial(2, 2, 0)]),
                 flat[1] + cag_dot(r, d[cag_partial(2, 1, 1)]),
                 flat[2] + cag_dot(r, d[cag_partial(2, 0, 2)])};
  const double little = CAG_ROUNDING;
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

// A point in a piece, with all data that a step needs.
typedef struct Place {
  double at[2], distance;
  double off; // component of the line to the point along the free directions
  bool fixed[2];
  CagVec3 r, d[9];
} Place;

static CagStatus surface_place(const Search *f, const Piece *in, CagVec3 p, const double at[2],
                               Place *out, CagError *err) {
  CagSide side[2];
  for (int k = 0; k < 2; k++) {
    out->at[k] = at[k];
    side[k] = at[k] >= in->high[k] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  }
  CagStatus status = cag_surface_eval(f->s, at[0], at[1], 2, side[0], side[1], out->d, err);
  if (status) return status;
  out->r = cag_sub(out->d[0], p);
  out->distance = cag_norm(out->r);
  out->off = 0;
  for (int k = 0; k < 2; k++) {
    // At an end, if the distance decreases only beyond it.
    const CagVec3 along = out->d[k ? cag_partial(2, 0, 1) : cag_partial(2, 1, 0)];
    const double slope = cag_dot(out->r, along), speed = cag_norm(along);
    out->fixed[k] =
        !in->ring[k] && ((at[k] <= in->low[k] && slope > 0) || (at[k] >= in->high[k] && slope < 0));
    if (!out->fixed[k] && speed > 0) out->off = fmax(out->off, fabs(slope) / speed);
  }
  return CAG_OK;
}

// Finds the local minimum in the piece. Near it the distance is constant up to rounding, and the
// slope decides which point is better.
static CagStatus descend(const Search *f, const Piece *in, CagVec3 p, const double start[2],
                         CagSurfaceNearest *out, CagError *err) {
  Place here, there;
  const double same = ROUNDING * f->cells.size;
  CagStatus status = surface_place(f, in, p, start, &here, err);
  for (int i = 0; !status && i < STEPS; i++) {
    double step[2];
    model_step(here.d, here.r, here.fixed, step);
    // Shorten the step until the distance decreases.
    bool better = false;
    for (double part = 1; !status && !better && part > 1e-4; part /= 4) {
      const double at[2] = {stepped(in, 0, here.at[0], part * step[0]),
                            stepped(in, 1, here.at[1], part * step[1])};
      if (at[0] == here.at[0] && at[1] == here.at[1]) break;
      status = surface_place(f, in, p, at, &there, err);
      const bool level = fabs(there.distance - here.distance) <= same;
      better = !status && (level ? there.off < here.off / 2 : there.distance < here.distance);
    }
    if (!better) break;
    here = there;
  }
  if (!status) *out = (CagSurfaceNearest){here.at[0], here.at[1], here.distance, here.d[0]};
  return status;
}

// The piece adjacent to the point at an end of its own: 0 if there is none, else whether the
// parameter changes.
static bool beside(const Search *f, int k, size_t piece, double *x, size_t *out) {
  const size_t last = f->pieces[k] - 1;
  const bool low = *x <= f->cuts[k][piece], high = *x >= f->cuts[k][piece + 1];
  if (last == 0 || (!low && !high)) return false;
  const bool around = low ? piece == 0 : piece == last;
  if (around && !is_closed(f, k)) return false;
  *out = low ? (around ? last : piece - 1) : (around ? 0 : piece + 1);
  if (around) *x = low ? f->cuts[k][last + 1] : f->cuts[k][0];
  return true;
}

// Descends from a point in a piece to a local minimum, across creases.
static CagStatus descend_over(const Search *f, const size_t start[2], const double from[2],
                              CagVec3 p, CagSurfaceNearest *out, CagError *err) {
  size_t piece[2] = {start[0], start[1]};
  Piece in = piece_of(f, piece);
  CagStatus status = descend(f, &in, p, from, out, err);
  bool moved = true;
  // Each crossing must reduce the distance by more than rounding; many in a row do not help.
  for (int crossings = 0; !status && moved && crossings < STEPS; crossings++) {
    moved = false;
    for (int ways = 1; !status && !moved && ways < 4; ways++) {
      double at[2] = {out->u, out->v};
      size_t next[2] = {piece[0], piece[1]};
      if ((ways & 1) && !beside(f, 0, piece[0], &at[0], &next[0])) continue;
      if ((ways & 2) && !beside(f, 1, piece[1], &at[1], &next[1])) continue;
      CagSurfaceNearest found;
      in = piece_of(f, next);
      status = descend(f, &in, p, at, &found, err);
      moved = !status && found.distance < out->distance - ROUNDING * f->cells.size;
      if (!moved) continue;
      *out = found;
      piece[0] = next[0];
      piece[1] = next[1];
    }
  }
  return status;
}

// --- Candidates ---

static CagStatus offer(Search *f, const CagSurfaceNearest *found, CagError *err) {
  bool inside = true;
  if (!(found->distance < f->best.distance)) return CAG_OK;
  CagStatus status = CAG_OK;
  if (f->region)
    status = cag_region_contains(f->region, cag_vec3(found->u, found->v, 0), &inside, err);
  if (status || !inside) return status;
  f->best = *found;
  f->cells.hint[0] = found->u;
  f->cells.hint[1] = found->v;
  return CAG_OK;
}

// Converts a parameter of a cell to one of the surface, exactly or approximately, and finds its
// piece.
static double own_parameter(const Search *f, int k, double x, const double range[2],
                            size_t *piece) {
  const CagSurface *s = f->s, *exact = f->cells.exact;
  double middle = range[0] + (range[1] - range[0]) / 2;
  if (exact) {
    const double low = k ? s->v0 : s->u0, high = k ? s->v1 : s->u1;
    const double a = k ? exact->v0 : exact->u0, b = k ? exact->v1 : exact->u1;
    if (low != a || high != b) {
      x = x >= b ? high : low + (x - a) / (b - a) * (high - low);
      middle = low + (middle - a) / (b - a) * (high - low);
    }
  }
  *piece = piece_at(f, k, middle);
  return fmin(fmax(x, f->cuts[k][*piece]), f->cuts[k][*piece + 1]);
}

// Parameters of a point on the surface that is known by a cell with other parameters, by descending
// to it from the nearest of some samples.
static CagStatus parameters_of(const Search *f, CagVec3 q, size_t piece[2], double at[2],
                               CagError *err) {
  enum { SAMPLES = 9, KEPT = 4 };
  struct {
    double distance, at[2];
    size_t piece[2];
  } kept[KEPT];
  size_t n = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < f->pieces[0]; i++)
    for (size_t j = 0; !status && j < f->pieces[1]; j++)
      for (int k = 0; !status && k < SAMPLES * SAMPLES; k++) {
        const size_t place[2] = {i, j};
        const double part[2] = {(k / SAMPLES + 0.5) / SAMPLES, (k % SAMPLES + 0.5) / SAMPLES};
        double x[2];
        CagVec3 point;
        for (int m = 0; m < 2; m++) {
          const double *ends = f->cuts[m] + place[m];
          x[m] = ends[0] + part[m] * (ends[1] - ends[0]);
        }
        status = cag_surface_point(f->s, x[0], x[1], &point, err);
        const double distance = cag_norm(cag_sub(point, q));
        if (status || (n == KEPT && distance >= kept[KEPT - 1].distance)) continue;
        size_t to = n < KEPT ? n++ : KEPT - 1;
        for (; to > 0 && kept[to - 1].distance > distance; to--) kept[to] = kept[to - 1];
        kept[to].distance = distance;
        for (int m = 0; m < 2; m++) {
          kept[to].at[m] = x[m];
          kept[to].piece[m] = place[m];
        }
      }
  CagSurfaceNearest best = {.distance = INFINITY}, found;
  for (size_t k = 0; !status && k < n; k++) {
    status = descend_over(f, kept[k].piece, kept[k].at, q, &found, err);
    if (!status && found.distance < best.distance) best = found;
  }
  at[0] = best.u;
  at[1] = best.v;
  for (int k = 0; k < 2; k++) piece[k] = piece_at(f, k, at[k]);
  return status;
}

static CagStatus try_cell(Search *f, const CagDistanceCell *cell, CagError *err) {
  const bool known = cell->least < f->best.distance * f->best.distance;
  if (!known && !cell->whole) return CAG_OK;
  size_t piece[2];
  double at[2];
  CagSurfaceNearest found;
  CagStatus status = CAG_OK;
  const double *from = cell->whole ? cell->low_at : cell->least_at;
  at[0] = own_parameter(f, 0, from[0], cell->u, &piece[0]);
  at[1] = own_parameter(f, 1, from[1], cell->v, &piece[1]);
  status = descend_over(f, piece, at, f->p, &found, err);
  if (!status) status = offer(f, &found, err);
  const double least = sqrt(cell->least), same = EQUALLY_NEAR * f->cells.size;
  if (status || !(least < f->best.distance - same)) return status;
  // Use the known point itself if the descent led elsewhere.
  if (f->cells.same) {
    at[0] = own_parameter(f, 0, cell->least_at[0], cell->u, &piece[0]);
    at[1] = own_parameter(f, 1, cell->least_at[1], cell->v, &piece[1]);
  } else {
    status = parameters_of(f, cell->least_point, piece, at, err);
  }
  if (!status) status = descend_over(f, piece, at, f->p, &found, err);
  if (!status) status = offer(f, &found, err);
  if (status || !f->region || !(least < f->best.distance)) return status;
  found = (CagSurfaceNearest){at[0], at[1], least, cell->least_point};
  return offer(f, &found, err);
}

// --- Outlines ---

static CagStatus try_loops(Search *f, const CagTransform *flat, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < f->region->count; i++) {
    const CagCurve *loop = f->region->loops[i];
    CagCurve *curve;
    CagVec3 at, point;
    double t, distance;
    status = flat ? cag_curve_transform(loop, flat, &curve, err)
                  : cag_curve_on_surface(f->s, loop, &curve, err);
    if (status) return status;
    status = cag_curve_closest(curve, f->p, &t, &point, &distance, err);
    cag_curve_release(curve);
    if (!status && distance < f->best.distance) status = cag_curve_point(loop, t, &at, err);
    if (!status && distance < f->best.distance)
      f->best = (CagSurfaceNearest){at.x, at.y, distance, point};
  }
  return status;
}

// Whether a cell lies outside the region, or is so small that the search on the outline covers its
// inner part.
static CagStatus is_outside(const Search *f, const CagDistanceCell *cell, bool *out,
                            CagError *err) {
  double middle[2], reach = 0;
  *out = false;
  if (!f->region) return CAG_OK;
  bool fine = true;
  for (int k = 0; k < 2; k++) {
    const double *range = k ? cell->v : cell->u;
    size_t unused;
    double end[2];
    for (int side = 0; side < 2; side++)
      end[side] = own_parameter(f, k, range[side], range, &unused);
    middle[k] = (end[0] + end[1]) / 2;
    reach = hypot(reach, (end[1] - end[0]) / 2);
    fine = fine && end[1] - end[0] < FINEST * (f->cuts[k][f->pieces[k]] - f->cuts[k][0]);
  }
  const CagVec3 at = {middle[0], middle[1], 0};
  bool inside;
  CagStatus status = cag_region_contains(f->region, at, &inside, err);
  if (status || (inside && !fine)) return status;
  double nearest = INFINITY;
  for (size_t i = 0; !status && i < f->region->count; i++) {
    double distance;
    status = cag_curve_closest(f->region->loops[i], at, NULL, NULL, &distance, err);
    nearest = fmin(nearest, distance);
  }
  *out = nearest > reach ? !inside : fine;
  return status;
}

// --- Complete search ---

static CagStatus search_cells(Search *f, CagError *err) {
  CagStatus status = CAG_OK;
  const bool sampled = !f->cells.certain;
  const int most = sampled ? MOST_CELLS_SAMPLED : MOST_CELLS;
  for (int i = 0; !status && i < most; i++) {
    const double share = sampled ? EQUALLY_NEAR_SAMPLED : EQUALLY_NEAR;
    CagDistanceCell cell;
    bool found, outside = false;
    // Squared distance that improves on the best by more than the tolerance.
    double nearer = f->best.distance - share * f->cells.size;
    if (!(nearer > 0)) break;
    status = cag_stop_check(err);
    if (!status) status = cag_distance_cells_next(&f->cells, nearer * nearer, &cell, &found, err);
    if (status || !found) break;
    status = is_outside(f, &cell, &outside, err);
    if (!status && !outside) status = try_cell(f, &cell, err);
    nearer = fmax(0, f->best.distance - share * f->cells.size);
    if (outside || !(cell.bound < nearer * nearer)) cag_distance_cells_drop(&f->cells, &cell);
    else if (!status) status = cag_distance_cells_halve(&f->cells, &cell, nearer * nearer, err);
  }
  return status;
}

// Tries the nearest point of the core. *certain is set if no other point can be nearer.
static CagStatus try_core(Search *f, bool *certain, CagError *err) {
  double bound;
  bool known;
  CagSurfaceNearest found;
  *certain = false;
  CagStatus status = cag_surface_nearest_by_core(f->s, f->p, &bound, &found, &known, err);
  if (status || !known || !(bound > 0)) return status;
  status = offer(f, &found, err);
  const double size = fmax(f->cells.size, cag_norm(cag_sub(found.point, f->p)));
  *certain = f->best.distance - bound <= EQUALLY_NEAR * size;
  return status;
}

// For a flat piece: the perpendicular foot if it is inside, else a point on the outline.
static CagStatus closest_planar(Search *f, const CagTransform *frame, CagError *err) {
  CagVec3 a = cag_transform_vector(frame, cag_vec3(1, 0, 0));
  CagVec3 b = cag_transform_vector(frame, cag_vec3(0, 1, 0));
  const CagVec3 r = cag_sub(f->p, cag_transform_point(frame, cag_vec3(0, 0, 0)));
  const CagVec3 n = cag_cross(a, b);
  const double det = cag_dot(n, n);
  if (det > 0) {
    CagSurfaceNearest found = {.u = cag_dot(cag_cross(r, b), n) / det,
                               .v = cag_dot(cag_cross(a, r), n) / det};
    found.point = cag_transform_point(frame, cag_vec3(found.u, found.v, 0));
    found.distance = cag_norm(cag_sub(found.point, f->p));
    CagStatus status = offer(f, &found, err);
    if (status) return status;
  }
  return isfinite(f->best.distance) ? CAG_OK : try_loops(f, frame, err);
}

// Tries the nearest point of a surface without its outline: if it is inside of it, no other is
// nearer.
static CagStatus try_untrimmed(Search *f, bool *done, CagError *err) {
  CagSurfaceNearest found;
  *done = cag_surface_quadric_closest(f->s, f->p, &found);
  CagStatus status = CAG_OK;
  if (!*done) status = cag_surface_revolved_closest(f->s, f->p, &found, done, err);
  if (!status && !*done && f->region) {
    status = cag_surface_closest(f->s, f->p, &found, err);
    *done = true;
  }
  if (!status && *done) status = offer(f, &found, err);
  *done = !status && isfinite(f->best.distance);
  return status;
}

static CagStatus closest_curved(Search *f, CagError *err) {
  bool certain = false;
  CagStatus status = find_cuts(f, err);
  if (!status) status = cag_distance_cells_make(&f->cells, f->s, f->p, f->region != NULL, err);
  if (!status && f->region) status = try_loops(f, NULL, err);
  if (!status) status = try_core(f, &certain, err);
  if (!status && !certain) status = search_cells(f, err);
  cag_distance_cells_free(&f->cells);
  cag_free(f->cuts[0]);
  cag_free(f->cuts[1]);
  return status;
}

CagStatus cag_surface_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out,
                              CagError *err) {
  Search f = {.s = s, .p = p, .best = {.distance = INFINITY}};
  CagTransform frame;
  if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "P", -1, "`P` must be finite");
  CagStatus status;
  if (cag_surface_planar_view(s, &f.region, &frame)) {
    status = closest_planar(&f, &frame, err);
  } else {
    bool done;
    if (cag_surface_trimmed_view(s, NULL, &f.region)) cag_surface_trimmed_view(s, &f.s, &f.region);
    status = try_untrimmed(&f, &done, err);
    if (!status && !done) status = closest_curved(&f, err);
    // A point on a seam is reported at its start.
    if (s->closed_u && f.best.u >= s->u1) f.best.u = s->u0;
    if (s->closed_v && f.best.v >= s->v1) f.best.v = s->v0;
  }
  if (!status) *out = f.best;
  return status;
}
