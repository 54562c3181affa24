// Inverse kinematics by the best method available for a robot, and joint paths through poses.

#ifndef CAG_GEOM_ROBOT_PATH_H
#define CAG_GEOM_ROBOT_PATH_H

#include "geom/robot/numeric.h"

// Options of an inverse solution. Zeros are the defaults.
typedef struct CagRobotGoal {
  const double *near; // the solution nearest to this is chosen; NULL: home
  double tolerance;   // length and radians; 0: 1e-6
  bool position_only;
  int shoulder, elbow, wrist; // the branch, -1 or 1; 0: any
} CagRobotGoal;

// Joint values within the limits that bring the tool to `target`, a rigid transform. Fails with
// CAG_E_DEGENERATE "unreachable"; q then has the closest pose that was found.
CagStatus cag_robot_solve(const CagRobot *r, const CagTransform *target, const CagRobotGoal *goal,
                          double *q, CagRobotFound *found, CagError *err);

// Options of a path. Zeros are the defaults.
typedef struct CagRobotWay {
  const double *near; // the solution nearest to this is chosen for the first pose; NULL: home
  bool position_only; // the orientation of the tool is free
  bool cross;         // lines: pass through singular configurations
  bool jumps;         // poses: switch to another branch if there is no other way
  bool (*going)(void *data); // called between poses; returning false ends the path with
                             // CAG_E_CALLBACK. NULL: never stop
  void *data;
} CagRobotWay;

// n >= 2 joint configurations whose poses are evenly spaced on the motion from one pose to another:
// the origin moves along a straight line, the orientation turns about one axis. q has n times
// joint_count values.
//
// Fails with "unreachable" (the start), "path-leaves" (a pose on the way is out of reach),
// "path-jumps" (the joints would have to jump because of a limit or a singularity),
// "path-singular"; err->index is the step, and the message states it.
CagStatus cag_robot_line_path(const CagRobot *r, const CagTransform *from, const CagTransform *to,
                              size_t n, const CagRobotWay *way, double *q, CagError *err);
// Joint configurations for n poses, each reached from the previous one without a change of branch
// if possible.
CagStatus cag_robot_follow(const CagRobot *r, const CagTransform *poses, size_t n,
                           const CagRobotWay *way, double *q, CagError *err);

#endif
