// Joins sides of faces to edges.
//
// Ends of sides that nearly coincide become one vertex. Two sides between the same vertices are one
// edge if points of one lie on the other, and if the loops traverse them in opposite directions, as
// for neighboring faces with consistent normals. A side without a partner is split at the vertices
// of others that lie on it, and tried again, so that one long side can meet two short ones.

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/sort.h"
#include "geom/curve/nurbs_ops.h"
#include "interp/formats/brep_build.h"

// --- Vertices ---

typedef struct End {
  CagVec3 p;
  size_t side, index; // index 0: start, 1: end
} End;

static int by_x(const void *a, const void *b) {
  double x = ((const End *)a)->p.x, y = ((const End *)b)->p.x;
  return x < y ? -1 : x > y;
}

static CagStatus add_vertex(CagBrep *b, size_t *room, CagVec3 p, size_t *index, CagError *err) {
  if (!cag_array_reserve(&b->vertices, room, b->vertex_count + 1, sizeof *b->vertices))
    return cag_fail_memory(err);
  *index = b->vertex_count;
  b->vertices[b->vertex_count++] = p;
  return CAG_OK;
}

static CagStatus gather_ends(const CagBrepWork *w, End *ends, CagError *err) {
  for (size_t i = 0; i < w->side_count; i++)
    for (size_t k = 0; k < 2; k++) {
      const CagCurve *c = w->sides[i].curve;
      End *e = &ends[2 * i + k];
      *e = (End){.side = i, .index = k};
      CagStatus status = cag_curve_point(c, k ? c->end : c->start, &e->p, err);
      if (status) return status;
    }
  return CAG_OK;
}

static CagStatus make_vertices(CagBrepWork *w, size_t first_vertex, CagError *err) {
  CagBrep *b = w->brep;
  size_t n = 2 * w->side_count, room = 16;
  while (room < b->vertex_count) room *= 2;
  const bool roomy = CAG_RESIZE(b->vertices, room);
  End *ends = cag_malloc((n ? n : 1) * sizeof *ends);
  CagStatus status = roomy && ends ? gather_ends(w, ends, err) : cag_fail_memory(err);
  b->vertex_count = first_vertex;
  if (!status) status = cag_sort(ends, n, sizeof *ends, by_x, err);
  size_t *vertex = cag_malloc((n ? n : 1) * sizeof *vertex);
  if (!vertex && !status) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    vertex[i] = SIZE_MAX;
    for (size_t k = i; k-- > 0 && ends[i].p.x - ends[k].p.x <= w->same;)
      if (cag_norm(cag_sub(ends[i].p, ends[k].p)) <= w->same) {
        vertex[i] = vertex[k];
        break;
      }
    if (vertex[i] == SIZE_MAX) status = add_vertex(b, &room, ends[i].p, &vertex[i], err);
    CagBrepSide *side = &w->sides[ends[i].side];
    if (ends[i].index == 0) side->from = vertex[i];
    else side->to = vertex[i];
  }
  cag_free(vertex);
  cag_free(ends);
  return status;
}

// --- Edges ---

// The number of points at which two sides are compared. Their order shows the direction of closed
// ones.
#define PROBES 5

// +1: the same curve, -1: the reversed curve, 0: different.
static CagStatus compare(const CagCurve *a, const CagCurve *b, double same, int *out, double *gap,
                         CagError *err) {
  *out = 0;
  double last = 0, widest = 0;
  int rising = 0;
  for (int i = 1; i <= PROBES; i++) {
    CagVec3 p, q;
    double t, distance;
    CagStatus status =
        cag_curve_point(a, a->start + (a->end - a->start) * i / (PROBES + 1), &p, err);
    if (!status) status = cag_curve_closest(b, p, &t, &q, &distance, err);
    if (status || distance > same) return status;
    widest = fmax(widest, distance);
    if (i > 1) rising += t > last ? 1 : -1;
    last = t;
  }
  *out = rising > 0 ? 1 : -1;
  *gap = fmax(*gap, widest);
  return CAG_OK;
}

static int by_vertices(const void *a, const void *b) {
  const CagBrepSide *s = *(const CagBrepSide *const *)a, *t = *(const CagBrepSide *const *)b;
  size_t s0 = s->from < s->to ? s->from : s->to, s1 = s->from < s->to ? s->to : s->from;
  size_t t0 = t->from < t->to ? t->from : t->to, t1 = t->from < t->to ? t->to : t->from;
  if (s0 != t0) return s0 < t0 ? -1 : 1;
  if (s1 != t1) return s1 < t1 ? -1 : 1;
  return s < t ? -1 : s > t; // in the order of the faces
}

static bool same_vertices(const CagBrepSide *s, const CagBrepSide *t) {
  return (s->from == t->from && s->to == t->to) || (s->from == t->to && s->to == t->from);
}

typedef struct Pair {
  size_t with;   // side; SIZE_MAX: none
  bool opposite; // the partner's curve is reversed
} Pair;

// Finds partners for the sides that have none.
static CagStatus pair_sides(CagBrepWork *w, Pair *pairs, CagError *err) {
  CagBrepSide **order = cag_malloc((w->side_count + 1) * sizeof *order);
  if (!order) return cag_fail_memory(err);
  size_t n = 0;
  for (size_t i = 0; i < w->side_count; i++)
    if (pairs[i].with == SIZE_MAX) order[n++] = &w->sides[i];
  CagStatus status = cag_sort(order, n, sizeof *order, by_vertices, err);
  for (size_t i = 0; !status && i < n; i++) {
    const CagBrepSide *a = order[i];
    size_t ia = (size_t)(a - w->sides);
    for (size_t k = i + 1; !status && k < n && same_vertices(a, order[k]); k++) {
      const CagBrepSide *b = order[k];
      size_t ib = (size_t)(b - w->sides);
      int how;
      if (pairs[ia].with != SIZE_MAX) break;
      if (pairs[ib].with != SIZE_MAX) continue;
      status = compare(a->curve, b->curve, w->same, &how, &w->brep->accuracy, err);
      // Neighboring faces traverse an edge in opposite directions.
      if (status || how == 0 || (how > 0) != (a->reversed != b->reversed)) continue;
      pairs[ia] = (Pair){ib, how < 0};
      pairs[ib] = (Pair){ia, how < 0};
    }
  }
  cag_free(order);
  return status;
}

// --- Long sides that meet several short ones ---

static bool near_box(const CagBounds *box, CagVec3 p, double off) {
  return p.x >= box->min.x - off && p.x <= box->max.x + off && p.y >= box->min.y - off &&
         p.y <= box->max.y + off && p.z >= box->min.z - off && p.z <= box->max.z + off;
}

// Finds a vertex, of another side without partner, inside the side, and its parameter t. Chooses
// the one nearest to the middle, so that few divisions are needed. `count` is the number of sides
// in `pairs`.
static CagStatus vertex_within(const CagBrepWork *w, const Pair *pairs, size_t count, size_t index,
                               double *t, bool *found, CagError *err) {
  const CagBrepSide *s = &w->sides[index];
  const double start = s->curve->start, end = s->curve->end, middle = (start + end) / 2;
  CagBounds box = s->curve->kind->hull(s->curve, start, end);
  *found = false;
  for (size_t k = 0; k < count; k++) {
    if (k == index || pairs[k].with != SIZE_MAX) continue;
    const size_t ends[2] = {w->sides[k].from, w->sides[k].to};
    for (int e = 0; e < 2; e++) {
      CagVec3 p = w->brep->vertices[ends[e]], q;
      double at, distance;
      if (ends[e] == s->from || ends[e] == s->to || !near_box(&box, p, w->same)) continue;
      CagStatus status = cag_curve_closest(s->curve, p, &at, &q, &distance, err);
      if (status) return status;
      if (distance > w->same || !(at > start && at < end)) continue;
      if (*found && fabs(at - middle) >= fabs(*t - middle)) continue;
      *found = true;
      *t = at;
    }
  }
  return CAG_OK;
}

// Splits the side in two. The second part is appended to the list.
static CagStatus cut_side(CagBrepWork *w, size_t index, double t, CagError *err) {
  CagCurve *parts[2];
  CagStatus status = cag_curve_split(w->sides[index].curve, t, parts, err);
  if (status) return status;
  if (!CAG_RESERVE(w->sides, w->side_room, w->side_count + 1)) {
    cag_curve_release(parts[0]);
    cag_curve_release(parts[1]);
    return cag_fail_memory(err);
  }
  CagBrepSide *s = &w->sides[index], *second = &w->sides[w->side_count++];
  // Orders stay unique: those after it in the loop increase by one.
  size_t order = s->order;
  for (size_t i = 0; i + 1 < w->side_count; i++)
    if (w->sides[i].loop == s->loop && w->sides[i].order > order) w->sides[i].order++;
  *second = *s;
  cag_curve_release(s->curve);
  s->curve = parts[0];
  second->curve = parts[1];
  if (s->reversed) s->order++;
  else second->order++;
  return CAG_OK;
}

// Appends the parts that are split off after the sides in `pairs`.
static CagStatus cut_sides(CagBrepWork *w, const Pair *pairs, bool *any, CagError *err) {
  size_t n = w->side_count;
  *any = false;
  for (size_t i = 0; i < n; i++) {
    bool found;
    double t = 0;
    if (pairs[i].with != SIZE_MAX) continue;
    CagStatus status = vertex_within(w, pairs, n, i, &t, &found, err);
    if (!status && found) status = cut_side(w, i, t, err), *any = true;
    if (status) return status;
  }
  return CAG_OK;
}

// Each round halves the number of remaining splits. A body that needs more rounds is not closed.
#define CUT_ROUNDS 64

// Makes vertices and finds partners. *pairs then has an element for each side.
static CagStatus match_sides(CagBrepWork *w, size_t first_vertex, Pair **pairs, CagError *err) {
  if (!CAG_RESIZE(*pairs, w->side_count + 1)) return cag_fail_memory(err);
  for (size_t i = 0; i < w->side_count; i++) (*pairs)[i] = (Pair){SIZE_MAX, false};
  CagStatus status = make_vertices(w, first_vertex, err);
  return status ? status : pair_sides(w, *pairs, err);
}

static CagStatus find_pairs(CagBrepWork *w, Pair **pairs, CagError *err) {
  size_t first_vertex = w->brep->vertex_count;
  *pairs = NULL;
  bool any = true;
  CagStatus status = match_sides(w, first_vertex, pairs, err);
  for (int round = 0; !status && any && round < CUT_ROUNDS; round++) {
    status = cut_sides(w, *pairs, &any, err);
    if (!status && any) status = match_sides(w, first_vertex, pairs, err);
  }
  return status;
}

// --- The result ---

static CagStatus make_edges(CagBrepWork *w, const Pair *pairs, CagError *err) {
  CagBrep *b = w->brep;
  if (!cag_brep_reserve((void **)&b->edges, b->edge_count, w->side_count, sizeof *b->edges) ||
      !cag_brep_reserve((void **)&b->uses, b->use_count, w->side_count, sizeof *b->uses))
    return cag_fail_memory(err);
  for (size_t i = 0; i < w->side_count; i++) {
    CagBrepSide *s = &w->sides[i];
    if (s->edge != SIZE_MAX) continue; // assigned with its partner
    s->edge = b->edge_count;
    b->edges[b->edge_count++] = (CagBrepEdge){.curve = cag_curve_retain(s->curve),
                                              .from = s->from,
                                              .to = s->to,
                                              .straight = cag_brep_is_straight(s->curve)};
    if (pairs[i].with == SIZE_MAX) continue;
    CagBrepSide *other = &w->sides[pairs[i].with];
    other->edge = s->edge;
    other->reversed = !s->reversed; // opposite to the edge now
  }
  return CAG_OK;
}

static int by_loop(const void *a, const void *b) {
  const CagBrepSide *s = a, *t = b;
  if (s->loop != t->loop) return s->loop < t->loop ? -1 : 1;
  return s->order < t->order ? -1 : s->order > t->order;
}

static void make_loops(CagBrepWork *w) {
  CagBrep *b = w->brep;
  qsort(w->sides, w->side_count, sizeof *w->sides, by_loop);
  size_t at = 0;
  for (size_t l = w->first_loop; l < b->loop_count; l++) {
    b->loops[l].first = b->use_count;
    for (; at < w->side_count && w->sides[at].loop == l; at++)
      b->uses[b->use_count++] = (CagBrepUse){w->sides[at].edge, w->sides[at].reversed, NULL};
    b->loops[l].count = b->use_count - b->loops[l].first;
  }
}

CagStatus cag_brep_join(CagBrepWork *w, CagError *err) {
  Pair *pairs = NULL;
  CagStatus status = find_pairs(w, &pairs, err);
  if (!status) status = make_edges(w, pairs, err);
  if (!status) make_loops(w);
  cag_free(pairs);
  return status;
}
