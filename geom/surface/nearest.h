// The point of a surface nearest to a given point.

#ifndef CAG_GEOM_SURFACE_NEAREST_H
#define CAG_GEOM_SURFACE_NEAREST_H

#include "geom/surface/surface.h"

typedef struct CagSurfaceNearest {
  double u, v, distance;
  CagVec3 point;
} CagSurfaceNearest;

// One of several equally near points. Only the part of a trimmed surface or region within its
// outlines counts.
CagStatus cag_surface_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out,
                              CagError *err);

#endif
