// Closed-form inverse kinematics: chains as rows, their recognition, and the combination of partial
// solvers. inverse_arm.c solves for three joints that position a point, inverse_parallel.c for
// chains with parallel axes; this file handles wrists, and chains determined by the orientation
// alone.

#include "geom/robot/inverse_parts.h"

#include <string.h>

#include "geom/robot/numeric.h"

// Largest error of the pose of a solution, as a fraction of the reach and in radians.
#define POSE_ERROR 1e-6
// A solution with an error up to this, from inexact steps, is refined.
#define ROUGH_ERROR 1e-2
#define FINE_ERROR 1e-12
#define DAMPING 1e-14
// Maximum number of Gauss-Newton steps. Near a double solution a step only halves the error.
#define MOST_STEPS 40
// Solutions closer than this are equal: for stretched arms they are known only to the square root
// of the rounding.
#define SAME_SOLUTION 1e-7

// --- Rows ---

// Writes Trans(a, 0, 0) Rot(x, alpha) fixed as Rot(z, turn) Trans(0, 0, rise) Trans(a, 0, 0) Rot(x,
// alpha) Rot(z, next_turn) Trans(0, 0, next_rise), by the common normal of the two z axes.
static void common_normal(const CagRobotFrame *m, double *turn, double *rise, InverseRow *row,
                          double *next_turn, double *next_rise) {
  const double sine = inverse_length(m->z.x, m->z.y);
  CagVec3 x = cag_vec3(1, 0, 0);
  *next_rise = 0;
  if (sine > INVERSE_PARALLEL) {
    x = cag_vec3(-m->z.y / sine, m->z.x / sine, 0);
    row->sine = sine, row->cosine = m->z.z;
    const CagVec3 y = cag_vec3(-x.y, x.x, 0);
    *next_rise = -cag_dot(m->p, y) / sine;
  } else {
    const double away = inverse_length(m->p.x, m->p.y);
    if (away > 0) x = cag_vec3(m->p.x / away, m->p.y / away, 0);
    row->sine = 0, row->cosine = m->z.z < 0 ? -1 : 1;
  }
  row->a = cag_dot(m->p, x);
  *rise = m->p.z - *next_rise * row->cosine;
  *turn = atan2(x.y, x.x);
  CagVec3 rest = inverse_turn_x(inverse_turn_z(m->x, -x.y, x.x), -row->sine, row->cosine);
  *next_turn = atan2(rest.y, rest.x);
}

static const CagRobotFrame unit_frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};

// The rows of a robot: fixed transforms between joints are absorbed. Returns false if the chain is
// too long, or has a screw joint.
static bool chain_of(const CagRobot *r, InverseChain *c) {
  if (r->joint_count == 0 || r->joint_count > CAG_INVERSE_JOINTS_MAX) return false;
  *c = (InverseChain){.n = r->joint_count, .before = r->before, .reach = r->reach};
  c->after = cag_transform_identity();
  double turn_in = 0, rise_in = 0; // from the previous row
  for (size_t i = 0; i < c->n; i++) {
    const CagRobotStage *s = &r->stages[i];
    InverseRow *row = &c->row[i];
    if (s->turn != 0 && s->slide != 0) return false;
    *row = (InverseRow){.turns = s->turn != 0,
                        .angle = s->angle + turn_in,
                        .shift = s->shift + rise_in,
                        .a = s->a,
                        .sine = s->sine,
                        .cosine = s->cosine};
    turn_in = rise_in = 0;
    if (!s->has_fixed) continue;
    if (i + 1 == c->n) {
      c->after = s->fixed;
      continue;
    }
    CagRobotFrame m = unit_frame;
    cag_robot_advance(&m,
                      &(CagRobotStage){.turn = 1,
                                       .a = s->a,
                                       .sine = s->sine,
                                       .cosine = s->cosine,
                                       .has_fixed = true,
                                       .fixed = s->fixed},
                      0, 1, 0);
    double turn, rise;
    common_normal(&m, &turn, &rise, row, &turn_in, &rise_in);
    row->angle += turn;
    row->shift += rise;
  }
  return true;
}

void cag_inverse_strip_left(const InverseRow *row, double q, CagRobotFrame *f) {
  const double theta = inverse_theta(row, q), s = -sin(theta), c = cos(theta);
  CagVec3 *const columns[] = {&f->x, &f->y, &f->z};
  for (int i = 0; i < 3; i++)
    *columns[i] = inverse_turn_x(inverse_turn_z(*columns[i], s, c), -row->sine, row->cosine);
  CagVec3 p = inverse_turn_z(f->p, s, c);
  p.x -= row->a;
  p.z -= inverse_d(row, q);
  f->p = inverse_turn_x(p, -row->sine, row->cosine);
}

void cag_inverse_strip_crank(const InverseRow *row, CagRobotFrame *f) {
  const CagVec3 y = f->y;
  f->y = cag_madd(cag_scaled(y, row->cosine), -row->sine, f->z);
  f->z = cag_madd(cag_scaled(f->z, row->cosine), row->sine, y);
  f->p = cag_madd(cag_madd(f->p, -row->a, f->x), row->turns ? -row->shift : 0, f->z);
}

void cag_inverse_strip_right(const InverseRow *row, double q, CagRobotFrame *f) {
  cag_inverse_strip_crank(row, f);
  if (!row->turns) f->p = cag_madd(f->p, -inverse_d(row, q), f->z);
  const double theta = inverse_theta(row, q), s = sin(theta), c = cos(theta);
  const CagVec3 x = f->x;
  f->x = cag_madd(cag_scaled(x, c), -s, f->y);
  f->y = cag_madd(cag_scaled(f->y, c), s, x);
}

int cag_inverse_trigonometric(double a, double b, double c, double scale, double x[2]) {
  const double h = inverse_length(a, b), nothing = INVERSE_NOTHING * scale;
  if (h < nothing) return fabs(c) < nothing ? -1 : 0;
  if (fabs(c) > h + INVERSE_CLAMP * scale) return 0;
  const double middle = atan2(b, a);
  const double half = fabs(c) < h ? atan2(sqrt((h - c) * (h + c)), c) : c > 0 ? 0 : M_PI;
  x[0] = middle + half;
  x[1] = middle - half;
  return half > 0 && half < M_PI ? 2 : 1;
}

// --- Recognition ---

static bool axes_meet(const InverseChain *c, size_t first, size_t count) {
  const double nothing = INVERSE_NOTHING * c->reach;
  for (size_t i = first; i < first + count; i++)
    if (!c->row[i].turns) return false;
  for (size_t i = first; i + 1 < first + count; i++) {
    if (fabs(c->row[i].a) > nothing || fabs(c->row[i].sine) < INVERSE_PARALLEL) return false;
    if (i > first && fabs(c->row[i].shift) > nothing) return false;
  }
  return true;
}

// The point positioned by the first three joints: the intersection of the following axes, or the
// tool.
static CagVec3 placed_point(const InverseChain *c) {
  const double(*m)[4] = c->after.m;
  return c->n == 3 ? cag_vec3(m[0][3], m[1][3], m[2][3]) : cag_vec3(0, 0, c->row[3].shift);
}

static InverseKind kind_of(const InverseChain *c) {
  if (cag_inverse_is_plane(c)) return INVERSE_PLANE;
  if (cag_inverse_is_parallel(c)) return c->n == 6 ? INVERSE_PARALLEL_6 : INVERSE_PARALLEL_5;
  if (c->n == 6 && cag_inverse_arm_is_solvable(c, placed_point(c)) && axes_meet(c, 3, 3))
    return INVERSE_ARM_WRIST;
  if (c->n == 5 && cag_inverse_arm_is_solvable(c, placed_point(c)) && axes_meet(c, 3, 2))
    return INVERSE_ARM_PAIR;
  if (c->n != 3) return INVERSE_NONE;
  const InverseRow *r = c->row;
  if (!r[0].turns && !r[1].turns && !r[2].turns) return INVERSE_PPP;
  if (r[0].turns && !r[1].turns && !r[2].turns) return INVERSE_RPP;
  if (r[0].turns && r[1].turns && !r[2].turns && fabs(r[0].sine) > INVERSE_PARALLEL)
    return INVERSE_RRP;
  return r[2].turns && cag_inverse_arm_is_solvable(c, placed_point(c)) ? INVERSE_RRR : INVERSE_NONE;
}

bool cag_robot_has_inverse(const CagRobot *r) {
  InverseChain c;
  return chain_of(r, &c) && kind_of(&c) != INVERSE_NONE;
}

// --- Solutions ---

static void forward(const InverseChain *c, const double *q, CagRobotFrame *f) {
  *f = unit_frame;
  for (size_t i = 0; i < c->n; i++) {
    const InverseRow *r = &c->row[i];
    const CagRobotStage s = {
        .a = r->a, .sine = r->sine, .cosine = r->cosine, .shift = inverse_d(r, q[i])};
    const double theta = inverse_theta(r, q[i]);
    cag_robot_advance(f, &s, sin(theta), cos(theta), 0);
  }
}

// The difference from the pose at q to the target: displacement and rotation vector (for small
// rotations).
static void pose_error(const InverseTask *t, const CagRobotFrame *f, double e[6]) {
  const CagRobotFrame *g = &t->target;
  const CagVec3 way = cag_sub(g->p, f->p);
  const CagVec3 turn = cag_scaled(
      cag_add(cag_add(cag_cross(f->x, g->x), cag_cross(f->y, g->y)), cag_cross(f->z, g->z)), 0.5);
  const double parts[6] = {way.x, way.y, way.z, turn.x, turn.y, turn.z};
  memcpy(e, parts, sizeof parts);
}

static bool reproduces(const InverseTask *t, const double *q, double within) {
  CagRobotFrame f;
  forward(t->chain, q, &f);
  const CagRobotFrame *g = &t->target;
  const double place = cag_norm(cag_sub(f.p, g->p));
  const double turn = fmax(cag_norm(cag_sub(f.x, g->x)),
                           fmax(cag_norm(cag_sub(f.y, g->y)), cag_norm(cag_sub(f.z, g->z))));
  return place <= within * t->chain->reach && turn <= within;
}

// Solves n equations with a positive definite matrix (right-hand side in column n).
static bool solve_normal(double m[][CAG_INVERSE_JOINTS_MAX + 1], size_t n) {
  for (size_t k = 0; k < n; k++) {
    if (!(m[k][k] > 0)) return false;
    for (size_t i = 0; i < n; i++) {
      if (i == k) continue;
      const double factor = m[i][k] / m[k][k];
      for (size_t j = k; j <= n; j++) m[i][j] -= factor * m[k][j];
    }
  }
  return true;
}

// One Gauss-Newton step towards the target, with lengths relative to the reach.
static void improve(const InverseTask *t, double *q) {
  const InverseChain *c = t->chain;
  CagVec3 axis[CAG_INVERSE_JOINTS_MAX], origin[CAG_INVERSE_JOINTS_MAX];
  double column[CAG_INVERSE_JOINTS_MAX][6], e[6];
  double m[CAG_INVERSE_JOINTS_MAX][CAG_INVERSE_JOINTS_MAX + 1];
  CagRobotFrame f = unit_frame;
  for (size_t i = 0; i < c->n; i++) {
    const InverseRow *r = &c->row[i];
    axis[i] = f.z, origin[i] = f.p;
    const double theta = inverse_theta(r, q[i]);
    cag_robot_advance(
        &f,
        &(CagRobotStage){
            .a = r->a, .sine = r->sine, .cosine = r->cosine, .shift = inverse_d(r, q[i])},
        sin(theta), cos(theta), 0);
  }
  pose_error(t, &f, e);
  for (int k = 0; k < 3; k++) e[k] /= c->reach;
  for (size_t i = 0; i < c->n; i++) {
    const bool turns = c->row[i].turns;
    const CagVec3 v = turns ? cag_cross(axis[i], cag_sub(f.p, origin[i])) : axis[i];
    const CagVec3 w = turns ? axis[i] : cag_vec3(0, 0, 0);
    const double parts[6] = {v.x / c->reach, v.y / c->reach, v.z / c->reach, w.x, w.y, w.z};
    memcpy(column[i], parts, sizeof parts);
  }
  for (size_t i = 0; i < c->n; i++)
    for (size_t j = 0; j <= c->n; j++) {
      const double *other = j < c->n ? column[j] : e;
      m[i][j] = i == j ? DAMPING : 0;
      for (int k = 0; k < 6; k++) m[i][j] += column[i][k] * other[k];
    }
  if (!solve_normal(m, c->n)) return;
  for (size_t i = 0; i < c->n; i++) {
    q[i] += m[i][c->n] / m[i][i];
    if (c->row[i].turns) q[i] = inverse_wrapped(q[i]);
  }
}

static bool is_same(const InverseChain *c, const double *a, const double *b) {
  for (size_t i = 0; i < c->n; i++) {
    const double apart =
        c->row[i].turns ? fabs(remainder(a[i] - b[i], 2 * M_PI)) : fabs(a[i] - b[i]) / c->reach;
    if (apart > SAME_SOLUTION) return false;
  }
  return true;
}

void cag_inverse_keep(InverseTask *t, const double *found, CagConfiguration configuration,
                      unsigned free) {
  t->placed = true;
  CagInverse *out = t->out;
  double q[CAG_INVERSE_JOINTS_MAX];
  memcpy(q, found, t->chain->n * sizeof *q);
  if (out->count == CAG_INVERSE_SOLUTIONS_MAX) return;
  if (!t->exact) {
    for (int i = 0;
         i < MOST_STEPS && !reproduces(t, q, FINE_ERROR) && reproduces(t, q, ROUGH_ERROR); i++)
      improve(t, q);
    if (!reproduces(t, q, POSE_ERROR)) return;
  }
  for (size_t i = 0; i < out->count; i++)
    if (is_same(t->chain, out->solutions[i].q, q)) return;
  CagInverseSolution *s = &out->solutions[out->count++];
  memcpy(s->q, q, t->chain->n * sizeof *q);
  s->configuration = configuration;
  s->free = free;
  out->free |= free;
}

void cag_inverse_keep_point(InverseTask *t, CagVec3 point, CagVec3 w, const double *q,
                            CagConfiguration configuration, unsigned free) {
  CagRobotFrame f;
  forward(t->chain, q, &f);
  const CagVec3 at = cag_madd(cag_madd(cag_madd(f.p, point.x, f.x), point.y, f.y), point.z, f.z);
  if (cag_norm(cag_sub(at, w)) > POSE_ERROR * t->chain->reach) return;
  t->target = f;
  cag_inverse_keep(t, q, configuration, free);
}

// --- Wrists ---

// Joints 4, 5, and 6 for the pose of the tool in frame 3.
static void solve_wrist(InverseTask *t, const CagRobotFrame *seen, const InverseArm *arm) {
  const InverseRow *r4 = &t->chain->row[3], *r5 = &t->chain->row[4], *r6 = &t->chain->row[5];
  CagRobotFrame f = *seen;
  double q[6] = {arm->q[0], arm->q[1], arm->q[2]};
  CagConfiguration label = {arm->shoulder, arm->elbow, 0};
  cag_inverse_strip_crank(r6, &f);
  // Cosine between the last axis and axis 4: cos(alpha4) cos(alpha5) - sin(alpha4) sin(alpha5)
  // cos(theta5).
  const double cosine = (r4->cosine * r5->cosine - f.z.z) / (r4->sine * r5->sine);
  if (fabs(cosine) > 1 + POSE_ERROR) return;
  const double clamped = fmax(-1, fmin(1, cosine));
  const bool square = fabs(r4->cosine) < INVERSE_PARALLEL && fabs(r5->cosine) < INVERSE_PARALLEL;
  const double sine = square ? inverse_length(f.z.x, f.z.y) : sqrt(1 - clamped * clamped);
  const bool aligned = inverse_length(f.z.x, f.z.y) < INVERSE_NOTHING; // axes 4 and 6 coincide
  const bool folded = sine < INVERSE_NOTHING;                          // both branches coincide
  for (int sign = 1; sign >= (aligned || folded ? 1 : -1); sign -= 2) {
    const unsigned free = arm->free | (aligned ? 8u : 0);
    label.wrist = aligned || folded ? 0 : sign;
    if (sign < 0 && square) { // the same rotation with the opposite signs
      q[3] = inverse_wrapped(q[3] + M_PI);
      q[4] = inverse_value(r5, -inverse_theta(r5, q[4]));
      q[5] = inverse_wrapped(q[5] + M_PI);
      cag_inverse_keep(t, q, label, free);
      break;
    }
    const double theta5 = folded ? (clamped < 0 ? M_PI : 0) : atan2(sign * sine, clamped);
    const CagVec3 v =
        inverse_turn_x(cag_vec3(r5->sine * sin(theta5), -r5->sine * cos(theta5), r5->cosine),
                       r4->sine, r4->cosine);
    q[3] = aligned ? t->near[3] : inverse_value(r4, atan2(f.z.y, f.z.x) - atan2(v.y, v.x));
    q[4] = inverse_value(r5, theta5);
    CagRobotFrame g = f; // joint 6 takes the remainder, so that errors near `aligned` cancel
    cag_inverse_strip_left(r4, q[3], &g);
    cag_inverse_strip_left(r5, q[4], &g);
    q[5] = inverse_value(r6, atan2(g.x.y, g.x.x));
    cag_inverse_keep(t, q, label, free);
  }
}

// Joints 4 and 5: axis 5 sweeps a cone, on which the target must lie.
static void solve_pair(InverseTask *t, const CagRobotFrame *seen, const InverseArm *arm) {
  const InverseRow *r4 = &t->chain->row[3], *r5 = &t->chain->row[4];
  CagRobotFrame f = *seen;
  double q[5] = {arm->q[0], arm->q[1], arm->q[2]};
  cag_inverse_strip_crank(r5, &f);
  q[3] = inverse_value(r4, atan2(f.z.x * r4->sine, -f.z.y * r4->sine));
  cag_inverse_strip_left(r4, q[3], &f);
  q[4] = inverse_value(r5, atan2(f.x.y, f.x.x));
  cag_inverse_keep(t, q, (CagConfiguration){arm->shoulder, arm->elbow, 0}, arm->free);
}

static void solve_arm_point(InverseTask *t, CagVec3 point, CagVec3 w) {
  InverseArm arms[INVERSE_ARMS_MAX];
  const size_t n = cag_inverse_arms(t->chain, point, w, t->near, arms);
  for (size_t i = 0; i < n; i++)
    cag_inverse_keep_point(t, point, w, arms[i].q,
                           (CagConfiguration){arms[i].shoulder, arms[i].elbow, 0}, arms[i].free);
}

static void solve_arm(InverseTask *t, InverseKind kind) {
  const InverseChain *c = t->chain;
  CagRobotFrame f = t->target;
  const CagVec3 point = placed_point(c);
  if (kind == INVERSE_RRR)
    f.p = cag_madd(cag_madd(cag_madd(f.p, point.x, f.x), point.y, f.y), point.z, f.z);
  else cag_inverse_strip_crank(&c->row[c->n - 1], &f);
  InverseArm arms[INVERSE_ARMS_MAX];
  const size_t n = cag_inverse_arms(c, point, f.p, t->near, arms);
  t->placed = n > 0;
  for (size_t i = 0; i < n; i++) {
    CagRobotFrame seen = t->target;
    if (kind == INVERSE_RRR) {
      cag_inverse_keep(t, arms[i].q, (CagConfiguration){arms[i].shoulder, arms[i].elbow, 0},
                       arms[i].free);
      continue;
    }
    for (size_t k = 0; k < 3; k++) cag_inverse_strip_left(&c->row[k], arms[i].q[k], &seen);
    if (kind == INVERSE_ARM_WRIST) solve_wrist(t, &seen, &arms[i]);
    else solve_pair(t, &seen, &arms[i]);
  }
}

// --- Prismatic joints ---

// The displacement of the tool when prismatic joint k moves by 1, and the position of the tool at
// zero displacements, for given revolute joint values.
static void slide_system(const InverseTask *t, const double *q, CagVec3 *ways, CagVec3 *rest) {
  const InverseChain *c = t->chain;
  CagRobotFrame f = unit_frame;
  for (size_t i = 0; i < c->n; i++) {
    const InverseRow *r = &c->row[i];
    if (!r->turns) ways[i] = f.z;
    const CagRobotStage s = {.a = r->a, .sine = r->sine, .cosine = r->cosine, .shift = r->shift};
    const double theta = inverse_theta(r, r->turns ? q[i] : 0);
    cag_robot_advance(&f, &s, sin(theta), cos(theta), 0);
  }
  *rest = cag_sub(t->target.p, f.p);
}

// Displacements by least squares, in one, two, or three directions.
static void solve_slides(InverseTask *t, double *q, unsigned free) {
  const InverseChain *c = t->chain;
  CagVec3 ways[CAG_INVERSE_JOINTS_MAX], rest;
  slide_system(t, q, ways, &rest);
  double matrix[3][4];
  size_t joint[3], n = 0;
  for (size_t i = 0; i < c->n; i++)
    if (!c->row[i].turns) joint[n++] = i;
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++) matrix[i][j] = cag_dot(ways[joint[i]], ways[joint[j]]);
    matrix[i][n] = cag_dot(ways[joint[i]], rest);
  }
  for (size_t k = 0; k < n; k++) { // the matrix is positive definite unless directions are parallel
    if (fabs(matrix[k][k]) < INVERSE_PARALLEL) return;
    for (size_t i = 0; i < n; i++) {
      if (i == k) continue;
      const double factor = matrix[i][k] / matrix[k][k];
      for (size_t j = k; j <= n; j++) matrix[i][j] -= factor * matrix[k][j];
    }
  }
  for (size_t i = 0; i < n; i++) q[joint[i]] = matrix[i][n] / matrix[i][i];
  cag_inverse_keep(t, q, (CagConfiguration){0}, free);
}

// The constant rotations of rows from..to, as a frame.
static CagRobotFrame turns_of(const InverseChain *c, size_t from, const double *q) {
  CagRobotFrame f = unit_frame;
  for (size_t i = from; i < c->n; i++) {
    const InverseRow *r = &c->row[i];
    const double theta = inverse_theta(r, r->turns ? q[i] : 0);
    const CagRobotStage s = {.sine = r->sine, .cosine = r->cosine};
    cag_robot_advance(&f, &s, sin(theta), cos(theta), 0);
  }
  return f;
}

// One revolute and two prismatic joints: the orientation determines the revolute joint.
static void solve_rpp(InverseTask *t) {
  double q[CAG_INVERSE_JOINTS_MAX] = {-t->chain->row[0].angle};
  const CagRobotFrame c = turns_of(t->chain, 0, q), *g = &t->target;
  // target = Rot(z, theta) c: the rotation that brings c's columns closest to the target's.
  const double sine = c.x.x * g->x.y - c.x.y * g->x.x + c.y.x * g->y.y - c.y.y * g->y.x +
                      c.z.x * g->z.y - c.z.y * g->z.x;
  const double cosine = c.x.x * g->x.x + c.x.y * g->x.y + c.y.x * g->y.x + c.y.y * g->y.y +
                        c.z.x * g->z.x + c.z.y * g->z.y;
  q[0] = inverse_value(&t->chain->row[0], atan2(sine, cosine));
  solve_slides(t, q, 0);
}

// Two revolute joints and a prismatic one: the orientation determines both revolute joints.
static void solve_rrp(InverseTask *t) {
  const InverseRow *r1 = &t->chain->row[0], *r2 = &t->chain->row[1];
  double q[CAG_INVERSE_JOINTS_MAX] = {0};
  CagRobotFrame f = t->target;
  // target = Rot(z, theta1) Rot(x, alpha1) Rot(z, theta2) c, where c is the rest of the chain.
  const double none[CAG_INVERSE_JOINTS_MAX] = {0};
  CagRobotFrame c = turns_of(t->chain, 2, none);
  const CagRobotStage twist = {.sine = r2->sine, .cosine = r2->cosine};
  CagRobotFrame m = unit_frame;
  cag_robot_advance(&m, &twist, 0, 1, 0);
  const CagVec3 columns[] = {c.x, c.y, c.z};
  CagVec3 all[3];
  for (int i = 0; i < 3; i++)
    all[i] =
        cag_madd(cag_madd(cag_scaled(m.x, columns[i].x), columns[i].y, m.y), columns[i].z, m.z);
  // f c^-1: its columns are sums over the target's columns.
  const CagVec3 target[] = {f.x, f.y, f.z};
  CagVec3 w[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  for (int i = 0; i < 3; i++) {
    w[0] = cag_madd(w[0], all[i].x, target[i]);
    w[1] = cag_madd(w[1], all[i].y, target[i]);
    w[2] = cag_madd(w[2], all[i].z, target[i]);
  }
  f = (CagRobotFrame){w[0], w[1], w[2], {0, 0, 0}};
  q[0] = inverse_value(r1, atan2(f.z.x * r1->sine, -f.z.y * r1->sine));
  InverseRow turn = *r1;
  turn.a = turn.shift = 0;
  cag_inverse_strip_left(&turn, q[0], &f);
  q[1] = inverse_value(r2, atan2(f.x.y, f.x.x));
  solve_slides(t, q, 0);
}

// --- Complete inverse ---

static int rank_of(const CagInverseSolution *s) {
  const CagConfiguration *c = &s->configuration;
  return 9 * c->shoulder + 3 * c->elbow + c->wrist;
}

// Sorts branches of +1 first.
static void sort_solutions(CagInverse *out) {
  for (size_t i = 1; i < out->count; i++)
    for (size_t j = i; j > 0 && rank_of(&out->solutions[j]) > rank_of(&out->solutions[j - 1]);
         j--) {
      const CagInverseSolution s = out->solutions[j];
      out->solutions[j] = out->solutions[j - 1];
      out->solutions[j - 1] = s;
    }
}

// The result for a robot without a closed form: no solutions.
static void clear_solutions(CagInverse *out) {
  out->count = 0;
  out->free = 0;
  out->status = CAG_INVERSE_NO_CLOSED_FORM;
}

static InverseTask begin_task(const InverseChain *c, const double *near, CagInverse *out) {
  static const double zeros[CAG_INVERSE_JOINTS_MAX] = {0};
  return (InverseTask){.chain = c, .near = near ? near : zeros, .out = out};
}

// Sorts the solutions. `none` is the status if there are none.
static void end_task(CagInverse *out, CagInverseStatus none) {
  sort_solutions(out);
  out->status = out->count == 0 ? none : out->free ? CAG_INVERSE_SINGULAR : CAG_INVERSE_OK;
}

void cag_robot_inverse(const CagRobot *r, const CagTransform *target, const double *near,
                       CagInverse *out) {
  clear_solutions(out);
  InverseChain c;
  const InverseKind kind = chain_of(r, &c) ? kind_of(&c) : INVERSE_NONE;
  if (kind == INVERSE_NONE) return;
  InverseTask t = begin_task(&c, near, out);
  const CagTransform before = cag_robot_rigid_inverse(&c.before);
  const CagTransform after = cag_robot_rigid_inverse(&c.after);
  CagTransform pose = cag_transform_multiply(&before, target);
  pose = cag_transform_multiply(&pose, &after);
  cag_robot_frame_from(&pose, &t.target);
  t.exact =
      kind == INVERSE_PARALLEL_6 || (kind == INVERSE_ARM_WRIST && cag_inverse_arm_is_exact(&c));
  switch (kind) {
  case INVERSE_ARM_WRIST:
  case INVERSE_ARM_PAIR:
  case INVERSE_RRR: solve_arm(&t, kind); break;
  case INVERSE_PARALLEL_6:
  case INVERSE_PARALLEL_5: cag_inverse_parallel(&t); break;
  case INVERSE_PLANE: cag_inverse_plane(&t); break;
  case INVERSE_RRP: solve_rrp(&t); break;
  case INVERSE_RPP: solve_rpp(&t); break;
  case INVERSE_PPP: solve_slides(&t, (double[CAG_INVERSE_JOINTS_MAX]){0}, 0); break;
  case INVERSE_NONE: break;
  }
  for (size_t i = 0; i < out->count && (kind == INVERSE_ARM_PAIR || kind == INVERSE_RRR); i++)
    cag_robot_configuration(r, out->solutions[i].q, &out->solutions[i].configuration);
  end_task(out, t.placed && c.n < 6 ? CAG_INVERSE_ORIENTATION : CAG_INVERSE_UNREACHABLE);
}

static bool has_point_inverse(const InverseChain *c) {
  const InverseKind kind = kind_of(c);
  return kind == INVERSE_RRR || (kind == INVERSE_PLANE && cag_inverse_plane_turns(c) <= 2);
}

bool cag_robot_has_point_inverse(const CagRobot *r) {
  InverseChain c;
  return chain_of(r, &c) && has_point_inverse(&c);
}

void cag_robot_inverse_point(const CagRobot *r, CagVec3 point, const double *near,
                             CagInverse *out) {
  clear_solutions(out);
  InverseChain c;
  if (!chain_of(r, &c) || !has_point_inverse(&c)) return;
  InverseTask t = begin_task(&c, near, out);
  const CagTransform before = cag_robot_rigid_inverse(&c.before);
  const CagVec3 w = cag_transform_point(&before, point);
  const double(*m)[4] = c.after.m;
  const CagVec3 tip = cag_vec3(m[0][3], m[1][3], m[2][3]);
  if (kind_of(&c) == INVERSE_PLANE) cag_inverse_plane_point(&t, tip, w);
  else solve_arm_point(&t, tip, w);
  end_task(out, CAG_INVERSE_UNREACHABLE);
}

CagConfiguration cag_robot_branches(const CagRobot *r) {
  InverseChain c;
  switch (chain_of(r, &c) ? kind_of(&c) : INVERSE_NONE) {
  case INVERSE_ARM_WRIST: return (CagConfiguration){1, c.row[2].turns, 1};
  case INVERSE_ARM_PAIR:
  case INVERSE_RRR: return (CagConfiguration){1, c.row[2].turns, 0};
  case INVERSE_PARALLEL_6: return (CagConfiguration){1, 1, 1};
  case INVERSE_PARALLEL_5: return (CagConfiguration){1, 1, 0};
  case INVERSE_PLANE: return (CagConfiguration){0, cag_inverse_plane_turns(&c) >= 2, 0};
  default: return (CagConfiguration){0};
  }
}

bool cag_robot_configuration(const CagRobot *r, const double *q, CagConfiguration *out) {
  InverseChain c;
  const InverseKind kind = chain_of(r, &c) ? kind_of(&c) : INVERSE_NONE;
  *out = (CagConfiguration){0};
  switch (kind) {
  case INVERSE_NONE: return false;
  case INVERSE_ARM_WRIST:
  case INVERSE_ARM_PAIR:
  case INVERSE_RRR: {
    cag_inverse_arm_labels(&c, placed_point(&c), q, &out->shoulder, &out->elbow);
    const double sine = kind == INVERSE_ARM_WRIST ? sin(inverse_theta(&c.row[4], q[4])) : 0;
    if (kind == INVERSE_ARM_WRIST) out->wrist = sine < 0 ? -1 : 1;
    break;
  }
  case INVERSE_PARALLEL_6:
  case INVERSE_PARALLEL_5: cag_inverse_parallel_labels(&c, q, out); break;
  case INVERSE_PLANE: cag_inverse_plane_labels(&c, q, out); break;
  default: break;
  }
  return true;
}
