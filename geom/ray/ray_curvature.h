// The curvature of exact surfaces where rays meet them.

#ifndef CAG_GEOM_RAY_RAY_CURVATURE_H
#define CAG_GEOM_RAY_RAY_CURVATURE_H

#include "geom/ray/ray.h"
#include "geom/surface/surface.h"

// The mean and the product of the principal curvatures, in 1/length and 1/length^2. The principal
// curvatures are relative to a unit normal, positive where the surface bends away from it, as a ball
// does from its outward normal.
typedef struct CagBend {
  double mean, gaussian;
} CagBend;

// The curvature of a surface at its parameters, relative to the normal on the side of `side`.
// *known is false where the surface has no normal. At a break, it is the limit from the right.
CagStatus cag_surface_bend(const CagSurface *s, double u, double v, CagVec3 side, CagBend *out,
                           bool *known, CagError *err);
// The curvature at a crossing, at the point `at`, relative to its normal. *known is false also for
// meshes and crossings that were not found by a caster.
CagStatus cag_crossing_bend(const CagCrossing *c, CagVec3 at, CagBend *out, bool *known,
                            CagError *err);

#endif
