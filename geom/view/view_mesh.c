// The lines of meshes: see view_lines.h.

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"
#include "geom/view/view_lines.h"

// cos 30 degrees.
#define CREASE 0.86602540378443865
// A triangle is parallel to the direction if its unit normal has at most this part along it.
#define UPRIGHT 1e-9

static CagVec3 triangle_normal(const CagMesh *m, size_t t) {
  const uint32_t *corner = m->triangles + 3 * t;
  const CagVec3 a = m->positions[corner[0]];
  return cag_unit(
      cag_cross(cag_sub(m->positions[corner[1]], a), cag_sub(m->positions[corner[2]], a)));
}

// Whether the edge with these n uses is shown.
static bool is_shown(const CagViewLines *l, const CagMesh *m, const CagMeshEdge *uses, size_t n) {
  if (n != 2) return true;
  const CagVec3 a = triangle_normal(m, cag_mesh_edge_triangle(&uses[0])),
                b = triangle_normal(m, cag_mesh_edge_triangle(&uses[1]));
  if (cag_norm(a) == 0 || cag_norm(b) == 0) return false;
  return cag_dot(a, b) < CREASE ||
         (cag_dot(a, l->direction) > UPRIGHT) != (cag_dot(b, l->direction) > UPRIGHT);
}

CagStatus cag_view_lines_of_mesh(CagViewLines *l, const CagMesh *m, size_t index, CagError *err) {
  size_t n = 0;
  CagMeshEdge *edges =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &n);
  CagStatus status = edges ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0, end; !status && i < n; i = end) {
    for (end = i + 1;
         end < n && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
      end++;
    CagCurve *line = NULL;
    if (!is_shown(l, m, edges + i, end - i)) continue;
    status = cag_curve_line(m->positions[edges[i].low], m->positions[edges[i].high], 3, &line, err);
    if (!status) status = cag_view_lines_add(l, line, NULL, index, err);
    if (!status) status = cag_stop_check(err);
  }
  cag_free(edges);
  return status;
}
