// Curves by a function of the caller: C(t) = f(t), with derivatives that the function computes too.

#ifndef CAG_GEOM_CURVE_FUNCTION_H
#define CAG_GEOM_CURVE_FUNCTION_H

#include "geom/curve/curve.h"

typedef struct CagCurveFunction {
  // Point and derivatives 1..order at t (radians where the parameter is an angle); order is at most
  // CAG_MAX_DERIVATIVE. A function that fails gives CAG_E_CALLBACK and fills err; points that are
  // not finite are found by the curve.
  CagStatus (*eval)(void *context, double t, int order, CagVec3 *out, CagError *err);
  void (*release)(void *context); // when the last curve that uses the function is gone
  void *context;
} CagCurveFunction;

// Kind "function" over [start, end]. On success the curve owns the context; where the call fails it
// stays the caller's.
CagStatus cag_curve_function(const CagCurveFunction *f, int dimension, double start, double end,
                             bool angular, CagCurve **out, CagError *err);

#endif
