// Helpers for the tests of robots: chains without base and tool, and comparisons of poses.

#ifndef CAG_TESTS_ROBOT_SUPPORT_H
#define CAG_TESTS_ROBOT_SUPPORT_H

#include "geom/robot/robot.h"

#include "support.h"

#define DEGREE (M_PI / 180)

static inline CagRobot *robot_of(const CagRobotLink *links, size_t n) {
  CagRobot *r = NULL;
  CagRobotSpec spec = {.links = links,
                       .link_count = n,
                       .base = cag_transform_identity(),
                       .tool = cag_transform_identity()};
  OK(cag_robot_new(&spec, &r, &err));
  return r;
}

typedef struct Row {
  double d, a, alpha;
} Row;

static inline CagRobot *revolute_chain(const Row *rows, size_t n) {
  CagRobotLink links[16];
  for (size_t i = 0; i < n; i++) {
    links[i] = cag_robot_link(CAG_JOINT_REVOLUTE);
    links[i].d = rows[i].d;
    links[i].a = rows[i].a;
    links[i].alpha = rows[i].alpha * DEGREE;
  }
  return robot_of(links, n);
}

static inline void assert_pose(const CagTransform *t, const double m[3][4], double tolerance) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) NEAR(t->m[i][j], m[i][j], tolerance);
}

#endif
