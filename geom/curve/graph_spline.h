// Curves through or near points of a graph, y as a function of x: [x, y] with increasing x.
//
// Every curve is a plane B-spline of degree 3 whose parameter is x.

#ifndef CAG_GEOM_GRAPH_SPLINE_H
#define CAG_GEOM_GRAPH_SPLINE_H

#include "geom/curve/curve.h"

// Slopes at n >= 2 points (x, y). Fails with "too-few-points" and "bad-parameter-length" if x does
// not increase.

// Monotone between any two points where the data are (Fritsch and Butland 1984; the ends by the
// three-point formula, limited).
CagStatus cag_pchip_slopes(const double *x, const double *y, size_t n, double *out, CagError *err);
// Weighted by the changes of slope, so that one outlier has little effect (Akima 1970).
CagStatus cag_akima_slopes(const double *x, const double *y, size_t n, double *out, CagError *err);

// The interpolating curves with these slopes; points have z = 0.
CagStatus cag_curve_pchip(const CagVec3 *points, size_t n, CagCurve **out, CagError *err);
CagStatus cag_curve_akima(const CagVec3 *points, size_t n, CagCurve **out, CagError *err);

typedef enum CagSmoothing {
  CAG_SMOOTHING_AUTO,     // minimizes the generalized cross-validation (Craven and Wahba 1979)
  CAG_SMOOTHING_WEIGHT,   // `value` is the weight of the integral
  CAG_SMOOTHING_DEVIATION // the smoothest curve whose distance in y from each point is at most
                          // `value`
} CagSmoothing;

// The natural cubic spline f that minimizes the sum of (y - f(x))^2 plus a weight times the integral
// of f''^2 (Reinsch 1967).
CagStatus cag_curve_smoothing(const CagVec3 *points, size_t n, CagSmoothing by, double value,
                              CagCurve **out, CagError *err);

#endif
