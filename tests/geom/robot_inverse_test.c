// Closed-form inverse kinematics. For arms of every known structure, all solutions of a pose of
// random joint values lead back to the pose, and one of them consists of these values.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
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
  size_t n, least, most; // number of solutions of a pose
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
    {"planar, turned rows",
     3,
     2,
     2,
     {{R, 20, 5, 30, 180}, {R, -40, 7, 20, 180}, {R, 70, 3, 9, 50}}},
    {"slide first, two turns",
     3,
     1,
     1,
     {{P, 30, 0, 40, 180}, {R, 20, 30, 45, 180}, {R, -40, 30, 20, 0}}},
    {"slide between two turns",
     3,
     1,
     1,
     {{R, 20, 30, 45, 180}, {P, 30, 0, 40, 180}, {R, -40, 30, 20, 70}}},
    {"slide last, two turns",
     3,
     1,
     1,
     {{R, 20, 30, 45, 0}, {R, -40, 30, 20, 180}, {P, 30, 0, 40, 70}}},
    {"slide between three turns",
     4,
     2,
     2,
     {{R, 20, 30, 45, 180}, {P, 30, 0, 40, 180}, {R, -40, 30, 60, 0}, {R, 25, 6, 10, 0}}},
    {"slide and turn", 2, 1, 1, {{P, 30, 0, 40, 180}, {R, 20, 30, 45, 60}}},
    {"turn and slide", 2, 1, 1, {{R, 20, 30, 45, 180}, {P, 30, 0, 40, 60}}},
    {"turn", 1, 1, 1, {{R, 20, 30, 45, 60}}},
    {"three turns", 3, 1, 1, {{R, 10, 100, 50, 60}, {R, 20, 70, 300, 40}, {R, -90, 30, 135, -70}}},
    {"three turns, two parallel",
     3,
     1,
     1,
     {{R, 10, 50, 300, 180}, {R, 5, 70, 50, 70}, {R, 0, 30, 200, 28}}},
    {"two turns and a slide",
     3,
     1,
     1,
     {{R, 15, 30, 40, 70}, {R, -20, 25, 60, 50}, {P, 30, 0, 20, 10}}},
    {"a turn and two slides",
     3,
     1,
     1,
     {{R, 15, 30, 40, 70}, {P, 30, 0, 20, 50}, {P, 10, 0, 20, 10}}},
    {"three slides", 3, 1, 1, {{P, 15, 0, 40, 70}, {P, 30, 0, 20, 50}, {P, 10, 0, 20, 10}}},
    {"axes 2, 3, 4 parallel, either way",
     6,
     1,
     8,
     {{R, 10, 89, 30, -90},
      {R, 20, 20, 425, 180},
      {R, -15, 30, 392, 180},
      {R, 35, 109, 25, 90},
      {R, -5, 94, 0, 90},
      {R, 50, 82, 14, 40}}},
    {"five axes, 2, 3, 4 parallel, either way",
     5,
     1,
     4,
     {{R, 10, 26, 3, 90},
      {R, 20, 4, 23, 180},
      {R, -15, 6, 22, 0},
      {R, 35, 5, 1, 90},
      {R, 15, 17, 2, 25}}},
    {"axes 1 and 2 meet, wrist",
     6,
     2,
     8,
     {{R, 10, 100, 0, 60},
      {R, 20, 70, 300, 40},
      {R, -90, 30, 135, -70},
      {R, 0, 320, 0, 80},
      {R, 0, 0, 0, -60},
      {R, 0, 80, 20, 30}}},
    {"slide behind two turns, wrist",
     6,
     2,
     8,
     {{R, 10, 412, 0, -70},
      {R, 20, 154, 30, 60},
      {P, 15, 0, 10, 35},
      {R, 5, 20, 0, -80},
      {R, 25, 0, 0, 70},
      {R, -30, 263, 12, 20}}},
    {"slide towards both sides and a wrist",
     6,
     2,
     8,
     {{R, 10, 412, 0, -70},
      {R, 20, 254, 30, 120},
      {P, 15, 0, 10, 35},
      {R, 5, 20, 0, -80},
      {R, 25, 0, 0, 70},
      {R, -30, 263, 12, 20}}},
};
#define SAMPLES (sizeof samples / sizeof *samples)

// Rotates the frame of joint i about its axis, and moves it along the axis; `back` undoes this.
static CagTransform along_axis(size_t i, double unit, bool back) {
  const double sign = back ? -1 : 1;
  return cag_dh(sign * (0.7 + 1.3 * (double)i), sign * (double)(17 * i % 30 + 5) / unit, 0, 0);
}

// Makes the arm of a sample. If `fixed` is set, each row's crank is a separate fixed link between
// frames anywhere on the axes, and there is a base and a tool. `unit` is the length unit relative
// to that of the table.
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
    const CagTransform back = along_axis(i, unit, true), on = along_axis(i + 1, unit, false);
    l->fixed = cag_dh(0, 0, row->a / unit, row->alpha * DEGREE);
    l->fixed = cag_transform_multiply(&back, &l->fixed);
    if (i + 1 < s->n) l->fixed = cag_transform_multiply(&l->fixed, &on);
  }
  if (fixed) {
    const CagTransform on = along_axis(0, unit, false);
    spec.base = cag_dh(1, 2 / unit, 3 / unit, 0.4);
    spec.base = cag_transform_multiply(&spec.base, &on);
    spec.tool = cag_dh(0.3, 20 / unit, -3 / unit, 1.4);
  }
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_OK);
  return r;
}
static CagRobot *make(const Sample *s, bool fixed) { return make_in(s, fixed, 1); }

static uint32_t seed = 7;
static double random_fraction(void) {
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

static int sign(double x) { return x < 0 ? -1 : 1; }

// Checks the labels of joint values, using the frames of an arm given by rows: the side of the
// first axis on which the positioned point is, and the signs of the elbow and wrist angles.
static void check_labels(const Sample *s, const CagRobot *plain, const double *q,
                         const CagConfiguration *c) {
  CagTransform f[7];
  const Row *row = s->rows;
  const CagConfiguration has = cag_robot_branches(plain);
  assert_int_equal(abs(c->shoulder), has.shoulder);
  assert_int_equal(abs(c->elbow), has.elbow);
  assert_int_equal(abs(c->wrist), has.wrist);
  cag_robot_frames(plain, q, f);
  if (has.wrist) assert_int_equal(c->wrist, sign(sin(q[4] + row[4].theta * DEGREE)));
  const bool flat23 = fabs(sin(row[1].alpha * DEGREE)) < 1e-9,
             flat34 = fabs(sin(row[2].alpha * DEGREE)) < 1e-9;
  if (has.shoulder) {
    // The wrist's center; if the axes 2, 3, and 4 are parallel, the start of the last link, or the
    // tool.
    const bool parallel = s->n > 3 && flat23 && flat34;
    const size_t at = s->n == 3 ? 3 : parallel ? 5 : 4;
    double side = plain->links[0].a;
    for (int i = 0; i < 3; i++) side += f[1].m[i][0] * (f[at].m[i][3] - f[1].m[i][3]);
    if (c->shoulder != sign(side)) fail_msg("%s: shoulder %d, %g", s->name, c->shoulder, side);
    if (parallel) assert_int_equal(c->elbow, sign(sin(q[2] + row[2].theta * DEGREE)));
  }
  if (s->n == 6 && flat23 && !flat34 && has.elbow) {
    const double theta = q[2] + row[2].theta * DEGREE, a = row[1].a * cos(row[1].alpha * DEGREE),
                 side = row[2].a * sin(theta) - row[3].d * sin(row[2].alpha * DEGREE) * cos(theta);
    assert_int_equal(c->elbow, fabs(row[3].d) > fabs(row[2].a) ? -sign(a * side) : sign(a * side));
  }
  if (!has.shoulder && has.elbow) { // all axes parallel: the second revolute joint
    size_t turning = 0, k = 0;
    for (;; k++)
      if (row[k].kind == R && turning++ == 1) break;
    assert_int_equal(c->elbow, sign(sin(q[k] + row[k].theta * DEGREE)));
  }
}

static void check_pose(const Sample *s, const CagRobot *r, const CagRobot *plain, const double *q) {
  CagTransform target, pose;
  CagInverse all;
  bool found = false;
  // With fewer than six joints, not all poses are reachable. Joint values that almost reach a pose
  // count as solutions, too. Solutions other than those that created the target may therefore
  // deviate by this much.
  const double most = s->n < 6 ? 1e-6 : 1e-8;
  cag_robot_forward(r, q, &target);
  cag_robot_inverse(r, &target, NULL, &all);
  if (all.count < s->least || all.count > s->most)
    fail_msg("%s: %zu solutions", s->name, all.count);
  for (size_t i = 0; i < all.count; i++) {
    double way, turn;
    CagConfiguration c;
    cag_robot_forward(r, all.solutions[i].q, &pose);
    cag_robot_pose_distance(&pose, &target, &way, &turn);
    const bool same = is_near(plain, q, all.solutions[i].q);
    const double tolerance = same ? 1e-8 : most;
    if (way > tolerance * r->reach || turn > tolerance)
      fail_msg("%s: off by %g, %g", s->name, way, turn);
    found = found || same;
    assert_true(cag_robot_configuration(r, all.solutions[i].q, &c));
    assert_memory_equal(&c, &all.solutions[i].configuration, sizeof c);
    if (r == plain) check_labels(s, r, all.solutions[i].q, &c);
    assert_int_equal(all.solutions[i].free, 0);
    for (size_t k = 0; k < i; k++)
      assert_false(is_near(plain, all.solutions[k].q, all.solutions[i].q));
  }
  if (!found) fail_msg("%s: the joint values are not among the solutions", s->name);
  assert_int_equal(all.status, CAG_INVERSE_OK);
  // The branches of +1 come first.
  for (size_t i = 1; i < all.count; i++) {
    const CagConfiguration *a = &all.solutions[i - 1].configuration,
                           *b = &all.solutions[i].configuration;
    assert_true(9 * a->shoulder + 3 * a->elbow + a->wrist >=
                9 * b->shoulder + 3 * b->elbow + b->wrist);
  }
}

// Tests poses of random joint values for the arm, with its lengths in the given unit.
static void find_all_solutions(const Sample *s, double unit, int poses) {
  CagRobot *plain = make_in(s, false, unit), *built = make_in(s, true, unit);
  assert_true(cag_robot_has_inverse(plain));
  assert_true(cag_robot_has_inverse(built));
  for (int i = 0; i < poses; i++) {
    double q[6];
    for (size_t j = 0; j < s->n; j++)
      q[j] = s->rows[j].kind == P ? (50 + 400 * random_fraction()) / unit
                                  : (2 * random_fraction() - 1) * 3.1;
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
    find_all_solutions(&samples[k], 1000, 200); // meters
    find_all_solutions(&samples[k], 1e-3, 200); // micrometres
  }
}

static CagInverseStatus status_of(const CagRobot *r, const CagTransform *t) {
  CagInverse all;
  cag_robot_inverse(r, t, NULL, &all);
  return all.status;
}

// For planar chains of one or two revolute joints, and for three revolute joints, all ways to move
// the tool's origin to a point.
static void all_ways_to_a_point_are_found(void **state) {
  (void)state;
  static const struct {
    const char *name;
    size_t most;
  } arms[] = {
      {"elbow", 4},          {"slide first, two turns", 2},    {"slide between two turns", 2},
      {"three turns", 4},    {"slide last, two turns", 2},     {"turn", 1},
      {"slide and turn", 1}, {"three turns, two parallel", 4}, {"turn and slide", 1}};
  for (size_t k = 0; k < SAMPLES; k++) {
    size_t most = 0;
    for (size_t i = 0; i < sizeof arms / sizeof *arms; i++)
      if (!strcmp(arms[i].name, samples[k].name)) most = arms[i].most;
    const Sample *s = &samples[k];
    for (int fixed = 0; fixed < 2; fixed++) {
      CagRobot *plain = make(s, false), *r = make(s, fixed);
      assert_int_equal(cag_robot_has_point_inverse(r), most > 0);
      for (int pose = 0; pose < 300; pose++) {
        double q[6];
        CagTransform target, at;
        CagInverse all;
        for (size_t j = 0; j < s->n; j++)
          q[j] = s->rows[j].kind == P ? 50 + 400 * random_fraction()
                                      : (2 * random_fraction() - 1) * 3.1;
        cag_robot_forward(r, q, &target);
        const CagVec3 p = cag_vec3(target.m[0][3], target.m[1][3], target.m[2][3]);
        cag_robot_inverse_point(r, p, NULL, &all);
        if (!most) {
          assert_int_equal(all.status, CAG_INVERSE_NO_CLOSED_FORM);
          assert_int_equal(all.count, 0);
          break;
        }
        assert_int_equal(all.status, CAG_INVERSE_OK);
        assert_true(all.count >= 1 && all.count <= most);
        bool found = false;
        for (size_t i = 0; i < all.count; i++) {
          CagConfiguration c;
          cag_robot_forward(r, all.solutions[i].q, &at);
          const CagVec3 there = cag_vec3(at.m[0][3], at.m[1][3], at.m[2][3]);
          if (cag_norm(cag_sub(there, p)) > 1e-6 * r->reach)
            fail_msg("%s: off by %g", s->name, cag_norm(cag_sub(there, p)));
          found = found || is_near(plain, q, all.solutions[i].q);
          assert_true(cag_robot_configuration(r, all.solutions[i].q, &c));
          assert_memory_equal(&c, &all.solutions[i].configuration, sizeof c);
          for (size_t j = 0; j < i; j++)
            assert_false(is_near(plain, all.solutions[j].q, all.solutions[i].q));
        }
        if (!found) fail_msg("%s: the joint values are not among the solutions", s->name);
        // At twice the reach from the base, nothing is reachable.
        const CagVec3 away = cag_madd(p, 3 * r->reach + 1000, cag_vec3(1, 0.1, 0));
        cag_robot_inverse_point(r, away, NULL, &all);
        if (s->rows[0].kind == R && s->rows[s->n - 1].kind == R) {
          assert_int_equal(all.status, CAG_INVERSE_UNREACHABLE);
          assert_int_equal(all.count, 0);
        }
      }
      cag_robot_release(plain);
      cag_robot_release(r);
    }
  }
}

static const Sample *sample_of(const char *name) {
  for (size_t k = 0; k < SAMPLES; k++)
    if (!strcmp(samples[k].name, name)) return &samples[k];
  fail_msg("no sample %s", name);
  return NULL;
}

// Poses in which joints compensate each other, as rows of degrees. The free joints have the
// preferred values, and the others achieve the pose.
static void free_joints_stand_where_they_are_wished(void **state) {
  (void)state;
  static const struct {
    const char *name;
    unsigned free;
    double q[6];
  } poses[] = {
      {"puma", 8, {35, -60, 100, 25, 0, 110}},
      {"puma", 8, {35, -60, 100, 25, 180, 110}},
      {"puma", 2, {35, -60, -90, 25, 30, 110}}, // folded: the wrist's center is on axis 2
      {"stanford", 8, {35, -60, 100, 25, 0, 110}},
      {"shoulder beside the axis", 8, {20, 30, 40, 50, 0, 60}},
      {"axes 2, 3, 4 parallel", 8, {20, 30, 40, 50, 0, 60}},
      {"axes 2, 3, 4 parallel", 8, {20, 30, 40, 50, 180, 60}},
      {"axes 2, 3, 4 parallel, either way", 8, {20, 30, 40, 50, 5, 60}},
      {"axes 2, 3, 4 parallel, either way", 8, {20, 30, 40, 50, 185, 60}},
  };
  for (size_t k = 0; k < sizeof poses / sizeof *poses; k++)
    for (int fixed = 0; fixed < 2; fixed++)
      for (int turn = 0; turn < 5; turn++) {
        const Sample *s = sample_of(poses[k].name);
        CagRobot *r = make(s, fixed);
        double q[6], near[6], way, rotation;
        CagTransform target, pose;
        CagInverse all;
        unsigned free = 0;
        for (size_t i = 0; i < s->n; i++)
          q[i] = s->rows[i].kind == P ? poses[k].q[i] : poses[k].q[i] * DEGREE;
        for (size_t i = 0; i < s->n; i++) near[i] = q[i] + 0.2 * random_fraction();
        cag_robot_forward(r, q, &target);
        cag_robot_inverse(r, &target, near, &all);
        if (all.status != CAG_INVERSE_SINGULAR)
          fail_msg("%s, %zu: status %d", s->name, k, all.status);
        for (size_t i = 0; i < all.count; i++) {
          const CagInverseSolution *one = &all.solutions[i];
          free |= one->free;
          cag_robot_forward(r, one->q, &pose);
          cag_robot_pose_distance(&pose, &target, &way, &rotation);
          if (way > 2e-6 * r->reach || rotation > 2e-6)
            fail_msg("%s: off by %g, %g", s->name, way, rotation);
          // With parallel axes 2 to 4, the three are free together, and joint 4 represents them.
          const bool parallel = !strncmp(s->name, "axes 2", 6);
          double apart = 0;
          for (size_t j = 0; j < s->n; j++)
            if (one->free >> j & 1 && !parallel) apart = fmax(apart, fabs(one->q[j] - near[j]));
          if (apart > 1e-9) fail_msg("%s: %g from where it is wished", s->name, apart);
        }
        assert_int_equal(free, all.free);
        if (!(all.free & poses[k].free)) fail_msg("%s: joint is not free", s->name);
        cag_robot_release(r);
      }
}

// Two folded links of equal length: the first has the preferred angle.
static void folded_links_turn_as_they_are_wished(void **state) {
  (void)state;
  for (int k = 0; k < 20; k++) {
    Sample s = *sample_of(k % 2 ? "slide first, two turns" : "slide last, two turns");
    const size_t first = k % 2;
    if (!first) s.rows[2].a = 0;
    s.rows[first].a = s.rows[first + 1].a = 25;
    CagRobot *r = make(&s, false);
    double q[3] = {100, 100, 100}, near[3];
    CagTransform target, pose;
    CagInverse all;
    q[first] = 2 * random_fraction() - 1;
    q[first + 1] = (180 + 40) * DEGREE;
    for (size_t i = 0; i < 3; i++) near[i] = 2 * random_fraction() - 1;
    cag_robot_forward(r, q, &target);
    const CagVec3 p = cag_vec3(target.m[0][3], target.m[1][3], target.m[2][3]);
    cag_robot_inverse_point(r, p, near, &all);
    assert_int_equal(all.count, 1);
    assert_int_equal(all.free, 1u << first);
    assert_true(fabs(all.solutions[0].q[first] - near[first]) < 1e-9);
    cag_robot_forward(r, all.solutions[0].q, &pose);
    for (int i = 0; i < 3; i++) assert_true(fabs(pose.m[i][3] - target.m[i][3]) < 1e-9);
    cag_robot_release(r);
  }
}

// The tool of five joints is above the first axis, so the direction of the hand determines the
// first joint.
static void hands_over_the_first_axis_are_found(void **state) {
  (void)state;
  const Sample *s = sample_of("minimover");
  for (int k = 0; k < 20; k++) {
    CagRobot *r = make(s, k % 2);
    double q[6];
    CagTransform target;
    CagInverse all;
    for (int i = 0; i < 5; i++) q[i] = 2 * random_fraction() - 1;
    q[2] = M_PI - 2 * q[1]; // 7 cos(q2) + 7 cos(q2 + q3) = 0
    cag_robot_forward(r, q, &target);
    cag_robot_inverse(r, &target, NULL, &all);
    bool found = false;
    for (size_t i = 0; i < all.count; i++) {
      double way, turn;
      CagTransform pose;
      cag_robot_forward(r, all.solutions[i].q, &pose);
      cag_robot_pose_distance(&pose, &target, &way, &turn);
      assert_true(way < 1e-6 && turn < 1e-6);
      found = found || is_near(r, q, all.solutions[i].q);
    }
    assert_true(found);
    assert_int_equal(all.free, 0);
    cag_robot_release(r);
  }
}

// A reachable point with an unreachable orientation, compared with an unreachable point.
static void turns_and_places_are_told_apart(void **state) {
  (void)state;
  static const char *const names[] = {"slide first, two turns", "turn", "planar", "slide and turn",
                                      "slide last, two turns"};
  for (int k = 0; k < 100; k++) {
    const Sample *s = sample_of(names[k % 5]);
    CagRobot *r = make(s, false);
    double q[6];
    CagTransform target;
    const CagTransform turned = cag_dh(0.4, 0, 0, 0), leaning = cag_dh(0, 0, 0, 0.4);
    for (size_t i = 0; i < s->n; i++) q[i] = s->rows[i].kind == P ? 100 : 2 * random_fraction() - 1;
    cag_robot_forward(r, q, &target);
    const double beyond = 2 * r->reach;
    // A planar arm cannot lean out of its plane.
    CagTransform other = cag_transform_multiply(&target, &leaning);
    assert_int_equal(status_of(r, &other), CAG_INVERSE_ORIENTATION);
    if (k % 5 != 2 && s->rows[s->n - 1].alpha == 0) {
      other = cag_transform_multiply(&target, &turned);
      assert_int_equal(status_of(r, &other), CAG_INVERSE_ORIENTATION);
    }
    other = target;
    for (int i = 0; i < 3; i++) other.m[i][3] += beyond * r->before.m[i][0];
    assert_int_equal(status_of(r, &other), CAG_INVERSE_UNREACHABLE);
    cag_robot_release(r);
  }
}

// If the axis of a joint passes through the tool, before or after a prismatic joint, the joint is
// free.
static void turns_that_place_nothing_are_free(void **state) {
  (void)state;
  for (int k = 0; k < 40; k++) {
    Sample s = *sample_of(k % 2 ? "slide first, two turns" : "slide between two turns");
    const size_t first = k % 2, second = 2;
    const bool at_point = k % 4 >= 2; // the target is a point that joint 3 does not move
    if (at_point) s.rows[2].a = 0;
    else if (k % 2) s.rows[1].a = 0;
    else s.rows[0].a = s.rows[1].a = 0;
    CagRobot *r = make(&s, false);
    double q[3], near[3];
    CagTransform target, pose;
    CagInverse all;
    for (size_t i = 0; i < 3; i++) q[i] = s.rows[i].kind == P ? 100 : 2 * random_fraction() - 1;
    for (size_t i = 0; i < 3; i++) near[i] = 2 * random_fraction() - 1;
    cag_robot_forward(r, q, &target);
    const CagVec3 p = cag_vec3(target.m[0][3], target.m[1][3], target.m[2][3]);
    if (at_point) cag_robot_inverse_point(r, p, near, &all);
    else cag_robot_inverse(r, &target, near, &all);
    assert_int_equal(all.status, CAG_INVERSE_SINGULAR);
    assert_int_equal(all.count, 1);
    const size_t joint = at_point ? second : first;
    assert_int_equal(all.free, 1u << joint);
    assert_int_equal(all.solutions[0].free, all.free);
    assert_true(fabs(all.solutions[0].q[joint] - near[joint]) < 1e-9);
    cag_robot_forward(r, all.solutions[0].q, &pose);
    double way, turn;
    cag_robot_pose_distance(&pose, &target, &way, &turn);
    assert_true(way < 1e-9 * r->reach && (at_point || turn < 1e-9));
    cag_robot_release(r);
  }
}

// Stretched or folded arms have one branch where others have two. They are found although rounding
// makes the pose unreachable.
static void stretched_and_folded_arms_are_found(void **state) {
  (void)state;
  static const struct {
    const char *name;
    size_t joint;
    double straight; // degrees
  } arms[] = {{"planar", 1, 0},
              {"planar, turned rows", 1, 40},
              {"elbow", 2, 0},
              {"axes 2, 3, 4 parallel", 2, 0},
              {"minimover", 2, 0},
              {"rhino", 2, 0},
              {"puma", 2, 90},
              {"scara", 1, 0},
              {"scara on a column", 2, 0},
              {"stanford", 1, 0}};
  const size_t count = sizeof arms / sizeof *arms;
  for (size_t k = 0; k < 3 * count; k++) {
    const double unit = k < count ? 1 : k < 2 * count ? 1000 : 1e-3; // as above
    const Sample *s = sample_of(arms[k % count].name);
    CagRobot *r = make_in(s, false, unit);
    for (int pose = 0; pose < 60; pose++) {
      double q[6], best = INFINITY, way, turn;
      CagTransform target, at;
      CagInverse all;
      for (size_t j = 0; j < s->n; j++)
        q[j] = s->rows[j].kind == P ? (50 + 400 * random_fraction()) / unit
                                    : (2 * random_fraction() - 1) * 3.1;
      q[arms[k % count].joint] = (arms[k % count].straight + (pose % 2 ? 180 : 0)) * DEGREE;
      cag_robot_forward(r, q, &target);
      cag_robot_inverse(r, &target, NULL, &all);
      // Minimover and puma fold to a point; see the free joints.
      if (pose % 2 && (!strcmp(s->name, "minimover") || !strcmp(s->name, "puma"))) continue;
      if (pose % 2 && !strcmp(s->name, "rhino")) continue;
      for (size_t i = 0; i < all.count; i++) {
        double apart = 0;
        cag_robot_forward(r, all.solutions[i].q, &at);
        cag_robot_pose_distance(&at, &target, &way, &turn);
        if (way > 2e-6 * r->reach || turn > 2e-6) fail_msg("%s: off by %g, %g", s->name, way, turn);
        for (size_t j = 0; j < s->n; j++)
          apart = fmax(apart, s->rows[j].kind == P
                                  ? fabs(q[j] - all.solutions[i].q[j]) / r->reach
                                  : fabs(remainder(q[j] - all.solutions[i].q[j], 2 * M_PI)));
        best = fmin(best, apart);
      }
      if (!(best < 1e-3)) fail_msg("%s: the joint values are %g away", s->name, best);
      // A thousandth farther is unreachable.
      if (s->n == 3 && !(pose % 2) && strcmp(s->name, "elbow") == 0) {
        for (int i = 0; i < 2; i++) target.m[i][3] *= 1.001;
        cag_robot_inverse(r, &target, NULL, &all);
        assert_int_equal(all.count, 0);
      }
    }
    cag_robot_release(r);
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

static void what_is_not_reached_is_told(void **state) {
  (void)state;
  CagRobot *puma = make(&samples[0], false), *mini = make(&samples[8], false);
  CagTransform far = cag_translate(cag_vec3(1e4, 0, 0)),
               inside = cag_translate(cag_vec3(20, 0, 500));
  assert_int_equal(status_of(puma, &far), CAG_INVERSE_UNREACHABLE);
  assert_int_equal(status_of(puma, &inside),
                   CAG_INVERSE_UNREACHABLE);     // inside the shoulder's cylinder
  CagTransform tilted = cag_dh(0.3, 12, 6, 0.7); // five joints cannot lean sideways
  assert_int_equal(status_of(mini, &tilted), CAG_INVERSE_ORIENTATION);
  cag_robot_release(puma);
  cag_robot_release(mini);
}

// If joint 5 is zero, joints 4 and 6 rotate about the same axis, and joint 4 keeps its value.
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
  static const struct {
    const char *name;
    size_t row;
    Row with;
  } changes[] = {
      {"puma", 4, {R, 0, 5, 0, 90}},                 // axes 4 and 6 do not meet
      {"puma", 4, {R, 0, 0, 5, 90}},                 //
      {"puma", 4, {R, 0, 0, 0, 0}},                  // axes 5 and 6 parallel
      {"puma", 4, {P, 0, 0, 0, 90}},                 // no wrist
      {"puma", 1, {R, 0, 149.5, 0, 0}},              // axes 2 and 3 coincide
      {"puma", 0, {R, 0, 0, 10, 0}},                 // axes 1, 2, 3 parallel
      {"puma", 0, {P, 0, 0, 0, -90}},                // a prismatic joint before
      {"puma", 1, {P, 0, 149.5, 432, 0}},            //
      {"puma", 3, {R, 0, 0, 0, -90}},                // joint 3 rotates about the wrist's center
      {"axes 1 and 2 parallel", 0, {R, 0, 9, 0, 0}}, // axes 1 and 2 coincide
      {"stanford", 0, {R, 0, 412, 5, -90}},          // a prismatic joint, and skew axes 1 and 2
      {"stanford", 0, {R, 0, 412, 0, 0}},            // or parallel ones
      {"axes 2, 3, 4 parallel", 0, {R, 0, 89, 0, 80}},
      {"axes 2, 3, 4 parallel", 0, {R, 0, 89, 0, 100}},
      {"axes 2, 3, 4 parallel", 3, {R, 0, 109, 0, 100}},
      {"axes 2, 3, 4 parallel", 4, {R, 0, 94, 0, -100}},
      {"axes 2, 3, 4 parallel", 1, {R, 0, 0, 0, 0}},
      {"axes 2, 3, 4 parallel", 2, {R, 0, 0, 0, 0}},
      {"axes 2, 3, 4 parallel", 3, {R, 0, 109, 0, 80}},
      {"axes 2, 3, 4 parallel", 4, {R, 0, 94, 0, -80}},
      {"axes 2, 3, 4 parallel", 4, {R, 0, 94, 7, -90}},
      {"axes 2, 3, 4 parallel", 5, {P, 0, 94, 7, -90}},
      {"five axes, a pair at the end", 3, {R, 0, 0, 5, -90}},
      {"five axes, a pair at the end", 3, {R, 0, 0, 0, 0}},
      {"scara", 2, {R, 0, 50, 0, 40}},
      {"scara", 3, {P, 0, 0, 0, 0}}, // two prismatic joints along one axis
      {"cylindrical", 0, {P, 0, 0, 0, 0}},
      {"spherical", 0, {R, 0, 0, 5, 0}},
  };
  for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
    Sample s = *sample_of(changes[k].name);
    s.rows[changes[k].row] = changes[k].with;
    r = make(&s, false);
    const bool has = !strcmp(s.name, "cylindrical"); // three prismatic joints in any directions
    if (cag_robot_has_inverse(r) != has) fail_msg("%s, change %zu", s.name, k);
    assert_int_equal(status_of(r, &t) == CAG_INVERSE_NO_CLOSED_FORM, !has);
    const CagConfiguration none = cag_robot_branches(r);
    assert_true(!none.shoulder && !none.elbow && !none.wrist);
    cag_robot_release(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_solutions_are_found),
      cmocka_unit_test(all_ways_to_a_point_are_found),
      cmocka_unit_test(free_joints_stand_where_they_are_wished),
      cmocka_unit_test(turns_that_place_nothing_are_free),
      cmocka_unit_test(folded_links_turn_as_they_are_wished),
      cmocka_unit_test(hands_over_the_first_axis_are_found),
      cmocka_unit_test(turns_and_places_are_told_apart),
      cmocka_unit_test(stretched_and_folded_arms_are_found),
      cmocka_unit_test(branches_have_their_names),
      cmocka_unit_test(what_is_not_reached_is_told),
      cmocka_unit_test(singular_families_are_told),
      cmocka_unit_test(other_chains_have_none),
  };
  return cmocka_run_group_tests_name("closed-form inverse kinematics", tests, NULL, NULL);
}
