// Random chains: products of links, ranks, limits, couplings and tables, against their definitions.

#include "geom/robot/robot.h"

#include "geom/robot/dh.h"
#include "random.h"
#include "robot_support.h"

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
    CagRobot *r = revolute_chain(rows, n);
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
  assert_string_equal(
      err.message,
      "the limits of joint 1 decrease from 90deg to 45deg; the lower limit comes first");
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
