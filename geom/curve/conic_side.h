// The part of a rectangle in which the equation of a conic is negative.

#ifndef CAG_GEOM_CONIC_SIDE_H
#define CAG_GEOM_CONIC_SIDE_H

#include "geom/curve/conic.h"
#include "geom/curve/region.h"

// A conic intersects the four sides in at most 8 points.
#define CAG_CONIC_PARTS 4

// The part of the rectangle in which the conic's equation is negative, as *n regions without common
// edges. They are bounded by pieces of the rectangle's sides and by exact arcs of the conic. The
// rectangle is given by x and y of its bounds. Parts thinner than 1e-10 of the rectangle are
// omitted. *decided is false if rounding hides the order in which the conic crosses the sides.
CagStatus cag_conic_negative_parts(const CagConic *conic, const CagBounds *rectangle,
                                   CagRegion *out[CAG_CONIC_PARTS], size_t *n, bool *decided,
                                   CagError *err);

// The arc between two points of a conic on which the tangent turns by less than a right angle: a
// rational quadratic Bezier curve in the plane, or a line if the arc is straight to rounding.
CagStatus cag_conic_short_arc(const CagConic *conic, CagVec3 p, CagVec3 q, CagCurve **out,
                              CagError *err);
// Projects a point near the conic onto it.
CagVec3 cag_conic_onto(const CagConic *conic, CagVec3 p);
// A normal of the conic at p: the gradient of its equation.
CagVec3 cag_conic_gradient(const CagConic *conic, CagVec3 p);

#endif
