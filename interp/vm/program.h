// Running a program: setting params, checking asserts of imported modules, and running the
// statements of the main file.

#ifndef CAG_INTERP_VM_PROGRAM_H
#define CAG_INTERP_VM_PROGRAM_H

#include "interp/vm/vm.h"

// A param set from outside: `-D name=value`.
typedef struct CagDefine {
  const char *name, *value;
} CagDefine;

// Sets time, frame, frames, and the params of the main module, and checks their types and ranges. A
// name that is not a param is an error unless `lenient`.
bool cag_program_set_params(CagVm *vm, CagModuleUnit *main, const CagDefine *defines, size_t n,
                            double frame, double frames, bool lenient);
// Runs a module's statements: shows are added to vm->shown, prints are written to vm->out. Calls
// `expression`, which may be NULL, with the value of each EXPRESSION statement.
bool cag_program_run(CagVm *vm, CagModuleUnit *main,
                     void (*expression)(CagVm *vm, CagValue v, void *context), void *context);
// Runs only the show statements of a module again, to update the scene of an interactive session
// after a change of its definitions.
bool cag_program_run_shows(CagVm *vm, CagModuleUnit *m);

#endif
