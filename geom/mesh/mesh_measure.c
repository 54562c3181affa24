// Measures and checks of triangle meshes: bounds, area, volume integrals, closedness, Euler
// characteristic.

#include <stdlib.h>

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

// Each triangle spans a signed tetrahedron with the origin. Over a tetrahedron of volume V with a
// corner in the origin and the others a, b, c: the integral of x is V/4 (ax + bx + cx), and of x y
// it is V/20 (sx sy + ax ay + bx by + cx cy) with s = a + b + c.
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

// Is the edge whose uses begin at e[0] used exactly twice, once in each sense? *uses: how often.
static bool edge_is_matched(const CagMeshEdge *e, size_t left, size_t *uses) {
  size_t n = 1;
  while (n < left && e[n].low == e[0].low && e[n].high == e[0].high) n++;
  *uses = n;
  return n == 2 && cag_mesh_edge_forward(&e[0]) != cag_mesh_edge_forward(&e[1]);
}

bool cag_mesh_is_watertight(const CagMesh *m, CagVec3 edge[2]) {
  CagVec3 none = {0, 0, 0};
  if (edge) edge[0] = edge[1] = none;
  if (m->triangle_count == 0) return false;
  size_t n, uses;
  CagMeshEdge *edges =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  if (!edges) return false;
  bool closed = true;
  for (size_t i = 0; i < n && closed; i += uses) {
    closed = edge_is_matched(edges + i, n - i, &uses);
    if (closed || !edge) continue;
    edge[0] = m->positions[edges[i].low];
    edge[1] = m->positions[edges[i].high];
  }
  free(edges);
  return closed;
}

long cag_mesh_euler_characteristic(const CagMesh *m) {
  size_t n, uses;
  CagMeshEdge *edges =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  unsigned char *used = calloc(m->vertex_count + 1, 1);
  long euler = 0;
  if (edges && used) {
    for (size_t i = 0; i < n; i += uses) {
      edge_is_matched(edges + i, n - i, &uses);
      euler--;
    }
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
  free(edges);
  free(used);
  return euler;
}
