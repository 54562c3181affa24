// Projected lines. A curve whose image is straight, such as a circle seen from its side, becomes
// segments between the parameters at which the image turns back. Curves are cut where they cross in
// the drawing, where others end on them, at cusps of the image, and where they pass through the faces
// of other bodies.

#include "geom/view/drawn.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/intersect.h"
#include "geom/meet/meet_curve.h"

// An image smaller than this fraction of the size is a point.
#define POINT 1e-9
// The sine of an angle between directions that are the same.
#define PARALLEL 1e-12
// An image has a cusp where its speed drops to this part of the usual one.
#define CUSP 1e-3
// An image is looked at this many times on each piece for places at which it turns or stops.
enum { STEPS = 48 };
// An image crosses itself only after it has turned by more than this, in radians.
#define ARC_TURN 1.2

void cag_drawing_free(CagDrawing *d) {
  for (size_t i = 0; i < d->count; i++) {
    cag_curve_release(d->items[i].flat);
    cag_free(d->items[i].cuts);
  }
  cag_free(d->items);
  cag_free(d->order);
}

static CagVec3 flat_point(const CagTransform *frame, CagVec3 p) {
  const CagVec3 q = cag_sub(p, cag_vec3(frame->m[0][3], frame->m[1][3], frame->m[2][3]));
  return cag_vec3(frame->m[0][0] * q.x + frame->m[1][0] * q.y + frame->m[2][0] * q.z,
                  frame->m[0][1] * q.x + frame->m[1][1] * q.y + frame->m[2][1] * q.z, 0);
}

static CagStatus cut_at(CagDrawnLine *l, double s, CagError *err) {
  if (!CAG_RESERVE(l->cuts, l->cut_room, l->cut_count + 1)) return cag_fail_memory(err);
  l->cuts[l->cut_count++] = fmin(fmax(s, l->flat->start), l->flat->end);
  return CAG_OK;
}

static int by_number(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static bool boxes_meet(const CagBounds *a, const CagBounds *b, double slack) {
  return a->min.x <= b->max.x + slack && b->min.x <= a->max.x + slack &&
         a->min.y <= b->max.y + slack && b->min.y <= a->max.y + slack &&
         a->min.z <= b->max.z + slack && b->min.z <= a->max.z + slack;
}

// --- Projection ---

// Takes over the flat curve, also if it fails.
static CagStatus add_drawn(CagDrawing *d, const CagViewLine *line, CagCurve *flat, bool straight,
                           double from, double to, CagError *err) {
  CagDrawnLine l = {.line = line, .flat = flat, .straight = straight, .from = from, .to = to};
  CagStatus status = cag_curve_bounds(flat, &l.box, err);
  if (!status) status = cag_curve_point(flat, flat->start, &l.start, err);
  if (!status) status = cag_curve_point(flat, flat->end, &l.end, err);
  if (!status && !CAG_RESERVE(d->items, d->capacity, d->count + 1)) status = cag_fail_memory(err);
  if (status) {
    cag_curve_release(flat);
    return status;
  }
  d->items[d->count++] = l;
  CagDrawnLine *added = &d->items[d->count - 1];
  status = cut_at(added, flat->start, err);
  return status ? status : cut_at(added, flat->end, err);
}

// How fast a straight image moves along a direction.
static CagStatus speed_along(const CagCurve *flat, double t, CagVec3 along, double *out,
                             CagError *err) {
  CagVec3 p[2];
  CagStatus status = cag_curve_eval(flat, t, 1, CAG_SIDE_RIGHT, p, err);
  if (!status) *out = cag_dot(p[1], along);
  return status;
}

// The parameter in [a, b] at which a straight image turns back; it moves forward at a if `forward`.
static CagStatus turning_point(const CagCurve *flat, CagVec3 along, double a, double b,
                               bool forward, double *out, CagError *err) {
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < 60; i++) {
    const double middle = a + (b - a) / 2;
    double speed;
    status = speed_along(flat, middle, along, &speed, err);
    if (!status && (speed > 0) == forward) a = middle;
    else b = middle;
  }
  *out = a + (b - a) / 2;
  return status;
}

// A parameter of a curve, or one beyond the end of a closed one.
static double within(const CagCurve *c, double t) {
  return c->closed && t > c->end ? fmin(t - (c->end - c->start), c->end) : t;
}

static CagStatus add_segment(CagDrawing *d, const CagViewLine *line, const CagCurve *flat,
                             double from, double to, CagError *err) {
  CagVec3 p, q;
  CagCurve *segment = NULL;
  CagStatus status = cag_curve_point(flat, from, &p, err);
  if (!status) status = cag_curve_point(flat, within(flat, to), &q, err);
  if (status || cag_norm(cag_sub(q, p)) <= POINT * d->size) return status;
  p.z = q.z = 0;
  status = cag_curve_line(p, q, 2, &segment, err);
  return status ? status : add_drawn(d, line, segment, true, from, to, err);
}

// The direction of a straight image, between the corners of its box.
static CagStatus straight_direction(const CagCurve *flat, CagVec3 *out, CagError *err) {
  CagVec3 first, farthest = {0, 0, 0};
  CagStatus status = cag_curve_point(flat, flat->start, &first, err);
  for (int i = 1; !status && i <= STEPS; i++) {
    CagVec3 p;
    status = cag_curve_point(flat, flat->start + (flat->end - flat->start) * i / STEPS, &p, err);
    if (!status && cag_norm(cag_sub(p, first)) > cag_norm(farthest)) farthest = cag_sub(p, first);
  }
  *out = cag_unit(farthest);
  return status;
}

// The parameters at which a straight image turns back. *smooth: it is closed, and goes on at the seam.
static CagStatus turning_points(const CagCurve *flat, double turns[STEPS], size_t *n, bool *smooth,
                                CagError *err) {
  CagVec3 along;
  double last = flat->start, speed = 0, before = 0, first = 0;
  CagStatus status = straight_direction(flat, &along, err);
  *n = 0;
  for (int i = 0; !status && i < STEPS; i++) {
    // Not at the ends, where the image may stop.
    const double t = flat->start + (flat->end - flat->start) * (i + 0.47) / STEPS;
    status = speed_along(flat, t, along, &speed, err);
    if (status) break;
    if (i == 0) first = speed;
    else if ((speed > 0) != (before > 0))
      status = turning_point(flat, along, last, t, before > 0, &turns[(*n)++], err);
    before = speed;
    last = t;
  }
  *smooth = flat->closed && *n > 0 && (first > 0) == (speed > 0);
  return status;
}

static CagStatus add_straight(CagDrawing *d, const CagViewLine *line, const CagCurve *flat,
                              CagError *err) {
  double turns[STEPS];
  size_t n;
  bool smooth;
  CagStatus status = turning_points(flat, turns, &n, &smooth, err);
  if (!status && !smooth)
    status = add_segment(d, line, flat, flat->start, n > 0 ? turns[0] : flat->end, err);
  for (size_t i = 0; !status && i < n; i++) {
    const double end = smooth ? turns[0] + (flat->end - flat->start) : flat->end;
    status = add_segment(d, line, flat, turns[i], i + 1 < n ? turns[i + 1] : end, err);
  }
  return status;
}

static CagStatus project(CagDrawing *d, const CagViewLine *line, CagError *err) {
  CagCurve *flat;
  CagBounds box;
  bool straight = false;
  CagStatus status = cag_curve_flatten(line->curve, &d->frame, &flat, err);
  if (status) return status;
  if (flat->dimension == 3) cag_curve_lay_flat(flat);
  status = cag_curve_bounds(flat, &box, err);
  const bool point = !status && cag_norm(cag_sub(box.max, box.min)) <= POINT * d->size;
  if (!status && !point) status = cag_curve_is_straight(flat, &straight, err);
  if (!status && !point && !straight)
    return add_drawn(d, line, flat, false, flat->start, flat->end, err);
  if (!status && straight) status = add_straight(d, line, flat, err);
  cag_curve_release(flat);
  return status;
}

CagStatus cag_drawn_parameter(const CagDrawing *d, const CagDrawnLine *l, double s, double *t,
                              CagError *err) {
  const CagCurve *space = l->line->curve;
  *t = s;
  if (!l->straight) return CAG_OK;
  const double fraction = (s - l->flat->start) / (l->flat->end - l->flat->start);
  const CagVec3 along = cag_sub(l->end, l->start);
  const double goal = fraction * cag_dot(along, along);
  double a = l->from, b = l->to;
  *t = a + fraction * (b - a);
  for (int i = 0; i < 60; i++) {
    CagVec3 p;
    CagStatus status = cag_curve_point(space, within(space, *t), &p, err);
    if (status) return status;
    const double off = cag_dot(cag_sub(flat_point(&d->frame, p), l->start), along) - goal;
    if (fabs(off) <= PARALLEL * cag_dot(along, along)) break;
    if (off < 0) a = *t;
    else b = *t;
    *t = a + (b - a) / 2;
  }
  *t = within(space, *t);
  return CAG_OK;
}

CagStatus cag_drawn_nearest(const CagDrawnLine *l, CagVec3 p, double *s, double *distance,
                            CagError *err) {
  CagVec3 at;
  if (!l->straight) return cag_curve_closest(l->flat, p, s, &at, distance, err);
  const CagVec3 along = cag_sub(l->end, l->start);
  const double w = cag_dot(cag_sub(p, l->start), along) / cag_dot(along, along),
               part = fmin(fmax(w, 0), 1);
  *s = l->flat->start + part * (l->flat->end - l->flat->start);
  *distance = cag_norm(cag_sub(p, cag_madd(l->start, part, along)));
  return CAG_OK;
}

// --- Cuts of one line ---

static CagStatus flat_speed(const CagCurve *flat, double t, double *out, CagError *err) {
  CagVec3 p[2];
  CagStatus status = cag_curve_eval(flat, t, 1, CAG_SIDE_RIGHT, p, err);
  if (!status) *out = cag_norm(p[1]);
  return status;
}

// Cuts at the slowest point of [a, b] if it is a cusp: golden section.
static CagStatus cut_cusp(CagDrawnLine *l, double a, double b, double usual, CagError *err) {
  const double golden = 0.6180339887498949;
  double speed = 0, x = b - golden * (b - a), y = a + golden * (b - a), at_x, at_y;
  CagStatus status = flat_speed(l->flat, x, &at_x, err);
  if (!status) status = flat_speed(l->flat, y, &at_y, err);
  for (int i = 0; !status && i < 60; i++) {
    if (at_x < at_y) {
      b = y, y = x, at_y = at_x;
      x = b - golden * (b - a);
      status = flat_speed(l->flat, x, &at_x, err);
    } else {
      a = x, x = y, at_x = at_y;
      y = a + golden * (b - a);
      status = flat_speed(l->flat, y, &at_y, err);
    }
  }
  if (!status) status = flat_speed(l->flat, (a + b) / 2, &speed, err);
  return status || speed > CUSP * usual ? status : cut_at(l, (a + b) / 2, err);
}

static CagStatus cut_piece_cusps(CagDrawnLine *l, double a, double b, CagError *err) {
  double speed[STEPS + 1], mean = 0;
  CagStatus status = CAG_OK;
  const double inside = 1e-9 * (b - a);
  for (int i = 0; !status && i <= STEPS; i++) {
    const double t = fmin(fmax(a + (b - a) * i / STEPS, a + inside), b - inside);
    status = flat_speed(l->flat, t, &speed[i], err);
    if (!status) mean += speed[i] / (STEPS + 1);
  }
  for (int i = 0; !status && i <= STEPS; i++) {
    if ((i > 0 && speed[i - 1] < speed[i]) || (i < STEPS && speed[i + 1] < speed[i])) continue;
    const double step = (b - a) / STEPS, t = a + step * i;
    if (speed[i] < 0.5 * mean)
      status = cut_cusp(l, fmax(t - step, a + inside), fmin(t + step, b - inside), mean, err);
  }
  return status;
}

static bool is_conic(const CagCurve *c) {
  CagVec3 center, x, y;
  double rate;
  return cag_curve_arc_axes(c, &center, &x, &y, &rate);
}

static CagStatus cut_cusps(CagDrawnLine *l, CagError *err) {
  double *cuts;
  size_t n;
  if (l->straight || is_conic(l->flat)) return CAG_OK;
  CagStatus status = cag_curve_cuts(l->flat, &cuts, &n, err);
  if (status) return status;
  // Breaks of a contour made of many cubics are closer than the steps of a search; a cusp may be at
  // one.
  const size_t pieces = n - 1, group = pieces > STEPS ? pieces / STEPS : 1;
  for (size_t i = 0; !status && i < pieces; i += group)
    status = cut_piece_cusps(l, cuts[i], cuts[i + group < pieces ? i + group : pieces], err);
  cag_free(cuts);
  return status;
}

// --- Cuts of two lines ---

// If a pair of curves fails, the drawing goes on without it, unless the work must stop.
static CagStatus forgive(CagStatus status, CagError *err) {
  if (status == CAG_E_MEMORY || status == CAG_E_CALLBACK) return status;
  return cag_stop_check(err);
}

static CagStatus cut_segments(CagDrawnLine *l, CagDrawnLine *k, CagError *err) {
  const CagVec3 a = cag_sub(l->end, l->start), b = cag_sub(k->end, k->start),
                c = cag_sub(k->start, l->start);
  const double w = a.x * b.y - a.y * b.x;
  if (fabs(w) <= PARALLEL * cag_norm(a) * cag_norm(b)) return CAG_OK;
  const double s = (c.x * b.y - c.y * b.x) / w, t = (c.x * a.y - c.y * a.x) / w;
  if (s < 0 || s > 1 || t < 0 || t > 1) return CAG_OK;
  CagStatus status = cut_at(l, l->flat->start + s * (l->flat->end - l->flat->start), err);
  return status ? status : cut_at(k, k->flat->start + t * (k->flat->end - k->flat->start), err);
}

static CagStatus cut_crossings(CagDrawnLine *l, CagDrawnLine *k, CagError *err) {
  if (l->straight && k->straight) return cut_segments(l, k, err);
  CagMeeting *found = NULL;
  size_t n = 0;
  CagStatus status = cag_curve_intersect(l->flat, k->flat, &found, &n, err);
  if (status) return forgive(status, err);
  for (size_t i = 0; !status && i < n; i++) {
    status = cut_at(l, found[i].t, err);
    if (!status) status = cut_at(k, found[i].t2, err);
  }
  cag_free(found);
  return status;
}

static bool near_box(const CagBounds *b, CagVec3 p, double slack) {
  return p.x >= b->min.x - slack && p.x <= b->max.x + slack && p.y >= b->min.y - slack &&
         p.y <= b->max.y + slack;
}

// Cuts a line where another one ends on it.
static CagStatus cut_at_ends(const CagDrawing *d, CagDrawnLine *l, const CagDrawnLine *k,
                             CagError *err) {
  const CagVec3 ends[2] = {k->start, k->end};
  const double near = CAG_DRAWN_NEAR * d->size;
  for (int i = 0; i < 2; i++) {
    double s, distance;
    if (!near_box(&l->box, ends[i], near)) continue;
    CagStatus status = cag_drawn_nearest(l, ends[i], &s, &distance, err);
    if (!status && distance <= near) status = cut_at(l, s, err);
    if (status) return status;
  }
  return CAG_OK;
}

size_t cag_drawing_from(const CagDrawing *d, double x) {
  size_t low = 0, high = d->count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (d->items[d->order[middle]].box.min.x < x - d->widest) low = middle + 1;
    else high = middle;
  }
  return low;
}

static CagStatus cut_pairs(CagDrawing *d, CagError *err) {
  const double near = CAG_DRAWN_NEAR * d->size;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < d->count; i++) {
    CagDrawnLine *l = &d->items[d->order[i]];
    status = cag_stop_check(err);
    for (size_t j = i + 1; !status && j < d->count; j++) {
      CagDrawnLine *k = &d->items[d->order[j]];
      if (k->box.min.x > l->box.max.x + near) break;
      if (k->box.min.y > l->box.max.y + near || k->box.max.y < l->box.min.y - near) continue;
      status = cut_crossings(l, k, err);
      if (!status) status = cut_at_ends(d, l, k, err);
      if (!status) status = cut_at_ends(d, k, l, err);
    }
  }
  return status;
}

// --- Cuts of a line by itself ---

// The parameters between which a flat curve turns little, so that only different parts cross.
typedef struct Arcs {
  double *ends;
  size_t count, capacity;
} Arcs;

static CagStatus end_arc(Arcs *a, double t, CagError *err) {
  if (!CAG_RESERVE(a->ends, a->capacity, a->count + 1)) return cag_fail_memory(err);
  a->ends[a->count++] = t;
  return CAG_OK;
}

// Adds the ends of the arcs of a smooth part.
static CagStatus add_arcs(const CagCurve *flat, double from, double to, size_t steps, Arcs *out,
                          CagError *err) {
  CagVec3 p[2], before = {0, 0, 0};
  double turned = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < steps; i++) {
    const double t = from + (to - from) * ((double)i + 0.5) / (double)steps;
    status = cag_curve_eval(flat, t, 1, CAG_SIDE_RIGHT, p, err);
    if (status) break;
    if (i > 0) turned += fabs(atan2(before.x * p[1].y - before.y * p[1].x, cag_dot(before, p[1])));
    before = p[1];
    if (turned < ARC_TURN) continue;
    turned = 0;
    status = end_arc(out, t, err);
  }
  return status ? status : end_arc(out, to, err);
}

static CagStatus cut_arcs(CagDrawnLine *l, CagCurve *const *arcs, const CagBounds *boxes, size_t n,
                          CagError *err) {
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < n; i++) {
    status = cag_stop_check(err);
    for (size_t j = i + 1; !status && j < n; j++) {
      CagMeeting *found = NULL;
      size_t count = 0;
      if (!boxes_meet(&boxes[i], &boxes[j], 0)) continue;
      status = cag_curve_intersect(arcs[i], arcs[j], &found, &count, err);
      if (status) status = forgive(status, err);
      for (size_t k = 0; !status && k < count; k++) {
        status = cut_at(l, found[k].t, err);
        if (!status) status = cut_at(l, found[k].t2, err);
      }
      cag_free(found);
    }
  }
  return status;
}

static CagStatus cut_between_arcs(CagDrawnLine *l, const Arcs *a, CagError *err) {
  CagCurve **arcs = cag_calloc(a->count + 1, sizeof(CagCurve *));
  CagBounds *boxes = cag_calloc(a->count + 1, sizeof *boxes);
  CagStatus status = arcs && boxes ? CAG_OK : cag_fail_memory(err);
  size_t n = 0;
  for (size_t i = 0; !status && i + 1 < a->count; i++) {
    if (a->ends[i + 1] - a->ends[i] <= 1e-9 * (l->flat->end - l->flat->start)) continue;
    status = cag_curve_trim(l->flat, a->ends[i], a->ends[i + 1], &arcs[n], err);
    if (!status) status = cag_curve_bounds(arcs[n], &boxes[n], err);
    n += arcs[n] != NULL;
  }
  if (!status) status = cut_arcs(l, arcs, boxes, n, err);
  for (size_t i = 0; i < n; i++) cag_curve_release(arcs[i]);
  cag_free(arcs);
  cag_free(boxes);
  return status;
}

// Cuts a line where it crosses itself. Its cuts so far are its ends and its cusps.
static CagStatus cut_by_itself(CagDrawnLine *l, CagError *err) {
  Arcs arcs = {0};
  const CagCurve *flat = l->flat;
  if (l->straight || is_conic(flat)) return CAG_OK;
  const size_t breaks = flat->kind->breaks ? flat->kind->breaks(flat, NULL, 0) : 0;
  const size_t steps = breaks < STEPS ? 4 * STEPS : 4 * breaks;
  qsort(l->cuts, l->cut_count, sizeof *l->cuts, by_number);
  CagStatus status = end_arc(&arcs, flat->start, err);
  for (size_t i = 0, n = l->cut_count; !status && i + 1 < n; i++)
    if (l->cuts[i + 1] > l->cuts[i])
      status = add_arcs(flat, l->cuts[i], l->cuts[i + 1], steps, &arcs, err);
  if (!status) status = cut_between_arcs(l, &arcs, err);
  cag_free(arcs.ends);
  return status;
}

// --- Cuts by faces ---

// Cuts a line where its curve in space passes through a face.
static CagStatus cut_by_face(const CagDrawing *d, CagDrawnLine *l, const CagSurface *face,
                             CagError *err) {
  CagSurfaceMeeting *found = NULL;
  size_t n = 0;
  const CagCurve *space = l->line->curve;
  const double period = space->closed ? space->end - space->start : 0;
  CagStatus status = cag_surface_intersect_curve(face, space, &found, &n, err);
  if (status) return forgive(status, err);
  for (size_t i = 0; !status && i < n; i++) {
    double s = found[i].t, distance;
    if (l->straight && s < l->from) s += period;
    if (l->straight && (s < l->from || s > l->to)) continue;
    if (l->straight)
      status = cag_drawn_nearest(l, flat_point(&d->frame, found[i].point), &s, &distance, err);
    if (!status) status = cut_at(l, s, err);
  }
  cag_free(found);
  return status;
}

static CagStatus faces_of_body(const CagViewBody *b, const CagSurface *const **faces, size_t *n) {
  *faces = b->solid ? (const CagSurface *const *)b->solid->faces : &b->surface;
  *n = b->solid ? b->solid->face_count : b->surface ? 1 : 0;
  return CAG_OK;
}

static CagStatus cut_by_body(CagDrawing *d, size_t body, const CagBounds *boxes, CagError *err) {
  const CagSurface *const *faces;
  size_t n;
  CagStatus status = faces_of_body(&d->bodies[body], &faces, &n);
  for (size_t f = 0; !status && f < n; f++) {
    CagBounds box;
    status = cag_surface_bounds(faces[f], &box, err);
    for (size_t i = 0; !status && i < d->count; i++) {
      if (d->items[i].line->body == body || !boxes_meet(&box, &boxes[i], 0)) continue;
      status = cut_by_face(d, &d->items[i], faces[f], err);
    }
  }
  return status;
}

static CagStatus cut_by_bodies(CagDrawing *d, size_t body_count, CagError *err) {
  CagBounds *boxes = cag_calloc(d->count + 1, sizeof *boxes);
  CagStatus status = boxes ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < d->count; i++)
    status = cag_curve_bounds(d->items[i].line->curve, &boxes[i], err);
  for (size_t i = 0; !status && body_count > 1 && i < body_count; i++)
    status = cut_by_body(d, i, boxes, err);
  cag_free(boxes);
  return status;
}

// --- The drawing ---

// Sorts the items by box.min.x, and by index where it is equal: heap sort, since the order needs the
// items.
static bool begins_before(const CagDrawing *d, size_t a, size_t b) {
  const double x = d->items[a].box.min.x, y = d->items[b].box.min.x;
  return x < y || (x == y && a < b);
}

static void sift(CagDrawing *d, size_t root, size_t n) {
  for (size_t child; (child = 2 * root + 1) < n; root = child) {
    if (child + 1 < n && begins_before(d, d->order[child], d->order[child + 1])) child++;
    if (!begins_before(d, d->order[root], d->order[child])) return;
    const size_t swapped = d->order[root];
    d->order[root] = d->order[child];
    d->order[child] = swapped;
  }
}

static CagStatus sort_items(CagDrawing *d, CagError *err) {
  d->order = cag_calloc(d->count + 1, sizeof *d->order);
  if (!d->order) return cag_fail_memory(err);
  for (size_t i = 0; i < d->count; i++) {
    d->order[i] = i;
    d->widest = fmax(d->widest, d->items[i].box.max.x - d->items[i].box.min.x);
  }
  for (size_t i = d->count / 2; i-- > 0;) sift(d, i, d->count);
  for (size_t n = d->count; n-- > 1;) {
    const size_t last = d->order[n];
    d->order[n] = d->order[0];
    d->order[0] = last;
    sift(d, 0, n);
  }
  return CAG_OK;
}

CagStatus cag_drawing_of(const CagViewLines *lines, const CagViewBody *bodies,
                         const CagTransform *frame, CagDrawing *out, CagError *err) {
  CagDrawing d = {.lines = lines, .bodies = bodies, .frame = *frame, .size = lines->size};
  size_t body_count = 0;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < lines->count; i++) {
    if (lines->items[i].body >= body_count) body_count = lines->items[i].body + 1;
    status = project(&d, &lines->items[i], err);
    if (!status) status = cag_stop_check(err);
  }
  for (size_t i = 0; !status && i < d.count; i++) {
    status = cut_cusps(&d.items[i], err);
    if (!status) status = cut_by_itself(&d.items[i], err);
  }
  if (!status) status = sort_items(&d, err);
  if (!status) status = cut_pairs(&d, err);
  if (!status) status = cut_by_bodies(&d, body_count, err);
  for (size_t i = 0; !status && i < d.count; i++)
    qsort(d.items[i].cuts, d.items[i].cut_count, sizeof *d.items[i].cuts, by_number);
  if (status) cag_drawing_free(&d);
  else *out = d;
  return status;
}
