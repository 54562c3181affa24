// Integrals along curves.

#ifndef CAG_GEOM_LINE_INTEGRAL_H
#define CAG_GEOM_LINE_INTEGRAL_H

#include "geom/basis/quadrature.h"
#include "geom/curve/curve.h"

// Writes the integrand's parts at the point p. The integral must not depend on the parameter:
// f(p, k d) = k f(p, d) for k > 0.
typedef void CagLineIntegrand(void *context, CagVec3 p, CagVec3 d, double *out);

// Integral of f over [a, b] of the curve's domain; errors as those of cag_integrate. Rational
// curves whose weights differ by orders of magnitude run through most of their length within a tiny
// part of their domain; they are integrated from both ends of each piece, where parameters have the
// most digits.
CagStatus cag_curve_integrate(const CagCurve *c, double a, double b, CagLineIntegrand *f,
                              void *context, int parts, double tolerance, double *out,
                              CagError *err);

#endif
