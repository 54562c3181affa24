// Shells, drafts, splits, and imprints.

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/hollow.h"
#include "geom/solid/incline.h"
#include "interp/builtin/exacts_parts.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// The tolerance for curves and surfaces without an exact form, as a fraction of the size.
#define APPROXIMATE 1e-5

// Adds what the kernel answered for a part.
static bool add_made(CagExactParts *p, CagStatus status, CagBoundaries *made) {
  return cag_geometry_ok(p->call, status) && cag_exact_parts_add(p, made);
}

// --- Meshes where the kernel fails (tier C) ---

// Walls that are meshes are within this fraction of their thickness, at most.
#define WALL 0.1

static void say_meshed(CagCall *call, const char *how, double tolerance, const char *what,
                       size_t count) {
  char said[96];
  snprintf(said, sizeof said, "tier C: %s, within %.3g mm", how, tolerance);
  cag_exacts_say_tier(call, said, what, count);
}

// The status after the mesh was tried: that of the kernel, with its error, unless the mesh was made,
// or the run ends.
static CagStatus instead(CagCall *call, CagStatus kernel, CagStatus meshed, const CagError *err) {
  if (cag_is_final(meshed)) *call->err = *err;
  return !meshed || cag_is_final(meshed) ? meshed : kernel;
}

// The result of a solid whose boundary is recognized in its mesh. `kernel` tells why the kernel did
// not compute it. If the mesh fails as well, and the kernel is missing, the error names its package.
static bool meshed_result(CagCall *call, const CagError *kernel, CagStatus status, CagSolid **made,
                          CagValue *result) {
  if (status && !cag_is_final(status) && kernel->id == CAG_ERR_kernel_missing)
    return cag_fail_geometry(call, kernel);
  return cag_exacts_changed(call, status, made, result);
}

// The chosen faces, held by the call.
static const CagSolidFace *chosen_faces(CagCall *call, const CagChosen *chosen, size_t n) {
  CagSolidFace *faces = cag_hold_array(call, n, sizeof *faces);
  for (size_t i = 0; i < n; i++) faces[i] = (CagSolidFace){chosen[i].part, chosen[i].index};
  return faces;
}

// --- shell ---

// p: NULL without a boundary, and without open faces. Without these, the mesh is that of the solid
// itself, which has fewer triangles than that of its boundary.
static CagStatus mesh_shell(CagCall *call, const struct cag_exacts_shell *a, CagExactParts *p,
                            const CagChosen *open, size_t n, CagSolid **out, CagError *err) {
  const CagSolid *s = n > 0 ? p->solid : a->G;
  const CagSolidFace *faces = chosen_faces(call, open, n);
  double tolerance;
  CagStatus status = cag_exacts_tolerance(call, s, &tolerance, err);
  if (status) return status;
  tolerance = fmin(tolerance, WALL * a->thickness);
  status = cag_solid_hollow(s, a->thickness, a->outside, faces, n, tolerance, out, err);
  if (!status) say_meshed(call, "offsets of the mesh", tolerance, "open faces", n);
  else cag_exacts_say_refused(call, "tier C: offsets of the mesh", err);
  return status;
}

static CagStatus kernel_shell(CagExactParts *p, const struct cag_exacts_shell *a,
                              const CagChosen *open, size_t n, CagSolid **out) {
  const double thickness = (a->outside ? -1 : 1) * a->thickness / p->scale;
  CagStatus status = CAG_OK;
  for (size_t i = 0; !status && i < p->count; i++) {
    CagBoundaries made;
    CagKernelFailure why;
    size_t *faces;
    const size_t count = cag_chosen_in_part(p->call, open, n, i, &faces);
    status = cag_kernel_shell(p->kernel, &p->parts[i], thickness, faces, count, &made, &why,
                              p->call->err);
    if (!status) status = cag_exact_parts_take(p, &made);
  }
  if (!status) status = cag_exact_parts_solid(p, out);
  if (!status) cag_exacts_say_tier(p->call, "tier B: kernel", "open faces", n);
  else cag_exacts_say_refused(p->call, "tier B: kernel", p->call->err);
  return status;
}

bool cag_exacts_shell(CagCall *call, const struct cag_exacts_shell *a, CagValue *result) {
  const CagSolid *s;
  CagExactParts *p = NULL;
  CagSolid *made = NULL;
  CagChosen *open = NULL;
  CagError err;
  size_t n = 0;
  CagStatus status = cag_exacts_of_solid(call, a->G, true, &s);
  // The choice is one of faces of the boundary.
  if (status && (cag_is_final(status) || cag_given(call, 2))) return cag_geometry_ok(call, status);
  const CagError kernel = *call->err;
  if (!status) {
    p = cag_exact_parts_of(call, s);
    if (!p || !cag_chosen_faces(p, 2, &open, &n)) return false;
    if (cag_exact_parts_meshed(p)) {
      status = mesh_shell(call, a, p, open, n, &made, call->err);
      return meshed_result(call, &kernel, status, &made, result);
    }
    status = kernel_shell(p, a, open, n, &made);
  }
  if (status && !cag_is_final(status))
    status = instead(call, status, mesh_shell(call, a, p, open, n, &made, &err), &err);
  return cag_exacts_changed(call, status, &made, result);
}

// --- draft ---

// The direction of the pull in world coordinates is a unit vector.
static CagStatus mesh_draft(CagExactParts *p, const struct cag_exacts_draft *a,
                            const CagChosen *chosen, size_t n, CagSolid **out, CagError *err) {
  CagCall *call = p->call;
  const CagSolidFace *faces = chosen_faces(call, chosen, n);
  double tolerance;
  CagStatus status = cag_exacts_tolerance(call, p->solid, &tolerance, err);
  if (status) return status;
  status = cag_solid_incline(p->solid, faces, n, a->angle, a->at.at, cag_unit(a->pull.at),
                             tolerance, out, err);
  if (!status) say_meshed(call, "moved faces of the mesh", tolerance, "faces", n);
  else cag_exacts_say_refused(call, "tier C: moved faces of the mesh", err);
  return status;
}

static CagStatus kernel_draft(CagExactParts *p, const struct cag_exacts_draft *a,
                              const CagChosen *chosen, size_t n, CagSolid **out) {
  CagTransform back;
  CagStatus status = cag_transform_inverse(&p->solid->placement, &back, p->call->err);
  if (status) return status;
  const CagVec3 at = cag_transform_point(&back, a->at.at);
  const CagVec3 pull = cag_unit(cag_transform_vector(&back, a->pull.at));
  for (size_t i = 0; !status && i < p->count; i++) {
    CagBoundaries made;
    CagKernelFailure why;
    size_t *faces;
    const size_t count = cag_chosen_in_part(p->call, chosen, n, i, &faces);
    status = cag_kernel_draft(p->kernel, &p->parts[i], a->angle, pull, at, faces, count, &made,
                              &why, p->call->err);
    if (!status) status = cag_exact_parts_take(p, &made);
  }
  if (!status) status = cag_exact_parts_solid(p, out);
  if (!status) cag_exacts_say_tier(p->call, "tier B: kernel", "faces", n);
  else cag_exacts_say_refused(p->call, "tier B: kernel", p->call->err);
  return status;
}

bool cag_exacts_draft(CagCall *call, const struct cag_exacts_draft *a, CagValue *result) {
  CagExactParts *p = cag_exact_parts(call, 0, true);
  CagSolid *made = NULL;
  CagChosen *chosen;
  CagError err;
  size_t n;
  const CagError kernel = *call->err;
  if (!p || !cag_chosen_faces(p, 2, &chosen, &n)) return false;
  if (cag_exact_parts_meshed(p)) {
    const CagStatus meshed = mesh_draft(p, a, chosen, n, &made, call->err);
    return meshed_result(call, &kernel, meshed, &made, result);
  }
  CagStatus status = kernel_draft(p, a, chosen, n, &made);
  if (status && !cag_is_final(status))
    status = instead(call, status, mesh_draft(p, a, chosen, n, &made, &err), &err);
  return cag_exacts_changed(call, status, &made, result);
}

// --- split_solid ---

// The side of a plane that is opposite to its normal, or a solid. It is held by the call.
static bool splitting_tool(CagCall *call, CagValue v, const CagSolid **out) {
  CagSolid *side = NULL;
  if (v.type == CAG_SOLID) {
    *out = CAG_AS_SHAPE(v)->as.solid;
    return true;
  }
  CagPlane plane;
  if (!cag_arg_plane(call, 1, &plane) ||
      !cag_geometry_ok(call, cag_solid_half_space(&plane, &side, call->err)))
    return false;
  cag_hold_solid(call, side);
  *out = side;
  return true;
}

static void release_boundaries(void *what) {
  CagBoundaries *b = what;
  cag_boundaries_free(b);
  cag_free(b);
}

// A list of the parts as solids with the attributes of the first argument.
static bool list_of_parts(CagCall *call, CagBoundaries *parts, CagValue *result) {
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < parts->count; i++) {
    CagBoundaries one = {.items = cag_calloc(1, sizeof *one.items), .count = 1};
    CagValue solid;
    if (!one.items) return cag_geometry_ok(call, cag_fail_memory(call->err));
    one.items[0] = parts->items[i];
    parts->items[i] = (CagBoundary){0};
    if (!cag_exacts_result(call, &one, 0, &solid) || !cag_builder_add(call->vm, list, solid))
      return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_exacts_split_solid(CagCall *call, const struct cag_exacts_split_solid *a,
                            CagValue *result) {
  const CagSolid *tool;
  CagKernelFailure why;
  CagBounds box;
  CagKernel *k = cag_exacts_kernel(call);
  if (!k || !splitting_tool(call, a->by, &tool) ||
      !cag_geometry_ok(call, cag_solid_bounds(a->G, &box, call->err)))
    return false;
  CagBoundaries *parts = cag_calloc(1, sizeof *parts);
  if (!parts) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_boundaries, parts);
  const double size = cag_norm(cag_sub(box.max, box.min));
  return cag_geometry_ok(
             call, cag_kernel_split(k, a->G, tool, APPROXIMATE * size, parts, &why, call->err)) &&
         list_of_parts(call, parts, result);
}

// --- imprint ---

// The curves of the argument in the coordinates of the parts. They are held by the call.
static bool imprinted_curves(CagCall *call, const CagExactParts *p, CagCurve ***out, size_t *n) {
  CagTransform back;
  CagBuilder *shapes = cag_builder_new(call->vm);
  if (!cag_geometry_ok(call, cag_transform_inverse(&p->solid->placement, &back, call->err)) ||
      !cag_shapes_collect(call, call->values[1], shapes))
    return false;
  const CagList *list = CAG_AS_LIST(cag_builder_finish(call->vm, shapes));
  *n = list->length;
  *out = cag_hold_curve_array(call, *n);
  for (size_t i = 0; i < *n; i++) {
    const CagValue one = cag_list_get(call->vm, list, i);
    if (one.type != CAG_CURVE) return cag_fail_type(call, 1, "a curve or a list of curves");
    if (!cag_geometry_ok(
            call, cag_curve_transform(CAG_AS_SHAPE(one)->as.curve, &back, &(*out)[i], call->err)))
      return false;
  }
  return *n > 0 || cag_fail_value(call, 1, "at least one curve");
}

// A part that the curves do not divide stays as it is, unless it is the only one.
static bool imprint_part(CagExactParts *p, size_t part, CagCurve *const *curves, size_t n,
                         double tolerance, bool *divided) {
  CagBoundaries made;
  CagKernelFailure why;
  CagStatus status = cag_kernel_imprint(p->kernel, &p->parts[part], curves, n, tolerance, &made,
                                        &why, p->call->err);
  *divided = *divided || !status;
  if (status && why.reason != 0 && (*divided || part + 1 < p->count))
    status = cag_kernel_imprint(p->kernel, &p->parts[part], NULL, 0, tolerance, &made, &why,
                                p->call->err);
  return add_made(p, status, &made);
}

bool cag_exacts_imprint(CagCall *call, const struct cag_exacts_imprint *a, CagValue *result) {
  CagExactParts *p = cag_exact_parts(call, 0, false);
  CagCurve **curves;
  CagBounds box;
  size_t n;
  bool divided = false;
  (void)a;
  if (!p || !imprinted_curves(call, p, &curves, &n) ||
      !cag_geometry_ok(call, cag_solid_bounds(p->solid, &box, call->err)))
    return false;
  const double tolerance = APPROXIMATE * cag_norm(cag_sub(box.max, box.min)) / p->scale;
  for (size_t i = 0; i < p->count; i++)
    if (!imprint_part(p, i, curves, n, tolerance, &divided)) return false;
  return cag_exact_parts_result(p, 0, result);
}
