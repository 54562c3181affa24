// Edges of welded triangle meshes: a counting sort by the lower vertex, then a short sort of each
// vertex's few edges.

#include "geom/mesh/edges.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/stop.h"

static int by_high(const void *a, const void *b) {
  const CagMeshEdge *p = a, *q = b;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return p->place < q->place ? -1 : p->place > q->place;
}

// Sorts one vertex's edges; most vertices have six or fewer.
static void sort_bucket(CagMeshEdge *e, size_t n) {
  enum { INSERTION_LIMIT = 24 };
  if (n > INSERTION_LIMIT) {
    qsort(e, n, sizeof *e, by_high);
    return;
  }
  for (size_t i = 1; i < n; i++) {
    CagMeshEdge moving = e[i];
    size_t j = i;
    for (; j > 0 && by_high(&moving, &e[j - 1]) < 0; j--) e[j] = e[j - 1];
    e[j] = moving;
  }
}

CagMeshEdge *cag_mesh_edges(const uint32_t *triangles, size_t triangle_count, const uint32_t *weld,
                            size_t vertex_count, size_t *n) {
  size_t *start = cag_calloc(vertex_count + 2, sizeof *start);
  CagMeshEdge *edges = cag_malloc((triangle_count * 3 + 1) * sizeof *edges);
  if (!start || !edges) {
    cag_free(start);
    cag_free(edges);
    return NULL;
  }
  // Two passes over the triangles: count the edges of each lower vertex, then put them there.
  bool stopped = false;
  for (int pass = 0; pass < 2 && !stopped; pass++) {
    for (size_t t = 0; t < triangle_count && !stopped; t++) {
      stopped = cag_stopped();
      for (unsigned k = 0; k < 3; k++) {
        uint32_t a = triangles[3 * t + k], b = triangles[3 * t + (k + 1) % 3];
        if (weld) a = weld[a], b = weld[b];
        if (a == b) continue;
        uint32_t low = a < b ? a : b, high = a < b ? b : a;
        if (pass == 0) start[low + 2]++;
        else
          edges[start[low + 1]++] = (CagMeshEdge){low, high, (uint64_t)t << 3 | k << 1 | (a < b)};
      }
    }
    if (pass == 0)
      for (size_t v = 2; v < vertex_count + 2; v++) start[v] += start[v - 1];
  }
  for (size_t v = 0; v < vertex_count && !stopped; v++) {
    stopped = cag_stopped();
    sort_bucket(edges + start[v], start[v + 1] - start[v]);
  }
  *n = start[vertex_count];
  cag_free(start);
  if (stopped) {
    cag_free(edges);
    return NULL;
  }
  return edges;
}
