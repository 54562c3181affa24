// All joint values for a pose, by closed form, and the branch that joint values belong to.

#include <string.h>

#include "geom/robot/inverse.h"
#include "interp/builtin/robots.h"
#include "interp/builtin/support.h"

// The branches that the arm has a choice of, as a record of 1 and -1.
static CagValue config_value(CagVm *vm, const CagConfiguration *c) {
  static const char *const all[] = {"shoulder", "elbow", "wrist"};
  const int signs[] = {c->shoulder, c->elbow, c->wrist};
  const char *names[3];
  CagValue values[3];
  size_t n = 0;
  for (size_t i = 0; i < 3; i++) {
    if (!signs[i]) continue;
    names[n] = all[i];
    values[n++] = cag_number(signs[i]);
  }
  return cag_record_new(vm, names, values, n);
}

// Numbers, from 1, of the joints whose bits are set.
static CagValue free_value(CagVm *vm, unsigned free) {
  double joints[CAG_INVERSE_JOINTS_MAX];
  size_t n = 0;
  for (size_t i = 0; i < CAG_INVERSE_JOINTS_MAX; i++)
    if (free & 1u << i) joints[n++] = (double)i + 1;
  return cag_vector(vm, joints, n);
}

static CagValue solution_value(CagVm *vm, const CagRobot *r, const CagInverseSolution *s) {
  static const char *const names[] = {"q", "config", "free"};
  const CagValue values[] = {cag_joints_value(vm, r, s->q), config_value(vm, &s->configuration),
                             free_value(vm, s->free)};
  return cag_record_new(vm, names, values, 3);
}

static bool fail_no_closed_form(CagCall *call, const CagRobot *r, bool point) {
  if (point && cag_robot_has_inverse(r))
    return cag_fail_call(call, 1, CAG_ERR_no_closed_form,
                         "expects a pose, since the arm reaches a point in infinitely many ways; "
                         "`ik` finds one of them");
  return cag_fail_call(
      call, 0, CAG_ERR_no_closed_form,
      "expects an arm whose inverse has a closed form; `ik` solves other arms numerically");
}

bool cag_inverse_ik_all(CagCall *call, const struct cag_inverse_ik_all *a, CagValue *result) {
  static const char *const names[] = {"status", "solutions", "free"};
  static const char *const statuses[] = {"ok", "unreachable", "infeasible-orientation", "singular"};
  CagTransform t;
  CagInverse all;
  double near[CAG_ROBOT_JOINTS_MAX];
  bool point;
  if (!cag_arg_target(call, 1, &t, &point) ||
      !cag_arg_joints_or_home(call, 2, a->robot, false, near))
    return false;
  if (point)
    cag_robot_inverse_point(a->robot, cag_vec3(t.m[0][3], t.m[1][3], t.m[2][3]), near, &all);
  else cag_robot_inverse(a->robot, &t, near, &all);
  if (all.status == CAG_INVERSE_NO_CLOSED_FORM) return fail_no_closed_form(call, a->robot, point);
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < all.count; i++)
    if (!cag_builder_add(call->vm, list, solution_value(call->vm, a->robot, &all.solutions[i])))
      return false;
  CagValue values[] = {cag_text_c(call->vm, statuses[all.status]),
                       cag_builder_finish(call->vm, list), free_value(call->vm, all.free)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

bool cag_inverse_configuration(CagCall *call, const struct cag_inverse_configuration *a,
                               CagValue *result) {
  CagConfiguration c;
  double q[CAG_ROBOT_JOINTS_MAX];
  if (!cag_arg_joints(call, 1, a->robot, false, q)) return false;
  if (!cag_robot_configuration(a->robot, q, &c)) return fail_no_closed_form(call, a->robot, false);
  *result = config_value(call->vm, &c);
  return true;
}
