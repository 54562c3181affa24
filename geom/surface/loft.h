// Surfaces through curves and through grids of points: lofts, interpolation, least squares.

#ifndef CAG_GEOM_LOFT_H
#define CAG_GEOM_LOFT_H

#include "geom/surface/surface.h"

// The NURBS surface with v = i on curve i. Curves are made compatible in u over 0..1; in v a spline
// of the degree (lower where there are too few curves) passes them. Closed: v runs on from the last
// curve to the first, whose copy is v = n; the degree is then odd.
CagStatus cag_surface_loft(const CagCurve *const *curves, size_t n, int degree, bool closed,
                           CagSurface **out, CagError *err);

#endif
