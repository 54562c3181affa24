// Trimmed surfaces: the part of a surface within a region of its parameter plane.
//
// The loops of the region are curves [u, v] in the surface's own parameters (radians if these are
// angles), which an exporter writes as trimming curves. The rectangle of parameters is the region's
// box; points of it outside the region can be evaluated but do not belong to the surface.

#ifndef CAG_GEOM_SURFACE_TRIMMED_H
#define CAG_GEOM_SURFACE_TRIMMED_H

#include "geom/surface/surface.h"

// Fails with "curve-outside" if the region leaves the domain, "already-trimmed".
CagStatus cag_surface_trimmed(const CagSurface *inner, const CagRegion *region, CagSurface **out,
                              CagError *err);
// The whole surface and the region; false: another kind.
bool cag_surface_trimmed_view(const CagSurface *s, const CagSurface **inner,
                              const CagRegion **region);

// The implementations for trimmed surfaces of the queries in surface.h. Integrals use Green's
// theorem along the loops.
CagStatus cag_trimmed_area(const CagSurface *s, double *area, CagVec3 *centroid, CagError *err);
CagStatus cag_trimmed_volume_terms(const CagSurface *s, double terms[10], CagError *err);
CagStatus cag_trimmed_bounds(const CagSurface *s, CagBounds *out, CagError *err);
CagStatus cag_trimmed_flip(const CagSurface *s, CagSurface **out, CagError *err);
CagStatus cag_trimmed_transpose(const CagSurface *s, CagSurface **out, CagError *err);
// The offset of the whole surface, trimmed by the same region.
CagStatus cag_trimmed_offset(const CagSurface *s, double d, CagSurface **out, CagError *err);
// Loop number i as a space curve, with the loop's parameter.
CagStatus cag_trimmed_loop(const CagSurface *s, size_t i, CagCurve **out, CagError *err);

#endif
