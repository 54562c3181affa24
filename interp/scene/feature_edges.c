#include "interp/scene/feature_edges.h"

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/mesh/edges.h"

// The cosine of the least angle of a crease.
#define CREASE 0.94

typedef struct Use {
  uint32_t from, to; // vertices at the ends, in the order of low and high
  CagVec3 flat;      // normal of the triangle
} Use;

static CagVec3 flat_normal(const CagMesh *m, size_t triangle) {
  const uint32_t *t = m->triangles + 3 * triangle;
  const CagVec3 a = m->positions[t[0]];
  return cag_unit(cag_cross(cag_sub(m->positions[t[1]], a), cag_sub(m->positions[t[2]], a)));
}

static Use use_of(const CagMesh *m, const CagMeshEdge *e) {
  const size_t triangle = cag_mesh_edge_triangle(e);
  const unsigned corner = cag_mesh_edge_corner(e);
  const uint32_t *t = m->triangles + 3 * triangle;
  const uint32_t a = t[corner], b = t[(corner + 1) % 3];
  const bool forward = cag_mesh_edge_forward(e);
  return (Use){forward ? a : b, forward ? b : a, flat_normal(m, triangle)};
}

static bool normals_differ(CagVec3 a, CagVec3 b) { return cag_dot(a, b) < CREASE; }

// Vertices that both triangles have are shaded without a crease.
static bool is_creased(const CagMesh *m, const Use *p, const Use *q) {
  if (!m->normals) return normals_differ(p->flat, q->flat);
  if (p->from == q->from && p->to == q->to) return false;
  return normals_differ(m->normals[p->from], m->normals[q->from]) ||
         normals_differ(m->normals[p->to], m->normals[q->to]);
}

static bool is_feature(const CagMesh *m, const CagMeshEdge *uses, size_t n) {
  if (n != 2) return true;
  const Use p = use_of(m, &uses[0]), q = use_of(m, &uses[1]);
  return is_creased(m, &p, &q);
}

CagStatus cag_feature_edges(const CagMesh *m, uint32_t **out, size_t *n, CagError *err) {
  size_t uses, capacity = 0;
  uint32_t *edges = NULL;
  *out = NULL;
  *n = 0;
  CagMeshEdge *all =
      cag_mesh_edges(m->triangles, m->triangle_count, m->weld, m->vertex_count, &uses);
  if (!all) return cag_stop_check(err) ? err->status : cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0, end; !status && i < uses; i = end) {
    for (end = i + 1; end < uses && all[end].low == all[i].low && all[end].high == all[i].high;)
      end++;
    if (!is_feature(m, all + i, end - i)) continue;
    if (!CAG_RESERVE(edges, capacity, 2 * (*n + 1))) {
      status = cag_fail_memory(err);
      break;
    }
    const Use use = use_of(m, &all[i]);
    edges[2 * *n] = use.from;
    edges[2 * *n + 1] = use.to;
    ++*n;
  }
  cag_free(all);
  if (status) cag_free(edges);
  else *out = edges;
  return status;
}
