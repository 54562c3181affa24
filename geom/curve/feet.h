// All feet of perpendiculars from a point to a curve.

#ifndef CAG_GEOM_CURVE_FEET_H
#define CAG_GEOM_CURVE_FEET_H

#include "geom/curve/curve.h"

// What the distance from the point has at a foot.
typedef enum CagFootKind {
  CAG_FOOT_MINIMUM,
  CAG_FOOT_MAXIMUM,
  CAG_FOOT_SADDLE,    // of surfaces: a minimum in one direction, a maximum in another
  CAG_FOOT_INFLECTION // of curves: it grows on one side, and shrinks on the other
} CagFootKind;

typedef struct CagFoot {
  double at[2]; // t, or u and v
  CagVec3 point;
  double distance;
  CagFootKind kind;
} CagFoot;

// The points of the curve at which the line to p is perpendicular to it, ascending by t; *out is
// malloc'd. Ends and corners count only if they are perpendicular to one side. Feet that are closer
// than 1e-7 of a smooth piece are one. Fails with "not-unique" if all points of a piece are feet.
CagStatus cag_curve_feet(const CagCurve *c, CagVec3 p, CagFoot **out, size_t *n, CagError *err);

#endif
