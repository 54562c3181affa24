// Curves near other curves: cubic B-splines within a tolerance, offsets, and how far two curves are
// apart.

#ifndef CAG_GEOM_APPROXIMATE_H
#define CAG_GEOM_APPROXIMATE_H

#include "geom/curve/curve.h"

// A NURBS with the same domain whose points are within the tolerance of the curve's, parameter for
// parameter: the exact one where there is one, else a cubic with continuous first derivative
// between the breaks. Fails with "convergence" near places where the curve has no finite
// derivative.
CagStatus cag_curve_approximate(const CagCurve *c, double tolerance, CagCurve **out, CagError *err);

// The curve at the distance d to the left of a plane curve (negative: to the right). Lines,
// polylines and circles have it exactly, others within the tolerance. At corners the outer side
// goes around in an arc (of polylines: to the corner of the two lines), and the inner side is cut
// where its parts meet. Where d is more than the radius of curvature the offset turns back in
// cusps, and crosses itself: these parts are kept. Fails with "not-planar", "offset-collapses" (a
// circle of radius d), "offset-corner" (parts at an inner corner that do not meet).
CagStatus cag_curve_offset(const CagCurve *c, double d, double tolerance, CagCurve **out,
                           CagError *err);

// Largest distance of points of equal parameters, b's domain mapped to a's; from samples between
// all breaks, refined.
CagStatus cag_curve_deviation(const CagCurve *a, const CagCurve *b, double *out, CagError *err);

// Point and first derivative at t.
typedef CagStatus (*CagCurveSampler)(void *context, double t, CagSide side, CagVec3 out[2],
                                     CagError *err);
// Cubic within the tolerance of the sampled points over cuts[0] .. cuts[n - 1], smooth between.
CagStatus cag_curve_fit_sampler(CagCurveSampler f, void *context, const double *cuts, size_t n,
                                double tolerance, int dimension, CagCurve **out, CagError *err);

#endif
