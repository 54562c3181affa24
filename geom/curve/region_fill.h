// Regions of outlines that may cross or touch themselves and each other.

#ifndef CAG_GEOM_REGION_FILL_H
#define CAG_GEOM_REGION_FILL_H

#include "geom/curve/region.h"

// Which points belong to the region, by the number of times that the outlines run around them
// counter-clockwise, minus the number of times that they run around them clockwise.
typedef enum CagFill {
  CAG_FILL_EVEN_ODD, // the number is odd
  CAG_FILL_NONZERO,  // the number is not 0
  CAG_FILL_POSITIVE  // the number is greater than 0
} CagFill;

// The region of the points that closed plane curves run around, with a boundary made like that of
// set operations. Outlines without an inside add nothing; the result may be the empty region. Fails
// with "not-planar", "region-not-closed", and the index, and with "region-undecided".
CagStatus cag_region_fill(const CagCurve *const *loops, size_t count, CagFill fill, CagRegion **out,
                          CagError *err);

#endif
