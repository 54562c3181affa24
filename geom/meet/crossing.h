// Surfaces that cross themselves by the way they are made.

#ifndef CAG_GEOM_MEET_CROSSING_H
#define CAG_GEOM_MEET_CROSSING_H

#include "geom/solid/solid.h"
#include "geom/surface/surface.h"

// Whether a revolution's profile crosses itself, or a section swept along a path reaches beyond the
// bend of the path, so that the surface folds there, or parts of a tube's path are nearer to each
// other than the tube is thick. Looked for at samples: crossings smaller than these, and sweeps of
// other sections whose parts meet, are not found. `what` (of `size`) names the first location.
bool cag_surface_crosses_itself(const CagSurface *s, char *what, size_t size);
// The same of a solid's faces.
bool cag_solid_crosses_itself(const CagSolid *s, char *what, size_t size);
// Whether it is a loft whose sections lie in one plane.
bool cag_solid_is_flat(const CagSolid *s, char *what, size_t size);

#endif
