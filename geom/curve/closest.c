// The globally closest point of a curve.
//
// A part of the curve is kept while its distance bound (that of the chord minus the sag) is below
// the best distance found; Newton's method refines the best point to a local minimum. The sag
// shrinks with the square of the step, so only parts near the minima survive. There the distance is
// quadratic in the parameter and flat up to rounding, so the last steps use its derivative.

#include <float.h>
#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"

// Two points whose distances differ by less than this fraction of the size are equally close.
#define EQUALLY_NEAR 1e-10
// Maximum number of parts; beyond, the search continues with only the closest ones.
#define MOST_PARTS 400000

typedef struct Part {
  double a, b;
  CagVec3 p, q;
} Part;

typedef struct Search {
  const CagCurve *c;
  CagVec3 target;
  double slack;
  double t, distance; // best so far
  CagVec3 point;
  double *cuts; // ends of the smooth pieces
  size_t cut_count;
} Search;

typedef struct Parts {
  Part *items;
  size_t n, capacity;
} Parts;

static CagStatus push(Parts *list, Part part, CagError *err) {
  if (!CAG_RESERVE(list->items, list->capacity, list->n + 1)) return cag_fail_memory(err);
  list->items[list->n++] = part;
  return CAG_OK;
}

static void offer(Search *s, double t, CagVec3 p) {
  double d = cag_norm(cag_sub(p, s->target));
  if (!(d < s->distance)) return;
  s->distance = d;
  s->t = t;
  s->point = p;
}

// Newton's method for (C - P) . C' = 0 within [a, b], from t.
static CagStatus polish(Search *s, double a, double b, double t, CagError *err) {
  const int rounds = 40;
  for (int i = 0; i < rounds; i++) {
    CagVec3 d[3];
    CagStatus status = cag_curve_eval(s->c, t, 2, t >= b ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    offer(s, t, d[0]);
    CagVec3 r = cag_sub(d[0], s->target);
    double f = cag_dot(r, d[1]), vv = cag_dot(d[1], d[1]), slope = vv + cag_dot(r, d[2]);
    // Near a maximum the full Newton step would go uphill; use that of a straight curve.
    if (!(slope > 0)) slope = vv;
    if (!(slope > 0)) return CAG_OK;
    double next = fmin(b, fmax(a, t - f / slope));
    if (next == t) return CAG_OK;
    t = next;
  }
  return CAG_OK;
}

static double chord_parameter(const Part *part, CagVec3 target) {
  CagVec3 d = cag_sub(part->q, part->p);
  double n = cag_dot(d, d), u = n > 0 ? cag_dot(cag_sub(target, part->p), d) / n : 0;
  return fmin(1, fmax(0, u));
}

// Processes one part: drops it, finishes it, or adds its halves to the list.
static CagStatus step(Search *s, const Part *part, Parts *next, CagError *err) {
  if (cag_stop_check(err)) return err->status;
  double u = chord_parameter(part, s->target);
  double sag = cag_curve_sag(s->c, part->a, part->b);
  double near = cag_norm(cag_sub(cag_lerp(part->p, part->q, u), s->target)) - sag;
  if (near >= s->distance - s->slack) return CAG_OK;
  double guess = part->a + u * (part->b - part->a), middle = part->a + (part->b - part->a) / 2;
  CagStatus status = polish(s, part->a, part->b, guess, err);
  if (status || sag <= s->slack || near >= s->distance - s->slack) return status;
  if (!(part->a < middle && middle < part->b)) return CAG_OK;
  CagVec3 p;
  status = cag_curve_point(s->c, middle, &p, err);
  if (status) return status;
  offer(s, middle, p);
  status = push(next, (Part){part->a, middle, part->p, p}, err);
  return status ? status : push(next, (Part){middle, part->b, p, part->q}, err);
}

// The smooth pieces, halved a few times so that chords of closed pieces are meaningful.
static CagStatus first_parts(Search *s, Parts *list, CagError *err) {
  enum { HALVES = 4 };
  CagStatus status = cag_curve_cuts(s->c, &s->cuts, &s->cut_count, err);
  if (status) return status;
  const double *cuts = s->cuts;
  const size_t n = s->cut_count;
  const size_t pieces = n > 8 ? 1 : HALVES;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    Part part = {.b = cuts[i]};
    status = cag_curve_eval(s->c, cuts[i], 0, CAG_SIDE_RIGHT, &part.q, err);
    if (!status) offer(s, cuts[i], part.q);
    for (size_t k = 1; !status && k <= pieces; k++) {
      part.a = part.b;
      part.p = part.q;
      part.b = k == pieces ? cuts[i + 1]
                           : cuts[i] + (cuts[i + 1] - cuts[i]) * (double)k / (double)pieces;
      status = cag_curve_eval(s->c, part.b, 0, CAG_SIDE_LEFT, &part.q, err);
      if (!status) offer(s, part.b, part.q);
      if (!status) status = push(list, part, err);
    }
  }
  return status;
}

// The component of the direction to the target along the curve, and the Newton step to its zero.
static CagStatus lean(const Search *s, double t, CagSide side, CagVec3 *point, double *off,
                      double *step, CagError *err) {
  CagVec3 d[3];
  CagStatus status = cag_curve_eval(s->c, t, 2, side, d, err);
  if (status) return status;
  const CagVec3 r = cag_sub(d[0], s->target);
  const double f = cag_dot(r, d[1]), vv = cag_dot(d[1], d[1]), slope = vv + cag_dot(r, d[2]);
  *point = d[0];
  *off = vv > 0 ? fabs(f) / sqrt(vv) : 0;
  *step = slope > 0 ? -f / slope : 0;
  return CAG_OK;
}

// Refines the best parameter on one side to where the line to the target is perpendicular. Only
// steps that change the distance by no more than rounding are accepted; others were taken before.
static CagStatus square_up(Search *s, double low, double high, double rounding, CagError *err) {
  enum { ROUNDS = 8 };
  CagVec3 point;
  double t = s->t, off, step, next_off, next_step;
  CagSide side = t >= high ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
  CagStatus status = lean(s, t, side, &point, &off, &step, err);
  for (int i = 0; !status && i < ROUNDS; i++) {
    const double next = fmin(high, fmax(low, t + step));
    if (next == t) break;
    side = next >= high ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    status = lean(s, next, side, &point, &next_off, &next_step, err);
    const double distance = cag_norm(cag_sub(point, s->target));
    if (status || !(next_off < off) || !(fabs(distance - s->distance) <= rounding)) break;
    t = s->t = next;
    s->point = point;
    s->distance = distance;
    off = next_off;
    step = next_step;
  }
  return status;
}

static CagStatus finish(Search *s, double rounding, CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i + 1 < s->cut_count; i++)
    if (s->cuts[i] <= s->t && s->t <= s->cuts[i + 1])
      status = square_up(s, s->cuts[i], s->cuts[i + 1], rounding, err);
  return status;
}

CagStatus cag_curve_closest(const CagCurve *c, CagVec3 p, double *t, CagVec3 *point,
                            double *distance, CagError *err) {
  CagStatus status = cag_curve_check_points(&p, 1, "P", err);
  if (status) {
    err->index = -1;
    return status;
  }
  CagBounds box = c->kind->hull(c, c->start, c->end);
  Search s = {.c = c, .target = p, .distance = INFINITY, .t = c->start};
  s.slack = fmax(EQUALLY_NEAR * cag_norm(cag_sub(box.max, box.min)), cag_curve_noise(&box));
  Parts now = {0}, next = {0};
  status = first_parts(&s, &now, err);
  while (!status && now.n > 0) {
    next.n = 0;
    for (size_t i = 0; !status && i < now.n && next.n < MOST_PARTS; i++)
      status = step(&s, &now.items[i], &next, err);
    Parts swap = now;
    now = next;
    next = swap;
  }
  // Rounding of the coordinates, which the distance inherits.
  const double rounding = 4 * DBL_EPSILON * (s.distance + cag_norm(s.point));
  if (!status) status = finish(&s, rounding, err);
  cag_free(now.items);
  cag_free(next.items);
  cag_free(s.cuts);
  if (status) return status;
  if (t) *t = s.t;
  if (point) *point = s.point;
  if (distance) *distance = s.distance;
  return CAG_OK;
}
