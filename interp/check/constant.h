// Calls of built-ins whose arguments are all written out: they are evaluated, so that what they
// reject is known before the script runs.

#ifndef CAG_INTERP_CHECK_CONSTANT_H
#define CAG_INTERP_CHECK_CONSTANT_H

#include "interp/vm/vm.h"

// A call or a pipe is constant if it calls quick built-ins that read neither files nor params, with
// literals, built-in constants, other such calls, and definitions of these. `is_bad` tells whether
// a definition of the top level already has a reported error.
typedef struct CagConstants {
  CagVm *vm;
  CagModuleUnit *unit;
  const bool *is_bad; // by the index of the definition
  size_t evaluated;
} CagConstants;

// Evaluates a call or a pipe if it is constant; its error goes to vm->errors.
void cag_check_constant(CagConstants *c, const CagExpr *e);

#endif
