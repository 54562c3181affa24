// B-spline basis functions over a knot vector, and the Bezier pieces of a B-spline.
//
// On a span only the p + 1 functions N[span - p] .. N[span] are nonzero.

#ifndef CAG_GEOM_BSPLINE_H
#define CAG_GEOM_BSPLINE_H

#include "geom/basis/bernstein.h"
#include "geom/basis/knots.h"

// out[j] = N[span - p + j](t), j = 0..p.
void cag_bspline_basis(const double *knots, int p, size_t span, double t, double *out);
// out[k * (p + 1) + j] = k-th derivative of N[span - p + j] at t, k = 0..order; 0 above the degree.
void cag_bspline_derivatives(const double *knots, int p, size_t span, double t, int order,
                             double *out);
// The Bezier points (p + 1 times 4 numbers) of the curve over [knots[span], knots[span + 1]].
void cag_bspline_piece(const double *homogeneous, const double *knots, int p, size_t span,
                       double *out);
// Value and derivatives 0..order (4 numbers each) at t of the piece over [knots[span], knots[span +
// 1]]. The derivatives are evaluated as splines over the differences of the control points. This is
// usually no more accurate than differentiating the Bezier piece, but it keeps its digits if the
// piece is much shorter than its neighbors.
void cag_bspline_piece_derivatives(const double *homogeneous, const double *knots, int p,
                                   size_t span, double t, int order, double *out);
// Inserts the knot t of the usable range once (Boehm 1980). n points become n + 1, and the n + p +
// 1 knots one more; both arrays must have room.
void cag_bspline_insert(double *homogeneous, double *knots, size_t n, int p, double t);
// The knots of the same splines in degree p + 1: the multiplicity of each grows by one. Returns
// their number; `out` needs room for twice the given n + p + 1 knots.
size_t cag_bspline_elevated_knots(const double *knots, size_t n, int p, double *out);
// Control points over the elevated knots, from n points of `width` numbers over clamped knots.
// Averages points of refined curves (discrete B-splines). Fails with "interrupted", or without
// memory.
CagStatus cag_bspline_elevate(const double *points, size_t width, const double *knots, size_t n,
                              int p, const double *elevated, double *out, CagError *err);

#endif
