// Least squares of any number of rows: the triangular factor R of a matrix whose rows are added one
// by one (sequential QR, Golub and Van Loan 2013, section 6.5.3). The memory does not grow with the
// rows.

#ifndef CAG_GEOM_CAMERA_TRIANGLE_H
#define CAG_GEOM_CAMERA_TRIANGLE_H

#include <stddef.h>

#include "base/status.h"

#define CAG_TRIANGLE_COLUMNS 12
// Rows that are collected before they are factored.
#define CAG_TRIANGLE_ROWS 96

typedef struct CagTriangle {
  size_t columns, count; // count: collected rows, with those of R above them
  double rows[CAG_TRIANGLE_ROWS][CAG_TRIANGLE_COLUMNS];
} CagTriangle;

void cag_triangle_init(CagTriangle *t, size_t columns);
// Adds a row of `columns` numbers.
CagStatus cag_triangle_add(CagTriangle *t, const double *row, CagError *err);
// Factors what was added: rows[0 .. columns) become R, with zeros below the diagonal.
CagStatus cag_triangle_finish(CagTriangle *t, CagError *err);
// The singular values of the first n columns of a finished triangle, in descending order, and the
// right singular vector of the smallest one (NULL: not needed), a unit vector.
CagStatus cag_triangle_singular(const CagTriangle *t, size_t n, double *values, double *vector,
                                CagError *err);
// Solves for the coefficients of the first n columns that approximate column `right` best. The
// columns must be independent.
void cag_triangle_solve(const CagTriangle *t, size_t n, size_t right, double *out);

#endif
