// The distance of two shapes, and whether a point is inside a closed mesh.

#ifndef CAG_GEOM_DISTANCE_SEPARATION_H
#define CAG_GEOM_DISTANCE_SEPARATION_H

#include "geom/mesh/mesh.h"
#include "geom/surface/core.h"
#include "geom/surface/surface.h"

// Small parts of a shape: points, chords of curves, triangles of exact surfaces, flat triangles.
typedef struct CagPart {
  CagVec3 p[3];              // corners; the last is repeated if there are fewer
  const CagCurve *curve;     // borrowed; the part over [low[0], high[0]]
  const CagSurface *surface; // borrowed
  bool flat;                 // the triangle itself
  double at[2];              // parameters of a point in the part
  double low[2], high[2];    // range of the search: the smooth piece around the part
  bool ring[2];              // the search may wrap around: a closed direction without breaks
  double sag;                // maximum distance of the exact shape from its chord or triangle
  size_t core;               // index of its core plus one; 0: none
} CagPart;

typedef struct CagParts {
  CagPart *items;
  size_t n, capacity;
  CagCore *cores;
  size_t core_count;
  struct CagPartTree *tree; // made by the first search, and used by others
} CagParts;

CagStatus cag_parts_add_point(CagParts *parts, CagVec3 p, CagError *err);
// A flat triangle.
CagStatus cag_parts_add_triangle(CagParts *parts, const CagVec3 corners[3], CagError *err);
CagStatus cag_parts_add_curve(CagParts *parts, const CagCurve *c, double tolerance, CagError *err);
// The mesh of a surface, with its parameters, to the tolerance; if surface is NULL, the mesh is the
// shape itself.
CagStatus cag_parts_add_mesh(CagParts *parts, const CagMesh *m, const CagSurface *surface,
                             double tolerance, CagError *err);
void cag_parts_free(CagParts *parts);

// Computes the minimum distance of two sets of parts, or 0 if they meet. Chords and flat triangles
// are compared first. Then the exact shapes are compared by Newton's method, for every pair that
// may be closer than the best one given the sag of its parts, in the order of the lower bounds. The
// cores of spheres, cylinders, circles and straight parts have bounds that are exact: shapes that
// run along each other at a constant distance, such as concentric spheres, need few pairs. For
// other shapes at a constant distance the search ends when thousands of pairs lead to that distance
// and no others.
//
//   most       maximum number of pairs to compare on the exact shapes
//   points     the closest points of a and b, which coincide within rounding if the shapes meet; may be
//              NULL
//   interrupt  may be NULL; a value other than 0 stops with CAG_E_CALLBACK
//
// Fails with "zero-area" if a set is empty, such as the set of a surface that is a single point,
// and with "convergence" if more than `most` pairs may be the closest and lead to different
// distances.
#define CAG_PARTS_PAIRS 100000
CagStatus cag_parts_distance(CagParts *a, CagParts *b, size_t most, double *out, CagVec3 points[2],
                             const volatile int *interrupt, CagError *err);

// Locations at which two sets of parts are nearly as close as at the closest pair of points.
#define CAG_PARTS_NEAR 4
typedef struct CagPartsNear {
  double margin; // given: distances up to this above the least one are wanted
  double apart;  // given: locations closer than this on both sets are one
  size_t n;
  double distance[CAG_PARTS_NEAR]; // ascending
  CagVec3 points[CAG_PARTS_NEAR][2];
} CagPartsNear;

// Like cag_parts_distance, and finds up to CAG_PARTS_NEAR such locations, those with the least
// distances. If thousands of pairs are within the margin, some may be missing. If the sets meet, one
// location where they do is found.
CagStatus cag_parts_near(CagParts *a, CagParts *b, size_t most, double *out, CagPartsNear *near,
                         const volatile int *interrupt, CagError *err);

// The winding number of a closed mesh about p: 1 inside, 0 outside, fractions only on the boundary.
double cag_mesh_winding(const CagMesh *m, CagVec3 p);

#endif
