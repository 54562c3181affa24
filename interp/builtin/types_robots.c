// The types link and robot.

#include <math.h>
#include <string.h>

#include "interp/builtin/robots.h"
#include "interp/builtin/types.h"

// --- Members ---

static CagValue range_of_link(CagVm *vm, const CagRobotLink *l) {
  return cag_domain_value(vm, l->kind == CAG_JOINT_REVOLUTE, l->low, l->high);
}

static CagValue limits_of(CagVm *vm, const CagRobot *r) {
  CagValue ranges[CAG_ROBOT_JOINTS_MAX];
  for (size_t i = 0; i < r->joint_count; i++)
    ranges[i] = range_of_link(vm, &r->links[r->joint_link[i]]);
  return cag_list_values(vm, ranges, r->joint_count);
}

static bool robot_member(CagVm *vm, CagValue value, const char *name, CagValue *out) {
  const CagRobotValue *v = CAG_AS_ROBOT(value);
  const CagRobot *r = v->robot;
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!strcmp(name, "joints")) *out = cag_number((double)r->joint_count);
  else if (!strcmp(name, "limits")) *out = limits_of(vm, r);
  else if (!strcmp(name, "name")) *out = cag_object(CAG_TEXT, v->name);
  else if (!strcmp(name, "links")) *out = cag_object(CAG_LIST, v->links);
  else if (!strcmp(name, "base")) *out = cag_transform_value(vm, &r->base);
  else if (!strcmp(name, "tool")) *out = cag_transform_value(vm, &r->tool);
  else if (!strcmp(name, "convention"))
    *out = cag_text_c(vm, r->convention == CAG_ROBOT_MODIFIED ? "mdh" : "dh");
  else if (!strcmp(name, "home")) {
    cag_robot_home(r, q);
    *out = cag_joints_value(vm, r, q);
  } else return false;
  return true;
}

static CagValue rate_value(double x, bool angle) {
  return x == 0 ? cag_none() : cag_parameter_value(angle, x);
}

static bool link_member(CagVm *vm, CagValue value, const char *name, CagValue *out) {
  const CagLinkValue *v = CAG_AS_LINK(value);
  const CagRobotLink *l = &v->link;
  bool turns = l->kind == CAG_JOINT_REVOLUTE, moves = l->kind != CAG_JOINT_FIXED;
  if (!strcmp(name, "kind")) *out = cag_text_c(vm, cag_joint_kinds[l->kind]);
  else if (!strcmp(name, "shape")) *out = v->shape;
  else if (!strcmp(name, "transform"))
    *out = moves ? cag_none() : cag_transform_value(vm, &l->fixed);
  else if (!strcmp(name, "theta")) *out = cag_angle(cag_degrees_shown(l->theta));
  else if (!strcmp(name, "d")) *out = cag_number(l->d);
  else if (!strcmp(name, "a")) *out = cag_number(l->a);
  else if (!strcmp(name, "alpha")) *out = cag_angle(cag_degrees_shown(l->alpha));
  else if (!strcmp(name, "lead")) *out = cag_number(l->screw * 2 * M_PI);
  else if (!strcmp(name, "limits")) *out = moves ? range_of_link(vm, l) : cag_none();
  else if (!strcmp(name, "home")) *out = moves ? cag_parameter_value(turns, l->home) : cag_none();
  else if (!strcmp(name, "speed")) *out = rate_value(l->speed, turns);
  else if (!strcmp(name, "effort")) *out = rate_value(l->effort, false);
  else return false;
  return true;
}

static const char *robot_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm, (void)v;
  static const char *const names[] = {"joints", "limits", "home",       "name", "links",
                                      "base",   "tool",   "convention", NULL};
  return cag_name_at(names, i);
}

static const char *link_member_name(CagVm *vm, CagValue v, size_t i) {
  (void)vm, (void)v;
  static const char *const names[] = {"kind",   "shape", "transform", "theta", "d",
                                      "a",      "alpha", "limits",    "home",  "speed",
                                      "effort", "lead",  NULL};
  return cag_name_at(names, i);
}

// --- Printed form ---

static void add_measure(CagString *s, const char *name, double x, const char *unit) {
  if (x == 0) return;
  cag_string_printf(s, ", %s ", name);
  cag_print_number(s, x);
  cag_string_printf(s, "%s", unit);
}

static void print_link(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagRobotLink *l = &CAG_AS_LINK(v)->link;
  cag_string_printf(s, "%s link", cag_joint_kinds[l->kind]);
  if (l->kind == CAG_JOINT_FIXED) return;
  const bool turns = l->kind == CAG_JOINT_REVOLUTE;
  const char *unit = turns ? "deg" : "";
  add_measure(s, turns ? "offset" : "theta", cag_degrees_shown(l->theta), "deg");
  add_measure(s, turns ? "d" : "offset", l->d, "");
  add_measure(s, "a", l->a, "");
  add_measure(s, "alpha", cag_degrees_shown(l->alpha), "deg");
  cag_string_printf(s, ", limits ");
  cag_print_number(s, turns ? cag_degrees_shown(l->low) : l->low);
  cag_string_printf(s, "%s..", unit);
  cag_print_number(s, turns ? cag_degrees_shown(l->high) : l->high);
  cag_string_printf(s, "%s", unit);
}

static void print_robot(CagVm *vm, CagString *s, CagValue v) {
  (void)vm;
  const CagRobotValue *robot = CAG_AS_ROBOT(v);
  cag_string_printf(s, "robot");
  if (robot->name->length) cag_string_printf(s, " %s", robot->name->bytes);
  size_t n = robot->robot->joint_count;
  cag_string_printf(s, ", %zu joint%s (", n, n == 1 ? "" : "s");
  for (size_t i = 0; i < n; i++)
    cag_string_add(
        s, robot->robot->links[robot->robot->joint_link[i]].kind == CAG_JOINT_REVOLUTE ? "R" : "P",
        1);
  cag_string_printf(s, ")");
}

// --- The types ---

static void scan_link(CagHeap *h, CagObject *o) { cag_mark_value(h, ((CagLinkValue *)o)->shape); }

static void scan_robot(CagHeap *h, CagObject *o) {
  const CagRobotValue *v = (CagRobotValue *)o;
  cag_mark_object(h, &v->name->head);
  cag_mark_object(h, &v->links->head);
}

static void destroy_robot(CagObject *o) { cag_robot_release(((CagRobotValue *)o)->robot); }

const CagValueType cag_type_link = {
    .print = print_link, .scan = scan_link, .member = link_member, .member_name = link_member_name};
const CagValueType cag_type_robot = {.print = print_robot,
                                     .scan = scan_robot,
                                     .destroy = destroy_robot,
                                     .member = robot_member,
                                     .member_name = robot_member_name};
