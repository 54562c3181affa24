// Tessellation of surfaces, and of faces that share edges, to a chord tolerance.

#ifndef CAG_GEOM_TESSELLATE_TESSELLATE_H
#define CAG_GEOM_TESSELLATE_TESSELLATE_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

typedef struct CagTessellation {
  double tolerance; // mm: largest distance between surface and mesh; <= 0: by the size (1/1000 of
                    // the diagonal of the bounds)
  double angle;     // radians: most that the normal turns along one edge; what turns within a fifth
                    // of the tolerance is free
  double max_edge;  // mm; <= 0: none
  size_t max_triangles;          // CAG_E_LIMIT "triangle-limit" before memory is taken
  const volatile int *interrupt; // not NULL and not 0: stops with CAG_E_CALLBACK
} CagTessellation;

#define CAG_TESSELLATION_DEFAULT                                                                   \
  ((CagTessellation){0, 15 * 3.14159265358979323846 / 180, 0, 100000000, 0})

// The distance from surface to mesh is at most the tolerance; seams and poles share vertices; grids
// are chosen per smooth cell (between breaks) so that triangles go where curvature is; neighbors
// along a cell edge have the same points. Normals from the surface; uv are the parameters.
CagStatus cag_surface_tessellate(const CagSurface *s, const CagTessellation *how, CagMesh **out,
                                 CagError *err);

// An edge that two faces share: the face's side (0: u0, 1: u1, 2: v0, 3: v1) or, of a planar face,
// the number of its loop plus 4.
typedef struct CagFaceEdge {
  size_t face[2];
  int side[2];
  bool reversed; // the second runs against the first
} CagFaceEdge;
typedef struct CagFaces {
  CagSurface *const *items;
  size_t count;
  const CagFaceEdge *edges;
  size_t edge_count;
} CagFaces;
// All faces, with the same points on shared edges: watertight by construction if the faces close.
// `bounds` are those of all faces.
CagStatus cag_faces_tessellate(const CagFaces *faces, const CagBounds *bounds,
                               const CagTessellation *how, CagMesh **out, CagError *err);

#endif
