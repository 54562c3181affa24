// Adaptive integration by the Gauss-Kronrod pair of 7 and 15 points.

#ifndef CAG_GEOM_QUADRATURE_H
#define CAG_GEOM_QUADRATURE_H

#include <stddef.h>

#include "base/status.h"

#define CAG_INTEGRAND_PARTS 10

// Writes the integrand's `parts` numbers at t.
typedef CagStatus (*CagIntegrand)(void *context, double t, double *out, CagError *err);

// Integral over the pieces cuts[0]..cuts[1], .., each smooth inside; `n` cuts. Error of every part
// at most about `tolerance` of the largest part's integral of absolute values. Kinks, cusps and
// peaks inside a piece are found by bisection. An integrand that is noise to more than the
// tolerance ends the search after some thousands of intervals.
CagStatus cag_integrate(CagIntegrand f, void *context, const double *cuts, size_t n, int parts,
                        double tolerance, double *out, CagError *err);

// Integrates over n ranges, each with its own parameter. `piece` is the index of the range that
// contains t.
typedef CagStatus (*CagPieceIntegrand)(void *context, size_t piece, double t, double *out,
                                       CagError *err);
CagStatus cag_integrate_pieces(CagPieceIntegrand f, void *context, const double (*ranges)[2],
                               size_t n, int parts, double tolerance, double *out, CagError *err);

#endif
