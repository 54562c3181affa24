// Points and unit normals of a surface on grids.

#ifndef CAG_GEOM_SURFACE_FRAMES_H
#define CAG_GEOM_SURFACE_FRAMES_H

#include "geom/surface/surface.h"

// Rounding error of a partial that vanishes, per unit of its parameter, for a domain of this
// length. Partials are sums of points, so rounding is relative to their distance from the origin.
static inline double cag_partial_noise(CagVec3 point, double length) {
  const double rounding = 64 * 2.220446049250313e-16; // relative to the coordinates, after a few
                                                      // operations
  return rounding * cag_norm(point) / length;
}

// The unit normal of a surface at a point, from its partials. Returns false if one of them vanishes
// or they are parallel, up to rounding.
bool cag_normal_of_partials(const CagSurface *s, CagVec3 point, CagVec3 du, CagVec3 dv,
                            CagVec3 *out);

// Like cag_surface_eval_grid, with the unit normals along S_u x S_v; zero where the partials vanish
// or are parallel. du, dv: both or neither (NULL).
CagStatus cag_surface_eval_frames(const CagSurface *s, const double *us, size_t nu,
                                  const double *vs, size_t nv, CagVec3 *points, CagVec3 *du,
                                  CagVec3 *dv, CagVec3 *normals, CagError *err);
// The same for a NURBS surface, in one pass. Returns false for other surfaces.
bool cag_surface_nurbs_frames(const CagSurface *s, const double *us, size_t nu, const double *vs,
                              size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                              CagVec3 *normals, CagStatus *status, CagError *err);

#endif
