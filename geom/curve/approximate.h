// Approximations of curves: cubic B-splines within a tolerance, offsets, and distances of curves.

#ifndef CAG_GEOM_APPROXIMATE_H
#define CAG_GEOM_APPROXIMATE_H

#include "geom/curve/curve.h"

// A NURBS with the same domain whose points are within the tolerance of the curve's at equal
// parameters: the exact form if there is one, else a cubic with a continuous first derivative
// between the breaks. Fails with "convergence" near parameters at which the curve has no finite
// derivative.
CagStatus cag_curve_approximate(const CagCurve *c, double tolerance, CagCurve **out, CagError *err);

// The offset of a plane curve at distance d to the left (negative: to the right). Lines, polylines,
// and circles have exact offsets, other curves within the tolerance. At corners the outer side is
// joined by an arc (for polylines: extended to the intersection of the two lines), and the inner
// side is trimmed where its parts intersect. If d exceeds the radius of curvature, the offset has
// cusps and crosses itself; these parts are kept. Fails with "not-planar", "offset-collapses" (a
// circle of radius d), "offset-corner" (parts at an inner corner that do not intersect).
CagStatus cag_curve_offset(const CagCurve *c, double d, double tolerance, CagCurve **out,
                           CagError *err);

// Largest distance of points at equal parameters, with b's domain mapped to a's; from samples
// between all breaks, refined.
CagStatus cag_curve_deviation(const CagCurve *a, const CagCurve *b, double *out, CagError *err);

// Point and first derivative at t.
typedef CagStatus (*CagCurveSampler)(void *context, double t, CagSide side, CagVec3 out[2],
                                     CagError *err);
// A cubic within the tolerance of the sampled points over cuts[0] .. cuts[n - 1], smooth between
// the cuts.
CagStatus cag_curve_fit_sampler(CagCurveSampler f, void *context, const double *cuts, size_t n,
                                double tolerance, int dimension, CagCurve **out, CagError *err);

#endif
