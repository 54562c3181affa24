// Outlines of lines and arcs turned about an axis (see brep_outline.h).
//
// The outline is in the half plane of its distance from the axis (x) and its height (y). Each of its
// pieces turns to a face, whose parameters are the angle u and, along the piece, v. Edges are rings,
// around the axis at the corners of the outline, and meridians, along the pieces with increasing v.
// A full turn has the meridians at one angle, which are seams, and other turns at both.

#include <math.h>

#include "base/memory.h"
#include "interp/formats/brep_outline.h"

static const CagVec3 X = {1, 0, 0}, Z = {0, 0, 1};

typedef struct Turn {
  CagFormWork *work;
  double from, to;
  bool full;
} Turn;

// What a piece turns to.
typedef struct Side {
  CagCarrierKind kind; // NONE: it is on the axis
  bool along;          // v increases along the outline
  double low, high;    // of v
  CagVec3 origin;      // of the carrier
  double a, b;
  size_t corner[2];   // at the start of the piece: at both angles, or at the pole
  size_t ring;        // at the start of the piece, if it is not a pole
  size_t meridian[2]; // at both angles
} Side;

// --- Kinds ---

static Side line_side(const CagFormPiece *p) {
  const double over = p->to.x - p->from.x, up = p->to.y - p->from.y;
  Side s = {.kind = CAG_CARRIER_NONE, .along = up >= 0};
  const CagVec3 low = s.along ? p->from : p->to, high = s.along ? p->to : p->from;
  s.high = hypot(over, up);
  if (low.x == 0 && high.x == 0) return s;
  s.origin = cag_vec3(0, 0, low.y);
  s.a = low.x;
  s.kind = up == 0 ? CAG_CARRIER_PLANE : over == 0 ? CAG_CARRIER_CYLINDER : CAG_CARRIER_CONE;
  if (s.kind == CAG_CARRIER_CONE) s.b = atan2(high.x - low.x, high.y - low.y);
  return s;
}

static Side arc_side(const CagFormPiece *p) {
  const bool sphere = p->center.x == 0;
  return (Side){.kind = sphere ? CAG_CARRIER_SPHERE : CAG_CARRIER_TORUS,
                .along = p->left,
                .low = p->start,
                .high = p->start + p->sweep,
                .origin = cag_vec3(0, 0, p->center.y),
                .a = sphere ? p->radius : p->center.x,
                .b = sphere ? 0 : p->radius};
}

static void snap(double *x, double to, double near) {
  if (fabs(*x - to) <= near) *x = to;
}

bool cag_form_outline_turns(CagFormOutline *o, double near) {
  bool fits = o->count > 0;
  for (size_t i = 0; i < o->count; i++) {
    CagFormPiece *p = &o->items[i];
    snap(&p->from.x, 0, near);
    snap(&p->to.x, 0, near);
    snap(&p->center.x, 0, near);
    if (!p->round) {
      snap(&p->to.x, p->from.x, near);
      snap(&p->to.y, p->from.y, near);
      o->items[(i + 1) % o->count].from = p->to;
    }
    fits = fits && p->from.x >= 0 && p->to.x >= 0;
    // A torus that meets itself at the axis has no such surface in other programs.
    if (p->round) fits = fits && (p->center.x == 0 || p->center.x > p->radius + near);
  }
  return fits;
}

// --- Edges ---

static CagVec3 radial(double angle) { return cag_vec3(cos(angle), sin(angle), 0); }

static CagVec3 turned_point(CagVec3 p, double angle) {
  return cag_vec3(p.x * cos(angle), p.x * sin(angle), p.y);
}

static bool is_curved(const Side *s) {
  return s->kind != CAG_CARRIER_NONE && s->kind != CAG_CARRIER_PLANE;
}

// The center of a disk is not a corner.
static void make_corners(const Turn *t, const CagFormPiece *p, Side *s, const Side *before) {
  CagFormWork *w = t->work;
  if (p->from.x == 0 && t->full && !is_curved(s) && !is_curved(before)) return;
  s->corner[0] = s->corner[1] = cag_form_corner(w, turned_point(p->from, t->from));
  if (p->from.x == 0) return;
  if (!t->full) s->corner[1] = cag_form_corner(w, turned_point(p->from, t->to));
  s->ring = cag_form_arc(w, cag_vec3(0, 0, p->from.y), X, Z, p->from.x, t->from, t->to,
                         s->corner[0], s->corner[1]);
}

static size_t meridian(const Turn *t, const CagFormPiece *p, const Side *s, const Side *next,
                       int end) {
  const double angle = end ? t->to : t->from;
  const size_t from = s->along ? s->corner[end] : next->corner[end];
  const size_t to = s->along ? next->corner[end] : s->corner[end];
  if (!p->round) return cag_form_line(t->work, from, to, s->low, s->high);
  const CagVec3 x = radial(angle), z = cag_vec3(sin(angle), -cos(angle), 0);
  return cag_form_arc(t->work, turned_point(p->center, angle), x, z, p->radius, s->low, s->high,
                      from, to);
}

static void make_meridians(const Turn *t, const CagFormPiece *p, Side *s, const Side *next) {
  if (t->full && !is_curved(s)) return;
  s->meridian[0] = s->meridian[1] = meridian(t, p, s, next, 0);
  if (!t->full && s->kind != CAG_CARRIER_NONE) s->meridian[1] = meridian(t, p, s, next, 1);
}

// --- Faces ---

// The use of the ring, or of the pole, at the start of a piece.
static void use_ring(const Turn *t, const CagFormPiece *p, const Side *at, bool reversed,
                     double v) {
  const bool pole = p->from.x == 0;
  const size_t edge = pole ? cag_form_pole(t->work, at->corner[0]) : at->ring;
  cag_form_use(t->work, edge, reversed, (const double[4]){t->from, v, t->to, v}, t->from, t->to);
}

static void round_face(const Turn *t, const CagFormPiece *p, const Side *s,
                       const CagFormPiece *next_piece, const Side *next) {
  CagFormWork *w = t->work;
  const double domain[4] = {t->from, t->to, s->low, s->high};
  cag_form_face(w, s->kind, s->origin, X, Z, s->a, s->b, !s->along, domain);
  cag_form_loop(w);
  use_ring(t, p, s, false, s->along ? s->low : s->high);
  cag_form_use(w, s->meridian[1], !s->along, (const double[4]){t->to, s->low, t->to, s->high},
               s->low, s->high);
  use_ring(t, next_piece, next, true, s->along ? s->high : s->low);
  cag_form_use(w, s->meridian[0], s->along, (const double[4]){t->from, s->low, t->from, s->high},
               s->low, s->high);
}

// A full turn has a loop for each ring, the larger one first.
static void plane_face(const Turn *t, const CagFormPiece *p, const Side *s, const Side *next) {
  CagFormWork *w = t->work;
  const bool down = p->to.x > p->from.x;
  const bool ring[2] = {p->from.x > 0, p->to.x > 0};
  cag_form_face(w, CAG_CARRIER_PLANE, s->origin, X, cag_vec3(0, 0, down ? -1 : 1), 0, 0, false,
                NULL);
  for (int k = 0; t->full && k < 2; k++) {
    const int end = down ? 1 - k : k;
    if (!ring[end]) continue;
    cag_form_loop(w);
    cag_form_use(w, end ? next->ring : s->ring, end, NULL, 0, 0);
  }
  if (t->full) return;
  cag_form_loop(w);
  if (ring[0]) cag_form_use(w, s->ring, false, NULL, 0, 0);
  cag_form_use(w, s->meridian[1], !s->along, NULL, 0, 0);
  if (ring[1]) cag_form_use(w, next->ring, true, NULL, 0, 0);
  cag_form_use(w, s->meridian[0], s->along, NULL, 0, 0);
}

static void end_face(const Turn *t, const Side *sides, size_t n, int end) {
  const double angle = end ? t->to : t->from;
  const double sign = end ? -1 : 1;
  cag_form_face(t->work, CAG_CARRIER_PLANE, cag_vec3(0, 0, 0), radial(angle),
                cag_vec3(sign * sin(angle), -sign * cos(angle), 0), 0, 0, false, NULL);
  cag_form_loop(t->work);
  for (size_t k = 0; k < n; k++) {
    const Side *s = &sides[end ? n - 1 - k : k];
    cag_form_use(t->work, s->meridian[end], s->along == (end == 1), NULL, 0, 0);
  }
}

void cag_form_turned(CagFormWork *w, const CagFormOutline *o, double from, double to) {
  const size_t n = o->count, first = w->brep->face_count;
  const Turn t = {w, from, to, to - from > 2 * M_PI * (1 - 1e-12)};
  Side *sides = cag_calloc(n + 1, sizeof *sides);
  if (!sides && !w->status) w->status = cag_fail_memory(w->err);
  for (size_t i = 0; !w->status && i < n; i++) {
    const CagFormPiece *p = &o->items[i];
    sides[i] = p->round ? arc_side(p) : line_side(p);
  }
  for (size_t i = 0; !w->status && i < n; i++)
    make_corners(&t, &o->items[i], &sides[i], &sides[(i + n - 1) % n]);
  for (size_t i = 0; !w->status && i < n; i++)
    make_meridians(&t, &o->items[i], &sides[i], &sides[(i + 1) % n]);
  for (size_t i = 0; !w->status && i < n; i++) {
    const CagFormPiece *p = &o->items[i];
    const size_t k = (i + 1) % n;
    if (sides[i].kind == CAG_CARRIER_PLANE) plane_face(&t, p, &sides[i], &sides[k]);
    else if (is_curved(&sides[i])) round_face(&t, p, &sides[i], &o->items[k], &sides[k]);
  }
  for (int end = 0; !w->status && !t.full && end < 2; end++) end_face(&t, sides, n, end);
  cag_form_shell(w, first);
  cag_free(sides);
}
