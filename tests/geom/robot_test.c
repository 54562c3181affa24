// Chains: frames, Jacobians, limits, couplings, and tables, compared with the textbook's numbers.

#include "geom/robot/robot.h"

#include "geom/robot/dh.h"
#include "geom/robot/kernel.h"
#include "robot_support.h"

// Puma of the textbook, table 14.1.
static const Row puma[] = {{0, 0, -90},   {149.5, 432, 0}, {0, 0, 90},
                           {432, 0, -90}, {0, 0, 90},      {56.5, 0, 0}};
static const Row puma_meters[] = {{0, 0, -90},      {.14909, .4318, 0}, {0, -.02032, 90},
                                  {.43307, 0, -90}, {0, 0, 90},         {.05625, 0, 0}};

static void to_radians(const double *degrees, size_t n, double *q) {
  for (size_t i = 0; i < n; i++) q[i] = degrees[i] * DEGREE;
}

static void sines_are_those_of_the_library(void **state) {
  (void)state;
  for (int k = -200000; k < 200000; k++) {
    const double x = k * 0.00031;
    double s, c;
    cag_robot_sines(&x, 1, &s, &c);
    NEAR(s, sin(x), 3e-16);
    NEAR(c, cos(x), 3e-16);
  }
}

static void quarter_turns_are_exact(void **state) {
  (void)state;
  for (int k = -400; k <= 400; k++) {
    const double x = k * 90 * DEGREE;
    static const double sines[] = {0, 1, 0, -1};
    double s, c;
    cag_robot_sines(&x, 1, &s, &c);
    assert_true(s == sines[((k % 4) + 4) % 4]);
    assert_true(c == sines[((k % 4) + 5) % 4]);
  }
  CagRobot *r = revolute_chain(puma, 6);
  const double q[] = {M_PI / 2, 0, M_PI / 2, 0, 0, 0};
  CagTransform t;
  cag_robot_forward(r, q, &t);
  const double m[3][4] = {{0, -1, 0, -149.5}, {0, 0, 1, 920.5}, {-1, 0, 0, 0}};
  assert_pose(&t, m, 0);
  cag_robot_release(r);
}

static void the_puma_of_the_textbook_is_where_it_should_be(void **state) {
  (void)state;
  CagRobot *r = revolute_chain(puma, 6);
  const double degrees[] = {35, -60, 100, 25, -40, 110};
  double q[6];
  CagTransform t, frames[7], back;
  to_radians(degrees, 6, q);
  cag_robot_forward(r, q, &t);
  const double m[3][4] = {
      {-0.9389416468496021, -0.2844390447790015, 0.19360530368914441, 329.59148290231036},
      {0.24704673710994354, -0.9489608854926623, -0.19606414126074279, 394.5512579374708},
      {0.23949215748054722, -0.1362632291199321, 0.9612886345396586, 759.3669817137667}};
  assert_pose(&t, m, 1e-9);
  // The products of single links agree; T(2, 5) T(5, 2) is the identity.
  cag_robot_frames(r, q, frames);
  assert_pose(&frames[6], m, 1e-9);
  cag_robot_subchain(r, q, 2, 5, &t);
  cag_robot_subchain(r, q, 5, 2, &back);
  t = cag_transform_multiply(&t, &back);
  const double unit[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  assert_pose(&t, unit, 1e-10);
  cag_robot_release(r);
}

static void subchains_match_the_textbook(void **state) {
  (void)state;
  CagRobot *r = revolute_chain(puma, 6);
  const double degrees[] = {10, -20, 130, 40, -50, 60};
  double q[6];
  CagTransform t;
  to_radians(degrees, 6, q);
  cag_robot_subchain(r, q, 2, 5, &t);
  const double m[3][4] = {
      {0.2703129780537207, 0.4131759111665348, 0.8696071298738485, 330.9311994273985},
      {0.8696071298738485, -0.49240387650610395, -0.03635742117269868, 277.684247384585},
      {0.41317591116653474, 0.766044443118978, -0.49240387650610395, 0}};
  assert_pose(&t, m, 1e-9);
  cag_robot_release(r);
}

// The same arm with modified rows, fixed links between, and a base and tool that are not the
// identity.
static void fixed_links_base_and_tool_are_part_of_the_chain(void **state) {
  (void)state;
  CagRobotLink links[4] = {cag_robot_link(CAG_JOINT_REVOLUTE), cag_robot_link(CAG_JOINT_FIXED),
                           cag_robot_link(CAG_JOINT_PRISMATIC), cag_robot_link(CAG_JOINT_REVOLUTE)};
  links[0].a = 1;
  links[0].alpha = 0.3;
  links[1].fixed = cag_rpy(0.1, 0.2, 0.3);
  links[1].fixed.m[1][3] = 2;
  links[2].theta = 0.4;
  links[2].d = 0.5;
  links[2].high = 3;
  links[3].alpha = -0.7;
  links[3].d = 0.25;
  links[3].screw = 0.1;
  for (int modified = 0; modified < 2; modified++) {
    CagRobot *r = NULL;
    CagRobotSpec spec = {.links = links,
                         .link_count = 4,
                         .convention = modified ? CAG_ROBOT_MODIFIED : CAG_ROBOT_CLASSIC,
                         .base = cag_rpy(0.5, 0, 0),
                         .tool = cag_translate(cag_vec3(0, 0, 4))};
    OK(cag_robot_new(&spec, &r, &err));
    assert_int_equal(r->joint_count, 3);
    const double q[] = {0.9, 1.5, -0.6};
    CagTransform (*row)(double, double, double, double) = modified ? cag_mdh : cag_dh;
    const CagTransform parts[] = {spec.base,
                                  row(0.9, 0, 1, 0.3),
                                  links[1].fixed,
                                  row(0.4, 2.0, 0, 0),
                                  row(-0.6, 0.25 - 0.06, 0, -0.7),
                                  spec.tool};
    CagTransform product = cag_transform_identity(), t;
    for (size_t i = 0; i < 6; i++) product = cag_transform_multiply(&product, &parts[i]);
    cag_robot_forward(r, q, &t);
    assert_pose(&t, (const double(*)[4])product.m, 1e-14);
    cag_robot_release(r);
  }
}

static void jacobian_is_that_of_the_reference(void **state) {
  (void)state;
  static const double wanted[6][6] = {
      {0.21200656520728187, 0.22492428454357408, -0.07486238406205278, 0.006157640545863286,
       -0.05356552946496163, 0},
      {-0.719126914000276, 0.10488391638770257, -0.03490890299587593, -0.020900922280212567,
       0.009571736146224884, 0},
      {0, 0.7413481680916031, 0.4637924782289554, 0.037175032001587976, 0.014254066798123933, 0},
      {0, -0.42261826174069944, -0.42261826174069944, -0.9028590122851735, -0.14290184628725197,
       -0.2697208389685193},
      {0, 0.9063077870366499, 0.9063077870366499, -0.4210100716628344, 0.4850527341930118,
       -0.8577691943163454},
      {1, 0, 0, -0.08715574274765818, -0.8627299156628209, -0.43758733792010696}};
  CagRobot *r = revolute_chain(puma_meters, 6);
  const double degrees[] = {25, -130, 35, 60, -50, 170};
  double q[6], columns[6][6], values[6];
  size_t count, rank;
  to_radians(degrees, 6, q);
  cag_robot_jacobian(r, q, columns, NULL);
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) NEAR(columns[j][i], wanted[i][j], 1e-12);
  // |det J| = |a2 (d4 C3 - a3 S3) (a2 C2 + a3 C23 + d4 S23) S5|.
  const double c3 = cos(q[2]), s3 = sin(q[2]), c23 = cos(q[1] + q[2]), s23 = sin(q[1] + q[2]);
  const double det = .4318 * (.43307 * c3 + .02032 * s3) *
                     (.4318 * cos(q[1]) - .02032 * c23 + .43307 * s23) * sin(q[4]);
  NEAR(cag_robot_manipulability(r, q), fabs(det), 1e-14);
  NEAR(fabs(det), 0.08571260052315208, 1e-14);
  OK(cag_robot_singular_values(r, q, values, &count, &rank, &err));
  assert_int_equal(rank, 6);
  // With the wrist stretched, S5 = 0.
  q[4] = 0;
  OK(cag_robot_singular_values(r, q, values, &count, &rank, &err));
  assert_int_equal(rank, 5);
  NEAR(cag_robot_manipulability(r, q), 0, 1e-16);
  cag_robot_release(r);
}

// Compares columns with central differences of the pose, for a chain with a prismatic and a screw
// joint.
static void jacobian_is_the_derivative_of_the_pose(void **state) {
  (void)state;
  CagRobotLink links[4] = {cag_robot_link(CAG_JOINT_REVOLUTE), cag_robot_link(CAG_JOINT_PRISMATIC),
                           cag_robot_link(CAG_JOINT_REVOLUTE), cag_robot_link(CAG_JOINT_REVOLUTE)};
  for (int i = 0; i < 4; i++) {
    links[i].a = 0.3 + i;
    links[i].alpha = 0.7 * i - 1;
    links[i].d = 0.2;
  }
  links[1].high = 2;
  links[2].screw = 0.4;
  CagRobotSpec spec = {.links = links,
                       .link_count = 4,
                       .base = cag_rpy(0.1, 0.2, 0.3),
                       .tool = cag_translate(cag_vec3(0.1, 0.2, 0.3))};
  CagRobot *r = NULL;
  OK(cag_robot_new(&spec, &r, &err));
  const double q[] = {0.4, 1.1, -0.8, 0.6}, h = 1e-5;
  double columns[4][6], in_tool[4][6];
  CagTransform at;
  cag_robot_jacobian(r, q, columns, &at);
  cag_robot_jacobian_tool(r, q, in_tool);
  for (int i = 0; i < 4; i++) {
    double up[4], down[4];
    CagTransform a, b;
    memcpy(up, q, sizeof up);
    memcpy(down, q, sizeof down);
    up[i] += h;
    down[i] -= h;
    cag_robot_forward(r, up, &a);
    cag_robot_forward(r, down, &b);
    double skew[3][3] = {{0}};
    for (int j = 0; j < 3; j++) {
      NEAR(columns[i][j], (a.m[j][3] - b.m[j][3]) / (2 * h), 1e-8);
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++) skew[j][k] += (a.m[j][l] - b.m[j][l]) / (2 * h) * at.m[k][l];
    }
    NEAR(columns[i][3], skew[2][1], 1e-8);
    NEAR(columns[i][4], skew[0][2], 1e-8);
    NEAR(columns[i][5], skew[1][0], 1e-8);
    for (int half = 0; half < 6; half += 3)
      for (int j = 0; j < 3; j++) {
        double world = 0;
        for (int k = 0; k < 3; k++) world += at.m[j][k] * in_tool[i][half + k];
        NEAR(world, columns[i][half + j], 1e-14);
      }
  }
  cag_robot_release(r);
}

static void seven_joints_straight_up_have_rank_three(void **state) {
  (void)state;
  static const Row rows[] = {{.34, 0, -90}, {0, 0, 90}, {.4, 0, 90}, {0, 0, -90},
                             {.4, 0, -90},  {0, 0, 90}, {.126, 0, 0}};
  CagRobot *r = revolute_chain(rows, 7);
  const double up[7] = {0}, general[7] = {.3, .5, -.4, 1.2, .2, .8, -.6};
  double values[6];
  size_t count, rank;
  OK(cag_robot_singular_values(r, up, values, &count, &rank, &err));
  assert_int_equal(rank, 3);
  OK(cag_robot_singular_values(r, general, values, &count, &rank, &err));
  assert_int_equal(rank, 6);
  cag_robot_release(r);
}

static void skeleton_runs_along_the_links(void **state) {
  (void)state;
  CagRobot *r = revolute_chain(puma, 6);
  const double degrees[] = {30, -60, 120, 0, 45, 0};
  double q[6], length = 0;
  CagVec3 points[14];
  to_radians(degrees, 6, q);
  assert_int_equal(cag_robot_skeleton(r, q, points), 13);
  for (int i = 1; i < 13; i++) length += cag_norm(cag_sub(points[i], points[i - 1]));
  NEAR(length, 149.5 + 432 + 432 + 56.5, 1e-9);
  NEAR(points[3].y, 129.4707978657736, 1e-9);
  NEAR(points[12].x, 483.5746583786249, 1e-9);
  cag_robot_release(r);
}

static void whole_turns_bring_joints_into_their_limits(void **state) {
  (void)state;
  CagRobotLink links[2] = {cag_robot_link(CAG_JOINT_REVOLUTE), cag_robot_link(CAG_JOINT_REVOLUTE)};
  links[0].low = -270 * DEGREE;
  links[0].high = 90 * DEGREE;
  links[1].low = -400 * DEGREE;
  links[1].high = 400 * DEGREE;
  CagRobotSpec spec = {.links = links,
                       .link_count = 2,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  CagRobot *r = NULL;
  OK(cag_robot_new(&spec, &r, &err));
  double q[2] = {170 * DEGREE, 10 * DEGREE}, by;
  const double near[2] = {0, 380 * DEGREE};
  assert_int_equal(cag_robot_outside(r, q, &by), 0);
  NEAR(by, 80 * DEGREE, 1e-12);
  assert_true(cag_robot_into_limits(r, near, q));
  NEAR(q[0], -190 * DEGREE, 1e-12);
  NEAR(q[1], 370 * DEGREE, 1e-12);
  assert_int_equal(cag_robot_outside(r, q, &by), 2);
  cag_robot_release(r);
}

// The Rhino's motors: phi = M theta + c with c = (0, 0, 90, 0, 0).
static void couplings_are_undone(void **state) {
  (void)state;
  static const double m[25] = {1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1,
                               0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 1};
  static const double offset[5] = {0, 0, 90 * DEGREE, 0, 0};
  CagRobotLink links[5];
  for (int i = 0; i < 5; i++) links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
  CagRobotSpec spec = {.links = links,
                       .link_count = 5,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity(),
                       .coupling = m,
                       .coupling_offset = offset};
  CagRobot *r = NULL;
  OK(cag_robot_new(&spec, &r, &err));
  const double motors[] = {10 * DEGREE, -20 * DEGREE, 120 * DEGREE, -30 * DEGREE, 5 * DEGREE};
  static const double joints[] = {10, -20, 50, -60, 5};
  double q[5], back[5];
  cag_robot_joints(r, motors, q);
  cag_robot_motors(r, q, back);
  for (int i = 0; i < 5; i++) {
    NEAR(q[i], joints[i] * DEGREE, 1e-12);
    NEAR(back[i], motors[i], 1e-12);
  }
  cag_robot_release(r);
}

static void bad_links_are_named(void **state) {
  (void)state;
  CagRobot *r = NULL;
  CagRobotLink link = cag_robot_link(CAG_JOINT_REVOLUTE);
  CagRobotSpec spec = {.links = &link,
                       .link_count = 0,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "empty-chain");
  spec.link_count = 1;
  link.high = INFINITY;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "joint-limits");
  link.high = NAN;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  link.high = -4;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  link.high = 1;
  link.home = 2;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "home-outside");
  link.home = 0;
  link.a = INFINITY;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  link.a = 0;
  spec.tool.m[0][0] = -1;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(cag_error_info(err.id)->reason, "not-rigid");
  spec.tool.m[0][0] = NAN;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
}

static void frames_are_assigned_as_in_the_reference(void **state) {
  (void)state;
  const CagVec3 y = {0, 1, 0}, z = {0, 0, 1};
  const CagJointAxis axes[] = {
      {CAG_JOINT_REVOLUTE, {0, 0, 0}, z},         {CAG_JOINT_REVOLUTE, {0, 0, 0}, y},
      {CAG_JOINT_REVOLUTE, {432, 0, 0}, y},       {CAG_JOINT_REVOLUTE, {432, 149.5, 0}, z},
      {CAG_JOINT_REVOLUTE, {432, 149.5, 432}, y}, {CAG_JOINT_REVOLUTE, {432, 149.5, 432}, z}};
  const CagJointAxis end = {CAG_JOINT_REVOLUTE, {432, 149.5, 488.5}, z};
  static const double wanted[6][4] = {{180, 0, 0, 90},   {180, 0, 432, 0}, {0, 149.5, 0, 90},
                                      {180, 432, 0, 90}, {180, 0, 0, 90},  {0, 56.5, 0, 0}};
  CagTransform base = cag_transform_identity(), frames[7];
  CagRobotLink links[6];
  OK(cag_robot_dh_assign(&base, axes, 6, &end, links, frames, &err));
  for (int i = 0; i < 6; i++) {
    NEAR(fabs(links[i].theta) / DEGREE, wanted[i][0], 1e-9);
    NEAR(links[i].d, wanted[i][1], 1e-9);
    NEAR(links[i].a, wanted[i][2], 1e-9);
    NEAR(links[i].alpha / DEGREE, wanted[i][3], 1e-9);
  }
  // The rows lead from frame to frame.
  for (int i = 0; i < 6; i++) {
    const CagRobotLink *l = &links[i];
    const CagTransform a = cag_dh(l->theta, l->d, l->a, l->alpha);
    const CagTransform t = cag_transform_multiply(&frames[i], &a);
    assert_pose(&t, (const double(*)[4])frames[i + 1].m, 1e-9);
  }
  CagJointAxis bad = axes[0];
  bad.direction = cag_vec3(0, 0, 0);
  assert_int_equal(cag_robot_dh_assign(&base, &bad, 1, &end, links, frames, &err), CAG_E_ARGUMENT);
  assert_int_equal(cag_robot_dh_assign(&base, axes, 0, &end, links, frames, &err), CAG_E_ARGUMENT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sines_are_those_of_the_library),
      cmocka_unit_test(quarter_turns_are_exact),
      cmocka_unit_test(the_puma_of_the_textbook_is_where_it_should_be),
      cmocka_unit_test(subchains_match_the_textbook),
      cmocka_unit_test(fixed_links_base_and_tool_are_part_of_the_chain),
      cmocka_unit_test(jacobian_is_that_of_the_reference),
      cmocka_unit_test(jacobian_is_the_derivative_of_the_pose),
      cmocka_unit_test(seven_joints_straight_up_have_rank_three),
      cmocka_unit_test(skeleton_runs_along_the_links),
      cmocka_unit_test(whole_turns_bring_joints_into_their_limits),
      cmocka_unit_test(couplings_are_undone),
      cmocka_unit_test(bad_links_are_named),
      cmocka_unit_test(frames_are_assigned_as_in_the_reference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
