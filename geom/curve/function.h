// Curves defined by a function of the caller: C(t) = f(t). The function computes derivatives, too.

#ifndef CAG_GEOM_CURVE_FUNCTION_H
#define CAG_GEOM_CURVE_FUNCTION_H

#include "geom/curve/curve.h"

typedef struct CagCurveFunction {
  // Point and derivatives 1..order at t (radians if the parameter is an angle); order is at most
  // CAG_MAX_DERIVATIVE. A function that fails returns CAG_E_CALLBACK and fills err. The curve
  // rejects points that are not finite.
  CagStatus (*eval)(void *context, double t, int order, CagVec3 *out, CagError *err);
  void (*release)(void *context); // called when the last curve that uses the function is released
  void *context;
  // Adds what the function computes to a digest. NULL: nothing can be said.
  void (*digest)(void *context, CagDigest *d);
} CagCurveFunction;

// Kind "function" over [start, end]. On success the curve owns the context; on failure the caller
// keeps it.
CagStatus cag_curve_function(const CagCurveFunction *f, int dimension, double start, double end,
                             bool angular, CagCurve **out, CagError *err);

#endif
