// General position of the operands of a set operation.
//
// Operands are in general position if no two of them have faces that coincide, wholly or partly:
// coplanar faces, parts of one cylinder, or free-form surfaces that overlap. A renderer with native
// set operations cannot tell which of two coincident faces a ray hits first, so it receives such
// operations as meshes.

#ifndef CAG_GEOM_SOLID_GENERAL_H
#define CAG_GEOM_SOLID_GENERAL_H

#include "geom/solid/csg.h"

// Whether the operands of the operation, at every depth, are in general position. True for solids
// that are not operations; false for operands whose faces cannot be evaluated.
//
//   interrupt  nonzero cancels the search, which returns false; may be NULL
bool cag_solid_in_general_position(const CagSolid *s, const volatile int *interrupt);

#endif
