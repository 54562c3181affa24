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

// How a path is gone. Zeros are the usual.
typedef struct CagRobotWay {
  const double *near; // of several solutions for the first pose the nearest to this; NULL: home
  bool position_only; // the tool may be turned as it likes
  bool cross;         // lines: pass through singular places
  bool jumps;         // poses: go to another branch where there is no other way
  bool (*going)(void *data); // asked between poses whether to go on; NULL: always. When not, the
                             // path ends with CAG_E_CALLBACK
  void *data;
} CagRobotWay;

// n >= 2 places of the joints whose poses lie evenly on the way from one pose to another: straight
// for the origin, about one axis for the rotation. q has n times joint_count values.
// Fails with "unreachable" (the start), "path-leaves" (a pose on the way is out of reach),
// "path-jumps" (the joints would have to jump there: a limit or a singularity stands between),
// "path-singular"; err->index is the step, and the message tells it.
CagStatus cag_robot_line_path(const CagRobot *r, const CagTransform *from, const CagTransform *to,
                              size_t n, const CagRobotWay *way, double *q, CagError *err);
// Joint places for n poses, each reached from the one before without a jump to another branch
// where there is such a way.
CagStatus cag_robot_follow(const CagRobot *r, const CagTransform *poses, size_t n,
                           const CagRobotWay *way, double *q, CagError *err);

#endif
