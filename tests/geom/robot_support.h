// What the tests of chains share: chains of revolute links, and comparisons of poses.

#ifndef CAG_TESTS_ROBOT_SUPPORT_H
#define CAG_TESTS_ROBOT_SUPPORT_H

#include "geom/robot/robot.h"

#include "support.h"

#define DEGREE (M_PI / 180)

typedef struct Row {
  double d, a, alpha;
} Row;

static inline CagRobot *chain(const Row *rows, size_t n) {
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

static inline void assert_pose(const CagTransform *t, const double m[3][4], double tolerance) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++) NEAR(t->m[i][j], m[i][j], tolerance);
}

#endif
