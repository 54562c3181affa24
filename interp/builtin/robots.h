// What several files of built-ins on robots share: reading of robots, joint values and poses.
//
// A list q has one value for each joint: angles where it turns, numbers (millimeters) where it
// slides. In the machine's memory q is radians and millimeters, at most CAG_ROBOT_JOINTS_MAX long.

#ifndef CAG_INTERP_BUILTIN_ROBOTS_H
#define CAG_INTERP_BUILTIN_ROBOTS_H

#include "geom/robot/robot.h"
#include "interp/builtin/shapes.h"

// --- Plain robots, of rods, drums and a foot: sizes as parts of the length of their skeleton ---
#define CAG_PLAIN_ROD_RADIUS 0.018
#define CAG_PLAIN_DRUM_RADIUS 0.035
#define CAG_PLAIN_DRUM_LENGTH 0.1
#define CAG_PLAIN_SLIDE_SIDE 0.056 // of the square bar of a sliding joint
#define CAG_PLAIN_FOOT_RADIUS 0.07
#define CAG_PLAIN_FOOT_HEIGHT 0.012
// Sections of the skeleton shorter than this part are not drawn.
#define CAG_PLAIN_SHORT 1e-6
// Linear light.
#define CAG_PLAIN_ROD_COLOR                                                                        \
  { 0.42, 0.44, 0.47 }
#define CAG_PLAIN_DRUM_COLOR                                                                       \
  { 0.86, 0.22, 0.03 }
#define CAG_PLAIN_FOOT_COLOR                                                                       \
  { 0.08, 0.09, 0.1 }

// --- Arguments ---
bool cag_arg_robot(CagCall *call, int argument, CagRobot **out); // borrowed
// Joint values; where `limits` the error outside-limits names the joint outside.
bool cag_arg_joints(CagCall *call, int argument, const CagRobot *r, bool limits, double *q);
// The same, or home where the argument is not given or none.
bool cag_arg_joints_or_home(CagCall *call, int argument, const CagRobot *r, bool limits, double *q);
// A pose of space: a rigid transform; else the error not-rigid.
bool cag_arg_pose(CagCall *call, int argument, CagTransform *out);
bool cag_pose_of_value(CagCall *call, int argument, CagValue v, CagTransform *out);
// A pose, or a point where the tool may be turned as it likes: the translation to it.
bool cag_arg_target(CagCall *call, int argument, CagTransform *out, bool *point);

// --- Results ---
extern const char *const cag_joint_kinds[]; // names, by CagJointKind
CagValue cag_joints_value(CagVm *vm, const CagRobot *r, const double *q);
// One joint's value.
CagValue cag_joint_value(const CagRobot *r, size_t joint, double q);
// Text of a joint's value with its unit, for messages: "35deg", "120"; buffer of 48 bytes.
const char *cag_joint_text(const CagRobot *r, size_t joint, double q, char *buffer);

// The group that `show robot` shows.
bool cag_robot_at_home(CagVm *vm, CagValue robot, CagValue *group);

#endif
