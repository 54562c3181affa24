// Detection of surfaces that intersect themselves by construction.

#ifndef CAG_GEOM_MEET_CROSSING_H
#define CAG_GEOM_MEET_CROSSING_H

#include "geom/solid/solid.h"
#include "geom/surface/surface.h"

// Whether a revolution's profile crosses itself, a swept section reaches beyond the center of
// curvature of the path so that the surface folds there, or parts of a tube's path are closer to
// each other than the tube is thick. Only samples are tested: smaller crossings, and sweeps of
// other sections whose parts intersect, are not found. `what` (of `size`) receives a description of
// the first location.
bool cag_surface_crosses_itself(const CagSurface *s, char *what, size_t size);
// The same for a solid's faces.
bool cag_solid_crosses_itself(const CagSolid *s, char *what, size_t size);
// Whether the solid is a loft whose sections all lie in one plane.
bool cag_solid_is_flat(const CagSolid *s, char *what, size_t size);

#endif
