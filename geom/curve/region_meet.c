// Intersections of the pieces of an arrangement.
//
// Two pieces are cut where they cross or touch, and where an end of one lies on the other. That
// also suffices if they overlap: overlapping curves of our kinds share an interval that begins and
// ends at ends of them.

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/intersect.h"
#include "geom/curve/region_arrange.h"

typedef struct Meetings {
  CagRegionPieces *pieces;
  bool again;
  double tolerance; // an end this close to a piece lies on it
  CagRegionCut *items;
  size_t n, capacity;
} Meetings;

static bool same(CagVec3 p, CagVec3 q) { return p.x == q.x && p.y == q.y; }

static CagStatus cut(Meetings *m, size_t piece, double t, CagVec3 point, CagError *err) {
  const CagRegionPiece *p = &m->pieces->items[piece];
  if (m->again && (same(point, p->p) || same(point, p->q))) return CAG_OK;
  if (!CAG_RESERVE(m->items, m->capacity, m->n + 1)) return cag_fail_memory(err);
  m->items[m->n++] = (CagRegionCut){piece, fmin(fmax(t, p->a), p->b), point};
  return CAG_OK;
}

static CagStatus cut_both(Meetings *m, size_t i, double t, size_t k, double u, CagVec3 point,
                          CagError *err) {
  CagStatus status = cut(m, i, t, point, err);
  return status ? status : cut(m, k, u, point, err);
}

static bool near(const Meetings *m, CagVec3 p, CagVec3 q) {
  return hypot(p.x - q.x, p.y - q.y) <= m->tolerance;
}

static bool in_box(const Meetings *m, const CagRegionPiece *piece, CagVec3 p) {
  const double slack = m->tolerance;
  return p.x >= fmin(piece->p.x, piece->q.x) - slack &&
         p.x <= fmax(piece->p.x, piece->q.x) + slack &&
         p.y >= fmin(piece->p.y, piece->q.y) - slack && p.y <= fmax(piece->p.y, piece->q.y) + slack;
}

// --- Two segments ---

// Parameter 0..1 of the segment's point nearest to the target.
static double foot(const CagRegionPiece *piece, CagVec3 target) {
  const CagVec3 d = cag_sub(piece->q, piece->p);
  const double dd = cag_dot(d, d);
  return dd > 0 ? fmin(1, fmax(0, cag_dot(cag_sub(target, piece->p), d) / dd)) : 0;
}

static double along(const CagRegionPiece *piece, double u) {
  return u == 1 ? piece->b : piece->a + (piece->b - piece->a) * u;
}

// Cuts the segment if an end of another lies on it; *found: it does.
static CagStatus end_on_segment(Meetings *m, size_t segment, CagVec3 end, bool *found,
                                CagError *err) {
  const CagRegionPiece *piece = &m->pieces->items[segment];
  if (!in_box(m, piece, end)) return CAG_OK;
  const double u = foot(piece, end);
  if (!near(m, cag_lerp(piece->p, piece->q, u), end)) return CAG_OK;
  *found = true;
  return cut(m, segment, along(piece, u), end, err);
}

// Signed distance of the point to the left of the segment's line, times the segment's length.
static double beside(const CagRegionPiece *piece, CagVec3 p) {
  const CagVec3 d = cag_sub(piece->q, piece->p), r = cag_sub(p, piece->p);
  return d.x * r.y - d.y * r.x;
}

static bool on_two_sides(double g, double h) { return (g < 0 && h > 0) || (g > 0 && h < 0); }

// If an end of one segment lies on the other, they do not cross elsewhere: that end becomes a
// corner of both. Other segments cross if each has its ends on different sides of the other's line.
// At a small angle, rounding moves the intersection along both of them.
static CagStatus meet_segments(Meetings *m, size_t i, size_t k, bool ends_only, CagError *err) {
  const CagRegionPiece *a = &m->pieces->items[i], *b = &m->pieces->items[k];
  bool touch = false;
  CagStatus status = end_on_segment(m, i, b->p, &touch, err);
  if (!status) status = end_on_segment(m, i, b->q, &touch, err);
  if (!status) status = end_on_segment(m, k, a->p, &touch, err);
  if (!status) status = end_on_segment(m, k, a->q, &touch, err);
  if (status || ends_only || touch) return status;
  const double g = beside(b, a->p), h = beside(b, a->q);
  if (!on_two_sides(g, h) || !on_two_sides(beside(a, b->p), beside(a, b->q))) return CAG_OK;
  const double u = g / (g - h);
  const CagVec3 point = cag_lerp(a->p, a->q, u);
  return cut_both(m, i, along(a, u), k, along(b, foot(b, point)), point, err);
}

// --- Circles ---

// Cuts both pieces at a point near them; a circle is cut if the point is between its ends.
static CagStatus cut_at(Meetings *m, size_t i, size_t k, CagVec3 p, CagError *err) {
  const size_t which[2] = {i, k};
  const CagRegionPiece *pieces = m->pieces->items;
  if (!in_box(m, &pieces[i], p) || !in_box(m, &pieces[k], p)) return CAG_OK;
  for (int side = 0; side < 2; side++) {
    const CagRegionPiece *piece = &pieces[which[side]];
    double t = along(piece, foot(piece, p));
    CagVec3 there;
    if (!piece->straight) {
      const CagVec3 r = cag_sub(p, piece->center);
      const int axis = fabs(r.x) > fabs(r.y); // the coordinate that changes faster there
      CagStatus status = cag_region_piece_at(m->pieces, piece, piece->a, piece->b, axis,
                                             axis ? p.y : p.x, &t, &there, err);
      if (status) return status;
    }
    CagStatus status = cut(m, which[side], t, p, err);
    if (status) return status;
  }
  return CAG_OK;
}

// Cuts at the two points at the distances `forward` and +-`aside` from `from` along the unit
// vector; at one point if they are so close that the lens between them is no wider than the
// tolerance.
static CagStatus cut_pair(Meetings *m, size_t i, size_t k, CagVec3 from, CagVec3 unit,
                          double forward, double square, bool touch, CagError *err) {
  const CagVec3 middle = cag_madd(from, forward, unit), side = cag_vec3(-unit.y, unit.x, 0);
  if (touch) return cut_at(m, i, k, middle, err);
  if (!(square > 0)) return CAG_OK;
  const double aside = sqrt(square);
  CagStatus status = cut_at(m, i, k, cag_madd(middle, aside, side), err);
  return status ? status : cut_at(m, i, k, cag_madd(middle, -aside, side), err);
}

// Piece i is part of a circle, k a segment or part of a circle.
static CagStatus meet_circle(Meetings *m, size_t i, size_t k, CagError *err) {
  const CagRegionPiece *a = &m->pieces->items[i], *b = &m->pieces->items[k];
  const double r = a->radius, tolerance = m->tolerance;
  if (b->straight) {
    const CagVec3 d = cag_sub(b->q, b->p);
    const double length = cag_norm(d);
    if (length == 0) return CAG_OK;
    const CagVec3 normal = cag_vec3(d.y / length, -d.x / length, 0);
    const double h = cag_dot(cag_sub(b->p, a->center), normal);
    return cut_pair(m, i, k, a->center, normal, h, (r - h) * (r + h),
                    fabs(fabs(h) - r) <= tolerance, err);
  }
  const CagVec3 d = cag_sub(b->center, a->center);
  const double distance = cag_norm(d), s = b->radius;
  if (distance <= tolerance) return CAG_OK; // concentric: identical, or disjoint
  const bool touch =
      fabs(distance - (r + s)) <= tolerance || fabs(distance - fabs(r - s)) <= tolerance;
  const double forward = (distance + (r - s) * (r + s) / distance) / 2;
  return cut_pair(m, i, k, a->center, cag_scaled(d, 1 / distance),
                  touch ? copysign(r, forward) : forward, (r - forward) * (r + forward), touch,
                  err);
}

// --- Curves ---

// The piece as a curve over its own parameters.
static CagStatus make_part(const CagCurve *c, const CagRegionPiece *piece, CagCurve **out,
                           CagError *err) {
  double local_a, local_b, rate;
  CagCurve *part;
  const CagCurve *inner =
      cag_curve_composite_piece(c, piece->a, piece->b, &local_a, &local_b, &rate);
  CagStatus status;
  if (piece->straight) status = cag_curve_line(piece->p, piece->q, 2, &part, err);
  else if (inner) status = cag_curve_trim(inner, local_a, local_b, &part, err);
  else return cag_curve_trim(c, piece->a, piece->b, out, err);
  if (status) return status;
  status = cag_curve_reparametrize(part, piece->a, piece->b, out, err);
  cag_curve_release(part);
  return status;
}

static CagStatus part_of(Meetings *m, size_t i, CagCurve **out, CagError *err) {
  CagRegionPiece *piece = &m->pieces->items[i];
  CagStatus status = CAG_OK;
  if (!piece->part)
    status = make_part(m->pieces->walks[piece->walk].curve, piece, &piece->part, err);
  *out = piece->part;
  return status;
}

// Whether the point lies on piece i, and its parameter.
static CagStatus lies_on(Meetings *m, size_t i, CagVec3 p, bool *out, double *t, CagError *err) {
  const CagRegionPiece *piece = &m->pieces->items[i];
  *out = false;
  if (!in_box(m, piece, p)) return CAG_OK;
  if (near(m, p, piece->p) || near(m, p, piece->q)) {
    *out = true;
    *t = near(m, p, piece->p) ? piece->a : piece->b;
    return CAG_OK;
  }
  if (piece->straight) {
    const double u = foot(piece, p);
    *out = near(m, cag_lerp(piece->p, piece->q, u), p);
    *t = along(piece, u);
    return CAG_OK;
  }
  if (piece->round) {
    const CagVec3 r = cag_sub(p, piece->center);
    *out = fabs(cag_norm(r) - piece->radius) <= m->tolerance;
    if (!*out) return CAG_OK;
    const int axis = fabs(r.x) > fabs(r.y);
    CagVec3 there;
    return cag_region_piece_at(m->pieces, piece, piece->a, piece->b, axis, axis ? p.y : p.x, t,
                               &there, err);
  }
  CagCurve *part;
  CagVec3 closest;
  double distance;
  CagStatus status = part_of(m, i, &part, err);
  if (!status) status = cag_curve_closest(part, p, t, &closest, &distance, err);
  *out = !status && distance <= m->tolerance;
  return status;
}

// Whether the two overlap somewhere: between two neighboring common points on piece i, whose
// parameters are t, there is a third one.
static CagStatus run_along(Meetings *m, size_t i, size_t k, double *t, size_t n, bool *out,
                           CagError *err) {
  *out = false;
  for (size_t a = 1; a < n; a++)
    for (size_t b = a; b > 0 && t[b] < t[b - 1]; b--) {
      const double other = t[b];
      t[b] = t[b - 1];
      t[b - 1] = other;
    }
  const CagRegionPiece *piece = &m->pieces->items[i];
  for (size_t a = 0; a + 1 < n && !*out; a++) {
    CagVec3 p, q, middle;
    double u;
    CagStatus status = cag_region_piece_point(m->pieces, piece, t[a], &p, err);
    if (!status) status = cag_region_piece_point(m->pieces, piece, t[a + 1], &q, err);
    if (!status)
      status = cag_region_piece_point(m->pieces, piece, t[a] + (t[a + 1] - t[a]) / 2, &middle, err);
    if (!status && !near(m, p, q)) status = lies_on(m, k, middle, out, &u, err);
    if (status) return status;
  }
  return CAG_OK;
}

static CagStatus meet_curves(Meetings *m, size_t i, size_t k, bool ends_only, CagError *err) {
  const size_t which[2] = {i, k};
  double shared[4]; // parameters on piece i of ends that lie on the other piece
  size_t n = 0;
  CagStatus status = CAG_OK;
  for (int side = 0; side < 2; side++) {
    const size_t on = which[side], of = which[1 - side];
    for (int end = 0; !status && end < 2; end++) {
      const CagRegionPiece *other = &m->pieces->items[of];
      const CagVec3 p = end ? other->q : other->p;
      bool lies;
      double t;
      status = lies_on(m, on, p, &lies, &t, err);
      if (status || !lies) continue;
      shared[n++] = side == 0 ? t : end ? other->b : other->a;
      status = cut(m, on, t, p, err);
    }
  }
  bool along_each_other = false;
  if (status || ends_only) return status;
  if (n > 1) status = run_along(m, i, k, shared, n, &along_each_other, err);
  if (status || along_each_other) return status;
  const CagRegionPiece *one = &m->pieces->items[i], *other = &m->pieces->items[k];
  if (one->round && (other->round || other->straight)) return meet_circle(m, i, k, err);
  if (other->round && one->straight) return meet_circle(m, k, i, err);
  CagCurve *a, *b;
  status = part_of(m, i, &a, err);
  if (!status) status = part_of(m, k, &b, err);
  if (status) return status;
  CagMeeting *found = NULL;
  size_t count = 0;
  status = cag_curve_intersect(a, b, &found, &count, err);
  if (status == CAG_E_DEGENERATE) return CAG_OK; // overlapping: cut at their ends already
  if (status) return status;
  for (size_t f = 0; !status && f < count; f++)
    status = cut_both(m, i, found[f].t, k, found[f].t2, found[f].point, err);
  cag_free(found);
  return status;
}

// --- All pairs ---

typedef struct Box {
  double x0, x1, y0, y1;
  size_t piece;
} Box;

static int by_x0(const void *a, const void *b) {
  const Box *p = a, *q = b;
  if (p->x0 != q->x0) return p->x0 > q->x0 ? 1 : -1;
  return (p->piece > q->piece) - (p->piece < q->piece);
}

static int by_place(const void *a, const void *b) {
  const CagRegionCut *p = a, *q = b;
  if (p->piece != q->piece) return p->piece > q->piece ? 1 : -1;
  return (p->t > q->t) - (p->t < q->t);
}

typedef enum Meet { NEVER, AT_ENDS, ANYWHERE } Meet;

// Pieces of one group do not cross, but an end of one may touch another. Neighbors on one bent
// curve never meet: they were split where one coordinate has an extremum, and the other coordinate
// separates them. Pieces that have been cut are tested again at the locations to which their ends
// were moved.
static Meet may_meet(const CagRegionPieces *s, const CagRegionPiece *a, const CagRegionPiece *b,
                     bool again) {
  const int group = s->walks[a->walk].group;
  if (a->walk == b->walk && (a->b == b->a || b->b == a->a) && !a->straight && !b->straight)
    return NEVER;
  if (again) return a->straight && b->straight ? ANYWHERE : AT_ENDS;
  return group >= 0 && group == s->walks[b->walk].group ? AT_ENDS : ANYWHERE;
}

CagStatus cag_region_pieces_meet(CagRegionPieces *s, bool again, CagRegionCut **out, size_t *n,
                                 CagError *err) {
  // Corners are farther apart than the tolerance. So if one is closer than half of that to a
  // segment between two others, the angle there exceeds 120 degrees, and both parts are shorter
  // than the segment by a fraction of the tolerance; therefore repeated cutting terminates.
  Meetings m = {.pieces = s, .again = again, .tolerance = again ? s->tolerance / 2 : s->tolerance};
  Box *boxes = cag_malloc(sizeof *boxes * (s->n + 1));
  if (!boxes) return cag_fail_memory(err);
  const double slack = s->tolerance;
  for (size_t i = 0; i < s->n; i++) {
    const CagRegionPiece *p = &s->items[i];
    boxes[i] = (Box){fmin(p->p.x, p->q.x) - slack, fmax(p->p.x, p->q.x) + slack,
                     fmin(p->p.y, p->q.y) - slack, fmax(p->p.y, p->q.y) + slack, i};
  }
  CagStatus status = cag_sort(boxes, s->n, sizeof *boxes, by_x0, err);
  for (size_t i = 0; !status && i < s->n; i++) {
    const Box *a = &boxes[i];
    status = cag_stop_check(err);
    for (size_t k = i + 1; !status && k < s->n && boxes[k].x0 <= a->x1; k++) {
      const Box *b = &boxes[k];
      if (b->y0 > a->y1 || a->y0 > b->y1) continue;
      const CagRegionPiece *p = &s->items[a->piece], *q = &s->items[b->piece];
      const Meet where = may_meet(s, p, q, again);
      if (where == NEVER) continue;
      status = p->straight && q->straight
                   ? meet_segments(&m, a->piece, b->piece, where == AT_ENDS, err)
                   : meet_curves(&m, a->piece, b->piece, where == AT_ENDS, err);
    }
  }
  cag_free(boxes);
  if (status) {
    cag_free(m.items);
    return status;
  }
  if (m.n) qsort(m.items, m.n, sizeof *m.items, by_place);
  *out = m.items;
  *n = m.n;
  return CAG_OK;
}
