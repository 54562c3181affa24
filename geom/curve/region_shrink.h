// Offsets of convex polygons to their inside, in linear time.

#ifndef CAG_GEOM_REGION_SHRINK_H
#define CAG_GEOM_REGION_SHRINK_H

#include "geom/curve/region.h"

// The points of a convex polygon at least the distance d > 0 from its boundary. size: of the
// region. *taken is false if the region is not a convex polygon. *out is NULL if nothing is left.
CagStatus cag_region_shrink_convex(const CagRegion *r, double d, double size, bool *taken,
                                   CagRegion **out, CagError *err);

#endif
