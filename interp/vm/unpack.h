// Taking lists and records apart by patterns.

#ifndef CAG_INTERP_VM_UNPACK_H
#define CAG_INTERP_VM_UNPACK_H

#include "interp/vm/vm.h"

// Sets out[0 .. n) to the elements of a list or range. With `rest`, it may have more than n, and
// out[n] is the list of the others. Fails, with the pattern and the value, if the value is not a
// list or range, or has another length.
bool cag_unpack(CagVm *vm, CagValue v, size_t n, bool rest, CagValue *out);
// The same for a field of a record.
bool cag_unpack_field(CagVm *vm, CagValue v, const CagText *name, CagValue *out);

#endif
