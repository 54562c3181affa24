// Static checks: calls that always fail, values of a type that an operator or a function never
// accepts, and unused definitions.
//
// The possible types of an expression are inferred as a set. An error is reported only if no type
// of the set is valid, so a reported expression always fails when it is evaluated.

#ifndef CAG_INTERP_CHECK_H
#define CAG_INTERP_CHECK_H

#include "interp/check/types.h"
#include "interp/vm/vm.h"

// Checks a module after its names were resolved, even if some names or imports are unknown. Adds
// errors and warnings to vm->errors. Returns false if there are errors.
bool cag_check_module(CagVm *vm, CagModuleUnit *m);
// The same, and stores the possible types of each top-level definition in types[0 .. top_count).
bool cag_check_module_types(CagVm *vm, CagModuleUnit *m, CagTypes *types);

#endif
