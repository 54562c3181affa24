// Whether loops may bound a region: they must not cross, nor overlap where they touch.

#ifndef CAG_GEOM_REGION_CHECK_H
#define CAG_GEOM_REGION_CHECK_H

#include "geom/curve/curve.h"

// The outer boundary, and holes turned clockwise: "region-crossing", "hole-outside", with the
// number of the hole.
CagStatus cag_region_check_holes(CagCurve *const *loops, size_t n, CagError *err);
// Loops of which any may lie within others: "region-crossing", with the number of the curve.
CagStatus cag_region_check_loops(CagCurve *const *loops, size_t n, CagError *err);

#endif
