// Nearest points of surfaces of revolution.

#ifndef CAG_GEOM_SURFACE_NEAREST_REVOLVED_H
#define CAG_GEOM_SURFACE_NEAREST_REVOLVED_H

#include "geom/surface/nearest.h"

// The nearest point of a surface of revolution whose profile is in a plane with the axis: the turned
// nearest point of the profile. *known is false for other surfaces, and if that point is beyond the
// ends of a partial turn.
CagStatus cag_surface_revolved_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out,
                                       bool *known, CagError *err);

#endif
