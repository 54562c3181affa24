// What several files of built-ins on transforms share.

#ifndef CAG_INTERP_BUILTIN_TRANSFORMS_H
#define CAG_INTERP_BUILTIN_TRANSFORMS_H

#include "interp/builtin/shapes.h"

// The result of a call of the core that makes a transform, or the machine's error.
bool cag_transform_result(CagCall *call, CagStatus status, CagTransform *made, bool planar,
                          CagValue *result);

#endif
