// Where shapes come from in the script: the calls that made, moved, and changed them.

#ifndef CAG_INTERP_VM_ORIGIN_H
#define CAG_INTERP_VM_ORIGIN_H

#include "interp/vm/builtin.h"

// The most numbers in an argument that are kept.
enum { CAG_ORIGIN_NUMBERS = 1200 };

// Adds a call that has just succeeded to the origins of the shapes that it made.
void cag_origin_note(const CagCall *call, size_t index, CagValue result);
// The same for an operator that has made something of these values.
void cag_origin_note_operator(CagVm *vm, CagValue result, const CagValue *values, size_t count);
// Whether a row of the table is `translate(G, V)`. NULL, which stands for an operator, is not.
bool cag_is_translation(const CagBuiltin *row);

#endif
