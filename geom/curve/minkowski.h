// Minkowski sums of regions: all sums of a point of one region and a point of the other.

#ifndef CAG_GEOM_MINKOWSKI_H
#define CAG_GEOM_MINKOWSKI_H

#include "geom/curve/region.h"

// Sums of segments and circular arcs are exact. Other curves are replaced by arcs within the
// tolerance. The sum with the empty region is empty. Fails like the set operations.
CagStatus cag_region_minkowski(const CagRegion *a, const CagRegion *b, double tolerance,
                               CagRegion **out, CagError *err);

#endif
