// Questions to robots: where their frames are, how they move, what their motors do.

#include <stdlib.h>
#include <string.h>

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
  if (cag_given(call, argument) && call->values[argument].type != CAG_NONE)
    return cag_arg_joints(call, argument, r, limits, q);
  cag_robot_home(r, q);
  return true;
}

bool cag_pose_of_value(CagCall *call, int argument, CagValue v, CagTransform *out) {
  CagError err;
  *out = CAG_AS_TRANSFORM(v)->t;
  return cag_geometry_ok(call, cag_robot_pose_check(out, cag_parameter_name(call, argument), &err),
                         &err);
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
  if (!cag_given(call, argument) || call->values[argument].type == CAG_NONE) return true;
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
  CagTransform *frames = malloc((r->link_count + 1) * sizeof *frames);
  if (!frames)
    return cag_fail_call(call, -1, CAG_ERR_limit_memory, "needs more memory than there is");
  cag_robot_frames(r, q, frames);
  CagBuilder *list = cag_builder_new(call->vm);
  bool ok = true;
  for (size_t i = 0; ok && i <= r->link_count; i++)
    ok = cag_builder_add(call->vm, list, cag_transform_value(call->vm, &frames[i]));
  free(frames);
  if (ok) *result = cag_builder_finish(call->vm, list);
  return ok;
}
