// How two regions lie to each other, and a point inside of one.

#ifndef CAG_GEOM_REGION_RELATION_H
#define CAG_GEOM_REGION_RELATION_H

#include "geom/curve/region.h"

typedef enum CagRegionRelation {
  CAG_REGION_DISJOINT, // no common points
  CAG_REGION_TOUCHES,  // common points of the boundaries only
  CAG_REGION_OVERLAPS, // common inner points, and each has points outside of the other
  CAG_REGION_WITHIN,   // the first lies in the second, which has more points
  CAG_REGION_CONTAINS, // the second lies in the first, which has more points
  CAG_REGION_EQUALS
} CagRegionRelation;

// The relation of regions (OGC 06-103r4, section 6.1.15, for polygons). Points within 1e-9 of the
// total size coincide, so parts thinner than that do not count. The empty region is disjoint from
// all regions, and from itself.
CagStatus cag_region_relation(const CagRegion *a, const CagRegion *b, CagRegionRelation *out,
                              CagError *err);

// A point inside the region, away from its boundary. Fails with "empty-shape".
CagStatus cag_region_interior_point(const CagRegion *r, CagVec3 *out, CagError *err);

#endif
