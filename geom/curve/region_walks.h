// Lists of curves for an arrangement, which they own.

#ifndef CAG_GEOM_REGION_WALKS_H
#define CAG_GEOM_REGION_WALKS_H

#include "geom/curve/region_arrange.h"

typedef struct CagWalks {
  CagWalk *items; // all of operand 0, in no group
  CagCurve **curves;
  size_t n, capacity;
} CagWalks;

void cag_walks_free(CagWalks *w);
// Takes ownership of the curve, even if it fails. sign: 1, or -1 to count it as if reversed.
CagStatus cag_walks_put(CagWalks *w, CagCurve *c, int sign, CagError *err);
// A segment; nothing if its ends are equal.
CagStatus cag_walks_put_line(CagWalks *w, CagVec3 p, CagVec3 q, int sign, CagError *err);
// The arc about the center from one point to the other, counter-clockwise or clockwise.
CagStatus cag_walks_put_arc(CagWalks *w, CagVec3 center, CagVec3 from, CagVec3 to, bool clockwise,
                            int sign, CagError *err);

#endif
