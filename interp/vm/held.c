// The resources of built-ins: a stack of what to release, so that a long jump out of a built-in
// leaks nothing.

#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "interp/vm/vm.h"

void cag_vm_release_held(CagVm *vm, size_t count) {
  while (vm->held_count > count) {
    const struct CagHeld h = vm->held[--vm->held_count];
    h.release(h.what);
  }
}

void cag_hold_for(CagCall *call, void (*release)(void *what), void *what) {
  if (!what) return;
  if (!CAG_RESERVE(call->vm->held, call->vm->held_capacity, call->vm->held_count + 1)) {
    release(what);
    cag_vm_out_of_memory(call->vm);
  }
  call->vm->held[call->vm->held_count++] = (struct CagHeld){release, what};
}

void *cag_hold(CagCall *call, void *block) {
  if (!block) cag_vm_out_of_memory(call->vm);
  cag_hold_for(call, cag_free, block);
  return block;
}

void *cag_hold_array(CagCall *call, size_t count, size_t size) {
  return cag_hold(call, cag_calloc(count ? count : 1, size));
}

// Removes a resource from the stack. Resources are released in about the reverse order, so it is
// usually near the end.
static struct CagHeld remove_held(CagVm *vm, const void *what) {
  size_t at = vm->held_count;
  while (at > 0 && vm->held[at - 1].what != what) at--;
  if (at == 0) return (struct CagHeld){NULL, NULL};
  const struct CagHeld h = vm->held[at - 1];
  memmove(vm->held + at - 1, vm->held + at, (vm->held_count - at) * sizeof h);
  vm->held_count--;
  return h;
}

void cag_release_held(CagCall *call, const void *what) {
  if (!what) return;
  const struct CagHeld h = remove_held(call->vm, what);
  if (h.release) h.release(h.what);
}

void *cag_give_held(CagCall *call, void *what) {
  if (what) remove_held(call->vm, what);
  return what;
}
