// Numerical inverse kinematics, paths and workspaces: solutions by their poses, out of reach by
// closed forms.

#include "geom/robot/numeric.h"
#include "geom/robot/path.h"
#include "geom/robot/workspace.h"
#include "support.h"

#define DEGREE (M_PI / 180)

static CagRobot *robot_of(const CagRobotLink *links, size_t n) {
  CagRobot *r = NULL;
  CagRobotSpec spec = {.links = links,
                       .link_count = n,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

// Rows of d, a, alpha and the limits to both sides.
static CagRobot *chain(const double (*rows)[4], size_t n) {
  CagRobotLink links[20];
  for (size_t i = 0; i < n; i++) {
    links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
    links[i].d = rows[i][0];
    links[i].a = rows[i][1];
    links[i].alpha = rows[i][2] * DEGREE;
    links[i].low = -rows[i][3] * DEGREE;
    links[i].high = rows[i][3] * DEGREE;
  }
  return robot_of(links, n);
}

static const double iiwa[7][4] = {{.34, 0, -90, 170}, {0, 0, 90, 120},   {.4, 0, 90, 170},
                                  {0, 0, -90, 120},   {.4, 0, -90, 170}, {0, 0, 90, 120},
                                  {.126, 0, 0, 175}};
static const double planar[2][4] = {{0, 2, 0, 180}, {0, 1, 0, 180}};

static double random_number(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) / 9007199254740992.0;
}

static void random_place(const CagRobot *r, uint64_t *state, double *q) {
  for (size_t i = 0; i < r->joint_count; i++) {
    const CagRobotLink *l = &r->links[r->joint_link[i]];
    q[i] = l->low + random_number(state) * (l->high - l->low);
  }
}

static void assert_reaches(const CagRobot *r, const double *q, const CagTransform *wanted,
                           double tolerance) {
  CagTransform t;
  double position, rotation, by;
  cag_robot_forward(r, q, &t);
  cag_robot_pose_distance(&t, wanted, &position, &rotation);
  assert_true(position <= tolerance && rotation <= tolerance);
  assert_int_equal(cag_robot_outside(r, q, &by), r->joint_count);
}

static void poses_of_chains_are_found_within_the_limits(void **state) {
  (void)state;
  double rows[15][4];
  for (int i = 0; i < 15; i++) {
    const double row[] = {i % 2 ? 0 : .12, i % 2 ? .05 : 0, i % 2 ? -90 : 90, 120};
    memcpy(rows[i], row, sizeof row);
  }
  static const double five[5][4] = {
      {.29, 0, -90, 165}, {0, .27, 0, 110}, {0, .27, 0, 110}, {0, 0, -90, 120}, {.15, 0, 0, 180}};
  CagRobot *robots[] = {chain(iiwa, 7), chain((const double(*)[4])rows, 15), chain(five, 5)};
  for (int k = 0; k < 3; k++) {
    uint64_t seed = 7;
    for (int i = 0; i < 300; i++) {
      double q[20], found[20], again[20];
      CagTransform wanted;
      CagRobotSearch search = {0};
      random_place(robots[k], &seed, q);
      cag_robot_forward(robots[k], q, &wanted);
      assert_true(cag_robot_search(robots[k], &wanted, &search, found).solved);
      assert_reaches(robots[k], found, &wanted, 1e-9);
      // The same every time.
      cag_robot_search(robots[k], &wanted, &search, again);
      assert_memory_equal(found, again, robots[k]->joint_count * sizeof *found);
    }
    cag_robot_release(robots[k]);
  }
}

// The same arm of turning and sliding joints with its lengths in other units: multiples by powers
// of two are exact, so the search takes the same steps to the same place.
static void the_unit_of_length_does_not_matter(void **state) {
  (void)state;
  static const double units[] = {1, 1024, 1.0 / 1024};
  CagRobot *robots[3];
  for (int k = 0; k < 3; k++) {
    CagRobotLink links[7];
    for (size_t i = 0; i < 7; i++) {
      const bool slides = i == 1 || i == 4;
      CagRobotLink *l = &links[i];
      *l = cag_robot_link(slides ? CAG_JOINT_PRISMATIC : CAG_JOINT_REVOLUTE);
      l->theta = slides ? 0.3 : 0;
      l->d = iiwa[i][0] * units[k];
      l->a = 0.0625 * (double)i * units[k];
      l->alpha = iiwa[i][2] * DEGREE;
      l->low = slides ? -0.75 * units[k] : -2.5;
      l->high = slides ? 1.5 * units[k] : 2.75;
    }
    robots[k] = robot_of(links, 7);
  }
  uint64_t seed = 11;
  for (int i = 0; i < 200; i++) {
    double places[7], q[3][7];
    CagRobotFound found[3];
    random_place(robots[0], &seed, places);
    for (int k = 0; k < 3; k++) {
      CagTransform wanted;
      const CagRobotSearch search = {0};
      for (size_t j = 0; j < 7; j++) q[k][j] = places[j] * (j == 1 || j == 4 ? units[k] : 1);
      cag_robot_forward(robots[k], q[k], &wanted);
      found[k] = cag_robot_search(robots[k], &wanted, &search, q[k]);
      assert_true(found[k].solved);
      assert_int_equal(found[k].steps, found[0].steps);
      for (size_t j = 0; j < 7; j++)
        NEAR(q[k][j] / (j == 1 || j == 4 ? units[k] : 1), q[0][j], 1e-12);
    }
  }
  for (int k = 0; k < 3; k++) cag_robot_release(robots[k]);
}

static void out_of_reach_the_nearest_point_is_found(void **state) {
  (void)state;
  CagRobot *arm = chain(planar, 2), *seven = chain(iiwa, 7);
  static const double cases[][3] = {{4, 0, 1},      {0, 4, 1}, {0.4, 0, 0.6},
                                    {0, -0.3, 0.7}, {0, 0, 1}, {30, 40, 47}};
  CagRobotSearch search = {.position_only = true};
  double q[7];
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagTransform t = cag_translate(cag_vec3(cases[i][0], cases[i][1], 0));
    CagRobotFound found = cag_robot_search(arm, &t, &search, q);
    assert_false(found.solved);
    NEAR(found.position, cases[i][2], 1e-9);
  }
  // From the shoulder at (0, 0, 0.34) the arm of seven joints reaches 0.926.
  CagTransform t = cag_translate(cag_vec3(2, 1, .34));
  NEAR(cag_robot_search(seven, &t, &search, q).position, sqrt(5) - .926, 1e-8);
  t = cag_translate(cag_vec3(0.2, 0.1, 0.5));
  assert_true(cag_robot_search(seven, &t, &search, q).solved);
  cag_robot_release(arm);
  cag_robot_release(seven);
}

static void freedom_to_spare_goes_into_being_near(void **state) {
  (void)state;
  CagRobot *r = chain(iiwa, 7);
  const double place[] = {.3, .5, -.4, 1.2, .2, .8, -.6}, near[] = {0, .3, 0, 1, 0, .5, 0};
  const double rates[] = {1, 0, 0, 0, 0, 0, 0};
  double plain[7], settled[7], still[7], columns[7][6], apart[2] = {0};
  CagTransform t;
  cag_robot_forward(r, place, &t);
  CagRobotSearch search = {.near = near};
  assert_true(cag_robot_search(r, &t, &search, plain).solved);
  search.stay_near = true;
  assert_true(cag_robot_search(r, &t, &search, settled).solved);
  assert_reaches(r, settled, &t, 1e-9);
  for (int i = 0; i < 7; i++) {
    apart[0] += (plain[i] - near[i]) * (plain[i] - near[i]);
    apart[1] += (settled[i] - near[i]) * (settled[i] - near[i]);
  }
  assert_true(apart[1] <= apart[0]);
  cag_robot_null_motion(r, place, rates, still);
  cag_robot_jacobian(r, place, columns, NULL);
  for (int k = 0; k < 6; k++) {
    double sum = 0;
    for (int i = 0; i < 7; i++) sum += columns[i][k] * still[i];
    NEAR(sum, 0, 1e-12);
  }
  assert_true(fabs(still[0]) > 0.1);
  cag_robot_release(r);
}

// Numbers that no robot has end in an answer, not in a loop.
static void hostile_numbers_come_to_an_end(void **state) {
  (void)state;
  CagRobotLink link = cag_robot_link(CAG_JOINT_REVOLUTE);
  CagRobotSpec spec = {.links = &link,
                       .link_count = 1,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  CagRobot *r = NULL;
  link.a = 1e308;
  FAILS(cag_robot_new(&spec, &r, &err), "link-number");
  link.a = 1;
  link.low = -1.7e308;
  link.high = 1.7e308;
  FAILS_AT(cag_robot_new(&spec, &r, &err), "joint-limits", 0);
  link.low = -1e300;
  link.high = 1e300;
  OK(cag_robot_new(&spec, &r, &err));
  double q[] = {3e299}, by;
  assert_true(cag_robot_into_limits(r, NULL, q));
  CagTransform far = cag_translate(cag_vec3(1e308, -1e308, 1e308));
  CagRobotSearch search = {0};
  assert_false(cag_robot_search(r, &far, &search, q).solved);
  assert_true(isfinite(q[0]));
  assert_int_equal(cag_robot_outside(r, q, &by), 1);
  cag_robot_release(r);
}

static void a_chain_without_joints_is_asked_safely(void **state) {
  (void)state;
  CagRobotLink fixed = cag_robot_link(CAG_JOINT_FIXED);
  CagRobot *r = robot_of(&fixed, 1);
  CagTransform here = cag_transform_identity(), there = cag_translate(cag_vec3(1, 0, 0));
  CagRobotSearch search = {0};
  double q[1];
  assert_true(cag_robot_search(r, &here, &search, q).solved);
  assert_false(cag_robot_search(r, &there, &search, q).solved);
  cag_robot_release(r);
}

static bool never(void *data) {
  ++*(int *)data;
  return false;
}

static void lines_are_straight_and_name_where_they_end(void **state) {
  (void)state;
  static const double rows[3][4] = {{0, 300, 0, 180}, {0, 200, 0, 170}, {0, 0, 0, 180}};
  CagRobot *r = chain(rows, 3);
  const double near[] = {0, 90 * DEGREE, 0};
  const CagRobotWay always = {.near = near};
  int asked = 0;
  CagTransform a = cag_translate(cag_vec3(300, 100, 0)), b = cag_translate(cag_vec3(100, 300, 0)),
               far = cag_translate(cag_vec3(600, 100, 0));
  double q[21][3];
  OK(cag_robot_line_path(r, &a, &b, 21, &always, &q[0][0], &err));
  for (int k = 0; k < 21; k++) {
    CagTransform wanted = cag_translate(cag_vec3(300 - 10 * k, 100 + 10 * k, 0));
    assert_reaches(r, q[k], &wanted, 1e-9);
    assert_true(q[k][1] > 0); // never the other elbow
  }
  // The reach of 500 ends at x = sqrt(500^2 - 100^2) = 489.9, after step 9 of steps of 20 mm.
  assert_int_equal(cag_robot_line_path(r, &a, &far, 16, &always, &q[0][0], &err), CAG_E_DEGENERATE);
  assert_string_equal(err.reason, "path-leaves");
  assert_int_equal(err.index, 10);
  const CagTransform poses[] = {a, b, far};
  OK(cag_robot_follow(r, poses, 2, &always, &q[0][0], &err));
  assert_int_equal(cag_robot_follow(r, poses, 3, &always, &q[0][0], &err), CAG_E_DEGENERATE);
  assert_int_equal(err.index, 2);
  const CagRobotWay stop = {.near = near, .going = never, .data = &asked};
  assert_int_equal(cag_robot_follow(r, poses, 2, &stop, &q[0][0], &err), CAG_E_CALLBACK);
  assert_int_equal(asked, 1);
  cag_robot_release(r);
}

// --- Workspaces ---

static CagRobotLink slide(double low, double high, double theta, double alpha) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_PRISMATIC);
  l.theta = theta * DEGREE;
  l.alpha = alpha * DEGREE;
  l.low = l.home = low;
  l.high = high;
  return l;
}

static CagRobotLink turn(double low, double high, double offset, double alpha) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_REVOLUTE);
  l.theta = offset * DEGREE;
  l.alpha = alpha * DEGREE;
  l.low = l.home = low * DEGREE;
  l.high = high * DEGREE;
  return l;
}

static void classical_arms_have_their_volumes(void **state) {
  (void)state;
  CagWorkspace w;
  const CagRobotLink cartesian[] = {slide(0.2, 1.4, 0, -90), slide(-0.5, 0.5, -90, -90),
                                    slide(0, 2, 0, 0)};
  CagRobot *r = robot_of(cartesian, 3);
  cag_robot_workspace(r, &w);
  assert_int_equal(w.kind, CAG_WORKSPACE_CARTESIAN);
  NEAR(w.volume, 2.4, 1e-12);
  NEAR(w.bounds.min.y, -0.5, 1e-12);
  NEAR(w.bounds.max.x, 2, 1e-12);
  cag_robot_release(r);

  const CagRobotLink cylindrical[] = {turn(-150, 150, 0, 0), slide(100, 400, 90, 90),
                                      slide(200, 500, 0, 0)};
  r = robot_of(cylindrical, 3);
  cag_robot_workspace(r, &w);
  assert_int_equal(w.kind, CAG_WORKSPACE_CYLINDRICAL);
  NEAR(w.volume, 300 * DEGREE / 2 * (500.0 * 500 - 200 * 200) * 300, 1e-3);
  NEAR(w.r_min, 200, 1e-9);
  cag_robot_release(r);

  const CagRobotLink spherical[] = {turn(-90, 90, 0, 90), turn(-20, 50, 90, 90),
                                    slide(200, 500, 0, 0)};
  r = robot_of(spherical, 3);
  cag_robot_workspace(r, &w);
  assert_int_equal(w.kind, CAG_WORKSPACE_SPHERICAL);
  NEAR(w.volume,
       M_PI / 3 * (5e2 * 5e2 * 5e2 - 2e2 * 2e2 * 2e2) * (sin(50 * DEGREE) + sin(20 * DEGREE)),
       1e-3);
  cag_robot_release(r);

  static const double rows[2][4] = {{0, 2, 0, 180}, {0, 1, 0, 180}};
  r = chain(rows, 2);
  cag_robot_workspace(r, &w);
  assert_int_equal(w.kind, CAG_WORKSPACE_PLANAR);
  NEAR(w.volume, 4 * M_PI * 2 * 1, 1e-9);
  cag_robot_release(r);

  // The elbow of 90 degrees at most: the ring begins at sqrt(5).
  static const double limited[2][4] = {{0, 2, 0, 180}, {0, 1, 0, 90}};
  r = chain(limited, 2);
  cag_robot_workspace(r, &w);
  NEAR(w.r_min, sqrt(5), 1e-9);
  NEAR(w.volume, M_PI * (9 - 5), 1e-9);
  cag_robot_release(r);
}

static void the_puma_has_a_shell(void **state) {
  (void)state;
  CagWorkspace w;
  static const double puma[6][4] = {{0, 0, -90, 180},     {149.09, 431.8, 0, 180},
                                    {0, -20.32, 90, 180}, {433.07, 0, -90, 180},
                                    {0, 0, 90, 100},      {56.25, 0, 0, 266}};
  const double l = hypot(20.32, 433.07), r_min = fabs(431.8 - l), r_max = 431.8 + l;
  CagRobot *r = chain(puma, 6);
  cag_robot_workspace(r, &w);
  assert_int_equal(w.kind, CAG_WORKSPACE_ARTICULATED);
  assert_true(w.of_wrist && w.exact);
  NEAR(w.r_min, r_min, 1e-9);
  NEAR(w.r_max, r_max, 1e-9);
  NEAR(w.hole, 149.09, 1e-9);
  NEAR(w.volume, 4 * M_PI / 3 * (pow(r_max, 3) - pow(r_min, 3)), 1);
  NEAR(w.bounds.max.x, hypot(r_max, 149.09), 1e-9);
  NEAR(w.bounds.max.z, r_max, 1e-9);
  cag_robot_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(poses_of_chains_are_found_within_the_limits),
      cmocka_unit_test(the_unit_of_length_does_not_matter),
      cmocka_unit_test(out_of_reach_the_nearest_point_is_found),
      cmocka_unit_test(freedom_to_spare_goes_into_being_near),
      cmocka_unit_test(hostile_numbers_come_to_an_end),
      cmocka_unit_test(a_chain_without_joints_is_asked_safely),
      cmocka_unit_test(lines_are_straight_and_name_where_they_end),
      cmocka_unit_test(classical_arms_have_their_volumes),
      cmocka_unit_test(the_puma_has_a_shell),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
