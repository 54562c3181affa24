// B-spline bases as data. Everything is evaluated on one non-empty interval, on which a function of
// degree q is nonzero if its index is interval - q .. interval.

#include "geom/basis/basis_table.h"

#include <string.h>

#include "geom/basis/bernstein.h"

CagStatus cag_basis_interval(const double *knots, size_t count, int p, double t, bool left,
                             size_t *out, CagError *err) {
  const size_t last = count - 1, end = count - 1 - (size_t)p;
  char a[32], b[32], x[32];
  if (!(t >= knots[0] && t <= knots[last]))
    return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "t", -1,
                    "`t` = %s is outside of the knots, %s..%s", cag_number_text(t, x),
                    cag_number_text(knots[0], a), cag_number_text(knots[last], b));
  size_t lo = 0, hi = last;
  while (hi - lo > 1) {
    size_t mid = lo + (hi - lo) / 2;
    if (knots[mid] <= t) lo = mid;
    else hi = mid;
  }
  // Take the left limit at the end of the functions, and at the end of the usable range if there is
  // one.
  const bool at_end = end > (size_t)p && t == knots[end];
  if (left || t >= knots[last] || at_end)
    while (lo > 0 && knots[lo] >= t) lo--;
  while (lo + 1 < last && knots[lo] >= knots[lo + 1]) lo++;
  while (lo > 0 && knots[lo] >= knots[lo + 1]) lo--;
  *out = lo;
  return CAG_OK;
}

static double part(double numerator, double denominator) {
  return denominator > 0 ? numerator / denominator : 0;
}

void cag_basis_triangle(const double *x, size_t count, int p, size_t interval, double t,
                        double *out) {
  const size_t width = count - 1;
  memset(out, 0, sizeof(double) * (size_t)(p + 1) * width);
  out[interval] = 1;
  for (size_t q = 1; q <= (size_t)p; q++) {
    const double *below = out + (q - 1) * width;
    double *row = out + q * width;
    for (size_t i = interval > q ? interval - q : 0; i <= interval && i + q < width; i++)
      row[i] = part(t - x[i], x[i + q] - x[i]) * below[i] +
               part(x[i + q + 1] - t, x[i + q + 1] - x[i + 1]) * below[i + 1];
  }
}

// window[j] is function interval - q + j of degree q. Functions beyond the ends of the knots are 0,
// as are quotients that would need knots from there.
static bool exists(size_t count, size_t interval, int q, int j, size_t *i) {
  if (interval + (size_t)j < (size_t)q) return false;
  *i = interval + (size_t)j - (size_t)q;
  return *i + (size_t)q + 1 < count;
}

void cag_basis_derivative(const double *x, size_t count, int p, size_t interval, double t,
                          int order, double *work, double *out) {
  memset(out, 0, sizeof(double) * (count - (size_t)p - 1));
  if (order > p) return;
  memset(work, 0, sizeof(double) * (size_t)(p + 2));
  work[0] = 1;
  size_t i;
  for (int q = 1; q <= p; q++) {
    // Function j of degree q comes from j - 1 and j of degree q - 1; computed from the last down.
    const bool difference = q > p - order;
    for (int j = q; j >= 0; j--) {
      double value = 0;
      if (exists(count, interval, q, j, &i)) {
        const size_t s = (size_t)q;
        const double lower = j > 0 ? work[j - 1] : 0, upper = j < q ? work[j] : 0;
        const double left = x[i + s] - x[i], right = x[i + s + 1] - x[i + 1];
        value = difference ? q * (part(lower, left) - part(upper, right))
                           : part(t - x[i], left) * lower + part(x[i + s + 1] - t, right) * upper;
      }
      work[j] = value;
    }
  }
  for (int j = 0; j <= p; j++)
    if (exists(count, interval, p, j, &i)) out[i] = work[j];
}

// Converts powers of s = t - c to powers of t.
static void shift(double *a, int p, double c) {
  for (int k = 0; k < p; k++)
    for (int i = p - 1; i >= k; i--) a[i] -= c * a[i + 1];
}

void cag_basis_piece(const double *x, size_t count, int p, size_t interval, bool local,
                     double *out) {
  const size_t stride = (size_t)p + 1;
  const double origin = x[interval];
  memset(out, 0, sizeof(double) * stride * stride);
  out[0] = 1;
  for (int q = 1; q <= p; q++) {
    for (int j = q; j >= 0; j--) {
      size_t i = 0;
      double *row = out + (size_t)j * stride, *before = j > 0 ? row - stride : row;
      const bool there = exists(count, interval, q, j, &i);
      const size_t s = (size_t)q;
      const double left = there ? x[i + s] - x[i] : 0, right = there ? x[i + s + 1] - x[i + 1] : 0;
      // (s + origin - x_i) / left times j - 1, (x_{i+q+1} - origin - s) / right times j.
      for (int k = q; k >= 0; k--) {
        double value = 0;
        if (j > 0 && left > 0)
          value += ((origin - x[i]) * before[k] + (k > 0 ? before[k - 1] : 0)) / left;
        if (j < q && right > 0)
          value += ((x[i + s + 1] - origin) * row[k] - (k > 0 ? row[k - 1] : 0)) / right;
        row[k] = value;
      }
    }
  }
  if (local) return;
  for (int j = 0; j <= p; j++) shift(out + (size_t)j * stride, p, origin);
}

// Each knot of x must occur in y at least as often, additional knots of y must lie in the usable
// range, and no multiplicity there may exceed p + 1.
static CagStatus check_refinement(const double *x, size_t count, const double *y, size_t n, int p,
                                  CagError *err) {
  const double start = x[p], end = x[count - 1 - (size_t)p];
  char text[32];
  size_t i = 0, run = 1;
  for (size_t j = 0; j < n; j++, run++) {
    if (j > 0 && y[j] < y[j - 1])
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knots_not_monotone, "refined", (long)j,
                      "`refined` must not decrease: it decreases at refined[%zu]", j);
    if (j > 0 && y[j] != y[j - 1]) run = 1;
    if (run > (size_t)p + 1)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "refined", (long)j,
                      "the knot %s occurs more than %d times", cag_number_text(y[j], text), p + 1);
    if (i < count && y[j] == x[i]) i++;
    else if (i < count && y[j] > x[i]) break;
    else if (y[j] < start || y[j] > end)
      return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "refined", (long)j,
                      "the new knot %s lies outside of the usable range",
                      cag_number_text(y[j], text));
  }
  if (i == count) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_a_refinement, "refined", (long)i,
                  "`refined` must contain every knot as often as `knots` does: %s is missing",
                  cag_number_text(x[i], text));
}

CagStatus cag_basis_oslo(const double *x, size_t count, const double *y, size_t n, int p,
                         double *out, CagError *err) {
  CagStatus status = check_refinement(x, count, y, n, p, err);
  if (status) return status;
  const size_t m = n - (size_t)p - 1, block = (count - 1) * m;
  memset(out, 0, sizeof(double) * block * (size_t)(p + 1));
  for (size_t j = 0; j < m; j++) {
    size_t r;
    status = cag_basis_interval(x, count, p, y[j], false, &r, err);
    if (status) return status;
    out[r * m + j] = 1;
    for (size_t q = 1; q <= (size_t)p; q++) {
      const double *below = out + (q - 1) * block;
      double *row = out + q * block;
      for (size_t i = r > q ? r - q : 0; i <= r && i + q + 1 < count; i++)
        row[i * m + j] =
            part(y[j + q] - x[i], x[i + q] - x[i]) * below[i * m + j] +
            part(x[i + q + 1] - y[j + q], x[i + q + 1] - x[i + 1]) * below[(i + 1) * m + j];
    }
  }
  return CAG_OK;
}
