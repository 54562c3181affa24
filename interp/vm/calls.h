// Calls: binding of arguments to parameters, and built-ins.

#ifndef CAG_INTERP_VM_CALLS_H
#define CAG_INTERP_VM_CALLS_H

#include "interp/vm/vm.h"

// Puts the `count` arguments at `arguments` (the last `named` of them named) in the order of the
// closure's parameters, in place; those not given are CAG_UNSET. There is room for all parameters.
// Fails for wrong arity and unknown names.
bool cag_bind_closure(CagVm *vm, const CagProto *p, CagValue *arguments, size_t count,
                      const char *const *names, size_t named);
// Calls anything that is not a closure: a built-in, a curve or a surface. `arguments` stand on the
// stack with vm->top right behind them or later.
bool cag_call_native(CagVm *vm, CagValue callee, CagValue *arguments, size_t count,
                     const char *const *names, size_t named, bool direct, CagValue *result);

#endif
