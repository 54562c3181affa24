// The union of many regions of which few overlap, such as the letters of a text.

#ifndef CAG_GEOM_REGION_UNITE_H
#define CAG_GEOM_REGION_UNITE_H

#include "geom/curve/region.h"

// The boundaries of regions that no other one touches stay as they are. Fails like
// cag_region_combine.
CagStatus cag_regions_unite_few(CagRegion *const *regions, size_t n, CagRegion **out,
                                CagError *err);

#endif
