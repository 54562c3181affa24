// What a quadric's equation tells about its points, and its plane sections as conics.

#ifndef CAG_GEOM_SURFACE_QUADRIC_EQUATION_H
#define CAG_GEOM_SURFACE_QUADRIC_EQUATION_H

#include "geom/curve/conic.h"
#include "geom/surface/quadric.h"

CagVec3 cag_quadric_gradient(const CagQuadric *q, CagVec3 p);
// The one center; fails with "quadric-not-central" where there is none, or a line or plane of them.
CagStatus cag_quadric_center(const CagQuadric *q, CagVec3 *out, CagError *err);
// Fails with "point-not-on-surface" and, where the gradient vanishes, "singular-point".
CagStatus cag_quadric_tangent_plane(const CagQuadric *q, CagVec3 p, CagPlane *out, CagError *err);
// Straight lines of the surface through one of its points: unit directions. `all`: every direction
// of the tangent plane is one. Fails as the tangent plane does.
typedef struct CagRulings {
  size_t count;
  bool all;
  CagVec3 direction[2];
} CagRulings;
CagStatus cag_quadric_rulings(const CagQuadric *q, CagVec3 p, CagRulings *out, CagError *err);
// The conic in the plane through the frame's origin along its x and y axes, in these coordinates.
void cag_quadric_section(const CagQuadric *q, const CagTransform *frame, CagConic *out);
// A right-handed frame of the plane: its point, and x as near to the world's X (or Y) as may be.
CagTransform cag_plane_frame(const CagPlane *plane);

#endif
