// Lines of curvature: curves on a surface that follow one of its principal directions.

#ifndef CAG_GEOM_MEET_CURVATURE_LINE_H
#define CAG_GEOM_MEET_CURVATURE_LINE_H

#include "geom/surface/surface.h"

// The principal curvatures, k[0] <= k[1], signed by the normal along S_u x S_v, and the principal
// directions as unit vectors a S_u + b S_v with (a, b) in `step`. *found is false if the surface
// has no normal, or at an umbilic, where both curvatures are equal (k is still set) and there are
// no unique directions.
typedef struct CagPrincipal {
  CagVec3 point;
  double k[2];
  CagVec3 direction[2];
  double step[2][2];
} CagPrincipal;
CagStatus cag_surface_principal(const CagSurface *s, double u, double v, bool *found,
                                CagPrincipal *out, CagError *err);

// The line of the larger (`larger`) or smaller principal curvature through a point, extended in
// both directions until it closes, leaves the surface, or reaches an umbilic. It passes straight
// over a pole of the parametrization if the surface is smooth there and the line leads right into
// the pole. Fails with "umbilic" if the point is an umbilic. Exact if the line is a straight line
// or an arc of a conic; else cubics, accurate to about 1e-8 of its size.
CagStatus cag_surface_curvature_line(const CagSurface *s, double u, double v, bool larger,
                                     CagCurve **out, CagError *err);

#endif
