// Tessellation of trimmed surfaces.

#ifndef CAG_GEOM_TESSELLATE_TRIMMED_H
#define CAG_GEOM_TESSELLATE_TRIMMED_H

#include "geom/tessellate/tessellate.h"

// The tolerance must be positive. The points of the outline depend only on the outline, and its
// edges are not divided further, so that surfaces on both sides of it can share them.
CagStatus cag_trimmed_tessellate(const CagSurface *s, const CagTessellation *how, CagMesh **out,
                                 CagError *err);

#endif
