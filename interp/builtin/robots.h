// Declarations shared by the built-ins on robots: reading of robots, joint values, and poses.
//
// A list q has one value for each joint: an angle for a revolute joint, and a number (millimeters)
// for a prismatic one. The machine stores q in radians and millimeters, with at most
// CAG_ROBOT_JOINTS_MAX values.

#ifndef CAG_INTERP_BUILTIN_ROBOTS_H
#define CAG_INTERP_BUILTIN_ROBOTS_H

#include "geom/robot/robot.h"
#include "interp/builtin/shapes.h"

// --- Default drawing of a robot by rods, drums, and a foot: sizes relative to the length of its
// skeleton ---
#define CAG_PLAIN_ROD_RADIUS 0.018
#define CAG_PLAIN_DRUM_RADIUS 0.035
#define CAG_PLAIN_DRUM_LENGTH 0.1
#define CAG_PLAIN_SLIDE_SIDE 0.056 // the square bar of a prismatic joint
#define CAG_PLAIN_FOOT_RADIUS 0.07
#define CAG_PLAIN_FOOT_HEIGHT 0.012
// Sections of the skeleton that are shorter than this fraction are not drawn.
#define CAG_PLAIN_SHORT 1e-6
// Colors in linear light.
#define CAG_PLAIN_ROD_COLOR                                                                        \
  { 0.42, 0.44, 0.47 }
#define CAG_PLAIN_DRUM_COLOR                                                                       \
  { 0.86, 0.22, 0.03 }
#define CAG_PLAIN_FOOT_COLOR                                                                       \
  { 0.08, 0.09, 0.1 }

// --- Arguments ---
bool cag_arg_robot(CagCall *call, int argument, CagRobot **out); // borrowed
// Reads joint values. If `limits` is set, values outside the limits cause the error outside-limits,
// which names the joint.
bool cag_arg_joints(CagCall *call, int argument, const CagRobot *r, bool limits, double *q);
// Does the same, but returns the home position if the argument is omitted or none.
bool cag_arg_joints_or_home(CagCall *call, int argument, const CagRobot *r, bool limits, double *q);
// Reads a pose, which must be a rigid transform of space; otherwise the error is not-rigid.
bool cag_arg_pose(CagCall *call, int argument, CagTransform *out);
bool cag_pose_of_value(CagCall *call, int argument, CagValue v, CagTransform *out);
// Reads a pose, or a point (as the translation to it) if the tool may have any orientation.
bool cag_arg_target(CagCall *call, int argument, CagTransform *out, bool *point);

// --- Results ---
extern const char *const cag_joint_kinds[]; // names, by CagJointKind
CagValue cag_joints_value(CagVm *vm, const CagRobot *r, const double *q);
// The value of one joint.
CagValue cag_joint_value(const CagRobot *r, size_t joint, double q);
// Formats a joint's value with its unit for messages, such as "35deg" or "120"; the buffer has 48
// bytes.
const char *cag_joint_text(const CagRobot *r, size_t joint, double q, char *buffer);

// Returns the group that `show robot` displays.
bool cag_robot_at_home(CagVm *vm, CagValue robot, CagValue *group);

#endif
