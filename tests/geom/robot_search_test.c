// Numerical inverse kinematics, compared with the test's own linear algebra: steps of minimal
// length, positions of minimal error, null space motion, and the sequence of starts.

#include "geom/robot/numeric.h"
#include "random.h"
#include "support.h"

#define JOINTS 16

static CagVec3 random_direction(void) {
  CagVec3 k;
  do {
    k.x = uniform(-1, 1);
    k.y = uniform(-1, 1);
    k.z = uniform(-1, 1);
  } while (cag_norm(k) > 1 || cag_norm(k) < 0.1);
  return cag_unit(k);
}

static CagTransform turned(CagVec3 axis, double angle) {
  CagTransform t;
  OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &t, &err));
  return t;
}

// An arm of n joints. The bits of `slides` select prismatic joints, and those of `screws` select
// screw joints.
static CagRobot *random_arm_with_screws(size_t n, unsigned slides, unsigned screws, double low,
                                        double high) {
  CagRobotLink links[JOINTS];
  CagRobotSpec spec = {.links = links, .link_count = n, .tool = cag_transform_identity()};
  CagRobot *r = NULL;
  for (size_t i = 0; i < n; i++) {
    const bool slide = slides >> i & 1;
    links[i] = cag_robot_link(slide ? CAG_JOINT_PRISMATIC : CAG_JOINT_REVOLUTE);
    links[i].theta = uniform(-1, 1);
    links[i].d = uniform(0.2, 0.6);
    links[i].a = uniform(0.1, 0.5);
    links[i].alpha = uniform(0.6, 1.6) * (i % 2 ? 1 : -1);
    links[i].low = low;
    links[i].high = high;
    if (screws >> i & 1) links[i].screw = 0.1;
  }
  const CagVec3 axis = random_direction();
  spec.base = turned(axis, uniform(-3, 3));
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

static CagRobot *random_arm(size_t n, unsigned slides, double low, double high) {
  return random_arm_with_screws(n, slides, 0, low, high);
}

static void random_joints(const CagRobot *r, double *q) {
  for (size_t i = 0; i < r->joint_count; i++) {
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    q[i] = uniform(l->low, l->high);
  }
}

// The length that corresponds to one unit of the joint's value: for a radian, the reach.
static double unit_of(const CagRobot *r, size_t joint) {
  return r->links[r->joint_link[joint]].kind == CAG_JOINT_REVOLUTE ? 1 : r->reach;
}

// Rows (velocities of the tool relative to the reach) over the joints in their units, without the
// fixed joints, orthonormalized twice by Gram-Schmidt.
static void orthonormal_rows(const CagRobot *r, const double *q, const bool *held, size_t rows,
                             double out[6][JOINTS]) {
  double columns[JOINTS][6];
  const size_t n = r->joint_count;
  cag_robot_jacobian(r, q, columns, NULL);
  for (size_t k = 0; k < rows; k++) {
    double length = 0;
    for (size_t i = 0; i < n; i++)
      out[k][i] = held && held[i] ? 0 : columns[i][k] * unit_of(r, i) / (k < 3 ? r->reach : 1);
    for (size_t j = 0; j < 2 * k; j++) {
      double dot = 0;
      for (size_t i = 0; i < n; i++) dot += out[k][i] * out[j % k][i];
      for (size_t i = 0; i < n; i++) out[k][i] -= dot * out[j % k][i];
    }
    for (size_t i = 0; i < n; i++) length += out[k][i] * out[k][i];
    for (size_t i = 0; i < n; i++) out[k][i] /= sqrt(length);
  }
}

// Removes the component of x in the span of the rows, and returns the length of the rest.
static double without_rows(double rows[6][JOINTS], size_t row_count, size_t n, double *x) {
  double length = 0;
  for (size_t k = 0; k < 2 * row_count; k++) {
    double dot = 0;
    for (size_t i = 0; i < n; i++) dot += x[i] * rows[k % row_count][i];
    for (size_t i = 0; i < n; i++) x[i] -= dot * rows[k % row_count][i];
  }
  for (size_t i = 0; i < n; i++) length += x[i] * x[i];
  return sqrt(length);
}

static void free_motion_is_what_the_rows_leave(void **state) {
  (void)state;
  seed = 1;
  for (int trial = 0; trial < 60; trial++) {
    const size_t n = 7 + (size_t)trial % 6;
    CagRobot *r = random_arm(n, trial % 3 ? 1u << trial % 7 : 0, -2, 2);
    double q[JOINTS], dq[JOINTS], x[JOINTS], out[JOINTS], rows[6][JOINTS];
    random_joints(r, q);
    for (size_t i = 0; i < n; i++) {
      dq[i] = uniform(-1, 1);
      x[i] = dq[i] / unit_of(r, i);
    }
    orthonormal_rows(r, q, NULL, 6, rows);
    without_rows(rows, 6, n, x);
    cag_robot_null_motion(r, q, dq, out);
    for (size_t i = 0; i < n; i++) NEAR(out[i], x[i] * unit_of(r, i), 1e-6);
    cag_robot_release(r);
  }
}

// From a nearby start, the motion to a solution is the shortest up to its curvature, and follows
// Newton's method: each step squares the error. Joints at limits that would be exceeded stay there.
static void near_solutions_are_found_by_the_shortest_way(void **state) {
  (void)state;
  seed = 2;
  size_t regular = 0, at_limits = 0;
  for (int trial = 0; trial < 600; trial++) {
    const double small = 1e-3, limit = 1.5;
    const bool point = trial % 4 == 3;
    const size_t n = (point ? 4 : 7) + (size_t)trial % 5, row_count = point ? 3 : 6;
    CagRobot *r = random_arm(n, trial % 3 ? 1u << trial % 7 : 0, -limit, limit);
    double q[JOINTS], there[JOINTS], found[JOINTS], way[JOINTS], rows[6][JOINTS], values[6];
    bool held[JOINTS] = {0};
    size_t count, rank;
    CagTransform wanted;
    random_joints(r, q);
    // In every other trial, one joint is at a limit.
    const size_t limited = (size_t)uniform(0, (double)n);
    if (trial % 2) q[limited] = trial % 8 < 4 ? -limit : limit;
    for (size_t i = 0; i < n; i++) there[i] = q[i] + uniform(-small, small) * unit_of(r, i);
    cag_robot_forward(r, there, &wanted);
    const CagRobotSearch search = {.near = q, .starts = 1, .position_only = point};
    const CagRobotFound f = cag_robot_search(r, &wanted, &search, found);
    OK(cag_robot_singular_values(r, q, values, &count, &rank, &err));
    if (values[count - 1] > 0.1) {
      regular++;
      assert_true(f.solved);
      if (trial % 2 == 0) assert_in_range(f.steps, 1, 3);
      for (size_t i = 0; i < n; i++) {
        assert_true(fabs(found[i]) <= limit);
        held[i] = fabs(found[i]) > limit - 1e-4 * unit_of(r, i);
        at_limits += held[i];
        way[i] = held[i] ? 0 : (found[i] - q[i]) / unit_of(r, i);
      }
      orthonormal_rows(r, q, held, row_count, rows);
      double length = 0;
      for (size_t i = 0; i < n; i++) length += way[i] * way[i];
      assert_true(without_rows(rows, row_count, n, way) < 30 * length);
    }
    cag_robot_release(r);
  }
  assert_true(regular > 80 && at_limits > 30);
}

// Revolute joints may be off by full turns, but screw joints may not, because each of their turns
// advances by the lead. The start of the search may be outside of the limits.
static void solutions_are_turned_as_near_as_limits_let(void **state) {
  (void)state;
  seed = 7;
  int solved = 0, turns_left = 0;
  for (int trial = 0; trial < 200; trial++) {
    const double low = uniform(-12, -1), high = uniform(1, 12);
    const unsigned screws = trial % 2 ? 1u << trial / 2 % 6 : 0;
    CagRobot *r = random_arm_with_screws(6, 0, screws, low, high);
    double there[6], near[6], found[6];
    CagTransform wanted;
    random_joints(r, there);
    for (int i = 0; i < 6; i++) near[i] = trial % 3 ? there[i] + uniform(-9, 9) : uniform(-40, 40);
    cag_robot_forward(r, there, &wanted);
    const CagRobotSearch search = {.near = near, .starts = 20};
    if (cag_robot_search(r, &wanted, &search, found).solved) {
      solved++;
      CagTransform got;
      double position, rotation;
      cag_robot_forward(r, found, &got);
      cag_robot_pose_distance(&got, &wanted, &position, &rotation);
      NEAR(position, 0, 1e-8);
      NEAR(rotation, 0, 1e-8);
      for (size_t i = 0; i < 6; i++) {
        assert_true(found[i] >= low && found[i] <= high);
        for (int k = -4; k <= 4; k++) {
          const double other = found[i] + k * 2 * M_PI;
          if (other < low || other > high || screws >> i & 1) continue;
          assert_true(fabs(other - near[i]) > fabs(found[i] - near[i]) - 1e-6);
          turns_left += k != 0;
        }
      }
    }
    cag_robot_release(r);
  }
  assert_true(solved > 100 && turns_left > 200);
}

// The squared error of a pose, with lengths relative to the reach.
static double error_at(const CagRobot *r, const double *q, const CagTransform *wanted, bool point) {
  CagTransform t;
  double position, rotation;
  cag_robot_forward(r, q, &t);
  cag_robot_pose_distance(&t, wanted, &position, &rotation);
  position /= r->reach;
  return position * position + (point ? 0 : rotation * rotation);
}

// If the target is unreachable, the gradient of the error at the result is 0, except toward limits.
static void what_is_out_of_reach_is_come_near_to(void **state) {
  (void)state;
  seed = 3;
  size_t at_limits = 0;
  for (int trial = 0; trial < 60; trial++) {
    const double h = 1e-5;
    const bool point = trial % 4 == 0;
    const size_t n = 3 + (size_t)trial % 6;
    CagRobot *r = random_arm(n, trial % 3 == 1 ? 2 : 0, -1.25, 1.5);
    const CagVec3 axis = random_direction(), way = random_direction();
    CagTransform wanted = turned(axis, uniform(-2, 2));
    for (int i = 0; i < 3; i++)
      wanted.m[i][3] = (i == 0 ? way.x : i == 1 ? way.y : way.z) * r->reach * 1.25;
    double q[JOINTS];
    const CagRobotSearch search = {.position_only = point, .steps = 300};
    const CagRobotFound f = cag_robot_search(r, &wanted, &search, q);
    assert_false(f.solved);
    assert_in_range(f.steps, 1, 300);
    NEAR((f.position / r->reach) * (f.position / r->reach) + f.rotation * f.rotation,
         error_at(r, q, &wanted, point), 1e-12);
    for (size_t i = 0; i < n; i++) {
      double at = q[i], step = h * unit_of(r, i), sides[2];
      assert_true(at >= -1.25 && at <= 1.5);
      for (int side = 0; side < 2; side++) {
        q[i] = at + (side ? step : -step);
        sides[side] = error_at(r, q, &wanted, point);
      }
      q[i] = at;
      const double slope = (sides[1] - sides[0]) / (2 * h);
      if (at == -1.25) assert_true(slope > -1e-6);
      else if (at == 1.5) assert_true(slope < 1e-6);
      else NEAR(slope, 0, 1e-6);
      at_limits += at == -1.25 || at == 1.5;
    }
    cag_robot_release(r);
  }
  assert_true(at_limits > 20);
}

// For a redundant chain, no null space motion brings the result closer to the preferred values.
static void wishes_are_met_as_far_as_the_tool_lets(void **state) {
  (void)state;
  seed = 4;
  size_t inside = 0;
  for (int trial = 0; trial < 40; trial++) {
    const size_t n = 7 + (size_t)trial % 3;
    CagRobot *r = random_arm(n, trial % 3 == 1 ? 4 : 0, -2.5, 2.5);
    double q[JOINTS], near[JOINTS], found[JOINTS], wish[JOINTS], rows[6][JOINTS];
    CagTransform wanted, got;
    random_joints(r, q);
    for (size_t i = 0; i < n; i++) q[i] /= 2;
    cag_robot_forward(r, q, &wanted);
    for (size_t i = 0; i < n; i++) near[i] = q[i] + uniform(-0.3, 0.3);
    const CagRobotSearch search = {.near = near, .stay_near = true};
    assert_true(cag_robot_search(r, &wanted, &search, found).solved);
    double position, rotation;
    cag_robot_forward(r, found, &got);
    cag_robot_pose_distance(&got, &wanted, &position, &rotation);
    assert_true(position < 1e-9 * r->reach && rotation < 1e-9);
    bool limited = false;
    for (size_t i = 0; i < n; i++) {
      wish[i] = (near[i] - found[i]) / unit_of(r, i);
      limited |= fabs(found[i]) > 2.4;
    }
    orthonormal_rows(r, found, NULL, 6, rows);
    inside += !limited;
    if (!limited) assert_true(without_rows(rows, 6, n, wish) < 2e-4);
    cag_robot_release(r);
  }
  assert_true(inside > 30);
}

// The angle between poses is that of the rotation, at all sizes, and a joint takes the short way.
static void turns_have_their_angle_and_sense(void **state) {
  (void)state;
  seed = 5;
  static const double angles[] = {0, 1e-12, 1e-7, 4e-6, 1.2e-5, 1e-3, 0.5, M_PI / 2, 2, 3.1};
  for (int trial = 0; trial < 400; trial++) {
    const int kind = trial % 20;
    const double angle = kind < 10 ? angles[kind] : M_PI - (kind < 19 ? angles[kind - 10] : 2e-5);
    const CagVec3 place = cag_scaled(random_direction(), 3), axis = random_direction();
    const CagVec3 other = random_direction();
    CagRobotLink link = cag_robot_link(CAG_JOINT_REVOLUTE);
    link.low = -0.2;
    link.high = 3.3;
    if (trial % 2) {
      link.low = -3.3;
      link.high = 0.2;
    }
    CagRobotSpec spec = {.links = &link, .link_count = 1, .tool = cag_transform_identity()};
    CagRobot *r;
    CagTransform from, to;
    const CagTransform move = cag_translate(place), first = turned(axis, 1.25),
                       then = turned(other, uniform(-3, 3)),
                       both = cag_transform_multiply(&then, &first);
    spec.base = cag_transform_multiply(&move, &both);
    OK(cag_robot_new(&spec, &r, &err));
    double zero[] = {0}, q[] = {trial % 2 ? -angle : angle}, position, rotation, found[1];
    cag_robot_forward(r, zero, &from);
    cag_robot_forward(r, q, &to);
    cag_robot_pose_distance(&from, &to, &position, &rotation);
    NEAR(position, 0, 1e-15);
    NEAR(rotation, angle, 2e-15 + 1e-11 * angle);
    const CagRobotSearch search = {.starts = 1};
    if (angle < M_PI) {
      assert_true(cag_robot_search(r, &to, &search, found).solved);
      NEAR(found[0], q[0], 1e-9);
    }
    cag_robot_release(r);
  }
}

// Point k of the sequence is the fractional part of 1/2 + k (1/g, 1/g^2 ...), where g is the root
// of x^(n+1) = x + 1 (Roberts 2018). The root is found by bisection here.
static void starts_are_the_sequence_of_the_golden_ratio(void **state) {
  (void)state;
  seed = 6;
  for (size_t n = 1; n <= 9; n++) {
    CagRobot *r = random_arm(n, 0, -0.75, 2.25);
    double low = 1, high = 2, q[JOINTS];
    for (int k = 0; k < 100; k++) {
      const double x = (low + high) / 2;
      if (pow(x, (double)n + 1) > x + 1) high = x;
      else low = x;
    }
    for (size_t k = 1; k < 40; k++) {
      cag_robot_sequence(r, k, q);
      for (size_t i = 0; i < n; i++) {
        const double share = 0.5 + (double)k * pow(low, -(double)(i + 1));
        NEAR(q[i], -0.75 + 3 * (share - floor(share)), 1e-11);
      }
    }
    cag_robot_release(r);
  }
}

// Additional starts only bring solutions closer to the preferred values, and often do. Joints are
// moved toward them by full turns within their limits.
static void alternatives_come_nearer(void **state) {
  (void)state;
  seed = 7;
  size_t nearer = 0;
  for (int trial = 0; trial < 40; trial++) {
    const double limit = 8;
    CagRobot *r = random_arm(6, 0, -limit, limit);
    double q[JOINTS], near[JOINTS], found[2][JOINTS], apart[2] = {0};
    CagTransform wanted;
    size_t steps[2];
    random_joints(r, q);
    random_joints(r, near);
    cag_robot_forward(r, q, &wanted);
    for (size_t k = 0; k < 2; k++) {
      const CagRobotSearch search = {.near = near, .alternatives = 20 * k};
      const CagRobotFound f = cag_robot_search(r, &wanted, &search, found[k]);
      assert_true(f.solved);
      steps[k] = f.steps;
      for (size_t i = 0; i < 6; i++) {
        const double x = found[k][i], d = x - near[i];
        assert_true(fabs(x) <= limit);
        apart[k] += d * d;
        // One full turn less would be outside the limits.
        for (int turn = -1; turn <= 1; turn += 2) {
          const double other = x + turn * 2 * M_PI;
          assert_true(fabs(other) > limit || fabs(other - near[i]) > fabs(d) - 1e-6);
        }
      }
    }
    assert_true(apart[1] <= apart[0] + 1e-9);
    // Twenty more attempts, each of about 15 steps.
    assert_true(steps[1] > steps[0] + 40 && steps[1] < steps[0] + 700);
    nearer += apart[1] < apart[0] - 1e-3;
    cag_robot_release(r);
  }
  assert_true(nearer > 20);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(free_motion_is_what_the_rows_leave),
      cmocka_unit_test(near_solutions_are_found_by_the_shortest_way),
      cmocka_unit_test(solutions_are_turned_as_near_as_limits_let),
      cmocka_unit_test(what_is_out_of_reach_is_come_near_to),
      cmocka_unit_test(wishes_are_met_as_far_as_the_tool_lets),
      cmocka_unit_test(turns_have_their_angle_and_sense),
      cmocka_unit_test(starts_are_the_sequence_of_the_golden_ratio),
      cmocka_unit_test(alternatives_come_nearer),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
