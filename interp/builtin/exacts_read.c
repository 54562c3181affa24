// Exact solids from STEP and IGES files.

#include <math.h>
#include <string.h>

#include "interp/builtin/exacts.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/scene.h"
#include "interp/vm/vm.h"

static void release_boundaries(void *what) {
  CagBoundaries *b = what;
  cag_boundaries_free(b);
  cag_free(b);
}

static void name_shape(CagVm *vm, CagValue shape, const char *name, bool has_color,
                       const double color[3]) {
  static const char *const COLOR[] = {"color"};
  CagShape *s = CAG_AS_SHAPE(shape);
  if (name && *name) s->name = CAG_AS_TEXT(cag_text_c(vm, name));
  if (!has_color) return;
  const CagValue value = cag_color_value(vm, (CagColor){color[0], color[1], color[2]});
  s->material = CAG_AS_RECORD(cag_record_new(vm, COLOR, &value, 1));
}

// The solid of one boundary, whose contents are taken.
static bool solid_of_boundary(CagCall *call, CagBoundary *from, size_t number, const char *path,
                              CagSolid **out) {
  CagBoundaries one = {.items = cag_calloc(1, sizeof *one.items), .count = 1};
  if (!one.items) return cag_geometry_ok(call, cag_fail_memory(call->err));
  one.items[0] = *from;
  *from = (CagBoundary){0};
  const CagStatus status = cag_exacts_checked(&one, out, call->err);
  if (status && call->err->id == CAG_ERR_no_boundary) {
    char why[sizeof call->err->message];
    memcpy(why, call->err->message, sizeof why);
    return cag_fail_call(call, 0, CAG_ERR_exact_file, "cannot use solid %zu of `%s`: %s", number,
                         path, why);
  }
  return cag_geometry_ok(call, status);
}

// A solid with its name and color. Copies share the boundary of their original and its measures.
static bool solid_of(CagCall *call, CagBoundaries *all, size_t i, CagSolid **solids,
                     const char *path, CagValue *result) {
  CagBoundary *from = &all->items[i];
  const bool has_color = from->has_color;
  double color[3];
  memcpy(color, from->color, sizeof color);
  char *name = from->name;
  from->name = NULL;
  cag_hold(call, name);
  const size_t original = all->copies ? all->copies[i].original : CAG_NOT_COPIED;
  if (original == CAG_NOT_COPIED) {
    if (!solid_of_boundary(call, from, i + 1, path, &solids[i])) return false;
  } else if (!cag_geometry_ok(call, cag_solid_transform(solids[original], &all->copies[i].placement,
                                                        &solids[i], call->err)))
    return false;
  CagSolid *s = cag_solid_retain(solids[i]);
  if (!cag_solid_result(call, CAG_OK, &s, result)) return false;
  name_shape(call->vm, *result, name, has_color, color);
  cag_release_held(call, name);
  return true;
}

// One solid as such, several as a group.
static bool solids_of(CagCall *call, CagBoundaries *all, const char *path, CagValue *result) {
  CagSolid **own = cag_hold_solid_array(call, all->count);
  if (all->count == 1) return solid_of(call, all, 0, own, path, result);
  CagBuilder *solids = cag_builder_new(call->vm);
  for (size_t i = 0; i < all->count; i++) {
    CagValue one;
    if (!cag_keep_going(call->vm) || !solid_of(call, all, i, own, path, &one) ||
        !cag_builder_add(call->vm, solids, one))
      return false;
  }
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, solids));
  return true;
}

typedef CagStatus (*FileReader)(CagKernel *k, const char *name, const void *bytes, size_t size,
                                CagBoundaries *out, CagKernelFailure *why, CagError *err);

static bool read_exact(CagCall *call, const char *path, FileReader reader, CagValue *result) {
  char *bytes;
  size_t size;
  CagKernelFailure why;
  if (!cag_vm_open_file(call, 0, path, &bytes, &size)) return false;
  cag_hold(call, bytes);
  CagKernel *k = cag_exacts_kernel(call);
  if (!k) return false;
  CagBoundaries *all = cag_calloc(1, sizeof *all);
  if (!all) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_boundaries, all);
  const char *slash = strrchr(path, '/');
  const CagStatus status = reader(k, slash ? slash + 1 : path, bytes, size, all, &why, call->err);
  cag_release_held(call, bytes); // early, because creating the solids may need the memory
  return cag_geometry_ok(call, status) && solids_of(call, all, path, result);
}

bool cag_mesh_files_read_step(CagCall *call, const struct cag_mesh_files_read_step *a,
                              CagValue *result) {
  return read_exact(call, a->path, cag_kernel_read_step, result);
}

bool cag_mesh_files_read_iges(CagCall *call, const struct cag_mesh_files_read_iges *a,
                              CagValue *result) {
  return read_exact(call, a->path, cag_kernel_read_iges, result);
}
