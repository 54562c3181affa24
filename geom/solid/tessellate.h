// Tessellation of solids.

#ifndef CAG_GEOM_SOLID_TESSELLATE_H
#define CAG_GEOM_SOLID_TESSELLATE_H

#include "geom/solid/solid.h"
#include "geom/tessellate/tessellate.h"

// The boundary as a watertight mesh; for a set operation, the mesh of the result.
CagStatus cag_solid_tessellate(const CagSolid *s, const CagTessellation *how, CagMesh **out,
                               CagError *err);

#endif
