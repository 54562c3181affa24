// Tangent circles, tangent lines, fillets, and rounded corners.
//
// Everything lies in the plane (z = 0) except rounded polylines, which may lie in space.

#ifndef CAG_GEOM_CIRCLES_H
#define CAG_GEOM_CIRCLES_H

#include "geom/curve/curve.h"

// An object that a circle touches: the infinite line through p along d, a circle (radius > 0) about
// p, or, where this is allowed, the point p (d and the radius are 0).
typedef struct CagTouched {
  CagVec3 p, d;
  double radius; // 0: a line
} CagTouched;

typedef struct CagTouchChoice {
  bool right;     // side of the first line, along its direction; for two circles: side of the
                  // direction from a to b
  bool near;      // two lines: the side of the second that the first comes from; line and circle:
                  // the earlier of the two solutions along the line
  bool inside[2]; // for the circles a, b: one circle lies inside the other
} CagTouchChoice;

// The center of the circle with that radius, and the points of contact. Fails with
// "parallel-lines", "radius-not-positive", "no-tangent-circle".
CagStatus cag_tangent_circle(const CagTouched *a, const CagTouched *b, double radius,
                             CagTouchChoice choice, CagVec3 *center, CagVec3 touch[2],
                             CagError *err);

// The circles that are tangent to three circles, lines, or points, ascending by radius, then by x
// and y of the center. Tangent lines and the three circles themselves are left out, and circles that
// count several times are listed once. There may be none. Fails with "infinitely-many" if two of the
// three are equal, or all three touch at one point.
#define CAG_TANGENT_CIRCLES 8
typedef struct CagTangentCircle {
  CagVec3 center;
  double radius;
} CagTangentCircle;
CagStatus cag_circles_tangent(const CagTouched touched[3],
                              CagTangentCircle out[CAG_TANGENT_CIRCLES], size_t *n, CagError *err);

typedef struct CagTangentLine {
  double t, t2; // parameters of the points of contact; t2: on the second curve
  CagVec3 p, q; // the point of contact with c; the given point, or the point of contact with the
                // second curve
} CagTangentLine;

// The lines through p that are tangent to the plane curve, ascending by t. *out is malloc'd.
CagStatus cag_tangents_from_point(const CagCurve *c, CagVec3 p, CagTangentLine **out, size_t *n,
                                  CagError *err);
// The lines that are tangent to both plane curves, ascending by t.
CagStatus cag_tangents_of_two(const CagCurve *a, const CagCurve *b, CagTangentLine **out, size_t *n,
                              CagError *err);

// The arc of that radius that leads from a to b, tangent to both, in the corner where a meets b:
// the end of a if it is the start of b, else the intersection nearest to the end of a. t, t2:
// parameters at which it leaves a and enters b. Fails with "curves-do-not-meet",
// "radius-too-large", "no-corner".
CagStatus cag_fillet(const CagCurve *a, const CagCurve *b, double radius, CagCurve **out, double *t,
                     double *t2, CagError *err);

// The curve with its corners replaced by arcs. Polylines may lie in space. Fails with
// "radius-too-large" and the corner's index.
CagStatus cag_curve_rounded(const CagCurve *c, double radius, CagCurve **out, CagError *err);

#endif
