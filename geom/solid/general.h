// General position of the operands of a set operation.
//
// Operands are in general position where no two of them have faces that coincide, wholly or in
// part: planes in one plane, cylinders on one cylinder, free forms on each other. A renderer with
// set operations of its own cannot tell which of two coincident faces a ray meets first, so it gets
// such operations as meshes.

#ifndef CAG_GEOM_SOLID_GENERAL_H
#define CAG_GEOM_SOLID_GENERAL_H

#include "geom/solid/csg.h"

// Whether the operands of the operation, at every depth, are in general position. Solids that are
// no operation are; operands whose faces cannot be evaluated are not.
//
//   interrupt  NULL, or: not 0 ends the search, with false
bool cag_solid_in_general_position(const CagSolid *s, const volatile int *interrupt);

#endif
