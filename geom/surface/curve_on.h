// Curves on surfaces: S(x(t), y(t)) for a plane curve [x, y] in the parameter plane of S.

#ifndef CAG_GEOM_SURFACE_CURVE_ON_H
#define CAG_GEOM_SURFACE_CURVE_ON_H

#include "geom/surface/surface.h"

// Kind "on surface", with the parameter and domain of c. In a closed direction of the surface, c
// may go around any number of times; in other directions it must stay in the domain:
// "curve-outside". Angles of the surface are radians in c. Fails with "not-planar" if c is not a
// plane curve.
CagStatus cag_curve_on_surface(const CagSurface *s, const CagCurve *c, CagCurve **out,
                               CagError *err);

#endif
