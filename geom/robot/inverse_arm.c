// Three joints that position a point.
//
// With f the point in frame 2, k = Trans(a2, 0, d2) Rot(x, alpha2) f, and g = Rot(z, theta2) k the
// point in frame 1, its distance from the first frame and its height above it do not depend on
// theta1:
//
//     |w|^2 = |k|^2 + 2 a1 g.x + a1^2        w.z = sin(alpha1) g.y + cos(alpha1) k.z
//
// (w from the foot of link 1). The required g.x and g.y give an equation for joint 3 alone, a
// quartic in the tangent of its half angle that decomposes into quadratics if axes intersect or are
// parallel (Pieper 1968). theta2 then rotates k's component in the plane to g, and theta1 rotates
// the result to w.

#include "geom/robot/inverse_parts.h"

// Number of points in a turn at which the general equation is tested for sign changes.
#define SAMPLES 1024

typedef struct Arm {
  const InverseChain *chain;
  CagVec3 w, e; // the target from the foot of link 1; the point after joint 3
  const double *near;
  InverseArm *arms;
  size_t count;
} Arm;

static CagVec3 behind_joint3(const InverseChain *c, CagVec3 point) {
  const InverseRow *r = &c->row[2];
  CagVec3 e = inverse_turn_x(point, r->sine, r->cosine);
  e.x += r->a;
  return e;
}

// The point in frame 2, and in frame 1 before joint 2 turns, at the value q3.
static CagVec3 seen_from2(const Arm *a, double q3) {
  const InverseRow *r = &a->chain->row[2];
  const double theta = inverse_theta(r, q3);
  CagVec3 f = inverse_turn_z(a->e, sin(theta), cos(theta));
  f.z += inverse_d(r, q3);
  return f;
}
static CagVec3 before_joint2(const Arm *a, CagVec3 f) {
  const InverseRow *r = &a->chain->row[1];
  CagVec3 k = inverse_turn_x(f, r->sine, r->cosine);
  k.x += r->a;
  k.z += r->shift;
  return k;
}

static int sign_of(double x) { return x < 0 ? -1 : 1; }

// Elbow: the side of the upper arm on which the forearm lies. The sign is reversed for arms whose
// forearm is along axis 4.
static int elbow_of(const InverseChain *c, CagVec3 point, CagVec3 f) {
  const InverseRow *r = &c->row[1];
  if (!c->row[2].turns) return 0;
  const bool along = fabs(point.z) > fabs(c->row[2].a);
  const double side = fabs(r->sine) < INVERSE_PARALLEL && r->a != 0 ? r->a * r->cosine * f.y : f.y;
  return along ? -sign_of(side) : sign_of(side);
}

// Completes a branch from g.x = u and g.y = v.
static void add_branch(Arm *a, CagVec3 point, double q3, CagVec3 f, CagVec3 k, double u, double v) {
  if (a->count == INVERSE_ARMS_MAX) return;
  const InverseRow *r1 = &a->chain->row[0], *r2 = &a->chain->row[1];
  const double nothing = INVERSE_NOTHING * a->chain->reach;
  InverseArm *arm = &a->arms[a->count++];
  *arm = (InverseArm){.shoulder = sign_of(u + r1->a), .elbow = elbow_of(a->chain, point, f)};
  arm->q[2] = a->chain->row[2].turns ? inverse_wrapped(q3) : q3;
  if (inverse_length(k.x, k.y) < nothing) {
    arm->q[1] = a->near[1];
    arm->free |= 2;
  } else {
    arm->q[1] = inverse_value(r2, atan2(v, u) - atan2(k.y, k.x));
  }
  const double along = u + r1->a, across = r1->cosine * v - r1->sine * k.z;
  if (inverse_length(a->w.x, a->w.y) < nothing) {
    arm->q[0] = a->near[0];
    arm->free |= 1;
  } else {
    arm->q[0] = inverse_value(r1, atan2(a->w.y, a->w.x) - atan2(across, along));
  }
}

// sqrt of x, clamped to 0; false if x is negative beyond rounding relative to `scale`.
static bool root_of(double x, double scale, double *root) {
  if (x < -INVERSE_CLAMP * scale) return false;
  *root = x > 0 ? sqrt(x) : 0;
  return true;
}

// Both signs of u, or one if it is zero.
static void both_sides(Arm *a, CagVec3 point, double q3, double center, double root, double v) {
  const CagVec3 f = seen_from2(a, q3), k = before_joint2(a, f);
  const double nothing = INVERSE_NOTHING * a->chain->reach;
  add_branch(a, point, q3, f, k, center + root, v);
  if (root > nothing) add_branch(a, point, q3, f, k, center - root, v);
}

// Axes 2 and 3 parallel: the height determines v, the distance u, and u and v the length of k.
static void parallel23(Arm *a, CagVec3 point) {
  const InverseRow *r1 = &a->chain->row[0], *r2 = &a->chain->row[1], *r3 = &a->chain->row[2];
  const double kz = before_joint2(a, seen_from2(a, 0)).z;
  const double v = (a->w.z - r1->cosine * kz) / r1->sine;
  const double w2 = cag_dot(a->w, a->w), scale = a->chain->reach * a->chain->reach;
  double root, x[2];
  if (!root_of(w2 - v * v - kz * kz, scale, &root)) return;
  const double h2 = a->e.x * a->e.x + a->e.y * a->e.y;
  for (int side = 0; side < (root > INVERSE_NOTHING * a->chain->reach ? 2 : 1); side++) {
    const double u = (side ? -root : root) - r1->a;
    const double fx = u * u + v * v - h2 - r2->a * r2->a; // 2 a2 f.x
    const int n = cag_inverse_trigonometric(2 * r2->a * a->e.x, -2 * r2->a * a->e.y, fx, scale, x);
    for (int i = 0; i < n; i++) {
      const double q3 = x[i] - r3->angle;
      const CagVec3 f = seen_from2(a, q3);
      add_branch(a, point, q3, f, before_joint2(a, f), u, v);
    }
  }
}

// Joint 2 at a value of joint 3 if axes 1 and 2 intersect (a1 = 0) and are not parallel.
static void meet12_at(Arm *a, CagVec3 point, double q3) {
  const InverseRow *r1 = &a->chain->row[0];
  const CagVec3 k = before_joint2(a, seen_from2(a, q3));
  const double v = (a->w.z - r1->cosine * k.z) / r1->sine;
  double root;
  if (root_of(k.x * k.x + k.y * k.y - v * v, a->chain->reach * a->chain->reach, &root))
    both_sides(a, point, q3, 0, root, v);
}

// Axes 1 and 2 intersect: the distance determines joint 3.
static void meet12(Arm *a, CagVec3 point) {
  const InverseRow *r2 = &a->chain->row[1], *r3 = &a->chain->row[2];
  const double w2 = cag_dot(a->w, a->w), scale = a->chain->reach * a->chain->reach;
  if (r3->turns) {
    const double fz = a->e.z + r3->shift, ds = r2->shift * r2->sine;
    const double fixed = a->e.x * a->e.x + a->e.y * a->e.y + fz * fz + r2->a * r2->a +
                         r2->shift * r2->shift + 2 * r2->shift * r2->cosine * fz;
    double x[2];
    const int n =
        cag_inverse_trigonometric(2 * (r2->a * a->e.x + ds * a->e.y),
                                  2 * (ds * a->e.x - r2->a * a->e.y), w2 - fixed, scale, x);
    for (int i = 0; i < n; i++) meet12_at(a, point, x[i] - r3->angle);
    return;
  }
  // A prismatic joint along axis 3: f.z = e.z + d, |k|^2 = f.z^2 + 2 d2 cos(alpha2) f.z + rest.
  const CagVec3 f = seen_from2(a, 0);
  const double half = r2->shift * r2->cosine;
  const double rest = f.x * f.x + f.y * f.y + r2->a * r2->a + r2->shift * r2->shift +
                      2 * (r2->a * f.x + r2->shift * r2->sine * f.y) - w2;
  double root;
  if (!root_of(half * half - rest, scale, &root)) return;
  meet12_at(a, point, root - half - f.z);
  // The other root is the same position with joint 2 rotated; it counts only if it is not a mirror
  // image.
  if (fabs(half) > INVERSE_NOTHING * a->chain->reach && -root - half > 0)
    meet12_at(a, point, -root - half - f.z);
}

// Axes 1 and 2 parallel, axis 3 not: the height determines joint 3, the distance joint 2.
static void parallel12(Arm *a, CagVec3 point) {
  const InverseRow *r1 = &a->chain->row[0], *r2 = &a->chain->row[1], *r3 = &a->chain->row[2];
  const double fz = a->e.z + r3->shift, w2 = cag_dot(a->w, a->w);
  const double scale = a->chain->reach * a->chain->reach;
  const double height = r1->cosine * a->w.z - r2->shift - r2->cosine * fz; // sin(alpha2) f.y
  double x[2], root;
  const int n =
      cag_inverse_trigonometric(r2->sine * a->e.y, r2->sine * a->e.x, height, a->chain->reach, x);
  for (int i = 0; i < n; i++) {
    const double q3 = x[i] - r3->angle;
    const CagVec3 f = seen_from2(a, q3), k = before_joint2(a, f);
    if (fabs(r1->a) < INVERSE_NOTHING * a->chain->reach) continue; // axes 1 and 2 coincide
    const double u = (w2 - cag_dot(k, k) - r1->a * r1->a) / (2 * r1->a);
    if (!root_of(k.x * k.x + k.y * k.y - u * u, scale, &root)) continue;
    add_branch(a, point, q3, f, k, u, root);
    if (root > INVERSE_NOTHING * a->chain->reach) add_branch(a, point, q3, f, k, u, -root);
  }
}

// u and v at q3, and the error of their fit to k.
static double misfit(const Arm *a, double q3, double *u, double *v) {
  const InverseRow *r1 = &a->chain->row[0];
  const CagVec3 k = before_joint2(a, seen_from2(a, q3));
  *u = (cag_dot(a->w, a->w) - cag_dot(k, k) - r1->a * r1->a) / (2 * r1->a);
  *v = (a->w.z - r1->cosine * k.z) / r1->sine;
  return *u * *u + *v * *v - k.x * k.x - k.y * k.y;
}

// The misfit as a trigonometric polynomial of degree 2 in q3.
typedef struct Waves {
  double mean, cos1, sin1, cos2, sin2;
} Waves;

static double wave(const Waves *w, double q3) {
  const double c = cos(q3), s = sin(q3);
  return w->mean + w->cos1 * c + w->sin1 * s + w->cos2 * (c * c - s * s) + w->sin2 * 2 * s * c;
}

static Waves waves_of(const Arm *a) {
  enum { POINTS = 8 };
  Waves w = {0};
  for (int i = 0; i < POINTS; i++) {
    const double x = 2 * M_PI * i / POINTS;
    double u, v;
    const double value = misfit(a, x, &u, &v);
    w.mean += value / POINTS;
    w.cos1 += 2 * value * cos(x) / POINTS;
    w.sin1 += 2 * value * sin(x) / POINTS;
    w.cos2 += 2 * value * cos(2 * x) / POINTS;
    w.sin2 += 2 * value * sin(2 * x) / POINTS;
  }
  return w;
}

// A root between low and high, at which the polynomial has different signs.
static double bisect(const Waves *w, double low, double high) {
  const double at_low = wave(w, low);
  for (int i = 0; i < 60 && high - low > 1e-16; i++) {
    const double middle = 0.5 * (low + high);
    if ((wave(w, middle) < 0) == (at_low < 0)) low = middle;
    else high = middle;
  }
  return 0.5 * (low + high);
}

// The minimum of direction times the polynomial, by golden section.
static double lowest(const Waves *w, double low, double high, double direction) {
  const double share = 0.5 * (sqrt(5.0) - 1);
  for (int i = 0; i < 60; i++) {
    const double x = high - share * (high - low), y = low + share * (high - low);
    if (direction * wave(w, x) < direction * wave(w, y)) high = y;
    else low = x;
  }
  return 0.5 * (low + high);
}

static void keep_general(Arm *a, CagVec3 point, double q3) {
  double u, v;
  misfit(a, q3, &u, &v);
  const CagVec3 f = seen_from2(a, q3);
  add_branch(a, point, q3, f, before_joint2(a, f), u, v);
}

// No two axes intersect or are parallel: a trigonometric polynomial of degree 2 in joint 3 with at
// most four roots per turn; two that nearly coincide are found at the extremum between them.
static void general(Arm *a, CagVec3 point) {
  const double step = 2 * M_PI / SAMPLES, scale = a->chain->reach * a->chain->reach;
  const Waves w = waves_of(a);
  const double step_sine = sin(step), step_cosine = cos(step);
  double value[SAMPLES + 2], c = 1, s = 0;
  for (int i = 0; i < SAMPLES; i++) {
    value[i] = w.mean + w.cos1 * c + w.sin1 * s + w.cos2 * (c * c - s * s) + w.sin2 * 2 * s * c;
    const double next = c * step_cosine - s * step_sine;
    s = s * step_cosine + c * step_sine;
    c = next;
  }
  value[SAMPLES] = value[0];
  value[SAMPLES + 1] = value[1];
  for (int i = 0; i < SAMPLES; i++) {
    const double low = i * step, middle = low + step, high = middle + step;
    if ((value[i] < 0) != (value[i + 1] < 0)) keep_general(a, point, bisect(&w, low, middle));
    const double sign = value[i + 1] < 0 ? -1 : 1;
    const bool turns =
        sign * value[i + 1] <= sign * value[i] && sign * value[i + 1] <= sign * value[i + 2] &&
        (value[i] < 0) == (value[i + 1] < 0) && (value[i + 2] < 0) == (value[i + 1] < 0);
    if (!turns) continue;
    const double x = lowest(&w, low, high, sign), at = wave(&w, x);
    if ((at < 0) != (value[i + 1] < 0)) {
      keep_general(a, point, bisect(&w, low, x));
      keep_general(a, point, bisect(&w, x, high));
    } else if (fabs(at) < INVERSE_CLAMP * scale) {
      keep_general(a, point, x);
    }
  }
}

static bool is_nothing(const InverseChain *c, double length) {
  return fabs(length) < INVERSE_NOTHING * c->reach;
}

bool cag_inverse_arm_is_solvable(const InverseChain *c, CagVec3 point) {
  const InverseRow *r = c->row;
  const CagVec3 e = behind_joint3(c, point);
  // Joint 3 must move the point.
  if (r[2].turns && is_nothing(c, inverse_length(e.x, e.y))) return false;
  if (!r[0].turns || !r[1].turns) return false;
  const bool parallel12 = fabs(r[0].sine) < INVERSE_PARALLEL;
  const bool parallel23 = fabs(r[1].sine) < INVERSE_PARALLEL;
  if (r[2].turns)
    return !(parallel12 && (parallel23 || is_nothing(c, r[0].a))) &&
           !(parallel23 && is_nothing(c, r[1].a));
  return !parallel12 && is_nothing(c, r[0].a);
}

bool cag_inverse_arm_is_exact(const InverseChain *c) {
  const InverseRow *r = c->row;
  return fabs(r[0].sine) < INVERSE_PARALLEL || fabs(r[1].sine) < INVERSE_PARALLEL ||
         is_nothing(c, r[0].a);
}

size_t cag_inverse_arms(const InverseChain *c, CagVec3 point, CagVec3 w, const double *near,
                        InverseArm arms[INVERSE_ARMS_MAX]) {
  Arm a = {.chain = c, .w = w, .e = behind_joint3(c, point), .near = near, .arms = arms};
  a.w.z -= c->row[0].shift;
  if (c->row[2].turns && fabs(c->row[0].sine) < INVERSE_PARALLEL) parallel12(&a, point);
  else if (c->row[2].turns && fabs(c->row[1].sine) < INVERSE_PARALLEL) parallel23(&a, point);
  else if (is_nothing(c, c->row[0].a)) meet12(&a, point);
  else general(&a, point);
  return a.count;
}

void cag_inverse_arm_labels(const InverseChain *c, CagVec3 point, const double *q, int *shoulder,
                            int *elbow) {
  Arm a = {.chain = c, .e = behind_joint3(c, point)};
  const CagVec3 f = seen_from2(&a, q[2]), k = before_joint2(&a, f);
  const double theta2 = inverse_theta(&c->row[1], q[1]);
  *shoulder = sign_of(cos(theta2) * k.x - sin(theta2) * k.y + c->row[0].a);
  *elbow = elbow_of(c, point, f);
}
