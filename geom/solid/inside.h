// Whether points lie within a solid, asked many times.

#ifndef CAG_GEOM_SOLID_INSIDE_H
#define CAG_GEOM_SOLID_INSIDE_H

#include "geom/solid/solid.h"
#include "geom/tessellate/tessellate.h"

typedef struct CagInside CagInside;

// Box, sphere, cylinder, torus, half space and quadric are asked by their equations, operations by
// their operands, everything else by a mesh that `how` describes (its tolerance <= 0: by the size).
// The solid must outlive it.
CagStatus cag_inside_new(const CagSolid *s, const CagTessellation *how, CagInside **out,
                         CagError *err);
void cag_inside_free(CagInside *inside);
// The boundary, to rounding, belongs to the solid.
CagStatus cag_inside_holds(CagInside *inside, CagVec3 p, bool *out, CagError *err);

#endif
