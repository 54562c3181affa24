// Inverse solutions by choice and joint paths: against all solutions of the closed form, and places
// where a path must end that are computed here.

#include <stdio.h>

#include "geom/robot/inverse.h"
#include "geom/robot/path.h"
#include "random.h"
#include "support.h"

#define DEGREE (M_PI / 180)

typedef struct Row {
  CagJointKind kind;
  double d, a, alpha, low, high; // angles in degrees
} Row;

#define R CAG_JOINT_REVOLUTE
#define P CAG_JOINT_PRISMATIC
static const Row puma[] = {{R, 0, 0, -90, -170, 170},  {R, 149.5, 432, 0, -225, 45},
                           {R, 0, 20.3, 90, -250, 75}, {R, 432, 0, -90, -135, 350},
                           {R, 0, 0, 90, -100, 100},   {R, 56.5, 0, 0, -366, 366}};
static const Row stanford[] = {{R, 412, 0, -90, -170, 170}, {R, 154, 0, 90, -170, 170},
                               {P, 0, 0, 0, 100, 900},      {R, 0, 0, -90, -170, 170},
                               {R, 0, 0, 90, -200, 200},    {R, 263, 0, 0, -170, 170}};

static CagRobot *arm_of(const Row *rows, size_t n) {
  CagRobotLink links[8];
  CagRobot *r = NULL;
  for (size_t i = 0; i < n; i++) {
    const double unit = rows[i].kind == R ? DEGREE : 1;
    links[i] = cag_robot_link(rows[i].kind);
    links[i].d = rows[i].d;
    links[i].a = rows[i].a;
    links[i].alpha = rows[i].alpha * DEGREE;
    links[i].low = rows[i].low * unit;
    links[i].high = rows[i].high * unit;
    links[i].home = fmax(links[i].low, 0);
  }
  const CagRobotSpec spec = {.links = links,
                             .link_count = n,
                             .base = cag_transform_identity(),
                             .tool = cag_transform_identity()};
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

static void random_place(const CagRobot *r, double *q) {
  for (size_t i = 0; i < r->joint_count; i++) {
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    q[i] = uniform(l->low, l->high);
  }
}

static double way_of(const CagRobot *r, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < r->joint_count; i++) {
    const bool slides = r->links[r->joint_link[i]].kind == P;
    sum += pow((b[i] - a[i]) / (slides ? r->reach : 1), 2);
  }
  return sum;
}

// The least way from `near` to a solution of the branch, over all whole turns within the limits.
static double least_way(const CagRobot *r, const CagInverse *all, const CagRobotGoal *goal,
                        const double *near) {
  double least = INFINITY;
  for (size_t i = 0; i < all->count; i++) {
    const CagInverseSolution *s = &all->solutions[i];
    const int is[] = {s->configuration.shoulder, s->configuration.elbow, s->configuration.wrist};
    const int wanted[] = {goal->shoulder, goal->elbow, goal->wrist};
    bool fits = true;
    double best[6];
    for (int k = 0; k < 3; k++) fits &= !wanted[k] || is[k] == wanted[k];
    for (size_t j = 0; j < r->joint_count; j++) {
      const CagRobotLink *l = &r->links[r->joint_link[j]];
      best[j] = INFINITY;
      for (int turn = -2; turn <= 2; turn++) {
        const double x = s->q[j] + (l->kind == R ? turn * 2 * M_PI : 0);
        if (x >= l->low && x <= l->high && fabs(x - near[j]) < fabs(best[j] - near[j])) best[j] = x;
      }
      fits &= best[j] < INFINITY;
    }
    if (fits) least = fmin(least, way_of(r, near, best));
  }
  return least;
}

static void the_nearest_solution_of_a_branch_is_taken(void **state) {
  (void)state;
  seed = 1;
  size_t found_count = 0, missing = 0;
  for (int trial = 0; trial < 400; trial++) {
    CagRobot *r = trial % 2 ? arm_of(puma, 6) : arm_of(stanford, 6);
    const CagConfiguration has = cag_robot_branches(r);
    double q[6], near[6], home[6], solved[6];
    CagTransform target, pose;
    CagInverse all;
    CagRobotFound found;
    CagRobotGoal goal = {.near = trial % 5 ? near : NULL};
    random_place(r, q);
    random_place(r, near);
    cag_robot_home(r, home);
    if (trial % 3 == 1) goal.shoulder = trial % 4 < 2 && has.shoulder ? 1 : 0;
    if (trial % 3 == 2) goal.wrist = trial % 4 < 2 ? 1 : -1;
    if (trial % 7 == 3 && has.elbow) goal.elbow = -1;
    const bool branch = goal.shoulder || goal.wrist || goal.elbow;
    cag_robot_forward(r, q, &target);
    cag_robot_inverse(r, &target, NULL, &all);
    const double *from = trial % 5 ? near : home, least = least_way(r, &all, &goal, from);
    const CagStatus status = cag_robot_solve(r, &target, &goal, solved, &found, &err);
    if (least < INFINITY) {
      double position, rotation;
      assert_int_equal(status, CAG_OK);
      found_count++;
      NEAR(way_of(r, from, solved), least, 1e-9 * (1 + least));
      cag_robot_forward(r, solved, &pose);
      cag_robot_pose_distance(&pose, &target, &position, &rotation);
      assert_true(found.solved && position < 1e-9 * r->reach && rotation < 1e-9);
      NEAR(found.position, position, 1e-15);
      NEAR(found.rotation, rotation, 1e-15);
    } else {
      missing++;
      assert_true(branch);
      FAILS(status, "unreachable");
      assert_string_equal(err.argument, "config");
    }
    cag_robot_release(r);
  }
  assert_true(found_count > 200 && missing > 5);
}

static void points_are_reached_by_the_nearest_way(void **state) {
  (void)state;
  static const Row anthropomorphic[] = {
      {R, 300, 0, 90, -170, 170}, {R, 0, 250, 0, -150, 150}, {R, 0, 200, 0, -150, 150}};
  CagRobot *r = arm_of(anthropomorphic, 3);
  seed = 2;
  for (int trial = 0; trial < 200; trial++) {
    double q[3], near[3], solved[3];
    CagTransform t, pose;
    CagInverse all;
    CagRobotFound found;
    const CagRobotGoal goal = {.near = near, .position_only = true};
    random_place(r, q);
    random_place(r, near);
    cag_robot_forward(r, q, &t);
    const CagVec3 p = cag_vec3(t.m[0][3], t.m[1][3], t.m[2][3]);
    cag_robot_inverse_point(r, p, near, &all);
    OK(cag_robot_solve(r, &t, &goal, solved, &found, &err));
    NEAR(way_of(r, near, solved), least_way(r, &all, &goal, near), 1e-9);
    cag_robot_forward(r, solved, &pose);
    near_vec(cag_vec3(pose.m[0][3], pose.m[1][3], pose.m[2][3]), p, 1e-9);
    assert_true(found.solved && found.rotation == 0 && found.position < 1e-9);
  }
  cag_robot_release(r);
}

static void branches_without_names_are_refused(void **state) {
  (void)state;
  static const Row planar[] = {{R, 0, 300, 0, -180, 180}, {R, 0, 200, 0, -180, 180}};
  static const Row turned[] = {{R, 100, 300, 30, -90, 90}, {R, 20, 200, 50, -90, 90},
                               {R, 30, 200, 70, -90, 90},  {R, 40, 100, 20, -90, 90},
                               {R, 50, 100, 40, -90, 90},  {R, 60, 100, 60, -90, 90},
                               {R, 70, 100, 10, -90, 90}};
  CagRobot *two = arm_of(planar, 2), *seven = arm_of(turned, 7), *six = arm_of(puma, 6);
  const CagTransform t = cag_translate(cag_vec3(300, 100, 0));
  double q[7];
  CagRobotFound found;
  CagRobotGoal goal = {.wrist = 1, .position_only = true};
  FAILS(cag_robot_solve(two, &t, &goal, q, &found, &err), "no-closed-form");
  assert_non_null(strstr(err.message, "`wrist`"));
  goal = (CagRobotGoal){.shoulder = -1};
  FAILS(cag_robot_solve(seven, &t, &goal, q, &found, &err), "no-closed-form");
  assert_non_null(strstr(err.message, "the arm has no closed form"));
  goal.position_only = true;
  FAILS(cag_robot_solve(six, &t, &goal, q, &found, &err), "no-closed-form");
  assert_non_null(strstr(err.message, "a point does not determine"));
  FAILS(cag_robot_solve(seven, &t, &goal, q, &found, &err), "no-closed-form");
  assert_non_null(strstr(err.message, "the arm has no closed form"));
  // The nearest place to a point out of reach is told: 500 of the way of 600 are reached.
  const CagTransform far = cag_translate(cag_vec3(0, -600, 0));
  goal = (CagRobotGoal){.position_only = true};
  FAILS(cag_robot_solve(two, &far, &goal, q, &found, &err), "unreachable");
  NEAR(found.position, 100, 1e-6);
  assert_non_null(strstr(err.message, "found is 100 mm away"));
  cag_robot_release(two);
  cag_robot_release(seven);
  cag_robot_release(six);
}

// Steps lie evenly on the way, and the branch stays: its end is that of joint values nearby.
static void lines_keep_the_branch(void **state) {
  (void)state;
  seed = 3;
  size_t arrived = 0, kept = 0;
  CagRobot *arms[] = {arm_of(puma, 6), arm_of(stanford, 6)};
  for (int trial = 0; trial < 60; trial++) {
    CagRobot *r = arms[trial % 2];
    double a[6], b[6], q[8][6], position, rotation;
    CagTransform from, to, wanted, pose;
    for (int i = 0; i < 6; i++) {
      a[i] = (i == 2 && trial % 2 ? 300 : i == 4 ? 0.9 : 0.4) + uniform(-0.3, 0.3);
      b[i] = a[i] + uniform(-0.3, 0.3) * (i == 2 && trial % 2 ? 300 : 1);
    }
    cag_robot_forward(r, a, &from);
    cag_robot_forward(r, b, &to);
    const CagRobotWay way = {.near = a};
    const size_t n = 2 + (size_t)trial % 7;
    if (cag_robot_line_path(r, &from, &to, n, &way, q[0], &err)) continue;
    arrived++;
    for (size_t k = 0; k < n; k++) {
      OK(cag_transform_mix(&from, &to, (double)k / (double)(n - 1), &wanted, &err));
      cag_robot_forward(r, q[k], &pose);
      cag_robot_pose_distance(&pose, &wanted, &position, &rotation);
      assert_true(position < 1e-9 * r->reach && rotation < 1e-9);
    }
    CagConfiguration first, last;
    assert_true(cag_robot_configuration(r, q[0], &first));
    assert_true(cag_robot_configuration(r, b, &last));
    const bool same = memcmp(&first, &last, sizeof first) == 0;
    for (int i = 0; i < 6; i++) {
      const double unit = i == 2 && trial % 2 ? r->reach : 1;
      NEAR(q[0][i] / unit, a[i] / unit, 1e-9);
      if (same) NEAR(q[n - 1][i] / unit, b[i] / unit, 1e-8);
    }
    kept += same;
  }
  assert_true(arrived > 45 && kept > 45);
  cag_robot_release(arms[0]);
  cag_robot_release(arms[1]);
}

// However few steps are asked for, the joints follow the whole way: one step ends where fifty do.
static void one_step_ends_where_many_do(void **state) {
  (void)state;
  static const Row slider[] = {{R, 0, 0, 0, -170, 170}, {P, 0, 0, -90, 0, 9000},
                               {P, 0, 0, 0, 100, 9000}, {R, 0, 0, -90, -400, 400},
                               {R, 0, 0, 90, 5, 175},   {R, 0, 0, 0, -400, 400}};
  enum { N = 50, ARMS = 3 };
  seed = 5;
  CagRobot *arms[ARMS] = {arm_of(puma, 6), arm_of(stanford, 6), arm_of(slider, 6)};
  int arrived[ARMS] = {0};
  for (int trial = 0; trial < 150; trial++) {
    CagRobot *r = arms[trial % ARMS];
    double a[6], b[6], few[2][6], many[N][6];
    CagTransform from, to;
    random_place(r, a);
    random_place(r, b);
    const double part = uniform(0.2, 0.9);
    for (int i = 0; i < 6; i++) b[i] = a[i] + part * (b[i] - a[i]);
    cag_robot_forward(r, a, &from);
    cag_robot_forward(r, b, &to);
    const CagRobotWay way = {.near = a};
    if (cag_robot_line_path(r, &from, &to, N, &way, many[0], &err)) continue;
    arrived[trial % ARMS]++;
    OK(cag_robot_line_path(r, &from, &to, 2, &way, few[0], &err));
    for (size_t i = 0; i < 6; i++) {
      const double unit = r->links[r->joint_link[i]].kind == P ? r->reach : 1;
      NEAR(few[1][i] / unit, many[N - 1][i] / unit, 1e-6);
    }
  }
  for (int i = 0; i < ARMS; i++) {
    assert_true(arrived[i] > 15);
    cag_robot_release(arms[i]);
  }
}

// Joint 5 of a wrist, where the tool is, turns through 0, where it is singular: at a step, or
// between two.
static void singular_places_are_told_by_their_step(void **state) {
  (void)state;
  Row rows[6];
  memcpy(rows, puma, sizeof rows);
  rows[5].d = 0;
  CagRobot *r = arm_of(rows, 6);
  const double ends[] = {-0.4, 0.4};
  for (size_t n = 2; n < 12; n++) {
    CagTransform pose[3];
    double q[12][6] = {{0.3, -0.5, 0.2, 0.4, -0.4, 0.7}}, at[6];
    char text[80];
    memcpy(at, q[0], sizeof at);
    for (int i = 0; i < 2; i++) {
      at[4] = ends[i];
      cag_robot_forward(r, at, &pose[i]);
    }
    at[4] = ends[0];
    CagRobotWay way = {.near = at};
    const bool between = n % 2 == 0;
    const size_t step = n / 2;
    FAILS_AT(cag_robot_line_path(r, &pose[0], &pose[1], n, &way, q[0], &err), "path-singular",
             (long)step);
    snprintf(text, sizeof text, between ? "between steps %zu and %zu;" : "step %zu (before %zu)",
             step - between, step + !between);
    assert_non_null(strstr(err.message, text));
    way.cross = true;
    OK(cag_robot_line_path(r, &pose[0], &pose[1], n, &way, q[0], &err));
    for (size_t k = 0; k < n; k++) {
      at[4] = -0.4 + 0.8 * (double)k / (double)(n - 1);
      for (int i = 0; i < 5; i++)
        if (i != 3) NEAR(q[k][i], at[i], 1e-7); // joint 4 is free beside joint 6
    }
    // A way may end at a singular place.
    at[4] = 0;
    cag_robot_forward(r, at, &pose[2]);
    at[4] = ends[0];
    way.cross = false;
    OK(cag_robot_line_path(r, &pose[0], &pose[2], n, &way, q[0], &err));
  }
  cag_robot_release(r);
}

// The number behind "(at " in the message.
static double told_place(void) {
  const char *at = strstr(err.message, "(at ");
  assert_non_null(at);
  return atof(at + 4);
}

static CagTransform at_point(double x, double y) { return cag_translate(cag_vec3(x, y, 0)); }

// A path ends where its branch does, which is told to 1/4096 of a step.
static void paths_end_where_their_branch_does(void **state) {
  (void)state;
  static const Row limited[] = {
      {R, 0, 300, 0, -40, 180}, {R, 0, 200, 0, -170, 170}, {R, 0, 0, 0, -180, 180}};
  CagRobot *r = arm_of(limited, 3);
  const double near[] = {-0.3, 1.9, -1.6}, left = 1.0 / 2048;
  const CagTransform from = at_point(300, 100), to = at_point(300, -100), far = at_point(600, 100);
  double q[41][3];
  const CagRobotWay way = {.near = near};
  // Joint 1 stands at the direction less the angle at the shoulder; -40 degrees is its limit.
  double high = 100, low = -100;
  for (int i = 0; i < 60; i++) {
    const double y = (high + low) / 2, d = hypot(300, y);
    const double joint = atan2(y, 300) - acos((300 * 300 + d * d - 200 * 200) / (2 * 300 * d));
    if (joint > -40 * DEGREE) high = y;
    else low = y;
  }
  for (size_t n = 2; n < 42; n += 13) {
    const double end = (100 - high) / 200 * (double)(n - 1);
    assert_int_equal(cag_robot_line_path(r, &from, &to, n, &way, q[0], &err), CAG_E_DEGENERATE);
    assert_string_equal(cag_error_info(err.id)->reason, "path-jumps");
    assert_int_equal(err.index, (long)ceil(end));
    assert_true(told_place() <= end && told_place() >= end - left);
    assert_non_null(strstr(err.message, "the limit of joint 1 is"));
    assert_non_null(strstr(err.message, "before step"));
    // The reach of 500 ends at x = sqrt(500^2 - 100^2).
    const double leaves = (sqrt(240000) - 300) / 300 * (double)(n - 1);
    assert_int_equal(cag_robot_line_path(r, &from, &far, n, &way, q[0], &err), CAG_E_DEGENERATE);
    assert_string_equal(cag_error_info(err.id)->reason, "path-leaves");
    assert_int_equal(err.index, (long)ceil(leaves));
    assert_true(told_place() <= leaves + 1e-3 && told_place() >= leaves - left);
  }
  const CagTransform poses[] = {from, at_point(300, 50), to, far};
  FAILS_AT(cag_robot_follow(r, poses, 3, &way, q[0], &err), "path-jumps", 2);
  assert_non_null(strstr(err.message, "before pose 2 (at 1."));
  const CagRobotWay jumping = {.near = near, .jumps = true};
  OK(cag_robot_follow(r, poses, 3, &jumping, q[0], &err));
  for (int k = 0; k < 3; k++) {
    const double y = k == 0 ? 100 : k == 1 ? 50 : -100, *p = q[k];
    NEAR(300 * cos(p[0]) + 200 * cos(p[0] + p[1]), 300, 1e-6);
    NEAR(300 * sin(p[0]) + 200 * sin(p[0] + p[1]), y, 1e-6);
    NEAR(p[0] + p[1] + p[2], 0, 1e-9);
    assert_true(k < 2 ? p[1] > 0 : p[1] < 0); // the other elbow
  }
  // Nothing reaches the fourth: the hand is hypot(600, 100) - 500 away.
  FAILS_AT(cag_robot_follow(r, poses, 4, &jumping, q[0], &err), "path-leaves", 3);
  assert_non_null(strstr(err.message, "pose 3 is out of reach; the closest found is 108.276 mm"));
  cag_robot_release(r);
}

// A slide that would have to go beyond its end, where the arm could turn by half a turn instead.
static void slides_end_paths_as_well(void **state) {
  (void)state;
  static const Row polar[] = {{R, 0, 0, 90, -400, 400}, {P, 0, 0, 0, -800, 100}};
  CagRobot *r = arm_of(polar, 2);
  const double near[] = {90 * DEGREE, 50};
  CagTransform from, to;
  double q[9][2];
  const double here[] = {90 * DEGREE, 50}, there[] = {270 * DEGREE, -210};
  cag_robot_forward(r, here, &from);
  cag_robot_forward(r, there, &to);
  const CagRobotWay way = {.near = near, .position_only = true};
  FAILS_AT(cag_robot_line_path(r, &from, &to, 9, &way, q[0], &err), "path-jumps", 3);
  // From 50 to 210 in 8 steps of 20, of which two and a half are within the limit.
  assert_true(told_place() <= 2.5 + 1e-6 && told_place() > 2.5 - 1.0 / 2048);
  assert_non_null(strstr(err.message, "the limit of joint 2 is"));
  const double inside[] = {90 * DEGREE, 94};
  cag_robot_forward(r, inside, &to);
  OK(cag_robot_line_path(r, &from, &to, 9, &way, q[0], &err));
  for (int k = 0; k < 9; k++) {
    NEAR(q[k][0], 90 * DEGREE, 1e-9);
    NEAR(q[k][1], 50 + 5.5 * k, 1e-6);
  }
  cag_robot_release(r);
}

// Asked n times whether to go on, the n-th answer is no.
static bool goes_on(void *left) { return --*(int *)left > 0; }

static void paths_are_stopped(void **state) {
  (void)state;
  CagRobot *r = arm_of(puma, 6);
  const double a[] = {0.3, -0.5, 0.2, 0.4, 0.4, 0.7}, b[] = {0.4, -0.6, 0.3, 0.3, 0.6, 0.5};
  CagTransform ends[2];
  double q[5][6];
  cag_robot_forward(r, a, &ends[0]);
  cag_robot_forward(r, b, &ends[1]);
  for (int answers = 1; answers < 7; answers++) {
    int left = answers;
    const CagRobotWay way = {.near = a, .going = goes_on, .data = &left};
    const CagStatus line = cag_robot_line_path(r, &ends[0], &ends[1], 5, &way, q[0], &err);
    assert_int_equal(line, answers <= 4 ? CAG_E_CALLBACK : CAG_OK); // asked before each step
    assert_int_equal(left, answers <= 4 ? 0 : answers - 4);
    left = answers;
    const CagStatus poses = cag_robot_follow(r, ends, 2, &way, q[0], &err);
    assert_int_equal(poses, answers <= 2 ? CAG_E_CALLBACK : CAG_OK);
  }
  cag_robot_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_nearest_solution_of_a_branch_is_taken),
      cmocka_unit_test(points_are_reached_by_the_nearest_way),
      cmocka_unit_test(branches_without_names_are_refused),
      cmocka_unit_test(lines_keep_the_branch),
      cmocka_unit_test(one_step_ends_where_many_do),
      cmocka_unit_test(singular_places_are_told_by_their_step),
      cmocka_unit_test(paths_end_where_their_branch_does),
      cmocka_unit_test(slides_end_paths_as_well),
      cmocka_unit_test(paths_are_stopped),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
