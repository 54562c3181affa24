// Nearest points of surfaces with a core: a simpler curve or surface at a constant distance.

#ifndef CAG_GEOM_SURFACE_NEAREST_CORE_H
#define CAG_GEOM_SURFACE_NEAREST_CORE_H

#include "geom/surface/nearest.h"

// The core of a tube is its center line, and the core of an offset is its base surface. For a point
// outside, the distance from the core minus the constant distance is a lower bound, which is stored
// in *bound. *out is the point of the surface that corresponds to the nearest point of the core.
// *known is set if the surface is a tube, an offset, or the image of one under a similarity.
CagStatus cag_surface_nearest_by_core(const CagSurface *s, CagVec3 p, double *bound,
                                      CagSurfaceNearest *out, bool *known, CagError *err);

#endif
