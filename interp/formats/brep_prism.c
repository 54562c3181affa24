// Prisms of outlines of lines and arcs (see brep_outline.h).
//
// Edges at the bottom and at the top run along lines, and counter-clockwise along arcs.

#include <math.h>

#include "base/memory.h"
#include "interp/formats/brep_outline.h"

static const CagVec3 Z = {0, 0, 1};

// The corners and edges at a piece of an outline; the upright edge is at its start.
typedef struct Rim {
  size_t low, high, bottom, top, upright;
  bool against; // the edges run against the outline
} Rim;

static size_t piece_edge(CagFormWork *w, const CagFormPiece *p, double z, size_t from, size_t to) {
  const CagVec3 center = cag_vec3(p->center.x, p->center.y, z);
  if (!p->round) return cag_form_line(w, from, to, 0, cag_norm(cag_sub(p->to, p->from)));
  return cag_form_arc(w, center, cag_vec3(cos(p->start), sin(p->start), 0), Z, p->radius, 0,
                      p->sweep, p->left ? from : to, p->left ? to : from);
}

static void make_rims(CagFormWork *w, const CagFormOutline *o, double height, Rim *rims) {
  for (size_t i = 0; i < o->count; i++) {
    const CagVec3 at = o->items[i].from;
    rims[i].low = cag_form_corner(w, at);
    rims[i].high = cag_form_corner(w, cag_vec3(at.x, at.y, height));
    rims[i].upright = cag_form_line(w, rims[i].low, rims[i].high, 0, height);
  }
  for (size_t i = 0; i < o->count; i++) {
    const CagFormPiece *p = &o->items[i];
    const Rim *next = &rims[(i + 1) % o->count];
    rims[i].bottom = piece_edge(w, p, 0, rims[i].low, next->low);
    rims[i].top = piece_edge(w, p, height, rims[i].high, next->high);
    rims[i].against = p->round && !p->left;
  }
}

static void plane_side(CagFormWork *w, const CagFormPiece *p, const Rim *rim, const Rim *next) {
  const CagVec3 x = cag_unit(cag_sub(p->to, p->from));
  cag_form_face(w, CAG_CARRIER_PLANE, p->from, x, cag_vec3(x.y, -x.x, 0), 0, 0, false, NULL);
  cag_form_loop(w);
  cag_form_use(w, rim->bottom, false, NULL, 0, 0);
  cag_form_use(w, next->upright, false, NULL, 0, 0);
  cag_form_use(w, rim->top, true, NULL, 0, 0);
  cag_form_use(w, rim->upright, true, NULL, 0, 0);
}

static void round_side(CagFormWork *w, const CagFormPiece *p, const Rim *rim, const Rim *next,
                       double height) {
  const double first = p->left ? 0 : p->sweep, last = p->left ? p->sweep : 0;
  const double domain[4] = {0, p->sweep, 0, height};
  cag_form_face(w, CAG_CARRIER_CYLINDER, p->center, cag_vec3(cos(p->start), sin(p->start), 0), Z,
                p->radius, 0, !p->left, domain);
  cag_form_loop(w);
  cag_form_use(w, rim->bottom, rim->against, (const double[4]){0, 0, p->sweep, 0}, 0, p->sweep);
  cag_form_use(w, next->upright, false, (const double[4]){last, 0, last, height}, 0, height);
  cag_form_use(w, rim->top, !rim->against, (const double[4]){0, height, p->sweep, height}, 0,
               p->sweep);
  cag_form_use(w, rim->upright, true, (const double[4]){first, 0, first, height}, 0, height);
}

static void cap_loop(CagFormWork *w, const Rim *rims, size_t n, bool top) {
  cag_form_loop(w);
  for (size_t k = 0; k < n; k++) {
    const Rim *rim = &rims[top ? k : n - 1 - k];
    cag_form_use(w, top ? rim->top : rim->bottom, rim->against == top, NULL, 0, 0);
  }
}

// The ends of an outer outline, with those in it as holes.
static void caps(CagFormWork *w, const CagFormOutline *outlines, Rim *const *rims,
                 const size_t *outer, size_t n, size_t own, double height) {
  for (int top = 0; top < 2; top++) {
    cag_form_face(w, CAG_CARRIER_PLANE, cag_vec3(0, 0, top ? height : 0), cag_vec3(1, 0, 0),
                  cag_vec3(0, 0, top ? 1 : -1), 0, 0, false, NULL);
    cap_loop(w, rims[own], outlines[own].count, top);
    for (size_t i = 0; i < n; i++)
      if (i != own && outer[i] == own) cap_loop(w, rims[i], outlines[i].count, top);
  }
}

static void sides(CagFormWork *w, const CagFormOutline *o, const Rim *rims, double height) {
  for (size_t i = 0; i < o->count; i++) {
    const Rim *next = &rims[(i + 1) % o->count];
    if (o->items[i].round) round_side(w, &o->items[i], &rims[i], next, height);
    else plane_side(w, &o->items[i], &rims[i], next);
  }
}

void cag_form_prism(CagFormWork *w, const CagFormOutline *outlines, const size_t *outer, size_t n,
                    double height) {
  Rim **rims = cag_calloc(n + 1, sizeof *rims);
  bool failed = !rims;
  for (size_t i = 0; !failed && i < n; i++) {
    rims[i] = cag_calloc(outlines[i].count + 1, sizeof **rims);
    failed = !rims[i];
    if (!failed) make_rims(w, &outlines[i], height, rims[i]);
  }
  if (failed && !w->status) w->status = cag_fail_memory(w->err);
  for (size_t own = 0; !w->status && own < n; own++) {
    if (outer[own] != own) continue;
    const size_t first = w->brep->face_count;
    for (size_t i = 0; i < n; i++)
      if (outer[i] == own) sides(w, &outlines[i], rims[i], height);
    caps(w, outlines, rims, outer, n, own, height);
    cag_form_shell(w, first);
  }
  for (size_t i = 0; rims && i < n; i++) cag_free(rims[i]);
  cag_free(rims);
}
