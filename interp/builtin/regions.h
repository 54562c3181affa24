// Declarations shared by the built-ins on regions.

#ifndef CAG_INTERP_BUILTIN_REGIONS_H
#define CAG_INTERP_BUILTIN_REGIONS_H

#include "geom/curve/region.h"
#include "interp/builtin/shapes.h"

// Reads the first two arguments as operands of set operations: regions, closed plane curves, and
// lists or groups of these, in a common plane. The array *out is held.
bool cag_regions_read_pair(CagCall *call, CagRegion ***out, CagTransform *plane);

#endif
