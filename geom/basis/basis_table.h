// B-spline bases as data: values and derivatives over the whole knot vector, the triangle of lower
// degrees, polynomial pieces, and the refinement matrix of a basis.
//
// Unlike the functions that evaluate curves, these cover the whole range of the knots, including
// the ends, where fewer than degree + 1 functions are nonzero and their sum is below 1. `count` is
// the number of knots; a knot vector of degree p has count - p - 1 basis functions. 0/0 counts as
// 0.

#ifndef CAG_GEOM_BASIS_TABLE_H
#define CAG_GEOM_BASIS_TABLE_H

#include "geom/basis/knots.h"

// Index of the non-empty interval that contains t. A knot belongs to the interval before it if
// `left` is set, at the last knot, and at the end of the usable range. Fails with
// "parameter-range".
CagStatus cag_basis_interval(const double *knots, size_t count, int p, double t, bool left,
                             size_t *out, CagError *err);
// All functions of degrees 0..p at t in the interval: out[q * (count - 1) + i], i < count - 1 - q.
void cag_basis_triangle(const double *knots, size_t count, int p, size_t interval, double t,
                        double *out);
// The derivative of the given order of all functions of degree p: out[i], i < count - p - 1. work:
// (p + 2) numbers.
void cag_basis_derivative(const double *knots, size_t count, int p, size_t interval, double t,
                          int order, double *work, double *out);
// The functions that are nonzero on the interval as polynomials, in powers of t, or of t -
// knots[interval] if `local`: out[j * (p + 1) + k] is the coefficient of power k of function
// interval - p + j, j = 0..p. Functions that do not exist (index negative or too large) get 0.
void cag_basis_piece(const double *knots, size_t count, int p, size_t interval, bool local,
                     double *out);
// N_i of `knots` = sum over j of out[p][i][j] M_j of `refined` (Oslo algorithm, Cohen, Lyche,
// Riesenfeld 1980). out[q] starts at q * (count - 1) * m, with rows i < count - 1 - q of m =
// refined_count - p - 1 numbers. Fails with "not-a-refinement", "knot-multiplicity",
// "parameter-range".
CagStatus cag_basis_oslo(const double *knots, size_t count, const double *refined,
                         size_t refined_count, int p, double *out, CagError *err);

#endif
