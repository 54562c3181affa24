// Points of a surface on grids with unit normals.

#ifndef CAG_GEOM_SURFACE_FRAMES_H
#define CAG_GEOM_SURFACE_FRAMES_H

#include "geom/surface/surface.h"

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
