// Joint paths: the solution for each pose is searched from the previous one, in steps so small that
// a change of branch cannot go unnoticed.

#include "geom/robot/path.h"

#include <stdlib.h>
#include <string.h>

#include "geom/robot/inverse.h"
#include "geom/robot/kernel.h"

#define TOLERANCE_DEFAULT 1e-6
// Number of further starts for solutions nearer to the wanted joint values.
#define ALTERNATIVES 24
// Largest step of a joint that counts as continuous: radians, or a fraction of the reach.
#define CONTINUOUS 0.5
// If the joints still jump over this fraction of the motion, the jump is real.
#define SHORTEST (1.0 / 4096)

// --- One pose ---

static CagStatus fail_unreachable(const CagRobotFound *found, bool position_only, CagError *err) {
  char angle[64] = "";
  if (!position_only) snprintf(angle, sizeof angle, " and %.6g deg", found->rotation * 180 / M_PI);
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_unreachable, "T", -1,
                  "no joint values within the limits reach the pose; the closest found is %.6g "
                  "mm%s away",
                  found->position, angle);
}

static bool is_wanted(int wanted, int is) { return !wanted || !is || wanted == is; }

// The squared distance of joint values a and b, in radians and fractions of the reach.
static double joint_way(const CagRobot *r, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < r->joint_count; i++) {
    double move = b[i] - a[i];
    if (r->links[r->joint_link[i]].kind != CAG_JOINT_REVOLUTE) move /= r->reach;
    sum += move * move;
  }
  return sum;
}

// The closed-form solution of the wanted branch within the limits that is nearest to `near`; false
// if there is none.
static bool solve_closed(const CagRobot *r, const CagTransform *target, const CagRobotGoal *goal,
                         const double *near, double *q) {
  CagInverse all;
  double nearest = INFINITY;
  const double(*m)[4] = target->m;
  if (goal->position_only)
    cag_robot_inverse_point(r, cag_vec3(m[0][3], m[1][3], m[2][3]), near, &all);
  else cag_robot_inverse(r, target, near, &all);
  for (size_t i = 0; i < all.count; i++) {
    CagInverseSolution *s = &all.solutions[i];
    const CagConfiguration *c = &s->configuration;
    if (!is_wanted(goal->shoulder, c->shoulder) || !is_wanted(goal->elbow, c->elbow) ||
        !is_wanted(goal->wrist, c->wrist) || !cag_robot_into_limits(r, near, s->q))
      continue;
    const double way = joint_way(r, near, s->q);
    if (way >= nearest) continue;
    nearest = way;
    memcpy(q, s->q, r->joint_count * sizeof *q);
  }
  return nearest < INFINITY;
}

// A requested branch must be one that the arm distinguishes.
static CagStatus check_branches(const CagRobot *r, const CagRobotGoal *goal, bool closed,
                                CagError *err) {
  const CagConfiguration has = cag_robot_branches(r);
  const int wanted[] = {goal->shoulder, goal->elbow, goal->wrist};
  const int there[] = {has.shoulder, has.elbow, has.wrist};
  static const char *const names[] = {"shoulder", "elbow", "wrist"};
  for (int i = 0; i < 3; i++) {
    if (!wanted[i]) continue;
    if (!closed)
      return cag_fail(
          err, CAG_E_UNSUPPORTED, CAG_ERR_no_closed_form, "config", -1,
          goal->position_only && cag_robot_has_inverse(r)
              ? "a point does not determine the tool's orientation, so its branches are "
                "undefined; give a pose, or choose by `near`"
              : "the arm has no closed form, so its branches are undefined; choose by "
                "`near`");
    if (!there[i])
      return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_closed_form, "config", -1,
                      "the arm has no choice of `%s`; `ik_all` lists its branches", names[i]);
  }
  return CAG_OK;
}

CagStatus cag_robot_solve(const CagRobot *r, const CagTransform *target, const CagRobotGoal *goal,
                          double *q, CagRobotFound *found, CagError *err) {
  double home[CAG_ROBOT_JOINTS_MAX];
  const bool closed =
      goal->position_only ? cag_robot_has_point_inverse(r) : cag_robot_has_inverse(r);
  const bool branch = goal->shoulder || goal->elbow || goal->wrist;
  *found = (CagRobotFound){0};
  cag_robot_home(r, home);
  CagStatus status = check_branches(r, goal, closed, err);
  if (status) return status;
  if (closed && solve_closed(r, target, goal, goal->near ? goal->near : home, q)) {
    CagTransform pose;
    *found = (CagRobotFound){.solved = true};
    cag_robot_forward(r, q, &pose);
    cag_robot_pose_distance(&pose, target, &found->position, &found->rotation);
    if (goal->position_only) found->rotation = 0;
    return CAG_OK;
  }
  double tolerance = goal->tolerance > 0 ? goal->tolerance : TOLERANCE_DEFAULT;
  CagRobotSearch search = {.near = goal->near,
                           .position = tolerance,
                           .rotation = tolerance,
                           .position_only = goal->position_only,
                           .alternatives = ALTERNATIVES,
                           .stay_near = true};
  *found = cag_robot_search(r, target, &search, q);
  if (branch && found->solved)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_unreachable, "config", -1,
                    "the pose is reached, but not in this branch within the limits; `ik_all` lists "
                    "the branches");
  return found->solved ? CAG_OK : fail_unreachable(found, goal->position_only, err);
}

// --- Steps ---

// The largest change of a joint from a to b, in radians or fractions of the reach.
static double largest_move(const CagRobot *r, const double *a, const double *b) {
  double largest = 0;
  for (size_t i = 0; i < r->joint_count; i++) {
    double move = fabs(b[i] - a[i]);
    if (r->links[r->joint_link[i]].kind != CAG_JOINT_REVOLUTE) move /= r->reach;
    largest = fmax(largest, move);
  }
  return largest;
}

// The solution that Newton's method converges to from `from`.
static bool solve_near(const CagRobot *r, const CagTransform *target, bool position_only,
                       const double *from, double *q) {
  CagRobotSearch search = {.near = from,
                           .position = TOLERANCE_DEFAULT,
                           .rotation = TOLERANCE_DEFAULT,
                           .position_only = position_only,
                           .starts = 1,
                           .steps = 100};
  return cag_robot_search(r, target, &search, q).solved;
}

typedef enum Tracked { ARRIVED, LEFT, JUMPED } Tracked;

// Follows the motion from pose a (reached at q) to b, updating q. `done` is the fraction that was
// completed.
static Tracked track(const CagRobot *r, const CagTransform *a, const CagTransform *b,
                     bool position_only, double *q, double *done, CagError *err) {
  double t = 0, h = 1, next[CAG_ROBOT_JOINTS_MAX];
  while (t < 1) {
    CagTransform pose;
    if (cag_transform_mix(a, b, t + h, &pose, err)) pose = *b;
    bool solved = solve_near(r, &pose, position_only, q, next);
    if (solved && largest_move(r, q, next) <= CONTINUOUS) {
      memcpy(q, next, r->joint_count * sizeof *q);
      t += h;
      h = fmin(2 * h, 1 - t);
      continue;
    }
    h /= 2;
    if (h >= SHORTEST) continue;
    *done = t;
    CagRobotFound found;
    CagRobotGoal goal = {.near = q, .position_only = position_only};
    if (cag_transform_mix(a, b, fmin(1, t + 2 * h), &pose, err)) pose = *b;
    return cag_robot_solve(r, &pose, &goal, next, &found, err) ? LEFT : JUMPED;
  }
  *done = 1;
  return ARRIVED;
}

// --- Lines ---

// Sign of the determinant of the Jacobian of six joints, 0 if it is singular; for other chains 1 if
// it has full rank.
static int jacobian_sign(const CagRobot *r, const double *q) {
  double values[6], m[CAG_ROBOT_JOINTS_MAX][6];
  size_t count, rank;
  CagError ignored;
  if (cag_robot_singular_values(r, q, values, &count, &rank, &ignored)) return 1;
  if (rank < count) return 0;
  if (r->joint_count != 6) return 1;
  cag_robot_jacobian(r, q, m, NULL);
  int sign = 1;
  for (int k = 0; k < 6; k++) {
    int pivot = k;
    for (int i = k + 1; i < 6; i++)
      if (fabs(m[i][k]) > fabs(m[pivot][k])) pivot = i;
    for (int j = 0; j < 6; j++) {
      double swap = m[k][j];
      m[k][j] = m[pivot][j];
      m[pivot][j] = swap;
    }
    if (pivot != k) sign = -sign;
    if (m[k][k] < 0) sign = -sign;
    for (int i = k + 1; i < 6; i++) {
      double factor = m[i][k] / m[k][k];
      for (int j = k; j < 6; j++) m[i][j] -= factor * m[k][j];
    }
  }
  return sign;
}

// The number, from 1, of a joint at a limit; 0: none.
static size_t joint_at_limit(const CagRobot *r, const double *q) {
  const double near = 1e-2; // radians, or fractions of the reach: the last step ends within this
                            // distance of a limit
  for (size_t i = 0; i < r->joint_count; i++) {
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    double room = fmin(q[i] - l->low, l->high - q[i]);
    if (room <= near * (l->kind == CAG_JOINT_REVOLUTE ? 1 : r->reach)) return i + 1;
  }
  return 0;
}

// q is the last configuration that was reached.
static CagStatus fail_step(const CagRobot *r, const double *q, Tracked how, size_t step,
                           double part, const char *what, CagError *err) {
  char cause[80] = "a singular configuration is";
  double at = (double)step - 1 + part;
  if (how == LEFT)
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_path_leaves, "", (long)step,
        "the path leaves the workspace before %s %zu (at %.6g): no joint values within the limits reach what follows",
        what, step, at);
  size_t joint = joint_at_limit(r, q);
  if (joint > 0) snprintf(cause, sizeof cause, "the limit of joint %zu is", joint);
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_path_jumps, "", (long)step,
                  "the joints would have to jump before %s %zu (at %.6g): %s in the way of this "
                  "branch; start from another `near`",
                  what, step, at, cause);
}

static CagStatus fail_singular(size_t step, bool between, CagError *err) {
  return cag_fail(
      err, CAG_E_DEGENERATE, CAG_ERR_path_singular, "", (long)step,
      between
          ? "the path crosses a singular configuration between steps %zu and %zu; `cross: true` allows it"
          : "the path meets a singular configuration at step %zu (before %zu); `cross: true` allows it",
      between ? step - 1 : step, between ? step : step + 1);
}

static CagStatus fail_stopped(CagError *err) {
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_function_failed, "", -1, "the path was interrupted");
}

CagStatus cag_robot_line_path(const CagRobot *r, const CagTransform *from, const CagTransform *to,
                              size_t n, const CagRobotWay *way, double *q, CagError *err) {
  size_t joints = r->joint_count;
  CagRobotFound found;
  CagRobotGoal goal = {.near = way->near, .position_only = way->position_only};
  CagTransform at = *from;
  double done;
  CagStatus status = cag_robot_solve(r, from, &goal, q, &found, err);
  if (status) return status;
  const bool asked = !way->cross && !way->position_only;
  int sign = jacobian_sign(r, q);
  for (size_t k = 1; k < n; k++) {
    CagTransform next = *to;
    if (way->going && !way->going(way->data)) return fail_stopped(err);
    double *here = q + k * joints;
    if (k + 1 < n) {
      status = cag_transform_mix(from, to, (double)k / (double)(n - 1), &next, err);
      if (status) return status;
    }
    memcpy(here, here - joints, joints * sizeof *q);
    Tracked how = track(r, &at, &next, way->position_only, here, &done, err);
    if (how != ARRIVED) return fail_step(r, here, how, k, done, "step", err);
    int now = jacobian_sign(r, here);
    if (asked && now == 0 && k + 1 < n) return fail_singular(k, false, err);
    if (asked && now * sign < 0) return fail_singular(k, true, err);
    sign = now;
    at = next;
  }
  return CAG_OK;
}

CagStatus cag_robot_follow(const CagRobot *r, const CagTransform *poses, size_t n,
                           const CagRobotWay *way, double *q, CagError *err) {
  size_t joints = r->joint_count;
  double done;
  for (size_t k = 0; k < n; k++) {
    double *here = q + k * joints, before[CAG_ROBOT_JOINTS_MAX];
    CagRobotFound found;
    Tracked how = LEFT;
    if (way->going && !way->going(way->data)) return fail_stopped(err);
    if (k > 0) {
      memcpy(before, here - joints, joints * sizeof *q);
      memcpy(here, before, joints * sizeof *q);
      how = track(r, &poses[k - 1], &poses[k], way->position_only, here, &done, err);
      if (how == ARRIVED) continue;
      if (how == JUMPED && !way->jumps) return fail_step(r, here, how, k, done, "pose", err);
    }
    // The first pose, or one that is reachable although the direct motion to it is not.
    CagRobotGoal goal = {.near = k > 0 ? before : way->near, .position_only = way->position_only};
    CagStatus status = cag_robot_solve(r, &poses[k], &goal, here, &found, err);
    if (status && k > 0)
      return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_path_leaves, "", (long)k,
                      "pose %zu is out of reach; the closest found is %.6g mm and %.6g deg away", k,
                      found.position, found.rotation * 180 / M_PI);
    if (status) return status;
  }
  return CAG_OK;
}
