// What the machine does with shapes and other geometric values outside of named calls: `T * x`,
// and calls of shapes.
//
// Errors are set as by built-ins; the place is the operation that the machine is at.

#ifndef CAG_INTERP_VM_APPLY_H
#define CAG_INTERP_VM_APPLY_H

#include "interp/vm/builtin.h"

// `T * v`: of a transform, point ([x, y], [x, y, z]; [x, y, z, w] stays homogeneous), plane, shape,
// camera, light, or a list of these. False: error set (E0321 where T cannot move such a value).
bool cag_transform_apply(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result);

// The call of a shape: c(t), s(u, v). False: error set.
bool cag_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                    CagValue *result);

#endif
