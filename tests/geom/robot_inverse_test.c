// Closed-form inverse kinematics: for arms of every structure that is known, each pose of random
// joint values is given back by all solutions, and one of them is the joint values it came from.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "geom/robot/inverse.h"
#include "geom/robot/numeric.h"

#define DEGREE (M_PI / 180)

typedef struct Row {
  CagJointKind kind;
  double theta, d, a, alpha; // degrees
} Row;
typedef struct Sample {
  const char *name;
  size_t n, least, most; // solutions of a pose
  Row rows[6];
} Sample;

#define R CAG_JOINT_REVOLUTE
#define P CAG_JOINT_PRISMATIC
static const Sample samples[] = {
    {"puma",
     6,
     8,
     8,
     {{R, 0, 0, 0, -90},
      {R, 0, 149.5, 432, 0},
      {R, 0, 0, 0, 90},
      {R, 0, 432, 0, -90},
      {R, 0, 0, 0, 90},
      {R, 0, 56.5, 0, 0}}},
    {"puma, axes the other way",
     6,
     8,
     8,
     {{R, 0, 0, 0, -90},
      {R, 0, 149.5, 432, 180},
      {R, 0, 0, 20.3, 90},
      {R, 0, 432, 0, 90},
      {R, 0, 0, 0, -90},
      {R, 0, 56.5, 0, 0}}},
    {"stanford",
     6,
     4,
     4,
     {{R, 0, 412, 0, -90},
      {R, 0, 154, 0, 90},
      {P, 0, 0, 0, 0},
      {R, 0, 0, 0, -90},
      {R, 0, 0, 0, 90},
      {R, 0, 263, 0, 0}}},
    {"shoulder beside the axis",
     6,
     4,
     8,
     {{R, 0, 400, 25, -90},
      {R, 0, 0, 455, 0},
      {R, -90, 0, 35, -90},
      {R, 0, 420, 0, 90},
      {R, 0, 0, 0, -90},
      {R, 0, 80, 0, 180}}},
    {"any arm with a wrist",
     6,
     2,
     8,
     {{R, 10, 100, 50, 60},
      {R, 20, 70, 300, 40},
      {R, -90, 30, 35, -70},
      {R, 0, 420, 0, 80},
      {R, 0, 0, 0, -60},
      {R, 0, 80, 20, 30}}},
    {"axes 1 and 2 parallel",
     6,
     2,
     8,
     {{R, 0, 100, 300, 0},
      {R, 0, 70, 50, 90},
      {R, 0, 30, 200, 28},
      {R, 0, 220, 0, 90},
      {R, 0, 0, 0, -90},
      {R, 0, 80, 0, 0}}},
    {"axes 2, 3, 4 parallel",
     6,
     2,
     8,
     {{R, 0, 89.159, 0, 90},
      {R, 0, 0, -425, 0},
      {R, 0, 0, -392.25, 0},
      {R, 0, 109.15, 0, 90},
      {R, 0, 94.65, 0, -90},
      {R, 0, 82.3, 0, 0}}},
    {"general, hand turned",
     6,
     4,
     8,
     {{R, 0, .8, 0, -90},
      {R, 0, 0, .9, 0},
      {R, 0, 0, .7, 0},
      {R, 0, 0, .25, 90},
      {R, 0, 0, 0, -90},
      {R, 0, .3, 0, -90}}},
    {"minimover",
     5,
     4,
     4,
     {{R, 0, 8.1, 0, -90}, {R, 0, 0, 7, 0}, {R, 0, 0, 7, 0}, {R, 0, 0, 0, 90}, {R, 0, 3.8, 0, 0}}},
    {"rhino",
     5,
     2,
     4,
     {{R, 0, 26.04, 0, -90},
      {R, 0, 0, 22.86, 0},
      {R, 0, 0, 22.86, 0},
      {R, 0, 0, .95, -90},
      {R, 0, 16.83, 0, 0}}},
    {"five axes, a pair at the end",
     5,
     2,
     4,
     {{R, 0, 10, 0, -90}, {R, 0, 0, 7, 90}, {R, 0, 0, 7, 0}, {R, 0, 0, 0, -90}, {R, 0, 0, 0, 90}}},
    {"scara",
     4,
     2,
     2,
     {{R, 0, 300, 400, 0}, {R, 0, 0, 300, 180}, {P, 0, 50, 0, 0}, {R, 0, 0, 0, 0}}},
    {"scara on a column",
     4,
     2,
     2,
     {{P, 30, 50, 40, 180}, {R, 0, 300, 400, 0}, {R, 0, 0, 300, 180}, {R, 0, 10, 20, 0}}},
    {"cylindrical", 3, 1, 1, {{R, 0, 0, 0, 0}, {P, 90, 0, 0, 90}, {P, 0, 0, 0, 0}}},
    {"spherical", 3, 1, 1, {{R, 0, 0, 0, 90}, {R, 90, 0, 0, 90}, {P, 0, 0, 0, 0}}},
    {"cartesian", 3, 1, 1, {{P, 0, 0, 0, -90}, {P, -90, 0, 0, -90}, {P, 0, 0, 0, 0}}},
    {"elbow", 3, 1, 1, {{R, 0, 100, 0, 90}, {R, 0, 0, 300, 0}, {R, 0, 0, 200, 0}}},
    {"planar", 3, 2, 2, {{R, 0, 0, 3, 0}, {R, 0, 0, 2, 0}, {R, 0, 0, 1, 0}}},
};
#define SAMPLES (sizeof samples / sizeof *samples)

// `fixed`: each row's crank as a fixed link of its own, and a base and a tool.
// `unit`: of length, in those of the table.
static CagRobot *make_in(const Sample *s, bool fixed, double unit) {
  CagRobotLink links[12];
  CagError err;
  CagRobot *r = NULL;
  CagRobotSpec spec = {
      .links = links, .base = cag_transform_identity(), .tool = cag_transform_identity()};
  for (size_t i = 0; i < s->n; i++) {
    const Row *row = &s->rows[i];
    CagRobotLink *l = &links[spec.link_count++];
    *l = cag_robot_link(row->kind);
    l->theta = row->theta * DEGREE;
    l->d = row->d / unit;
    if (row->kind == P) l->low = l->home = 1 / unit, l->high = 500 / unit;
    if (!fixed) {
      l->a = row->a / unit;
      l->alpha = row->alpha * DEGREE;
      continue;
    }
    l = &links[spec.link_count++];
    *l = cag_robot_link(CAG_JOINT_FIXED);
    l->fixed = cag_dh(0, 0, row->a / unit, row->alpha * DEGREE);
  }
  if (fixed) {
    spec.base = cag_dh(1, 2 / unit, 3 / unit, 0.4);
    spec.tool = cag_dh(0.3, 20 / unit, -3 / unit, 1.4);
  }
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_OK);
  return r;
}
static CagRobot *make(const Sample *s, bool fixed) { return make_in(s, fixed, 1); }

static uint32_t seed = 7;
static double random_share(void) {
  seed = seed * 1664525 + 1013904223;
  return (double)(seed >> 8) / (1 << 24);
}

static bool is_near(const CagRobot *r, const double *a, const double *b) {
  for (size_t i = 0; i < r->joint_count; i++) {
    const bool turns = r->links[i].kind != P;
    const double apart =
        turns ? fabs(remainder(a[i] - b[i], 2 * M_PI)) : fabs(a[i] - b[i]) / r->reach;
    if (apart > 1e-6) return false;
  }
  return true;
}

static void check_pose(const Sample *s, const CagRobot *r, const CagRobot *plain, const double *q) {
  CagTransform target, pose;
  CagInverse all;
  bool found = false;
  cag_robot_forward(r, q, &target);
  cag_robot_inverse(r, &target, NULL, &all);
  if (all.count < s->least || all.count > s->most)
    fail_msg("%s: %zu solutions", s->name, all.count);
  for (size_t i = 0; i < all.count; i++) {
    double way, turn;
    CagConfiguration c;
    cag_robot_forward(r, all.solutions[i].q, &pose);
    cag_robot_pose_distance(&pose, &target, &way, &turn);
    if (way > 1e-8 * r->reach || turn > 1e-8) fail_msg("%s: off by %g, %g", s->name, way, turn);
    found = found || is_near(plain, q, all.solutions[i].q);
    assert_true(cag_robot_configuration(r, all.solutions[i].q, &c));
    assert_memory_equal(&c, &all.solutions[i].configuration, sizeof c);
    for (size_t k = 0; k < i; k++)
      assert_false(is_near(plain, all.solutions[k].q, all.solutions[i].q));
  }
  if (!found) fail_msg("%s: the joint values are not among the solutions", s->name);
}

// Poses of random joint values, for the arm with its lengths in such units.
static void find_all_solutions(const Sample *s, double unit, int poses) {
  CagRobot *plain = make_in(s, false, unit), *built = make_in(s, true, unit);
  assert_true(cag_robot_has_inverse(plain));
  assert_true(cag_robot_has_inverse(built));
  for (int i = 0; i < poses; i++) {
    double q[6];
    for (size_t j = 0; j < s->n; j++)
      q[j] = s->rows[j].kind == P ? (50 + 400 * random_share()) / unit
                                  : (2 * random_share() - 1) * 3.1;
    check_pose(s, plain, plain, q);
    check_pose(s, built, plain, q);
  }
  cag_robot_release(plain);
  cag_robot_release(built);
}

static void all_solutions_are_found(void **state) {
  (void)state;
  for (size_t k = 0; k < SAMPLES; k++) {
    find_all_solutions(&samples[k], 1, 1000);
    find_all_solutions(&samples[k], 1000, 200); // metres
    find_all_solutions(&samples[k], 1e-3, 200); // micrometres
  }
}

// Example 14.1 of the reference: shoulder 1, elbow -1, wrist -1 of a PUMA 600.
static void branches_have_their_names(void **state) {
  (void)state;
  CagRobot *r = make(&samples[0], false);
  const double q[6] = {35 * DEGREE, -60 * DEGREE, 100 * DEGREE,
                       25 * DEGREE, -40 * DEGREE, 110 * DEGREE};
  CagConfiguration c;
  assert_true(cag_robot_configuration(r, q, &c));
  assert_int_equal(c.shoulder, 1);
  assert_int_equal(c.elbow, -1);
  assert_int_equal(c.wrist, -1);
  cag_robot_release(r);
}

static CagInverseStatus status_of(const CagRobot *r, const CagTransform *t) {
  CagInverse all;
  cag_robot_inverse(r, t, NULL, &all);
  return all.status;
}

static void what_is_not_reached_is_told(void **state) {
  (void)state;
  CagRobot *puma = make(&samples[0], false), *mini = make(&samples[8], false);
  CagTransform far = cag_translate(cag_vec3(1e4, 0, 0)),
               inside = cag_translate(cag_vec3(20, 0, 500));
  assert_int_equal(status_of(puma, &far), CAG_INVERSE_UNREACHABLE);
  assert_int_equal(status_of(puma, &inside),
                   CAG_INVERSE_UNREACHABLE);     // within the shoulder's cylinder
  CagTransform tilted = cag_dh(0.3, 12, 6, 0.7); // five joints cannot lean sideways
  assert_int_equal(status_of(mini, &tilted), CAG_INVERSE_ORIENTATION);
  cag_robot_release(puma);
  cag_robot_release(mini);
}

// Joint 5 at zero: joints 4 and 6 turn about one axis, and joint 4 stays where it is.
static void singular_families_are_told(void **state) {
  (void)state;
  CagRobot *r = make(&samples[0], false);
  const double q[6] = {35 * DEGREE, -60 * DEGREE, 100 * DEGREE, 25 * DEGREE, 0, 110 * DEGREE};
  const double near[6] = {0, 0, 0, 15 * DEGREE, 0, 0};
  CagTransform t;
  CagInverse all;
  cag_robot_forward(r, q, &t);
  cag_robot_inverse(r, &t, near, &all);
  assert_int_equal(all.status, CAG_INVERSE_SINGULAR);
  assert_int_equal(all.free, 8);
  bool found = false;
  for (size_t i = 0; i < all.count; i++) {
    if (!all.solutions[i].free) continue;
    found = true;
    assert_true(fabs(all.solutions[i].q[3] - 15 * DEGREE) < 1e-12);
    assert_true(fabs(all.solutions[i].q[5] - 120 * DEGREE) < 1e-9);
    assert_int_equal(all.solutions[i].configuration.wrist, 0);
  }
  assert_true(found);
  cag_robot_release(r);
}

static void other_chains_have_none(void **state) {
  (void)state;
  Sample skew = samples[0];
  skew.rows[3].a = 50; // no wrist center
  CagRobot *r = make(&skew, false);
  CagTransform t = cag_transform_identity();
  assert_false(cag_robot_has_inverse(r));
  assert_int_equal(status_of(r, &t), CAG_INVERSE_NO_CLOSED_FORM);
  cag_robot_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_solutions_are_found),     cmocka_unit_test(branches_have_their_names),
      cmocka_unit_test(what_is_not_reached_is_told), cmocka_unit_test(singular_families_are_told),
      cmocka_unit_test(other_chains_have_none),
  };
  return cmocka_run_group_tests_name("closed-form inverse kinematics", tests, NULL, NULL);
}
