// Functions of one variable, sampled once and kept as piecewise Chebyshev series.
//
// The interval is halved until the series of every piece has died away; where the function has a
// kink the pieces shrink onto it. Values and derivatives are then exact ones of the series, and the
// function is not called any more.

#ifndef CAG_GEOM_CHEBYSHEV_H
#define CAG_GEOM_CHEBYSHEV_H

#include "base/status.h"
#include "geom/basis/interval.h"

// Writes the function's `parts` numbers at t.
typedef CagStatus (*CagSampled)(void *context, double t, double *out, CagError *err);

typedef struct CagChebyshev CagChebyshev;

// Highest derivative that a series gives.
#define CAG_CHEBYSHEV_DERIVATIVES 8

// Error of each part at most about `tolerance` of its largest value. `name` is the argument that
// errors name: "function-jumps" where the function is not continuous, "not-finite".
CagStatus cag_chebyshev_fit(CagSampled f, void *context, double a, double b, int parts,
                            double tolerance, const char *name, CagChebyshev **out, CagError *err);
CagChebyshev *cag_chebyshev_retain(const CagChebyshev *c);
void cag_chebyshev_release(CagChebyshev *c); // NULL is fine
// Taylor coefficients 0..n about t (limit from the left where `left`): out[part * (n + 1) + k].
void cag_chebyshev_series(const CagChebyshev *c, double t, bool left, int n, double *out);
// Ranges of these coefficients about all t of [a, b], which has no end of a piece inside;
// n <= CAG_CHEBYSHEV_DERIVATIVES.
void cag_chebyshev_ranges(const CagChebyshev *c, double a, double b, int n, CagInterval *out);
// The ends of the pieces between a and b; returns their number.
size_t cag_chebyshev_joints(const CagChebyshev *c, double *out, size_t capacity);
// Where the first derivative jumps; as of curves.
size_t cag_chebyshev_breaks(const CagChebyshev *c, double *out, size_t capacity);

#endif
