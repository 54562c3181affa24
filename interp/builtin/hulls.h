// What the built-ins on hulls, containment, and distances share.

#ifndef CAG_INTERP_BUILTIN_HULLS_H
#define CAG_INTERP_BUILTIN_HULLS_H

#include "interp/vm/builtin.h"

// Whether a value is a list, at any depth, whose first item is a shape.
bool cag_is_list_of_shapes(CagVm *vm, CagValue v);
// Whether a solid or closed mesh contains the point. *body is false for other shapes.
bool cag_shape_holds(CagCall *call, CagValue v, CagVec3 p, bool *inside, bool *body);

#endif
