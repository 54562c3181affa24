// Curves from their natural equations: curvature and torsion as functions of the arc length.

#ifndef CAG_GEOM_CURVE_NATURAL_H
#define CAG_GEOM_CURVE_NATURAL_H

#include "geom/curve/curve.h"

typedef struct CagNaturalEquations {
  // Taylor coefficients 0..order (derivatives over factorials) of curvature and torsion at s; order
  // is below CAG_MAX_DERIVATIVE. A function that fails returns CAG_E_CALLBACK and fills err.
  CagStatus (*eval)(void *context, double s, int order, double *curvature, double *torsion,
                    CagError *err);
  void (*release)(void *context); // called when the last curve that uses the equations is released
  void *context;
} CagNaturalEquations;

// The curve with these equations over [0, length], parametrized by arc length. It starts at the
// origin of the frame along its x axis, bending toward its y axis (do Carmo 1976, section 1-5).
// Dimension 2: a plane curve, whose curvature may be negative; torsion is not used. Points are
// accurate to 1e-12 of the length if the equations are smooth; jumps are allowed.
//
// Fails with "length-not-positive", "frame-not-orthonormal", "convergence" (100,000 steps). On
// success the curve owns the context; on failure the caller keeps it.
CagStatus cag_curve_natural(const CagNaturalEquations *equations, double length,
                            const CagTransform *frame, int dimension, CagCurve **out,
                            CagError *err);

#endif
