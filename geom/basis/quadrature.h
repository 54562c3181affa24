// Adaptive integration with the Gauss-Kronrod pair of 7 and 15 points.

#ifndef CAG_GEOM_QUADRATURE_H
#define CAG_GEOM_QUADRATURE_H

#include <stddef.h>

#include "base/status.h"

#define CAG_INTEGRAND_PARTS 14

// Writes the integrand's `parts` numbers at t.
typedef CagStatus (*CagIntegrand)(void *context, double t, double *out, CagError *err);

// Integral over the n - 1 pieces cuts[0]..cuts[1], ..; the integrand should be smooth inside each.
// The error of every part is at most about `tolerance` times the largest integral of the absolute
// value of a part. Kinks, cusps, and peaks inside a piece are located by bisection. If the
// integrand's noise exceeds the tolerance, the search stops after some thousands of intervals.
CagStatus cag_integrate(CagIntegrand f, void *context, const double *cuts, size_t n, int parts,
                        double tolerance, double *out, CagError *err);

// Integrates over n ranges, each with its own parameter. `piece` is the index of the range.
typedef CagStatus (*CagPieceIntegrand)(void *context, size_t piece, double t, double *out,
                                       CagError *err);
CagStatus cag_integrate_pieces(CagPieceIntegrand f, void *context, const double (*ranges)[2],
                               size_t n, int parts, double tolerance, double *out, CagError *err);

#endif
