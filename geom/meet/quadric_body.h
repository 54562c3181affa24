// Bodies within a quadric, closed by exact flat faces.

#ifndef CAG_GEOM_MEET_QUADRIC_BODY_H
#define CAG_GEOM_MEET_QUADRIC_BODY_H

#include "geom/solid/csg.h"

// Tests whether the surfaces are pieces of one quadric that bound a body with flat faces: all those
// that a box or a range of z left, or patches cut perpendicular to the axis.
bool cag_solid_has_quadric_body(CagSurface *const *pieces, size_t n);
// Makes this body: the part within the box or range on the side of the quadric that contains its
// axis. For a hyperbolic paraboloid, it is the side on which its original form is negative. The
// body is an intersection. It has exact faces too, unless rounding hides in which order the quadric
// passes the sides of the box.
CagStatus cag_solid_quadric_body(CagSurface *const *pieces, size_t n, const volatile int *interrupt,
                                 CagSolid **out, CagError *err);

#endif
