// Detects polygons that would take too long to triangulate.
//
// The polygon is projected along the axis nearest to its normal. Its edges are sorted by their
// smallest x, and each is compared with those whose range contains it. A proper crossing decides.
// Edges may touch, as bridges to holes do, but not much more often than there are corners.

#include "interp/formats/tangle.h"

#include <stdlib.h>

#include "base/memory.h"

// The number of corners up to which any polygon is triangulated. Even if every edge crosses every
// other, this takes only milliseconds.
#define FEW_CORNERS 128
// The maximum number of pairs of edges that are compared: about a second.
#define MOST_PAIRS ((size_t)200000000)
// The maximum number of touching pairs, except neighbors, per corner.
#define MOST_TOUCHES 8

typedef struct Edge {
  double a[2], b[2]; // a[0] <= b[0]
  size_t number;     // in the polygon
} Edge;

static int compare(const void *a, const void *b) {
  double x = ((const Edge *)a)->a[0], y = ((const Edge *)b)->a[0];
  return (x > y) - (x < y);
}

static void make_edges(const CagVec3 *positions, const uint32_t *corners, size_t n, Edge *edges) {
  CagVec3 normal = {0, 0, 0}, first = positions[corners[0]];
  for (size_t k = 1; k + 1 < n; k++)
    normal = cag_add(normal, cag_cross(cag_sub(positions[corners[k]], first),
                                       cag_sub(positions[corners[k + 1]], first)));
  double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
  int along = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  for (size_t k = 0; k < n; k++) {
    const double *p = &positions[corners[k]].x, *q = &positions[corners[(k + 1) % n]].x;
    bool turned = p[(along + 1) % 3] > q[(along + 1) % 3];
    for (int i = 0; i < 2; i++) {
      edges[k].a[i] = (turned ? q : p)[(along + 1 + i) % 3];
      edges[k].b[i] = (turned ? p : q)[(along + 1 + i) % 3];
    }
    edges[k].number = k;
  }
  qsort(edges, n, sizeof *edges, compare);
}

static double side(const Edge *e, const double p[2]) {
  return (e->b[0] - e->a[0]) * (p[1] - e->a[1]) - (e->b[1] - e->a[1]) * (p[0] - e->a[0]);
}

typedef enum Meeting { APART, TOUCHING, CROSSING } Meeting;

static Meeting meeting_of(const Edge *e, const Edge *f) {
  if (fmax(e->a[1], e->b[1]) < fmin(f->a[1], f->b[1]) ||
      fmax(f->a[1], f->b[1]) < fmin(e->a[1], e->b[1]))
    return APART;
  double s = side(e, f->a), t = side(e, f->b), u = side(f, e->a), v = side(f, e->b);
  if ((s > 0 && t > 0) || (s < 0 && t < 0) || (u > 0 && v > 0) || (u < 0 && v < 0)) return APART;
  return s != 0 && t != 0 && u != 0 && v != 0 ? CROSSING : TOUCHING;
}

static CagTangle sweep(const Edge *edges, size_t n, const Edge **active) {
  size_t count = 0, pairs = 0, touches = 0;
  for (size_t k = 0; k < n; k++) {
    const Edge *e = &edges[k];
    size_t kept = 0;
    for (size_t j = 0; j < count; j++) {
      const Edge *f = active[j];
      if (f->b[0] < e->a[0]) continue; // it ended before
      active[kept++] = f;
      size_t apart = e->number > f->number ? e->number - f->number : f->number - e->number;
      if (apart == 1 || apart == n - 1) continue;
      Meeting meeting = meeting_of(e, f);
      if (meeting == CROSSING) return CAG_TANGLE_CROSSED;
      touches += meeting == TOUCHING;
    }
    pairs += count;
    count = kept;
    active[count++] = e;
    if (touches > MOST_TOUCHES * n) return CAG_TANGLE_CROSSED;
    if (pairs > MOST_PAIRS) return CAG_TANGLE_UNKNOWN;
  }
  return CAG_TANGLE_NONE;
}

CagTangle cag_tangle_of(const CagVec3 *positions, const uint32_t *corners, size_t n) {
  if (n <= FEW_CORNERS) return CAG_TANGLE_NONE;
  Edge *edges = cag_malloc(n * sizeof *edges);
  const Edge **active = cag_malloc(n * sizeof *active);
  CagTangle tangle = CAG_TANGLE_MEMORY;
  if (edges && active) {
    make_edges(positions, corners, n, edges);
    tangle = sweep(edges, n, active);
  }
  cag_free(edges);
  cag_free(active);
  return tangle;
}
