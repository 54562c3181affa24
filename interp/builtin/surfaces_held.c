// Memory for arrays of surfaces and curves, held until the built-in ends, and values of results.

#include "base/memory.h"
#include "interp/builtin/surfaces.h"

static void release_surfaces(void *array) {
  CagSurfaceArray *a = array;
  for (size_t i = 0; i < a->count; i++) cag_surface_release(a->items[i]);
  cag_free(a->items);
}

CagSurfaceArray *cag_hold_surfaces(CagCall *call) {
  CagSurfaceArray *a = cag_hold_array(call, 1, sizeof *a);
  cag_hold_for(call, release_surfaces, a);
  return a;
}

CagValue cag_table_value(CagVm *vm, const CagVec3 *points, size_t rows, size_t columns) {
  CagBuilder *table = cag_builder_new(vm);
  for (size_t i = 0; i < rows; i++)
    cag_builder_add(vm, table, cag_points_value(vm, points + i * columns, columns, 3));
  return cag_builder_finish(vm, table);
}

CagValue cag_uv_value(CagVm *vm, CagValue u, CagValue v) {
  static const char *const names[] = {"u", "v"};
  return cag_record_new(vm, names, (CagValue[]){u, v}, 2);
}

CagValue cag_curve_list_value(CagVm *vm, const CagCurveList *list) {
  CagBuilder *out = cag_builder_new(vm);
  for (size_t i = 0; i < list->count; i++)
    cag_builder_add(vm, out, cag_curve_value(vm, cag_curve_retain(list->items[i])));
  return cag_builder_finish(vm, out);
}
