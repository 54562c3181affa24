// Built-ins that take jets (interp/vm/jet.h): what they do while a function of the script is
// differentiated.

#ifndef CAG_INTERP_VM_JET_BUILTINS_H
#define CAG_INTERP_VM_JET_BUILTINS_H

#include "interp/vm/builtin.h"

// The function to call for built-in `index`: that of its row, or, where arguments hold jets, its
// differentiated form or one that says that there is none.
CagBuiltinFunction cag_jet_function(const CagCall *call, size_t index);

// Row of the differentiated form of the built-in with this name, counted from 1. 0 means there is
// none.
size_t cag_jet_row(const char *name);

// T * v where v holds jets: points of 2, 3 or 4 coordinates and lists of these.
bool cag_jet_transform(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result);

// c(t), s(u, v) where a parameter is a jet: by the chain rule.
bool cag_jet_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                        CagValue *result);

#endif
