// Calls: binding of arguments to parameters, and calls of built-ins.

#ifndef CAG_INTERP_VM_CALLS_H
#define CAG_INTERP_VM_CALLS_H

#include "interp/vm/vm.h"

// Reorders the `count` arguments at `arguments`, of which the last `named` are named, into the
// order of the closure's parameters, in place. There must be room for all parameters; those not
// given become CAG_UNSET. Fails for wrong arity and unknown names.
bool cag_bind_closure(CagVm *vm, const CagProto *p, CagValue *arguments, size_t count,
                      const char *const *names, size_t named);
// Calls a value that is not a closure: a built-in, curve, or surface. `arguments` are on the stack,
// and vm->top is at or after their end.
bool cag_call_native(CagVm *vm, CagValue callee, CagValue *arguments, size_t count,
                     const char *const *names, size_t named, bool direct, CagValue *result);

#endif
