// Givens rotations of single rows into a triangle.

#include "geom/linalg/givens.h"

#include <lapacke.h>
#include <math.h>

void cag_givens_add(CagGivens *t, double *row) {
  for (int i = 0; i < t->columns; i++) {
    if (row[i] == 0) continue;
    const double length = hypot(t->r[i][i], row[i]);
    const double c = t->r[i][i] / length, s = row[i] / length;
    for (int j = i; j < t->columns; j++) {
      const double old = t->r[i][j];
      t->r[i][j] = c * old + s * row[j];
      row[j] = c * row[j] - s * old;
    }
  }
}

bool cag_givens_solve(const CagGivens *t, double *x) {
  const int n = t->columns - 1;
  for (int i = n; i-- > 0;) {
    if (t->r[i][i] == 0) return false;
    x[i] = t->r[i][n];
    for (int j = i + 1; j < n; j++) x[i] -= t->r[i][j] * x[j];
    x[i] /= t->r[i][i];
  }
  return true;
}

bool cag_givens_svd(const CagGivens *t, int k, double *values, double *vectors) {
  double a[CAG_GIVENS_MOST * CAG_GIVENS_MOST], rest[CAG_GIVENS_MOST];
  double left[CAG_GIVENS_MOST * CAG_GIVENS_MOST];
  for (int i = 0; i < k; i++)
    for (int j = 0; j < k; j++) a[k * i + j] = j < i ? 0 : t->r[i][j];
  return LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'A', 'A', k, k, a, k, values, left, k, vectors, k,
                        rest) == 0;
}
