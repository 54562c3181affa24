// Numerical inverse kinematics for every chain: damped least squares within the joint limits, with
// restarts from a low-discrepancy sequence, so that a call gives the same answer every time.
//
// Joint values are radians and lengths, q has joint_count of them.

#ifndef CAG_GEOM_ROBOT_NUMERIC_H
#define CAG_GEOM_ROBOT_NUMERIC_H

#include "geom/robot/robot.h"

// How a pose is looked for. Zeros are the usual.
typedef struct CagRobotSearch {
  const double *near;        // where to start; NULL: home. Brought within the limits.
  double position, rotation; // errors (length, radians) with which to be content; 0: 1e-9 of the
                             // reach, 1e-9. What is found is always made as good as rounding lets.
  bool position_only;        // the tool may be turned as it likes
  size_t starts;             // most starts; 0: as many as the steps let
  size_t steps;              // most steps of the iteration in all; 0: 8000
  size_t alternatives; // after a solution so many further starts for ones that are nearer to `near`
  bool stay_near; // chains with freedom to spare are moved towards `near` without moving the tool
} CagRobotSearch;

// What was found: `q` lies within the limits, solution or not.
typedef struct CagRobotFound {
  bool solved;
  double position, rotation; // errors of the pose at q; the best of all starts when not solved
  size_t steps;
} CagRobotFound;

// Never fails; `target` is rigid. q may be where search->near lies.
CagRobotFound cag_robot_search(const CagRobot *r, const CagTransform *target,
                               const CagRobotSearch *search, double *q);

// Distance of two poses: of their origins and of their rotations (the angle between).
void cag_robot_pose_distance(const CagTransform *a, const CagTransform *b, double *position,
                             double *rotation);
// Part of the rates dq that leaves the tool where it is: (I - J^+ J) dq.
void cag_robot_null_motion(const CagRobot *r, const double *q, const double *dq, double *out);
// Point k >= 1 of a sequence that fills the joint limits evenly.
void cag_robot_sequence(const CagRobot *r, size_t k, double *q);

#endif
