// Strokes of plane curves.

#ifndef CAG_GEOM_REGION_STROKE_H
#define CAG_GEOM_REGION_STROKE_H

#include "geom/curve/joins.h"
#include "geom/curve/region.h"

typedef struct CagStroke {
  double width;
  double tolerance; // of the sides of curves other than lines and circles
  CagCap cap;
  CagJoins joins;
} CagStroke;

// The points on normals of the curves up to half of the width, and the joins of their corners and
// the caps of their ends. A closed curve has no ends. A curve that is a single point has round and
// square caps, a square along the axes.
CagStatus cag_region_stroke(const CagCurve *const *curves, size_t count, const CagStroke *stroke,
                            CagRegion **out, CagError *err);

#endif
