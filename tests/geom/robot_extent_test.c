// The boxes of workspaces: a shell with a hole about the first axis, in any direction.

#include "geom/robot/workspace.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

static CagRobotLink whole_turn(double d, double a, double alpha) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_REVOLUTE);
  l.d = d;
  l.a = a;
  l.alpha = alpha;
  l.low = -M_PI;
  l.high = M_PI;
  return l;
}

static CagRobotLink slide(double low, double high) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_PRISMATIC);
  l.low = l.home = low;
  l.high = high;
  return l;
}

// A base that rotates the first axis to the direction z.
static CagTransform base_along(CagVec3 z) {
  const CagVec3 other = fabs(z.x) < 0.7 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
  const CagVec3 x = cag_unit(cag_cross(other, z)), y = cag_cross(z, x);
  CagTransform t = cag_transform_identity();
  const CagVec3 columns[3] = {x, y, z};
  for (int k = 0; k < 3; k++) {
    t.m[0][k] = columns[k].x;
    t.m[1][k] = columns[k].y;
    t.m[2][k] = columns[k].z;
  }
  for (int i = 0; i < 3; i++) t.m[i][3] = uniform(-3, 3);
  t.planar = false;
  return t;
}

// The extent in a direction whose cosine with the first axis is c. At height h above the shoulder,
// the region reaches a distance of sqrt(r_max^2 + hole^2 - h^2) from the axis.
static double highest(const CagWorkspace *w, double c) {
  enum { HEIGHTS = 4000 };
  double most = 0;
  for (int k = -HEIGHTS; k <= HEIGHTS; k++) {
    const double h = w->r_max * k / HEIGHTS, whole = w->r_max * w->r_max + w->hole * w->hole;
    most = fmax(most, c * h + sqrt(fmax(0, 1 - c * c)) * sqrt(whole - h * h));
  }
  return most;
}

static void check_extents(const CagRobotLink *links, CagVec3 axis, CagWorkspaceKind kind,
                          double r_max, double hole) {
  CagRobot *r = NULL;
  const CagRobotSpec spec = {
      .links = links, .link_count = 3, .base = base_along(axis), .tool = cag_transform_identity()};
  CagWorkspace w;
  OK(cag_robot_new(&spec, &r, &err));
  cag_robot_workspace(r, &w);
  assert_int_equal(w.kind, kind);
  assert_true(w.exact);
  NEAR(w.r_max, r_max, 1e-12);
  NEAR(w.hole, hole, 1e-12);
  // The shoulder is on the first axis, at the length of the first link from the base.
  near_vec(
      w.center,
      cag_madd(cag_vec3(spec.base.m[0][3], spec.base.m[1][3], spec.base.m[2][3]), links[0].d, axis),
      1e-12);
  const CagVec3 half = cag_vec3(highest(&w, axis.x), highest(&w, axis.y), highest(&w, axis.z));
  near_vec(w.bounds.max, cag_add(w.center, half), 1e-6);
  near_vec(w.bounds.min, cag_sub(w.center, half), 1e-6);
  // All reachable points are inside.
  for (int k = 0; k < 200; k++) {
    double q[3];
    CagTransform t;
    for (int i = 0; i < 3; i++) q[i] = uniform(links[i].low, links[i].high);
    cag_robot_forward(r, q, &t);
    const double p[3] = {t.m[0][3], t.m[1][3], t.m[2][3]},
                 low[3] = {w.bounds.min.x, w.bounds.min.y, w.bounds.min.z},
                 high[3] = {w.bounds.max.x, w.bounds.max.y, w.bounds.max.z};
    for (int i = 0; i < 3; i++) assert_true(p[i] >= low[i] - 1e-12 && p[i] <= high[i] + 1e-12);
  }
  cag_robot_release(r);
}

static void shells_with_a_hole_have_tight_boxes(void **state) {
  (void)state;
  seed = 71;
  for (int round = 0; round < 120; round++) {
    // Along an axis of the world, slightly off it, or in any direction.
    const int sign = round % 2 ? -1 : 1, k = round / 2 % 3;
    CagVec3 axis = cag_vec3(k == 0 ? sign : 0, k == 1 ? sign : 0, k == 2 ? sign : 0);
    if (round >= 30) {
      const double off = round < 60 ? 0.3 : 2;
      axis.x += uniform(-off, off);
      axis.y += uniform(-off, off);
      axis.z += uniform(-off, off);
      axis = cag_unit(axis);
    }
    const double d = uniform(-1, 1), hole = uniform(0.1, 2), upper = uniform(0.3, 2),
                 fore = uniform(0.3, 2), low = uniform(0.1, 1);
    const CagRobotLink elbow[3] = {whole_turn(d, 0, M_PI / 2), whole_turn(hole * sign, upper, 0),
                                   whole_turn(0, fore, 0)};
    check_extents(elbow, axis, CAG_WORKSPACE_ARTICULATED, upper + fore, hole);
    const CagRobotLink stanford[3] = {whole_turn(d, 0, -M_PI / 2),
                                      whole_turn(hole * sign, 0, M_PI / 2), slide(low, low + fore)};
    check_extents(stanford, axis, CAG_WORKSPACE_OFFSET, low + fore, hole);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shells_with_a_hole_have_tight_boxes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
