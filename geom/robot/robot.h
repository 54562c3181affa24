// Robots: serial chains of revolute, prismatic, and fixed links, and their forward kinematics.
//
// A robot is a list of links in order from the base to the end effector. A link is a row of a
// Denavit-Hartenberg table with a joint, or a fixed transform. The pose of the tool in the world is
//
//     base A1 A2 ... An tool
//
// with A = Rot(z, theta) Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha)  (CAG_ROBOT_CLASSIC)
// or   A = Rot(x, alpha) Trans(a, 0, 0) Rot(z, theta) Trans(0, 0, d)  (CAG_ROBOT_MODIFIED)
//
// The value q of a joint is added to theta (revolute) or to d (prismatic). `q` has one value for
// each joint, in radians or in lengths; fixed links have none. Joints are numbered 0 ..
// joint_count-1, links 0 .. link_count-1 in the given order. Frame i is the base frame for i = 0,
// else the frame after link i-1; so the frames that a user names count links from 1.
//
// In addition to its links a robot keeps a uniform form, its stages, from which everything is
// computed. There is one stage for each joint, and the tool's pose is
//
//     before  S1 S2 ... Sm       with
//     S = Rot(z, turn q + angle) Trans(0, 0, slide q + shift) Trans(a, 0, 0) Rot(x, alpha) fixed
//
// so base, tool, and fixed links are absorbed into `before` and the stages' `fixed`, which is the
// identity if `has_fixed` is false. A joint's axis is the z axis before its stage.
//
// Robots are immutable and reference counted. Angles are radians.

#ifndef CAG_GEOM_ROBOT_H
#define CAG_GEOM_ROBOT_H

#include "geom/linalg/transform.h"

// Maximum number of joints of a chain; bounds the stack use of the functions below.
#define CAG_ROBOT_JOINTS_MAX 128

typedef enum CagJointKind {
  CAG_JOINT_REVOLUTE,
  CAG_JOINT_PRISMATIC,
  CAG_JOINT_FIXED // a transform between joints
} CagJointKind;

typedef enum CagRobotConvention { CAG_ROBOT_CLASSIC, CAG_ROBOT_MODIFIED } CagRobotConvention;

typedef struct CagRobotLink {
  CagJointKind kind;
  double theta, d, a, alpha; // theta (revolute) and d (prismatic) are the values at q = 0
  double screw;              // revolute joints: translation along the axis per radian
  CagTransform fixed;        // FIXED only
  double low, high;          // limits of q: finite, low <= high
  double home;               // a value within the limits
  double speed, effort;      // maximum rate of q, and maximum force or torque; 0: unspecified
} CagRobotLink;

// A stage of the uniform form: see above.
typedef struct CagRobotStage {
  double turn, angle;  // turn is 1 (revolute) or 0
  double slide, shift; // slide is 1 (prismatic), 0, or the lead of a screw per radian
  double a, alpha;
  double sine, cosine; // of alpha, exact at quarter turns
  bool has_fixed;
  CagTransform fixed;
} CagRobotStage;

typedef struct CagRobot {
  long references;
  size_t link_count, joint_count;
  CagRobotLink *links;
  size_t *joint_link; // the link of each joint
  CagRobotConvention convention;
  CagTransform base, tool;
  // Coupling of the motors: motors = coupling q + offsets, joint_count rows of joint_count. NULL if
  // each motor drives its own joint.
  double *coupling, *coupling_inverse, *coupling_offset;
  CagTransform before;
  CagRobotStage *stages; // one for each joint
  double reach; // upper bound of the distance from the first joint's axis point to the tool, never
                // 0
} CagRobot;

// The definition of a robot. `links` are copied. `coupling` is NULL or joint_count^2 numbers, row
// by row, with joint_count values of `coupling_offset` (NULL: zeros).
typedef struct CagRobotSpec {
  const CagRobotLink *links;
  size_t link_count;
  CagRobotConvention convention;
  CagTransform base, tool;
  const double *coupling, *coupling_offset;
} CagRobotSpec;

// Fails with CAG_E_ARGUMENT: "empty-chain" (no link), "too-many-joints", "joint-limits" (infinite
// or reversed; err->index is the joint), "home-outside", "not-rigid" (base, tool or a fixed link),
// "coupling-singular".
CagStatus cag_robot_new(const CagRobotSpec *spec, CagRobot **out, CagError *err);
CagRobot *cag_robot_retain(const CagRobot *r);
void cag_robot_release(CagRobot *r);

// Checks a single link: finite numbers, limits, home, and a rigid fixed transform.
CagStatus cag_robot_link_check(const CagRobotLink *link, CagError *err);
// Checks that a requested pose is a rigid motion, to 1e-9. Fails with "not-rigid" for this
// argument.
CagStatus cag_robot_pose_check(const CagTransform *t, const char *argument, CagError *err);

// A link with all parameters 0: a revolute row with limits of half a turn, a prismatic row with the
// limits 0 .. 0, or a fixed link.
CagRobotLink cag_robot_link(CagJointKind kind);

// --- Forward kinematics (chain.c). q has joint_count finite values; limits are not checked. ---

// Pose of the tool in the world.
void cag_robot_forward(const CagRobot *r, const double *q, CagTransform *tool);
// Frames 0 .. link_count in the world: the base, then the frame after each link.
void cag_robot_frames(const CagRobot *r, const double *q, CagTransform *frames);
// Frame i relative to frame j, T(j, i); for i < j the inverse of T(i, j).
void cag_robot_subchain(const CagRobot *r, const double *q, size_t j, size_t i, CagTransform *out);
// The axis of each joint in the world: a point on it and its unit direction.
void cag_robot_axes(const CagRobot *r, const double *q, CagVec3 *points, CagVec3 *directions);
// Stick figure of the chain: the base's origin, for each link the foot of its common normal and its
// origin (only the origin of a fixed link), and the tool's origin if there is a tool. At most 2
// link_count + 2 points; returns their number.
size_t cag_robot_skeleton(const CagRobot *r, const double *q, CagVec3 *points);

// --- Jacobian (jacobian.c) ---

// Columns of the geometric Jacobian, by joint: linear velocity of the tool's origin, then angular
// velocity, per unit rate of q, in world axes. `tool` (may be NULL) receives the pose.
void cag_robot_jacobian(const CagRobot *r, const double *q, double (*columns)[6],
                        CagTransform *tool);
// The same in the axes of the tool.
void cag_robot_jacobian_tool(const CagRobot *r, const double *q, double (*columns)[6]);
// The min(6, joint_count) singular values of the Jacobian, descending. Lengths are divided by the
// robot's reach so that they compare with radians. The rank counts the values above 1e-9 of the
// largest.
CagStatus cag_robot_singular_values(const CagRobot *r, const double *q, double values[6],
                                    size_t *count, size_t *rank, CagError *err);
// sqrt(det(J J^T)), or for fewer than 6 joints sqrt(det(J^T J)): Yoshikawa's measure.
double cag_robot_manipulability(const CagRobot *r, const double *q);

// --- Limits and couplings (chain.c) ---

// How far q violates the limits: the first joint at fault and by how much (if none, joint_count and
// 0).
size_t cag_robot_outside(const CagRobot *r, const double *q, double *by);
// How far one joint's value lies outside its limits, and the limit it violates; 0: within.
double cag_robot_joint_outside(const CagRobot *r, size_t joint, double q, double *limit);
// Brings revolute joints that are whole turns outside their limits back within them, nearest to
// `near` (NULL: nearest to q). Returns false if a joint cannot be brought within.
bool cag_robot_into_limits(const CagRobot *r, const double *near, double *q);
void cag_robot_motors(const CagRobot *r, const double *q, double *motors);
void cag_robot_joints(const CagRobot *r, const double *motors, double *q);
void cag_robot_home(const CagRobot *r, double *q);

#endif
