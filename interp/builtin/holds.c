// Geometry held by built-ins: how each kind is released.

#include "interp/builtin/holds.h"

#include <stddef.h>

#include "base/memory.h"
#include "interp/builtin/shapes.h"
#include "interp/vm/vm.h"

// An array is held by the address of its items, which follow their number in memory.
#define X(Type, name)                                                                              \
  static void release_##name(void *what) { cag_##name##_release(what); }                           \
                                                                                                   \
  void cag_hold_##name(CagCall *call, Type *what) { cag_hold_for(call, release_##name, what); }    \
                                                                                                   \
  typedef struct Type##Array {                                                                     \
    size_t n;                                                                                      \
    Type *items[];                                                                                 \
  } Type##Array;                                                                                   \
                                                                                                   \
  static void release_##name##_array(void *items) {                                                \
    Type##Array *array = (void *)((char *)items - offsetof(Type##Array, items));                   \
    for (size_t i = 0; i < array->n; i++) cag_##name##_release(array->items[i]);                   \
    cag_free(array);                                                                               \
  }                                                                                                \
                                                                                                   \
  Type **cag_hold_##name##_array(CagCall *call, size_t n) {                                        \
    Type##Array *array = cag_calloc(1, sizeof *array + n * sizeof *array->items);                  \
    if (!array) cag_vm_out_of_memory(call->vm);                                                    \
    array->n = n;                                                                                  \
    cag_hold_for(call, release_##name##_array, array->items);                                      \
    return array->items;                                                                           \
  }
CAG_HELD_GEOMETRY(X)
#undef X

static void release_curve_list(void *list) {
  cag_curve_list_free(list);
  cag_free(list);
}

CagCurveList *cag_hold_curve_list(CagCall *call) {
  CagCurveList *list = cag_calloc(1, sizeof *list);
  if (!list) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, release_curve_list, list);
  return list;
}
