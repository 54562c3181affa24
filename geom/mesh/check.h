// Is a list of faces the boundary of a solid? Counts for the answer.

#ifndef CAG_GEOM_MESH_CHECK_H
#define CAG_GEOM_MESH_CHECK_H

#include "geom/mesh/mesh.h"

typedef struct CagMeshCheck {
  size_t vertices; // those that faces name
  size_t edges, faces;
  long euler;                  // vertices - edges + faces
  size_t shells;               // parts whose faces are connected over edges
  size_t boundary_edges;       // of one face
  size_t nonmanifold_edges;    // of three or more
  size_t nonmanifold_vertices; // where the faces around are several fans
  bool closed;                 // each edge is of two faces
  bool oriented;               // no two faces run an edge in the same sense
  bool solid; // closed, oriented, no such vertices, and a volume above 0: corners and edges alone
              // do not tell whether faces pass through each other
  long genus; // handles of all shells, their touching vertices taken apart; if closed and oriented
  double volume; // negative: inside out; if closed and oriented
} CagMeshCheck;

// Faces as polygons, given by their counts and indices. Vertices are one where their numbers are.
// "face-degenerate" (fewer than 3 corners, or a vertex twice), "face-index", "vertex-not-finite".
CagStatus cag_faces_check(const CagVec3 *vertices, size_t n, const uint32_t *indices,
                          const uint32_t *counts, size_t faces, CagMeshCheck *out, CagError *err);
// Of the welded mesh; triangles that welding makes edges are left out.
CagStatus cag_mesh_check(const CagMesh *m, CagMeshCheck *out, CagError *err);

#endif
