// Edges of welded triangle meshes, found by sorting; used by the checks and by the Delaunay flips.

#ifndef CAG_GEOM_MESH_EDGES_H
#define CAG_GEOM_MESH_EDGES_H

#include "geom/mesh/mesh.h"

// One use of an edge by a triangle. low < high are welded vertices. The corner is the one at which
// the edge starts; forward: it runs from low to high.
typedef struct CagMeshEdge {
  uint32_t low, high;
  uint64_t place; // triangle * 8 + corner * 2 + (1: forward)
} CagMeshEdge;

static inline size_t cag_mesh_edge_triangle(const CagMeshEdge *e) { return e->place >> 3; }
static inline unsigned cag_mesh_edge_corner(const CagMeshEdge *e) { return e->place >> 1 & 3; }
static inline bool cag_mesh_edge_forward(const CagMeshEdge *e) { return e->place & 1; }

// All uses of edges, sorted by (low, high, place), so those of one edge are adjacent; linear time.
// weld NULL: vertices are not welded. Uses with low == high are left out (*n counts the rest).
// Returns NULL if memory ran out or the work was canceled.
CagMeshEdge *cag_mesh_edges(const uint32_t *triangles, size_t triangle_count, const uint32_t *weld,
                            size_t vertex_count, size_t *n);

#endif
