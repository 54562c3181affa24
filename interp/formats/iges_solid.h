// Solids of IGES files by their boundaries.

#ifndef CAG_INTERP_FORMATS_IGES_SOLID_H
#define CAG_INTERP_FORMATS_IGES_SOLID_H

#include "interp/formats/iges_entity.h"

// Writes the solid within a shell and its cavities, whose faces have carriers, as a manifold solid
// B-rep (entity 186), with the writer's name and color. Fails if memory runs out, or if a curve
// cannot be converted.
CagStatus cag_iges_solid(CagIges *w, const CagBrepShape *shape, size_t outer, CagError *err);

#endif
