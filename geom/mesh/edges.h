// Edges of welded triangle meshes, found by sorting: the shared ground of the checks and of the
// Delaunay flips.

#ifndef CAG_GEOM_MESH_EDGES_H
#define CAG_GEOM_MESH_EDGES_H

#include "geom/mesh/mesh.h"

// One use of an edge by a triangle. low < high are welded vertices; `triangle` << 2 | corner is the
// corner at which the edge starts; forward: it runs from low to high.
typedef struct CagMeshEdge {
  uint32_t low, high;
  uint64_t place; // triangle * 8 + corner * 2 + (1: forward)
} CagMeshEdge;

static inline size_t cag_mesh_edge_triangle(const CagMeshEdge *e) { return e->place >> 3; }
static inline unsigned cag_mesh_edge_corner(const CagMeshEdge *e) { return e->place >> 1 & 3; }
static inline bool cag_mesh_edge_forward(const CagMeshEdge *e) { return e->place & 1; }

// All uses of edges, those of one edge side by side, in the order of (low, high, place): linear
// time. weld NULL: each vertex is its own. Uses with low == high are left out (*n counts the rest).
// NULL: no memory, or the work is to end.
CagMeshEdge *cag_mesh_edges(const uint32_t *triangles, size_t triangle_count, const uint32_t *weld,
                            size_t vertex_count, size_t *n);

#endif
