// Planar robots with a prismatic joint anywhere: the position determines the part of a pose that is
// unreachable.

#include "geom/robot/inverse.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { MOST = 3 };

// Revolute and prismatic joints in the order of the letters, with parallel or antiparallel axes.
static CagRobot *robot_of(const char *joints) {
  CagRobotLink links[MOST];
  const size_t n = strlen(joints);
  for (size_t i = 0; i < n; i++) {
    const bool slides = joints[i] == 'P';
    links[i] = cag_robot_link(slides ? CAG_JOINT_PRISMATIC : CAG_JOINT_REVOLUTE);
    links[i].theta = slides ? uniform(-3, 3) : uniform(-1, 1);
    links[i].d = slides ? 0 : uniform(-1, 1);
    links[i].a = uniform(0.3, 2);
    links[i].alpha = uniform(0, 1) < 0.5 ? 0 : M_PI;
    links[i].low = slides ? -5 : -M_PI;
    links[i].high = slides ? 5 : M_PI;
  }
  const double roll = uniform(-3, 3), pitch = uniform(-1.5, 1.5), yaw = uniform(-3, 3);
  CagRobotSpec spec = {.links = links,
                       .link_count = n,
                       .base = cag_rpy(roll, pitch, yaw),
                       .tool = cag_transform_identity()};
  for (int i = 0; i < 3; i++) spec.base.m[i][3] = uniform(-3, 3);
  spec.base.planar = false;
  CagRobot *r = NULL;
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

static CagVec3 origin_of(const CagTransform *t) {
  return cag_vec3(t->m[0][3], t->m[1][3], t->m[2][3]);
}

// The vector to p, perpendicular to the axis through o along z.
static CagVec3 away_from(CagVec3 o, CagVec3 z, CagVec3 p) {
  const CagVec3 way = cag_sub(p, o);
  return cag_madd(way, -cag_dot(way, z), z);
}

static CagInverseStatus status_at(const CagRobot *r, CagTransform pose, CagVec3 place,
                                  double turn) {
  const CagTransform about = cag_dh(turn, 0, 0, 0);
  CagInverse all;
  pose = cag_transform_multiply(&pose, &about);
  pose.m[0][3] = place.x;
  pose.m[1][3] = place.y;
  pose.m[2][3] = place.z;
  cag_robot_inverse(r, &pose, NULL, &all);
  return all.status;
}

// Two revolute joints reach points whose distance is between the difference and the sum of the
// lengths, in two ways each; any other orientation of the tool is unreachable there. With three
// revolute joints, the third axis must be reachable by the first two.
static void places_out_of_reach_are_told_from_turns(void **state) {
  (void)state;
  static const char *const kinds[] = {"RR", "PRR", "RPR", "RRP", "RRR"};
  seed = 511;
  for (int round = 0; round < 500; round++) {
    CagRobot *r = robot_of(kinds[round % 5]);
    CagVec3 o[CAG_ROBOT_JOINTS_MAX], z[CAG_ROBOT_JOINTS_MAX];
    double q[MOST] = {0};
    size_t turns[MOST] = {0}, n = 0;
    for (size_t i = 0; i < r->joint_count; i++) {
      q[i] = uniform(-2, 2);
      if (kinds[round % 5][i] == 'R') turns[n++] = i;
    }
    CagTransform pose;
    cag_robot_axes(r, q, o, z);
    cag_robot_forward(r, q, &pose);
    const CagVec3 tool = origin_of(&pose), axis = z[turns[0]];
    const CagVec3 target = n == 3 ? o[turns[2]] : tool;
    const double first = cag_norm(away_from(o[turns[0]], axis, o[turns[1]])),
                 second = cag_norm(away_from(o[turns[1]], axis, target));
    const CagVec3 from = away_from(o[turns[0]], axis, target), along = cag_unit(from);
    const double now = cag_norm(from), least = fabs(first - second), most = first + second;
    assert_int_equal(status_at(r, pose, tool, 0), CAG_INVERSE_OK);
    // The same orientation, so that the third axis moves like the tool.
    const double wanted[3] = {most + uniform(0.01, 2), least - uniform(0.01, 1),
                              uniform(least + 0.01, most - 0.01)};
    for (int k = 0; k < 3; k++) {
      if (wanted[k] <= 0.01 || (k == 2 && most - least < 0.05)) continue;
      const CagVec3 place = cag_madd(tool, wanted[k] - now, along);
      const CagInverseStatus s = status_at(r, pose, place, n == 3 ? 0 : uniform(0.5, 1.5));
      if (k < 2) assert_int_equal(s, CAG_INVERSE_UNREACHABLE);
      else if (n == 3) assert_int_equal(s, CAG_INVERSE_OK);
      else assert_true(s == CAG_INVERSE_ORIENTATION);
    }
    cag_robot_release(r);
  }
}

// Two links of equal length reach points in front of, beside, and behind the first frame like all
// others: with both bends of the elbow, if the tool may rotate.
static void equal_links_reach_places_on_the_axes_of_the_frame(void **state) {
  (void)state;
  seed = 512;
  for (int round = 0; round < 200; round++) {
    CagRobotLink links[3];
    CagRobot *r = NULL;
    const size_t n = 2 + (size_t)round % 2;
    const bool back = round / 2 % 2;
    for (size_t i = 0; i < n; i++) {
      links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
      links[i].theta = uniform(-1, 1);
      links[i].low = -4;
      links[i].high = 4;
      links[i].a = 1.3;
    }
    links[0].alpha = back ? M_PI : 0;
    if (n == 3) links[2].a = 0;
    const CagRobotSpec spec = {.links = links,
                               .link_count = n,
                               .base = cag_transform_identity(),
                               .tool = cag_transform_identity()};
    OK(cag_robot_new(&spec, &r, &err));
    const double bend = (round / 4 % 2 ? 1 : -1) * uniform(0.3, 2.8);
    const double ahead = M_PI / 2 * (round / 8 % 4 - 1);
    double q[3] = {ahead - links[0].theta - (back ? -1 : 1) * bend / 2, bend - links[1].theta,
                   uniform(-1, 1)};
    CagTransform pose;
    CagInverse all;
    cag_robot_forward(r, q, &pose);
    NEAR(sin(ahead) == 0 ? pose.m[1][3] : 0, 0, 1e-9);
    NEAR(fabs(cos(ahead)) < 0.5 ? pose.m[0][3] : 0, 0, 1e-9);
    cag_robot_inverse(r, &pose, NULL, &all);
    assert_int_equal(all.status, CAG_INVERSE_OK);
    assert_int_equal(all.count, n - 1);
    assert_int_equal(all.free, 0);
    double nearest = INFINITY;
    for (size_t i = 0; i < all.count; i++) {
      double off = 0;
      CagTransform found;
      cag_robot_forward(r, all.solutions[i].q, &found);
      near_vec(origin_of(&found), origin_of(&pose), 1e-9);
      for (size_t k = 0; k < n; k++)
        off = fmax(off, fabs(remainder(all.solutions[i].q[k] - q[k], 2 * M_PI)));
      nearest = fmin(nearest, off);
    }
    NEAR(nearest, 0, 1e-8);
    if (n == 2) { // the position alone, with both bends
      cag_robot_inverse_point(r, origin_of(&pose), NULL, &all);
      assert_int_equal(all.status, CAG_INVERSE_OK);
      assert_int_equal(all.count, 2);
      assert_int_equal(all.free, 0);
      for (size_t i = 0; i < 2; i++) {
        CagTransform found;
        cag_robot_forward(r, all.solutions[i].q, &found);
        near_vec(origin_of(&found), origin_of(&pose), 1e-9);
      }
    }
    cag_robot_release(r);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(places_out_of_reach_are_told_from_turns),
      cmocka_unit_test(equal_links_reach_places_on_the_axes_of_the_frame),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
