// Repeated tests whether points lie within a solid.

#ifndef CAG_GEOM_SOLID_INSIDE_H
#define CAG_GEOM_SOLID_INSIDE_H

#include "geom/solid/solid.h"
#include "geom/tessellate/tessellate.h"

typedef struct CagInside CagInside;

// Boxes, spheres, cylinders, tori, half spaces, and quadrics are tested by their equations,
// operations by their operands, and other solids by a mesh made with `how` (tolerance <= 0: by the
// size). The solid must outlive the result.
CagStatus cag_inside_new(const CagSolid *s, const CagTessellation *how, CagInside **out,
                         CagError *err);
void cag_inside_free(CagInside *inside);
// Points on the boundary, to rounding, are inside.
CagStatus cag_inside_holds(CagInside *inside, CagVec3 p, bool *out, CagError *err);

#endif
