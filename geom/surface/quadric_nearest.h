// The point of a quadric nearest to a given point.

#ifndef CAG_GEOM_SURFACE_QUADRIC_NEAREST_H
#define CAG_GEOM_SURFACE_QUADRIC_NEAREST_H

#include "geom/surface/nearest.h"
#include "geom/surface/quadric.h"

// The nearest point of the whole quadric, which need not be bounded. One of several equally near
// points. Returns false if the quadric has no real points.
bool cag_quadric_closest(const CagQuadric *q, CagVec3 p, CagVec3 *out);

// The nearest point of a surface of kind "quadric", if it is that of the whole quadric. Returns
// false for other kinds, and where the nearest point of the quadric is not on the surface.
bool cag_surface_quadric_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out);

#endif
