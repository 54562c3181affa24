// Rays that are cast at shapes.

#include <math.h>

#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

static CagValue parameter_value(double x, bool is_angle) {
  if (isnan(x)) return cag_none();
  return is_angle ? cag_angle(x * (180 / M_PI)) : cag_number(x);
}

static CagValue hit_record(CagVm *vm, const CagTarget *t, const CagRay *ray,
                           const CagTargetHit *hit) {
  static const char *const names[] = {"distance", "point", "normal", "u", "v", "part", "material"};
  const CagValue values[] = {cag_number(hit->at.t),
                             cag_point(vm, cag_ray_point(ray, hit->at.t), 3),
                             cag_point(vm, hit->at.normal, 3),
                             parameter_value(hit->at.u, hit->at.angular[0]),
                             parameter_value(hit->at.v, hit->at.angular[1]),
                             cag_target_name(t, hit->part),
                             cag_target_material(vm, t, hit)};
  return cag_record_new(vm, names, values, sizeof values / sizeof *values);
}

static bool first_hit(CagCall *call, const CagTarget *t, const CagRay *ray, CagTargetHit *hit,
                      bool *met) {
  CagCrossings work = {0};
  const CagStatus status = cag_target_first(t, ray, &work, hit, met, call->err);
  cag_crossings_free(&work);
  return cag_geometry_ok(call, status);
}

bool cag_rays_cast(CagCall *call, const struct cag_rays_cast *a, CagValue *result) {
  const CagTarget *t;
  CagTargetHit hit;
  bool met;
  if (!cag_arg_ray_target(call, 0, &t)) return false;
  const CagRay ray = {a->P.at, cag_unit(a->V.at), cag_target_skipped(t, a->P.at), a->max};
  if (!first_hit(call, t, &ray, &hit, &met)) return false;
  *result = met ? hit_record(call->vm, t, &ray, &hit) : cag_none();
  return true;
}

bool cag_rays_visible(CagCall *call, const struct cag_rays_visible *a, CagValue *result) {
  const CagTarget *t;
  CagCrossings work = {0};
  bool sees;
  if (!cag_arg_ray_target(call, 0, &t)) return false;
  const CagStatus status = cag_target_sees(t, a->P.at, a->Q.at, &work, &sees, call->err);
  cag_crossings_free(&work);
  *result = cag_bool(sees);
  return cag_geometry_ok(call, status);
}
