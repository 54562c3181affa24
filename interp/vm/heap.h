// The heap: precise mark-and-sweep garbage collection.
//
// Allocation never collects. It adds to a debt, and the machine collects at safe points (calls of
// script functions, back edges of loops, between top-level definitions) once the debt is due. C
// code between safe points therefore needs no precautions. The roots are the machine's stack, the
// modules' globals, constants, interned texts, and the root stack. If --max-memory is still
// exceeded after a collection, the run fails with E0602 (memory-limit).
//
// Small objects (up to CAG_SMALL_MAX bytes) come from size-classed pages with free lists; larger
// ones from cag_malloc. Everything that the run allocates, geometry included, is charged to the
// machine's account (base/memory.h), whose limit is --max-memory.

#ifndef CAG_INTERP_VM_HEAP_H
#define CAG_INTERP_VM_HEAP_H

#include "interp/vm/value.h"

// Allocates an object, zeroed except for its header. Never returns NULL: if the limit or the
// system's memory is exceeded, the run ends with the error of the memory limit. A long jump then
// leads to the start of the run, and cleanups release what C code holds (base/guard.h).
void *cag_alloc(CagVm *vm, CagType type, size_t size);
void cag_collect(CagVm *vm);

// Kinds of objects with the type CAG_INTERNAL, in their head.flags.
enum {
  CAG_INTERNAL_BUILDER = 1,
  CAG_INTERNAL_LAYOUT = 2,
  CAG_INTERNAL_LABEL = 3,
  CAG_INTERNAL_STEP = 4,
  CAG_INTERNAL_STILL = 5,
  CAG_INTERNAL_POSTURE = 6,
  CAG_INTERNAL_LIMB = 7,
  CAG_INTERNAL_MOTION = 8,
  CAG_INTERNAL_INPUTS = 9,
  CAG_INTERNAL_OPERANDS = 10,
  CAG_INTERNAL_CALL = 11,
  CAG_INTERNAL_SITE = 12
};

void cag_heap_init(CagVm *vm);
void cag_heap_free(CagVm *vm);

// Root stack.
void cag_root_push(CagVm *vm, CagValue v);
void cag_root_pop(CagVm *vm, size_t n);

#endif
