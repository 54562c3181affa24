// Workspaces: the region a robot's arm reaches, in closed form if its structure allows.

#ifndef CAG_GEOM_ROBOT_WORKSPACE_H
#define CAG_GEOM_ROBOT_WORKSPACE_H

#include "geom/robot/robot.h"

typedef enum CagWorkspaceKind {
  CAG_WORKSPACE_CARTESIAN,   // a box: the travels of three prismatic joints
  CAG_WORKSPACE_CYLINDRICAL, // a revolute joint, a slide along its axis, and a slide away from it
  CAG_WORKSPACE_SPHERICAL,   // two revolute joints with intersecting axes, and a slide away from
                             // the intersection
  CAG_WORKSPACE_OFFSET,      // the same with a shoulder offset (the Stanford arm)
  CAG_WORKSPACE_PLANAR,      // revolute joints with parallel axes: a disk or ring
  CAG_WORKSPACE_SCARA,       // the same with a slide along the axes
  CAG_WORKSPACE_ARTICULATED, // waist, shoulder, and elbow: a shell about the shoulder
  CAG_WORKSPACE_OTHER
} CagWorkspaceKind;

// The region reached by one point of the robot: the tool's origin if the joints of the wrist rotate
// about it, or else the point where the wrist's axes intersect.
typedef struct CagWorkspace {
  CagWorkspaceKind kind;
  bool of_wrist;
  CagVec3 center; // center of r_min and r_max: the shoulder, or a point of the first axis
  // Bounds of the distance from the center, or from the first axis for the cylindrical, planar, and
  // SCARA kinds, within the limits of the joints that determine it. With a shoulder offset no point
  // is closer to the axis than `hole`, and r is the root of |p - center|^2 - hole^2.
  double r_min, r_max, hole;
  // The formulas describe the region exactly: joint limits do not restrict it further.
  bool exact;
  double volume;    // of the region when exact (PLANAR: its area), else NaN
  CagBounds bounds; // CARTESIAN, OFFSET and ARTICULATED when exact, else empty
} CagWorkspace;

void cag_robot_workspace(const CagRobot *r, CagWorkspace *out);

// Joint values for sample k = 0 .. n-1 of the workspace: first the corners of the arm's limits (if
// they are at most half of n), then a low-discrepancy sequence within the limits.
void cag_robot_workspace_sample(const CagRobot *r, size_t k, size_t n, double *q);

#endif
