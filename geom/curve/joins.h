// Corners and ends of strokes and offsets.

#ifndef CAG_GEOM_JOINS_H
#define CAG_GEOM_JOINS_H

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

#endif
