// Chains: frames, Jacobians, limits, couplings and tables, against the textbook's numbers.

#include "geom/robot/robot.h"

#include "geom/robot/dh.h"
#include "geom/robot/kernel.h"
#include "random.h"
#include "support.h"

#define DEGREE (M_PI / 180)

typedef struct Row {
  double d, a, alpha;
} Row;

static CagRobot *chain(const Row *rows, size_t n) {
  CagRobotLink links[16];
  CagRobot *r = NULL;
  for (size_t i = 0; i < n; i++) {
    links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
    links[i].d = rows[i].d;
    links[i].a = rows[i].a;
    links[i].alpha = rows[i].alpha * DEGREE;
  }
  CagRobotSpec spec = {.links = links,
                       .link_count = n,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

// Puma of the textbook, table 14.1.
static const Row puma[] = {{0, 0, -90},   {149.5, 432, 0}, {0, 0, 90},
                           {432, 0, -90}, {0, 0, 90},      {56.5, 0, 0}};
static const Row puma_meters[] = {{0, 0, -90},      {.14909, .4318, 0}, {0, -.02032, 90},
                                  {.43307, 0, -90}, {0, 0, 90},         {.05625, 0, 0}};

static void to_radians(const double *degrees, size_t n, double *q) {
  for (size_t i = 0; i < n; i++) q[i] = degrees[i] * DEGREE;
}

static void assert_pose(const CagTransform *t, const double m[3][4], double tolerance) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) NEAR(t->m[i][j], m[i][j], tolerance);
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
  CagRobot *r = chain(puma, 6);
  const double q[] = {M_PI / 2, 0, M_PI / 2, 0, 0, 0};
  CagTransform t;
  cag_robot_forward(r, q, &t);
  const double m[3][4] = {{0, -1, 0, -149.5}, {0, 0, 1, 920.5}, {-1, 0, 0, 0}};
  assert_pose(&t, m, 0);
  cag_robot_release(r);
}

static void the_puma_of_the_textbook_is_where_it_should_be(void **state) {
  (void)state;
  CagRobot *r = chain(puma, 6);
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
  CagRobot *r = chain(puma, 6);
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

// The same arm: modified rows, fixed links between, base and tool that are not the identity.
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
  CagRobot *r = chain(puma_meters, 6);
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
  // The wrist stretched: S5 = 0.
  q[4] = 0;
  OK(cag_robot_singular_values(r, q, values, &count, &rank, &err));
  assert_int_equal(rank, 5);
  NEAR(cag_robot_manipulability(r, q), 0, 1e-16);
  cag_robot_release(r);
}

// Columns against central differences of the pose, of a chain with a slide and a screw.
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
  CagRobot *r = chain(rows, 7);
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
  CagRobot *r = chain(puma, 6);
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
  assert_string_equal(err.reason, "empty-chain");
  spec.link_count = 1;
  link.high = INFINITY;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(err.reason, "joint-limits");
  link.high = NAN;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  link.high = -4;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  link.high = 1;
  link.home = 2;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(err.reason, "home-outside");
  link.home = 0;
  link.a = INFINITY;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  link.a = 0;
  spec.tool.m[0][0] = -1;
  assert_int_equal(cag_robot_new(&spec, &r, &err), CAG_E_ARGUMENT);
  assert_string_equal(err.reason, "not-rigid");
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

// --- Random chains ---

static double between(double low, double high) { return uniform(low, high); }

static CagTransform random_motion(double size) {
  double angles[3], way[3];
  for (int i = 0; i < 3; i++) angles[i] = between(-3, 3);
  for (int i = 0; i < 3; i++) way[i] = between(-size, size);
  CagTransform t = cag_rpy(angles[0], angles[1], angles[2]);
  for (int i = 0; i < 3; i++) t.m[i][3] = way[i];
  t.planar = false;
  return t;
}

// A chain of every kind of links; `kinds` picks them.
static CagRobot *random_chain(size_t n, CagRobotConvention convention, const int *kinds) {
  CagRobotLink links[16];
  for (size_t i = 0; i < n; i++) {
    CagRobotLink *l = &links[i];
    *l = cag_robot_link(kinds[i] == 2   ? CAG_JOINT_FIXED
                        : kinds[i] == 1 ? CAG_JOINT_PRISMATIC
                                        : CAG_JOINT_REVOLUTE);
    if (l->kind == CAG_JOINT_FIXED) {
      l->fixed = random_motion(2);
      continue;
    }
    l->theta = between(-3, 3);
    l->d = between(-1, 1);
    l->a = between(-1, 1);
    l->alpha = between(-3, 3);
    l->low = between(-2, 0), l->high = l->low + between(0.1, 2), l->home = l->low;
    if (kinds[i] == 3) l->screw = between(-0.5, 0.5);
  }
  CagRobot *r = NULL;
  CagRobotSpec spec = {.links = links,
                       .link_count = n,
                       .convention = convention,
                       .base = random_motion(2),
                       .tool = random_motion(2)};
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

// The product of all rows, by the functions for single rows, against frames, axes, parts of the
// chain, and the figure.
static void chains_are_products_of_their_links(void **state) {
  (void)state;
  seed = 21;
  for (int k = 0; k < 300; k++) {
    int kinds[8];
    const size_t n = 1 + (size_t)k % 8;
    for (size_t i = 0; i < n; i++) kinds[i] = (int)between(0, 4);
    CagRobot *r = random_chain(n, k % 3 ? CAG_ROBOT_CLASSIC : CAG_ROBOT_MODIFIED, kinds);
    double q[8], sum = 0;
    CagTransform at[9], frames[9], tool, part;
    CagVec3 points[8], directions[8], figure[18], expected[18];
    for (size_t i = 0; i < r->joint_count; i++) q[i] = between(-3, 3);
    at[0] = r->base;
    size_t joint = 0, corners = 1;
    expected[0] = cag_vec3(r->base.m[0][3], r->base.m[1][3], r->base.m[2][3]);
    cag_robot_axes(r, q, points, directions);
    for (size_t i = 0; i < n; i++) {
      const CagRobotLink *l = &r->links[i];
      CagTransform a = l->fixed, before = at[i];
      const bool modified = r->convention == CAG_ROBOT_MODIFIED;
      if (l->kind != CAG_JOINT_FIXED) {
        const double value = q[joint], turned = l->kind == CAG_JOINT_REVOLUTE ? value : 0,
                     moved = l->kind == CAG_JOINT_REVOLUTE ? l->screw * value : value;
        a = (modified ? cag_mdh : cag_dh)(l->theta + turned, l->d + moved, l->a, l->alpha);
        // A joint's axis is the z axis, of modified rows behind their twist.
        const CagTransform twist = cag_dh(0, 0, l->a, l->alpha),
                           turn = cag_transform_multiply(&before, &twist),
                           *own = modified ? &turn : &before;
        const CagVec3 o = cag_vec3(own->m[0][3], own->m[1][3], own->m[2][3]),
                      z = cag_vec3(own->m[0][2], own->m[1][2], own->m[2][2]);
        near_vec(directions[joint], z, 1e-13);
        near_vec(cag_cross(cag_sub(points[joint], o), z), cag_vec3(0, 0, 0), 1e-12);
        joint++;
        // The foot of the common normal.
        const CagTransform lift = cag_dh(l->theta + turned, l->d + moved, 0, 0),
                           foot = cag_transform_multiply(&before, modified ? &twist : &lift);
        expected[corners++] = cag_vec3(foot.m[0][3], foot.m[1][3], foot.m[2][3]);
      }
      at[i + 1] = cag_transform_multiply(&before, &a);
      expected[corners++] = cag_vec3(at[i + 1].m[0][3], at[i + 1].m[1][3], at[i + 1].m[2][3]);
    }
    const CagTransform end = cag_transform_multiply(&at[n], &r->tool);
    expected[corners++] = cag_vec3(end.m[0][3], end.m[1][3], end.m[2][3]);
    cag_robot_forward(r, q, &tool);
    assert_pose(&tool, (const double(*)[4])end.m, 1e-13);
    cag_robot_frames(r, q, frames);
    for (size_t i = 0; i <= n; i++) assert_pose(&frames[i], (const double(*)[4])at[i].m, 1e-13);
    assert_int_equal(cag_robot_skeleton(r, q, figure), corners);
    for (size_t i = 0; i < corners; i++) near_vec(figure[i], expected[i], 1e-12);
    for (size_t i = 0; i <= n; i++)
      for (size_t j = 0; j <= n; j++) { // at[j] T(j, i) = at[i]
        cag_robot_subchain(r, q, j, i, &part);
        part = cag_transform_multiply(&at[j], &part);
        assert_pose(&part, (const double(*)[4])at[i].m, 1e-12);
      }
    // The reach holds the tool from the first joint's axis point, wherever the joints stand.
    for (int place = 0; place < 20 && r->joint_count > 0; place++) {
      for (size_t i = 0; i < r->joint_count; i++) {
        const CagRobotLink *l = &r->links[r->joint_link[i]];
        q[i] = between(l->low, l->high);
      }
      cag_robot_forward(r, q, &tool);
      cag_robot_axes(r, q, points, directions);
      const CagVec3 p = cag_vec3(tool.m[0][3], tool.m[1][3], tool.m[2][3]);
      sum = fmax(sum, cag_norm(cag_sub(p, points[0])));
    }
    assert_true(sum <= r->reach * (1 + 1e-12));
    cag_robot_release(r);
  }
}

// Lengths that add up in one line are all of the reach.
static void the_reach_of_a_straight_chain_is_its_length(void **state) {
  (void)state;
  CagRobotLink links[4] = {cag_robot_link(CAG_JOINT_REVOLUTE), cag_robot_link(CAG_JOINT_FIXED),
                           cag_robot_link(CAG_JOINT_PRISMATIC), cag_robot_link(CAG_JOINT_REVOLUTE)};
  links[0].a = -1;
  links[1].fixed = cag_translate(cag_vec3(-2, 0, 0));
  links[1].fixed.planar = false;
  links[2].d = 1, links[2].low = links[2].home = -6, links[2].high = 3;
  links[3].screw = 0.5, links[3].low = -4, links[3].high = 2;
  CagRobot *r = NULL;
  CagRobotSpec spec = {.links = links,
                       .link_count = 4,
                       .base = cag_translate(cag_vec3(50, 0, 0)),
                       .tool = cag_translate(cag_vec3(0, 0, 7))};
  OK(cag_robot_new(&spec, &r, &err));
  NEAR(r->reach, 1 + 2 + 5 + 2 + 7, 1e-14);
  cag_robot_release(r);
  links[0].a = 0;
  spec.link_count = 1;
  spec.tool = cag_transform_identity();
  OK(cag_robot_new(&spec, &r, &err));
  NEAR(r->reach, 1, 0);
  cag_robot_release(r);
}

// The determinant of a matrix, by its permutations' products along the first row.
static double determinant(double (*m)[6], size_t n) {
  if (n == 1) return m[0][0];
  double sum = 0;
  for (size_t k = 0; k < n; k++) {
    double rest[6][6];
    for (size_t i = 1; i < n; i++)
      for (size_t j = 0, to = 0; j < n; j++)
        if (j != k) rest[i - 1][to++] = m[i][j];
    sum += (k % 2 ? -1 : 1) * m[0][k] * determinant(rest, n - 1);
  }
  return sum;
}

// Singular values by their sums of powers: the squares add up to the square of all entries, their
// squares to that of the products of columns, and their product is the root of a determinant.
static void singular_values_have_their_sums(void **state) {
  (void)state;
  seed = 22;
  for (int k = 0; k < 200; k++) {
    int kinds[8];
    const size_t n = 1 + (size_t)k % 8;
    for (size_t i = 0; i < n; i++) kinds[i] = k % 16 < 8 ? 0 : (int)between(0, 4) % 2 * 3;
    CagRobot *r = random_chain(n, CAG_ROBOT_CLASSIC, kinds);
    double q[8], columns[8][6], values[6], products[8][8] = {{0}}, g[6][6] = {{0}}, squares = 0,
                                           fourths = 0, sum = 0, sum4 = 0, product = 1;
    size_t count, rank;
    for (size_t i = 0; i < n; i++) q[i] = between(-3, 3);
    cag_robot_jacobian(r, q, columns, NULL);
    // Manipulability: lengths as they are.
    for (size_t i = 0; i < (n < 6 ? n : 6); i++)
      for (size_t j = 0; j < (n < 6 ? n : 6); j++)
        for (size_t l = 0; l < (n < 6 ? 6 : n); l++)
          g[i][j] += n < 6 ? columns[i][l] * columns[j][l] : columns[l][i] * columns[l][j];
    const double gram = determinant(g, n < 6 ? n : 6);
    NEAR(cag_robot_manipulability(r, q) * cag_robot_manipulability(r, q), gram,
         1e-9 * fabs(gram) + 1e-12);
    OK(cag_robot_singular_values(r, q, values, &count, &rank, &err));
    assert_int_equal(count, n < 6 ? n : 6);
    for (size_t i = 0; i < n; i++)
      for (int l = 0; l < 3; l++) columns[i][l] /= r->reach;
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < n; j++) {
        for (int l = 0; l < 6; l++) products[i][j] += columns[i][l] * columns[j][l];
        fourths += products[i][j] * products[i][j];
      }
    for (size_t i = 0; i < n; i++) squares += products[i][i];
    for (size_t i = 0; i < count; i++) {
      if (i > 0) assert_true(values[i] <= values[i - 1]);
      assert_true(values[i] >= 0);
      sum += values[i] * values[i];
      sum4 += pow(values[i], 4);
      product *= values[i];
    }
    NEAR(sum, squares, 1e-12 * squares);
    NEAR(sum4, fourths, 1e-12 * fourths);
    double scaled = sqrt(fmax(gram, 0)); // three rows, or where fewer columns each row apart
    if (n >= 6) NEAR(product, scaled / pow(r->reach, 3), 1e-9);
    else {
      double small[6][6];
      for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) small[i][j] = products[i][j];
      NEAR(product * product, determinant(small, n), 1e-10);
    }
    assert_int_equal(rank, n < 6 ? n : 6);
    cag_robot_release(r);
  }
}

// Joints whose axes are one or parallel: the rank is what their axes span.
static void ranks_are_those_of_the_axes(void **state) {
  (void)state;
  seed = 23;
  for (int k = 0; k < 60; k++) {
    Row rows[8];
    const size_t n = 2 + (size_t)k % 7;
    const int kind = k % 3; // one axis; parallel axes; axes through one point
    for (size_t i = 0; i < n; i++) {
      rows[i] = (Row){kind == 2 ? 0 : between(-1, 1), kind == 1 ? between(0.5, 1) : 0,
                      kind == 2 ? between(30, 150) : 0};
    }
    CagRobot *r = chain(rows, n);
    double q[8], values[6];
    size_t count, rank;
    for (size_t i = 0; i < n; i++) q[i] = between(0.3, 1.2);
    OK(cag_robot_singular_values(r, q, values, &count, &rank, &err));
    const size_t full = kind == 0 ? 1 : 3;
    assert_int_equal(rank, n < full ? n : full);
    if (n > full) NEAR(cag_robot_manipulability(r, q), 0, 1e-7);
    cag_robot_release(r);
  }
}

// --- Limits and couplings ---

static void values_are_brought_within_their_limits(void **state) {
  (void)state;
  seed = 24;
  for (int k = 0; k < 4000; k++) {
    CagRobotLink link = cag_robot_link(k % 4 ? CAG_JOINT_REVOLUTE : CAG_JOINT_PRISMATIC);
    link.low = between(-15, 10), link.high = link.low + between(0, k % 3 ? 4 : 20);
    link.home = link.high, link.a = 1;
    if (k % 8 == 1) link.screw = 0.1;
    CagRobot *r = NULL;
    CagRobotSpec spec = {.links = &link,
                         .link_count = 1,
                         .base = cag_transform_identity(),
                         .tool = cag_transform_identity()};
    OK(cag_robot_new(&spec, &r, &err));
    double q = between(-20, 20), near = between(-20, 20), value = q, by, limit, home;
    // The nearest to the wish of all values whole turns away, by trial.
    double best = INFINITY;
    for (int turns = -12; turns <= 12; turns++) {
      const double x = q + turns * 2 * M_PI;
      if ((turns != 0 && (link.kind != CAG_JOINT_REVOLUTE || link.screw != 0)) || x < link.low ||
          x > link.high)
        continue;
      const double wish = k % 2 ? near : q;
      if (fabs(x - wish) < fabs(best - wish)) best = x;
    }
    assert_int_equal(cag_robot_into_limits(r, k % 2 ? &near : NULL, &value), isfinite(best));
    if (isfinite(best)) NEAR(value, best, 1e-12);
    const double over = fmax(0, fmax(link.low - q, q - link.high));
    NEAR(cag_robot_joint_outside(r, 0, q, &limit), over, 1e-12);
    if (over > 0) NEAR(limit, q < link.low ? link.low : link.high, 0);
    assert_int_equal(cag_robot_outside(r, &q, &by), over == 0);
    NEAR(by, over, 1e-12);
    cag_robot_home(r, &home);
    NEAR(home, link.high, 0);
    // Rounding past a limit is on it.
    value = link.high + 1e-13;
    assert_int_equal(cag_robot_outside(r, &value, &by), 1);
    assert_true(cag_robot_into_limits(r, &value, &value));
    NEAR(value, link.high, 0);
    value = link.low - 1e-13;
    assert_int_equal(cag_robot_outside(r, &value, &by), 1);
    assert_true(cag_robot_into_limits(r, &value, &value));
    NEAR(value, link.low, 0);
    cag_robot_release(r);
  }
}

static void random_couplings_are_undone(void **state) {
  (void)state;
  seed = 25;
  for (int k = 0; k < 300; k++) {
    const size_t n = 1 + (size_t)k % 6;
    double m[36], offset[6], q[6], motors[6], back[6];
    CagRobotLink links[6];
    for (size_t i = 0; i < n; i++) links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
    for (size_t i = 0; i < n * n; i++) m[i] = between(0, 1) < 0.4 ? 0 : between(-2, 2);
    // A permutation, so that pivots are needed, and the matrix is regular more often.
    for (size_t i = 0; i < n; i++) m[i * n + (i + (size_t)k) % n] += 3;
    for (size_t i = 0; i < n; i++) offset[i] = between(-1, 1);
    for (size_t i = 0; i < n; i++) q[i] = between(-1, 1);
    const bool plain = k % 7 == 0, singular = k % 7 == 1 && n > 1;
    if (singular)
      for (size_t j = 0; j < n; j++) m[(n - 1) * n + j] = n > 2 ? m[j] + m[n + j] : 2 * m[j];
    CagRobot *r = NULL;
    CagRobotSpec spec = {.links = links,
                         .link_count = n,
                         .base = cag_transform_identity(),
                         .tool = cag_transform_identity(),
                         .coupling = plain ? NULL : m,
                         .coupling_offset = k % 2 ? offset : NULL};
    if (singular) {
      FAILS(cag_robot_new(&spec, &r, &err), "coupling-singular");
      continue;
    }
    OK(cag_robot_new(&spec, &r, &err));
    cag_robot_motors(r, q, motors);
    for (size_t i = 0; i < n; i++) {
      double sum = plain ? q[i] : k % 2 ? offset[i] : 0;
      for (size_t j = 0; j < n && !plain; j++) sum += m[i * n + j] * q[j];
      NEAR(motors[i], sum, 1e-14);
    }
    cag_robot_joints(r, motors, back);
    for (size_t i = 0; i < n; i++) NEAR(back[i], q[i], 1e-10);
    cag_robot_release(r);
    if (plain) continue;
    const size_t row = (size_t)k / 7 % n;
    m[row * n + n - 1] = k % 2 ? NAN : INFINITY;
    FAILS_AT(cag_robot_new(&spec, &r, &err), "coupling-singular", (int)row);
    m[row * n + n - 1] = 1;
    offset[row] = NAN;
    if (k % 2) FAILS_AT(cag_robot_new(&spec, &r, &err), "coupling-singular", (int)row);
  }
}

// --- What is refused ---

static void transforms_that_are_no_motions_are_refused(void **state) {
  (void)state;
  seed = 26;
  for (int k = 0; k < 400; k++) {
    CagTransform t = random_motion(5);
    OK(cag_robot_pose_check(&t, "T", &err));
    const int i = k % 4, j = k / 4 % 4;
    const double was = t.m[i][j];
    // Rounding passes, more does not; places may be any, if they are finite.
    if (i < 3 && j < 3) {
      t.m[i][j] = was + 1e-11;
      OK(cag_robot_pose_check(&t, "T", &err));
      t.m[i][j] = was + 0.01;
      FAILS(cag_robot_pose_check(&t, "T", &err), "not-rigid");
    } else if (i < 3) {
      t.m[i][j] = was + 1e10;
      OK(cag_robot_pose_check(&t, "T", &err));
    } else {
      t.m[i][j] = was + 1e-6;
      FAILS(cag_robot_pose_check(&t, "T", &err), "not-rigid");
    }
    t.m[i][j] = k % 2 ? NAN : INFINITY;
    FAILS(cag_robot_pose_check(&t, "T", &err), "not-rigid");
    t.m[i][j] = was;
    for (int row = 0; row < 3; row++) t.m[row][k % 3] *= -1; // a mirror
    FAILS(cag_robot_pose_check(&t, "T", &err), "not-rigid");
  }
}

static void bad_numbers_of_links_are_named(void **state) {
  (void)state;
  CagRobotLink links[3] = {cag_robot_link(CAG_JOINT_REVOLUTE), cag_robot_link(CAG_JOINT_FIXED),
                           cag_robot_link(CAG_JOINT_PRISMATIC)};
  links[2].high = 4;
  CagRobotSpec spec = {.links = links,
                       .link_count = 3,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  CagRobot *r = NULL;
  OK(cag_robot_new(&spec, &r, &err));
  // Shared: the last release frees it.
  assert_ptr_equal(cag_robot_retain(r), r);
  cag_robot_release(r);
  assert_int_equal(r->joint_count, 2);
  cag_robot_release(r);
  for (int at = 0; at < 3; at += 2) {
    CagRobotLink *l = &links[at], good = *l;
    double *const numbers[] = {&l->theta, &l->d,     &l->a,     &l->alpha,
                               &l->screw, &l->speed, &l->effort};
    for (size_t i = 0; i < 7; i++) {
      *numbers[i] = i % 2 ? NAN : INFINITY;
      FAILS_AT(cag_robot_new(&spec, &r, &err), "link-number", at);
      FAILS(cag_robot_link_check(l, &err), "link-number");
      *l = good;
    }
    // The home may be at a limit, and the limits may be one.
    l->low = l->high = l->home = 0.5;
    OK(cag_robot_link_check(l, &err));
    l->home = 0.5 + 1e-9;
    FAILS_AT(cag_robot_new(&spec, &r, &err), "home-outside", at / 2);
    l->home = 0.5 - 1e-9;
    FAILS_AT(cag_robot_new(&spec, &r, &err), "home-outside", at / 2);
    l->low = 0.6;
    FAILS_AT(cag_robot_new(&spec, &r, &err), "joint-limits", at / 2);
    *l = good;
  }
  links[2].home = 5;
  FAILS_AT(cag_robot_new(&spec, &r, &err), "home-outside", 1);
  assert_string_equal(err.message, "the home value 5 of joint 2 lies outside of its limits 0..4");
  links[2].home = 0;
  links[0].low = -M_PI / 2, links[0].high = M_PI / 4, links[0].home = M_PI;
  FAILS_AT(cag_robot_new(&spec, &r, &err), "home-outside", 0);
  assert_string_equal(err.message,
                      "the home value 180deg of joint 1 lies outside of its limits -90deg..45deg");
  FAILS(cag_robot_link_check(&links[0], &err), "home-outside");
  links[0].home = 0, links[0].low = M_PI / 2;
  FAILS_AT(cag_robot_new(&spec, &r, &err), "joint-limits", 0);
  assert_string_equal(err.message, "the limits of joint 1 run from 90deg down to 45deg; the lower "
                                   "comes first");
  links[0].low = -INFINITY;
  FAILS_AT(cag_robot_new(&spec, &r, &err), "joint-limits", 0);
  links[0].low = -1;
  links[1].fixed.m[0][0] = -1;
  FAILS_AT(cag_robot_new(&spec, &r, &err), "not-rigid", 1);
  FAILS(cag_robot_link_check(&links[1], &err), "not-rigid");
  links[1].fixed.m[0][0] = 1;
  spec.base.m[1][1] = 2;
  FAILS(cag_robot_new(&spec, &r, &err), "not-rigid");
  spec.base.m[1][1] = 1;
  CagRobotLink many[CAG_ROBOT_JOINTS_MAX + 2];
  for (size_t i = 0; i < CAG_ROBOT_JOINTS_MAX + 2; i++)
    many[i] = cag_robot_link(i ? CAG_JOINT_REVOLUTE : CAG_JOINT_FIXED);
  spec.links = many;
  spec.link_count = CAG_ROBOT_JOINTS_MAX + 1;
  OK(cag_robot_new(&spec, &r, &err));
  cag_robot_release(r);
  spec.link_count++;
  FAILS(cag_robot_new(&spec, &r, &err), "too-many-joints");
}

// --- Tables from axes ---

// Frames and rows of random axes, some of them parallel, meeting or one.
static void random_axes_get_frames(void **state) {
  (void)state;
  seed = 27;
  for (int k = 0; k < 500; k++) {
    CagJointAxis axes[6], end;
    CagRobotLink links[6];
    CagTransform frames[7];
    const double unit = k % 3 == 0 ? 1e-3 : k % 3 == 1 ? 1 : 1e3;
    const size_t n = 1 + (size_t)k % 6;
    CagTransform base = random_motion(2 * unit);
    const CagVec3 z0 = cag_vec3(base.m[0][2], base.m[1][2], base.m[2][2]),
                  o0 = cag_vec3(base.m[0][3], base.m[1][3], base.m[2][3]);
    CagJointAxis before = {CAG_JOINT_REVOLUTE, o0, z0};
    for (size_t i = 0; i <= n; i++) {
      CagJointAxis *a = i < n ? &axes[i] : &end;
      double v[6];
      for (int j = 0; j < 6; j++) v[j] = between(-1, 1);
      const double how = between(0, 1), turned = between(-2, 2);
      a->kind = turned > 1 ? CAG_JOINT_PRISMATIC : CAG_JOINT_REVOLUTE;
      a->direction = cag_scaled(cag_vec3(v[0], v[1], v[2]), 3);
      a->point = cag_scaled(cag_vec3(v[3], v[4], v[5]), unit);
      // The first axis is the base's; others are parallel, against it, meet it or are one with it.
      if (i == 0 || how < 0.4) a->direction = cag_scaled(before.direction, i && v[0] < 0 ? -2 : 2);
      if (i == 0 || (how > 0.3 && how < 0.7))
        a->point = cag_madd(before.point, turned * unit, cag_unit(before.direction));
      before = *a;
    }
    OK(cag_robot_dh_assign(&base, axes, n, &end, links, frames, &err));
    for (size_t i = 0; i <= n; i++) {
      const CagJointAxis *a = i < n ? &axes[i] : &end;
      const CagVec3 x = cag_vec3(frames[i].m[0][0], frames[i].m[1][0], frames[i].m[2][0]),
                    z = cag_vec3(frames[i].m[0][2], frames[i].m[1][2], frames[i].m[2][2]),
                    o = cag_vec3(frames[i].m[0][3], frames[i].m[1][3], frames[i].m[2][3]);
      OK(cag_robot_pose_check(&frames[i], "frame", &err));
      near_vec(z, cag_unit(a->direction), 1e-8);
      if (cag_norm(cag_cross(cag_sub(a->point, o), z)) > 1e-6 * unit)
        fail_msg("frame %zu is beside its axis", i);
      if (i == 0) {
        assert_pose(&frames[0], (const double(*)[4])base.m, 1e-12 * unit + 1e-12);
        continue;
      }
      const CagVec3 last = cag_vec3(frames[i - 1].m[0][2], frames[i - 1].m[1][2],
                                    frames[i - 1].m[2][2]),
                    from = cag_vec3(frames[i - 1].m[0][3], frames[i - 1].m[1][3],
                                    frames[i - 1].m[2][3]);
      NEAR(cag_dot(x, last), 0, 1e-7); // along the common normal
      const CagRobotLink *l = &links[i - 1];
      assert_int_equal(l->kind, axes[i - 1].kind);
      assert_true(l->a >= -1e-9 * unit);
      const CagTransform row = cag_dh(l->theta, l->d, l->a, l->alpha),
                         next = cag_transform_multiply(&frames[i - 1], &row);
      for (int m = 0; m < 3; m++)
        for (int j = 0; j < 4; j++)
          NEAR(next.m[m][j], frames[i].m[m][j], j < 3 ? 1e-8 : 1e-6 * unit);
      // Away from the axis before; of axes that meet along the product of their directions; of
      // parallel ones towards the point of the next axis, or as before where the axes are one.
      const CagVec3 product = cag_cross(last, z), way = cag_sub(a->point, from),
                    off = cag_madd(way, -cag_dot(way, last), last);
      const CagVec3 x_before =
          cag_vec3(frames[i - 1].m[0][0], frames[i - 1].m[1][0], frames[i - 1].m[2][0]);
      if (cag_norm(product) > 1e-6 && l->a < 1e-9 * unit) near_vec(x, cag_unit(product), 1e-6);
      if (cag_norm(product) < 1e-6 && cag_norm(off) > 1e-6 * unit) near_vec(x, cag_unit(off), 1e-6);
      if (cag_norm(product) < 1e-6 && cag_norm(off) < 1e-10 * unit) near_vec(x, x_before, 1e-7);
      // Parallel axes: without rise, but the last frame at the height of its point.
      if (cag_norm(product) < 1e-9) NEAR(l->d, i == n ? cag_dot(way, last) : 0, 1e-6 * unit);
    }
    // What cannot be.
    const size_t bad = (size_t)k / 6 % (n + 1);
    CagJointAxis *a = bad < n ? &axes[bad] : &end, good = *a;
    a->direction = k % 2 ? cag_vec3(0, 0, 0) : cag_vec3(INFINITY, 0, 0);
    FAILS_AT(cag_robot_dh_assign(&base, axes, n, &end, links, frames, &err), "zero-vector",
             bad < n ? (int)bad : -1);
    *a = good;
    CagTransform off = base;
    const CagVec3 x0 = cag_vec3(base.m[0][0], base.m[1][0], base.m[2][0]);
    for (int i = 0; i < 3; i++) off.m[i][3] += 1e-3 * unit * (&x0.x)[i];
    FAILS(cag_robot_dh_assign(&off, axes, n, &end, links, frames, &err), "axis-off-base");
    const CagTransform lean = cag_dh(0, 0, 0, k % 2 ? 1e-3 : M_PI);
    off = cag_transform_multiply(&base, &lean);
    FAILS(cag_robot_dh_assign(&off, axes, n, &end, links, frames, &err), "axis-off-base");
    off = base;
    off.m[0][0] += 0.1;
    FAILS(cag_robot_dh_assign(&off, axes, n, &end, links, frames, &err), "not-rigid");
  }
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
      cmocka_unit_test(chains_are_products_of_their_links),
      cmocka_unit_test(the_reach_of_a_straight_chain_is_its_length),
      cmocka_unit_test(singular_values_have_their_sums),
      cmocka_unit_test(ranks_are_those_of_the_axes),
      cmocka_unit_test(values_are_brought_within_their_limits),
      cmocka_unit_test(random_couplings_are_undone),
      cmocka_unit_test(transforms_that_are_no_motions_are_refused),
      cmocka_unit_test(bad_numbers_of_links_are_named),
      cmocka_unit_test(random_axes_get_frames),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
