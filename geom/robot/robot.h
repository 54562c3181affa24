// Robots: serial chains of revolute, prismatic and fixed links, and where their joints put them.
//
// A robot is a list of links in the order from the base to the hand. A link is a row of a
// Denavit-Hartenberg table with a joint, or a fixed transform. The pose of the tool is
//
//     base A1 A2 ... An tool          all seen from the world
//
// with A = Rot(z, theta) Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha)  (CAG_ROBOT_CLASSIC)
// or   A = Rot(x, alpha) Trans(a, 0, 0) Rot(z, theta) Trans(0, 0, d)  (CAG_ROBOT_MODIFIED)
//
// The value q of a joint is added to theta (revolute) or to d (prismatic). `q` has one value for
// each joint (links that are fixed have none), in radians or in lengths: the joints are numbered
// 0 .. joint_count-1, the links as they were given, 0 .. link_count-1. Frame i is the base frame
// for i = 0, else the frame after link i-1; so links count from 1 where a user names a frame.
//
// Beside the links a robot keeps them in one uniform form, its stages, from which everything is
// computed. There is one stage for each joint, and the tool's pose is
//
//     before  S1 S2 ... Sm       with
//     S = Rot(z, turn q + angle) Trans(0, 0, slide q + shift) Trans(a, 0, 0) Rot(x, alpha) fixed
//
// so base, tool and fixed links are part of `before` and of the stages' `fixed`, which is the
// identity wherever `has_fixed` is false. A joint's axis is the z axis before its stage.
//
// Robots are immutable and reference counted. Angles are radians.

#ifndef CAG_GEOM_ROBOT_H
#define CAG_GEOM_ROBOT_H

#include "geom/linalg/transform.h"

// Joints that a chain may have: what the functions below keep on the stack.
#define CAG_ROBOT_JOINTS_MAX 128

typedef enum CagJointKind {
  CAG_JOINT_REVOLUTE,
  CAG_JOINT_PRISMATIC,
  CAG_JOINT_FIXED // a transform between joints
} CagJointKind;

typedef enum CagRobotConvention { CAG_ROBOT_CLASSIC, CAG_ROBOT_MODIFIED } CagRobotConvention;

typedef struct CagRobotLink {
  CagJointKind kind;
  double theta, d, a, alpha; // theta (revolute) and d (prismatic) are the row's at q = 0
  double screw;              // of a revolute joint: how far it also slides along its axis, a radian
  CagTransform fixed;        // FIXED only
  double low, high;          // limits of q: finite, low <= high
  double home;               // a value within the limits
  double speed, effort;      // greatest rate of q and force or torque; 0: not said
} CagRobotLink;

// A stage of the uniform form: see above.
typedef struct CagRobotStage {
  double turn, angle;  // turn is 1 (revolute) or 0
  double slide, shift; // slide is 1 (prismatic), 0, or the lead of a screw
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
  // Couplings: motors = coupling q + offsets, joint_count rows of joint_count; NULL where each
  // motor drives its joint alone.
  double *coupling, *coupling_inverse, *coupling_offset;
  CagTransform before;
  CagRobotStage *stages; // one for each joint
  double reach; // bound of the distance of the tool from the first joint's axis point, never 0
} CagRobot;

// What a robot is made of. `links` are copied. `coupling` is NULL or joint_count^2 numbers, row by
// row, with joint_count `coupling_offset`s (NULL: zeros).
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

// Whether a link alone is good: finite numbers, limits, home, a rigid fixed transform.
CagStatus cag_robot_link_check(const CagRobotLink *link, CagError *err);
// Whether a pose asked for is a motion, to 1e-9: "not-rigid" of this argument.
CagStatus cag_robot_pose_check(const CagTransform *t, const char *argument, CagError *err);

// A revolute or prismatic row of zeros with limits of half a turn or 0 .. 0; a fixed link.
CagRobotLink cag_robot_link(CagJointKind kind);

// --- Forward kinematics (chain.c). q has joint_count values, finite; limits are not asked. ---

// Pose of the tool in the world.
void cag_robot_forward(const CagRobot *r, const double *q, CagTransform *tool);
// Frames 0 .. link_count in the world: the base, then the frame after each link.
void cag_robot_frames(const CagRobot *r, const double *q, CagTransform *frames);
// Frame i seen from frame j, T(j, i); i < j gives the inverse of T(i, j).
void cag_robot_subchain(const CagRobot *r, const double *q, size_t j, size_t i, CagTransform *out);
// The axis of each joint in the world: a point of it and its unit direction.
void cag_robot_axes(const CagRobot *r, const double *q, CagVec3 *points, CagVec3 *directions);
// Stick figure of the chain: the base's origin, then for each link the foot of its common normal
// and its origin (of a fixed link its origin alone), and the tool's origin where there is a tool.
// At most 2 link_count + 2 points.
size_t cag_robot_skeleton(const CagRobot *r, const double *q, CagVec3 *points);

// --- Jacobian (jacobian.c) ---

// Columns of the geometric Jacobian, by joint: velocity of the tool's origin, then angular
// velocity, for each unit of q's rate, in the world's axes. `tool` (may be NULL) is the pose.
void cag_robot_jacobian(const CagRobot *r, const double *q, double (*columns)[6],
                        CagTransform *tool);
// The same in the axes of the tool.
void cag_robot_jacobian_tool(const CagRobot *r, const double *q, double (*columns)[6]);
// Singular values of the Jacobian, min(6, joints) of them, descending, lengths as parts of the
// robot's reach so that they compare with radians; the rank counts those above 1e-9 of the largest.
CagStatus cag_robot_singular_values(const CagRobot *r, const double *q, double values[6],
                                    size_t *count, size_t *rank, CagError *err);
// sqrt(det(J J^T)), or for fewer than 6 joints sqrt(det(J^T J)): Yoshikawa's measure.
double cag_robot_manipulability(const CagRobot *r, const double *q);

// --- Limits and couplings (chain.c) ---

// How far q lies outside of the limits: the first joint at fault and by how much (0 and
// joint_count: none).
size_t cag_robot_outside(const CagRobot *r, const double *q, double *by);
// How far one joint's value lies outside, and the limit that it passes; 0: within.
double cag_robot_joint_outside(const CagRobot *r, size_t joint, double q, double *limit);
// Brings turning joints that are a whole turn away from their limits within them, nearest to
// `near` (NULL: as near to q as may be). False when a joint cannot be brought.
bool cag_robot_into_limits(const CagRobot *r, const double *near, double *q);
void cag_robot_motors(const CagRobot *r, const double *q, double *motors);
void cag_robot_joints(const CagRobot *r, const double *motors, double *q);
void cag_robot_home(const CagRobot *r, double *q);

#endif
