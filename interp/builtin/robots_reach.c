// From poses to joint values: inverse kinematics, reach, and paths.

#include <string.h>

#include "base/memory.h"
#include "geom/robot/path.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// Most poses that one call follows.
#define POSES_MAX 1000000

// --- One pose ---

// A pose, or a point where the tool may be turned as it likes.
static bool read_target(CagCall *call, int argument, CagTransform *out, bool *point) {
  CagVec3 p;
  *point = call->values[argument].type == CAG_LIST;
  if (!*point) return cag_arg_pose(call, argument, out);
  if (!cag_arg_vec(call, argument, &p, NULL)) return false;
  *out = cag_translate(p);
  return true;
}

static bool read_branch(CagCall *call, int argument, const CagRecord *config, const char *name,
                        int *out) {
  CagValue v = cag_record_get(config, name);
  *out = 0;
  if (v.type == CAG_UNSET || v.type == CAG_NONE) return true;
  if (v.type != CAG_NUMBER || (v.as.number != 1 && v.as.number != -1))
    return cag_fail_call(call, argument, CAG_ERR_value, "expects 1 or -1 as `%s` of `%s`", name,
                         cag_parameter_name(call, argument));
  *out = v.as.number > 0 ? 1 : -1;
  return true;
}

static bool read_config(CagCall *call, int argument, CagRobotGoal *goal) {
  CagRecord *config = NULL;
  if (!cag_given(call, argument)) return true;
  return cag_arg_record(call, argument, &config) &&
         read_branch(call, argument, config, "shoulder", &goal->shoulder) &&
         read_branch(call, argument, config, "elbow", &goal->elbow) &&
         read_branch(call, argument, config, "wrist", &goal->wrist);
}

// robot, T, near, config, tolerance
bool cag_robots_ik(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  CagTransform target;
  CagRobotGoal goal = {0};
  CagRobotFound found;
  double near[CAG_ROBOT_JOINTS_MAX], q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_robot(call, 0, &r) || !read_target(call, 1, &target, &goal.position_only) ||
      !cag_arg_joints_or_home(call, 2, r, false, near) || !read_config(call, 3, &goal) ||
      (cag_given(call, 4) && !cag_arg_positive(call, 4, &goal.tolerance)))
    return false;
  goal.near = near;
  if (!cag_geometry_ok(call, cag_robot_solve(r, &target, &goal, q, &found, call->err)))
    return false;
  *result = cag_joints_value(call->vm, r, q);
  return true;
}

// robot, T, tolerance
bool cag_robots_reachable(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  CagTransform target;
  CagRobotGoal goal = {0};
  CagRobotFound found;
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_robot(call, 0, &r) || !read_target(call, 1, &target, &goal.position_only) ||
      (cag_given(call, 2) && !cag_arg_positive(call, 2, &goal.tolerance)))
    return false;
  *result = cag_bool(cag_robot_solve(r, &target, &goal, q, &found, call->err) == CAG_OK);
  return true;
}

// robot, T, near: what comes closest
bool cag_robots_closest_pose(CagCall *call, CagValue *result) {
  static const char *const names[] = {"q", "pose", "distance", "angle"};
  CagRobot *r = NULL;
  CagTransform target, pose;
  CagRobotGoal goal = {0};
  CagRobotFound found;
  double near[CAG_ROBOT_JOINTS_MAX], q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_robot(call, 0, &r) || !read_target(call, 1, &target, &goal.position_only) ||
      !cag_arg_joints_or_home(call, 2, r, false, near))
    return false;
  goal.near = near;
  if (cag_robot_solve(r, &target, &goal, q, &found, call->err) &&
      call->err->id != CAG_ERR_unreachable)
    return cag_fail_geometry(call, call->err);
  cag_robot_forward(r, q, &pose);
  CagValue values[] = {cag_joints_value(call->vm, r, q), cag_transform_value(call->vm, &pose),
                       cag_number(found.position),
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
  return cag_hold(call, cag_malloc((n * r->joint_count + 1) * sizeof(double)));
}

// robot, from, to, n
bool cag_robots_joint_path(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  double from[CAG_ROBOT_JOINTS_MAX], to[CAG_ROBOT_JOINTS_MAX];
  long n;
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_joints(call, 1, r, true, from) ||
      !cag_arg_joints(call, 2, r, true, to) || !cag_arg_integer(call, 3, 2, POSES_MAX, &n))
    return false;
  size_t joints = r->joint_count;
  double *q = take_places(call, r, (size_t)n);
  for (size_t k = 0; k < (size_t)n; k++)
    for (size_t i = 0; i < joints; i++) {
      double t = (double)k / (double)(n - 1);
      q[k * joints + i] = (1 - t) * from[i] + t * to[i];
    }
  return give_places(call, r, q, (size_t)n, result);
}

static bool going(void *vm) { return cag_keep_going(vm); }

// robot, from, to, n, near, cross
bool cag_robots_line_path(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  CagTransform from, to;
  double near[CAG_ROBOT_JOINTS_MAX];
  long n;
  bool point = false;
  CagRobotWay way = {.near = near, .going = going, .data = call->vm};
  if (!cag_arg_robot(call, 0, &r) || !read_target(call, 1, &from, &way.position_only) ||
      !read_target(call, 2, &to, &point))
    return false;
  if (point != way.position_only)
    return cag_fail_type(
        call, 2, way.position_only ? "a point, as the start is" : "a pose, as the start is");
  if (!cag_arg_integer(call, 3, 2, POSES_MAX, &n) ||
      !cag_arg_joints_or_home(call, 4, r, false, near) ||
      !cag_arg_bool_or(call, 5, false, &way.cross))
    return false;
  double *q = take_places(call, r, (size_t)n);
  CagStatus status = cag_robot_line_path(r, &from, &to, (size_t)n, &way, q, call->err);
  return cag_geometry_ok(call, status) && give_places(call, r, q, (size_t)n, result);
}

// Poses, or points where the tool may be turned as it likes; *out is held.
static bool read_poses(CagCall *call, int argument, CagTransform **out, size_t *n, bool *points) {
  CagList *list = NULL;
  if (!cag_arg_list(call, argument, &list)) return false;
  *n = list->length;
  *points = list->dim == 3;
  *out = cag_hold(call, cag_malloc((*n + 1) * sizeof **out));
  for (size_t i = 0; i < *n; i++) {
    CagValue v = cag_list_get(call->vm, list, i);
    const double *x = *points ? list->as.numbers + 3 * i : NULL;
    bool finite = *points && isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]);
    if (finite) (*out)[i] = cag_translate(cag_vec3(x[0], x[1], x[2]));
    else if (v.type != CAG_TRANSFORM)
      return cag_fail_element(call, argument, i, v, "poses, or points of space,");
    else if (!cag_pose_of_value(call, argument, v, &(*out)[i])) return false;
  }
  return true;
}

// robot, poses, near, jumps
bool cag_robots_follow(CagCall *call, CagValue *result) {
  CagRobot *r = NULL;
  CagTransform *poses = NULL;
  double near[CAG_ROBOT_JOINTS_MAX];
  size_t n = 0;
  CagRobotWay way = {.near = near, .going = going, .data = call->vm};
  if (!cag_arg_robot(call, 0, &r) || !cag_arg_joints_or_home(call, 2, r, false, near) ||
      !cag_arg_bool_or(call, 3, false, &way.jumps) ||
      !read_poses(call, 1, &poses, &n, &way.position_only))
    return false;
  double *q = take_places(call, r, n);
  return cag_geometry_ok(call, cag_robot_follow(r, poses, n, &way, q, call->err)) &&
         give_places(call, r, q, n, result);
}
