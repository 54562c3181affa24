// Offsets of solids with exact faces.

#ifndef CAG_INTERP_BUILTIN_EXACTS_OFFSET_H
#define CAG_INTERP_BUILTIN_EXACTS_OFFSET_H

#include "interp/builtin/shapes.h"

// The offset of a solid argument, at a distance (mm) that is not 0, whose faces are exact: of boxes,
// spheres, cylinders, and tori by their forms (tier A), of exact solids and set operations by the
// kernel (tier B). *done is false if there is none, or the kernel is missing, fails, or finds
// something else; the offset of the mesh (tier C) remains. Returns false if an error is set, because
// the work was stopped or memory ran out.
bool cag_exact_offset(CagCall *call, int argument, double d, CagValue *result, bool *done);

#endif
