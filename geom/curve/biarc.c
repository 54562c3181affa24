// Pairs of arcs between points of a curve, which is halved until they are within the tolerance.

#include "geom/curve/biarc.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"

// Points at which a pair of arcs is compared with the curve.
#define LOOKS 8
// Halvings of a smooth part, and its turn from which on it is halved without a comparison (cosine).
#define HALVINGS 24
#define TURN_MOST 0.5
// An arc is straight if it rises above its tangent by less than this fraction of its chord: its
// center would be so far away that rounding moves its ends.
#define FLAT 1e-7

static CagVec3 left_of(CagVec3 v) { return cag_vec3(-v.y, v.x, 0); }

// The signed radius of the arc from p in the unit direction to q; infinite for a segment.
static double radius_to(CagVec3 p, CagVec3 direction, CagVec3 q) {
  const CagVec3 chord = cag_sub(q, p);
  const double rise = cag_dot(left_of(direction), chord), square = cag_dot(chord, chord);
  return fabs(rise) <= FLAT * sqrt(square) ? INFINITY : square / (2 * rise);
}

// Two arcs that meet smoothly: from p in the direction u to the middle, and on to q in the
// direction v. Both are as long as possible alike (Bolton 1975).
typedef struct Biarc {
  CagVec3 p, q, u, v, middle;
} Biarc;

static bool biarc_between(CagVec3 p, CagVec3 u, CagVec3 q, CagVec3 v, Biarc *out) {
  const CagVec3 w = cag_sub(q, p), sum = cag_add(u, v);
  const double a = 2 * (1 - cag_dot(u, v)), b = cag_dot(w, sum), c = cag_dot(w, w);
  // a d^2 + 2 b d = c, by the stable formula of its positive root.
  const double root = b + sqrt(b * b + a * c);
  if (!(root > 0)) return false;
  const double d = c / root;
  *out = (Biarc){p, q, u, v, cag_scaled(cag_add(cag_add(p, q), cag_scaled(cag_sub(u, v), d)), 0.5)};
  return true;
}

// The distance of a point from an arc, if it is beside it.
static double off_arc(CagVec3 start, CagVec3 direction, double radius, CagVec3 p) {
  const CagVec3 r = cag_sub(p, start);
  if (isinf(radius)) return fabs(cag_cross(direction, r).z);
  return fabs(cag_norm(cag_sub(r, cag_scaled(left_of(direction), radius))) - fabs(radius));
}

static CagStatus fits(const CagCurve *c, double a, double b, const Biarc *arcs, double tolerance,
                      bool *out, CagError *err) {
  const double first = radius_to(arcs->p, arcs->u, arcs->middle),
               second = -radius_to(arcs->q, cag_scaled(arcs->v, -1), arcs->middle);
  const CagVec3 chord = cag_sub(arcs->q, arcs->p);
  const double half = cag_dot(cag_sub(arcs->middle, arcs->p), chord);
  *out = true;
  for (int i = 1; i < LOOKS && *out; i++) {
    CagVec3 p;
    CagStatus status = cag_curve_point(c, a + (b - a) * i / LOOKS, &p, err);
    if (status) return status;
    const bool before = cag_dot(cag_sub(p, arcs->p), chord) < half;
    const double off =
        before ? off_arc(arcs->p, arcs->u, first, p) : off_arc(arcs->q, arcs->v, second, p);
    *out = off <= tolerance;
  }
  return CAG_OK;
}

// The turn of an arc with the radius between two points.
static double turn_of(CagVec3 p, CagVec3 q, double radius) {
  return isinf(radius) ? 0 : 2 * asin(fmin(1, cag_norm(cag_sub(q, p)) / (2 * fabs(radius))));
}

static CagStatus pass(const Biarc *b, CagArcSink sink, void *context, CagError *err) {
  const double first = radius_to(b->p, b->u, b->middle),
               second = -radius_to(b->q, cag_scaled(b->v, -1), b->middle);
  const CagArcStep before = {b->p, b->middle, b->u, first, turn_of(b->p, b->middle, first)};
  CagArcStep after = {b->middle, b->q, b->v, second, turn_of(b->middle, b->q, second)};
  CagStatus status = sink(context, &before, err);
  if (status) return status;
  if (!isinf(second)) {
    const CagVec3 center = cag_madd(b->q, second, left_of(b->v)),
                  out = cag_scaled(cag_sub(b->middle, center), 1 / second);
    after.direction = cag_unit(left_of(out));
  }
  return sink(context, &after, err);
}

// The smooth part of the curve over [a, b].
static CagStatus pass_smooth(const CagCurve *c, double a, double b, double tolerance, int halvings,
                             CagArcSink sink, void *context, CagError *err) {
  CagVec3 p, q, u, v;
  CagStatus status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &p, err);
  if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &q, err);
  if (!status) status = cag_curve_tangent(c, a, CAG_SIDE_RIGHT, &u, err);
  if (!status) status = cag_curve_tangent(c, b, CAG_SIDE_LEFT, &v, err);
  if (!status) status = cag_stop_check(err);
  if (status) return status;
  Biarc arcs;
  bool good = cag_dot(u, v) > TURN_MOST && biarc_between(p, u, q, v, &arcs);
  if (good) status = fits(c, a, b, &arcs, tolerance, &good, err);
  if (status) return status;
  if (good) return pass(&arcs, sink, context, err);
  const double middle = a + (b - a) / 2;
  if (halvings == 0 || !(a < middle && middle < b)) {
    const CagVec3 chord = cag_sub(q, p);
    const CagArcStep step = {p, q, cag_norm(chord) > 0 ? cag_unit(chord) : u, INFINITY, 0};
    return sink(context, &step, err);
  }
  status = pass_smooth(c, a, middle, tolerance, halvings - 1, sink, context, err);
  return status ? status : pass_smooth(c, middle, b, tolerance, halvings - 1, sink, context, err);
}

CagStatus cag_curve_arcs(const CagCurve *c, double tolerance, CagArcSink sink, void *context,
                         CagError *err) {
  double *cuts;
  size_t n;
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  for (size_t i = 0; !status && i + 1 < n; i++)
    status = pass_smooth(c, cuts[i], cuts[i + 1], tolerance, HALVINGS, sink, context, err);
  cag_free(cuts);
  return status;
}

CagStatus cag_arc_step_curve(const CagArcStep *step, CagCurve **out, CagError *err) {
  if (isinf(step->radius)) return cag_curve_line(step->from, step->to, 2, out, err);
  // The axes: from the center to the start, and along the arc there.
  const double sense = step->radius > 0 ? 1 : -1, radius = fabs(step->radius);
  const CagVec3 x = cag_scaled(left_of(step->direction), -sense);
  CagTransform frame = cag_translate(cag_madd(step->from, -radius, x));
  frame.m[0][0] = x.x;
  frame.m[1][0] = x.y;
  frame.m[0][1] = step->direction.x;
  frame.m[1][1] = step->direction.y;
  frame.planar = true;
  return cag_curve_arc(radius, radius, 0, step->turn, &frame, out, err);
}
