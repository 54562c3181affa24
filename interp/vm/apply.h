// Operations of the machine on shapes and other geometric values outside of named calls: `T * x`,
// and calls of shapes.
//
// Errors are set as by built-ins. Their location is the current operation of the machine.

#ifndef CAG_INTERP_VM_APPLY_H
#define CAG_INTERP_VM_APPLY_H

#include "interp/vm/builtin.h"

// Computes `T * v` for a transform, point ([x, y] or [x, y, z]; [x, y, z, w] stays homogeneous),
// plane, shape, camera, light, or a list of these. Returns false if an error was set (E0321 if T
// cannot transform such a value).
bool cag_transform_apply(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result);

// Calls a shape: c(t), s(u, v). Returns false if an error was set.
bool cag_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                    CagValue *result);

#endif
