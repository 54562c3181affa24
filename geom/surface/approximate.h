// Splines that approximate any surface.

#ifndef CAG_GEOM_SURFACE_APPROXIMATE_H
#define CAG_GEOM_SURFACE_APPROXIMATE_H

#include "geom/surface/surface.h"

// A bicubic B-spline within the tolerance (mm) of the surface, with its parameters. Fails with
// CAG_E_CONVERGENCE if the surface is not smooth at a point.
CagStatus cag_surface_approximate(const CagSurface *s, double tolerance, CagSurface **out,
                                  CagError *err);

#endif
