// Nearest points of surfaces all of whose points are at one distance from something simpler.

#ifndef CAG_GEOM_SURFACE_NEAREST_CORE_H
#define CAG_GEOM_SURFACE_NEAREST_CORE_H

#include "geom/surface/nearest.h"

// A tube is at its radius from its center line, an offset at its distance from its surface: from
// outside no point of them is nearer than the nearest one of these less that distance. *bound: that
// lower bound, and *out: the place of the surface that it leads to. *known: there is one, as of
// images of such surfaces by similarities.
CagStatus cag_surface_nearest_by_core(const CagSurface *s, CagVec3 p, double *bound,
                                      CagSurfaceNearest *out, bool *known, CagError *err);

#endif
