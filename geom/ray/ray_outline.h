// Whether points lie within a region, asked many times.

#ifndef CAG_GEOM_RAY_RAY_OUTLINE_H
#define CAG_GEOM_RAY_RAY_OUTLINE_H

#include <stdint.h>

#include "geom/curve/region_arrange.h"

// The loops as pieces that are monotone in x and y, found by the strip of y that a point is in.
typedef struct CagRayOutline {
  CagRegion *region; // retained
  CagWalk *walks;
  CagRegionPieces pieces;
  double low, high, scale; // range of y, and strips per unit of it
  size_t strip_count;
  size_t *strip;   // strip k has the numbers piece[strip[k]] to piece[strip[k + 1] - 1]
  uint32_t *piece; // of pieces
} CagRayOutline;

CagStatus cag_ray_outline_new(const CagRegion *r, CagRayOutline **out, CagError *err);
void cag_ray_outline_free(CagRayOutline *o); // o may be NULL
// Whether [x, y] is inside, or at most about `slack` away from the region. Exact but for the
// rounding of the curves: a horizontal line from the point crosses the outline an odd number of
// times.
bool cag_ray_outline_holds(const CagRayOutline *o, double x, double y, double slack);

#endif
