// Tessellation of surfaces, and of faces that share edges, to a chord tolerance.

#ifndef CAG_GEOM_TESSELLATE_TESSELLATE_H
#define CAG_GEOM_TESSELLATE_TESSELLATE_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

typedef struct CagTessellation {
  double tolerance; // mm: maximum distance between surface and mesh; <= 0: by the size (1/1000 of
                    // the diagonal of the bounds)
  double angle;     // radians: maximum turn of the normal along an edge that is not short
  double max_edge;  // mm; <= 0: unlimited
  size_t max_triangles;          // checked before memory is allocated; CAG_E_LIMIT "triangle-limit"
  const volatile int *interrupt; // nonzero stops with CAG_E_CALLBACK; may be NULL
  double short_edge;             // multiple of the tolerance: along edges up to this length the
                                 // normal may turn farther; <= 0: a fifth
} CagTessellation;

#define CAG_TESSELLATION_DEFAULT                                                                   \
  ((CagTessellation){0, 15 * 3.14159265358979323846 / 180, 0, 100000000, 0, 0})

// The distance from surface to mesh is at most the tolerance. Seams and poles share vertices. Grids
// are chosen per smooth cell (between breaks), so that triangles concentrate where the curvature is
// high; neighbors along a cell edge have the same points. Normals are those of the surface; uv are
// its parameters.
CagStatus cag_surface_tessellate(const CagSurface *s, const CagTessellation *how, CagMesh **out,
                                 CagError *err);

// An edge shared by two faces: the face's side (0: u0, 1: u1, 2: v0, 3: v1) or, for a planar face,
// the index of its loop plus 4.
typedef struct CagFaceEdge {
  size_t face[2];
  int side[2];
  bool reversed; // the second runs in the opposite direction
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
