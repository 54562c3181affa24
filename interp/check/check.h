// What can be told of a script without running it: calls that cannot go well, values of a type that
// an operator or a function never takes, definitions that nothing uses.
//
// The types that an expression may have are inferred as a set; an error is reported only where no
// type of the set would do. So what is reported is wrong whenever the place is reached.

#ifndef CAG_INTERP_CHECK_H
#define CAG_INTERP_CHECK_H

#include "interp/vm/vm.h"

// Checks a module whose names were resolved, which may have failed for some of them and of its
// imports. Errors and warnings go to vm->errors; false where there are errors.
bool cag_check_module(CagVm *vm, CagModuleUnit *m);

#endif
