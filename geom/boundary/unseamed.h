// Faces of boundaries that were found from meshes, whose loops have no seams.

#ifndef CAG_GEOM_BOUNDARY_UNSEAMED_H
#define CAG_GEOM_BOUNDARY_UNSEAMED_H

#include "geom/boundary/boundary.h"
#include "geom/curve/region.h"

// The region of a face on a carrier of revolution in the parameters of the carrier, and its bounds u0
// u1 v0 v1. A face that goes all around is cut at an angle at which no hole is, and one around the
// pole of a sphere or the apex of a cone ends there. *out is NULL if the loops are incomplete or no
// such angle exists, or if the region does not match the mesh of the boundary.
CagStatus cag_unseamed_region(const CagBoundary *b, size_t face, CagRegion **out, double bounds[4],
                              CagError *err);

#endif
