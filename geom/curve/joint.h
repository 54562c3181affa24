// How smoothly one curve goes on where another ends.

#ifndef CAG_GEOM_JOINT_H
#define CAG_GEOM_JOINT_H

#include "geom/curve/curve.h"

// Flags hold to `tolerance`, relative to the sizes of what is compared: C by the parameters as
// they are, G after a change of parameter. G1: same unit tangent; G2: same curvature vector too.
typedef struct CagJoint {
  bool c0, c1, c2, g1, g2;
  double gap;            // distance of the points
  double angle;          // between the tangents, radians; NAN where a curve has none
  double ratio;          // tangent length of b over that of a; NAN where a's is 0
  double first_jump;     // |B' - A'|
  double second_jump;    // |B'' - A''|
  double curvature_jump; // |difference of the curvature vectors|; NAN where a speed is 0
} CagJoint;

// The end of a against the start of b.
CagStatus cag_curve_joint(const CagCurve *a, const CagCurve *b, double tolerance, CagJoint *out,
                          CagError *err);
// "none" "C0" "G1" "C1" "G2" "C2", the strongest that holds.
const char *cag_joint_class(const CagJoint *j);

#endif
