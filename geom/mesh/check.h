// Checks whether a list of faces bounds a solid.

#ifndef CAG_GEOM_MESH_CHECK_H
#define CAG_GEOM_MESH_CHECK_H

#include "geom/mesh/mesh.h"

typedef struct CagMeshCheck {
  size_t vertices; // vertices used by faces
  size_t edges, faces;
  long euler;                  // vertices - edges + faces
  size_t shells;               // parts whose faces are connected over edges
  size_t boundary_edges;       // edges with one face
  size_t nonmanifold_edges;    // edges with three or more faces
  size_t nonmanifold_vertices; // vertices whose faces form several fans
  bool closed;                 // each edge has two faces
  bool oriented;               // no two faces run along an edge in the same direction
  bool solid;    // closed, oriented, without such vertices, and with a positive volume. Faces that
                 // pass through each other are not detected.
  long genus;    // number of handles of all shells, after separating them at shared vertices; if
                 // closed and oriented
  double volume; // negative if inside out; if closed and oriented
} CagMeshCheck;

// Polygonal faces, given by their counts and indices. Vertices are identified by index. Fails with
// "face-degenerate" (fewer than 3 corners, or a repeated vertex), "face-index",
// "vertex-not-finite".
CagStatus cag_faces_check(const CagVec3 *vertices, size_t n, const uint32_t *indices,
                          const uint32_t *counts, size_t faces, CagMeshCheck *out, CagError *err);
// Checks the welded mesh, without triangles that collapse to edges by welding.
CagStatus cag_mesh_check(const CagMesh *m, CagMeshCheck *out, CagError *err);

#endif
