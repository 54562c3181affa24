// What the machine does with shapes and other geometric values outside of named calls: `T * x`,
// members, calls of shapes, and their printed form.
//
// Errors are set as by built-ins; the place is the operation that the machine is at.

#ifndef CAG_INTERP_VM_APPLY_H
#define CAG_INTERP_VM_APPLY_H

#include "interp/vm/builtin.h"

// `T * v`: of a transform, point ([x, y], [x, y, z]; [x, y, z, w] stays homogeneous), plane, shape,
// camera, light, or a list of these. False: error set (E0321 where T cannot move such a value).
bool cag_transform_apply(CagVm *vm, const CagTransform *t, CagValue v, CagValue *result);

// A member of a transform, plane, shape, camera, light or setting. False: there is none of this
// name; no error is set. cag_value_members gives the names that there are and their number, for
// messages and completion: none for values of other types.
#define CAG_MEMBERS_MOST 32
bool cag_value_member(CagVm *vm, CagValue object, const char *name, CagValue *out);
size_t cag_value_members(CagValue object, const char *names[CAG_MEMBERS_MOST]);

// The call of a shape: c(t), s(u, v). False: error set.
bool cag_shape_call(CagVm *vm, CagValue shape, const CagValue *arguments, size_t n,
                    CagValue *result);

// Printed form of a shape, plane, camera, light or setting:
// "bspline curve, degree 3, 5 points, t in 0..2", "sphere, radius 10", "group of 3 shapes".
void cag_describe_shape(CagVm *vm, CagString *s, CagValue v);

#endif
