// Measures and checks of triangle meshes: bounds, area, volume integrals, closedness, Euler
// characteristic.

#include <stdlib.h>

#include "base/memory.h"
#include "geom/mesh/edges.h"
#include "geom/mesh/mesh.h"

CagBounds cag_mesh_bounds(const CagMesh *m) {
  CagBounds b = CAG_BOUNDS_EMPTY;
  for (size_t i = 0; i < m->vertex_count; i++) cag_bounds_add(&b, m->positions[i]);
  return b;
}

double cag_mesh_area(const CagMesh *m) {
  double twice = 0;
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]];
    twice += cag_norm(cag_cross(cag_sub(m->positions[k[1]], a), cag_sub(m->positions[k[2]], a)));
  }
  return twice / 2;
}

// Each triangle spans a signed tetrahedron with the origin. Over a tetrahedron of volume V with one
// corner at the origin and the others a, b, c: the integral of x is V/4 (ax + bx + cx), and that of
// x y is V/20 (sx sy + ax ay + bx by + cx cy) with s = a + b + c.
void cag_mesh_volume_terms(const CagMesh *m, double terms[10]) {
  double sum[10] = {0};
  for (size_t t = 0; t < m->triangle_count; t++) {
    const uint32_t *k = m->triangles + 3 * t;
    CagVec3 a = m->positions[k[0]], b = m->positions[k[1]], c = m->positions[k[2]];
    double v = cag_dot(a, cag_cross(b, c)) / 6;
    CagVec3 s = cag_add(cag_add(a, b), c);
    sum[0] += v;
    sum[1] += v / 4 * s.x;
    sum[2] += v / 4 * s.y;
    sum[3] += v / 4 * s.z;
    sum[4] += v / 20 * (s.x * s.x + a.x * a.x + b.x * b.x + c.x * c.x);
    sum[5] += v / 20 * (s.y * s.y + a.y * a.y + b.y * b.y + c.y * c.y);
    sum[6] += v / 20 * (s.z * s.z + a.z * a.z + b.z * b.z + c.z * c.z);
    sum[7] += v / 20 * (s.x * s.y + a.x * a.y + b.x * b.y + c.x * c.y);
    sum[8] += v / 20 * (s.y * s.z + a.y * a.z + b.y * b.z + c.y * c.z);
    sum[9] += v / 20 * (s.z * s.x + a.z * a.x + b.z * b.x + c.z * c.x);
  }
  for (int i = 0; i < 10; i++) terms[i] = sum[i];
}

static int by_number(const void *a, const void *b) {
  uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

// Sorts the few uses of edges with the same lower vertex.
static void sort_uses(uint32_t *use, size_t n) {
  enum { INSERTION_LIMIT = 24 };
  if (n > INSERTION_LIMIT) {
    qsort(use, n, sizeof *use, by_number);
    return;
  }
  for (size_t i = 1; i < n; i++) {
    uint32_t moving = use[i];
    size_t j = i;
    for (; j > 0 && use[j - 1] > moving; j--) use[j] = use[j - 1];
    use[j] = moving;
  }
}

// Uses of edges as higher vertex * 2 + (1: it runs from the lower one), grouped by lower vertex
// from start[lower] on. This takes a quarter of the memory of cag_mesh_edges, for checking meshes
// of millions of triangles while they are written.
typedef struct Uses {
  size_t *start;
  uint32_t *use;
} Uses;

static bool collect_uses(const CagMesh *m, Uses *out) {
  size_t *start = cag_calloc(m->vertex_count + 2, sizeof *start);
  uint32_t *use = cag_malloc((m->triangle_count * 3 + 1) * sizeof *use);
  *out = (Uses){start, use};
  if (!start || !use) return false;
  // Two passes over the triangles: count the edges of each lower vertex, then store them.
  for (int pass = 0; pass < 2; pass++) {
    for (size_t t = 0; t < m->triangle_count; t++)
      for (size_t k = 0; k < 3; k++) {
        uint32_t a = m->triangles[3 * t + k], b = m->triangles[3 * t + (k + 1) % 3];
        if (m->weld) a = m->weld[a], b = m->weld[b];
        if (a == b) continue;
        uint32_t low = a < b ? a : b, high = a < b ? b : a;
        if (pass == 0) start[low + 2]++;
        else use[start[low + 1]++] = high << 1 | (a < b);
      }
    if (pass == 0)
      for (size_t v = 2; v < m->vertex_count + 2; v++) start[v] += start[v - 1];
  }
  for (size_t v = 0; v < m->vertex_count; v++) sort_uses(use + start[v], start[v + 1] - start[v]);
  return true;
}

CagStatus cag_mesh_watertight(const CagMesh *m, bool *watertight, CagVec3 edge[2], CagError *err) {
  CagVec3 none = {0, 0, 0};
  if (edge) edge[0] = edge[1] = none;
  *watertight = false;
  if (m->triangle_count == 0 || m->vertex_count > UINT32_MAX / 2) return CAG_OK;
  Uses uses;
  bool closed = collect_uses(m, &uses);
  const CagStatus status = closed ? CAG_OK : cag_fail_memory(err);
  for (size_t v = 0; closed && v < m->vertex_count; v++)
    for (size_t k = uses.start[v]; k < uses.start[v + 1] && closed; k += 2) {
      const uint32_t *use = uses.use + k;
      // Exactly twice, once in each direction: 2 high and 2 high + 1, and no third.
      size_t left = uses.start[v + 1] - k;
      closed =
          left >= 2 && use[0] % 2 == 0 && use[1] == use[0] + 1 && (left == 2 || use[2] > use[1]);
      if (closed || !edge) continue;
      edge[0] = m->positions[v];
      edge[1] = m->positions[use[0] >> 1];
    }
  cag_free(uses.start);
  cag_free(uses.use);
  *watertight = closed;
  return status;
}

bool cag_mesh_is_watertight(const CagMesh *m, CagVec3 edge[2]) {
  CagError err;
  bool closed;
  cag_mesh_watertight(m, &closed, edge, &err);
  return closed;
}

// The number of uses of the edge whose uses begin at e[0].
static size_t uses_of(const CagMeshEdge *e, size_t left) {
  size_t n = 1;
  while (n < left && e[n].low == e[0].low && e[n].high == e[0].high) n++;
  return n;
}

long cag_mesh_euler_characteristic(const CagMesh *m) {
  size_t n;
  CagMeshEdge *edges =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  unsigned char *used = cag_calloc(m->vertex_count + 1, 1);
  long euler = 0;
  if (!edges || !used) cag_note_memory();
  if (edges && used) {
    for (size_t i = 0; i < n; i += uses_of(edges + i, n - i)) euler--;
    for (size_t t = 0; t < m->triangle_count; t++) {
      uint32_t k[3];
      for (int j = 0; j < 3; j++) {
        k[j] = m->triangles[3 * t + j];
        if (m->weld) k[j] = m->weld[k[j]];
        euler += !used[k[j]];
        used[k[j]] = 1;
      }
      euler += k[0] != k[1] && k[1] != k[2] && k[2] != k[0];
    }
  }
  cag_free(edges);
  cag_free(used);
  return euler;
}
