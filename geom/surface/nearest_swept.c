// Lower bounds of the distances of cells of tubes, sweeps, and extrusions, from intervals of their
// derivatives.
//
// A function on an interval of length h is below the chord of its end values by at most h^2 / 8
// times the largest second derivative; a convex function is never below its tangents. Both apply to
// the squared distance on a cell, in u and in v. A tube is a family of circles: with w the path
// minus p, and Z its tangent times the scale, the squared distance of p from the circle of radius R
// |Z| is w^2 + R^2 Z^2 - 2 R |w x Z|, so that cells are intervals of v only.

#include "geom/surface/nearest_swept.h"

#include <float.h>
#include <math.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/range.h"
#include "geom/surface/family.h"
#include "geom/surface/motion_parts.h"
#include "geom/surface/swept.h"

// Derivatives whose ranges are needed.
#define SECOND 2
// Rounding of a squared distance, in units of that of the largest term.
#define ROUNDING (8 * DBL_EPSILON)
// Initial number of cells for a round section, and for another smooth piece.
#define ROUND_PARTS 4
#define OTHER_PARTS 2
// Initial number of intervals of an extrusion in v.
#define EXTRUSION_PARTS 4

// --- The surface ---

// The section's circle about the origin of the axes; false: another section.
static bool is_centered_circle(const CagCurve *section, double *radius) {
  double a, b;
  CagTransform frame;
  *radius = 0;
  if (!section->closed || !cag_curve_arc_view(section, &a, &b, &frame) || a != b) return false;
  *radius = a;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      if (frame.m[i][j] != (i == j)) return false;
  return true;
}

// The axes of an extrusion: x and y are multiplied by the complex factor (1 + k v) exp(i a v), a
// being the twist and 1 + k the scale.
static void extrusion_ranges(const CagTwisted *e, double a, double b, int n, CagMotionRanges *out) {
  const CagInterval none = cag_interval(0), v = {a, b};
  const double k = e->scale - 1;
  const CagInterval grown = cag_interval_add(cag_interval(1), cag_interval_scaled(v, k));
  const CagInterval turn = cag_interval_scaled(v, e->twist);
  CagInterval before[2] = {none, none}; // the coefficient of exp(i a v) before
  double factor = 1;                    // a^j / j!
  for (int j = 0; j <= n; j++) {
    CagInterval e_j[2], m[2];
    for (int part = 0; part < 2; part++) {
      const CagInterval angle = cag_interval_add(turn, cag_interval((j - part) * (M_PI / 2)));
      e_j[part] = cag_interval_scaled(cag_interval_cos(angle), factor);
      m[part] = cag_interval_add(cag_interval_product(grown, e_j[part]),
                                 cag_interval_scaled(before[part], k));
      before[part] = e_j[part];
    }
    const CagInterval up = j == 0 ? v : j == 1 ? cag_interval(1) : none;
    out->x[j] = (CagInterval3){m[0], m[1], none};
    out->y[j] = (CagInterval3){cag_interval_scaled(m[1], -1), m[0], none};
    out->z[j] = (CagInterval3){none, none, cag_interval(j == 0)};
    out->origin[j] =
        (CagInterval3){cag_interval_scaled(up, e->along.x), cag_interval_scaled(up, e->along.y),
                       cag_interval_scaled(up, e->along.z)};
    factor *= e->twist / (j + 1);
  }
}

static bool spoke_ranges(const CagSwept *w, double a, double b, int n, CagMotionRanges *out) {
  if (w->motion) return cag_motion_ranges(w->motion, a, b, n, out);
  extrusion_ranges(&w->extrusion, a, b, n, out);
  return true;
}

// The ends of the intervals on which the surface is analytic.
static CagStatus find_joints(const CagSwept *w, double **out, size_t *n, CagError *err) {
  if (w->motion) return cag_motion_joints(w->motion, out, n, err);
  *out = cag_malloc((EXTRUSION_PARTS + 1) * sizeof **out);
  if (!*out) return cag_fail_memory(err);
  for (int i = 0; i <= EXTRUSION_PARTS; i++) (*out)[i] = (double)i / EXTRUSION_PARTS;
  *n = EXTRUSION_PARTS;
  return CAG_OK;
}

CagStatus cag_swept_cells_begin(CagDistanceCells *c, bool region, bool *known, CagError *err) {
  CagSwept *w = &c->swept;
  const CagSurface *s = c->s;
  CagTransform back;
  CagMotionRanges at;
  CagInterval3 section[SECOND + 1];
  *w = (CagSwept){.map = cag_transform_identity(), .scale = 1, .p = c->p};
  if (cag_surface_placed_view(s, &s, &w->map)) w->flip = cag_surface_is_flipped(c->s);
  *known = cag_surface_swept_view(s, &w->section, &w->motion);
  if (!*known && cag_surface_twisted_view(s, &w->extrusion)) {
    *known = true;
    w->section = w->extrusion.section;
  }
  if (!*known) return CAG_OK;
  double *joints = NULL, *cuts = NULL;
  size_t n;
  CagStatus status = find_joints(w, &joints, &n, err);
  if (!status) status = cag_curve_cuts(w->section, &cuts, &n, err);
  if (!status) {
    // A tiny interval shows whether ranges are available at all.
    const double tiny = 1e-6, dv = tiny * (joints[1] - joints[0]), du = tiny * (cuts[1] - cuts[0]);
    *known = spoke_ranges(w, joints[0], joints[0] + dv, SECOND, &at) &&
             cag_curve_ranges(w->section, cuts[0], cuts[0] + du, SECOND, section);
  }
  cag_free(joints);
  cag_free(cuts);
  if (status || !*known) return status;
  if (!w->motion) return CAG_OK;
  const CagPathMotion *how = cag_motion_path(w->motion) ? cag_motion_how(w->motion) : NULL;
  w->tube = !region && how && how->orient != CAG_ORIENT_FIXED && !w->motion->corner &&
            is_centered_circle(w->section, &w->radius) &&
            cag_transform_is_similarity(&w->map, &w->scale) &&
            !cag_transform_inverse(&w->map, &back, err);
  w->scale = fabs(w->scale);
  if (w->tube) w->p = cag_transform_point(&back, c->p);
  return CAG_OK;
}

// v of the motion, ascending.
static void inner_range(const CagDistanceCells *c, const double v[2], double out[2]) {
  const double sum = c->s->v0 + c->s->v1;
  out[0] = c->swept.flip ? sum - v[1] : v[0];
  out[1] = c->swept.flip ? sum - v[0] : v[1];
}

// --- Ranges ---

static CagInterval3 sum(CagInterval3 a, CagInterval3 b) {
  CagInterval3 out;
  cag_intervals3_add(&a, &b, 0, &out);
  return out;
}

static CagInterval3 scaled(CagInterval3 a, CagInterval f) {
  CagInterval3 out;
  cag_intervals3_scaled(&a, &f, 0, &out);
  return out;
}

static CagInterval dot(CagInterval3 a, CagInterval3 b) {
  return cag_interval_add(
      cag_interval_product(a.x, b.x),
      cag_interval_add(cag_interval_product(a.y, b.y), cag_interval_product(a.z, b.z)));
}

static CagInterval square(CagInterval3 a) {
  return cag_interval_add(cag_interval_square(a.x),
                          cag_interval_add(cag_interval_square(a.y), cag_interval_square(a.z)));
}

static CagInterval3 less_point(CagInterval3 a, CagVec3 p) {
  return (CagInterval3){cag_interval_sub(a.x, cag_interval(p.x)),
                        cag_interval_sub(a.y, cag_interval(p.y)),
                        cag_interval_sub(a.z, cag_interval(p.z))};
}

// The image of a vector, or with `move` of a point.
static CagInterval3 mapped(const CagTransform *t, CagInterval3 a, bool move) {
  CagInterval out[3];
  for (int i = 0; i < 3; i++) {
    out[i] = cag_interval_add(cag_interval_scaled(a.x, t->m[i][0]),
                              cag_interval_add(cag_interval_scaled(a.y, t->m[i][1]),
                                               cag_interval_scaled(a.z, t->m[i][2])));
    if (move) out[i] = cag_interval_add(out[i], cag_interval(t->m[i][3]));
  }
  return (CagInterval3){out[0], out[1], out[2]};
}

// Derivative i by u and j by v, from the Taylor coefficients of section and motion.
static CagInterval3 partial(const CagSwept *w, const CagInterval3 *section,
                            const CagMotionRanges *m, int i, int j) {
  static const double factorial[SECOND + 1] = {1, 1, 2};
  const CagInterval3 c = section[i];
  CagInterval3 out = sum(scaled(m->x[j], c.x), scaled(m->y[j], c.y));
  if (c.z.lo != 0 || c.z.hi != 0) out = sum(out, scaled(m->z[j], c.z));
  if (i == 0) out = sum(out, m->origin[j]);
  out = mapped(&w->map, out, i + j == 0);
  return scaled(out, cag_interval(factorial[i] * factorial[j]));
}

static CagInterval intersection(CagInterval a, CagInterval b) {
  return (CagInterval){fmax(a.lo, b.lo), fmin(a.hi, b.hi)};
}

// The squared distance of p from the box.
static double box_distance(CagInterval3 box, CagVec3 p) {
  const double x = fmax(0, fmax(box.x.lo - p.x, p.x - box.x.hi));
  const double y = fmax(0, fmax(box.y.lo - p.y, p.y - box.y.hi));
  const double z = fmax(0, fmax(box.z.lo - p.z, p.z - box.z.hi));
  return x * x + y * y + z * z;
}

// The range of a function on the cell: the intersection of `natural` with the mean value form, from
// the value at the middle and the derivatives in u and v.
static CagInterval3 centered(CagInterval3 natural, CagVec3 middle, CagInterval3 by_u, double hu,
                             CagInterval3 by_v, double hv) {
  const CagInterval3 at = {cag_interval(middle.x), cag_interval(middle.y), cag_interval(middle.z)};
  const CagInterval3 around =
      sum(at, sum(scaled(by_u, (CagInterval){-hu, hu}), scaled(by_v, (CagInterval){-hv, hv})));
  return (CagInterval3){intersection(natural.x, around.x), intersection(natural.y, around.y),
                        intersection(natural.z, around.z)};
}

static double width(CagInterval3 a) {
  return fmax(a.x.hi - a.x.lo, fmax(a.y.hi - a.y.lo, a.z.hi - a.z.lo));
}

// The squared distance of p from the box of a cell. Halving is chosen in the direction that shrinks
// the box more.
static double box_bound(const CagDistanceCells *c, CagDistanceCell *cell) {
  CagInterval3 section;
  CagMotionRanges m;
  double v[2];
  inner_range(c, cell->v, v);
  if (!cag_curve_ranges(c->swept.section, cell->u[0], cell->u[1], 0, &section) ||
      !spoke_ranges(&c->swept, v[0], v[1], 0, &m))
    return 0;
  const CagInterval of[3] = {section.x, section.y, section.z};
  const CagInterval3 *spokes[3] = {m.x, m.y, m.z};
  double by_u = 0, by_v = width(m.origin[0]);
  for (int k = 0; k < 3; k++) {
    by_u += (of[k].hi - of[k].lo) * cag_interval3_size(*spokes[k]);
    by_v += cag_interval_size(of[k]) * width(*spokes[k]);
  }
  cell->across = by_v > by_u;
  return box_distance(partial(&c->swept, &section, &m, 0, 0), c->p);
}

// Bounds of half the squared distance on a cell.
typedef struct Bends {
  CagInterval slope[2];   // first derivatives
  CagInterval uu, uv, vv; // second derivatives
  double least;           // a lower bound of the squared distance
} Bends;

// `middle`: point and first derivatives at the middle. Returns false if the ranges are unknown.
static bool bend_ranges(const CagDistanceCells *c, const CagDistanceCell *cell,
                        const CagVec3 *middle, Bends *out) {
  const CagSwept *w = &c->swept;
  CagInterval3 section[SECOND + 1], d[SECOND + 1][SECOND + 1];
  CagMotionRanges m;
  double v[2];
  inner_range(c, cell->v, v);
  if (!cag_curve_ranges(w->section, cell->u[0], cell->u[1], SECOND, section) ||
      !spoke_ranges(w, v[0], v[1], SECOND, &m))
    return false;
  for (int i = 0; i <= SECOND; i++)
    for (int j = 0; i + j <= SECOND; j++) {
      d[i][j] = partial(w, section, &m, i, j);
      if (w->flip && j == 1) d[i][j] = scaled(d[i][j], cag_interval(-1));
    }
  const double hu = (cell->u[1] - cell->u[0]) / 2, hv = (cell->v[1] - cell->v[0]) / 2;
  d[1][0] = centered(d[1][0], middle[cag_partial(1, 1, 0)], d[2][0], hu, d[1][1], hv);
  d[0][1] = centered(d[0][1], middle[cag_partial(1, 0, 1)], d[1][1], hu, d[0][2], hv);
  const CagInterval3 r = less_point(centered(d[0][0], middle[0], d[1][0], hu, d[0][1], hv), c->p);
  out->slope[0] = dot(r, d[1][0]);
  out->slope[1] = dot(r, d[0][1]);
  out->uu = cag_interval_add(square(d[1][0]), dot(r, d[2][0]));
  out->uv = cag_interval_add(dot(d[1][0], d[0][1]), dot(r, d[1][1]));
  out->vv = cag_interval_add(square(d[0][1]), dot(r, d[0][2]));
  out->least = square(r).lo;
  return true;
}

// --- Cells of sweeps ---

// Records a point of the cell if it is the nearest so far.
static void note_point(CagDistanceCells *c, CagDistanceCell *cell, double u, double v,
                       CagVec3 point) {
  const CagVec3 r = cag_sub(point, c->p);
  const double distance = cag_dot(r, r);
  c->size = fmax(c->size, sqrt(distance));
  if (!(distance < cell->least)) return;
  cell->least = distance;
  cell->least_at[0] = cell->low_at[0] = u;
  cell->least_at[1] = cell->low_at[1] = v;
  cell->least_point = point;
}

// The end (0 or 1) at which a function with slopes in this range is lowest, or -1 if the slope may
// have both signs.
static int lowest_end(CagInterval slope) { return slope.lo >= 0 ? 0 : slope.hi <= 0 ? 1 : -1; }

// Bound from the tangents at the best point so far, or at the lowest known point, if the function
// is convex. In a direction in which it is monotone only the lowest end counts.
static CagStatus tangent_bound(const CagDistanceCells *c, const CagDistanceCell *cell,
                               const Bends *bend, double *out, CagError *err) {
  const int end[2] = {lowest_end(bend->slope[0]), lowest_end(bend->slope[1])};
  const bool both = end[0] < 0 && end[1] < 0;
  *out = -INFINITY;
  if (end[0] < 0 && !(bend->uu.lo > 0)) return CAG_OK;
  if (end[1] < 0 && !(bend->vv.lo > 0)) return CAG_OK;
  if (both && !(bend->uu.lo * bend->vv.lo > cag_interval_square(bend->uv).hi)) return CAG_OK;
  double at[2];
  CagSide side[2];
  CagVec3 d[4];
  bool hinted = true;
  for (int k = 0; k < 2; k++) {
    const double *range = k ? cell->v : cell->u;
    hinted = hinted && (end[k] >= 0 || (c->hint[k] >= range[0] && c->hint[k] <= range[1]));
  }
  for (int k = 0; k < 2; k++) {
    const double *range = k ? cell->v : cell->u;
    at[k] = end[k] >= 0 ? range[end[k]] : hinted ? c->hint[k] : cell->least_at[k];
    side[k] = at[k] >= range[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  }
  CagStatus status = cag_surface_eval(c->s, at[0], at[1], 1, side[0], side[1], d, err);
  if (status) return status;
  const CagVec3 r = cag_sub(d[0], c->p);
  *out = cag_dot(r, r);
  for (int k = 0; k < 2; k++) {
    const double *range = k ? cell->v : cell->u;
    const double slope = 2 * cag_dot(r, d[k ? cag_partial(1, 0, 1) : cag_partial(1, 1, 0)]);
    if (end[k] < 0) *out += fmin(slope * (range[0] - at[k]), slope * (range[1] - at[k]));
  }
  return CAG_OK;
}

static CagStatus bound_sweep(CagDistanceCells *c, CagDistanceCell *cell, CagError *err) {
  CagVec3 points[4], middle[4];
  const double mu = cell->u[0] + (cell->u[1] - cell->u[0]) / 2;
  const double mv = cell->v[0] + (cell->v[1] - cell->v[0]) / 2;
  Bends bend;
  CagStatus status = cag_surface_eval_grid(c->s, cell->u, 2, cell->v, 2, points, NULL, NULL, err);
  if (!status)
    status = cag_surface_eval(c->s, mu, mv, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, middle, err);
  if (status) return status;
  double low = INFINITY, most = 0, tangent;
  cell->least = INFINITY;
  note_point(c, cell, mu, mv, middle[0]);
  for (int k = 0; k < 4; k++) {
    const CagVec3 r = cag_sub(points[k], c->p);
    low = fmin(low, cag_dot(r, r));
    most = fmax(most, cag_dot(r, r));
    note_point(c, cell, cell->u[k / 2], cell->v[k % 2], points[k]);
  }
  const double rounding = ROUNDING * (most + c->size * sqrt(most));
  if (!bend_ranges(c, cell, middle, &bend)) {
    cell->bound = fmax(cell->bound, box_bound(c, cell) - rounding);
    return CAG_OK;
  }
  const double hu = cell->u[1] - cell->u[0], hv = cell->v[1] - cell->v[0];
  // The squared distance bends twice as much as its half.
  const double by_u = hu * hu / 4 * fmax(0, bend.uu.hi), by_v = hv * hv / 4 * fmax(0, bend.vv.hi);
  double bound = fmax(bend.least, low - by_u - by_v);
  cell->across = by_v > by_u;
  status = tangent_bound(c, cell, &bend, &tangent, err);
  if (!status) bound = fmax(bound, tangent);
  cell->bound = fmax(cell->bound, bound - rounding);
  return status;
}

// --- Cells of tubes ---

// The circle at v: the squared distance of p, p relative to the center, and the axes.
typedef struct Circle {
  double value;
  CagVec3 r, x, y;
} Circle;

static CagStatus circle_at(const CagDistanceCells *c, double v, CagSide side, Circle *out,
                           CagError *err) {
  const CagSwept *s = &c->swept;
  CagMotionSeries m;
  const double at = s->flip ? c->s->v0 + c->s->v1 - v : v;
  if (s->flip) side = side == CAG_SIDE_LEFT ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
  CagStatus status = cag_motion_at(s->motion, at, 0, side, &m, err);
  if (status) return status;
  const CagVec3 w = cag_sub(m.origin[0], s->p), z = m.z[0];
  const double length = cag_norm(z);
  // Components along the axis of the circle, and off the circle in its plane.
  const double along = length > 0 ? cag_dot(w, z) / length : cag_norm(w);
  const double off = length > 0 ? cag_norm(cag_cross(w, z)) / length - s->radius * length : 0;
  *out = (Circle){along * along + off * off, cag_scaled(w, -1), m.x[0], m.y[0]};
  return CAG_OK;
}

// u of the nearest point of the circle.
static double circle_nearest_u(const CagDistanceCells *c, const Circle *circle) {
  const double u = atan2(cag_dot(circle->r, circle->y), cag_dot(circle->r, circle->x));
  return fmin(u < 0 ? u + 2 * M_PI : u, c->s->u1);
}

// Second derivatives over the cell: the largest of w^2 + R^2 Z^2, the largest of R |w x Z|, and the
// least of the squared distance. Returns false if the ranges are unknown.
static bool tube_bends(const CagDistanceCells *c, const CagDistanceCell *cell, double out[3]) {
  const CagSwept *s = &c->swept;
  CagMotionRanges m;
  CagInterval3 g[SECOND + 1];
  double v[2];
  inner_range(c, cell->v, v);
  if (!cag_motion_ranges(s->motion, v[0], v[1], SECOND, &m)) return false;
  m.origin[0] = less_point(m.origin[0], s->p);
  cag_intervals3_cross(m.origin, m.z, SECOND, g);
  const double radius = s->radius;
  CagInterval q = cag_interval_scaled(
      cag_interval_add(square(m.origin[1]), cag_interval_scaled(dot(m.origin[0], m.origin[2]), 2)),
      2);
  if (!cag_along_is_constant(&cag_motion_how(s->motion)->scale, 1)) {
    const CagInterval z =
        cag_interval_add(square(m.z[1]), cag_interval_scaled(dot(m.z[0], m.z[2]), 2));
    q = cag_interval_add(q, cag_interval_scaled(z, 2 * radius * radius));
  }
  out[0] = fmax(0, q.hi);
  out[1] = 2 * radius * cag_interval3_size(g[2]);
  // |g|'' <= (g'^2 + g g'') / |g|
  const double least = sqrt(square(g[0]).lo);
  const double most = cag_interval_add(square(g[1]), cag_interval_scaled(dot(g[0], g[2]), 2)).hi;
  out[2] = least > 0 ? q.lo - 2 * radius * fmax(most, 0) / least : -INFINITY;
  return true;
}

// Bound of a convex function from the tangent at the best point so far, or at the nearer end. Its
// slope is the derivative of the squared distance in v at the nearest point of the circle.
static CagStatus tube_tangent(const CagDistanceCells *c, const CagDistanceCell *cell,
                              const Circle ends[2], double *out, CagError *err) {
  const double *v = cell->v;
  double at = ends[0].value < ends[1].value ? v[0] : v[1];
  Circle circle = ends[0].value < ends[1].value ? ends[0] : ends[1];
  CagStatus status = CAG_OK;
  CagVec3 d[4];
  if (c->hint[1] >= v[0] && c->hint[1] <= v[1]) {
    at = c->hint[1];
    status = circle_at(c, at, at >= v[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, &circle, err);
  }
  const CagSide side = at >= v[1] ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  if (!status)
    status =
        cag_surface_eval(c->s, circle_nearest_u(c, &circle), at, 1, CAG_SIDE_RIGHT, side, d, err);
  if (status) return status;
  const double slope = 2 * cag_dot(cag_sub(d[0], c->p), d[cag_partial(1, 0, 1)]);
  const double value = c->swept.scale * c->swept.scale * circle.value;
  *out = value + fmin(slope * (v[0] - at), slope * (v[1] - at));
  return CAG_OK;
}

static CagStatus bound_tube(CagDistanceCells *c, CagDistanceCell *cell, CagError *err) {
  Circle ends[2];
  double bend[3], tangent;
  const double *v = cell->v, h = v[1] - v[0], scale = c->swept.scale * c->swept.scale;
  CagStatus status = CAG_OK;
  cell->least = INFINITY;
  for (int k = 0; !status && k < 2; k++) {
    const CagSide side = k == 1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagVec3 point;
    status = circle_at(c, v[k], side, &ends[k], err);
    const double u = status ? 0 : circle_nearest_u(c, &ends[k]);
    if (!status) status = cag_surface_point(c->s, u, v[k], &point, err);
    if (!status) note_point(c, cell, u, v[k], point);
  }
  if (status) return status;
  if (!tube_bends(c, cell, bend)) {
    cell->bound = fmax(cell->bound, box_bound(c, cell));
    cell->across = true;
    return CAG_OK;
  }
  cell->across = true;
  double bound = fmin(ends[0].value, ends[1].value) - h * h / 8 * (bend[0] + 2 * bend[1]);
  bound *= scale;
  if (bend[2] > 0) {
    status = tube_tangent(c, cell, ends, &tangent, err);
    if (!status) bound = fmax(bound, tangent);
  }
  const double most = scale * fmax(ends[0].value, ends[1].value);
  cell->bound = fmax(cell->bound, bound - ROUNDING * (most + c->size * sqrt(most)));
  return status;
}

CagStatus cag_swept_cell_bound(CagDistanceCells *c, CagDistanceCell *cell, CagError *err) {
  return c->swept.tube ? bound_tube(c, cell, err) : bound_sweep(c, cell, err);
}

// --- The first cells ---

// Adds cells for u over [cuts[i], cuts[i + 1]], in `parts` cells each.
static CagStatus push_row(CagDistanceCells *c, const double v[2], const CagMotionRanges *m,
                          const double *cuts, size_t pieces, size_t parts, CagError *err) {
  CagStatus status = CAG_OK;
  const CagSwept *w = &c->swept;
  for (size_t i = 0; !status && i < pieces * parts; i++) {
    CagDistanceCell cell = {
        .u = {cag_cut_part(cuts, i, parts), cag_cut_part(cuts, i + 1, parts)},
        .v = {v[0], v[1]},
        .whole = true,
        .raw = true,
    };
    CagInterval3 section;
    if (m && cag_curve_ranges(w->section, cell.u[0], cell.u[1], 0, &section))
      cell.bound = box_distance(partial(w, &section, m, 0, 0), c->p);
    status = cag_distance_cells_push(c, &cell, err);
  }
  return status;
}

CagStatus cag_swept_cells_push(CagDistanceCells *c, CagError *err) {
  const CagSwept *w = &c->swept;
  double *joints = NULL, *cuts = NULL, a, b;
  size_t rows, columns = 0;
  CagTransform frame;
  CagStatus status = find_joints(w, &joints, &rows, err);
  if (!status) status = cag_surface_cuts(c->s, 0, &cuts, &columns, err);
  const bool round = cag_curve_arc_view(w->section, &a, &b, &frame);
  const size_t parts = w->tube ? 1 : round ? ROUND_PARTS : OTHER_PARTS;
  for (size_t j = 0; !status && j < rows; j++) {
    CagMotionRanges m;
    const bool known = spoke_ranges(w, joints[j], joints[j + 1], 0, &m);
    double v[2];
    inner_range(c, joints + j, v); // its own inverse
    status = push_row(c, v, known ? &m : NULL, cuts, columns, parts, err);
  }
  cag_free(joints);
  cag_free(cuts);
  return status;
}
