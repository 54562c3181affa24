// The heap: precise mark and sweep.
//
// Allocation never collects. It adds to a debt, and the machine collects at safe points (calls of script functions, back edges of loops, between top-level
// definitions) once the debt is due; so C code between safe points needs no care. Roots are the machine's stack, the modules' globals, constants, interned texts and the
// root stack. Crossing --max-memory after a collection is the error E0602 (memory-limit).
//
// Small objects (up to CAG_SMALL_MAX bytes) come from size-classed pages with free lists; larger ones from malloc. Memory outside of the heap (a curve's data, a
// list's buffer) is told with cag_heap_charge.

#ifndef CAG_INTERP_HEAP_H
#define CAG_INTERP_HEAP_H

#include "interp/value/value.h"

// Zeroed except for the header, which is set. Never NULL: when the system has no more memory the run ends with the memory limit's error at the
// next safe point, using a reserve.
void *cag_alloc(CagVm *vm, CagType type, size_t size);
void cag_heap_charge(CagVm *vm, size_t bytes);
void cag_collect(CagVm *vm);

// Root stack.
void cag_root_push(CagVm *vm, CagValue v);
void cag_root_pop(CagVm *vm, size_t n);

#endif
