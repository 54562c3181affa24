// Declarations shared by the built-ins on transforms.

#ifndef CAG_INTERP_BUILTIN_TRANSFORMS_H
#define CAG_INTERP_BUILTIN_TRANSFORMS_H

#include "interp/builtin/shapes.h"

// Returns the transform that a core function made, or sets the machine's error.
bool cag_transform_result(CagCall *call, CagStatus status, CagTransform *made, bool planar,
                          CagValue *result);

#endif
