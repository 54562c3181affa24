// Tensor product NURBS surfaces at one point: the bases, and all partial derivatives.

#include <string.h>

#include "geom/surface/tensor.h"

// --- Basis ---

size_t cag_tensor_span(const Direction *d, double t, CagSide side) {
  size_t low = (size_t)d->degree, high = d->count; // knots[low] <= t <= knots[high]
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    bool above = side == CAG_SIDE_LEFT ? t > d->knots[middle] : t >= d->knots[middle];
    if (above) low = middle;
    else high = middle;
  }
  // At an end of the domain the bisection may stop at an empty span; use the nearest nonempty one.
  while (low > (size_t)d->degree && d->knots[low] >= d->knots[low + 1]) low--;
  while (low + 1 < d->count && d->knots[low] >= d->knots[low + 1]) low++;
  return low;
}

// Values of the p + 1 basis functions of degree p on the span, by the triangular scheme of Cox and
// de Boor. `lower` (may be NULL) receives the p values of degree p - 1.
INLINE void basis_scheme(const Direction *d, int p, size_t span, double t, double *values,
                         double *lower) {
  double left[MAX_DEGREE + 1], right[MAX_DEGREE + 1];
  values[0] = 1;
  for (int j = 1; j <= p; j++) {
    for (int r = 0; lower && j == p && r < j; r++) lower[r] = values[r];
    left[j] = t - d->knots[span + 1 - (size_t)j];
    right[j] = d->knots[span + (size_t)j] - t;
    double saved = 0;
    for (int r = 0; r < j; r++) {
      double part = values[r] / (right[r + 1] + left[j - r]);
      values[r] = saved + right[r + 1] * part;
      saved = left[j - r] * part;
    }
    values[j] = saved;
  }
}

static void basis_values(const Direction *d, size_t span, double t, double *values) {
  basis_scheme(d, d->degree, span, t, values, NULL);
}

INLINE void basis_first_of(const Direction *d, int p, size_t span, double t, double *values,
                           double *slopes) {
  double lower[MAX_DEGREE + 1], before = 0;
  basis_scheme(d, p, span, t, values, lower);
  for (int i = 0; i <= p; i++) {
    double after = 0;
    if (i < p) {
      double width = d->knots[span + 1 + (size_t)i] - d->knots[span + 1 + (size_t)i - (size_t)p];
      after = p * lower[i] / width;
    }
    slopes[i] = before - after;
    before = after;
  }
}

// Values and first derivatives. The loops for common degrees are unrolled.
void cag_tensor_basis_first(const Direction *d, size_t span, double t, double *values,
                            double *slopes) {
  switch (d->degree) {
  case 1: basis_first_of(d, 1, span, t, values, slopes); break;
  case 2: basis_first_of(d, 2, span, t, values, slopes); break;
  case 3: basis_first_of(d, 3, span, t, values, slopes); break;
  default: basis_first_of(d, d->degree, span, t, values, slopes);
  }
}

// Derivatives 0..n: out[k * (degree + 1) + i]. Derivatives of a B-spline are B-splines of the
// differences of its control points, applied here to the unit control points.
static void basis_derivatives(const Direction *d, size_t span, double t, int n, double *out) {
  int p = d->degree, width = p + 1;
  if (n <= 1) {
    double slopes[MAX_DEGREE + 1];
    cag_tensor_basis_first(d, span, t, out, n < 1 ? slopes : out + width);
    return;
  }
  for (int k = 0; k <= n; k++) {
    double *row = out + k * width;
    for (int i = 0; i <= p; i++) row[i] = 0;
    if (k > p) continue;
    // Values of degree p - k on the span, then raised k times by the derivative formula.
    Direction low = *d;
    low.degree = p - k;
    double values[MAX_DEGREE + 1];
    basis_values(&low, span, t, values);
    for (int i = 0; i <= p - k; i++) row[i] = values[i];
    for (int q = p - k + 1; q <= p; q++) {
      double before = 0;
      for (int i = 0; i <= q; i++) {
        double after = 0;
        if (i < q) {
          double span_width =
              d->knots[span + 1 + (size_t)i] - d->knots[span + 1 + (size_t)i - (size_t)q];
          after = q * row[i] / span_width;
        }
        row[i] = before - after;
        before = after;
      }
    }
  }
}

// --- One point ---

// Quotient rule for all partials of total order <= n of A / w (Piegl and Tiller 1997, section 4.5).
static CagStatus divide(int n, const double (*h)[4], CagVec3 *out, CagError *err) {
  double w = h[0][3];
  if (!(w > 0))
    return cag_fail(
        err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "weights", -1,
        "all `weights` that act at this point are 0: give one of them a positive value");
  double binomial[CAG_MAX_PARTIAL + 1][CAG_MAX_PARTIAL + 1];
  for (int i = 0; i <= n; i++)
    for (int j = 0; j <= i; j++)
      binomial[i][j] = j == 0 || j == i ? 1 : binomial[i - 1][j - 1] + binomial[i - 1][j];
  for (int a = 0; a <= n; a++)
    for (int b = 0; a + b <= n; b++) {
      const double *top = h[cag_partial(n, a, b)];
      CagVec3 sum = {top[0], top[1], top[2]};
      for (int i = 0; i <= a; i++)
        for (int j = 0; j <= b; j++)
          if (i + j > 0)
            sum = cag_madd(sum, -binomial[a][i] * binomial[b][j] * h[cag_partial(n, i, j)][3],
                           out[cag_partial(n, a - i, b - j)]);
      out[cag_partial(n, a, b)] = cag_scaled(sum, 1 / w);
    }
  return CAG_OK;
}

// All partials of total order <= n of the homogeneous point. bu, bv: derivatives of the bases; p,
// q: the degrees, passed separately so that loops can be unrolled.
INLINE void contract_net(const Nurbs *b, int p, int q, size_t iu, size_t iv, int n,
                         const double *bu, const double *bv, double (*h)[4]) {
  double row[MAX_DEGREE + 1][4];
  for (int i = 0; i <= n; i++) {
    // The net contracted with the i-th derivatives by u.
    for (int l = 0; l <= q; l++)
      for (int c = 0; c < 4; c++) row[l][c] = 0;
    for (int k = 0; k <= p && i <= p; k++) {
      double f = bu[i * (p + 1) + k];
      const double *net = b->net + 4 * ((iu - (size_t)p + (size_t)k) * b->v.count + iv - (size_t)q);
      for (int l = 0; l <= q; l++)
        for (int c = 0; c < 4; c++) row[l][c] += f * net[4 * l + c];
    }
    for (int j = 0; i + j <= n; j++) {
      double to[4] = {0};
      for (int l = 0; l <= q; l++)
        for (int c = 0; c < 4; c++) to[c] += bv[j * (q + 1) + l] * row[l][c];
      memcpy(h[cag_partial(n, i, j)], to, sizeof to);
    }
  }
}

CagStatus cag_tensor_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                          CagVec3 *out, CagError *err) {
  const Nurbs *b = (const Nurbs *)s;
  int p = b->u.degree, q = b->v.degree;
  double bu[(CAG_MAX_PARTIAL + 1) * (MAX_DEGREE + 1)], bv[(CAG_MAX_PARTIAL + 1) * (MAX_DEGREE + 1)];
  double h[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)][4];
  size_t iu = cag_tensor_span(&b->u, u, su), iv = cag_tensor_span(&b->v, v, sv);
  h[0][0] = h[0][1] = h[0][2] = 0;
  h[0][3] = 1;
  basis_derivatives(&b->u, iu, u, n, bu);
  basis_derivatives(&b->v, iv, v, n, bv);
  if (p == 3 && q == 3) contract_net(b, 3, 3, iu, iv, n, bu, bv, h);
  else contract_net(b, p, q, iu, iv, n, bu, bv, h);
  if (b->rational) return divide(n, (const double(*)[4])h, out, err);
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      int k = cag_partial(n, i, j);
      out[k] = cag_vec3(h[k][0], h[k][1], h[k][2]);
    }
  return CAG_OK;
}
