// The continuity between the end of one curve and the start of another.

#ifndef CAG_GEOM_JOINT_H
#define CAG_GEOM_JOINT_H

#include "geom/curve/curve.h"

// Flags hold to `tolerance`, relative to the sizes of the compared quantities: C for the parameters
// as they are, G after a change of parameter. G1: same unit tangent; G2: also the same curvature
// vector.
typedef struct CagJoint {
  bool c0, c1, c2, g1, g2;
  double gap;            // distance of the points
  double angle;          // between the tangents, radians; NAN if a curve has none
  double ratio;          // tangent length of b over that of a; NAN if a's is 0
  double first_jump;     // |B' - A'|
  double second_jump;    // |B'' - A''|
  double curvature_jump; // |difference of the curvature vectors|; NAN if a speed is 0
} CagJoint;

// Compares the end of a with the start of b.
CagStatus cag_curve_joint(const CagCurve *a, const CagCurve *b, double tolerance, CagJoint *out,
                          CagError *err);
// "none" "C0" "G1" "C1" "G2" "C2", the strongest that holds.
const char *cag_joint_class(const CagJoint *j);

#endif
