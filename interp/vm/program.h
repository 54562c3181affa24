// Running a program: params from outside, imported asserts, the statements of the main file.

#ifndef CAG_INTERP_VM_PROGRAM_H
#define CAG_INTERP_VM_PROGRAM_H

#include "interp/vm/vm.h"

// A param set from outside: `-D name=value`.
typedef struct CagDefine {
  const char *name, *value;
} CagDefine;

// Sets time, frame and frames, and the params of the main module; checks types and ranges. A name
// that is not a param is an error, unless `lenient`.
bool cag_program_set_params(CagVm *vm, CagModuleUnit *main, const CagDefine *defines, size_t n,
                            double frame, double frames, bool lenient);
// Runs a module's statements: shows go to vm->shown, prints to vm->out. Values of EXPRESSION
// statements are given to `expression` (may be NULL).
bool cag_program_run(CagVm *vm, CagModuleUnit *main,
                     void (*expression)(CagVm *vm, CagValue v, void *context), void *context);
// Runs the show statements of a module alone, once more: the interactive session's scene follows
// its definitions.
bool cag_program_run_shows(CagVm *vm, CagModuleUnit *m);

#endif
