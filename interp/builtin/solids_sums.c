// Minkowski sums and offsets of solids and meshes.

#include "geom/solid/convolve.h"
#include "geom/solid/csg.h"
#include "interp/builtin/exacts_offset.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/shapes.h"
#include "interp/builtin/support.h"
#include "interp/builtin/targets.h"
#include "interp/vm/vm.h"

// A distance below the first part of the size is rounding; beyond the second multiple, the solid is.
#define NO_DISTANCE 1e-12
#define FAR 1e9
// Default tolerances: of the distance, and of the size of the solid.
#define PART_OF_DISTANCE 0.01
#define PART_OF_SIZE 1e-4

static void release_mesh(void *m) { cag_mesh_release(m); }

static bool check_body(CagCall *call, int argument) {
  const CagType type = call->values[argument].type;
  return type == CAG_SOLID || type == CAG_MESH || type == CAG_SURFACE ||
         cag_fail_type(call, argument, "a solid or a closed mesh");
}

static CagStatus diagonal_of(CagValue v, double *out, CagError *err) {
  const CagShape *shape = CAG_AS_SHAPE(v);
  CagBounds box;
  CagStatus status = CAG_OK;
  if (v.type == CAG_MESH) box = cag_mesh_bounds(shape->as.mesh);
  else if (v.type == CAG_SOLID) status = cag_solid_bounds(shape->as.solid, &box, err);
  else status = cag_surface_bounds(shape->as.surface, &box, err);
  if (!status) *out = cag_norm(cag_sub(box.max, box.min));
  return status;
}

static bool check_closed(CagCall *call, const CagMesh *m) {
  CagSolid *s;
  const CagStatus status = cag_solid_from_mesh(m, &s, call->err);
  if (!status) cag_solid_release(s);
  return cag_geometry_ok(call, status);
}

// The mesh of an argument, held by the call; *out is NULL if the body is empty.
static bool body_mesh(CagCall *call, int argument, double tolerance, CagMesh **out) {
  const CagValue v = call->values[argument];
  const double own = CAG_AS_SHAPE(v)->tolerance;
  CagMesh *m = NULL;
  const CagStatus status = cag_shape_mesh(call->vm, v, own > 0 ? own : tolerance, &m, call->err);
  *out = NULL;
  if (status && cag_is_empty_shape(call->err)) return true;
  if (!cag_geometry_ok(call, status)) return false;
  cag_hold_for(call, release_mesh, m);
  *out = m;
  return v.type == CAG_SOLID || check_closed(call, m);
}

// Takes ownership of the mesh.
static bool sum_result(CagCall *call, CagStatus status, CagMesh *m, CagValue *result) {
  CagSolid *s = NULL;
  if (!status) status = cag_solid_from_mesh(m, &s, call->err);
  cag_mesh_release(m);
  if (!cag_solid_result(call, status, &s, result)) return false;
  cag_shape_say_alike(*result, call->values[0]);
  return true;
}

static bool nothing_result(CagCall *call, CagValue *result) {
  CagSolid *s = NULL;
  const CagStatus status = cag_solid_empty(&s, call->err);
  return cag_solid_result(call, status, &s, result);
}

// Whether the argument is an empty shape, which has no bounds.
static bool size_of_body(CagCall *call, int argument, double *out, bool *empty) {
  const CagStatus status = diagonal_of(call->values[argument], out, call->err);
  *empty = status && cag_is_empty_shape(call->err);
  return *empty || cag_geometry_ok(call, status);
}

bool cag_solids_offset(CagCall *call, const struct cag_solids_offset *a, CagValue *result) {
  double size, tolerance = a->tolerance;
  bool empty;
  CagMesh *m, *moved = NULL;
  if (!check_body(call, 0) || !size_of_body(call, 0, &size, &empty)) return false;
  if (empty || a->d < -size) return nothing_result(call, result);
  if (a->d > FAR * size)
    return cag_fail_call(call, 1, CAG_ERR_too_far,
                         "expects a distance of at most 1e9 times the size of the solid");
  const double d = fabs(a->d) <= NO_DISTANCE * size ? 0 : a->d;
  bool done = false;
  if (d != 0 && !cag_given(call, 2) && !cag_exact_offset(call, 0, d, result, &done)) return false;
  if (done) return true;
  if (!cag_given(call, 2)) tolerance = fmax(PART_OF_DISTANCE * fabs(d), PART_OF_SIZE * size);
  if (!body_mesh(call, 0, tolerance, &m)) return false;
  if (!m) return nothing_result(call, result);
  const CagStatus status =
      cag_mesh_offset(m, d, tolerance, cag_vm_stop(call->vm), &moved, call->err);
  if (!sum_result(call, status, moved, result)) return false;
  if (call->vm->verbose)
    cag_vm_trace(call, cag_number(tolerance), "offset: tier C: mesh; tolerance");
  return true;
}

bool cag_solids_minkowski(CagCall *call, const struct cag_solids_minkowski *a, CagValue *result) {
  CagMesh *m[2], *sum = NULL;
  for (int i = 0; i < 2; i++) {
    double size;
    bool empty;
    if (!check_body(call, i) || !size_of_body(call, i, &size, &empty)) return false;
    if (empty) return nothing_result(call, result);
    const double tolerance = cag_given(call, 2) ? a->tolerance : 10 * PART_OF_SIZE * size;
    if (!body_mesh(call, i, tolerance, &m[i])) return false;
    if (!m[i]) return nothing_result(call, result);
  }
  // The convex one is the body that moves over the other one.
  bool convex = false;
  CagStatus status = cag_mesh_is_convex(m[1], &convex, call->err);
  if (!status && !convex) {
    CagMesh *first = m[0];
    m[0] = m[1];
    m[1] = first;
    status = cag_mesh_is_convex(m[1], &convex, call->err);
  }
  if (!status && !convex)
    return cag_fail_call(call, 1, CAG_ERR_not_convex,
                         "expects at least one convex body, found two that are not");
  if (!status) status = cag_mesh_minkowski(m[0], m[1], cag_vm_stop(call->vm), &sum, call->err);
  return sum_result(call, status, sum, result);
}
