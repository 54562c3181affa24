// Functions of one variable, sampled once and kept as piecewise Chebyshev series.
//
// The interval is bisected until the series of every piece has converged; at a kink of the function
// the pieces shrink onto it. Values and derivatives are then exact for the series, and the function
// is not called again.

#ifndef CAG_GEOM_CHEBYSHEV_H
#define CAG_GEOM_CHEBYSHEV_H

#include "base/digest.h"
#include "base/status.h"
#include "geom/basis/interval.h"

// Writes the function's `parts` numbers at t.
typedef CagStatus (*CagSampled)(void *context, double t, double *out, CagError *err);

typedef struct CagChebyshev CagChebyshev;

// Highest derivative of a series.
#define CAG_CHEBYSHEV_DERIVATIVES 8

// The error of each part is at most about `tolerance` times its largest value. Errors refer to the
// argument `name`: "function-jumps" if the function is discontinuous, "not-finite".
CagStatus cag_chebyshev_fit(CagSampled f, void *context, double a, double b, int parts,
                            double tolerance, const char *name, CagChebyshev **out, CagError *err);
CagChebyshev *cag_chebyshev_retain(const CagChebyshev *c);
void cag_chebyshev_release(CagChebyshev *c); // c may be NULL
void cag_chebyshev_digest(const CagChebyshev *c, CagDigest *d);
// Taylor coefficients 0..n about t (limit from the left where `left`): out[part * (n + 1) + k].
void cag_chebyshev_series(const CagChebyshev *c, double t, bool left, int n, double *out);
// Ranges of these coefficients about all t of [a, b], which must not contain a joint of pieces; n
// <= CAG_CHEBYSHEV_DERIVATIVES.
void cag_chebyshev_ranges(const CagChebyshev *c, double a, double b, int n, CagInterval *out);
// The joints of the pieces strictly between a and b; returns their number.
size_t cag_chebyshev_joints(const CagChebyshev *c, double *out, size_t capacity);
// The parameters at which the first derivative jumps; same conventions as for the breaks of a
// curve.
size_t cag_chebyshev_breaks(const CagChebyshev *c, double *out, size_t capacity);

#endif
