// What the files of the closed-form inverse share: a chain as plain rows, frames that are stripped
// of links from either side, and the solvers for parts of a chain.

#ifndef CAG_GEOM_ROBOT_INVERSE_PARTS_H
#define CAG_GEOM_ROBOT_INVERSE_PARTS_H

#include "geom/linalg/tolerance.h"
#include "geom/robot/inverse.h"
#include "geom/robot/kernel.h"

// Sines this small are of parallel axes; lengths this small, as parts of the reach, are none.
#define INVERSE_PARALLEL CAG_PARALLEL
#define INVERSE_NOTHING CAG_COINCIDENT
// Beyond a square root of a negative number, or a cosine above 1, by so much: unreachable.
#define INVERSE_CLAMP CAG_COINCIDENT

// A link: Rot(z, theta) Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha), theta = q + angle, d = shift
// of a joint that turns, theta = angle and d = q + shift of one that slides.
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
  INVERSE_ARM_WRIST, // three joints, then three axes that meet
  INVERSE_ARM_PAIR,  // three joints, then two axes that meet
  INVERSE_PARALLEL_6,
  INVERSE_PARALLEL_5, // axes 2, 3, 4 parallel
  INVERSE_PLANE,      // all axes parallel
  INVERSE_RRP,
  INVERSE_RPP,
  INVERSE_PPP,
  INVERSE_RRR // three turning joints
} InverseKind;

// Where the target is sought: the chain's own frames, without base and tool.
typedef struct InverseTask {
  const InverseChain *chain;
  CagRobotFrame target;
  const double *near;
  bool placed; // some branch reaches the place
  bool exact;  // solutions need not be tried: six joints, all found by exact steps
  CagInverse *out;
} InverseTask;

static inline double inverse_wrapped(double angle) {
  if (fabs(angle) > M_PI) angle -= 2 * M_PI * nearbyint(angle / (2 * M_PI));
  return angle <= -M_PI ? angle + 2 * M_PI : angle + 0.0;
}

// The joint's value at the row's theta or d.
static inline double inverse_value(const InverseRow *row, double x) {
  return row->turns ? inverse_wrapped(x - row->angle) : x - row->shift;
}
// The row's theta at a joint value (of a slide: its constant angle), and its d.
static inline double inverse_theta(const InverseRow *row, double q) {
  return row->turns ? q + row->angle : row->angle;
}
static inline double inverse_d(const InverseRow *row, double q) {
  return row->turns ? row->shift : q + row->shift;
}

// Length in a plane: lengths here are far from the ends of the numbers, so that squares may be.
static inline double inverse_length(double x, double y) { return sqrt(x * x + y * y); }

static inline CagVec3 inverse_turn_z(CagVec3 v, double s, double c) {
  return cag_vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
}
static inline CagVec3 inverse_turn_x(CagVec3 v, double s, double c) {
  return cag_vec3(v.x, c * v.y - s * v.z, s * v.y + c * v.z);
}

// f = row(q)^-1 f.
void cag_inverse_strip_left(const InverseRow *row, double q, CagRobotFrame *f);
// f = f row(q)^-1, and the part of it that does not depend on q of a turning joint:
// f = f (Trans(0, 0, d) Trans(a, 0, 0) Rot(x, alpha))^-1.
void cag_inverse_strip_right(const InverseRow *row, double q, CagRobotFrame *f);
void cag_inverse_strip_crank(const InverseRow *row, CagRobotFrame *f);

// Solutions x of a cos x + b sin x = c: their number, 0 to 2; -1 where all x are (a = b = c = 0,
// measured by `scale`).
int cag_inverse_trigonometric(double a, double b, double c, double scale, double x[2]);

// Joint values of three joints that place the point `point` of frame 3 at w.
typedef struct InverseArm {
  double q[3];
  int shoulder, elbow;
  unsigned free;
} InverseArm;
#define INVERSE_ARMS_MAX 8
size_t cag_inverse_arms(const InverseChain *c, CagVec3 point, CagVec3 w, const double *near,
                        InverseArm arms[INVERSE_ARMS_MAX]);
bool cag_inverse_arm_is_solvable(const InverseChain *c, CagVec3 point);
// Whether its steps are exact, and none is found by search.
bool cag_inverse_arm_is_exact(const InverseChain *c);
// The labels of joint values.
void cag_inverse_arm_labels(const InverseChain *c, CagVec3 point, const double *q, int *shoulder,
                            int *elbow);

// Axes 2, 3, 4 parallel; all parallel.
void cag_inverse_parallel(InverseTask *t);
void cag_inverse_parallel_labels(const InverseChain *c, const double *q, CagConfiguration *out);
bool cag_inverse_is_parallel(const InverseChain *c);
void cag_inverse_plane(InverseTask *t);
void cag_inverse_plane_labels(const InverseChain *c, const double *q, CagConfiguration *out);
bool cag_inverse_is_plane(const InverseChain *c);
size_t cag_inverse_plane_turns(const InverseChain *c);
// Of chains of one or two turning joints: all ways to bring `point` of the last frame to w.
void cag_inverse_plane_point(InverseTask *t, CagVec3 point, CagVec3 w);
// Keeps a solution that brings `point` of the last frame to w; its own pose becomes the target.
void cag_inverse_keep_point(InverseTask *t, CagVec3 point, CagVec3 w, const double *q,
                            CagConfiguration configuration, unsigned free);

// Keeps a solution if it is none of those found.
void cag_inverse_keep(InverseTask *t, const double *q, CagConfiguration configuration,
                      unsigned free);

#endif
