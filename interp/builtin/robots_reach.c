// From poses to joint values: inverse kinematics, reach, and paths.

#include "geom/robot/path.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// --- One pose ---

bool cag_arg_target(CagCall *call, int argument, CagTransform *out, bool *point) {
  CagVec3 p;
  *point = call->values[argument].type == CAG_LIST;
  if (!*point) return cag_arg_pose(call, argument, out);
  if (!cag_arg_vec(call, argument, &p, NULL)) return false;
  *out = cag_translate(p);
  return true;
}

static bool read_branch(CagCall *call, const CagRecord *config, const char *name, int *out) {
  CagValue v = cag_record_get(config, name);
  if (v.type == CAG_UNSET || v.type == CAG_NONE) return true;
  if (v.type != CAG_NUMBER || fabs(v.as.number) != 1)
    return cag_fail_call(call, 3, CAG_ERR_value, "expects 1 or -1 as `%s` of `config`", name);
  *out = (int)v.as.number;
  return true;
}

bool cag_robots_ik(CagCall *call, const struct cag_robots_ik *a, CagValue *result) {
  CagTransform target;
  CagRobotFound found;
  double near[CAG_ROBOT_JOINTS_MAX], q[CAG_ROBOT_JOINTS_MAX];
  CagRobotGoal goal = {.near = near, .tolerance = a->tolerance};
  if (!cag_arg_target(call, 1, &target, &goal.position_only) ||
      !cag_arg_joints_or_home(call, 2, a->robot, false, near) ||
      (a->config && (!read_branch(call, a->config, "shoulder", &goal.shoulder) ||
                     !read_branch(call, a->config, "elbow", &goal.elbow) ||
                     !read_branch(call, a->config, "wrist", &goal.wrist))) ||
      !cag_geometry_ok(call, cag_robot_solve(a->robot, &target, &goal, q, &found, call->err)))
    return false;
  *result = cag_joints_value(call->vm, a->robot, q);
  return true;
}

bool cag_robots_reachable(CagCall *call, const struct cag_robots_reachable *a, CagValue *result) {
  CagTransform target;
  CagRobotGoal goal = {.tolerance = a->tolerance};
  CagRobotFound found;
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_target(call, 1, &target, &goal.position_only)) return false;
  *result = cag_bool(!cag_robot_solve(a->robot, &target, &goal, q, &found, call->err));
  return true;
}

bool cag_robots_closest_pose(CagCall *call, const struct cag_robots_closest_pose *a,
                             CagValue *result) {
  static const char *const names[] = {"q", "pose", "distance", "angle"};
  CagTransform target, pose;
  CagRobotFound found;
  double near[CAG_ROBOT_JOINTS_MAX], q[CAG_ROBOT_JOINTS_MAX];
  CagRobotGoal goal = {.near = near};
  if (!cag_arg_target(call, 1, &target, &goal.position_only) ||
      !cag_arg_joints_or_home(call, 2, a->robot, false, near))
    return false;
  if (cag_robot_solve(a->robot, &target, &goal, q, &found, call->err) &&
      call->err->id != CAG_ERR_unreachable)
    return cag_fail_geometry(call, call->err);
  cag_robot_forward(a->robot, q, &pose);
  CagValue values[] = {cag_joints_value(call->vm, a->robot, q),
                       cag_transform_value(call->vm, &pose), cag_number(found.position),
                       goal.position_only ? cag_none()
                                          : cag_angle(cag_degrees_shown(found.rotation))};
  *result = cag_record_new(call->vm, names, values, 4);
  return true;
}

// --- Paths ---

// n places of the joints as a list of q.
static bool give_places(CagCall *call, const CagRobot *r, const double *q, size_t n,
                        CagValue *result) {
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t k = 0; k < n; k++)
    if (!cag_builder_add(call->vm, list, cag_joints_value(call->vm, r, q + k * r->joint_count)) ||
        !cag_keep_going(call->vm))
      return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// Room for n places of the joints, held.
static double *take_places(CagCall *call, const CagRobot *r, size_t n) {
  return cag_hold_array(call, n * r->joint_count, sizeof(double));
}

bool cag_robots_joint_path(CagCall *call, const struct cag_robots_joint_path *a, CagValue *result) {
  const size_t joints = a->robot->joint_count, n = (size_t)a->n;
  double from[CAG_ROBOT_JOINTS_MAX], to[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints(call, 1, a->robot, true, from) ||
      !cag_arg_joints(call, 2, a->robot, true, to))
    return false;
  double *q = take_places(call, a->robot, n);
  for (size_t k = 0; k < n; k++) {
    const double t = (double)k / (double)(n - 1);
    for (size_t i = 0; i < joints; i++) q[k * joints + i] = (1 - t) * from[i] + t * to[i];
  }
  return give_places(call, a->robot, q, n, result);
}

static bool going(void *vm) { return cag_keep_going(vm); }

bool cag_robots_line_path(CagCall *call, const struct cag_robots_line_path *a, CagValue *result) {
  CagTransform from, to;
  double near[CAG_ROBOT_JOINTS_MAX];
  const size_t n = (size_t)a->n;
  bool point;
  CagRobotWay way = {.near = near, .cross = a->cross, .going = going, .data = call->vm};
  if (!cag_arg_target(call, 1, &from, &way.position_only) || !cag_arg_target(call, 2, &to, &point))
    return false;
  if (point != way.position_only)
    return cag_fail_type(call, 2,
                         way.position_only ? "a point, because the start is a point"
                                           : "a pose, because the start is a pose");
  if (!cag_arg_joints_or_home(call, 4, a->robot, false, near)) return false;
  double *q = take_places(call, a->robot, n);
  CagStatus status = cag_robot_line_path(a->robot, &from, &to, n, &way, q, call->err);
  return cag_geometry_ok(call, status) && give_places(call, a->robot, q, n, result);
}

// Poses, or points where the tool may be turned as it likes; *out is held.
static bool read_poses(CagCall *call, CagTransform **out, size_t *n, bool *points) {
  CagList *list;
  if (!cag_arg_list(call, 1, &list)) return false;
  *n = list->length;
  *points = list->dim == 3;
  *out = cag_hold_array(call, list->length, sizeof **out);
  for (size_t i = 0; i < list->length; i++) {
    CagValue v = cag_list_get(call->vm, list, i);
    const double *x = *points ? list->as.numbers + 3 * i : NULL;
    bool finite = *points && isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]);
    if (finite) (*out)[i] = cag_translate(cag_vec3(x[0], x[1], x[2]));
    else if (v.type != CAG_TRANSFORM)
      return cag_fail_element(call, 1, i, v, "poses or points in space");
    else if (!cag_pose_of_value(call, 1, v, &(*out)[i])) return false;
  }
  return true;
}

bool cag_robots_follow(CagCall *call, const struct cag_robots_follow *a, CagValue *result) {
  CagTransform *poses;
  double near[CAG_ROBOT_JOINTS_MAX];
  size_t n;
  CagRobotWay way = {.near = near, .jumps = a->jumps, .going = going, .data = call->vm};
  if (!cag_arg_joints_or_home(call, 2, a->robot, false, near) ||
      !read_poses(call, &poses, &n, &way.position_only))
    return false;
  double *q = take_places(call, a->robot, n);
  return cag_geometry_ok(call, cag_robot_follow(a->robot, poses, n, &way, q, call->err)) &&
         give_places(call, a->robot, q, n, result);
}
