// Solids bounded by a quadric and exact flat faces.

#ifndef CAG_GEOM_MEET_QUADRIC_BODY_H
#define CAG_GEOM_MEET_QUADRIC_BODY_H

#include "geom/solid/csg.h"

// Whether the surfaces are pieces of one quadric that bound a solid together with flat faces:
// either all pieces left by a box or a range of z, or patches cut perpendicular to the axis.
bool cag_solid_has_quadric_body(CagSurface *const *pieces, size_t n);
// Makes this solid: the part within the box or range on the side of the quadric that contains its
// axis. For a hyperbolic paraboloid it is the side on which its original form is negative. The
// solid is an intersection, and also has exact faces unless rounding hides the order in which the
// quadric crosses the sides of the box.
CagStatus cag_solid_quadric_body(CagSurface *const *pieces, size_t n, const volatile int *interrupt,
                                 CagSolid **out, CagError *err);

#endif
