// The flat faces of a closed mesh, with the edges and vertices that they share.
//
// Neighboring triangles in one plane are one face, which may have holes. Triangles that are thinner
// than the slack have no plane of their own and are parts of their neighbors' faces. Where an edge
// belongs to more than two triangles, the two that bound the same wedge of the inside share it, so
// that bodies that touch along an edge remain separate shells.

#ifndef CAG_GEOM_MESH_FACETS_H
#define CAG_GEOM_MESH_FACETS_H

#include "geom/mesh/mesh.h"

typedef struct CagFacetEdge {
  size_t from, to; // vertices
} CagFacetEdge;

typedef struct CagFacetUse {
  size_t edge;
  bool reversed; // from `to` to `from`
} CagFacetUse;

typedef struct CagFacetLoop {
  size_t first, count; // uses, with the face on their left
} CagFacetLoop;

typedef struct CagFacet {
  CagVec3 origin, normal; // the plane; the normal points out of the body
  size_t first, count;    // loops, the outer one first
} CagFacet;

typedef struct CagFacetShell {
  size_t first, count; // faces
  size_t void_of;      // the shell in which this one is a cavity; its own index: none
  double volume;       // mm^3; negative: the normals point into the space that it encloses
} CagFacetShell;

typedef struct CagFacets {
  CagVec3 *vertices;
  CagFacetEdge *edges;
  CagFacetUse *uses;
  CagFacetLoop *loops;
  CagFacet *faces; // by shells
  CagFacetShell *shells;
  size_t vertex_count, edge_count, use_count, loop_count, face_count, shell_count;
  double flatness; // mm: the largest distance between a vertex and the plane of a face that has it
} CagFacets;

// Finds the faces of a mesh whose closed parts have outward normals (orient.h).
//
//   slack  mm: vertices up to this distance from a plane count as on it; 0: three vertices only
//
// Fails with "mesh-open" and the ends of an edge that does not have as many triangles on one side
// as on the other, and with "interrupted". Release with cag_facets_free.
CagStatus cag_mesh_facets(const CagMesh *m, double slack, CagFacets *out, CagError *err);
void cag_facets_free(CagFacets *f);

#endif
