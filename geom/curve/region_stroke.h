// Strokes of plane curves, and the corners and ends of strokes and offsets.

#ifndef CAG_GEOM_REGION_STROKE_H
#define CAG_GEOM_REGION_STROKE_H

#include "geom/curve/region.h"

typedef enum CagJoin {
  CAG_JOIN_ROUND,  // an arc about the corner
  CAG_JOIN_MITER,  // both sides extended to their intersection
  CAG_JOIN_BEVEL,  // a segment between the ends of the sides
  CAG_JOIN_SQUARE, // a segment at the distance from the corner, perpendicular to the bisector
} CagJoin;

typedef struct CagJoins {
  CagJoin join;
  double
      miter_limit; // the tip of a miter that is farther from its corner, in distances, is squared
} CagJoins;

typedef enum CagCap {
  CAG_CAP_ROUND,  // a half disc
  CAG_CAP_BUTT,   // nothing
  CAG_CAP_SQUARE, // half a square
} CagCap;

typedef struct CagStroke {
  double width;
  double tolerance; // of the sides of curves other than lines and circles
  CagCap cap;
  CagJoins joins;
} CagStroke;

// cag_region_offset with other corners.
CagStatus cag_region_offset_joined(const CagRegion *r, double d, double tolerance,
                                   const CagJoins *joins, CagRegion **out, CagError *err);

// The points on normals of the curves up to half of the width, and the joins of their corners and
// the caps of their ends. A closed curve has no ends. A curve that bends with a radius below half
// of the width is round at the ends of that part, unless it is a circle. A curve that is a single
// point has round and square caps, a square along the axes.
CagStatus cag_region_stroke(const CagCurve *const *curves, size_t count, const CagStroke *stroke,
                            CagRegion **out, CagError *err);

#endif
