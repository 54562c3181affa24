// Outlines, and the parts of solids with analytic faces (see brep_outline.h).

#include "interp/formats/brep_outline.h"

#include <math.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/nurbs.h"
#include "geom/curve/strip.h"
#include "geom/linalg/tolerance.h"
#include "interp/formats/brep_build.h"

// --- Outlines ---

void cag_form_outline_free(CagFormOutline *o) {
  cag_free(o->items);
  *o = (CagFormOutline){0};
}

static CagStatus add_piece(CagFormOutline *o, CagFormPiece piece, CagError *err) {
  if (!CAG_RESERVE(o->items, o->room, o->count + 1)) return cag_fail_memory(err);
  o->items[o->count++] = piece;
  return CAG_OK;
}

CagStatus cag_form_outline_line(CagFormOutline *o, CagVec3 from, CagVec3 to, CagError *err) {
  return add_piece(o, (CagFormPiece){.from = from, .to = to}, err);
}

static CagVec3 on_circle(CagVec3 center, double radius, double angle) {
  return cag_add(center, cag_vec3(radius * cos(angle), radius * sin(angle), 0));
}

CagStatus cag_form_outline_arc(CagFormOutline *o, CagVec3 center, double radius, double start,
                               double sweep, CagError *err) {
  CagFormPiece p = {.round = true, .left = sweep > 0, .center = center, .radius = radius};
  p.from = on_circle(center, radius, start);
  p.to = on_circle(center, radius, start + sweep);
  p.start = p.left ? start : start + sweep;
  p.sweep = fabs(sweep);
  return add_piece(o, p, err);
}

// Part of a circle, with the ends of the part itself.
static CagFormPiece round_piece(const CagStripPart *part) {
  CagFormPiece p = {.from = part->ends[0],
                    .to = part->ends[1],
                    .round = true,
                    .left = part->sense > 0,
                    .center = part->center,
                    .radius = part->radius};
  const CagVec3 a = cag_sub(p.left ? p.from : p.to, p.center);
  const CagVec3 b = cag_sub(p.left ? p.to : p.from, p.center);
  p.start = atan2(a.y, a.x);
  p.sweep = atan2(a.x * b.y - a.y * b.x, cag_dot(a, b));
  if (p.sweep <= CAG_ROUNDING) p.sweep += 2 * M_PI;
  return p;
}

CagStatus cag_form_outline_curve(CagFormOutline *o, const CagCurve *c, bool *fits, CagError *err) {
  CagStripParts parts = {0};
  CagStatus status = cag_strip_parts_add(&parts, c, 0, err);
  for (size_t i = 0; !status && *fits && i < parts.n; i++) {
    const CagStripPart *part = &parts.items[i];
    *fits = part->straight || part->round;
    if (part->straight) status = cag_form_outline_line(o, part->ends[0], part->ends[1], err);
    else if (part->round) status = add_piece(o, round_piece(part), err);
    if (!status) status = cag_stop_check(err);
  }
  cag_strip_parts_free(&parts);
  return status;
}

// Twice the area to the left.
static double outline_area(const CagFormOutline *o) {
  double area = 0;
  for (size_t i = 0; i < o->count; i++) {
    const CagFormPiece *p = &o->items[i];
    const CagVec3 a = cag_sub(p->from, o->items[0].from), b = cag_sub(p->to, o->items[0].from);
    area += a.x * b.y - a.y * b.x;
    if (p->round) area += (p->left ? 1 : -1) * p->radius * p->radius * (p->sweep - sin(p->sweep));
  }
  return area;
}

void cag_form_outline_turn(CagFormOutline *o, bool left) {
  if ((outline_area(o) > 0) == left) return;
  for (size_t i = 0; i < o->count; i++) {
    CagFormPiece *p = &o->items[i];
    const CagVec3 from = p->from;
    p->from = p->to;
    p->to = from;
    p->left = !p->left;
  }
  for (size_t i = 0, k = o->count; i + 1 < k; i++) {
    const CagFormPiece swap = o->items[i];
    o->items[i] = o->items[--k];
    o->items[k] = swap;
  }
}

// --- Corners and edges ---

static bool room_for(CagFormWork *w, void **array, size_t count, size_t size) {
  if (!w->status && !cag_brep_reserve(array, count, 1, size)) w->status = cag_fail_memory(w->err);
  return !w->status;
}

size_t cag_form_corner(CagFormWork *w, CagVec3 p) {
  CagBrep *b = w->brep;
  if (!room_for(w, (void **)&b->vertices, b->vertex_count, sizeof *b->vertices)) return 0;
  b->vertices[b->vertex_count] = cag_transform_point(&w->frame, p);
  return b->vertex_count++;
}

// Takes over the reference to the curve.
static size_t add_edge(CagFormWork *w, CagCurve *curve, size_t from, size_t to) {
  CagBrep *b = w->brep;
  if (!room_for(w, (void **)&b->edges, b->edge_count, sizeof *b->edges)) {
    cag_curve_release(curve);
    return 0;
  }
  b->edges[b->edge_count] = (CagBrepEdge){.curve = curve,
                                          .from = from,
                                          .to = to,
                                          .straight = curve && cag_brep_is_straight(curve),
                                          .timed = true};
  return b->edge_count++;
}

static CagCurve *segment(CagFormWork *w, CagVec3 p, CagVec3 q, double t0, double t1,
                         int dimension) {
  const CagVec3 ends[2] = {p, q};
  const double knots[4] = {t0, t0, t1, t1};
  CagCurve *c = NULL;
  if (!w->status) w->status = cag_curve_nurbs(ends, NULL, 2, 1, knots, dimension, &c, w->err);
  return w->status ? NULL : c;
}

size_t cag_form_line(CagFormWork *w, size_t from, size_t to, double t0, double t1) {
  if (w->status) return 0;
  const CagVec3 *at = w->brep->vertices;
  CagCurve *c = segment(w, at[from], at[to], t0, t1, 3);
  return add_edge(w, c, from, to);
}

// The frame in the world of an origin, x, and z in the work's coordinates.
static CagTransform world_frame(const CagFormWork *w, CagVec3 origin, CagVec3 x, CagVec3 z) {
  const CagVec3 y = cag_cross(z, x);
  const CagTransform own = {.m = {{x.x, y.x, z.x, origin.x},
                                  {x.y, y.y, z.y, origin.y},
                                  {x.z, y.z, z.z, origin.z},
                                  {0, 0, 0, 1}}};
  return cag_transform_multiply(&w->frame, &own);
}

size_t cag_form_arc(CagFormWork *w, CagVec3 center, CagVec3 x, CagVec3 z, double radius, double t0,
                    double t1, size_t from, size_t to) {
  const CagTransform frame = world_frame(w, center, x, z);
  CagCurve *c = NULL;
  if (!w->status) w->status = cag_curve_arc(radius, radius, t0, t1, &frame, &c, w->err);
  return w->status ? 0 : add_edge(w, c, from, to);
}

size_t cag_form_pole(CagFormWork *w, size_t corner) { return add_edge(w, NULL, corner, corner); }

// --- Faces ---

void cag_form_face(CagFormWork *w, CagCarrierKind kind, CagVec3 origin, CagVec3 x, CagVec3 z,
                   double a, double b, bool reversed, const double domain[4]) {
  CagBrep *brep = w->brep;
  if (!room_for(w, (void **)&brep->faces, brep->face_count, sizeof *brep->faces)) return;
  CagBrepFace f = {.reversed = reversed, .first = brep->loop_count};
  f.carrier = (CagCarrier){.kind = kind, .frame = world_frame(w, origin, x, z), .a = a, .b = b};
  for (int i = 0; domain && i < 4; i++) f.domain[i] = domain[i];
  brep->faces[brep->face_count++] = f;
  w->status = cag_stop_check(w->err);
}

void cag_form_loop(CagFormWork *w) {
  CagBrep *b = w->brep;
  if (!room_for(w, (void **)&b->loops, b->loop_count, sizeof *b->loops)) return;
  b->loops[b->loop_count++] = (CagBrepLoop){b->use_count, 0};
  b->faces[b->face_count - 1].count++;
}

void cag_form_use(CagFormWork *w, size_t edge, bool reversed, const double trace[4], double t0,
                  double t1) {
  CagBrep *b = w->brep;
  if (!room_for(w, (void **)&b->uses, b->use_count, sizeof *b->uses)) return;
  CagCurve *drawn = NULL;
  if (trace)
    drawn = segment(w, cag_vec3(trace[0], trace[1], 0), cag_vec3(trace[2], trace[3], 0), t0, t1, 2);
  if (w->status) return;
  b->uses[b->use_count++] = (CagBrepUse){edge, reversed, drawn};
  b->loops[b->loop_count - 1].count++;
}

void cag_form_shell(CagFormWork *w, size_t first) {
  CagBrep *b = w->brep;
  if (!room_for(w, (void **)&b->shells, b->shell_count, sizeof *b->shells)) return;
  b->shells[b->shell_count] = (CagBrepShell){first, b->face_count - first, true, b->shell_count};
  b->shell_count++;
}
