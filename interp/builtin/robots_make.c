// Links and robots made, their members, and their printed form.

#include <string.h>

#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// --- Links ---

// The shape of a link: shapes, or lists of them.
static bool read_shape(CagCall *call, int argument, CagValue *out) {
  *out = cag_none();
  if (!cag_given(call, argument)) return true;
  CagBuilder *builder = cag_builder_new(call->vm);
  if (!cag_shapes_collect(call, call->values[argument], builder)) return false;
  *out = call->values[argument];
  return true;
}

// An optional number or angle greater than 0.
static bool read_rate(CagCall *call, int argument, bool angle, double *out) {
  *out = 0;
  if (!cag_given(call, argument)) return true;
  if (!(angle ? cag_arg_angle(call, argument, out) : cag_arg_finite(call, argument, out)))
    return false;
  return *out > 0 || cag_fail_value(call, argument, "a value greater than 0");
}

// Reads limits as a range of the joint's unit.
static bool read_limits(CagCall *call, int argument, CagRobotLink *l) {
  bool turns = l->kind == CAG_JOINT_REVOLUTE, angle;
  if (!cag_given(call, argument)) return true;
  if (!cag_arg_interval(call, argument, &l->low, &l->high, &angle)) return false;
  if (angle != turns && isfinite(l->low) && isfinite(l->high))
    return cag_fail_type(call, argument, turns ? "a range of angles" : "a range of numbers");
  if (turns) {
    l->low *= CAG_RADIANS_PER_DEGREE;
    l->high *= CAG_RADIANS_PER_DEGREE;
  }
  return true;
}

// Checks a finished link; its home is 0, or the limit next to it, where none was given.
static bool give_link(CagCall *call, CagRobotLink *l, int home, int shape, CagValue *result) {
  CagValue drawn;
  bool turns = l->kind == CAG_JOINT_REVOLUTE;
  if (!read_shape(call, shape, &drawn)) return false;
  if (home >= 0 && cag_given(call, home)) {
    if (!(turns ? cag_arg_angle(call, home, &l->home) : cag_arg_finite(call, home, &l->home)))
      return false;
  } else if (home >= 0) {
    l->home = turns ? fmin(fmax(0, l->low), l->high) : l->low;
  }
  if (!cag_geometry_ok(call, cag_robot_link_check(l, call->err))) return false;
  *result = cag_link_value(call->vm, l, drawn);
  return true;
}

static bool finite_or_zero(CagCall *call, int argument, double *out) {
  *out = 0;
  return !cag_given(call, argument) || cag_arg_finite(call, argument, out);
}

// d, a, alpha, offset, limits, home, shape, speed, effort, lead
bool cag_robots_revolute(CagCall *call, CagValue *result) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_REVOLUTE);
  double lead;
  if (!finite_or_zero(call, 0, &l.d) || !finite_or_zero(call, 1, &l.a) ||
      !cag_arg_angle_or(call, 2, 0, &l.alpha) || !cag_arg_angle_or(call, 3, 0, &l.theta) ||
      !read_limits(call, 4, &l) || !read_rate(call, 7, true, &l.speed) ||
      !read_rate(call, 8, false, &l.effort) || !finite_or_zero(call, 9, &lead))
    return false;
  l.screw = lead / (2 * M_PI);
  return give_link(call, &l, 5, 6, result);
}

// theta, a, alpha, offset, limits, home, shape, speed, effort
bool cag_robots_prismatic(CagCall *call, CagValue *result) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_PRISMATIC);
  if (!cag_given(call, 4))
    return cag_fail_call(call, -1, CAG_ERR_joint_limits,
                         "expects the travel of the joint as `limits`, such as limits: 0..300");
  if (!cag_arg_angle_or(call, 0, 0, &l.theta) || !finite_or_zero(call, 1, &l.a) ||
      !cag_arg_angle_or(call, 2, 0, &l.alpha) || !finite_or_zero(call, 3, &l.d) ||
      !read_limits(call, 4, &l) || !read_rate(call, 7, false, &l.speed) ||
      !read_rate(call, 8, false, &l.effort))
    return false;
  return give_link(call, &l, 5, 6, result);
}

bool cag_robots_fixed_link(CagCall *call, CagValue *result) {
  CagRobotLink l = cag_robot_link(CAG_JOINT_FIXED);
  if (!cag_arg_transform(call, 0, &l.fixed)) return false;
  return give_link(call, &l, -1, 1, result);
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

typedef struct Coupling {
  double *matrix, *offset; // held
} Coupling;

static bool read_coupling_rows(CagCall *call, int argument, CagValue rows, size_t joints,
                               double *matrix) {
  if (rows.type != CAG_LIST || CAG_AS_LIST(rows)->length != joints)
    return cag_fail_call(call, argument, CAG_ERR_joint_count,
                         "expects %zu rows of %zu numbers as the coupling, one for each joint",
                         joints, joints);
  for (size_t i = 0; i < joints; i++) {
    const double *x;
    size_t n;
    CagValue row = cag_list_get(call->vm, CAG_AS_LIST(rows), i);
    if (!cag_as_vector(row, &x, &n) || n != joints)
      return cag_fail_call(call, argument, CAG_ERR_joint_count,
                           "expects %zu numbers in each row of the coupling; row [%zu] differs",
                           joints, i);
    memcpy(matrix + i * joints, x, joints * sizeof *x);
  }
  return true;
}

static bool read_coupling_offset(CagCall *call, int argument, CagValue list, size_t joints,
                                 double *offset) {
  if (list.type != CAG_LIST || CAG_AS_LIST(list)->length != joints)
    return cag_fail_call(call, argument, CAG_ERR_joint_count,
                         "expects %zu values as the coupling's offset", joints);
  for (size_t i = 0; i < joints; i++) {
    CagValue v = cag_list_get(call->vm, CAG_AS_LIST(list), i);
    if ((v.type != CAG_NUMBER && v.type != CAG_ANGLE) || !isfinite(v.as.number))
      return cag_fail_element(call, argument, i, v, "finite angles or numbers as offset");
    offset[i] = v.as.number;
  }
  return true;
}

// A matrix, or a record of `matrix` and `offset`; in degrees and millimeters as written.
static bool read_coupling(CagCall *call, int argument, const CagRobotLink *links, size_t count,
                          Coupling *out) {
  *out = (Coupling){0};
  if (!cag_given(call, argument)) return true;
  CagValue v = call->values[argument], rows = v, offset = cag_unset();
  if (v.type == CAG_RECORD) {
    rows = cag_record_get(CAG_AS_RECORD(v), "matrix");
    offset = cag_record_get(CAG_AS_RECORD(v), "offset");
  } else if (v.type != CAG_LIST) {
    return cag_fail_type(call, argument, "rows of numbers, or a record of matrix and offset");
  }
  size_t n = 0;
  for (size_t i = 0; i < count; i++) n += links[i].kind != CAG_JOINT_FIXED;
  *out = (Coupling){cag_hold_array(call, n * n, sizeof(double)),
                    cag_hold_array(call, n, sizeof(double))};
  if (!read_coupling_rows(call, argument, rows, n, out->matrix) ||
      (offset.type != CAG_UNSET && !read_coupling_offset(call, argument, offset, n, out->offset)))
    return false;
  for (size_t i = 0; i < n; i++) {
    double unit = shown_unit(links, count, i);
    out->offset[i] /= unit;
    for (size_t j = 0; j < n; j++)
      if (i != j) out->matrix[i * n + j] *= shown_unit(links, count, j) / unit;
  }
  return true;
}

static bool transform_or_identity(CagCall *call, int argument, CagTransform *out) {
  *out = cag_transform_identity();
  return !cag_given(call, argument) || cag_arg_transform(call, argument, out);
}

// links, name, convention, base, tool, coupling
bool cag_robots_robot(CagCall *call, CagValue *result) {
  static const char *const conventions[] = {"dh", "mdh", NULL};
  CagRobotSpec spec = {0};
  CagList *list;
  const char *name = "";
  int convention;
  if (!cag_arg_list(call, 0, &list)) return false;
  CagBuilder *flat = cag_builder_new(call->vm);
  if (!flatten_links(call, cag_object(CAG_LIST, list), flat, 0)) return false;
  CagValue links = cag_builder_finish(call->vm, flat);
  if ((cag_given(call, 1) && !cag_arg_text(call, 1, &name)) ||
      !cag_arg_choice(call, 2, conventions, &convention) ||
      !transform_or_identity(call, 3, &spec.base) || !transform_or_identity(call, 4, &spec.tool))
    return false;
  CagRobotLink *plain = NULL;
  Coupling coupling = {0};
  CagRobot *robot = NULL;
  spec.link_count = CAG_AS_LIST(links)->length;
  if (!read_links(call, CAG_AS_LIST(links), &plain) ||
      !read_coupling(call, 5, plain, spec.link_count, &coupling))
    return false;
  spec.links = plain;
  spec.convention = convention ? CAG_ROBOT_MODIFIED : CAG_ROBOT_CLASSIC;
  spec.coupling = coupling.matrix;
  spec.coupling_offset = coupling.offset;
  CagText *text = CAG_AS_TEXT(cag_text_c(call->vm, name));
  if (!cag_geometry_ok(call, cag_robot_new(&spec, &robot, call->err))) return false;
  *result = cag_robot_value(call->vm, robot, text, links);
  return true;
}
