// Points of a quadric given by its equation, and its plane sections as conics.

#ifndef CAG_GEOM_SURFACE_QUADRIC_EQUATION_H
#define CAG_GEOM_SURFACE_QUADRIC_EQUATION_H

#include "geom/curve/conic.h"
#include "geom/surface/quadric.h"

CagVec3 cag_quadric_gradient(const CagQuadric *q, CagVec3 p);
// The center. Fails with "quadric-not-central" if there is none, or a whole line or plane of
// centers.
CagStatus cag_quadric_center(const CagQuadric *q, CagVec3 *out, CagError *err);
// Fails with "point-not-on-surface", and with "singular-point" if the gradient vanishes.
CagStatus cag_quadric_tangent_plane(const CagQuadric *q, CagVec3 p, CagPlane *out, CagError *err);
// Unit directions of the straight lines on the surface through one of its points. `all`: every
// direction of the tangent plane is one. Fails like cag_quadric_tangent_plane.
typedef struct CagRulings {
  size_t count;
  bool all;
  CagVec3 direction[2];
} CagRulings;
CagStatus cag_quadric_rulings(const CagQuadric *q, CagVec3 p, CagRulings *out, CagError *err);
// The section with the plane through the frame's origin along its x and y axes, in these
// coordinates.
void cag_quadric_section(const CagQuadric *q, const CagTransform *frame, CagConic *out);
// A right-handed frame of the plane: its point, and x as close as possible to the world's X (or Y).
CagTransform cag_plane_frame(const CagPlane *plane);

#endif
