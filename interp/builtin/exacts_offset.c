// Offsets of solids with exact faces (see exacts_offset.h).

#include "interp/builtin/exacts_offset.h"

#include <math.h>

#include "geom/solid/csg.h"
#include "geom/solid/rounded.h"
#include "interp/builtin/exacts.h"
#include "interp/builtin/support.h"
#include "interp/vm/vm.h"

// The tolerance for surfaces without an exact form, as a fraction of the size.
#define APPROXIMATE 1e-5
// The bounds of the kernel's offset may differ from the expected ones by this fraction of the size.
#define SAME_BOUNDS 1e-4

static void say_tier(CagCall *call, const char *label, double d) {
  if (call->vm->verbose) cag_vm_trace(call, cag_number(d), label);
}

static bool solid_result(CagCall *call, CagStatus status, CagSolid *s, int argument,
                         CagValue *result) {
  if (!cag_solid_result(call, status, &s, result)) return false;
  cag_shape_say_alike(*result, call->values[argument]);
  return true;
}

// --- Tier A: forms ---

// The form in its own coordinates, and how far it is moved there. Nothing is left if a size is not
// positive.
static CagStatus offset_box(const CagSolid *s, double d, CagSolid **out, CagVec3 *move,
                            CagError *err) {
  const CagVec3 size = cag_vec3(s->a + 2 * d, s->b + 2 * d, s->c + 2 * d);
  if (!s->centered) *move = cag_vec3(-d, -d, -d);
  if (!(size.x > 0 && size.y > 0 && size.z > 0)) return cag_solid_empty(out, err);
  return d > 0 ? cag_solid_rounded_box(size, d, s->centered, out, err)
               : cag_solid_box(size, s->centered, out, err);
}

static CagStatus offset_cylinder(const CagSolid *s, double d, CagSolid **out, CagVec3 *move,
                                 CagError *err) {
  const double height = s->a + 2 * d, radius = s->b + d;
  *move = cag_vec3(0, 0, -d);
  if (!(height > 0 && radius > 0)) return cag_solid_empty(out, err);
  return d > 0 ? cag_solid_rounded_cylinder(height, radius, d, out, err)
               : cag_solid_cylinder(height, radius, radius, out, err);
}

// *out stays NULL if the offset has no such form: a torus whose hole closes, a cone.
static CagStatus offset_form(const CagSolid *s, double d, CagSolid **out, CagVec3 *move,
                             CagError *err) {
  switch (s->kind) {
  case CAG_SOLID_BOX: return offset_box(s, d, out, move, err);
  case CAG_SOLID_CYLINDER: return s->b == s->c ? offset_cylinder(s, d, out, move, err) : CAG_OK;
  case CAG_SOLID_SPHERE:
    return s->a + d > 0 ? cag_solid_sphere(s->a + d, out, err) : cag_solid_empty(out, err);
  case CAG_SOLID_TORUS:
    if (!(s->b < s->a && s->b + d < s->a)) return CAG_OK;
    return s->b + d > 0 ? cag_solid_torus(s->a, s->b + d, out, err) : cag_solid_empty(out, err);
  default: return CAG_OK;
  }
}

static bool form_result(CagCall *call, const CagSolid *s, int argument, double d, CagValue *result,
                        bool *done) {
  CagSolid *own = NULL, *placed = NULL;
  CagVec3 move = {0, 0, 0};
  double scale;
  if (!cag_transform_is_similarity(&s->placement, &scale)) return true;
  CagStatus status = offset_form(s, d / scale, &own, &move, call->err);
  if (!status && !own) return true;
  const CagTransform shift = cag_translate(move);
  const CagTransform place = cag_transform_multiply(&s->placement, &shift);
  if (!status) status = cag_solid_transform(own, &place, &placed, call->err);
  cag_solid_release(own);
  *done = true;
  if (!solid_result(call, status, placed, argument, result)) return false;
  say_tier(call, "offset: tier A: exact form; distance", d);
  return true;
}

// --- Tier B: the kernel ---

// Whether the kernel is worth its time: the solid has a boundary that is not a mesh's.
static bool is_for_kernel(const CagSolid *s) {
  if (s->kind == CAG_SOLID_MESH || s->kind == CAG_SOLID_HALF_SPACE || s->kind == CAG_SOLID_QUADRIC)
    return false;
  for (size_t i = 0; s->face_count == 0 && s->core && i < s->core->count; i++)
    if (s->core->operands[i]->kind == CAG_SOLID_MESH ||
        (s->core->operands[i]->core && s->core->operands[i]->core->count > 0 &&
         !is_for_kernel(s->core->operands[i])))
      return false;
  return s->kind == CAG_SOLID_EXACT || s->face_count == 0;
}

// A solid grows by the distance along each axis, and shrinks by at least the distance.
static bool fits_bounds(const CagBounds *box, const CagBounds *made, double d) {
  const double slack = SAME_BOUNDS * cag_norm(cag_sub(box->max, box->min));
  const double off[6] = {box->min.x - made->min.x, box->min.y - made->min.y,
                         box->min.z - made->min.z, made->max.x - box->max.x,
                         made->max.y - box->max.y, made->max.z - box->max.z};
  for (int i = 0; i < 6; i++)
    if (off[i] > d + slack || (d > 0 && off[i] < d - slack)) return false;
  return true;
}

static CagStatus kernel_offset(CagKernel *k, const CagSolid *s, double d, CagSolid **out,
                               CagError *err) {
  CagBounds box, made;
  CagBoundaries parts;
  CagKernelFailure why;
  CagStatus status = cag_solid_bounds(s, &box, err);
  if (status) return status;
  const double tolerance = APPROXIMATE * cag_norm(cag_sub(box.max, box.min));
  status = cag_kernel_offset(k, s, d, tolerance, &parts, &why, err);
  if (!status) status = cag_exacts_checked(&parts, out, err);
  if (status) return status;
  status = cag_solid_bounds(*out, &made, err);
  if (!status && fits_bounds(&box, &made, d)) return CAG_OK;
  cag_solid_release(*out);
  *out = NULL;
  return status;
}

static bool kernel_result(CagCall *call, const CagSolid *s, int argument, double d,
                          CagValue *result, bool *done) {
  CagVm *vm = call->vm;
  CagKernel *k = vm->find_kernel ? vm->find_kernel(vm->find_kernel_context) : NULL;
  CagSolid *made = NULL;
  CagError err;
  if (!k) return true;
  const CagStatus status = kernel_offset(k, s, d, &made, &err);
  if (cag_is_final(status)) {
    *call->err = err;
    return cag_geometry_ok(call, status);
  }
  if (status || !made) return true;
  *done = true;
  if (!solid_result(call, CAG_OK, made, argument, result)) return false;
  say_tier(call, "offset: tier B: kernel; distance", d);
  return true;
}

bool cag_exact_offset(CagCall *call, int argument, double d, CagValue *result, bool *done) {
  *done = false;
  if (call->values[argument].type != CAG_SOLID) return true;
  const CagSolid *s = CAG_AS_SHAPE(call->values[argument])->as.solid;
  if (!form_result(call, s, argument, d, result, done)) return false;
  if (*done || !is_for_kernel(s)) return true;
  return kernel_result(call, s, argument, d, result, done);
}
