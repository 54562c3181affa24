// Integrals along curves.

#ifndef CAG_GEOM_LINE_INTEGRAL_H
#define CAG_GEOM_LINE_INTEGRAL_H

#include "geom/basis/quadrature.h"
#include "geom/curve/curve.h"

// Writes the components of the integrand at the point p. The integral must not depend on the
// parameterization: f(p, k d) = k f(p, d) for k > 0.
typedef void CagLineIntegrand(void *context, CagVec3 p, CagVec3 d, double *out);

// Integrates f over [a, b] of the curve's domain. Fails like cag_integrate. A rational curve whose
// weights differ by orders of magnitude covers most of its length within a tiny part of its domain.
// Such a curve is integrated from both ends of each piece, where parameters have the most digits.
CagStatus cag_curve_integrate(const CagCurve *c, double a, double b, CagLineIntegrand *f,
                              void *context, int parts, double tolerance, double *out,
                              CagError *err);

#endif
