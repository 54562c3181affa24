// Inverse kinematics in closed form: all joint values that bring the tool to a pose.
//
// Chains are recognized by their structure, however they are written down (either convention, fixed
// links between the joints, base and tool):
//
//   a spherical wrist          the axes of joints 4, 5 and 6 meet in a point; joints 1 to 3 turn,
//                              in any arrangement, or two of them turn and one slides
//   two axes that meet         five joints; the axes of joints 4 and 5 meet
//   axes 2, 3 and 4 parallel   six joints, or five; axes 5 and 6 each perpendicular to the one
//                              before
//   all axes parallel          at most three turning joints, and a slide
//   slides                     two turning joints and a slide, one turning joint and two slides,
//                              three slides
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
  CAG_INVERSE_ORIENTATION, // the place is reached, but not the orientation: fewer than six joints
  CAG_INVERSE_SINGULAR,    // some solutions belong to families: joints may turn against each other
  CAG_INVERSE_NO_CLOSED_FORM
} CagInverseStatus;

// Which of the branches: +1 or -1, 0 where a chain has no such choice or, at a singular pose, it
// makes no difference.
//   shoulder   the point that the first three joints place lies before or behind the first axis
//   elbow      sign of the sine of joint 3; of planar arms, of the second turning joint; of arms
//              with a forearm along axis 4, of d4 cos - a3 sin
//   wrist      sign of the sine of joint 5
typedef struct CagConfiguration {
  int shoulder, elbow, wrist;
} CagConfiguration;

typedef struct CagInverseSolution {
  double q[CAG_INVERSE_JOINTS_MAX]; // angles in (-pi, pi]
  CagConfiguration configuration;
  unsigned free; // bit i: joint i is free in this solution's family and stands where `near` has it
} CagInverseSolution;

typedef struct CagInverse {
  CagInverseStatus status;
  size_t count;
  CagInverseSolution solutions[CAG_INVERSE_SOLUTIONS_MAX];
  unsigned free; // of all solutions
} CagInverse;

bool cag_robot_has_inverse(const CagRobot *r);
// All solutions for a rigid target, also those that miss it by up to 1e-6 (of the reach, and
// radians), so that a rounded target has solutions if there are fewer than six joints. Limits are
// not asked. `near` (NULL: zeros) has the values for free joints.
void cag_robot_inverse(const CagRobot *r, const CagTransform *target, const double *near,
                       CagInverse *out);
// The same for a point that the tool's origin is to reach, whatever its orientation: of chains that
// reach a point in finitely many ways, which are planar chains of one or two turning joints (and a
// slide) and three turning joints in any arrangement.
bool cag_robot_has_point_inverse(const CagRobot *r);
void cag_robot_inverse_point(const CagRobot *r, CagVec3 point, const double *near, CagInverse *out);
// Which choices a chain has: 1 in each branch that it tells apart, 0 in the others.
CagConfiguration cag_robot_branches(const CagRobot *r);
// The branch that joint values belong to; false for a chain without closed form.
bool cag_robot_configuration(const CagRobot *r, const double *q, CagConfiguration *out);

#endif
