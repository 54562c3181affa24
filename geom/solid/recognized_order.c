// The order of recognized boundaries (see recognized_order.h).
//
// Coordinates along an axis are sorted, and those without a gap between them form a class. Parts are
// compared by the classes of their coordinates, so that rounding errors do not change the order.

#include "geom/solid/recognized_order.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/boundary/carrier.h"
#include "geom/curve/family.h"

// Points of a closed curve that is not a conic, whose mean is its position.
#define CLOSED_POINTS 16
// A face goes all around if its angles are this close to a turn (radians).
#define WHOLE_TURN 1e-6

typedef struct OrderKey {
  double at[3];
  size_t class[3];
  size_t ties[2]; // numbers of parts that are sorted already
  size_t index;   // before sorting
} OrderKey;

// --- Sorting ---

// A coordinate, and the key to which it belongs.
typedef struct OrderValue {
  double x;
  size_t key;
} OrderValue;

static int by_coordinate(const void *a, const void *b) {
  const double x = ((const OrderValue *)a)->x, y = ((const OrderValue *)b)->x;
  return x < y ? -1 : x > y;
}

static int compare_sizes(size_t a, size_t b) { return a < b ? -1 : a > b; }

static int by_class(const void *a, const void *b) {
  const OrderKey *k = a, *l = b;
  int c = 0;
  for (int i = 0; c == 0 && i < 3; i++) c = compare_sizes(k->class[i], l -> class[i]);
  for (int i = 0; c == 0 && i < 2; i++) c = compare_sizes(k->ties[i], l->ties[i]);
  return c ? c : compare_sizes(k->index, l->index);
}

// Sorts keys, whose indexes are their places. rank[i]: the new place of key i.
static CagStatus sort_keys(OrderKey *keys, size_t n, double slack, size_t *rank, CagError *err) {
  OrderValue *values = cag_malloc((n + 1) * sizeof *values);
  if (!values) return cag_fail_memory(err);
  for (int axis = 0; axis < 3; axis++) {
    size_t class = 0;
    for (size_t i = 0; i < n; i++) values[i] = (OrderValue){keys[i].at[axis], i};
    qsort(values, n, sizeof *values, by_coordinate);
    for (size_t i = 0; i < n; i++) {
      class += i > 0 && values[i].x - values[i - 1].x > slack;
      keys[values[i].key].class[axis] = class;
    }
  }
  qsort(keys, n, sizeof *keys, by_class);
  for (size_t i = 0; i < n; i++) rank[keys[i].index] = i;
  cag_free(values);
  return CAG_OK;
}

static OrderKey position_key(CagVec3 p, size_t index) {
  return (OrderKey){.at = {p.x, p.y, p.z}, .index = index};
}

// --- Positions ---

static CagStatus edge_position(const CagCurve *c, CagVec3 *out, CagError *err) {
  CagVec3 center, x, y, p, sum = {0, 0, 0};
  double rate;
  if (!c->closed || cag_curve_arc_axes(c, &center, &x, &y, &rate))
    return cag_curve_point(c, c->start + (c->end - c->start) / 2, out, err);
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i < CLOSED_POINTS; i++) {
    status = cag_curve_point(c, c->start + (c->end - c->start) * i / CLOSED_POINTS, &p, err);
    if (!status) sum = cag_add(sum, p);
  }
  *out = cag_scaled(sum, 1.0 / CLOSED_POINTS);
  return status;
}

// The kernel's faces that go all around have a seam, which lies opposite the middles of their closed
// edges. The centers of these edges stand for both.
static CagVec3 position_in_face(const CagBoundary *b, const CagBoundaryFace *f, size_t edge,
                                const CagVec3 *middles) {
  CagVec3 center, x, y;
  double rate;
  const CagCurve *c = b->edges[edge].curve;
  const bool around = cag_carrier_is_periodic(&f->carrier, 0) &&
                      f->domain[1] - f->domain[0] >= 2 * M_PI - WHOLE_TURN;
  return around && c->closed && cag_curve_arc_axes(c, &center, &x, &y, &rate) ? center
                                                                              : middles[edge];
}

static OrderKey face_key(const CagBoundary *b, size_t face, const CagVec3 *middles) {
  const CagBoundaryFace *f = &b->faces[face];
  CagVec3 sum = {0, 0, 0};
  size_t n = 0, least = SIZE_MAX, most = 0;
  for (size_t l = f->first; l < f->first + f->count; l++)
    for (size_t u = b->loops[l].first; u < b->loops[l].first + b->loops[l].count; u++, n++) {
      const size_t edge = b->uses[u].edge;
      sum = cag_add(sum, position_in_face(b, f, edge, middles));
      if (edge < least) least = edge;
      if (edge > most) most = edge;
    }
  OrderKey key = position_key(
      n > 0 ? cag_scaled(sum, 1 / (double)n) : cag_frame_column(&f->carrier.frame, 3), face);
  key.ties[0] = least;
  key.ties[1] = most;
  return key;
}

// --- Parts ---

typedef struct Ordering {
  CagBoundary *b;
  OrderKey *keys;
  size_t *rank;     // of the parts that were sorted last
  CagVec3 *middles; // of edges, in their new order
  double slack;
} Ordering;

static CagStatus order_corners(const Ordering *o, CagError *err) {
  CagBoundary *b = o->b;
  for (size_t i = 0; i < b->corner_count; i++) o->keys[i] = position_key(b->corners[i], i);
  CagStatus status = sort_keys(o->keys, b->corner_count, o->slack, o->rank, err);
  if (status) return status;
  for (size_t i = 0; i < b->corner_count; i++) {
    const double *at = o->keys[i].at;
    b->corners[i] = cag_vec3(at[0], at[1], at[2]);
  }
  for (size_t i = 0; i < b->edge_count; i++) {
    b->edges[i].from = o->rank[b->edges[i].from];
    b->edges[i].to = o->rank[b->edges[i].to];
  }
  return CAG_OK;
}

static CagStatus order_edges(const Ordering *o, CagError *err) {
  CagBoundary *b = o->b;
  CagStatus status = CAG_OK;
  CagBoundaryEdge *edges = cag_calloc(b->edge_count + 1, sizeof *edges);
  if (!edges) return cag_fail_memory(err);
  for (size_t i = 0; !status && i < b->edge_count; i++) {
    const CagBoundaryEdge *e = &b->edges[i];
    CagVec3 p;
    status = edge_position(e->curve, &p, err);
    if (!status) status = cag_stop_check(err);
    if (status) break;
    o->keys[i] = position_key(p, i);
    o->keys[i].ties[0] = e->from < e->to ? e->from : e->to;
    o->keys[i].ties[1] = e->from < e->to ? e->to : e->from;
  }
  if (!status) status = sort_keys(o->keys, b->edge_count, o->slack, o->rank, err);
  if (status) {
    cag_free(edges);
    return status;
  }
  for (size_t i = 0; i < b->edge_count; i++) {
    const double *at = o->keys[i].at;
    o->middles[i] = cag_vec3(at[0], at[1], at[2]);
    edges[o->rank[i]] = b->edges[i];
  }
  for (size_t i = 0; i < b->use_count; i++) b->uses[i].edge = o->rank[b->uses[i].edge];
  cag_free(b->edges);
  b->edges = edges;
  return CAG_OK;
}

static CagStatus order_faces(const Ordering *o, CagError *err) {
  CagBoundary *b = o->b;
  CagBoundaryFace *faces = cag_calloc(b->face_count + 1, sizeof *faces);
  if (!faces) return cag_fail_memory(err);
  for (size_t i = 0; i < b->face_count; i++) o->keys[i] = face_key(b, i, o->middles);
  const CagStatus status = sort_keys(o->keys, b->face_count, o->slack, o->rank, err);
  if (status) {
    cag_free(faces);
    return status;
  }
  for (size_t i = 0; i < b->face_count; i++) faces[o->rank[i]] = b->faces[i];
  cag_free(b->faces);
  b->faces = faces;
  return CAG_OK;
}

CagStatus cag_recognized_order(CagBoundary *b, double slack, size_t *rank, CagError *err) {
  size_t n = b->corner_count;
  if (b->edge_count > n) n = b->edge_count;
  if (b->face_count > n) n = b->face_count;
  Ordering o = {b, cag_calloc(n + 1, sizeof *o.keys), cag_calloc(n + 1, sizeof *o.rank),
                cag_calloc(b->edge_count + 1, sizeof *o.middles), slack};
  CagStatus status = o.keys && o.rank && o.middles ? CAG_OK : cag_fail_memory(err);
  if (!status) status = order_corners(&o, err);
  if (!status) status = order_edges(&o, err);
  if (!status) status = order_faces(&o, err);
  for (size_t i = 0; !status && i < b->face_count; i++) rank[i] = o.rank[i];
  cag_free(o.keys);
  cag_free(o.rank);
  cag_free(o.middles);
  return status;
}
