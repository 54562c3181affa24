// The side of a conic on which its equation is negative, within a rectangle.

#ifndef CAG_GEOM_CONIC_SIDE_H
#define CAG_GEOM_CONIC_SIDE_H

#include "geom/curve/conic.h"
#include "geom/curve/region.h"

// A conic meets the four sides in 8 points at most.
#define CAG_CONIC_PARTS 4

// The part of the rectangle in which the conic's equation is negative, as *n regions without common
// edges. They are bounded by pieces of the rectangle's sides and by exact arcs of the conic. The
// rectangle is given by x and y of its bounds. Parts that are thinner than 1e-10 of the rectangle
// are left out. *decided is false where rounding hides in which order the conic passes the sides.
CagStatus cag_conic_negative_parts(const CagConic *conic, const CagBounds *rectangle,
                                   CagRegion *out[CAG_CONIC_PARTS], size_t *n, bool *decided,
                                   CagError *err);

#endif
