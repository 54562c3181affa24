// Denavit-Hartenberg tables from the axes of joints.

#ifndef CAG_GEOM_ROBOT_DH_H
#define CAG_GEOM_ROBOT_DH_H

#include "geom/robot/robot.h"

typedef struct CagJointAxis {
  CagJointKind kind; // revolute or prismatic
  CagVec3 point, direction;
} CagJointAxis;

// Frames and classic rows for joint axes at their zero positions (Denavit and Hartenberg 1955, with
// all choices fixed). z(i) is along axis i + 1. x(i) is along the common normal, away from the
// previous axis; for intersecting axes along the cross product of their directions; for parallel
// axes towards the point of the next axis (for the last frame at the height of the end's point).
//
//   base       its z axis is the direction of the first axis, and its origin lies on it
//   end        the point and direction of the last frame
//   links      n rows; theta and d are those of the zero position
//   frames     n + 1
//
// Fails with "empty-chain", "zero-vector" (err->index is the axis), "not-rigid", "axis-off-base".
CagStatus cag_robot_dh_assign(const CagTransform *base, const CagJointAxis *axes, size_t n,
                              const CagJointAxis *end, CagRobotLink *links, CagTransform *frames,
                              CagError *err);

#endif
