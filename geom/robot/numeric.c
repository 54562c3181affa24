// Numerical inverse kinematics.
//
// The error of a pose is six dimensionless numbers: the displacement to the target divided by a
// length of the chain, and the remaining rotation vector. A step solves the damped normal equations
//
//     (J J^T + damping I) y = e,   dq = J^T y
//
// of size 6 for any number of joints, by an LDL^T factorization. The damping is proportional to the
// squared error (Sugihara 2011): far from a solution steps are cautious, near one they are Newton
// steps. Joints that would violate their limits are fixed at them, and the remaining error is
// distributed over the others. An attempt that no longer makes progress is abandoned early, since a
// fresh start is cheaper.

#include "geom/robot/numeric.h"

#include "geom/robot/kernel.h"

// Default limit of steps over all starts: a few milliseconds.
#define STEPS_DEFAULT 8000
// Damping relative to the squared error, and its minimum.
#define DAMPING 0.1
#define DAMPING_LEAST 1e-12
// Largest step of a revolute joint, radians.
#define STEP_MAX 1.0
// An attempt is abandoned if the squared error has not fallen to this fraction in this many steps.
#define PATIENCE 6
#define PROGRESS 0.7
// Steps that refine a solution to rounding accuracy.
#define POLISH_STEPS 6
// Steps for converging to the closest pose to an unreachable target.
#define DESCENT_STEPS 400

typedef struct Problem {
  const CagRobot *r;
  size_t n;
  double low[CAG_ROBOT_JOINTS_MAX], high[CAG_ROBOT_JOINTS_MAX];
  double unit[CAG_ROBOT_JOINTS_MAX]; // change of each joint that counts as one: a radian, or the
                                     // length
  CagRobotFrame target;
  double length; // equivalent of one radian
  double position, rotation;
  size_t rows; // 6, or 3 for positions alone
} Problem;

// The chain at given joint values.
typedef struct State {
  double q[CAG_ROBOT_JOINTS_MAX];
  double columns[CAG_ROBOT_JOINTS_MAX][6]; // of the Jacobian, in the problem's units
  double error[6];
  double square; // squared norm of the error
  double position, rotation;
} State;

// --- Errors ---

// Rotation vector from the axes of `from` to those of `to`.
static CagVec3 turn_between(const CagRobotFrame *from, const CagRobotFrame *to) {
  // The sum of cross products is 2 sin(t) k, the sum of dot products 1 + 2 cos(t).
  CagVec3 s = cag_add(cag_add(cag_cross(from->x, to->x), cag_cross(from->y, to->y)),
                      cag_cross(from->z, to->z));
  double cosine = cag_dot(from->x, to->x) + cag_dot(from->y, to->y) + cag_dot(from->z, to->z) - 1;
  double sine = cag_norm(s);
  const double nearly_none = 1e-5, nearly_half = 1e-4;
  if (cosine > 0 && sine < nearly_none) return cag_scaled(s, 0.5);
  double angle = atan2(sine, cosine);
  if (sine > nearly_half) return cag_scaled(s, angle / sine);
  // Nearly a half turn: to + from of each axis is along k; use the longest sum.
  CagVec3 sums[3] = {cag_add(from->x, to->x), cag_add(from->y, to->y), cag_add(from->z, to->z)};
  CagVec3 k = sums[0];
  for (int i = 1; i < 3; i++)
    if (cag_dot(sums[i], sums[i]) > cag_dot(k, k)) k = sums[i];
  k = cag_unit(k);
  return cag_scaled(k, cag_dot(k, s) < 0 ? -angle : angle);
}

static void set_error(const Problem *p, const CagRobotFrame *f, State *s) {
  CagVec3 way = cag_sub(p->target.p, f->p);
  s->position = cag_norm(way);
  s->error[0] = way.x / p->length;
  s->error[1] = way.y / p->length;
  s->error[2] = way.z / p->length;
  s->square = cag_dot(way, way) / (p->length * p->length);
  s->rotation = 0;
  s->error[3] = s->error[4] = s->error[5] = 0;
  if (p->rows == 3) return;
  CagVec3 turn = turn_between(f, &p->target);
  s->error[3] = turn.x;
  s->error[4] = turn.y;
  s->error[5] = turn.z;
  double square = cag_dot(turn, turn);
  s->rotation = sqrt(square);
  s->square += square;
}

static bool content(const Problem *p, const State *s) {
  return s->position <= p->position && s->rotation <= p->rotation;
}

// Fills the columns and the error for s->q.
static void evaluate(const Problem *p, State *s) {
  const CagRobot *r = p->r;
  CagRobotTurns turns;
  CagRobotFrame f;
  CagVec3 origins[CAG_ROBOT_JOINTS_MAX], axes[CAG_ROBOT_JOINTS_MAX];
  cag_robot_turns(r, s->q, &turns);
  cag_robot_frame_from(&r->before, &f);
  for (size_t i = 0; i < p->n; i++) {
    origins[i] = f.p;
    axes[i] = f.z;
    cag_robot_advance(&f, &r->stages[i], turns.sine[i], turns.cosine[i], s->q[i]);
  }
  for (size_t i = 0; i < p->n; i++) {
    double turn = r->stages[i].turn * p->unit[i], slide = r->stages[i].slide * p->unit[i];
    CagVec3 z = axes[i];
    CagVec3 v = cag_scaled(cag_cross(z, cag_sub(f.p, origins[i])), turn);
    v = cag_scaled(cag_madd(v, slide, z), 1 / p->length);
    double *c = s->columns[i];
    c[0] = v.x;
    c[1] = v.y;
    c[2] = v.z;
    c[3] = p->rows == 3 ? 0 : turn * z.x;
    c[4] = p->rows == 3 ? 0 : turn * z.y;
    c[5] = p->rows == 3 ? 0 : turn * z.z;
  }
  set_error(p, &f, s);
}

// --- One step ---

// Solves (M + damping I) y = e for the symmetric 6 x 6 matrix whose lower part is given, as
// L D L^T; M is overwritten.
static void solve_six(double m[6][6], double damping, const double e[6], double y[6]) {
  double inverse[6];
  for (int k = 0; k < 6; k++) {
    double d = m[k][k] + damping, scaled[6];
    for (int j = 0; j < k; j++) {
      scaled[j] = m[k][j] * m[j][j];
      d -= m[k][j] * scaled[j];
    }
    // The rounding of a singular matrix must not fall below the damping.
    d = d > damping ? d : damping;
    m[k][k] = d;
    inverse[k] = 1 / d;
    for (int i = k + 1; i < 6; i++) {
      double sum = m[i][k];
      for (int j = 0; j < k; j++) sum -= m[i][j] * scaled[j];
      m[i][k] = sum * inverse[k];
    }
  }
  for (int k = 0; k < 6; k++) {
    y[k] = e[k];
    for (int j = 0; j < k; j++) y[k] -= m[k][j] * y[j];
  }
  for (int k = 5; k >= 0; k--) {
    y[k] *= inverse[k];
    for (int j = k + 1; j < 6; j++) y[k] -= m[j][k] * y[j];
  }
}

// Lower part of the sum of c c^T over the free joints.
static void add_products(const State *s, const bool *held, size_t n, double m[6][6]) {
  memset(m, 0, 36 * sizeof(double));
  for (size_t i = 0; i < n; i++) {
    if (held[i]) continue;
    const double *c = s->columns[i];
    for (int a = 0; a < 6; a++)
      for (int b = 0; b <= a; b++) m[a][b] += c[a] * c[b];
  }
}

static double dot_six(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
}

// The step from s within the limits, into `step` (values of q). Returns false if no joint can move.
static bool find_step(const Problem *p, const State *s, double damping, double *step) {
  const size_t rounds = 4; // of fixing joints at their limits
  bool held[CAG_ROBOT_JOINTS_MAX] = {0};
  double rest[6], m[6][6], y[6], largest = 0;
  memcpy(rest, s->error, sizeof rest);
  for (size_t round = 0;; round++) {
    bool more = false;
    add_products(s, held, p->n, m);
    solve_six(m, damping, rest, y);
    for (size_t i = 0; i < p->n; i++) {
      if (held[i]) continue;
      step[i] = dot_six(s->columns[i], y) * p->unit[i];
      double to = s->q[i] + step[i];
      if (to >= p->low[i] && to <= p->high[i]) continue;
      step[i] = (to < p->low[i] ? p->low[i] : p->high[i]) - s->q[i];
      if (round == rounds) continue;
      held[i] = more = true;
      for (int k = 0; k < 6; k++) rest[k] -= s->columns[i][k] * step[i] / p->unit[i];
    }
    if (!more) break;
  }
  for (size_t i = 0; i < p->n; i++) largest = fmax(largest, fabs(step[i] / p->unit[i]));
  if (largest > STEP_MAX)
    for (size_t i = 0; i < p->n; i++) step[i] *= STEP_MAX / largest;
  return largest > 0;
}

static void take_step(const Problem *p, const State *s, const double *step, State *next) {
  for (size_t i = 0; i < p->n; i++)
    next->q[i] = fmin(fmax(s->q[i] + step[i], p->low[i]), p->high[i]);
  evaluate(p, next);
}

// --- Attempts ---

// Iterates from s->q, which must be evaluated; the best state is left in s.
static bool attempt(const Problem *p, State *s, size_t steps_max, size_t *steps) {
  State other, *at = s, *next = &other;
  double step[CAG_ROBOT_JOINTS_MAX], marked = s->square;
  size_t since = 0;
  while (!content(p, at) && *steps < steps_max) {
    double damping = DAMPING * at->square + DAMPING_LEAST;
    if (!find_step(p, at, damping, step)) break;
    take_step(p, at, step, next);
    ++*steps;
    State *swap = at;
    at = next;
    next = swap;
    if (++since < PATIENCE) continue;
    if (at->square > PROGRESS * marked) break;
    marked = at->square;
    since = 0;
  }
  if (at != s) *s = *at;
  return content(p, s);
}

// Newton steps as long as they help.
static void polish(const Problem *p, State *s) {
  State next;
  double step[CAG_ROBOT_JOINTS_MAX];
  for (int k = 0; k < POLISH_STEPS; k++) {
    if (!find_step(p, s, DAMPING_LEAST, step)) return;
    take_step(p, s, step, &next);
    if (!(next.square < 0.25 * s->square)) {
      if (next.square < s->square) *s = next;
      return;
    }
    *s = next;
  }
}

// Minimizes the error of a target that cannot be reached, by the Levenberg-Marquardt method: the
// damping is reduced after a successful step and raised after a failed one.
static void descend(const Problem *p, State *s, double damping_start, size_t steps_max) {
  const double raise = 4, lower = 0.3, most = 1e8, still = 1e-15;
  State next;
  double step[CAG_ROBOT_JOINTS_MAX], damping = damping_start;
  for (size_t k = 0; k < steps_max && damping < most; k++) {
    if (!find_step(p, s, damping, step)) return;
    take_step(p, s, step, &next);
    if (next.square < s->square) {
      bool done = s->square - next.square <= still * s->square;
      *s = next;
      damping = fmax(damping * lower, DAMPING_LEAST);
      if (done) return;
    } else {
      damping *= raise;
    }
  }
}

// Solves n equations with a symmetric matrix (the lower part is overwritten) by Cholesky
// factorization. False: it is not positive definite.
static bool solve_definite(double m[][CAG_ROBOT_JOINTS_MAX], size_t n, double *x) {
  for (size_t k = 0; k < n; k++) {
    for (size_t j = 0; j < k; j++) m[k][k] -= m[k][j] * m[k][j];
    if (!(m[k][k] > 0)) return false;
    m[k][k] = sqrt(m[k][k]);
    for (size_t i = k + 1; i < n; i++) {
      for (size_t j = 0; j < k; j++) m[i][k] -= m[i][j] * m[k][j];
      m[i][k] /= m[k][k];
    }
  }
  for (size_t k = 0; k < n; k++) {
    for (size_t j = 0; j < k; j++) x[k] -= m[k][j] * x[j];
    x[k] /= m[k][k];
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t j = k + 1; j < n; j++) x[k] -= m[j][k] * x[j];
    x[k] /= m[k][k];
  }
  return true;
}

// The gradient of half the squared error, in the problem's units. It is exact for the rotation
// vector, which is along the axis of the remaining rotation.
static double gradient(const State *s, size_t joint) {
  return -dot_six(s->columns[joint], s->error);
}

// Second derivatives of half the squared error over the free joints, from differences of the
// gradient; the lower part.
static void second_derivatives(const Problem *p, const State *s, const size_t *free, size_t n,
                               double m[][CAG_ROBOT_JOINTS_MAX]) {
  const double h = 1e-5; // the error of the differences, h squared, is below their rounding, 1e-16
                         // / h
  State sides[2];
  for (size_t k = 0; k < n; k++) {
    for (int side = 0; side < 2; side++) {
      memcpy(sides[side].q, s->q, p->n * sizeof *s->q);
      sides[side].q[free[k]] += (side ? h : -h) * p->unit[free[k]];
      evaluate(p, &sides[side]);
    }
    for (size_t i = k; i < n; i++)
      m[i][k] = (gradient(&sides[1], free[i]) - gradient(&sides[0], free[i])) / (2 * h);
  }
}

// Converges to the closest pose. If a target is unreachable, the second derivatives of the
// remaining error matter as much as the Jacobian, and the steps above, which neglect them, converge
// slowly; these are full Newton steps, damped until they help, within the limits.
static void rest_nearest(const Problem *p, State *s) {
  const int rounds = 100;
  const double raise = 8, lower = 0.1, most = 1e8, still = 1e-14;
  double m[CAG_ROBOT_JOINTS_MAX][CAG_ROBOT_JOINTS_MAX], x[CAG_ROBOT_JOINTS_MAX], damping = 1e-3;
  double step[CAG_ROBOT_JOINTS_MAX];
  State next;
  for (int round = 0; round < rounds && damping < most; round++) {
    size_t free[CAG_ROBOT_JOINTS_MAX], n = 0;
    double steep = 0;
    for (size_t i = 0; i < p->n; i++) {
      const double g = gradient(s, i);
      step[i] = 0;
      if ((s->q[i] <= p->low[i] && g > 0) || (s->q[i] >= p->high[i] && g < 0)) continue;
      free[n++] = i;
      steep = fmax(steep, fabs(g));
    }
    if (!(steep > still * s->square)) return;
    second_derivatives(p, s, free, n, m);
    for (size_t k = 0; k < n; k++) m[k][k] += damping, x[k] = -gradient(s, free[k]);
    if (!solve_definite(m, n, x)) {
      damping *= raise;
      continue;
    }
    for (size_t k = 0; k < n; k++)
      step[free[k]] = fmax(-STEP_MAX, fmin(STEP_MAX, x[k])) * p->unit[free[k]];
    take_step(p, s, step, &next);
    if (next.square < s->square) {
      *s = next;
      damping = fmax(damping * lower, DAMPING_LEAST);
    } else {
      damping *= raise;
    }
  }
}

// --- Redundancy ---

// The part of `rates` (in the problem's units) that does not move the tool; held joints do not
// move.
static void project(const Problem *p, const State *s, const bool *held, const double *rates,
                    double *out) {
  double m[6][6], moved[6] = {0}, y[6];
  for (size_t i = 0; i < p->n; i++)
    for (int k = 0; k < 6 && !held[i]; k++) moved[k] += s->columns[i][k] * rates[i];
  add_products(s, held, p->n, m);
  solve_six(m, DAMPING_LEAST, moved, y);
  for (size_t i = 0; i < p->n; i++) out[i] = held[i] ? 0 : rates[i] - dot_six(s->columns[i], y);
}

// Squared distance of joint values, in the problem's units.
static double apart(const Problem *p, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < p->n; i++) {
    double d = (a[i] - b[i]) / p->unit[i];
    sum += d * d;
  }
  return sum;
}

// Moves a solution towards `near` along motions that do not move the tool.
static void approach_near(const Problem *p, State *s, const double *near) {
  const double widest = 0.3, gain_least = 1e-9, share_least = 1.0 / 64;
  const int rounds = 60;
  double share = 1, want[CAG_ROBOT_JOINTS_MAX] = {0}, step[CAG_ROBOT_JOINTS_MAX];
  State next;
  for (int round = 0; round < rounds && share > share_least; round++) {
    bool held[CAG_ROBOT_JOINTS_MAX];
    double largest = 0, before = apart(p, s->q, near);
    for (size_t i = 0; i < p->n; i++) {
      want[i] = (near[i] - s->q[i]) / p->unit[i];
      held[i] = (s->q[i] <= p->low[i] && want[i] < 0) || (s->q[i] >= p->high[i] && want[i] > 0);
    }
    project(p, s, held, want, step);
    for (size_t i = 0; i < p->n; i++) largest = fmax(largest, fabs(step[i]));
    double scale = share * (largest > widest ? widest / largest : 1);
    for (size_t i = 0; i < p->n; i++) step[i] *= scale * p->unit[i];
    take_step(p, s, step, &next);
    polish(p, &next);
    double gain = before - apart(p, next.q, near);
    if (content(p, &next) && gain > 0) {
      *s = next;
      if (gain < gain_least * before) return;
    } else {
      share /= 2;
    }
  }
}

// --- Starts ---

// The generalized golden ratio of dimension n: the root above 1 of x^(n+1) = x + 1.
static double golden(size_t n) {
  double x = 1.5;
  for (int k = 0; k < 60; k++) {
    double power = 1;
    for (size_t i = 0; i < n; i++) power *= x;
    x -= (power * x - x - 1) / ((double)(n + 1) * power - 1);
  }
  return x;
}

// The additive recurrence of powers of the golden ratio (Roberts 2018), which fills a box of any
// dimension evenly.
static void sequence(const Problem *p, double ratio, size_t k, double *q) {
  double power = 1;
  for (size_t i = 0; i < p->n; i++) {
    power /= ratio;
    double x = 0.5 + (double)k * power;
    q[i] = p->low[i] + (x - floor(x)) * (p->high[i] - p->low[i]);
  }
}

static void set_limits(Problem *p) {
  for (size_t i = 0; i < p->n; i++) {
    const CagRobotLink *l = &p->r->links[p->r->joint_link[i]];
    p->low[i] = l->low;
    p->high[i] = l->high;
    p->unit[i] = l->kind == CAG_JOINT_REVOLUTE ? 1 : p->length;
  }
}

void cag_robot_sequence(const CagRobot *r, size_t k, double *q) {
  Problem p = {.r = r, .n = r->joint_count, .length = 1};
  set_limits(&p);
  sequence(&p, golden(p.n), k, q);
}

// --- The search ---

CagRobotFound cag_robot_search(const CagRobot *r, const CagTransform *target,
                               const CagRobotSearch *search, double *q) {
  Problem p = {.r = r,
               .n = r->joint_count,
               .length = r->reach,
               .position = search->position > 0 ? search->position : 1e-9 * r->reach,
               .rotation = search->rotation > 0 ? search->rotation : 1e-9,
               .rows = search->position_only ? 3 : 6};
  double near[CAG_ROBOT_JOINTS_MAX], ratio = golden(p.n);
  size_t most = search->steps ? search->steps : STEPS_DEFAULT, steps = 0, left = 0;
  State s, best;
  bool found = false;
  set_limits(&p);
  cag_robot_frame_from(target, &p.target);
  if (search->near) memcpy(near, search->near, p.n * sizeof *near);
  else cag_robot_home(r, near);
  for (size_t i = 0; i < p.n; i++) s.q[i] = fmin(fmax(near[i], p.low[i]), p.high[i]);
  for (size_t k = 0; k == 0 || (steps < most && k != search->starts); k++) {
    if (k > 0) sequence(&p, ratio, k, s.q);
    evaluate(&p, &s);
    bool solved = attempt(&p, &s, most, &steps);
    if (solved) cag_robot_into_limits(r, near, s.q); // by whole turns towards `near`
    bool better = k == 0 || (solved && !found) ||
                  (solved == found && (solved ? apart(&p, s.q, near) < apart(&p, best.q, near)
                                              : s.square < best.square));
    if (better) best = s;
    if (solved && !found) left = search->alternatives;
    else if (found && left > 0) left--;
    found = found || solved;
    if ((found && left == 0) || p.n == 0) break;
  }
  if (!found && (search->starts != 1 || search->closest)) {
    descend(&p, &best, DAMPING * best.square + DAMPING_LEAST, DESCENT_STEPS);
    rest_nearest(&p, &best);
  }
  if (found || (search->starts == 1 && !search->closest)) polish(&p, &best);
  if (found && search->stay_near && p.n > p.rows) approach_near(&p, &best, near);
  memcpy(q, best.q, p.n * sizeof *q);
  return (CagRobotFound){content(&p, &best), best.position, best.rotation, steps};
}

// --- Distances and free motion ---

void cag_robot_pose_distance(const CagTransform *a, const CagTransform *b, double *position,
                             double *rotation) {
  CagRobotFrame f, g;
  cag_robot_frame_from(a, &f);
  cag_robot_frame_from(b, &g);
  *position = cag_norm(cag_sub(f.p, g.p));
  *rotation = cag_norm(turn_between(&f, &g));
}

void cag_robot_null_motion(const CagRobot *r, const double *q, const double *dq, double *out) {
  Problem p = {.r = r, .n = r->joint_count, .length = r->reach, .rows = 6};
  State s;
  const bool held[CAG_ROBOT_JOINTS_MAX] = {0};
  double rates[CAG_ROBOT_JOINTS_MAX] = {0};
  set_limits(&p);
  cag_robot_frame_from(&r->before, &p.target); // the error is not used
  memcpy(s.q, q, p.n * sizeof *q);
  evaluate(&p, &s);
  for (size_t i = 0; i < p.n; i++) rates[i] = dq[i] / p.unit[i];
  // The second projection squares the residue that damping leaves.
  project(&p, &s, held, rates, out);
  project(&p, &s, held, out, rates);
  for (size_t i = 0; i < p.n; i++) out[i] = rates[i] * p.unit[i];
}
