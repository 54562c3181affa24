// Points of a surface on grids with unit normals.

#ifndef CAG_GEOM_SURFACE_FRAMES_H
#define CAG_GEOM_SURFACE_FRAMES_H

#include "geom/surface/surface.h"

// What is left of a partial that vanishes, over a unit of its parameter, where the domain has this
// length: partials are sums of points, which are rounded by their distance from the origin.
static inline double cag_partial_noise(CagVec3 point, double length) {
  const double rounding = 64 * 2.220446049250313e-16; // of the coordinates, by a few operations
  return rounding * cag_norm(point) / length;
}

// The unit normal of a surface at a point, from its partials. False: one of them vanishes or they
// are parallel, but for rounding.
bool cag_normal_of_partials(const CagSurface *s, CagVec3 point, CagVec3 du, CagVec3 dv,
                            CagVec3 *out);

// As cag_surface_eval_grid, with the unit normals along S_u x S_v; zero where the partials vanish
// or are parallel. du, dv: both or neither (NULL).
CagStatus cag_surface_eval_frames(const CagSurface *s, const double *us, size_t nu,
                                  const double *vs, size_t nv, CagVec3 *points, CagVec3 *du,
                                  CagVec3 *dv, CagVec3 *normals, CagError *err);
// The same of a NURBS, in one pass; false: it is none.
bool cag_surface_nurbs_frames(const CagSurface *s, const double *us, size_t nu, const double *vs,
                              size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv,
                              CagVec3 *normals, CagStatus *status, CagError *err);

#endif
