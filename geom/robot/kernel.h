// The innermost loops of robot kinematics: sines of all joint angles at once, and one stage of a
// chain.
//
// A frame is stored by columns, so that a rotation about its own z or x axis mixes two of them.
// Everything is inline: forward kinematics, Jacobians, and the inverse solver are built from these.

#ifndef CAG_GEOM_ROBOT_KERNEL_H
#define CAG_GEOM_ROBOT_KERNEL_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "geom/robot/robot.h"

typedef struct CagRobotFrame {
  CagVec3 x, y, z, p;
} CagRobotFrame;

// Sine and cosine of each joint's angle.
typedef struct CagRobotTurns {
  double sine[CAG_ROBOT_JOINTS_MAX], cosine[CAG_ROBOT_JOINTS_MAX];
} CagRobotTurns;

CagTransform cag_robot_rigid_inverse(const CagTransform *t);

static inline void cag_robot_frame_from(const CagTransform *t, CagRobotFrame *f) {
  const double(*m)[4] = t->m;
  f->x = cag_vec3(m[0][0], m[1][0], m[2][0]);
  f->y = cag_vec3(m[0][1], m[1][1], m[2][1]);
  f->z = cag_vec3(m[0][2], m[1][2], m[2][2]);
  f->p = cag_vec3(m[0][3], m[1][3], m[2][3]);
}

// Without negative zeros.
static inline void cag_robot_frame_to(const CagRobotFrame *f, CagTransform *t) {
  *t = (CagTransform){.m = {{f->x.x + 0.0, f->y.x + 0.0, f->z.x + 0.0, f->p.x + 0.0},
                            {f->x.y + 0.0, f->y.y + 0.0, f->z.y + 0.0, f->p.y + 0.0},
                            {f->x.z + 0.0, f->y.z + 0.0, f->z.z + 0.0, f->p.z + 0.0},
                            {0, 0, 0, 1}}};
}

// Multiplies the frame by a stage's matrix from the right; sine and cosine are those of its
// rotation.
static inline void cag_robot_advance(CagRobotFrame *f, const CagRobotStage *s, double sine,
                                     double cosine, double q) {
  CagVec3 x = cag_madd(cag_scaled(f->x, cosine), sine, f->y);
  CagVec3 y = cag_madd(cag_scaled(f->y, cosine), -sine, f->x);
  double along = s->shift + s->slide * q;
  f->p = cag_madd(cag_madd(f->p, along, f->z), s->a, x);
  f->x = x;
  CagVec3 z = f->z;
  f->y = cag_madd(cag_scaled(y, s->cosine), s->sine, z);
  f->z = cag_madd(cag_scaled(z, s->cosine), -s->sine, y);
  if (!s->has_fixed) return;
  CagRobotFrame g = *f;
  const double(*m)[4] = s->fixed.m;
#define COLUMN(j) cag_madd(cag_madd(cag_scaled(g.x, m[0][j]), m[1][j], g.y), m[2][j], g.z)
  f->x = COLUMN(0);
  f->y = COLUMN(1);
  f->z = COLUMN(2);
  f->p = cag_add(g.p, COLUMN(3));
#undef COLUMN
}

// Sines and cosines of all joint angles, within 1.5 units in the last place, and exact if an angle
// is within a few roundings of a multiple of a quarter turn. Straight-line code that the compiler
// can vectorize: the quadrant is read from the bits of a shifted number, and the remainder, within
// an eighth of a turn, is evaluated by the polynomials of fdlibm.
static inline void cag_robot_sines(const double *angle, size_t n, double *sine, double *cosine) {
  const double to_quarters = 6.36619772367581382433e-01;
  const double shifter = 6755399441055744.0; // 1.5 * 2^52: adding it rounds to the nearest integer
  // A quarter turn in three parts, the first two with 33 bits, so that small multiples are exact.
  const double part1 = 1.57079632673412561417e+00, part2 = 6.07710050630396597660e-11,
               part3 = 2.02226624879595063154e-21;
  const double roundings = 4 * 2.220446049250313e-16;
  for (size_t i = 0; i < n; i++) {
    double x = angle[i], shifted = x * to_quarters + shifter, k = shifted - shifter;
    uint64_t quadrant;
    memcpy(&quadrant, &shifted, sizeof quadrant);
    double r = ((x - k * part1) - k * part2) - k * part3;
    r = fabs(r) <= roundings * fabs(x) ? 0 : r;
    double z = r * r;
    double s = -2.50507602534068634195e-08 + z * 1.58969099521155010221e-10;
    s = 2.75573137070700676789e-06 + z * s;
    s = -1.98412698298579493134e-04 + z * s;
    s = 8.33333333332248946124e-03 + z * s;
    s = -1.66666666666666324348e-01 + z * s;
    s = r + r * z * s;
    double c = 2.08757232129817482790e-09 + z * -1.13596475577881948265e-11;
    c = -2.75573143513906633035e-07 + z * c;
    c = 2.48015872894767294178e-05 + z * c;
    c = -1.38888888888741095749e-03 + z * c;
    c = 4.16666666666666019037e-02 + z * c;
    double half = 0.5 * z, rest = 1 - half;
    c = rest + (((1 - rest) - half) + z * z * c);
    // Odd quadrants swap sine and cosine; the second bit flips the signs.
    uint64_t odd = 0 - (quadrant & 1), a, b;
    memcpy(&a, &s, sizeof a);
    memcpy(&b, &c, sizeof b);
    uint64_t swap = (a ^ b) & odd;
    a = (a ^ swap) ^ ((quadrant & 2) << 62);
    b = (b ^ swap) ^ (((quadrant + 1) & 2) << 62);
    memcpy(&sine[i], &a, sizeof a);
    memcpy(&cosine[i], &b, sizeof b);
  }
}

// For larger angles the three parts of a quarter turn are not precise enough.
#define CAG_ROBOT_ANGLE_MAX 1e5

static inline void cag_robot_turns(const CagRobot *r, const double *q, CagRobotTurns *t) {
  double angle[CAG_ROBOT_JOINTS_MAX];
  size_t n = r->joint_count;
  double largest = 0;
  for (size_t i = 0; i < n; i++) {
    angle[i] = r->stages[i].turn * q[i] + r->stages[i].angle;
    largest = fmax(largest, fabs(angle[i]));
  }
  if (largest <= CAG_ROBOT_ANGLE_MAX) {
    cag_robot_sines(angle, n, t->sine, t->cosine);
    return;
  }
  for (size_t i = 0; i < n; i++) cag_sincos(angle[i], &t->sine[i], &t->cosine[i]);
}

#endif
