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
  cag_fail_call(call, argument, CAG_ERR_outside_limits,
                "expects joint values within the limits; joint %zu is at %s, %s outside of "
                "%s..%s",
                joint + 1, cag_joint_text(r, joint, q[joint], value),
                rounded_text(r, joint, by, over), cag_joint_text(r, joint, l->low, low),
                cag_joint_text(r, joint, l->high, high));
  return false;
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
               turns ? "a finite angle for joint %zu, which turns,"
                     : "a finite number for joint %zu, which slides,",
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
  return joint_turns(r, joint) ? cag_angle(cag_degrees_shown(q)) : cag_number(q);
}

CagValue cag_joints_value(CagVm *vm, const CagRobot *r, const double *q) {
  CagValue values[CAG_ROBOT_JOINTS_MAX];
  for (size_t i = 0; i < r->joint_count; i++) values[i] = cag_joint_value(r, i, q[i]);
  return cag_list_values(vm, values, r->joint_count);
}

// --- Frames ---

// A link's number: 0 (the base) .. the number of links.
static bool read_frame(CagCall *call, int argument, const CagRobot *r, long fallback, long *out) {
  *out = fallback;
  if (!cag_given(call, argument)) return true;
  return cag_arg_integer(call, argument, 0, (long)r->link_count, out);
}

// robot, q, link, from, limits
bool cag_robots_fk(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX];
  bool limits;
  long link, from;
  CagTransform t;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_bool_or(call, 4, true, &limits) ||
      !cag_arg_joints(call, 1, r, limits, q) || !read_frame(call, 2, r, -1, &link) ||
      !read_frame(call, 3, r, -1, &from))
    return false;
  if (link < 0 && from < 0) {
    cag_robot_forward(r, q, &t);
  } else {
    size_t to = link < 0 ? r->link_count : (size_t)link;
    cag_robot_subchain(r, q, from < 0 ? 0 : (size_t)from, to, &t);
    if (link < 0) t = cag_transform_multiply(&t, &r->tool);
    if (from < 0) t = cag_transform_multiply(&r->base, &t);
    t.planar = false;
  }
  *result = cag_transform_value(call->vm, &t);
  return true;
}

// robot, q, limits
bool cag_robots_link_frames(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX];
  bool limits;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_bool_or(call, 2, true, &limits) ||
      !cag_arg_joints(call, 1, r, limits, q))
    return false;
  CagTransform *frames = cag_hold_array(call, r->link_count + 1, sizeof *frames);
  cag_robot_frames(r, q, frames);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i <= r->link_count; i++)
    if (!cag_builder_add(call->vm, list, cag_transform_value(call->vm, &frames[i]))) return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// --- Motion ---

// Robot and joint values as the first two arguments; `limits` is argument number `argument`, or
// always true where that is negative.
static bool read_place(CagCall *call, int argument, CagRobot **r, double *q) {
  bool limits = true;
  return cag_arg_robot(call, 0, r) &&
         (argument < 0 || cag_arg_bool_or(call, argument, true, &limits)) &&
         cag_arg_joints(call, 1, *r, limits, q);
}

// robot, q, frame, limits
bool cag_robots_jacobian(CagCall *call, CagValue *result) {
  static const char *const frames[] = {"base", "tool", NULL};
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX], columns[CAG_ROBOT_JOINTS_MAX][6], *numbers;
  int frame;
  if (!read_place(call, 3, &r, q) || !cag_arg_choice(call, 2, frames, &frame)) return false;
  if (frame) cag_robot_jacobian_tool(r, q, columns);
  else cag_robot_jacobian(r, q, columns, NULL);
  CagValue rows[6];
  for (int k = 0; k < 6; k++) {
    rows[k] = cag_list_numbers(call->vm, r->joint_count, &numbers);
    for (size_t i = 0; i < r->joint_count; i++) numbers[i] = columns[i][k];
  }
  *result = cag_list_values(call->vm, rows, 6);
  return true;
}

bool cag_robots_manipulability(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!read_place(call, 2, &r, q)) return false;
  return cag_give_number(call, cag_robot_manipulability(r, q), result);
}

static bool read_rank(CagCall *call, size_t *count, size_t *rank) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX], values[6];
  return read_place(call, 2, &r, q) &&
         cag_geometry_ok(call, cag_robot_singular_values(r, q, values, count, rank, call->err));
}

bool cag_robots_is_singular(CagCall *call, CagValue *result) {
  size_t count = 0, rank = 0;
  if (!read_rank(call, &count, &rank)) return false;
  *result = cag_bool(rank < count);
  return true;
}

bool cag_robots_jacobian_rank(CagCall *call, CagValue *result) {
  size_t count = 0, rank = 0;
  if (!read_rank(call, &count, &rank)) return false;
  *result = cag_number((double)rank);
  return true;
}

// robot, q, dq, frame, limits
bool cag_robots_velocity(CagCall *call, CagValue *result) {
  static const char *const frames[] = {"base", "tool", NULL};
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX], dq[CAG_ROBOT_JOINTS_MAX], columns[CAG_ROBOT_JOINTS_MAX][6],
      v[6] = {0};
  int frame;
  if (!read_place(call, 4, &r, q) || !cag_arg_joints(call, 2, r, false, dq) ||
      !cag_arg_choice(call, 3, frames, &frame))
    return false;
  if (frame) cag_robot_jacobian_tool(r, q, columns);
  else cag_robot_jacobian(r, q, columns, NULL);
  for (size_t i = 0; i < r->joint_count; i++)
    for (int k = 0; k < 6; k++) v[k] += columns[i][k] * dq[i];
  *result = cag_vector(call->vm, v, 6);
  return true;
}

// robot, q, wrench, frame, limits
bool cag_robots_torques(CagCall *call, CagValue *result) {
  static const char *const frames[] = {"base", "tool", NULL};
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX], columns[CAG_ROBOT_JOINTS_MAX][6], *torques;
  const double *wrench = NULL;
  size_t n = 0;
  int frame;
  if (!read_place(call, 4, &r, q) || !cag_arg_numbers(call, 2, &wrench, &n) ||
      !cag_arg_choice(call, 3, frames, &frame))
    return false;
  if (n != 6)
    return cag_fail_call(call, 2, CAG_ERR_length,
                         "expects 6 numbers, the force [fx, fy, fz] and the moment [mx, my, mz] at "
                         "the tool, found %zu",
                         n);
  if (frame) cag_robot_jacobian_tool(r, q, columns);
  else cag_robot_jacobian(r, q, columns, NULL);
  *result = cag_list_numbers(call->vm, r->joint_count, &torques);
  for (size_t i = 0; i < r->joint_count; i++) {
    torques[i] = 0;
    for (int k = 0; k < 6; k++) torques[i] += columns[i][k] * wrench[k];
  }
  return true;
}

bool cag_robots_null_motion(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX], dq[CAG_ROBOT_JOINTS_MAX], out[CAG_ROBOT_JOINTS_MAX];
  if (!read_place(call, 3, &r, q) || !cag_arg_joints(call, 2, r, false, dq)) return false;
  cag_robot_null_motion(r, q, dq, out);
  *result = cag_joints_value(call->vm, r, out);
  return true;
}

// --- The chain's lines ---

bool cag_robots_skeleton(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX];
  bool limits;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_bool_or(call, 2, true, &limits) ||
      !cag_arg_joints_or_home(call, 1, r, limits, q))
    return false;
  CagVec3 *points = cag_hold_array(call, 2 * r->link_count + 2, sizeof *points);
  size_t n = cag_robot_skeleton(r, q, points);
  *result = cag_points_value(call->vm, points, n, 3);
  return true;
}

bool cag_robots_joint_axes(CagCall *call, CagValue *result) {
  static const char *const names[] = {"kind", "point", "direction"};
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX];
  CagVec3 points[CAG_ROBOT_JOINTS_MAX], directions[CAG_ROBOT_JOINTS_MAX];
  CagValue records[CAG_ROBOT_JOINTS_MAX];
  bool limits;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_bool_or(call, 2, true, &limits) ||
      !cag_arg_joints_or_home(call, 1, r, limits, q))
    return false;
  cag_robot_axes(r, q, points, directions);
  for (size_t i = 0; i < r->joint_count; i++) {
    CagVec3 z = directions[i];
    CagValue values[] = {cag_text_c(call->vm, joint_turns(r, i) ? "revolute" : "prismatic"),
                         cag_point(call->vm, points[i], 3),
                         cag_point(call->vm, cag_vec3(z.x + 0.0, z.y + 0.0, z.z + 0.0), 3)};
    records[i] = cag_record_new(call->vm, names, values, 3);
  }
  *result = cag_list_values(call->vm, records, r->joint_count);
  return true;
}

// --- Tables ---

static CagValue table_row(CagVm *vm, const CagRobotLink *l) {
  static const char *const names[] = {"kind", "theta", "d", "a", "alpha", "limits", "transform"};
  static const char *const kinds[] = {"revolute", "prismatic", "fixed"};
  bool moves = l->kind != CAG_JOINT_FIXED, turns = l->kind == CAG_JOINT_REVOLUTE;
  CagValue values[] = {
      cag_text_c(vm, kinds[l->kind]),
      moves ? cag_angle(cag_degrees_shown(l->theta)) : cag_none(),
      moves ? cag_number(l->d) : cag_none(),
      moves ? cag_number(l->a) : cag_none(),
      moves ? cag_angle(cag_degrees_shown(l->alpha)) : cag_none(),
      moves ? cag_domain_value(vm, turns, l->low, l->high) : cag_none(),
      moves ? cag_none() : cag_transform_value(vm, &l->fixed),
  };
  return cag_record_new(vm, names, values, 7);
}

bool cag_robots_dh_table(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  if (!cag_arg_robot(call, 0, &r)) return false;
  CagBuilder *rows = cag_builder_new(call->vm);
  for (size_t i = 0; i < r->link_count; i++)
    if (!cag_builder_add(call->vm, rows, table_row(call->vm, &r->links[i]))) return false;
  *result = cag_builder_finish(call->vm, rows);
  return true;
}

// --- Limits and couplings ---

bool cag_robots_violations(CagCall *call, CagValue *result) {
  static const char *const names[] = {"joint", "value", "limit", "by"};
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX];
  CagValue records[CAG_ROBOT_JOINTS_MAX];
  size_t n = 0;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_joints(call, 1, r, false, q)) return false;
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
static bool give_map(CagCall *call, void (*map)(const CagRobot *, const double *, double *),
                     CagValue *result) {
  CagRobot *r = NULL;
  double q[CAG_ROBOT_JOINTS_MAX], out[CAG_ROBOT_JOINTS_MAX], zeros[CAG_ROBOT_JOINTS_MAX] = {0},
                                                             at_zero[CAG_ROBOT_JOINTS_MAX];
  bool change;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_joints(call, 1, r, false, q) ||
      !cag_arg_bool_or(call, 2, false, &change))
    return false;
  map(r, q, out);
  if (change) {
    map(r, zeros, at_zero);
    for (size_t i = 0; i < r->joint_count; i++) out[i] -= at_zero[i];
  }
  *result = cag_joints_value(call->vm, r, out);
  return true;
}

bool cag_robots_motor_values(CagCall *call, CagValue *result) {
  return give_map(call, cag_robot_motors, result);
}

bool cag_robots_joint_values(CagCall *call, CagValue *result) {
  return give_map(call, cag_robot_joints, result);
}
