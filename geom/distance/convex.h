// The distances of convex bodies and tori, from their exact shapes.

#ifndef CAG_GEOM_DISTANCE_CONVEX_H
#define CAG_GEOM_DISTANCE_CONVEX_H

#include <stdbool.h>
#include <stddef.h>

#include "geom/linalg/vec.h"

typedef enum CagConvexKind {
  CAG_CONVEX_HULL,      // the convex hull of points
  CAG_CONVEX_ELLIPSOID, // center + x, y, z times a point of the unit ball
  CAG_CONVEX_FRUSTUM,   // the hull of two disks: center and center + z, x and y times their radii
  CAG_CONVEX_RING       // a circle with radius vectors x and y, which is not convex
} CagConvexKind;

// A body: all points within `round` of its kind. A ball is a rounded point, a torus a rounded ring.
typedef struct CagConvex {
  CagConvexKind kind;
  const CagVec3 *points; // HULL, borrowed
  size_t count;
  CagVec3 center, x, y, z;
  double radius[2]; // FRUSTUM: at the center, and at center + z
  double round;
} CagConvex;

CagBounds cag_convex_bounds(const CagConvex *c);
// A point of the body.
CagVec3 cag_convex_point(const CagConvex *c);

// Computes the distance of two bodies, or 0 if they meet or are closer than rounding permits to
// tell. Convex bodies are compared by their support functions (Gilbert, Johnson, Keerthi 1988),
// which bound the distance from below, rings by subdivision with such bounds. If the distance is at
// least `most`, a lower bound that is at least `most` may be returned instead.
//
// The result is off by at most 1e-10 of the size of the bodies and their distance. Returns false if
// that was not reached. Rings to whose points the other body is almost equally near, as for coaxial
// ones, have no such proof: these are sampled, and the nearest samples refined. points: points of a
// and b with about this distance, unless it is only a lower bound. They coincide if the bodies meet.
// NULL: not wanted.
bool cag_convex_distance(const CagConvex *a, const CagConvex *b, double most, double *out,
                         CagVec3 points[2]);

#endif
