// Lines of curvature: curves on a surface that follow one of its principal directions.

#ifndef CAG_GEOM_MEET_CURVATURE_LINE_H
#define CAG_GEOM_MEET_CURVATURE_LINE_H

#include "geom/surface/surface.h"

// The principal curvatures, k[0] <= k[1], signed by the normal along S_u x S_v, and their
// directions as unit vectors a S_u + b S_v with (a, b) in `step`. False where the surface has no
// normal, or both are one (an umbilic; k is set then) and no direction is singled out.
typedef struct CagPrincipal {
  CagVec3 point;
  double k[2];
  CagVec3 direction[2];
  double step[2][2];
} CagPrincipal;
CagStatus cag_surface_principal(const CagSurface *s, double u, double v, bool *found,
                                CagPrincipal *out, CagError *err);

// The line of the larger (`larger`) or smaller principal curvature through a place, to both sides
// until it comes back, leaves the surface, or meets an umbilic. A pole of the parameters where the
// surface is smooth it passes over, straight on, if it leads right into it. Fails with "umbilic"
// where the place is one. Exact where it is a line or an arc of a conic; else cubics, to about 1e-8
// of its size.
CagStatus cag_surface_curvature_line(const CagSurface *s, double u, double v, bool larger,
                                     CagCurve **out, CagError *err);

#endif
