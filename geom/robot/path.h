// Inverse kinematics by whichever way a robot has, and joint paths along poses.

#ifndef CAG_GEOM_ROBOT_PATH_H
#define CAG_GEOM_ROBOT_PATH_H

#include "geom/robot/numeric.h"

// What is asked of an inverse solution. Zeros are the usual.
typedef struct CagRobotGoal {
  const double *near; // of several solutions the nearest to this; NULL: home
  double tolerance;   // length and radians; 0: 1e-6
  bool position_only;
  int shoulder, elbow, wrist; // the branch, -1 or 1; 0: any
} CagRobotGoal;

// Joint values within the limits that bring the tool to `target`, a rigid transform. Fails with
// CAG_E_DEGENERATE: "unreachable"; q is then the place whose pose comes closest.
CagStatus cag_robot_solve(const CagRobot *r, const CagTransform *target, const CagRobotGoal *goal,
                          double *q, CagRobotFound *found, CagError *err);

// Asked between poses of a path whether to go on; `going` NULL: always. One that says no ends the
// path with CAG_E_CALLBACK.
typedef struct CagRobotWatch {
  bool (*going)(void *data);
  void *data;
} CagRobotWatch;

// n >= 2 places of the joints whose poses lie evenly on the way from one pose to another: straight
// for the origin, about one axis for the rotation. q has n times joint_count values. `cross` lets
// the way pass through singular places.
// Fails with "unreachable" (the start), "path-leaves" (a pose on the way is out of reach),
// "path-jumps" (the joints would have to jump there: a limit or a singularity stands between),
// "path-singular"; err->index is the step, and the message tells it.
CagStatus cag_robot_line_path(const CagRobot *r, const CagTransform *from, const CagTransform *to,
                              size_t n, const double *near, bool cross, CagRobotWatch watch,
                              double *q, CagError *err);
// Joint places for n poses, each reached from the one before without a jump to another branch
// where there is such a way. `jumps` lets the joints go to another branch where there is none.
CagStatus cag_robot_follow(const CagRobot *r, const CagTransform *poses, size_t n,
                           const double *near, bool jumps, CagRobotWatch watch, double *q,
                           CagError *err);

#endif
