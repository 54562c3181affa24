// Definitions that need themselves.

#ifndef CAG_INTERP_CHECK_CIRCLE_H
#define CAG_INTERP_CHECK_CIRCLE_H

#include "interp/vm/vm.h"

// Reports each circle of definitions once, at the name that closes it, to `errors`. Only what is
// evaluated in any case counts: no branch of an `if`, no body of a loop or of a function that is
// not called.
void cag_check_circles(const CagModuleAst *ast, CagDiagnostics *errors);

#endif
