// Robots that a page moves: which of them are found, where their parts go, and which joint values
// reach a target.

#include <math.h>

#include "tests/interp/session_support.h"

enum { JOINTS_MAX = 16 };

static void build_scene(CagSession *s, const char *text) {
  CagShownCounts counts;
  if (cag_session_run_text(s, "page.cag", text, strlen(text)) != CAG_STATUS_OK ||
      cag_session_scene(s, &counts) != CAG_STATUS_OK) {
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, stderr);
    fail_msg("%s", text);
  }
}

static CagSession *session_with(const char *text) {
  CagSession *s = new_session();
  build_scene(s, text);
  return s;
}

static CagRobotView robot_view(CagSession *s, size_t i) {
  CagRobotView r;
  assert_true(cag_session_robot(s, i, &r));
  return r;
}

static CagRobotPose pose_of(CagSession *s, size_t robot, const double *q, size_t n) {
  CagRobotPose pose;
  assert_int_equal(cag_session_robot_pose(s, robot, q, n, &pose), CAG_STATUS_OK);
  return pose;
}

// --- Poses ---

static void multiply(const double a[3][4], const double b[3][4], double out[3][4]) {
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 4; k++)
      out[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k] + (k == 3) * a[i][3];
}

// The box around the mesh of a part after a motion.
static void box_of(CagSession *s, size_t part, const double motion[3][4], double low[3],
                   double high[3]) {
  CagMeshView m;
  double place[3][4];
  assert_int_equal(cag_session_part_mesh(s, part, 1, NULL, NULL, &m), CAG_STATUS_OK);
  multiply(motion, (const double(*)[4])m.placement, place);
  for (int i = 0; i < 3; i++) {
    low[i] = INFINITY;
    high[i] = -INFINITY;
    for (size_t v = 0; v < m.vertex_count; v++) {
      const float *p = m.positions + 3 * v;
      const double x = place[i][0] * p[0] + place[i][1] * p[1] + place[i][2] * p[2] + place[i][3];
      low[i] = fmin(low[i], x);
      high[i] = fmax(high[i], x);
    }
  }
}

// A robot that is shown with one q, and then posed with another, looks as if it was shown with the
// other one.
static void check_pose(const char *before, const char *q, const char *other, const double *values,
                       size_t n, const char *after, double tolerance) {
  static const double still[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  char text[4096];
  snprintf(text, sizeof text, "import std.robots\n%s%s%s", before, q, after);
  CagSession *a = session_with(text);
  snprintf(text, sizeof text, "import std.robots\n%s%s%s", before, other, after);
  CagSession *b = session_with(text);
  const CagRobotView r = robot_view(a, 0);
  assert_int_equal(r.joint_count, n);
  assert_int_equal(robot_view(b, 0).part_count, r.part_count);
  const CagRobotPose pose = pose_of(a, 0, values, n);
  for (size_t k = 0; k < r.part_count; k++) {
    double low[2][3], high[2][3];
    box_of(a, cag_session_robot_part(a, 0, k, NULL), pose.motions[k], low[0], high[0]);
    box_of(b, cag_session_robot_part(b, 0, k, NULL), still, low[1], high[1]);
    for (int i = 0; i < 3; i++)
      if (!(fabs(low[0][i] - low[1][i]) < tolerance && fabs(high[0][i] - high[1][i]) < tolerance))
        fail_msg("part %zu of %s%s%s: %g..%g, expected %g..%g", k, before, other, after, low[0][i],
                 high[0][i], low[1][i], high[1][i]);
  }
  cag_session_free(a);
  cag_session_free(b);
}

// Vertices are rounded to single precision, with a relative error of 6e-8 of a meter.
#define ROUNDED 1e-3
// Bodies that were stretched are divided anew, within a thousandth of their size.
#define CHORDS 0.5

static void parts_go_where_the_language_poses_them(void **state) {
  (void)state;
  const double puma[] = {20, -60, 100, 40, -30, 90};
  const char *q = "[30deg, -45deg, 120deg, 0deg, 45deg, 0deg]",
             *other = "[20deg, -60deg, 100deg, 40deg, -30deg, 90deg]";
  check_pose("show robots.puma560 |> posed(", q, other, puma, 6, ")\n", ROUNDED);
  check_pose("show robots.puma560 |> posed(", q, other, puma, 6,
             ", holding: box([20, 30, 40])) |> rotate(X, 30deg) |> translate([10, 20, 30])\n",
             ROUNDED);
  check_pose("show robots.puma560 |> posed(", q, other, puma, 6,
             ") |> scale([1, 2, 0.5]) |> reflect(X)\n", CHORDS);
  const double scara[] = {-20, 50, 130, 10};
  check_pose("show robots.scara(d1: 250, a1: 300, a2: 250, stroke: 0..150) |> posed(",
             "[10deg, 20deg, 30, 40deg]", "[-20deg, 50deg, 130, 10deg]", scara, 4, ")\n", ROUNDED);
}

// The default drawing has rods whose radii are 0.018 of the length of the skeleton, which depends
// on the slides: here 90 of 1000 mm.
static void rods_follow_slides(void **state) {
  (void)state;
  const double q[] = {40, 130, 60};
  static const char *const CONVENTIONS[] = {"dh", "mdh"};
  for (size_t i = 0; i < 2; i++) {
    char before[512];
    snprintf(before, sizeof before,
             "arm = robot([revolute(d: 200, alpha: -90deg), prismatic(limits: 10..300, alpha: "
             "90deg, a: 100), fixed_link(translate([50, 0, 90])), revolute(a: 400, d: 50)], "
             "convention: \"%s\", tool: translate([0, 0, 70]))\nshow arm |> posed(",
             CONVENTIONS[i]);
    check_pose(before, "[0deg, 40, -20deg]", "[40deg, 130, 60deg]", q, 3, ")\n", 90 * 0.08);
  }
}

static void frames_are_those_of_forward_kinematics(void **state) {
  (void)state;
  CagSession *s =
      session_with("import std.robots\n"
                   "q = [20deg, -60deg, 100deg, 40deg, -30deg, 90deg]\n"
                   "base = translate([10, 20, 30]) * rotate(X, 30deg)\n"
                   "show base * posed(robots.puma560, [30deg, -45deg, 120deg, 0deg, 45deg, 0deg])\n"
                   "show base * fk(robots.puma560, q) * box([1, 2, 3])\n"
                   "show [for f in link_frames(robots.puma560, q): base * f * box([1, 2, 3])]\n");
  const double q[] = {20, -60, 100, 40, -30, 90};
  const CagRobotView r = robot_view(s, 0);
  const CagRobotPose pose = pose_of(s, 0, q, 6);
  assert_int_equal(pose.frame_count, r.frame_count);
  for (size_t f = 0; f <= pose.frame_count; f++) {
    CagMeshView m;
    assert_int_equal(cag_session_part_mesh(s, r.part_count + f, 1, NULL, NULL, &m), CAG_STATUS_OK);
    const double(*found)[4] = f == 0 ? (const double(*)[4])pose.tool : pose.frames[f - 1];
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 4; k++)
        if (!(fabs(found[i][k] - m.placement[i][k]) < 1e-9))
          fail_msg("frame %zu: %g, expected %g", f, found[i][k], m.placement[i][k]);
  }
  cag_session_free(s);
}

// --- Reach ---

// Reproducible joint values within the limits.
static void choose_joints(CagSession *s, size_t robot, unsigned seed, double *q, size_t n) {
  for (size_t i = 0; i < n; i++) {
    CagJointView j;
    assert_true(cag_session_robot_joint(s, robot, i, &j));
    seed = seed * 1103515245u + 12345u;
    q[i] = j.low + (j.high - j.low) * (0.1 + 0.8 * ((seed >> 8) & 0xffff) / 65535.0);
  }
}

static void check_reached(CagSession *s, size_t robot, unsigned seed, CagReach orientation) {
  double q[JOINTS_MAX], near[JOINTS_MAX], target[3][4];
  const size_t n = robot_view(s, robot).joint_count;
  choose_joints(s, robot, seed, q, n);
  choose_joints(s, robot, seed + 1000, near, n);
  memcpy(target, pose_of(s, robot, q, n).tool, sizeof target);
  CagReachView reach;
  assert_int_equal(
      cag_session_robot_reach(s, robot, (const double(*)[4])target, orientation, near, n, &reach),
      CAG_STATUS_OK);
  if (!reach.reached) fail_msg("robot %zu misses target %u by %g mm", robot, seed, reach.distance);
  memcpy(q, reach.q, n * sizeof *q);
  for (size_t i = 0; i < n; i++) {
    CagJointView j;
    cag_session_robot_joint(s, robot, i, &j);
    assert_true(q[i] >= j.low - 1e-9 && q[i] <= j.high + 1e-9);
  }
  const CagRobotPose pose = pose_of(s, robot, q, n);
  for (int i = 0; i < 3; i++)
    for (int k = orientation == CAG_REACH_EXACT ? 0 : 3; k < 4; k++)
      if (!(fabs(pose.tool[i][k] - target[i][k]) < 1e-5))
        fail_msg("robot %zu, target %u: %g, expected %g", robot, seed, pose.tool[i][k],
                 target[i][k]);
}

static const char *const ARMS =
    "import std.robots\n"
    "show robots.puma560, robots.ur5e, robots.iiwa14, robots.irb120\n"
    "show robots.puma560 |> posed() |> scale(2) |> rotate(Y, 40deg) |> translate([5000, 0, 0])\n"
    "show robots.puma560 |> posed() |> reflect(X) |> translate([9000, 0, 0])\n"
    "show posed(robots.scara()) |> translate([0, 5000, 0])\n"
    "show posed(robots.rhino) |> translate([0, 9000, 0])\n";

static void targets_of_forward_kinematics_are_reached(void **state) {
  (void)state;
  CagSession *s = session_with(ARMS);
  for (size_t robot = 0; robot < 7; robot++)
    for (unsigned seed = 1; seed <= 20; seed++) check_reached(s, robot, seed, CAG_REACH_EXACT);
  for (unsigned seed = 1; seed <= 20; seed++) {
    check_reached(s, 7, seed, CAG_REACH_KEEP); // five joints
    check_reached(s, 0, seed, CAG_REACH_FREE);
  }
  cag_session_free(s);
}

// A robot that is dragged does not jump: small steps of the target are small steps of the joints,
// also beyond the reach of the arm.
static void a_drag_is_steady(void **state) {
  (void)state;
  CagSession *s =
      session_with("show robot([revolute(a: 300), revolute(a: 200, limits: -150deg..150deg)])"
                   " |> posed([0deg, 60deg])\n");
  double q[] = {0, 60}, target[3][4];
  CagReachView reach;
  memcpy(target, pose_of(s, 0, q, 2).tool, sizeof target);
  for (int i = 0; i < 100; i++) {
    target[0][3] += 5;
    target[1][3] -= 2;
    assert_int_equal(
        cag_session_robot_reach(s, 0, (const double(*)[4])target, CAG_REACH_KEEP, q, 2, &reach),
        CAG_STATUS_OK);
    for (int k = 0; k < 2; k++) {
      // Where the arm is stretched, the elbow turns by the root of the step.
      assert_true(fabs(reach.q[k] - q[k]) < 25);
      q[k] = reach.q[k];
    }
  }
  // The closest pose to a target that is too far is the stretched arm.
  assert_false(reach.reached);
  const double far = hypot(target[0][3], target[1][3]);
  assert_true(fabs(reach.distance - (far - 500)) < 1e-6);
  assert_true(fabs(q[1]) < 1e-3);
  cag_session_free(s);
}

// --- What is a robot ---

static size_t count_robots(CagSession *s, const char *text) {
  CagRobotView r;
  char whole[2048];
  size_t n = 0;
  snprintf(whole, sizeof whole,
           "arm = robot([revolute(a: 100, shape: box([10, 20, 30])), revolute(a: 50, shape: "
           "sphere(9))], name: \"arm\")\nq = [10deg, 20deg]\n%s",
           text);
  build_scene(s, whole);
  while (cag_session_robot(s, n, &r)) n++;
  return n;
}

static void robots_are_found_wherever_they_are_shown(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(count_robots(s, "show arm\n"), 1);
  assert_int_equal(count_robots(s, "show posed(arm, q) |> material({color: \"red\"})\n"), 1);
  assert_int_equal(count_robots(s, "show group([box([1, 1, 1]), posed(arm, q), posed(arm, q)])\n"),
                   2);
  assert_int_equal(
      count_robots(s, "show [for i in 0..3: posed(arm, q) |> translate([i * 500, 0, 0])]\n"), 4);
  assert_int_equal(count_robots(s, "show around(posed(arm, q) |> translate([500, 0, 0]), 3)\n"), 3);
  assert_string_equal(robot_view(s, 0).name, "arm");
  assert_string_equal(robot_view(s, 2).name, "arm 3");
  assert_int_equal(robot_view(s, 2).part_count, 2);
  const char *name;
  assert_int_equal(cag_session_robot_part(s, 2, 1, &name), 5);
  assert_string_equal(name, "arm.6");
  assert_int_equal(count_robots(s, "show sphere(1)\nshow ground()\n"), 0);
  assert_int_equal(count_robots(s, "show union(posed(arm, q).items)\n"), 0);
  assert_int_equal(cag_session_robot_part(s, 0, 0, NULL), (size_t)-1);
  cag_session_free(s);
}

static void a_robot_within_another_is_a_part_of_it(void **state) {
  (void)state;
  CagSession *s = new_session();
  assert_int_equal(count_robots(s, "show posed(arm, q, holding: posed(arm, q))\n"), 1);
  assert_int_equal(robot_view(s, 0).part_count, 4);
  cag_session_free(s);
}

static void joints_have_the_units_of_the_script(void **state) {
  (void)state;
  CagSession *s = session_with(
      "show robot([revolute(a: 300, limits: -1rad..100deg), prismatic(limits: 5mm..3cm)])"
      " |> posed([0.5turn, 2cm], limits: false)\n");
  CagJointView j;
  assert_true(cag_session_robot_joint(s, 0, 0, &j));
  assert_string_equal(j.kind, "revolute");
  assert_string_equal(j.unit, "deg");
  assert_string_equal(j.name, "joint 1");
  assert_true(fabs(j.low + 180 / M_PI) < 1e-12 && j.high == 100 && j.value == 180);
  assert_true(cag_session_robot_joint(s, 0, 1, &j));
  assert_string_equal(j.kind, "prismatic");
  assert_true(j.low == 5 && j.high == 30 && j.value == 20 && j.home == 5);
  assert_false(cag_session_robot_joint(s, 0, 2, &j));
  assert_false(cag_session_robot_joint(s, 1, 0, &j));
  cag_session_free(s);
}

// --- Errors ---

static void expect_error(CagSession *s, int status, const char *reason) {
  CagErrorView e;
  assert_int_equal(status, CAG_STATUS_USAGE);
  assert_true(cag_session_error_count(s) > 0);
  cag_session_error(s, cag_session_error_count(s) - 1, &e);
  assert_string_equal(e.reason, reason);
}

static void wrong_values_are_errors(void **state) {
  (void)state;
  CagSession *s = session_with("show robot([revolute(a: 300), prismatic(limits: 0..9)])\n");
  const double q[] = {1, 2, 3}, none[] = {1, NAN};
  const double flat[3][4] = {{1, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}},
               left[3][4] = {{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
               far[3][4] = {{1, 0, 0, INFINITY}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  CagRobotPose pose;
  CagReachView reach;
  expect_error(s, cag_session_robot_pose(s, 0, q, 3, &pose), "joint-count");
  expect_error(s, cag_session_robot_pose(s, 0, none, 2, &pose), "not-finite");
  expect_error(s, cag_session_robot_reach(s, 0, flat, CAG_REACH_KEEP, q, 2, &reach), "not-rigid");
  expect_error(s, cag_session_robot_reach(s, 0, left, CAG_REACH_KEEP, q, 2, &reach), "not-rigid");
  expect_error(s, cag_session_robot_reach(s, 0, far, CAG_REACH_KEEP, q, 2, &reach), "not-finite");
  expect_error(s, cag_session_robot_reach(s, 0, left, CAG_REACH_KEEP, q, 1, &reach), "joint-count");
  assert_int_equal(cag_session_robot_pose(s, 1, q, 2, &pose), CAG_STATUS_USAGE);
  // Errors about robots are not those of the script.
  assert_int_equal(cag_session_robot_pose(s, 0, q, 2, &pose), CAG_STATUS_OK);
  assert_int_equal(cag_session_error_count(s), 0);
  cag_session_free(s);
}

// --- The script ---

// The texts at the locations of the joint values, or why there are none.
static void expect_said(CagSession *s, const char *text, const char *expected) {
  char found[512] = "";
  char whole[2048];
  snprintf(whole, sizeof whole,
           "arm = robot([revolute(a: 100), prismatic(limits: -9..100)], name: \"arm\")\n%s", text);
  build_scene(s, whole);
  for (size_t k = 0; k < 2; k++) {
    CagPlaceView p;
    const char *why = cag_session_robot_joint_place(s, 0, k, &p);
    const size_t n = strlen(found);
    if (why) {
      snprintf(found, sizeof found, "%s", why);
      break;
    }
    const char *line = whole;
    for (size_t i = 1; i < p.line; i++) line = strchr(line, '\n') + 1;
    assert_int_equal(p.line, p.end_line);
    snprintf(found + n, sizeof found - n, "%s%.*s", k ? "|" : "", (int)(p.end_column - p.column),
             line + p.column - 1);
  }
  if (strcmp(found, expected) != 0) fail_msg("%s: %s, expected %s", text, found, expected);
}

static void joint_values_are_found_in_the_script(void **state) {
  (void)state;
  CagSession *s = new_session();
  expect_said(s, "show posed(arm, [10deg, 20])\n", "10deg|20");
  expect_said(s, "show arm |> posed([-0.5rad, -2mm])\n", "-0.5rad|-2mm");
  expect_said(s, "show posed(q: [1deg, 2], robot: arm) |> translate([0, 0, 9])\n", "1deg|2");
  expect_said(s, "show arm\n  |> posed(\n    [\n      1deg, // first\n      2\n    ]\n  )\n",
              "1deg|2");
  expect_said(s, "param q = [1deg, 2]\nshow group([posed(arm, (q)), sphere(1)])\n", "1deg|2");
  expect_said(s, "q = [1deg, 2]\nr = q\nshot(a) = posed(a, r)\nshow shot(arm)\n", "1deg|2");
  expect_said(s, "show { p = [3deg, 4]\n  posed(arm, p) }\n", "3deg|4");
  expect_said(s, "show [for i in 0..1: arm |> posed([1deg, 2]) |> translate([i * 9, 0, 0])]\n",
              "1deg|2");
  expect_said(s, "show arm\n", "the script shows the robot without posed");
  expect_said(s, "show posed(arm)\n", "the script gives posed no q");
  expect_said(s, "show arm |> posed\n", "the script gives posed no q");
  expect_said(s, "show posed(arm, ik(arm, fk(arm, [1deg, 2])))\n", "the script computes q");
  expect_said(s, "show [for i in 0..1: posed(arm, [i * 9deg, 2])]\n",
              "the script computes values of q");
  expect_said(s, "r = [2]\nshow posed(arm, [1deg, ...r])\n", "the script computes values of q");
  expect_said(s, "shot(q) = posed(arm, q)\nshow shot([1deg, 2])\n", "the script computes q");
  cag_session_free(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parts_go_where_the_language_poses_them),
      cmocka_unit_test(rods_follow_slides),
      cmocka_unit_test(frames_are_those_of_forward_kinematics),
      cmocka_unit_test(targets_of_forward_kinematics_are_reached),
      cmocka_unit_test(a_drag_is_steady),
      cmocka_unit_test(robots_are_found_wherever_they_are_shown),
      cmocka_unit_test(a_robot_within_another_is_a_part_of_it),
      cmocka_unit_test(joints_have_the_units_of_the_script),
      cmocka_unit_test(wrong_values_are_errors),
      cmocka_unit_test(joint_values_are_found_in_the_script),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
