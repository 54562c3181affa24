// Calls of the script from geometry: curves and surfaces by a formula.
//
// Geometry may evaluate them at any time: from built-ins that hold values in plain variables, or
// from exporters after the script has ended. So each call is protected separately: exhausted memory
// becomes the status of the evaluation, and the collector keeps all objects that are older than the
// call (heap.c).

#include "base/array.h"
#include "base/memory.h"
#include "interp/vm/vm.h"

// The maximum depth of functions that evaluate curves that call functions; it has six bits.
#define DEPTH_MOST 60

size_t cag_vm_keep(CagVm *vm, CagValue v) {
  if (vm->kept_free) {
    size_t slot = vm->kept_free - 1;
    vm->kept_free = (size_t)vm->kept[slot].as.number;
    vm->kept[slot] = v;
    return slot;
  }
  if (!CAG_RESERVE(vm->kept, vm->kept_capacity, vm->kept_count + 1)) cag_vm_out_of_memory(vm);
  vm->kept[vm->kept_count] = v;
  return vm->kept_count++;
}

void cag_vm_let_go(CagVm *vm, size_t slot) {
  vm->kept[slot] = cag_unset();
  vm->kept[slot].as.number = (double)vm->kept_free;
  vm->kept_free = slot + 1;
}

bool cag_vm_call_back(CagVm *vm, bool (*work)(CagVm *vm, void *context), void *context) {
  if (vm->failed) return false;
  if (vm->heap.depth == DEPTH_MOST)
    return cag_vm_fail(vm, CAG_ERR_limit_depth,
                       "formulas of curves and surfaces are nested more than %d deep", DEPTH_MOST);
  const uint32_t level = vm->differentiation;
  vm->heap.depth++;
  const bool ok = cag_vm_protect(vm, work, context) && !vm->failed;
  if (!ok && vm->native) vm->native->probed = true;
  vm->heap.depth--;
  vm->differentiation = level;
  return ok;
}
