// Circular definitions.

#ifndef CAG_INTERP_CHECK_CIRCLE_H
#define CAG_INTERP_CHECK_CIRCLE_H

#include "interp/vm/vm.h"

// Reports each circle of definitions once, at the name that closes it, to `errors`. Considers only
// what is always evaluated: not the branches of an `if`, nor the bodies of loops and of functions
// that are not called.
void cag_check_circles(const CagModuleAst *ast, CagDiagnostics *errors);

#endif
