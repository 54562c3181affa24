// Constant calls of built-ins: they are evaluated, so that invalid arguments are reported without
// running the script.

#ifndef CAG_INTERP_CHECK_CONSTANT_H
#define CAG_INTERP_CHECK_CONSTANT_H

#include "interp/vm/vm.h"

// A call or a pipe is constant if it calls only fast built-ins that read neither files nor params,
// with literals, built-in constants, other such calls, and definitions of these. `is_bad` marks
// top-level definitions with an error that was already reported.
typedef struct CagConstants {
  CagVm *vm;
  CagModuleUnit *unit;
  const bool *is_bad; // by the index of the definition
  size_t evaluated;
} CagConstants;

// Evaluates an expression if it is constant, and prints its value. Returns false if it is not, or
// if it has an error. Errors are discarded.
bool cag_constant_print(CagVm *vm, CagModuleUnit *unit, const CagExpr *e, CagString *out);
// Evaluates a call or a pipe if it is constant. Adds its error to vm->errors.
void cag_check_constant(CagConstants *c, const CagExpr *e);

#endif
