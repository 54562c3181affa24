// Curves from their natural equations: curvature and torsion as functions of the arc length.

#ifndef CAG_GEOM_CURVE_NATURAL_H
#define CAG_GEOM_CURVE_NATURAL_H

#include "geom/curve/curve.h"

typedef struct CagNaturalEquations {
  // Taylor coefficients 0..order (derivatives over factorials) of curvature and torsion at s; order
  // is below CAG_MAX_DERIVATIVE. A function that fails gives CAG_E_CALLBACK and fills err.
  CagStatus (*eval)(void *context, double s, int order, double *curvature, double *torsion,
                    CagError *err);
  void (*release)(void *context); // when the last curve that uses the equations is gone
  void *context;
} CagNaturalEquations;

// The curve with these equations over [0, length], its parameter the arc length, that starts at the
// origin of the frame along its x axis, bending toward its y axis (do Carmo 1976, section 1-5).
// Dimension 2: a plane curve, whose curvature may be negative; torsion is not asked for. Points are
// accurate to 1e-12 of the length as far as the equations are smooth; they may jump.
//
// Fails with "length-not-positive", "frame-not-orthonormal", "convergence" (100,000 steps). On
// success the curve owns the context; where the call fails it stays the caller's.
CagStatus cag_curve_natural(const CagNaturalEquations *equations, double length,
                            const CagTransform *frame, int dimension, CagCurve **out,
                            CagError *err);

#endif
