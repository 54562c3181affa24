// Bounds of the derivatives of a curve over an interval.

#ifndef CAG_GEOM_CURVE_RANGE_H
#define CAG_GEOM_CURVE_RANGE_H

#include "geom/basis/interval.h"
#include "geom/curve/curve.h"

// Ranges of the Taylor coefficients 0..n (the k-th derivative over k!) about every parameter of [a,
// b], which must not contain a break. Returns false if the kind of curve provides only points, or
// if the weights may vanish.
bool cag_curve_ranges(const CagCurve *c, double a, double b, int n, CagInterval3 *out);

#endif
