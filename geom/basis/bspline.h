// B-spline basis functions over a knot vector, and the Bezier pieces of a B-spline.
//
// Over a span only the p + 1 functions N[span - p] .. N[span] are not zero.

#ifndef CAG_GEOM_BSPLINE_H
#define CAG_GEOM_BSPLINE_H

#include "geom/basis/bernstein.h"
#include "geom/basis/knots.h"

// out[j] = N[span - p + j](t), j = 0..p.
void cag_bspline_basis(const double *knots, int p, size_t span, double t, double *out);
// out[k * (p + 1) + j] = k-th derivative of N[span - p + j] at t, k = 0..order; 0 above the degree.
void cag_bspline_derivatives(const double *knots, int p, size_t span, double t, int order,
                             double *out);
// Bezier points (p + 1 times 4 numbers) of the curve over [knots[span], knots[span + 1]].
void cag_bspline_piece(const double *homogeneous, const double *knots, int p, size_t span,
                       double *out);
// Value and derivatives 0..order (4 numbers each) at t of the piece over [knots[span],
// knots[span + 1]]. The derivatives are those of the splines of the differences of the control
// points: no more exact than those of a Bezier piece as a rule, but they keep their digits where
// the piece is much shorter than its neighbors.
void cag_bspline_piece_derivatives(const double *homogeneous, const double *knots, int p,
                                   size_t span, double t, int order, double *out);
// Inserts knot t of the usable range once (Boehm 1980): n points become n + 1, n + p + 1 knots one
// more; both arrays have the room.
void cag_bspline_insert(double *homogeneous, double *knots, size_t n, int p, double t);
// The knots of the same splines in degree p + 1: each occurs once more. Returns how many there are;
// `out` has room for twice as many as the n + p + 1 given ones.
size_t cag_bspline_elevated_knots(const double *knots, size_t n, int p, double *out);
// The points over the elevated knots of n points of `width` numbers over clamped ones (mean of
// points of refined curves, by discrete B-splines). Fails with "interrupted", or without memory.
CagStatus cag_bspline_elevate(const double *points, size_t width, const double *knots, size_t n,
                              int p, const double *elevated, double *out, CagError *err);

#endif
