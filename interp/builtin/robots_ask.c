// Questions to robots: where their frames are, how they move, what their motors do.

#include <string.h>

#include "geom/robot/numeric.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// --- Reading ---

bool cag_arg_robot(CagCall *call, int argument, CagRobot **out) {
  if (call->values[argument].type != CAG_ROBOT) return cag_fail_type(call, argument, "a robot");
  *out = CAG_AS_ROBOT(call->values[argument])->robot;
  return true;
}

const char *const cag_joint_kinds[] = {"revolute", "prismatic", "fixed"};

static bool joint_turns(const CagRobot *r, size_t joint) {
  return r->links[r->joint_link[joint]].kind == CAG_JOINT_REVOLUTE;
}

const char *cag_joint_text(const CagRobot *r, size_t joint, double q, char *buffer) {
  bool turns = joint_turns(r, joint);
  cag_number_text(turns ? cag_degrees_shown(q) : q, buffer);
  if (turns) strcat(buffer, "deg");
  return buffer;
}

// A difference of joint values, with six digits.
static const char *rounded_text(const CagRobot *r, size_t joint, double x, char *buffer) {
  bool turns = joint_turns(r, joint);
  snprintf(buffer, 48, "%.6g%s", turns ? x / CAG_RADIANS_PER_DEGREE : x, turns ? "deg" : "");
  return buffer;
}

static bool check_limits(CagCall *call, int argument, const CagRobot *r, const double *q) {
  double by;
  size_t joint = cag_robot_outside(r, q, &by);
  if (joint == r->joint_count) return true;
  char value[48], over[48], low[48], high[48];
  const CagRobotLink *l = &r->links[r->joint_link[joint]];
  return cag_fail_call(call, argument, CAG_ERR_outside_limits,
                       "expects joint values within the limits; joint %zu is at %s, %s outside of "
                       "%s..%s",
                       joint + 1, cag_joint_text(r, joint, q[joint], value),
                       rounded_text(r, joint, by, over), cag_joint_text(r, joint, l->low, low),
                       cag_joint_text(r, joint, l->high, high));
}

bool cag_arg_joints(CagCall *call, int argument, const CagRobot *r, bool limits, double *q) {
  CagList *list;
  if (!cag_arg_list(call, argument, &list)) return false;
  if (list->length != r->joint_count)
    return cag_fail_call(call, argument, CAG_ERR_joint_count,
                         "expects %zu joint value%s, one for each joint of the robot, found %zu",
                         r->joint_count, r->joint_count == 1 ? "" : "s", list->length);
  for (size_t i = 0; i < list->length; i++) {
    CagValue v = cag_list_get(call->vm, list, i);
    bool turns = joint_turns(r, i);
    if (v.type != (turns ? CAG_ANGLE : CAG_NUMBER) || !isfinite(v.as.number)) {
      char expected[80];
      snprintf(expected, sizeof expected,
               turns ? "a finite angle for the revolute joint %zu"
                     : "a finite number for the prismatic joint %zu",
               i + 1);
      return cag_fail_element(call, argument, i, v, expected);
    }
    q[i] = turns ? v.as.number * CAG_RADIANS_PER_DEGREE : v.as.number;
  }
  return !limits || check_limits(call, argument, r, q);
}

bool cag_arg_joints_or_home(CagCall *call, int argument, const CagRobot *r, bool limits,
                            double *q) {
  if (cag_given(call, argument)) return cag_arg_joints(call, argument, r, limits, q);
  cag_robot_home(r, q);
  return true;
}

bool cag_pose_of_value(CagCall *call, int argument, CagValue v, CagTransform *out) {
  *out = CAG_AS_TRANSFORM(v)->t;
  return cag_geometry_ok(call,
                         cag_robot_pose_check(out, cag_parameter_name(call, argument), call->err));
}

bool cag_arg_pose(CagCall *call, int argument, CagTransform *out) {
  CagTransform t;
  return cag_arg_transform(call, argument, &t) &&
         cag_pose_of_value(call, argument, call->values[argument], out);
}

CagValue cag_joint_value(const CagRobot *r, size_t joint, double q) {
  return cag_parameter_value(joint_turns(r, joint), q);
}

CagValue cag_joints_value(CagVm *vm, const CagRobot *r, const double *q) {
  CagValue values[CAG_ROBOT_JOINTS_MAX];
  for (size_t i = 0; i < r->joint_count; i++) values[i] = cag_joint_value(r, i, q[i]);
  return cag_list_values(vm, values, r->joint_count);
}

// --- Frames ---

// Checks a link's number: 0 (the base) .. the number of links.
static bool read_frame(CagCall *call, int argument, const CagRobot *r, size_t fallback,
                       size_t *out) {
  long number = (long)fallback;
  if (!cag_arg_integer_or(call, argument, number, 0, (long)r->link_count, &number)) return false;
  *out = (size_t)number;
  return true;
}

bool cag_robots_fk(CagCall *call, const struct cag_robots_fk *a, CagValue *result) {
  const CagRobot *r = a->robot;
  double q[CAG_ROBOT_JOINTS_MAX];
  size_t link, from;
  CagTransform t;
  if (!cag_arg_joints(call, 1, r, a->limits, q) || !read_frame(call, 2, r, r->link_count, &link) ||
      !read_frame(call, 3, r, 0, &from))
    return false;
  if (!cag_given(call, 2) && !cag_given(call, 3)) {
    cag_robot_forward(r, q, &t);
  } else {
    cag_robot_subchain(r, q, from, link, &t);
    if (!cag_given(call, 2)) t = cag_transform_multiply(&t, &r->tool);
    if (!cag_given(call, 3)) t = cag_transform_multiply(&r->base, &t);
    t.planar = false;
  }
  *result = cag_transform_value(call->vm, &t);
  return true;
}

bool cag_robots_link_frames(CagCall *call, const struct cag_robots_link_frames *a,
                            CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints(call, 1, a->robot, a->limits, q)) return false;
  CagTransform *frames = cag_hold_array(call, a->robot->link_count + 1, sizeof *frames);
  cag_robot_frames(a->robot, q, frames);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i <= a->robot->link_count; i++)
    if (!cag_builder_add(call->vm, list, cag_transform_value(call->vm, &frames[i]))) return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- Motion ---

// The columns of the Jacobian in the axes of the world, or of the tool.
static void find_jacobian(const CagRobot *r, const double *q, bool of_tool, double (*columns)[6]) {
  if (of_tool) cag_robot_jacobian_tool(r, q, columns);
  else cag_robot_jacobian(r, q, columns, NULL);
}

bool cag_robots_jacobian(CagCall *call, const struct cag_robots_jacobian *a, CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX], columns[CAG_ROBOT_JOINTS_MAX][6], *numbers;
  if (!cag_arg_joints(call, 1, a->robot, a->limits, q)) return false;
  find_jacobian(a->robot, q, a->frame, columns);
  CagValue rows[6];
  for (int k = 0; k < 6; k++) {
    rows[k] = cag_list_numbers(call->vm, a->robot->joint_count, &numbers);
    for (size_t i = 0; i < a->robot->joint_count; i++) numbers[i] = columns[i][k];
  }
  *result = cag_list_values(call->vm, rows, 6);
  return true;
}

bool cag_robots_manipulability(CagCall *call, const struct cag_robots_manipulability *a,
                               CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX];
  return cag_arg_joints(call, 1, a->robot, a->limits, q) &&
         cag_give_number(call, cag_robot_manipulability(a->robot, q), result);
}

static bool find_rank(CagCall *call, const CagRobot *r, bool limits, size_t *count, size_t *rank) {
  double q[CAG_ROBOT_JOINTS_MAX], values[6];
  return cag_arg_joints(call, 1, r, limits, q) &&
         cag_geometry_ok(call, cag_robot_singular_values(r, q, values, count, rank, call->err));
}

bool cag_robots_is_singular(CagCall *call, const struct cag_robots_is_singular *a,
                            CagValue *result) {
  size_t count = 0, rank = 0;
  if (!find_rank(call, a->robot, a->limits, &count, &rank)) return false;
  *result = cag_bool(rank < count);
  return true;
}

bool cag_robots_jacobian_rank(CagCall *call, const struct cag_robots_jacobian_rank *a,
                              CagValue *result) {
  size_t count = 0, rank = 0;
  if (!find_rank(call, a->robot, a->limits, &count, &rank)) return false;
  *result = cag_number((double)rank);
  return true;
}

bool cag_robots_velocity(CagCall *call, const struct cag_robots_velocity *a, CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX], dq[CAG_ROBOT_JOINTS_MAX], columns[CAG_ROBOT_JOINTS_MAX][6];
  double v[6] = {0};
  if (!cag_arg_joints(call, 1, a->robot, a->limits, q) ||
      !cag_arg_joints(call, 2, a->robot, false, dq))
    return false;
  find_jacobian(a->robot, q, a->frame, columns);
  for (size_t i = 0; i < a->robot->joint_count; i++)
    for (int k = 0; k < 6; k++) v[k] += columns[i][k] * dq[i];
  *result = cag_vector(call->vm, v, 6);
  return true;
}

bool cag_robots_torques(CagCall *call, const struct cag_robots_torques *a, CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX], columns[CAG_ROBOT_JOINTS_MAX][6], *torques;
  if (!cag_arg_joints(call, 1, a->robot, a->limits, q)) return false;
  if (a->wrench.count != 6)
    return cag_fail_call(call, 2, CAG_ERR_length,
                         "expects 6 numbers, the force [fx, fy, fz] and the moment [mx, my, mz] at "
                         "the tool, found %zu",
                         a->wrench.count);
  find_jacobian(a->robot, q, a->frame, columns);
  *result = cag_list_numbers(call->vm, a->robot->joint_count, &torques);
  for (size_t i = 0; i < a->robot->joint_count; i++) {
    torques[i] = 0;
    for (int k = 0; k < 6; k++) torques[i] += columns[i][k] * a->wrench.items[k];
  }
  return true;
}

bool cag_robots_null_motion(CagCall *call, const struct cag_robots_null_motion *a,
                            CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX], dq[CAG_ROBOT_JOINTS_MAX], out[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints(call, 1, a->robot, a->limits, q) ||
      !cag_arg_joints(call, 2, a->robot, false, dq))
    return false;
  cag_robot_null_motion(a->robot, q, dq, out);
  *result = cag_joints_value(call->vm, a->robot, out);
  return true;
}

// --- The chain's lines ---

bool cag_robots_skeleton(CagCall *call, const struct cag_robots_skeleton *a, CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints_or_home(call, 1, a->robot, a->limits, q)) return false;
  CagVec3 *points = cag_hold_array(call, 2 * a->robot->link_count + 2, sizeof *points);
  size_t n = cag_robot_skeleton(a->robot, q, points);
  *result = cag_points_value(call->vm, points, n, 3);
  return true;
}

bool cag_robots_joint_axes(CagCall *call, const struct cag_robots_joint_axes *a, CagValue *result) {
  static const char *const names[] = {"kind", "point", "direction"};
  const CagRobot *r = a->robot;
  double q[CAG_ROBOT_JOINTS_MAX];
  CagVec3 points[CAG_ROBOT_JOINTS_MAX], directions[CAG_ROBOT_JOINTS_MAX];
  CagValue records[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints_or_home(call, 1, r, a->limits, q)) return false;
  cag_robot_axes(r, q, points, directions);
  for (size_t i = 0; i < r->joint_count; i++) {
    CagVec3 z = cag_add(directions[i], cag_vec3(0, 0, 0)); // never -0
    CagValue values[] = {cag_text_c(call->vm, joint_turns(r, i) ? "revolute" : "prismatic"),
                         cag_point(call->vm, points[i], 3), cag_point(call->vm, z, 3)};
    records[i] = cag_record_new(call->vm, names, values, 3);
  }
  *result = cag_list_values(call->vm, records, r->joint_count);
  return true;
}

// --- Tables ---

static CagValue table_row(CagVm *vm, const CagRobotLink *l) {
  static const char *const names[] = {"kind", "theta", "d", "a", "alpha", "limits", "transform"};
  bool moves = l->kind != CAG_JOINT_FIXED, turns = l->kind == CAG_JOINT_REVOLUTE;
  CagValue values[] = {
      cag_text_c(vm, cag_joint_kinds[l->kind]),
      moves ? cag_angle(cag_degrees_shown(l->theta)) : cag_none(),
      moves ? cag_number(l->d) : cag_none(),
      moves ? cag_number(l->a) : cag_none(),
      moves ? cag_angle(cag_degrees_shown(l->alpha)) : cag_none(),
      moves ? cag_domain_value(vm, turns, l->low, l->high) : cag_none(),
      moves ? cag_none() : cag_transform_value(vm, &l->fixed),
  };
  return cag_record_new(vm, names, values, 7);
}

bool cag_robots_dh_table(CagCall *call, const struct cag_robots_dh_table *a, CagValue *result) {
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = 0; i < a->robot->link_count; i++)
    if (!cag_builder_add(call->vm, rows, table_row(call->vm, &a->robot->links[i]))) return false;
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

// --- Limits and couplings ---

bool cag_robots_violations(CagCall *call, const struct cag_robots_violations *a, CagValue *result) {
  static const char *const names[] = {"joint", "value", "limit", "by"};
  const CagRobot *r = a->robot;
  double q[CAG_ROBOT_JOINTS_MAX];
  CagValue records[CAG_ROBOT_JOINTS_MAX];
  size_t n = 0;
  if (!cag_arg_joints(call, 1, r, false, q)) return false;
  for (size_t i = 0; i < r->joint_count; i++) {
    double limit, by = cag_robot_joint_outside(r, i, q[i], &limit);
    if (by == 0) continue;
    CagValue values[] = {cag_number((double)(i + 1)), cag_joint_value(r, i, q[i]),
                         cag_joint_value(r, i, limit), cag_joint_value(r, i, by)};
    records[n++] = cag_record_new(call->vm, names, values, 4);
  }
  *result = cag_list_values(call->vm, records, n);
  return true;
}

// The map between joints and motors, or its linear part where `change` is true.
static bool give_map(CagCall *call, const CagRobot *r, bool change,
                     void (*map)(const CagRobot *, const double *, double *), CagValue *result) {
  double q[CAG_ROBOT_JOINTS_MAX], out[CAG_ROBOT_JOINTS_MAX], at_zero[CAG_ROBOT_JOINTS_MAX];
  const double zeros[CAG_ROBOT_JOINTS_MAX] = {0};
  if (!cag_arg_joints(call, 1, r, false, q)) return false;
  map(r, q, out);
  if (change) {
    map(r, zeros, at_zero);
    for (size_t i = 0; i < r->joint_count; i++) out[i] -= at_zero[i];
  }
  *result = cag_joints_value(call->vm, r, out);
  return true;
}

bool cag_robots_motor_values(CagCall *call, const struct cag_robots_motor_values *a,
                             CagValue *result) {
  return give_map(call, a->robot, a->change, cag_robot_motors, result);
}

bool cag_robots_joint_values(CagCall *call, const struct cag_robots_joint_values *a,
                             CagValue *result) {
  return give_map(call, a->robot, a->change, cag_robot_joints, result);
}
