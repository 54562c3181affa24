// The triangular factor of a matrix of any number of rows.

#include "geom/camera/triangle.h"

#include <string.h>

#include <lapacke.h>

#include "base/stop.h"

void cag_triangle_init(CagTriangle *t, size_t columns) {
  CAG_ASSERT(columns <= CAG_TRIANGLE_COLUMNS);
  t->columns = columns;
  t->count = 0;
}

static CagStatus fail_factor(CagError *err) {
  return cag_fail(err, CAG_E_CONVERGENCE, CAG_ERR_convergence, "", -1,
                  "the singular values could not be found");
}

static CagStatus factor_rows(CagTriangle *t, CagError *err) {
  double tau[CAG_TRIANGLE_COLUMNS], work[CAG_TRIANGLE_COLUMNS * CAG_TRIANGLE_ROWS];
  double transposed[CAG_TRIANGLE_COLUMNS]
                   [CAG_TRIANGLE_ROWS]; // by columns, as LAPACK works in place
  const size_t n = t->columns;
  for (size_t i = 0; i < t->count; i++)
    for (size_t j = 0; j < n; j++) transposed[j][i] = t->rows[i][j];
  if (LAPACKE_dgeqrf_work(LAPACK_COL_MAJOR, (lapack_int)t->count, (lapack_int)n, transposed[0],
                          CAG_TRIANGLE_ROWS, tau, work, (lapack_int)(sizeof work / sizeof *work)))
    return fail_factor(err);
  if (t->count < n) memset(t->rows[t->count], 0, (n - t->count) * sizeof *t->rows);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n && i < t->count; j++) t->rows[i][j] = j < i ? 0 : transposed[j][i];
  t->count = n;
  return cag_stop_check(err) ? err->status : CAG_OK;
}

CagStatus cag_triangle_add(CagTriangle *t, const double *row, CagError *err) {
  memcpy(t->rows[t->count++], row, t->columns * sizeof *row);
  return t->count < CAG_TRIANGLE_ROWS ? CAG_OK : factor_rows(t, err);
}

CagStatus cag_triangle_finish(CagTriangle *t, CagError *err) { return factor_rows(t, err); }

CagStatus cag_triangle_singular(const CagTriangle *t, size_t n, double *values, double *vector,
                                CagError *err) {
  double a[CAG_TRIANGLE_COLUMNS * CAG_TRIANGLE_COLUMNS] = {0};
  double vt[CAG_TRIANGLE_COLUMNS * CAG_TRIANGLE_COLUMNS], unused[1];
  double work[CAG_TRIANGLE_COLUMNS * CAG_TRIANGLE_ROWS];
  for (size_t i = 0; i < n; i++)
    for (size_t j = i; j < n; j++) a[j * n + i] = t->rows[i][j];
  const lapack_int k = (lapack_int)n;
  if (LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', vector ? 'A' : 'N', k, k, a, k, values, unused, 1,
                          vt, k, work, (lapack_int)(sizeof work / sizeof *work)))
    return fail_factor(err);
  for (size_t j = 0; vector && j < n; j++) vector[j] = vt[j * n + n - 1];
  return CAG_OK;
}

void cag_triangle_solve(const CagTriangle *t, size_t n, size_t right, double *out) {
  for (size_t i = n; i-- > 0;) {
    double sum = t->rows[i][right];
    for (size_t j = i + 1; j < n; j++) sum -= t->rows[i][j] * out[j];
    out[i] = sum / t->rows[i][i];
  }
}
