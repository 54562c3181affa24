// Inverse kinematics in closed form: all joint values that bring the tool to a pose.
//
// Chains are recognized by their structure, regardless of how they are described (either
// convention, fixed links between the joints, base and tool):
//
//   a spherical wrist          the axes of joints 4, 5, and 6 intersect at a point; joints 1 to 3
//                              are revolute, in any arrangement, or two revolute and one prismatic
//   two intersecting axes      five joints; the axes of joints 4 and 5 intersect
//   axes 2, 3, and 4 parallel  six joints, or five; axes 5 and 6 are each perpendicular to the
//                              previous one
//   all axes parallel          at most three revolute joints, and a prismatic one
//   prismatic joints           two revolute joints and a prismatic one, one revolute joint and two
//                              prismatic ones, three prismatic ones
//
// Methods: D. L. Pieper, The Kinematics of Manipulators under Computer Control (1968), for arms
// with a wrist; R. P. Paul, Robot Manipulators (1981), for the elimination joint by joint.

#ifndef CAG_GEOM_ROBOT_INVERSE_H
#define CAG_GEOM_ROBOT_INVERSE_H

#include "geom/robot/robot.h"

#define CAG_INVERSE_JOINTS_MAX 6
#define CAG_INVERSE_SOLUTIONS_MAX 16

typedef enum CagInverseStatus {
  CAG_INVERSE_OK,
  CAG_INVERSE_UNREACHABLE,
  CAG_INVERSE_ORIENTATION, // the position is reachable, but not the orientation: fewer than six
                           // joints
  CAG_INVERSE_SINGULAR,    // some solutions belong to families: joints may turn against each other
  CAG_INVERSE_NO_CLOSED_FORM
} CagInverseStatus;

// The branch: +1 or -1, and 0 if a chain has no such choice or, at a singular pose, it makes no
// difference.
//   shoulder   the point positioned by the first three joints lies before or behind the first axis
//   elbow      sign of the sine of joint 3; for planar arms, of the second revolute joint; for arms
//              with a forearm along axis 4, of d4 cos - a3 sin
//   wrist      sign of the sine of joint 5
typedef struct CagConfiguration {
  int shoulder, elbow, wrist;
} CagConfiguration;

typedef struct CagInverseSolution {
  double q[CAG_INVERSE_JOINTS_MAX]; // angles in (-pi, pi]
  CagConfiguration configuration;
  unsigned free; // bit i: joint i is free in this solution's family and has its value from `near`
} CagInverseSolution;

typedef struct CagInverse {
  CagInverseStatus status;
  size_t count;
  CagInverseSolution solutions[CAG_INVERSE_SOLUTIONS_MAX];
  unsigned free; // of all solutions
} CagInverse;

bool cag_robot_has_inverse(const CagRobot *r);
// All solutions for a rigid target, including those that miss it by up to 1e-6 (of the reach, and
// radians), so that a rounded target has solutions if there are fewer than six joints. Joint limits
// are ignored. `near` (NULL: zeros) provides the values of free joints.
void cag_robot_inverse(const CagRobot *r, const CagTransform *target, const double *near,
                       CagInverse *out);
// The same for a point that the tool's origin must reach, in any orientation. Supports chains that
// reach a point in finitely many ways: planar chains with one or two revolute joints (and a
// prismatic one), and three revolute joints in any arrangement.
bool cag_robot_has_point_inverse(const CagRobot *r);
void cag_robot_inverse_point(const CagRobot *r, CagVec3 point, const double *near, CagInverse *out);
// The choices a chain has: 1 for each kind of branch that it distinguishes, 0 for the others.
CagConfiguration cag_robot_branches(const CagRobot *r);
// The branch that joint values belong to; false for a chain without a closed form.
bool cag_robot_configuration(const CagRobot *r, const double *q, CagConfiguration *out);

#endif
