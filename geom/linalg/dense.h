// Linear algebra that can be canceled: every function here calls cag_stop_check at least once per
// few hundred thousand operations. LAPACK does not, so it is used only for systems of up to a few
// million operations (CAG_LAPACK_MOST); larger ones are solved here.
//
// Matrices are dense, stored by rows or by columns as stated for each function.

#ifndef CAG_GEOM_DENSE_H
#define CAG_GEOM_DENSE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

// Maximum number of multiplications for which LAPACK is called: some hundredths of a second.
#define CAG_LAPACK_MOST 2e7

// Replaces the n x n matrix `a`, by rows, by L and U of P a = L U (L has a unit diagonal), with
// partial pivoting. At step k, row k was exchanged with row pivots[k]. Sets *singular if a pivot
// is 0; the factors are then useless.
CagStatus cag_lu_factor(double *a, size_t n, size_t *pivots, bool *singular, CagError *err);

// Replaces b, n rows of `columns` numbers, by the solution of a x = b.
CagStatus cag_lu_solve(const double *lu, size_t n, const size_t *pivots, double *b, size_t columns,
                       CagError *err);

// Estimates the reciprocal of the condition number in the 1-norm (Higham 1988); `norm` is the
// 1-norm of the matrix before it was factored.
CagStatus cag_lu_condition(const double *lu, size_t n, const size_t *pivots, double norm,
                           double *out, CagError *err);

// Least squares by Householder reflections. `a` has `rows` x `columns` numbers, by columns, and
// becomes R in its upper triangle. `right` has `sides` columns of `room` >= max(rows, columns)
// numbers; the first `columns` numbers of each become the solution.
//
// Without `cut`, the columns must be independent, and rows >= columns; the caller checks the
// diagonal of R. Otherwise columns are pivoted, diagonal entries of R below `cut` times the largest
// count as 0, and the solution is the one of minimum norm.
CagStatus cag_least_squares(double *a, size_t rows, size_t columns, double *right, size_t room,
                            size_t sides, const double *cut, CagError *err);

// Solves a banded system by Gaussian elimination with partial pivoting. Entry (i, j) of the n x n
// matrix is band[j * (2 kl + ku + 1) + kl + ku + i - j] (LAPACK's layout); `right` has `sides`
// columns of n numbers, which become the solution. Sets *singular if a pivot is 0.
CagStatus cag_band_solve(double *band, size_t n, size_t kl, size_t ku, double *right, size_t sides,
                         bool *singular, CagError *err);

// Eigenvalues in ascending order, and unit eigenvectors as the rows of `a`, of the symmetric n x n
// matrix `a`: tridiagonal form, then the QL method with implicit shifts (Martin and Wilkinson
// 1968). CAG_E_CONVERGENCE if the method does not converge.
CagStatus cag_symmetric_eigen(double *a, size_t n, double *values, CagError *err);

#endif
