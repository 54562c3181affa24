// Offsets of regions: the points within a distance of a region, or of its inside.
//
// A strip of the width |d| lies along each smooth part of the boundary, on the side to which it
// moves, and a sector at each corner that bends away from that side. The curve around region and
// strips (grown), or around the region without the strips (shrunk), runs along the shifted parts,
// by arcs about such corners, and through all other corners. The winding number of the curve about
// a point is that of the region plus (minus) the number of strips and sectors that contain the
// point. The result consists of the points with a positive winding number, so crossings need no
// separate treatment.
//
// Strips are oriented: where a part bends towards its strip with a radius below |d|, the strip
// folds over, and the area beyond the fold would count negatively. Such parts are not moved;
// instead the whole neighborhood of the part is added (removed). The curve around it, with both
// sides and a half circle at each end, runs around each point as often as the part has intervals
// within |d| of the point (the sublevel sets of a function on an interval), so at least once if the
// point is within |d| and never otherwise. Such a part extends a little beyond the point where the
// strip begins to fold, so that its ends are not cusps of the shifted curve.

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/family.h"
#include "geom/curve/region_arrange.h"
#include "geom/linalg/tolerance.h"

// Turns below this (sine) are not corners.
#define TURN CAG_PARALLEL
// A strip folds if its far side moves at less than this fraction of the near side's speed.
#define FOLD 0.05
// Samples of a smooth part, dense enough that the radius of curvature passes |d| at most once
// between two of them.
#define SAMPLES 32
// Enough bisections to reduce an interval to neighboring doubles.
#define BISECTIONS 80
// Maximum relative difference of the axes of a circle; a circle shrunk to this fraction is a point.
#define ROUND CAG_ROUNDING

typedef struct Raw {
  CagCurve **curves; // owned
  CagWalk *walks;
  size_t n, capacity;
  double left, tolerance; // distance by which the boundary moves to its left
  bool near;              // some of the curves are accurate only to the tolerance
} Raw;

// Takes ownership of the curve.
static CagStatus put(Raw *raw, CagCurve *c, int sign, CagError *err) {
  if (raw->n == raw->capacity) {
    size_t capacity = raw->capacity ? 2 * raw->capacity : 32;
    if (!CAG_RESIZE(raw->curves, capacity) || !CAG_RESIZE(raw->walks, capacity)) {
      cag_curve_release(c);
      return cag_fail_memory(err);
    }
    raw->capacity = capacity;
  }
  raw->walks[raw->n] = (CagWalk){c, 0, sign, -1};
  raw->curves[raw->n++] = c;
  return CAG_OK;
}

static CagStatus put_line(Raw *raw, CagVec3 p, CagVec3 q, int sign, CagError *err) {
  if (p.x == q.x && p.y == q.y) return CAG_OK;
  CagCurve *line;
  CagStatus status = cag_curve_line(p, q, 2, &line, err);
  return status ? status : put(raw, line, sign, err);
}

// The arc about the center from one point to the other, counter-clockwise or clockwise.
static CagStatus put_arc(Raw *raw, CagVec3 center, CagVec3 from, CagVec3 to, bool clockwise,
                         int sign, CagError *err) {
  const CagVec3 a = cag_sub(from, center), b = cag_sub(to, center);
  const double radius = cag_norm(a);
  double turn = atan2(cag_cross(a, b).z, cag_dot(a, b));
  if (clockwise) turn = -turn;
  if (turn <= 0) turn += 2 * M_PI;
  const CagVec3 x = cag_scaled(a, 1 / radius);
  const double sense = clockwise ? -1 : 1;
  CagTransform frame = cag_translate(center);
  frame.m[0][0] = x.x;
  frame.m[1][0] = x.y;
  frame.m[0][1] = -sense * x.y;
  frame.m[1][1] = sense * x.x;
  frame.planar = true;
  CagCurve *arc;
  CagStatus status = cag_curve_arc(radius, radius, 0, turn, &frame, &arc, err);
  return status ? status : put(raw, arc, sign, err);
}

// --- Smooth parts ---

typedef struct Part {
  CagCurve *curve;
  bool folds; // bends towards the side it moves to, with a radius below the distance
  CagVec3 ends[2], tangents[2];
} Part;

typedef struct Parts {
  Part *items;
  size_t n, capacity;
} Parts;

static void parts_free(Parts *p) {
  for (size_t i = 0; i < p->n; i++) cag_curve_release(p->items[i].curve);
  cag_free(p->items);
}

static bool is_line(const CagCurve *c) {
  const CagVec3 *v;
  size_t n;
  bool closed;
  return cag_curve_vertices(c, &v, &n, &closed);
}

// Center, radius, and orientation of an arc of a circle; false for other curves.
static bool circle_of(const CagCurve *c, CagVec3 *center, double *radius, double *sense) {
  CagVec3 x, y;
  double rate;
  if (!cag_curve_arc_axes(c, center, &x, &y, &rate)) return false;
  const double a = cag_norm(x), b = cag_norm(y);
  *radius = a;
  *sense = rate * cag_cross(x, y).z > 0 ? 1 : -1;
  return fabs(a - b) <= ROUND * a && fabs(cag_dot(x, y)) <= ROUND * a * b;
}

// Positive if the far side of a strip of the width `left` moves faster than `least` times the speed
// of the near side: |C'|^3 (1 - left k - least).
static CagStatus room(const CagCurve *c, double left, double least, double t, double *out,
                      CagError *err) {
  CagVec3 d[3];
  CagStatus status = cag_curve_eval(c, t, 2, t >= c->end ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const double speed = cag_norm(d[1]);
  *out = (1 - least) * speed * speed * speed - left * cag_cross(d[1], d[2]).z;
  return CAG_OK;
}

// Takes ownership of the curve.
static CagStatus add_part(Parts *parts, CagCurve *c, bool folds, CagError *err) {
  CagStatus status = CAG_OK;
  if (!CAG_RESERVE(parts->items, parts->capacity, parts->n + 1)) status = cag_fail_memory(err);
  Part p = {.curve = c, .folds = folds};
  if (!status) status = cag_curve_point(c, c->start, &p.ends[0], err);
  if (!status) status = cag_curve_point(c, c->end, &p.ends[1], err);
  if (!status) status = cag_curve_tangent(c, c->start, CAG_SIDE_RIGHT, &p.tangents[0], err);
  if (!status) status = cag_curve_tangent(c, c->end, CAG_SIDE_LEFT, &p.tangents[1], err);
  if (status) cag_curve_release(c);
  else parts->items[parts->n++] = p;
  return status;
}

static CagStatus add_over(Parts *parts, const CagCurve *c, double a, double b, bool folds,
                          CagError *err) {
  CagCurve *part;
  if (!(a < b)) return CAG_OK;
  CagStatus status = cag_curve_trim(c, a, b, &part, err);
  return status ? status : add_part(parts, part, folds, err);
}

// Cuts the part where the room changes sign.
static CagStatus add_bent(Parts *parts, const CagCurve *c, double left, double least,
                          CagError *err) {
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  double from = c->start, before = c->start, f = 0;
  status = room(c, left, least, c->start, &f, err);
  bool folds = f < 0, known = f != 0;
  for (size_t i = 0; !status && i + 1 < n; i++)
    for (int k = 1; !status && k <= SAMPLES; k++) {
      const double t = k == SAMPLES ? cuts[i + 1] : cuts[i] + (cuts[i + 1] - cuts[i]) * k / SAMPLES;
      status = room(c, left, least, t, &f, err);
      if (!status && f != 0 && !known) {
        folds = f < 0;
        known = true;
      }
      if (!status && f != 0 && (f < 0) != folds) {
        double lo = before, hi = t, g = 0;
        for (int j = 0; !status && j < BISECTIONS && lo + (hi - lo) / 2 > lo; j++) {
          const double m = lo + (hi - lo) / 2;
          status = room(c, left, least, m, &g, err);
          if ((g < 0) == folds) lo = m;
          else hi = m;
        }
        if (!status) status = add_over(parts, c, from, hi, folds, err);
        from = hi;
        folds = !folds;
      }
      before = t;
    }
  cag_free(cuts);
  return status ? status : add_over(parts, c, from, c->end, folds, err);
}

// Adds a smooth part of the boundary, cut further if necessary; whole circles that fold are cut in
// two, because a neighborhood has ends.
static CagStatus add_smooth(Parts *parts, const CagCurve *c, double left, CagError *err) {
  CagVec3 center;
  double radius, sense;
  if (is_line(c)) return add_over(parts, c, c->start, c->end, false, err);
  const double middle = c->start + (c->end - c->start) / 2;
  CagStatus status;
  if (!circle_of(c, &center, &radius, &sense)) {
    const size_t first = parts->n;
    status = add_bent(parts, c, left, FOLD, err);
    if (status || !c->closed || parts->n != first + 1 || !parts->items[first].folds) return status;
    cag_curve_release(parts->items[--parts->n].curve);
    status = add_over(parts, c, c->start, middle, true, err);
    return status ? status : add_over(parts, c, middle, c->end, true, err);
  }
  const bool folds = radius - sense * left <= ROUND * radius;
  if (!folds) return add_over(parts, c, c->start, c->end, false, err);
  status = add_over(parts, c, c->start, middle, true, err);
  return status ? status : add_over(parts, c, middle, c->end, true, err);
}

// Whether the curve is smooth at one of its breaks.
static CagStatus is_smooth(const CagCurve *c, double t, bool *out, CagError *err) {
  CagVec3 left, right;
  CagStatus status = cag_curve_tangent(c, t, CAG_SIDE_LEFT, &left, err);
  if (!status) status = cag_curve_tangent(c, t, CAG_SIDE_RIGHT, &right, err);
  *out = !status && fabs(cag_cross(left, right).z) <= TURN && cag_dot(left, right) > 0;
  return status;
}

// The part over [a, b] of the boundary, which is of one kind.
static CagStatus take_part(const CagCurve *c, double a, double b, bool straight, CagCurve **out,
                           CagError *err) {
  double local_a, local_b, rate;
  if (straight) {
    CagVec3 p, q;
    CagStatus status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &p, err);
    if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &q, err);
    return status ? status : cag_curve_line(p, q, 2, out, err);
  }
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &local_a, &local_b, &rate);
  return piece ? cag_curve_trim(piece, local_a, local_b, out, err)
               : cag_curve_trim(c, a, b, out, err);
}

// Whether [a, b] is as short as rounding, in the parameter and in the plane.
static CagStatus is_nothing(const CagCurve *c, double a, double b, double size, bool *out,
                            CagError *err) {
  const double nothing = CAG_ROUNDING; // fraction of the whole
  CagVec3 p, q;
  *out = !(a < b);
  if (*out) return CAG_OK;
  CagStatus status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &p, err);
  if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &q, err);
  *out = b - a <= nothing * (c->end - c->start) && cag_norm(cag_sub(p, q)) <= nothing * size;
  return status;
}

static CagStatus add_loop(Parts *parts, const CagCurve *c, double left, CagError *err) {
  const CagBounds box = c->kind->hull(c, c->start, c->end);
  const double size = cag_norm(cag_sub(box.max, box.min));
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  double from = cuts[0];
  for (size_t i = 1; !status && i < n; i++) {
    double local_a, local_b, rate;
    const CagCurve *piece =
        cag_curve_composite_piece(c, cuts[i - 1], cuts[i], &local_a, &local_b, &rate);
    const bool straight = is_line(piece ? piece : c);
    bool smooth = false, nothing = false;
    // The joint of two pieces is always a cut, since each has its own kind.
    if (i + 1 < n && !straight && !(piece && local_b == piece->end))
      status = is_smooth(c, cuts[i], &smooth, err);
    if (status || smooth) continue;
    status = is_nothing(c, from, cuts[i], size, &nothing, err);
    CagCurve *part = NULL;
    if (!status && !nothing) status = take_part(c, from, cuts[i], straight, &part, err);
    if (part) status = add_smooth(parts, part, left, err);
    cag_curve_release(part);
    from = cuts[i];
  }
  cag_free(cuts);
  return status;
}

// --- The surrounding curve ---

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }

// The part shifted to its left; *out is NULL if it shrinks to a point.
static CagStatus shifted(const Part *p, double left, double tolerance, CagCurve **out,
                         CagError *err) {
  CagVec3 center;
  double radius, sense;
  *out = NULL;
  if (!circle_of(p->curve, &center, &radius, &sense))
    return cag_curve_offset(p->curve, left, tolerance, out, err);
  const double factor = 1 - sense * left / radius;
  if (fabs(factor) <= ROUND) return CAG_OK;
  CagTransform t = cag_translate(cag_scaled(center, 1 - factor));
  t.m[0][0] = t.m[1][1] = factor; // negative: rotated by half a turn, with the same orientation
  t.planar = true;
  return cag_curve_transform(p->curve, &t, out, err);
}

static CagVec3 moved_end(const Part *p, int end, double left) {
  return cag_madd(p->ends[end], left, left_of(p->tangents[end]));
}

// Whether the strips of two segments at an inner corner both cover the triangle of the corner and
// the strips' ends. Counted once less, it is still covered, and the detour to the corner is
// unnecessary.
static bool overlaps(const Part *a, const Part *b, double left) {
  if (a->folds || b->folds || !is_line(a->curve) || !is_line(b->curve)) return false;
  const double reach = fabs(left * cag_cross(a->tangents[1], b->tangents[0]).z);
  return cag_dot(a->tangents[1], b->tangents[0]) > 0 &&
         reach <= cag_norm(cag_sub(a->ends[1], a->ends[0])) &&
         reach <= cag_norm(cag_sub(b->ends[1], b->ends[0]));
}

// From the end of one part's strip to the start of the next one's.
static CagStatus put_corner(Raw *raw, const Part *a, const Part *b, CagError *err) {
  const CagVec3 corner = b->ends[0];
  const CagVec3 from = a->folds ? corner : moved_end(a, 1, raw->left),
                to = b->folds ? corner : moved_end(b, 0, raw->left);
  if (!a->folds && !b->folds) {
    const double sine = cag_cross(a->tangents[1], b->tangents[0]).z,
                 cosine = cag_dot(a->tangents[1], b->tangents[0]);
    if (fabs(sine) <= TURN && cosine > 0) return put_line(raw, from, to, 1, err);
    if ((raw->left > 0) == (sine < 0) || fabs(sine) <= TURN)
      return put_arc(raw, corner, from, to, raw->left > 0, 1, err);
  }
  if (overlaps(a, b, raw->left)) return put_line(raw, from, to, 1, err);
  CagStatus status = put_line(raw, from, corner, 1, err);
  return status ? status : put_line(raw, corner, to, 1, err);
}

static CagStatus put_shifted(Raw *raw, const Part *p, double left, bool backwards, int sign,
                             CagError *err) {
  CagCurve *side, *turned;
  CagStatus status = shifted(p, left, raw->tolerance, &side, err);
  if (status || !side) return status;
  CagVec3 center;
  double radius, sense;
  raw->near = raw->near || !(is_line(p->curve) || circle_of(p->curve, &center, &radius, &sense));
  if (!backwards) return put(raw, side, sign, err);
  status = cag_curve_reverse(side, &turned, err);
  cag_curve_release(side);
  return status ? status : put(raw, turned, sign, err);
}

// One side of a part; if it has cusps, each of the curves between them.
static CagStatus put_side(Raw *raw, const Part *p, double left, bool backwards, int sign,
                          CagError *err) {
  CagVec3 center;
  double radius, sense;
  if (!p->folds || is_line(p->curve) || circle_of(p->curve, &center, &radius, &sense))
    return put_shifted(raw, p, left, backwards, sign, err);
  Parts between = {0};
  CagStatus status = add_bent(&between, p->curve, left, 0, err);
  for (size_t i = 0; !status && i < between.n; i++)
    status = put_shifted(raw, &between.items[i], left, backwards, sign, err);
  parts_free(&between);
  return status;
}

// The counter-clockwise curve around all points within the distance of the part.
static CagStatus put_neighborhood(Raw *raw, const Part *p, CagError *err) {
  const double d = fabs(raw->left);
  const int sign = raw->left < 0 ? 1 : -1;
  CagStatus status = put_side(raw, p, -d, false, sign, err);
  if (!status)
    status = put_arc(raw, p->ends[1], moved_end(p, 1, -d), moved_end(p, 1, d), false, sign, err);
  if (!status) status = put_side(raw, p, d, true, sign, err);
  if (!status)
    status = put_arc(raw, p->ends[0], moved_end(p, 0, d), moved_end(p, 0, -d), false, sign, err);
  return status;
}

static CagStatus put_loop(Raw *raw, const CagCurve *loop, CagError *err) {
  Parts parts = {0};
  CagStatus status = add_loop(&parts, loop, raw->left, err);
  for (size_t i = 0; !status && i < parts.n; i++) {
    const Part *p = &parts.items[i];
    // A smooth closed curve moves to a closed curve.
    if (parts.n > 1 || !p->curve->closed)
      status = put_corner(raw, &parts.items[(i + parts.n - 1) % parts.n], p, err);
    else {
      bool smooth = fabs(cag_cross(p->tangents[0], p->tangents[1]).z) <= TURN &&
                    cag_dot(p->tangents[0], p->tangents[1]) > 0;
      if (!smooth) status = put_corner(raw, p, p, err);
    }
    if (!status && !p->folds) status = put_side(raw, p, raw->left, false, 1, err);
    if (!status && p->folds) status = put(raw, cag_curve_retain(p->curve), 1, err);
    if (!status && p->folds) status = put_neighborhood(raw, p, err);
  }
  parts_free(&parts);
  return status;
}

static bool is_inside(const int winding[2], int parameter) {
  (void)parameter;
  return winding[0] > 0;
}

// The largest disc in the region has at most the region's area, and fits into its box.
static CagStatus largest_disc(const CagRegion *r, double *out, CagError *err) {
  double area;
  CagBounds box;
  CagStatus status = cag_region_area(r, &area, NULL, err);
  if (!status) status = cag_region_bounds(r, &box, err);
  if (status) return status;
  *out = fmin(fmin(box.max.x - box.min.x, box.max.y - box.min.y) / 2, sqrt(area / M_PI));
  return CAG_OK;
}

// Relative to the region's size: a distance below the first is rounding; for one above the second
// the region itself is below rounding.
#define NO_DISTANCE CAG_ROUNDING
#define FAR 1e9

// --- Shrinking convex polygons ---
//
// The result is bounded only by the shifted lines of the edges, which are sorted by direction: each
// cuts off the ends of the chain of the previous ones. This takes linear time, while an arrangement
// would intersect all strips near the middle with each other.

// The half plane to the left of a line.
typedef struct Half {
  CagVec3 at, along; // along: unit
} Half;

typedef struct Chain {
  Half *halves;
  size_t first, end; // the remaining ones: first .. end - 1
  double slack;      // lengths below this are rounding
} Chain;

static CagVec3 meeting(const Half *a, const Half *b) {
  const double t = cag_cross(cag_sub(b->at, a->at), b->along).z / cag_cross(a->along, b->along).z;
  return cag_madd(a->at, t, a->along);
}

static bool leaves_out(const Half *h, CagVec3 p) {
  return cag_cross(h->along, cag_sub(p, h->at)).z <= 0;
}

// False: nothing is left.
static bool cut_chain(Chain *c, Half h) {
  const Half *all = c->halves;
  while (c->end - c->first > 1 && leaves_out(&h, meeting(&all[c->end - 2], &all[c->end - 1])))
    c->end--;
  while (c->end - c->first > 1 && leaves_out(&h, meeting(&all[c->first], &all[c->first + 1])))
    c->first++;
  if (c->end > c->first && !(cag_cross(all[c->end - 1].along, h.along).z > 0)) return false;
  c->halves[c->end++] = h;
  return true;
}

// The loop's edges shifted to the left by `left`; false if it is not a convex polygon that runs
// counter-clockwise once.
static bool move_edges(const CagVec3 *v, size_t n, double left, Half *out, size_t *count) {
  double turned = 0;
  *count = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 p = v[i], step = cag_sub(v[(i + 1) % n], p);
    if (!(cag_norm(step) > 0)) continue;
    const CagVec3 u = cag_unit(step);
    if (*count > 0) {
      const CagVec3 before = out[*count - 1].along;
      const double sine = cag_cross(before, u).z, cosine = cag_dot(before, u);
      if (fabs(sine) <= TURN && cosine > 0) continue; // collinear with the previous edge
      if (sine < 0) return false;
      turned += atan2(sine, cosine);
    }
    out[(*count)++] = (Half){cag_madd(p, left, cag_vec3(-u.y, u.x, 0)), u};
  }
  if (*count < 3) return false;
  const CagVec3 first = out[0].along, last = out[*count - 1].along;
  const double sine = cag_cross(last, first).z, cosine = cag_dot(last, first);
  turned += atan2(sine, cosine);
  if (fabs(sine) <= TURN && cosine > 0) --*count; // the loop starts on a line
  else if (sine < 0) return false;
  return turned < 3 * M_PI;
}

static CagStatus polygon_of(const Chain *c, CagRegion **out, CagError *err) {
  const size_t n = c->end - c->first;
  CagVec3 *v = cag_malloc((n + 1) * sizeof *v);
  if (!v) return cag_fail_memory(err);
  size_t kept = 0;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 p = meeting(&c->halves[c->first + i], &c->halves[c->first + (i + 1) % n]);
    if (kept == 0 || cag_norm(cag_sub(p, v[kept - 1])) > c->slack) v[kept++] = p;
  }
  while (kept > 1 && !(cag_norm(cag_sub(v[kept - 1], v[0])) > c->slack)) kept--;
  CagCurve *loop = NULL;
  CagStatus status = CAG_OK;
  *out = NULL;
  if (kept > 2) {
    status = cag_curve_polyline(v, kept, true, 2, &loop, err);
    if (!status) status = cag_region_new(loop, NULL, 0, out, err);
    cag_curve_release(loop);
  }
  cag_free(v);
  return status;
}

// *taken is false if the region is not a convex polygon. *out is NULL if nothing is left.
static CagStatus shrink_convex(const CagRegion *r, double d, double size, bool *taken,
                               CagRegion **out, CagError *err) {
  const CagVec3 *v;
  size_t n, count;
  bool closed;
  *taken = false;
  *out = NULL;
  if (r->count != 1 || !cag_curve_vertices(r->loops[0], &v, &n, &closed)) return CAG_OK;
  Half *moved = cag_malloc((2 * n + 2) * sizeof *moved);
  if (!moved) return cag_fail_memory(err);
  Chain c = {moved + n + 1, 0, 0, NO_DISTANCE * size};
  *taken = move_edges(v, n, d, moved, &count);
  bool left = *taken;
  for (size_t i = 0; left && i < count; i++) left = cut_chain(&c, moved[i]);
  const Half *all = c.halves;
  while (left && c.end - c.first > 2 &&
         leaves_out(&all[c.first], meeting(&all[c.end - 2], &all[c.end - 1])))
    c.end--;
  left = left && c.end - c.first > 2 && cag_cross(all[c.end - 1].along, all[c.first].along).z > 0;
  const CagStatus status = left ? polygon_of(&c, out, err) : CAG_OK;
  cag_free(moved);
  return status;
}

CagStatus cag_region_offset(const CagRegion *r, double d, double tolerance, CagRegion **out,
                            CagError *err) {
  CagStatus status = cag_curve_check_number(d, "d", err);
  CagBounds box;
  double disc = 0;
  if (!status && cag_region_is_empty(r)) return cag_region_empty(out, err);
  if (!status) status = cag_region_bounds(r, &box, err);
  if (!status && d < 0) status = largest_disc(r, &disc, err);
  if (status) return status;
  const double size = cag_norm(cag_sub(box.max, box.min)), slack = 1e-6;
  char text[32];
  if (d < 0 && -d > disc * (1 + slack)) return cag_region_empty(out, err);
  if (d > FAR * size)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_far, "d", -1,
                    "`d` must be at most 1e9 times the size of the region, found %s",
                    cag_number_text(d, text));
  if (fabs(d) <= NO_DISTANCE * size) {
    *out = cag_region_retain(r);
    return CAG_OK;
  }
  bool convex = false;
  if (d < 0) status = shrink_convex(r, -d, size, &convex, out, err);
  if (status || convex) return status || *out ? status : cag_region_empty(out, err);
  Raw raw = {.left = -d, .tolerance = tolerance}; // the region lies to the left of its boundary
  for (size_t i = 0; !status && i < r->count; i++) status = put_loop(&raw, r->loops[i], err);
  if (!status)
    status = cag_region_arrange(raw.walks, raw.n, is_inside, 0, raw.near ? tolerance : 0, out, err);
  for (size_t i = 0; i < raw.n; i++) cag_curve_release(raw.curves[i]);
  cag_free(raw.curves);
  cag_free(raw.walks);
  return status || *out ? status : cag_region_empty(out, err);
}
