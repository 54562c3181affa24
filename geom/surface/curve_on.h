// Curves on surfaces: S(x(t), y(t)) of a plane curve [x, y] in the parameter plane of S.

#ifndef CAG_GEOM_SURFACE_CURVE_ON_H
#define CAG_GEOM_SURFACE_CURVE_ON_H

#include "geom/surface/surface.h"

// Kind "on surface", with the parameter and domain of c. Along a direction in which the surface is
// closed c may go round any number of times; along others it stays in the domain: "curve-outside".
// Angles of the surface are radians of c. "not-planar" where c is no plane curve.
CagStatus cag_curve_on_surface(const CagSurface *s, const CagCurve *c, CagCurve **out,
                               CagError *err);

#endif
