// Linear systems that can be canceled: LU with partial pivoting, by panels of rows that stay in the
// cache, and Gaussian elimination of banded matrices.

#include "geom/linalg/dense.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

// Pivot rows of a panel.
#define PANEL ((size_t)32)
// Columns of right-hand sides that are solved together.
#define STRIP ((size_t)256)
// Operations between checks of the stop flag.
#define WORK_BETWEEN_LOOKS ((size_t)1 << 18)

static void swap_rows(double *a, double *b, size_t n) {
  for (size_t j = 0; j < n; j++) {
    const double x = a[j];
    a[j] = b[j];
    b[j] = x;
  }
}

static inline void subtract(double *restrict x, double factor, const double *restrict y, size_t n) {
  for (size_t j = 0; j < n; j++) x[j] -= factor * y[j];
}

// Factors columns from .. to of the rows from `from` on; exchanges whole rows.
static CagStatus factor_panel(double *a, size_t n, size_t from, size_t to, size_t *pivots,
                              bool *singular, CagError *err) {
  for (size_t k = from; k < to; k++) {
    size_t best = k;
    for (size_t i = k + 1; i < n; i++)
      if (fabs(a[i * n + k]) > fabs(a[best * n + k])) best = i;
    pivots[k] = best;
    if (best != k) swap_rows(a + k * n, a + best * n, n);
    const double pivot = a[k * n + k];
    if (pivot == 0) {
      *singular = true;
      continue;
    }
    for (size_t i = k + 1; i < n; i++) {
      double *row = a + i * n;
      row[k] /= pivot;
      if (row[k] != 0) subtract(row + k + 1, row[k], a + k * n + k + 1, to - k - 1);
    }
    if (cag_stop_check(err)) return err->status;
  }
  return CAG_OK;
}

CagStatus cag_lu_factor(double *a, size_t n, size_t *pivots, bool *singular, CagError *err) {
  *singular = false;
  for (size_t from = 0; from < n; from += PANEL) {
    const size_t to = n - from < PANEL ? n : from + PANEL, rest = n - to;
    CagStatus status = factor_panel(a, n, from, to, pivots, singular, err);
    if (status) return status;
    // First the panel's rows of U to its right, then all rows below.
    for (size_t i = from + 1; i < n; i++) {
      double *row = a + i * n;
      for (size_t k = from; k < to && k < i; k++)
        if (row[k] != 0) subtract(row + to, row[k], a + k * n + to, rest);
      if (cag_stop_check(err)) return err->status;
    }
  }
  return CAG_OK;
}

CagStatus cag_lu_solve(const double *lu, size_t n, const size_t *pivots, double *b, size_t columns,
                       CagError *err) {
  for (size_t k = 0; k < n; k++)
    if (pivots[k] != k) swap_rows(b + k * columns, b + pivots[k] * columns, columns);
  for (size_t from = 0; from < columns; from += STRIP) {
    const size_t width = columns - from < STRIP ? columns - from : STRIP;
    double *x = b + from;
    for (size_t i = 0; i < n; i++) {
      for (size_t k = 0; k < i; k++)
        subtract(x + i * columns, lu[i * n + k], x + k * columns, width);
      if (cag_stop_check(err)) return err->status;
    }
    for (size_t i = n; i-- > 0;) {
      for (size_t k = i + 1; k < n; k++)
        subtract(x + i * columns, lu[i * n + k], x + k * columns, width);
      for (size_t j = 0; j < width; j++) x[i * columns + j] /= lu[i * n + i];
      if (cag_stop_check(err)) return err->status;
    }
  }
  return CAG_OK;
}

// Replaces x by the solution of the transposed system: U^T, then L^T, then the exchanges backwards.
static CagStatus solve_transposed(const double *lu, size_t n, const size_t *pivots, double *x,
                                  CagError *err) {
  for (size_t i = 0; i < n; i++) {
    x[i] /= lu[i * n + i];
    subtract(x + i + 1, x[i], lu + i * n + i + 1, n - i - 1);
    if (i % STRIP == 0 && cag_stop_check(err)) return err->status;
  }
  for (size_t i = n; i-- > 0;) {
    subtract(x, x[i], lu + i * n, i);
    if (i % STRIP == 0 && cag_stop_check(err)) return err->status;
  }
  for (size_t k = n; k-- > 0;)
    if (pivots[k] != k) swap_rows(x + k, x + pivots[k], 1);
  return CAG_OK;
}

static double sum_of_sizes(const double *x, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += fabs(x[i]);
  return sum;
}

CagStatus cag_lu_condition(const double *lu, size_t n, const size_t *pivots, double norm,
                           double *out, CagError *err) {
  enum { STEPS_MOST = 5 };
  double *x = cag_malloc(2 * n * sizeof *x), *z = x ? x + n : NULL, largest = 0;
  if (!x) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < n; i++) x[i] = 1 / (double)n;
  // Approaches the column of the inverse with the largest norm along the gradient of the norm.
  for (int step = 0; !status && step < STEPS_MOST; step++) {
    status = cag_lu_solve(lu, n, pivots, x, 1, err);
    if (status) break;
    const double size = sum_of_sizes(x, n);
    if (step > 0 && size <= largest) break;
    largest = size;
    for (size_t i = 0; i < n; i++) z[i] = x[i] < 0 ? -1 : 1;
    status = solve_transposed(lu, n, pivots, z, err);
    size_t best = 0;
    for (size_t i = 1; i < n; i++)
      if (fabs(z[i]) > fabs(z[best])) best = i;
    memset(x, 0, n * sizeof *x);
    x[best] = 1;
  }
  // Higham's alternative vector, for matrices on which the above underestimates badly.
  for (size_t i = 0; i < n; i++)
    x[i] = (i % 2 ? -1 : 1) * (1 + (double)i / (double)(n > 1 ? n - 1 : 1));
  if (!status) status = cag_lu_solve(lu, n, pivots, x, 1, err);
  if (!status) largest = fmax(largest, 2 * sum_of_sizes(x, n) / (3 * (double)n));
  *out = largest > 0 && isfinite(largest) && norm > 0 ? 1 / largest / norm : 0;
  cag_free(x);
  return status;
}

// --- Banded matrices ---

// Eliminates column k below its pivot. `last` is the last column that row exchanges have reached.
static bool eliminate(double *column, size_t k, size_t below, size_t ld, size_t *last, size_t ku,
                      size_t n, double *right, size_t sides) {
  size_t best = 0;
  for (size_t i = 1; i <= below; i++)
    if (fabs(column[i]) > fabs(column[best])) best = i;
  if (column[best] == 0) return false;
  const size_t reach = k + ku + best < n ? k + ku + best : n - 1;
  if (reach > *last) *last = reach;
  // One row further, an entry of the next column is ld - 1 later.
  for (size_t j = 0; best > 0 && j <= *last - k; j++) {
    double *entry = column + j * (ld - 1), x = entry[0];
    entry[0] = entry[best];
    entry[best] = x;
  }
  const double inverse = 1 / column[0];
  for (size_t i = 1; i <= below; i++) column[i] *= inverse;
  for (size_t j = 1; j <= *last - k; j++) {
    double *entry = column + j * (ld - 1);
    if (entry[0] != 0) subtract(entry + 1, entry[0], column + 1, below);
  }
  for (size_t s = 0; s < sides; s++) {
    double *x = right + s * n + k, y = x[0];
    x[0] = x[best];
    x[best] = y;
    subtract(x + 1, x[0], column + 1, below);
  }
  return true;
}

CagStatus cag_band_solve(double *band, size_t n, size_t kl, size_t ku, double *right, size_t sides,
                         bool *singular, CagError *err) {
  const size_t ld = 2 * kl + ku + 1, diagonal = kl + ku;
  const size_t look = WORK_BETWEEN_LOOKS / ((kl + 1) * (diagonal + sides + 1)) + 1;
  size_t last = 0;
  *singular = false;
  for (size_t k = 0; k < n; k++) {
    const size_t below = n - 1 - k < kl ? n - 1 - k : kl;
    if (k % look == 0 && cag_stop_check(err)) return err->status;
    if (!eliminate(band + k * ld + diagonal, k, below, ld, &last, ku, n, right, sides)) {
      *singular = true;
      return CAG_OK;
    }
  }
  for (size_t k = n; k-- > 0;) {
    const size_t above = k < diagonal ? k : diagonal;
    const double *column = band + k * ld + diagonal;
    if (k % look == 0 && cag_stop_check(err)) return err->status;
    for (size_t s = 0; s < sides; s++) {
      double *x = right + s * n + k;
      x[0] /= column[0];
      subtract(x - above, x[0], column - above, above);
    }
  }
  return CAG_OK;
}
