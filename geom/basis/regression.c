// Least-squares fits of formulas: QR factorization of the Vandermonde matrix, with x shifted and
// scaled to -1 .. 1 so that high degrees stay well conditioned.

#include "geom/basis/regression.h"

#include <lapacke.h>
#include <math.h>

#include "base/memory.h"
#include "base/sort.h"
#include "base/stop.h"
#include "geom/linalg/dense.h"
#include "geom/linalg/tolerance.h"

// Values of x closer than this fraction of their range are equal.
#define SAME_X CAG_ROUNDING

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static CagStatus check_distinct(const double *x, size_t n, size_t needed, CagError *err) {
  double *sorted = cag_malloc(sizeof *sorted * (n + 1));
  if (!sorted) return cag_fail_memory(err);
  size_t distinct = n > 0;
  for (size_t i = 0; i < n; i++) sorted[i] = x[i];
  const CagStatus status = cag_sort(sorted, n, sizeof *sorted, ascending, err);
  for (size_t i = 1; !status && i < n; i++)
    distinct += sorted[i] - sorted[i - 1] > SAME_X * (sorted[n - 1] - sorted[0]);
  cag_free(sorted);
  if (status) return status;
  if (distinct >= needed) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_underdetermined, "points", -1,
                  "%zu coefficients need at least as many points with different x, found %zu",
                  needed, distinct);
}

// Converts coefficients of p((x - m) / h), in place, to those of powers of x: Horner's scheme on
// polynomials.
static void expand(double *c, int degree, double m, double h) {
  for (int i = 0; i <= degree; i++) c[i] /= pow(h, i);
  for (int i = 0; i < degree; i++)
    for (int k = degree - 1; k >= i; k--) c[k] -= m * c[k + 1];
}

// Least squares of a column-major matrix; the first numbers of `right` become the solution.
static CagStatus solve(double *matrix, size_t n, size_t columns, double *right, CagError *err) {
  if ((double)n * (double)columns * (double)columns > CAG_LAPACK_MOST)
    return cag_least_squares(matrix, n, columns, right, n, 1, NULL, err);
  const lapack_int info = LAPACKE_dgels(LAPACK_COL_MAJOR, 'N', (lapack_int)n, (lapack_int)columns,
                                        1, matrix, (lapack_int)n, right, (lapack_int)n);
  return info == 0 ? CAG_OK : CAG_E_DEGENERATE;
}

static CagStatus fit_polynomial(const double *x, const double *y, size_t n, int degree, double *out,
                                CagError *err) {
  const size_t columns = (size_t)degree + 1;
  CagStatus status = check_distinct(x, n, columns, err);
  if (status) return status;
  double low = x[0], high = x[0];
  for (size_t i = 1; i < n; i++) {
    low = fmin(low, x[i]);
    high = fmax(high, x[i]);
  }
  const double m = low + (high - low) / 2, h = high > low ? (high - low) / 2 : 1;
  double *matrix = cag_malloc(sizeof *matrix * n * columns), *right = cag_malloc(sizeof *right * n);
  if (!matrix || !right) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    right[i] = y[i];
    double power = 1;
    for (size_t j = 0; j < columns; j++, power *= (x[i] - m) / h) matrix[j * n + i] = power;
  }
  if (!status) status = solve(matrix, n, columns, right, err);
  if (status == CAG_E_DEGENERATE)
    status = cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_underdetermined, "points", -1,
                      "the points do not determine %zu coefficients", columns);
  for (size_t j = 0; !status && j < columns; j++) out[j] = right[j];
  if (!status) expand(out, degree, m, h);
  cag_free(matrix);
  cag_free(right);
  return status;
}

static CagStatus fail_sign(const char *what, size_t i, CagError *err) {
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_conic_domain, "points", (long)i,
                  "%s; the logarithm of `points`[%zu] is undefined", what, i);
}

// The line through the logarithms.
static CagStatus fit_logarithm(const double *x, const double *y, size_t n, bool power, double *out,
                               CagError *err) {
  double *u = cag_calloc(n + 1, sizeof *u), *v = cag_calloc(n + 1, sizeof *v);
  CagStatus status = u && v ? CAG_OK : cag_fail_memory(err);
  const double sign = n > 0 && y[0] < 0 && !power ? -1 : 1;
  for (size_t i = 0; !status && i < n; i++) {
    if (power && !(x[i] > 0 && y[i] > 0))
      status = fail_sign("a power law needs points with positive x and y", i, err);
    else if (!(sign * y[i] > 0))
      status = fail_sign("an exponential needs points whose y all have the same sign", i, err);
    else {
      u[i] = power ? log(x[i]) : x[i];
      v[i] = log(sign * y[i]);
    }
  }
  if (!status) status = fit_polynomial(u, v, n, 1, out, err);
  if (!status) out[0] = sign * exp(out[0]);
  cag_free(u);
  cag_free(v);
  return status;
}

static double value_at(CagModel model, const double *c, int degree, double x) {
  if (model == CAG_MODEL_POWER) return c[0] * pow(x, c[1]);
  if (model == CAG_MODEL_EXPONENTIAL) return c[0] * exp(c[1] * x);
  double y = c[degree];
  for (int i = degree - 1; i >= 0; i--) y = y * x + c[i];
  return y;
}

CagStatus cag_fit_formula(const double *x, const double *y, size_t n, CagModel model, int degree,
                          double *out, double *residual, CagError *err) {
  CagStatus status = model == CAG_MODEL_POLYNOMIAL
                         ? fit_polynomial(x, y, n, degree, out, err)
                         : fit_logarithm(x, y, n, model == CAG_MODEL_POWER, out, err);
  if (status) return status;
  *residual = 0;
  for (size_t i = 0; i < n; i++) {
    const double d = y[i] - value_at(model, out, degree, x[i]);
    *residual += d * d;
  }
  return CAG_OK;
}
