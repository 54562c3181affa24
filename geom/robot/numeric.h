// Numerical inverse kinematics for arbitrary chains: damped least squares within the joint limits,
// with restarts from a low-discrepancy sequence, so results are reproducible.
//
// Joint values are radians and lengths; q has joint_count of them.

#ifndef CAG_GEOM_ROBOT_NUMERIC_H
#define CAG_GEOM_ROBOT_NUMERIC_H

#include "geom/robot/robot.h"

// Options of a search. Zeros are the defaults.
typedef struct CagRobotSearch {
  const double *near;        // start values, clamped to the limits; NULL: home
  double position, rotation; // accepted errors (length, radians); 0: 1e-9 of the reach, 1e-9.
                             // Solutions are always refined to rounding accuracy.
  bool position_only;        // the orientation of the tool is free
  size_t starts;             // maximum number of starts; 0: as many as the steps allow
  size_t steps;              // maximum number of iterations in total; 0: 8000
  size_t alternatives; // after a solution, the number of further starts that look for ones closer
                       // to `near`
  bool closest;        // without a solution, converges to the closest pose also from a single start
  bool stay_near;      // redundant chains are moved towards `near` without moving the tool
} CagRobotSearch;

// The result of a search: `q` lies within the limits even if no solution was found.
typedef struct CagRobotFound {
  bool solved;
  double position, rotation; // errors of the pose at q; if not solved, the best of all starts
  size_t steps;
} CagRobotFound;

// Never fails. `target` must be rigid. q may alias search->near.
CagRobotFound cag_robot_search(const CagRobot *r, const CagTransform *target,
                               const CagRobotSearch *search, double *q);

// Distance of two poses: between their origins, and the angle between their orientations.
void cag_robot_pose_distance(const CagTransform *a, const CagTransform *b, double *position,
                             double *rotation);
// The part of the rates dq that does not move the tool: (I - J^+ J) dq.
void cag_robot_null_motion(const CagRobot *r, const double *q, const double *dq, double *out);
// Point k >= 1 of a low-discrepancy sequence within the joint limits.
void cag_robot_sequence(const CagRobot *r, size_t k, double *q);

#endif
