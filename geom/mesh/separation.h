// How far two shapes are apart, and whether a point is within a closed mesh.

#ifndef CAG_GEOM_MESH_SEPARATION_H
#define CAG_GEOM_MESH_SEPARATION_H

#include "geom/mesh/mesh.h"
#include "geom/surface/surface.h"

// Small parts of a shape: points, chords of curves, triangles of exact surfaces, flat triangles.
typedef struct CagPart {
  CagVec3 p[3];              // corners; fewer are repeated
  const CagCurve *curve;     // borrowed; the part over [low[0], high[0]]
  const CagSurface *surface; // borrowed
  bool flat;                 // the triangle itself
  double at[2];              // parameters within the part
  double low[2], high[2];    // where the search may go: the smooth piece around
  bool ring[2];              // may go around: a closed direction without breaks
  double sag;                // how far the exact shape may leave its chord or triangle
} CagPart;

typedef struct CagParts {
  CagPart *items;
  size_t n, capacity;
} CagParts;

CagStatus cag_parts_add_point(CagParts *parts, CagVec3 p, CagError *err);
CagStatus cag_parts_add_curve(CagParts *parts, const CagCurve *c, double tolerance, CagError *err);
// The mesh of a surface, which has its parameters, to the tolerance; surface NULL: the mesh is the
// shape.
CagStatus cag_parts_add_mesh(CagParts *parts, const CagMesh *m, const CagSurface *surface,
                             double tolerance, CagError *err);
void cag_parts_free(CagParts *parts);

// The least distance of two sets of parts; 0 where they meet. Parts are compared by their chords
// and flat triangles, and then on the exact shapes (Newton's method) all pairs that the sag of
// their parts allows to be nearer than the nearest one found, those with the lowest bounds first.
// Shapes that run along each other at one distance have that: it ends the search when thousands of
// pairs lead to it and none to another.
//
//   most       pairs to compare on the exact shapes
//   point      of b, where they do not meet; may be NULL
//   interrupt  NULL, or: not 0 stops with CAG_E_CALLBACK
//
// Fails with "zero-area" where a set is empty, as that of a surface which is one point, and with
// "convergence" where more pairs than `most` may be the nearest and lead to different distances.
#define CAG_PARTS_PAIRS 100000
CagStatus cag_parts_distance(const CagParts *a, const CagParts *b, size_t most, double *out,
                             CagVec3 *point, const volatile int *interrupt, CagError *err);

// How often a closed mesh winds about p: 1 inside, 0 outside, fractions on the boundary only.
double cag_mesh_winding(const CagMesh *m, CagVec3 p);

#endif
