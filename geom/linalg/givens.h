// Least squares with rows that arrive one at a time: Givens rotations into an upper triangle, which
// never squares the condition number and needs no memory per row.

#ifndef CAG_GEOM_GIVENS_H
#define CAG_GEOM_GIVENS_H

#include <stdbool.h>

#define CAG_GIVENS_MOST 10

// The triangle R of the rows so far, with `columns` columns: R^T R is the sum of their products.
typedef struct CagGivens {
  int columns;
  double r[CAG_GIVENS_MOST][CAG_GIVENS_MOST];
} CagGivens;

// Adds a row of `columns` numbers, which are overwritten.
void cag_givens_add(CagGivens *t, double *row);
// The least-squares solution x of [A | b], where b is the last column; x has columns - 1 numbers.
// Returns false if a diagonal entry is 0.
bool cag_givens_solve(const CagGivens *t, double *x);
// Singular values of the first k columns in descending order, and the right singular vectors as
// rows. Returns false if the method does not converge.
bool cag_givens_svd(const CagGivens *t, int k, double *values, double *vectors);

#endif
