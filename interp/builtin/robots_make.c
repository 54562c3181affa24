// Links and robots made, their members, and their printed form.

#include <string.h>

#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// --- Links ---

// An optional speed or effort.
static bool check_rate(CagCall *call, int argument, double rate) {
  return !cag_given(call, argument) || rate > 0 ||
         cag_fail_value(call, argument, "a value greater than 0");
}

// Takes limits as a range of the joint's unit, and the home: where none is given 0 or the limit
// next to it. They are the parameters 4 and 5.
static bool set_limits(CagCall *call, CagRobotLink *l, CagRangeEnds limits, double home) {
  const bool turns = l->kind == CAG_JOINT_REVOLUTE;
  const double unit = turns ? CAG_RADIANS_PER_DEGREE : 1;
  if (limits.angle != turns && isfinite(limits.start) && isfinite(limits.end))
    return cag_fail_type(call, 4, turns ? "a range of angles" : "a range of numbers");
  l->low = limits.start * unit;
  l->high = limits.end * unit;
  if (cag_given(call, 5)) l->home = home;
  else l->home = turns ? fmin(fmax(0, l->low), l->high) : l->low;
  return true;
}

// Checks a finished link; its shape, shapes or lists of them, is the parameter `shape`.
static bool give_link(CagCall *call, const CagRobotLink *l, int shape, CagValue *result) {
  const CagValue drawn = cag_given(call, shape) ? call->values[shape] : cag_none();
  if (drawn.type != CAG_NONE && !cag_shapes_collect(call, drawn, cag_builder_new(call->vm)))
    return false;
  if (!cag_geometry_ok(call, cag_robot_link_check(l, call->err))) return false;
  *result = cag_link_value(call->vm, l, drawn);
  return true;
}

bool cag_robots_revolute(CagCall *call, const struct cag_robots_revolute *a, CagValue *result) {
  CagRobotLink l = {.kind = CAG_JOINT_REVOLUTE,
                    .d = a->d,
                    .a = a->a,
                    .alpha = a->alpha,
                    .theta = a->offset,
                    .fixed = cag_transform_identity(),
                    .speed = a->speed,
                    .effort = a->effort,
                    .screw = a->lead / (2 * M_PI)};
  return check_rate(call, 7, a->speed) && check_rate(call, 8, a->effort) &&
         set_limits(call, &l, a->limits, a->home) && give_link(call, &l, 6, result);
}

bool cag_robots_prismatic(CagCall *call, const struct cag_robots_prismatic *a, CagValue *result) {
  CagRobotLink l = {.kind = CAG_JOINT_PRISMATIC,
                    .theta = a->theta,
                    .a = a->a,
                    .alpha = a->alpha,
                    .d = a->offset,
                    .fixed = cag_transform_identity(),
                    .speed = a->speed,
                    .effort = a->effort};
  if (!cag_given(call, 4))
    return cag_fail_call(call, -1, CAG_ERR_joint_limits,
                         "expects the travel of the joint as `limits`, such as limits: 0..300");
  return check_rate(call, 7, a->speed) && check_rate(call, 8, a->effort) &&
         set_limits(call, &l, a->limits, a->home) && give_link(call, &l, 6, result);
}

bool cag_robots_fixed_link(CagCall *call, const struct cag_robots_fixed_link *a, CagValue *result) {
  const CagRobotLink l = {.kind = CAG_JOINT_FIXED, .fixed = a->T};
  return give_link(call, &l, 1, result);
}

// --- Robots ---

// The links of a list as plain data, held.
static bool read_links(CagCall *call, const CagList *list, CagRobotLink **out) {
  *out = cag_hold_array(call, list->length, sizeof **out);
  for (size_t i = 0; i < list->length; i++) {
    CagValue v = cag_list_get(call->vm, list, i);
    if (v.type != CAG_LINK)
      return cag_fail_element(call, 0, i, v, "links (revolute, prismatic, fixed_link)");
    (*out)[i] = CAG_AS_LINK(v)->link;
  }
  return true;
}

// Flattens lists of links in the list, so that what stands for several rows may be one element.
static bool flatten_links(CagCall *call, CagValue v, CagBuilder *into, int depth) {
  if (v.type != CAG_LIST) return cag_builder_add(call->vm, into, v);
  if (!cag_may_nest(call, depth)) return false;
  const CagList *list = CAG_AS_LIST(v);
  for (size_t i = 0; i < list->length; i++)
    if (!flatten_links(call, cag_list_get(call->vm, list, i), into, depth + 1)) return false;
  return true;
}

// Degrees (or millimeters) that one unit of a joint's memory form is.
static double shown_unit(const CagRobotLink *links, size_t n, size_t joint) {
  for (size_t i = 0, k = 0; i < n; i++) {
    if (links[i].kind == CAG_JOINT_FIXED || k++ != joint) continue;
    return links[i].kind == CAG_JOINT_REVOLUTE ? 1 / CAG_RADIANS_PER_DEGREE : 1;
  }
  return 1;
}

static bool read_coupling_rows(CagCall *call, CagValue rows, size_t joints, double *matrix) {
  if (rows.type != CAG_LIST || CAG_AS_LIST(rows)->length != joints)
    return cag_fail_call(call, 5, CAG_ERR_joint_count,
                         "expects %zu rows of %zu numbers as the coupling, one for each joint",
                         joints, joints);
  for (size_t i = 0; i < joints; i++) {
    const double *x;
    size_t n;
    CagValue row = cag_list_get(call->vm, CAG_AS_LIST(rows), i);
    if (!cag_as_vector(row, &x, &n) || n != joints)
      return cag_fail_call(
          call, 5, CAG_ERR_joint_count,
          "expects %zu numbers in each row of the coupling; row [%zu] has another length", joints,
          i);
    memcpy(matrix + i * joints, x, joints * sizeof *x);
  }
  return true;
}

static bool read_coupling_offset(CagCall *call, CagValue list, size_t joints, double *offset) {
  if (list.type != CAG_LIST || CAG_AS_LIST(list)->length != joints)
    return cag_fail_call(call, 5, CAG_ERR_joint_count,
                         "expects %zu values as the coupling's offset", joints);
  for (size_t i = 0; i < joints; i++) {
    CagValue v = cag_list_get(call->vm, CAG_AS_LIST(list), i);
    if ((v.type != CAG_NUMBER && v.type != CAG_ANGLE) || !isfinite(v.as.number))
      return cag_fail_element(call, 5, i, v, "finite angles or numbers as offset");
    offset[i] = v.as.number;
  }
  return true;
}

// A matrix, or a record of `matrix` and `offset`; in degrees and millimeters as written. Sets the
// coupling of the robot, held.
static bool read_coupling(CagCall *call, CagValue v, CagRobotSpec *spec) {
  if (!cag_given(call, 5)) return true;
  CagValue rows = v, offset = cag_unset();
  if (v.type == CAG_RECORD) {
    rows = cag_record_get(CAG_AS_RECORD(v), "matrix");
    offset = cag_record_get(CAG_AS_RECORD(v), "offset");
  } else if (v.type != CAG_LIST) {
    return cag_fail_type(call, 5, "rows of numbers, or a record of matrix and offset");
  }
  size_t n = 0;
  for (size_t i = 0; i < spec->link_count; i++) n += spec->links[i].kind != CAG_JOINT_FIXED;
  double *matrix = cag_hold_array(call, n * n, sizeof *matrix);
  double *offsets = cag_hold_array(call, n, sizeof *offsets);
  if (!read_coupling_rows(call, rows, n, matrix) ||
      (offset.type != CAG_UNSET && !read_coupling_offset(call, offset, n, offsets)))
    return false;
  for (size_t i = 0; i < n; i++) {
    double unit = shown_unit(spec->links, spec->link_count, i);
    offsets[i] /= unit;
    for (size_t j = 0; j < n; j++)
      if (i != j) matrix[i * n + j] *= shown_unit(spec->links, spec->link_count, j) / unit;
  }
  spec->coupling = matrix;
  spec->coupling_offset = offsets;
  return true;
}

bool cag_robots_robot(CagCall *call, const struct cag_robots_robot *a, CagValue *result) {
  CagList *list;
  if (!cag_arg_list(call, 0, &list)) return false;
  CagBuilder *flat = cag_builder_new(call->vm);
  if (!flatten_links(call, cag_object(CAG_LIST, list), flat, 0)) return false;
  CagValue links = cag_builder_finish(call->vm, flat);
  CagRobotLink *plain;
  CagRobot *robot = NULL;
  if (!read_links(call, CAG_AS_LIST(links), &plain)) return false;
  CagRobotSpec spec = {.links = plain,
                       .link_count = CAG_AS_LIST(links)->length,
                       .convention = a->convention ? CAG_ROBOT_MODIFIED : CAG_ROBOT_CLASSIC,
                       .base = a->base,
                       .tool = a->tool};
  if (!read_coupling(call, a->coupling, &spec)) return false;
  CagText *name = CAG_AS_TEXT(cag_text_c(call->vm, a->name));
  if (!cag_geometry_ok(call, cag_robot_new(&spec, &robot, call->err))) return false;
  *result = cag_robot_value(call->vm, robot, name, links);
  return true;
}
