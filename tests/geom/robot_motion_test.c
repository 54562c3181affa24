// Numerical inverse kinematics, paths, and workspaces: solutions are checked by their poses, and
// reach by closed forms.

#include "geom/robot/numeric.h"
#include "geom/robot/path.h"
#include "geom/robot/workspace.h"
#include "robot_support.h"

// Rows of d, a, alpha, and the symmetric limit.
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

static void random_joints(const CagRobot *r, uint64_t *state, double *q) {
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
      random_joints(robots[k], &seed, q);
      cag_robot_forward(robots[k], q, &wanted);
      assert_true(cag_robot_search(robots[k], &wanted, &search, found).solved);
      assert_reaches(robots[k], found, &wanted, 1e-9);
      // The result is reproducible.
      cag_robot_search(robots[k], &wanted, &search, again);
      assert_memory_equal(found, again, robots[k]->joint_count * sizeof *found);
    }
    cag_robot_release(robots[k]);
  }
}

// The same arm of revolute and prismatic joints with its lengths in other units. Scaling by powers
// of two is exact, so the search takes the same steps.
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
    random_joints(robots[0], &seed, places);
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
  // From the shoulder at (0, 0, 0.34), the arm of seven joints reaches 0.926.
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

// Absurd numbers produce a result, not an endless loop.
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
    assert_true(q[k][1] > 0); // the elbow never flips
  }
  // The reach of 500 ends at x = sqrt(500^2 - 100^2) = 489.9, after step 9 of 20 mm each.
  assert_int_equal(cag_robot_line_path(r, &a, &far, 16, &always, &q[0][0], &err), CAG_E_DEGENERATE);
  assert_string_equal(cag_error_info(err.id)->reason, "path-leaves");
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

  // The elbow bends at most 90 degrees, so the ring begins at sqrt(5).
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

// --- Workspaces of random arms ---

// Returns a random number from a range.
static double between(uint64_t *state, double low, double high) {
  return low + random_number(state) * (high - low);
}

#define GRID 32
#define PROBES (GRID + 1)

// Steps the first n joints through a grid over the limits, including the ends; the others are not
// changed. Returns false when all have been visited.
static bool next_configuration(const CagRobot *r, size_t n, size_t *at, double *q) {
  size_t i = 0;
  while (i < n && ++at[i] == PROBES) at[i++] = 0;
  for (size_t k = 0; k < n; k++) {
    const CagRobotLink *l = &r->links[k];
    q[k] = l->low + (l->high - l->low) * (double)at[k] / GRID;
  }
  return i < n;
}

// The distance bounded by r_min and r_max: see workspace.h.
static double distance_of(const CagRobot *r, const CagWorkspace *w, CagVec3 p) {
  CagVec3 way = cag_sub(p, w->center);
  const CagVec3 axis =
      cag_vec3(r->base.m[0][2], r->base.m[1][2], r->base.m[2][2]); // the axis of the first joint
  const bool flat = w->kind == CAG_WORKSPACE_CYLINDRICAL || w->kind == CAG_WORKSPACE_PLANAR ||
                    w->kind == CAG_WORKSPACE_SCARA;
  if (flat) way = cag_madd(way, -cag_dot(way, axis), axis);
  return sqrt(fmax(0, cag_dot(way, way) - w->hole * w->hole));
}

// The volume swept by the points of three joints, counted with multiplicity: the integral of the
// determinant of their velocities, by the midpoint rule.
static double swept_volume(const CagRobot *r) {
  double sum = 0, cell = 1, q[CAG_ROBOT_JOINTS_MAX] = {0}, columns[CAG_ROBOT_JOINTS_MAX][6];
  for (size_t i = 0; i < 3; i++) cell *= (r->links[i].high - r->links[i].low) / GRID;
  for (size_t k = 0; k < (size_t)GRID * GRID * GRID; k++) {
    const size_t at[3] = {k % GRID, k / GRID % GRID, k / GRID / GRID};
    if (at[0] > 0) continue; // the first joint does not matter
    for (size_t i = 0; i < 3; i++)
      q[i] = r->links[i].low + ((double)at[i] + 0.5) / GRID * (r->links[i].high - r->links[i].low);
    cag_robot_jacobian(r, q, columns, NULL);
    const CagVec3 u = cag_vec3(columns[0][0], columns[0][1], columns[0][2]),
                  v = cag_vec3(columns[1][0], columns[1][1], columns[1][2]),
                  way = cag_vec3(columns[2][0], columns[2][1], columns[2][2]);
    sum += fabs(cag_dot(cag_cross(u, v), way));
  }
  return sum * GRID * cell;
}

// Checks that the points for all values of the first n joints are within the bounds, and reach
// them: exactly if a limit decides, and otherwise up to the spacing of the grid.
static void check_workspace(const CagRobot *r, const CagWorkspace *w, size_t n, bool sharp) {
  double q[CAG_ROBOT_JOINTS_MAX], least = INFINITY, most = 0;
  size_t at[CAG_ROBOT_JOINTS_MAX] = {0};
  CagBounds seen = CAG_BOUNDS_EMPTY;
  cag_robot_home(r, q);
  for (bool more = true; more;) {
    CagTransform tool;
    more = next_configuration(r, n, at, q);
    cag_robot_forward(r, q, &tool);
    const CagVec3 p = cag_vec3(tool.m[0][3], tool.m[1][3], tool.m[2][3]);
    const double d = distance_of(r, w, p);
    least = fmin(least, d);
    most = fmax(most, d);
    cag_bounds_add(&seen, p);
  }
  // The error of the square root of a small difference of squares.
  const double rounding = 1e-7 * r->reach, near = 0.03 * r->reach;
  assert_true(least >= w->r_min - rounding);
  assert_true(most <= w->r_max + rounding);
  if (sharp) {
    NEAR(least, w->r_min, near);
    NEAR(most, w->r_max, near);
  }
  assert_true(isnan(w->volume) == !w->exact);
  const bool bounded =
      w->kind == CAG_WORKSPACE_CARTESIAN ||
      (w->exact && (w->kind == CAG_WORKSPACE_OFFSET || w->kind == CAG_WORKSPACE_ARTICULATED));
  assert_true(bounded == (w->bounds.min.x <= w->bounds.max.x));
  if (!bounded) return;
  near_vec(w->bounds.min, seen.min, near);
  near_vec(w->bounds.max, seen.max, near);
}

// Makes a robot of the links, with a random base.
static CagRobot *placed_robot(const CagRobotLink *links, size_t n, uint64_t *state) {
  double angles[3], way[3];
  for (int i = 0; i < 3; i++) angles[i] = between(state, -2, 2);
  for (int i = 0; i < 3; i++) way[i] = between(state, -3, 3);
  CagRobot *r = NULL;
  CagRobotSpec spec = {.links = links,
                       .link_count = n,
                       .base = cag_rpy(angles[0], angles[1], angles[2]),
                       .tool = cag_transform_identity()};
  for (int i = 0; i < 3; i++) spec.base.m[i][3] = way[i];
  spec.base.planar = false;
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

static void slides_reach_a_box(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int k = 0; k < 8; k++) {
    CagRobotLink links[3];
    double middle[3], diagonal = 0;
    for (int i = 0; i < 3; i++) {
      const double low = between(&seed, -2, 2), span = between(&seed, 0.1, 2);
      links[i] = slide(low, low + span, i == 1 ? -90 : 0, i < 2 ? -90 : 0);
      middle[i] = low + span / 2;
      diagonal += span * span;
    }
    CagRobot *r = placed_robot(links, 3, &seed);
    CagWorkspace w;
    CagTransform at;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_CARTESIAN);
    assert_true(w.exact && !w.of_wrist);
    check_workspace(r, &w, 3, false);
    cag_robot_forward(r, middle, &at);
    near_vec(w.center, cag_vec3(at.m[0][3], at.m[1][3], at.m[2][3]), 1e-12);
    NEAR(w.r_max, sqrt(diagonal) / 2, 1e-12);
    NEAR(w.r_min, 0, 0);
    NEAR(w.volume, swept_volume(r), 1e-9);
    cag_robot_release(r);
    // Prismatic joints that are not perpendicular, and chains of a similar structure, are not of
    // this kind.
    for (int i = 0; i < 2; i++) {
      CagRobotLink skew[3] = {links[0], links[1], links[2]};
      skew[i].alpha += 0.1;
      r = placed_robot(skew, 3, &seed);
      cag_robot_workspace(r, &w);
      assert_int_equal(w.kind, CAG_WORKSPACE_OTHER);
      assert_true(isnan(w.volume) && !w.exact);
      cag_robot_release(r);
    }
  }
}

static void a_turn_and_slides_reach_a_cylinder(void **state) {
  (void)state;
  uint64_t seed = 4;
  for (int k = 0; k < 24; k++) {
    const double from = between(&seed, -170, 0), angle = k % 6 == 0 ? 400 : between(&seed, 60, 350),
                 low = between(&seed, k % 2 ? 0.2 : -2, k % 2 ? 2 : 0),
                 span = between(&seed, 0.2, 3);
    const CagRobotLink links[] = {turn(from, from + angle, 0, 0), slide(-1, 1.5, 90, 90),
                                  slide(low, low + span, 0, 0)};
    CagRobot *r = placed_robot(links, 3, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_CYLINDRICAL);
    assert_int_equal(w.exact, low >= 0);
    check_workspace(r, &w, 3, true);
    if (w.exact) NEAR(w.volume, swept_volume(r) * fmin(1, 360 / angle), 1e-3 * w.volume);
    cag_robot_release(r);
    // A radial prismatic joint whose axis does not meet the first axis.
    CagRobotLink beside[] = {links[0], links[1], links[2]};
    beside[0].a = 0.4;
    beside[1].theta = 0;
    r = placed_robot(beside, 3, &seed);
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_OTHER);
    cag_robot_release(r);
  }
}

static void turns_that_meet_and_a_slide_reach_a_ball(void **state) {
  (void)state;
  uint64_t seed = 5;
  int exact = 0;
  for (int k = 0; k < 60; k++) {
    const double middle = between(&seed, -180, 180), half = between(&seed, 5, 60),
                 low = between(&seed, k % 4 ? 0.2 : -2, k % 4 ? 2 : 0),
                 span = between(&seed, 0.2, 3), angle = k % 6 == 0 ? 400 : between(&seed, 60, 350);
    const CagRobotLink links[] = {turn(-90, angle - 90, 0, 90),
                                  turn(middle - half, middle + half, 90, 90),
                                  slide(low, low + span, 0, 0)};
    CagRobot *r = placed_robot(links, 3, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_SPHERICAL);
    // If the prismatic joint does not pass a pole, each point is reached once. At the poles, joint
    // 2 is at 90 or -90 degrees.
    const double to_pole =
        fmin(fabs(remainder(middle - 90, 360)), fabs(remainder(middle + 90, 360)));
    assert_int_equal(w.exact, low >= 0 && to_pole >= half);
    exact += w.exact;
    check_workspace(r, &w, 3, true);
    if (w.exact) NEAR(w.volume, swept_volume(r) * fmin(1, 360 / angle), 1e-3 * w.volume);
    cag_robot_release(r);
  }
  assert_true(exact >= 10);
}

static void a_shoulder_beside_the_axis_leaves_a_hole(void **state) {
  (void)state;
  uint64_t seed = 6;
  for (int k = 0; k < 24; k++) {
    const double low = between(&seed, k % 4 ? 0.1 : -2, k % 4 ? 2 : 0),
                 span = between(&seed, 0.2, 3);
    CagRobotLink links[] = {turn(-180, k % 5 == 1 ? 170 : 180, 0, -90),
                            turn(-180, k % 5 == 2 ? 170 : 180, 0, 90),
                            slide(low, low + span, 0, 0)};
    links[0].d = between(&seed, -1, 1);
    links[1].d = between(&seed, 0.3, 1) * (k % 2 ? 1 : -1);
    CagRobot *r = placed_robot(links, 3, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_OFFSET);
    NEAR(w.hole, fabs(links[1].d), 1e-12);
    assert_int_equal(w.exact, low >= 0 && k % 5 != 1 && k % 5 != 2);
    check_workspace(r, &w, 3, true);
    // Each point is reached with the shoulder on either side.
    if (w.exact) NEAR(w.volume, swept_volume(r) / 2, 2e-3 * w.volume);
    cag_robot_release(r);
  }
}

static void an_elbow_reaches_a_shell(void **state) {
  (void)state;
  uint64_t seed = 7;
  for (int k = 0; k < 50; k++) {
    const double from = between(&seed, -400, 200), span = between(&seed, 5, k % 3 ? 170 : 400);
    CagRobotLink links[] = {turn(-180, k % 7 == 1 ? 170 : 180, 0, k % 2 ? 90 : -90),
                            turn(-180, k % 7 == 2 ? 170 : 180, 0, k % 5 ? 0 : 180),
                            turn(from, from + span, 0, 0)};
    links[0].d = between(&seed, -1, 1);
    links[1].a = between(&seed, 0.3, 2);
    links[1].d = k % 4 ? between(&seed, -0.3, 0.3) : 0;
    links[2].a = between(&seed, 0.3, 2);
    CagRobot *r = placed_robot(links, 3, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_ARTICULATED);
    NEAR(w.hole, fabs(links[1].d), 1e-12);
    assert_int_equal(w.exact, k % 7 != 1 && k % 7 != 2);
    check_workspace(r, &w, 3, true);
    // The law of cosines: at the limits, stretched, or folded.
    const double a = links[1].a, b = links[2].a;
    double least = INFINITY, most = 0;
    for (int turns = -3; turns <= 3; turns++)
      for (int half = 0; half < 2; half++) {
        const double straight = 360 * turns + 180 * half;
        if (straight < from || straight > from + span) continue;
        least = fmin(least, half ? fabs(a - b) : INFINITY);
        most = fmax(most, half ? 0 : a + b);
      }
    for (int end = 0; end < 2; end++) {
      const double t = (from + end * span) * DEGREE;
      least = fmin(least, sqrt(a * a + b * b + 2 * a * b * cos(t)));
      most = fmax(most, sqrt(a * a + b * b + 2 * a * b * cos(t)));
    }
    NEAR(w.r_min, least, 1e-7);
    NEAR(w.r_max, most, 1e-9);
    if (w.exact) NEAR(w.volume, 4 * M_PI / 3 * (most * most * most - least * least * least), 1e-6);
    cag_robot_release(r);
  }
}

// Planar arms of one to four revolute joints, with a prismatic joint anywhere among them.
static void parallel_turns_reach_a_ring(void **state) {
  (void)state;
  uint64_t seed = 8;
  for (int k = 0; k < 120; k++) {
    CagRobotLink links[5];
    const size_t turning = 1 + (size_t)k % 4, slide_at = (size_t)k / 4 % 6; // 5: no prismatic joint
    const bool slides = slide_at <= turning, full = k / 24 % 2;
    double sum = 0, largest = 0, travel = 1;
    size_t n = 0;
    bool free = true;
    for (size_t i = 0; i <= turning; i++) {
      if (slides && slide_at == i) {
        travel = between(&seed, 0.5, 2);
        links[n++] = slide(-0.3, travel - 0.3, 0, 0);
      }
      if (i == turning) break;
      const double half = full || i == 1 ? 180 : between(&seed, 60, 179);
      links[n] = turn(-half, half, between(&seed, -50, 50), i % 2 ? 180 : 0);
      links[n].a = between(&seed, 0.2, 2);
      sum += links[n].a;
      largest = fmax(largest, links[n].a);
      free = free && half == 180;
      n++;
    }
    CagRobot *r = placed_robot(links, n, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, slides ? CAG_WORKSPACE_SCARA : CAG_WORKSPACE_PLANAR);
    assert_int_equal(w.exact, free);
    NEAR(w.r_max, sum, 1e-9);
    NEAR(w.r_min, turning == 2 ? fabs(2 * largest - sum) : fmax(0, 2 * largest - sum), 1e-7);
    if (free) NEAR(w.volume, M_PI * (w.r_max * w.r_max - w.r_min * w.r_min) * travel, 1e-9);
    if (n <= 3) check_workspace(r, &w, n, free);
    cag_robot_release(r);
  }
}

// Two planar links whose elbow has limits: the ring is narrower. With a prismatic joint between the
// two, the formula for full rotations remains.
static void the_elbow_of_a_plane_has_limits(void **state) {
  (void)state;
  uint64_t seed = 9;
  for (int k = 0; k < 60; k++) {
    const double from = between(&seed, -200, 100), span = between(&seed, 5, 200);
    CagRobotLink links[3];
    size_t n = 0;
    const int slide_at = k % 4; // 3: none
    if (slide_at == 0) links[n++] = slide(0, 1, 0, 0);
    links[n] = turn(-180, 180, 0, 0);
    links[n++].a = between(&seed, 0.5, 2);
    if (slide_at == 1) links[n++] = slide(0, 1, 0, 0);
    links[n] = turn(from, from + span, 20, 0);
    links[n++].a = between(&seed, 0.5, 2);
    if (slide_at == 2) links[n++] = slide(0, 1, 0, 180);
    if (slide_at != 1) links[n - (slide_at == 2 ? 2 : 1)].theta = 0;
    CagRobot *r = placed_robot(links, n, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.exact, slide_at != 1);
    check_workspace(r, &w, n, slide_at != 1);
    if (w.exact) NEAR(w.volume, M_PI * (w.r_max * w.r_max - w.r_min * w.r_min), 1e-9);
    cag_robot_release(r);
  }
}

// Chains that are almost of one of the kinds.
static void other_arms_have_no_formula(void **state) {
  (void)state;
  uint64_t seed = 10;
  const CagRobotLink plain = turn(-180, 180, 0, 0);
  CagRobotLink arms[9][3];
  for (size_t i = 0; i < 9; i++)
    for (size_t k = 0; k < 3; k++) arms[i][k] = plain, arms[i][k].a = 1;
  // The waist is beside the shoulder; axes 1 and 2 are not perpendicular; axes 2 and 3 are not
  // parallel; a screw joint.
  arms[0][0].alpha = 90 * DEGREE;
  arms[1][0].a = 0, arms[1][0].alpha = 80 * DEGREE;
  arms[2][0].a = 0, arms[2][0].alpha = 90 * DEGREE, arms[2][1].alpha = 0.1;
  arms[3][1].screw = 0.1;
  arms[4][0].screw = 0.1;
  // A prismatic joint that is neither parallel nor perpendicular to the axis; two prismatic joints
  // along it.
  arms[5][2] = slide(0, 1, 0, 0), arms[5][1].alpha = 45 * DEGREE;
  arms[6][1] = slide(0, 1, 0, 0), arms[6][2] = slide(0, 1, 0, 0);
  // Prismatic joints alone; an oblique prismatic joint after two axes that meet.
  for (size_t k = 0; k < 3; k++) arms[7][k] = slide(0, 1, 0, 0);
  arms[8][0] = turn(-180, 180, 0, 90), arms[8][1] = turn(-20, 20, 0, 60);
  arms[8][2] = slide(1, 2, 0, 0);
  for (size_t i = 0; i < 9; i++) {
    CagRobot *r = placed_robot(arms[i], 3, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    if (w.kind != CAG_WORKSPACE_OTHER) fail_msg("arm %zu has kind %d", i, w.kind);
    assert_true(isnan(w.volume) && !w.exact && w.bounds.min.x > w.bounds.max.x);
    cag_robot_release(r);
  }
}

// Arms of every sequence of joints with axes that are parallel, perpendicular, or neither. Whatever
// kind is detected, its bounds hold, and are reached if they are exact. Some arms have a last joint
// that rotates about the tool.
static void bounds_hold_for_every_arm(void **state) {
  (void)state;
  static const double twists[] = {0, 90, -90, 180, 40};
  static const double lengths[] = {0, 0, 1.3, 0.4};
  uint64_t seed = 12;
  int known = 0;
  for (int k = 0; k < 400; k++) {
    CagRobotLink links[4];
    const size_t n = 3 + (size_t)(k / 8 % 2);
    for (size_t i = 0; i < 3; i++) {
      const double theta = between(&seed, 0, 1) < 0.5 ? 0 : 90,
                   twist = twists[(int)between(&seed, 0, 5)], low = between(&seed, -2, 1),
                   span = between(&seed, 0.2, 3);
      if (k >> i & 1) links[i] = slide(low, low + span, theta, twist);
      else {
        const double half = between(&seed, 0, 1) < 0.5 ? 180 : 40 * span;
        links[i] = turn(-half, half, theta, twist);
        links[i].d = lengths[(int)between(&seed, 0, 4)];
      }
      links[i].a = lengths[(int)between(&seed, 0, 4)];
    }
    links[3] = turn(-100, 100, 0, 90);
    CagRobot *r = placed_robot(links, n, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_false(w.of_wrist);
    if (w.kind == CAG_WORKSPACE_OTHER) assert_true(isnan(w.volume) && !w.exact);
    else check_workspace(r, &w, 3, w.exact && w.kind != CAG_WORKSPACE_CARTESIAN);
    known += w.kind != CAG_WORKSPACE_OTHER;
    cag_robot_release(r);
  }
  assert_true(known > 40);
}

// A prismatic joint that begins at its center up to rounding; links of equal length that fold
// exactly to the center; an arm whose point is on its axis.
static void ends_of_ranges_are_exact(void **state) {
  (void)state;
  uint64_t seed = 13;
  for (int k = 0; k < 30; k++) {
    const double span = between(&seed, 0.2, 3), a = between(&seed, 0.2, 3);
    const CagRobotLink cylinder[] = {turn(-180, 180, 0, 0), slide(0, 1, 90, 90),
                                     slide(0, span, 0, 0)},
                       ball[] = {turn(-180, 180, 0, 90), turn(-90, 90, 90, 90),
                                 slide(0, span, 0, 0)};
    CagRobotLink shell[] = {turn(-180, 180, 0, 90), turn(-180, 180, 0, 0), turn(-180, 180, 0, 0)};
    CagRobotLink ring[] = {turn(-180, 180, 0, 0), turn(k % 2 ? 30 : -180, 180, 0, 0)};
    CagRobotLink point[] = {turn(-180, 180, 0, 0)};
    shell[1].a = shell[2].a = ring[0].a = ring[1].a = a;
    const struct {
      const CagRobotLink *links;
      size_t n;
      double r_max, volume;
    } arms[] = {{cylinder, 3, span, M_PI * span * span},
                {ball, 3, span, 4 * M_PI / 3 * pow(span, 3)},
                {shell, 3, 2 * a, 4 * M_PI / 3 * pow(2 * a, 3)},
                {ring, 2, k % 2 ? 2 * a * cos(15 * DEGREE) : 2 * a, 0},
                {point, 1, 0, 0}};
    for (size_t i = 0; i < 5; i++) {
      CagRobot *r = placed_robot(arms[i].links, arms[i].n, &seed);
      CagWorkspace w;
      cag_robot_workspace(r, &w);
      assert_true(w.exact);
      NEAR(w.r_min, 0, 1e-13);
      NEAR(w.r_max, arms[i].r_max, 1e-13);
      NEAR(w.volume, i == 3 ? M_PI * arms[i].r_max * arms[i].r_max : arms[i].volume, 1e-10);
      cag_robot_release(r);
    }
    // Coinciding axes: a circle, for any limits.
    ring[0].a = 0;
    CagRobot *r = placed_robot(ring, 2, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_true(w.exact);
    NEAR(w.r_min, a, 1e-12);
    NEAR(w.r_max, a, 1e-12);
    NEAR(w.volume, 0, 1e-10);
    cag_robot_release(r);
  }
}

// Joints that rotate about the point do not belong to the arm. Three subsequent joints whose axes
// meet elsewhere are a wrist.
static void wrists_do_not_count(void **state) {
  (void)state;
  uint64_t seed = 11;
  for (int k = 0; k < 12; k++) {
    CagRobotLink links[6] = {turn(-180, 180, 0, 90),  turn(-180, 180, 0, 0), turn(-180, 180, 0, 90),
                             turn(-180, 180, 0, -90), turn(-90, 90, 0, 90),  turn(-180, 180, 0, 0)};
    const double hand = k % 3 == 0 ? 0 : between(&seed, 0.2, 1);
    links[1].a = between(&seed, 1, 2);
    links[3].d = between(&seed, 1, 2);
    links[5].d = hand;
    links[5].a = k % 3 == 2 ? 0.3 : 0;
    CagRobot *r = placed_robot(links, 6, &seed);
    CagWorkspace w;
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_ARTICULATED);
    assert_int_equal(w.of_wrist, hand > 0);
    NEAR(w.r_max, links[1].a + links[3].d, 1e-9);
    NEAR(w.r_min, fabs(links[1].a - links[3].d), 1e-7);
    near_vec(w.center, cag_vec3(r->base.m[0][3], r->base.m[1][3], r->base.m[2][3]), 1e-12);
    cag_robot_release(r);
    // If the last axis misses the other two, or one of the three is prismatic, there is no wrist.
    CagRobotLink other[6];
    memcpy(other, links, sizeof other);
    if (k % 4 == 0) other[4].a = 0.2;
    else other[2 + k % 4] = slide(0.2, 1, 0, k % 4 == 1 ? -90 : k % 4 == 2 ? 90 : 0);
    other[5].d = 0.3;
    r = placed_robot(other, 6, &seed);
    cag_robot_workspace(r, &w);
    assert_int_equal(w.kind, CAG_WORKSPACE_OTHER);
    assert_false(w.of_wrist);
    cag_robot_release(r);
  }
}

// The first samples are the corners of the limits, at most half of all; the others fill the
// interior.
static void samples_begin_with_the_corners(void **state) {
  (void)state;
  const CagRobotLink links[] = {turn(-10, 50, 0, 90), turn(20, 70, 0, 0), slide(2, 5, 0, 0)};
  static const size_t counts[][2] = {{1, 0}, {3, 0},  {4, 2},  {7, 2},
                                     {8, 4}, {15, 4}, {16, 8}, {500, 8}};
  CagRobot *r = robot_of(links, 3);
  for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
    const size_t n = counts[k][0], corners = counts[k][1];
    for (size_t i = 0; i < n; i++) {
      double q[3], even[3], by;
      cag_robot_workspace_sample(r, i, n, q);
      cag_robot_sequence(r, i + 1, even);
      assert_int_equal(cag_robot_outside(r, q, &by), 3);
      for (size_t j = 0; j < 3; j++) {
        const CagRobotLink *l = &r->links[j];
        if (i < corners && (size_t)1 << j < corners) NEAR(q[j], i >> j & 1 ? l->high : l->low, 0);
        else NEAR(q[j], even[j], 0);
      }
    }
  }
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
      cmocka_unit_test(slides_reach_a_box),
      cmocka_unit_test(a_turn_and_slides_reach_a_cylinder),
      cmocka_unit_test(turns_that_meet_and_a_slide_reach_a_ball),
      cmocka_unit_test(a_shoulder_beside_the_axis_leaves_a_hole),
      cmocka_unit_test(an_elbow_reaches_a_shell),
      cmocka_unit_test(parallel_turns_reach_a_ring),
      cmocka_unit_test(the_elbow_of_a_plane_has_limits),
      cmocka_unit_test(other_arms_have_no_formula),
      cmocka_unit_test(bounds_hold_for_every_arm),
      cmocka_unit_test(ends_of_ranges_are_exact),
      cmocka_unit_test(wrists_do_not_count),
      cmocka_unit_test(samples_begin_with_the_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
