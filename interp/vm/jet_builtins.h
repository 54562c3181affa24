// Built-ins that accept jets (interp/vm/jet.h), used while a function of the script is
// differentiated.

#ifndef CAG_INTERP_VM_JET_BUILTINS_H
#define CAG_INTERP_VM_JET_BUILTINS_H

#include "interp/vm/builtin.h"

// Returns the function to call for built-in `index`: that of its row or, if arguments contain jets,
// its differentiated form or one that reports that it cannot be differentiated.
CagBuiltinFunction cag_jet_function(const CagCall *call, size_t index);

// Returns the row, counted from 1, of the differentiated form of the built-in with this name, or 0
// if there is none.
size_t cag_jet_row(const char *name);

// Computes T * v if v contains jets, for points of 2, 3, or 4 coordinates and lists of these.
bool cag_jet_transform(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result);

// Computes c(t) or s(u, v) if a parameter is a jet, by the chain rule.
bool cag_jet_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                        CagValue *result);

#endif
