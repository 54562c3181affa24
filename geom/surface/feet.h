// All feet of perpendiculars from a point to a surface.

#ifndef CAG_GEOM_SURFACE_FEET_H
#define CAG_GEOM_SURFACE_FEET_H

#include "geom/curve/feet.h"
#include "geom/surface/surface.h"

// The points of the surface at which the line to p is normal to it, ascending by distance; *out is
// malloc'd. Only the part of a trimmed surface or region within its outlines counts. Edges and
// creases count only if the line is normal to one side. The search starts from samples, at least 48
// along each direction. Fails with "not-unique" if a foot is not isolated.
CagStatus cag_surface_feet(const CagSurface *s, CagVec3 p, CagFoot **out, size_t *n, CagError *err);

#endif
