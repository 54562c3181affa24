// Lists of polylines for hosts that draw them.

#ifndef CAG_INTERP_SESSION_POLYLINES_H
#define CAG_INTERP_SESSION_POLYLINES_H

#include "geom/curve/curve.h"

// The points of several lines, one after the other. {0} is empty.
typedef struct CagPolylines {
  float *points;
  size_t point_count, point_capacity; // in numbers, 3 per point
  uint32_t *sizes;                    // points of each line
  size_t count, capacity;
} CagPolylines;

void cag_polylines_free(CagPolylines *l);
// Begins another line, to which points are then added.
CagStatus cag_polylines_begin(CagPolylines *l, CagError *err);
CagStatus cag_polylines_add(CagPolylines *l, CagVec3 p, CagError *err);
// Adds the image of a curve under a map as a line. The line stays so close to it that this cannot
// be seen where the curve fills the screen.
CagStatus cag_polylines_curve(CagPolylines *l, const CagCurve *c, const CagTransform *map,
                              CagError *err);

#endif
