// Shared by the files of the closed-form inverse: a chain as plain rows, frames from which links
// are stripped on either side, and the solvers for parts of a chain.

#ifndef CAG_GEOM_ROBOT_INVERSE_PARTS_H
#define CAG_GEOM_ROBOT_INVERSE_PARTS_H

#include "geom/linalg/tolerance.h"
#include "geom/robot/inverse.h"
#include "geom/robot/kernel.h"

// Axes are parallel if their sine is below the first; lengths below the second, as fractions of the
// reach, count as 0.
#define INVERSE_PARALLEL CAG_PARALLEL
#define INVERSE_NOTHING CAG_COINCIDENT
// Unreachable: a square root of a number below the negative of this, or a cosine above 1 by more
// than this.
#define INVERSE_CLAMP CAG_COINCIDENT

// A link: Rot(z, theta) Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha). Revolute joint: theta = q +
// angle, d = shift. Prismatic joint: theta = angle, d = q + shift.
typedef struct InverseRow {
  bool turns;
  double angle, shift, a, sine, cosine;
} InverseRow;

typedef struct InverseChain {
  size_t n;
  InverseRow row[CAG_INVERSE_JOINTS_MAX];
  CagTransform before; // the pose of the tool is before row[0] ... row[n - 1] after
  CagTransform after;
  double reach;
} InverseChain;

typedef enum InverseKind {
  INVERSE_NONE,
  INVERSE_ARM_WRIST, // three joints, then three intersecting axes
  INVERSE_ARM_PAIR,  // three joints, then two intersecting axes
  INVERSE_PARALLEL_6,
  INVERSE_PARALLEL_5, // axes 2, 3, 4 parallel
  INVERSE_PLANE,      // all axes parallel
  INVERSE_RRP,
  INVERSE_RPP,
  INVERSE_PPP,
  INVERSE_RRR // three revolute joints
} InverseKind;

// A target in the chain's own frames, without base and tool.
typedef struct InverseTask {
  const InverseChain *chain;
  CagRobotFrame target;
  const double *near;
  bool placed; // some branch reaches the position
  bool exact;  // solutions need no verification: six joints, all found by exact steps
  CagInverse *out;
} InverseTask;

static inline double inverse_wrapped(double angle) {
  if (fabs(angle) > M_PI) angle -= 2 * M_PI * nearbyint(angle / (2 * M_PI));
  return angle <= -M_PI ? angle + 2 * M_PI : angle + 0.0;
}

// The joint's value for the row's theta or d.
static inline double inverse_value(const InverseRow *row, double x) {
  return row->turns ? inverse_wrapped(x - row->angle) : x - row->shift;
}
// The row's theta at a joint value (for a prismatic joint its constant angle), and its d.
static inline double inverse_theta(const InverseRow *row, double q) {
  return row->turns ? q + row->angle : row->angle;
}
static inline double inverse_d(const InverseRow *row, double q) {
  return row->turns ? row->shift : q + row->shift;
}

// Length in the plane. Lengths here are far enough from overflow and underflow to be squared.
static inline double inverse_length(double x, double y) { return sqrt(x * x + y * y); }

static inline CagVec3 inverse_turn_z(CagVec3 v, double s, double c) {
  return cag_vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
}
static inline CagVec3 inverse_turn_x(CagVec3 v, double s, double c) {
  return cag_vec3(v.x, c * v.y - s * v.z, s * v.y + c * v.z);
}

// f = row(q)^-1 f.
void cag_inverse_strip_left(const InverseRow *row, double q, CagRobotFrame *f);
// f = f row(q)^-1, and the part of it that for a revolute joint does not depend on q:
// f = f (Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha))^-1.
void cag_inverse_strip_right(const InverseRow *row, double q, CagRobotFrame *f);
void cag_inverse_strip_crank(const InverseRow *row, CagRobotFrame *f);

// Solutions x of a cos x + b sin x = c. Returns their number, 0 to 2, or -1 if every x is a
// solution (a = b = c = 0, relative to `scale`).
int cag_inverse_trigonometric(double a, double b, double c, double scale, double x[2]);

// Values of three joints that bring the point `point` of frame 3 to w.
typedef struct InverseArm {
  double q[3];
  int shoulder, elbow;
  unsigned free;
} InverseArm;
#define INVERSE_ARMS_MAX 8
size_t cag_inverse_arms(const InverseChain *c, CagVec3 point, CagVec3 w, const double *near,
                        InverseArm arms[INVERSE_ARMS_MAX]);
bool cag_inverse_arm_is_solvable(const InverseChain *c, CagVec3 point);
// Whether all its steps are exact, so that no solution is found by a search.
bool cag_inverse_arm_is_exact(const InverseChain *c);
// The branch labels of joint values.
void cag_inverse_arm_labels(const InverseChain *c, CagVec3 point, const double *q, int *shoulder,
                            int *elbow);

// Axes 2, 3, 4 parallel; all axes parallel.
void cag_inverse_parallel(InverseTask *t);
void cag_inverse_parallel_labels(const InverseChain *c, const double *q, CagConfiguration *out);
bool cag_inverse_is_parallel(const InverseChain *c);
void cag_inverse_plane(InverseTask *t);
void cag_inverse_plane_labels(const InverseChain *c, const double *q, CagConfiguration *out);
bool cag_inverse_is_plane(const InverseChain *c);
size_t cag_inverse_plane_turns(const InverseChain *c);
// For chains with one or two revolute joints: all ways to bring `point` of the last frame to w.
void cag_inverse_plane_point(InverseTask *t, CagVec3 point, CagVec3 w);
// Adds a solution that brings `point` of the last frame to w; its own pose becomes the target.
void cag_inverse_keep_point(InverseTask *t, CagVec3 point, CagVec3 w, const double *q,
                            CagConfiguration configuration, unsigned free);

// Adds a solution unless it is already listed.
void cag_inverse_keep(InverseTask *t, const double *q, CagConfiguration configuration,
                      unsigned free);

#endif
