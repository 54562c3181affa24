// Strips along plane curves: their parts, sides, and joins.

#include "geom/curve/strip.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/approximate.h"
#include "geom/curve/biarc.h"
#include "geom/curve/family.h"
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

// --- Parts ---

void cag_strip_parts_free(CagStripParts *parts) {
  for (size_t i = 0; i < parts->n; i++) cag_curve_release(parts->items[i].curve);
  cag_free(parts->items);
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
static CagStatus add_part(CagStripParts *parts, CagCurve *c, bool folds, CagError *err) {
  CagStatus status = CAG_OK;
  if (!CAG_RESERVE(parts->items, parts->capacity, parts->n + 1)) status = cag_fail_memory(err);
  CagStripPart p = {.curve = c, .folds = folds, .straight = is_line(c)};
  p.round = circle_of(c, &p.center, &p.radius, &p.sense);
  if (!status) status = cag_curve_point(c, c->start, &p.ends[0], err);
  if (!status) status = cag_curve_point(c, c->end, &p.ends[1], err);
  if (!status) status = cag_curve_tangent(c, c->start, CAG_SIDE_RIGHT, &p.tangents[0], err);
  if (!status) status = cag_curve_tangent(c, c->end, CAG_SIDE_LEFT, &p.tangents[1], err);
  if (status) cag_curve_release(c);
  else parts->items[parts->n++] = p;
  return status;
}

CagStatus cag_strip_parts_copy(CagStripParts *parts, const CagStripPart *p, CagError *err) {
  return add_part(parts, cag_curve_retain(p->curve), p->folds, err);
}

static CagStatus add_over(CagStripParts *parts, const CagCurve *c, double a, double b, bool folds,
                          CagError *err) {
  CagCurve *part;
  if (!(a < b)) return CAG_OK;
  CagStatus status = cag_curve_trim(c, a, b, &part, err);
  return status ? status : add_part(parts, part, folds, err);
}

// Cuts the part where the room changes sign.
static CagStatus add_bent(CagStripParts *parts, const CagCurve *c, double left, double least,
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
static CagStatus add_smooth(CagStripParts *parts, const CagCurve *c, double left, CagError *err) {
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

CagStatus cag_strip_parts_add(CagStripParts *parts, const CagCurve *c, double left, CagError *err) {
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

// --- Parts that fold as arcs ---

typedef struct Arcs {
  CagStripParts *parts;
  double left;
  bool both;
} Arcs;

static CagStatus add_step(void *context, const CagArcStep *step, CagError *err) {
  Arcs *a = context;
  CagCurve *c;
  if (step->from.x == step->to.x && step->from.y == step->to.y) return CAG_OK;
  const bool folds =
      fabs(step->radius) <= fabs(a->left) && (a->both || (step->radius > 0) == (a->left > 0));
  CagStatus status = cag_arc_step_curve(step, &c, err);
  return status ? status : add_part(a->parts, c, folds, err);
}

CagStatus cag_strip_parts_unfold(CagStripParts *parts, double left, bool both, double tolerance,
                                 bool *near, CagError *err) {
  CagStripParts all = {0};
  Arcs arcs = {&all, left, both};
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < parts->n; i++) {
    const CagStripPart *p = &parts->items[i];
    const bool replaced = p->folds && !p->round;
    *near = *near || replaced;
    status = replaced ? cag_curve_arcs(p->curve, tolerance, add_step, &arcs, err)
                      : cag_strip_parts_copy(&all, p, err);
  }
  cag_strip_parts_free(parts);
  *parts = all;
  return status;
}

// --- Sides ---

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }

CagVec3 cag_strip_end(const CagStripPart *p, int end, double left) {
  return cag_madd(p->ends[end], left, left_of(p->tangents[end]));
}

// The part shifted to its left; *out is NULL if it shrinks to a point.
static CagStatus shifted(const CagStripPart *p, double left, double tolerance, CagCurve **out,
                         CagError *err) {
  *out = NULL;
  if (!p->round) return cag_curve_offset(p->curve, left, tolerance, out, err);
  const double factor = 1 - p->sense * left / p->radius;
  if (fabs(factor) <= ROUND) return CAG_OK;
  CagTransform t = cag_translate(cag_scaled(p->center, 1 - factor));
  t.m[0][0] = t.m[1][1] = factor; // negative: rotated by half a turn, with the same orientation
  t.planar = true;
  return cag_curve_transform(p->curve, &t, out, err);
}

CagStatus cag_strip_put_shifted(CagWalks *w, const CagStripPart *p, double left, double tolerance,
                                bool backwards, int sign, bool *near, CagError *err) {
  CagCurve *side, *turned;
  CagStatus status = shifted(p, left, tolerance, &side, err);
  if (status || !side) return status;
  *near = *near || !(p->straight || p->round);
  if (!backwards) return cag_walks_put(w, side, sign, err);
  status = cag_curve_reverse(side, &turned, err);
  cag_curve_release(side);
  return status ? status : cag_walks_put(w, turned, sign, err);
}

// One side of a part; if it has cusps, each of the curves between them.
static CagStatus put_side(CagWalks *w, const CagStripPart *p, double left, double tolerance,
                          bool backwards, int sign, bool *near, CagError *err) {
  if (!p->folds || p->straight || p->round)
    return cag_strip_put_shifted(w, p, left, tolerance, backwards, sign, near, err);
  CagStripParts between = {0};
  CagStatus status = add_bent(&between, p->curve, left, 0, err);
  for (size_t i = 0; !status && i < between.n; i++)
    status =
        cag_strip_put_shifted(w, &between.items[i], left, tolerance, backwards, sign, near, err);
  cag_strip_parts_free(&between);
  return status;
}

CagStatus cag_strip_put_neighborhood(CagWalks *w, const CagStripPart *p, double d, double tolerance,
                                     int sign, bool *near, CagError *err) {
  CagStatus status = put_side(w, p, -d, tolerance, false, sign, near, err);
  if (!status)
    status = cag_walks_put_arc(w, p->ends[1], cag_strip_end(p, 1, -d), cag_strip_end(p, 1, d),
                               false, sign, err);
  if (!status) status = put_side(w, p, d, tolerance, true, sign, near, err);
  if (!status)
    status = cag_walks_put_arc(w, p->ends[0], cag_strip_end(p, 0, d), cag_strip_end(p, 0, -d),
                               false, sign, err);
  return status;
}

CagStatus cag_strip_put_beyond(CagWalks *w, const CagStripPart *p, double d, int sign,
                               CagError *err) {
  const int first = p->sense > 0 ? 0 : 1; // the end at which a counter-clockwise arc starts
  const double left = p->sense * d;
  if (!(d - p->radius > ROUND * p->radius)) return CAG_OK;
  CagStripPart beyond = *p;
  beyond.folds = false;
  bool near = false;
  const CagVec3 from = cag_strip_end(p, first, left), to = cag_strip_end(p, 1 - first, left);
  CagStatus status = cag_walks_put_line(w, p->center, from, sign, err);
  if (!status) status = cag_strip_put_shifted(w, &beyond, left, 0, first == 1, sign, &near, err);
  return status ? status : cag_walks_put_line(w, to, p->center, sign, err);
}

// --- Corners ---

CagTurn cag_strip_turn(const CagStripPart *a, const CagStripPart *b) {
  const double sine = cag_cross(a->tangents[1], b->tangents[0]).z,
               cosine = cag_dot(a->tangents[1], b->tangents[0]);
  if (fabs(sine) <= TURN) return cosine > 0 ? CAG_TURN_NONE : CAG_TURN_BACK;
  return sine > 0 ? CAG_TURN_LEFT : CAG_TURN_RIGHT;
}

// Extends both sides by a fraction of the distance, and connects them.
static CagStatus put_extended(CagWalks *w, const CagStripPart *a, const CagStripPart *b,
                              double left, double part, int sign, CagError *err) {
  const double reach = part * fabs(left);
  const CagVec3 from = cag_strip_end(a, 1, left), to = cag_strip_end(b, 0, left);
  const CagVec3 p = cag_madd(from, reach, a->tangents[1]), q = cag_madd(to, -reach, b->tangents[0]);
  CagStatus status = cag_walks_put_line(w, from, p, sign, err);
  if (!status) status = cag_walks_put_line(w, p, q, sign, err);
  return status ? status : cag_walks_put_line(w, q, to, sign, err);
}

static CagStatus put_miter(CagWalks *w, const CagStripPart *a, const CagStripPart *b, double left,
                           double cosine, int sign, CagError *err) {
  const CagVec3 from = cag_strip_end(a, 1, left), to = cag_strip_end(b, 0, left);
  const CagVec3 normals = cag_add(left_of(a->tangents[1]), left_of(b->tangents[0]));
  const CagVec3 tip = cag_madd(b->ends[0], left / (1 + cosine), normals);
  CagStatus status = cag_walks_put_line(w, from, tip, sign, err);
  return status ? status : cag_walks_put_line(w, tip, to, sign, err);
}

CagStatus cag_strip_put_join(CagWalks *w, const CagStripPart *a, const CagStripPart *b, double left,
                             const CagJoins *joins, int sign, CagError *err) {
  const double sine = fabs(cag_cross(a->tangents[1], b->tangents[0]).z),
               cosine = cag_dot(a->tangents[1], b->tangents[0]);
  const double slack = 1e-9; // of the limit, which angles such as 60 degrees reach exactly
  if (joins->join == CAG_JOIN_ROUND)
    return cag_walks_put_arc(w, b->ends[0], cag_strip_end(a, 1, left), cag_strip_end(b, 0, left),
                             left > 0, sign, err);
  if (joins->join == CAG_JOIN_BEVEL) return put_extended(w, a, b, left, 0, sign, err);
  // The tip of a miter is at 1 / cos(turn / 2) distances from the corner.
  const double limit = joins->miter_limit * (1 + slack);
  if (joins->join == CAG_JOIN_MITER && 2 <= limit * limit * (1 + cosine))
    return put_miter(w, a, b, left, cosine, sign, err);
  return put_extended(w, a, b, left, tan(atan2(sine, cosine) / 4), sign, err);
}
