// The place of a surface that is nearest to a point.

#ifndef CAG_GEOM_SURFACE_NEAREST_H
#define CAG_GEOM_SURFACE_NEAREST_H

#include "geom/surface/surface.h"

typedef struct CagSurfaceNearest {
  double u, v, distance;
  CagVec3 point;
} CagSurfaceNearest;

// Of several that are equally near it is one. Trimmed surfaces and regions count within their
// outlines only.
CagStatus cag_surface_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out,
                              CagError *err);

#endif
