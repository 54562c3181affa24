// Solids with exact boundaries.

#include "interp/builtin/exacts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/recognized.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// The tolerance for surfaces without an exact form, as a fraction of the size.
#define APPROXIMATE 1e-5
// The default tolerance of meshes in place of exact results, likewise, and that of the mesh before.
#define MESHED 3e-4
#define FINER 0.5

static CagKernel *find_kernel(CagCall *call) {
  const CagVm *vm = call->vm;
  return vm->find_kernel ? vm->find_kernel(vm->find_kernel_context) : NULL;
}

CagKernel *cag_exacts_kernel(CagCall *call) {
  CagKernel *k = find_kernel(call);
  if (k) return k;
  (void)cag_geometry_ok(call, cag_fail_memory(call->err));
  return NULL;
}

CagStatus cag_exacts_checked(CagBoundaries *parts, CagSolid **out, CagError *err) {
  CagSolid *s = NULL;
  CagStatus status = cag_solid_exact(parts->items, parts->count, &s, err);
  cag_boundaries_free(parts);
  if (!status) status = cag_solid_exact_check(s, err);
  if (status) cag_solid_release(s);
  else *out = s;
  return status;
}

// Forms of round operands with other seams are tried if the boundary cannot be used.
static CagStatus compute(CagKernel *k, const CagSolid *s, CagSolid **out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_reach(s, &box, err);
  const double size = status ? 0 : cag_norm(cag_sub(box.max, box.min));
  const double tolerance = size > 0 && isfinite(size) ? APPROXIMATE * size : 0;
  for (int turn = 0; !status && turn < CAG_TURNS; turn++) {
    CagBoundaries parts;
    bool approximate;
    status = cag_kernel_boundary(k, s, tolerance, turn, &parts, &approximate, err);
    if (!status) status = cag_exacts_checked(&parts, out, err);
    if (!status) return CAG_OK;
    if (err->id == CAG_ERR_no_boundary && turn + 1 < CAG_TURNS) status = CAG_OK;
  }
  return status;
}

CagStatus cag_exacts_tolerance(CagCall *call, const CagSolid *s, double *out, CagError *err) {
  CagBounds box;
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  const double own = call->vm->tolerance;
  *out = own > 0 ? own : MESHED * cag_norm(cag_sub(box.max, box.min));
  return CAG_OK;
}

CagStatus cag_exacts_meshed(CagCall *call, const CagSolid *s, const CagSolid **out, CagError *err) {
  CagSolid *found = NULL;
  double tolerance;
  CagStatus status = cag_exacts_tolerance(call, s, &tolerance, err);
  if (!status) status = cag_solid_recognized(s, FINER * tolerance, &found, err);
  if (status) return status;
  cag_hold_solid(call, found);
  *out = found;
  return CAG_OK;
}

bool cag_exacts_changed(CagCall *call, CagStatus status, CagSolid **made, CagValue *result) {
  if (!cag_solid_result(call, status, made, result)) return false;
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}

// The kernel's error stays if there is no boundary of the mesh either.
CagStatus cag_exacts_of_solid(CagCall *call, const CagSolid *s, bool meshed, const CagSolid **out) {
  CagSolid *exact = NULL;
  double scale;
  *out = s;
  if (s->kind == CAG_SOLID_EXACT && cag_transform_is_similarity(&s->placement, &scale))
    return CAG_OK;
  CagKernel *k = find_kernel(call);
  const CagStatus status = k ? compute(k, s, &exact, call->err) : cag_fail_memory(call->err);
  if (!status) {
    cag_hold_solid(call, exact);
    *out = exact;
  }
  if (!status || cag_is_final(status) || !meshed) return status;
  CagError err;
  const CagStatus other = cag_exacts_meshed(call, s, out, &err);
  if (cag_is_final(other)) *call->err = err;
  return !other || cag_is_final(other) ? other : status;
}

bool cag_exacts_of(CagCall *call, int argument, const CagSolid **out) {
  const CagSolid *s = CAG_AS_SHAPE(call->values[argument])->as.solid;
  return cag_geometry_ok(call, cag_exacts_of_solid(call, s, false, out));
}

bool cag_exacts_or_meshed(CagCall *call, int argument, const CagSolid **out) {
  const CagSolid *s = CAG_AS_SHAPE(call->values[argument])->as.solid;
  return cag_geometry_ok(call, cag_exacts_of_solid(call, s, true, out));
}

bool cag_exacts_result(CagCall *call, CagBoundaries *parts, int argument, CagValue *result) {
  CagSolid *s = NULL;
  const CagStatus status = cag_exacts_checked(parts, &s, call->err);
  if (!cag_solid_result(call, status, &s, result)) return false;
  cag_shape_say_alike(*result, call->values[argument]);
  return true;
}

// "fillet: tier B: kernel; edges: 3"
static void trace(CagCall *call, const char *tier, const char *what, CagValue value) {
  char label[128];
  const char *signature = call->builtin->signature;
  snprintf(label, sizeof label, "%.*s: %s; %s", (int)strcspn(signature, "("), signature, tier,
           what);
  cag_vm_trace(call, value, label);
}

void cag_exacts_say_tier(CagCall *call, const char *tier, const char *what, size_t count) {
  if (call->vm->verbose) trace(call, tier, what, cag_number((double)count));
}

void cag_exacts_say_refused(CagCall *call, const char *tier, const CagError *why) {
  if (call->vm->verbose) trace(call, tier, "failed", cag_text_c(call->vm, why->message));
}

bool cag_exacts_exact(CagCall *call, const struct cag_exacts_exact *a, CagValue *result) {
  const CagSolid *s;
  (void)a;
  if (!cag_exacts_of(call, 0, &s)) return false;
  CagSolid *kept = cag_solid_retain(s);
  if (!cag_solid_result(call, CAG_OK, &kept, result)) return false;
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}
