// Surfaces that cross themselves by the way they are made.

#ifndef CAG_GEOM_CROSSING_H
#define CAG_GEOM_CROSSING_H

#include "geom/solid/solid.h"
#include "geom/surface/surface.h"

// Whether a revolution's profile crosses itself, or a section swept along a path reaches beyond the
// bend of the path, so that the surface folds there. Looked for at samples: crossings smaller than
// these, and parts of a path that come near to each other, are not found. `what` (of `size`) tells
// of the first place.
bool cag_surface_crosses_itself(const CagSurface *s, char *what, size_t size);
// The same of a solid's faces.
bool cag_solid_crosses_itself(const CagSolid *s, char *what, size_t size);

#endif
