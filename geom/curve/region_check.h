// Checks that loops can bound a region: they must not cross, nor overlap where they touch.

#ifndef CAG_GEOM_REGION_CHECK_H
#define CAG_GEOM_REGION_CHECK_H

#include "geom/curve/curve.h"

// Whether the curve is a closed plane curve: "not-planar", "region-not-closed", with the index.
// Messages name it as argument[index], or as the outer boundary if the index is negative.
CagStatus cag_region_check_closed(const CagCurve *c, const char *argument, long index,
                                  CagError *err);
// For an outer boundary and holes (reversed to clockwise): "region-crossing", "hole-outside", with
// the index of the hole.
CagStatus cag_region_check_holes(CagCurve *const *loops, size_t n, CagError *err);
// For loops that may be nested in any way: "region-crossing", with the index of the loop.
CagStatus cag_region_check_loops(CagCurve *const *loops, size_t n, CagError *err);

#endif
