// Bernstein polynomials and Bezier pieces: variants of de Casteljau's algorithm.

#include "geom/basis/bernstein.h"

#include <string.h>

double cag_binomial(int n, int k) {
  if (k < 0 || k > n) return 0;
  if (k > n - k) k = n - k;
  double c = 1;
  for (int i = 1; i <= k; i++) c = c * (n - k + i) / i; // an integer at every step
  return c;
}

void cag_bernstein(int n, double t, double *out) {
  out[0] = 1;
  for (int j = 1; j <= n; j++) {
    double carried = 0;
    for (int i = 0; i < j; i++) {
      double b = out[i];
      out[i] = carried + (1 - t) * b;
      carried = t * b;
    }
    out[j] = carried;
  }
}

// One level of de Casteljau on `n` points, in place: n - 1 remain.
static inline void corner_cut(double *b, int n, double u) {
  if (u < 0.5)
    for (int i = 0; i < 4 * (n - 1); i++) b[i] += u * (b[i + 4] - b[i]);
  else
    for (int i = 0; i < 4 * (n - 1); i++) b[i] = b[i + 4] - (1 - u) * (b[i + 4] - b[i]);
}

void cag_bezier_derivatives(const double *b, int p, double u, int order, double *out) {
  double d[4 * (CAG_MAX_DEGREE + 1)], difference[4 * (CAG_MAX_DEGREE + 1)];
  memcpy(d, b, sizeof(double) * 4 * (size_t)(p + 1));
  if (order > p) memset(out + 4 * (p + 1), 0, sizeof(double) * 4 * (size_t)(order - p));
  // When k + 1 points are left, their k-th difference determines the k-th derivative.
  for (int left = p; left >= 0; left--) {
    if (left <= order) {
      memcpy(difference, d, sizeof(double) * 4 * (size_t)(left + 1));
      double factor = 1;
      for (int k = 0; k < left; k++) {
        factor *= p - k;
        for (int i = 0; i < 4 * (left - k); i++) difference[i] = difference[i + 4] - difference[i];
      }
      for (int i = 0; i < 4; i++) out[4 * left + i] = factor * difference[i];
    }
    if (left > 0) corner_cut(d, left + 1, u);
  }
}

// Keeps the left part [0, u] in place: point k is the first of level k.
static void keep_left(double *b, int p, double u) {
  for (int level = 1; level <= p; level++)
    for (int i = p; i >= level; i--)
      for (int c = 0; c < 4; c++) b[4 * i + c] = cag_mix(b[4 * (i - 1) + c], b[4 * i + c], u);
}

static void keep_right(double *b, int p, double u) {
  for (int level = 1; level <= p; level++) { corner_cut(b, p + 2 - level, u); }
}

void cag_bezier_segment(const double *b, int p, double u, double v, double *out) {
  memcpy(out, b, sizeof(double) * 4 * (size_t)(p + 1));
  if (v < 1) keep_left(out, p, v);
  if (u > 0) keep_right(out, p, v > 0 ? u / v : 0);
}

void cag_bezier_elevate(const double *b, int p, double *out) {
  for (int c = 0; c < 4; c++) {
    out[c] = b[c];
    for (int i = 1; i <= p; i++)
      out[4 * i + c] = cag_mix(b[4 * i + c], b[4 * (i - 1) + c], (double)i / (p + 1));
    out[4 * (p + 1) + c] = b[4 * p + c];
  }
}

void cag_rational_derivatives(const double *h, int order, CagVec3 *out) {
  const double w = 1 / h[3];
  for (int d = 0; d <= order; d++) {
    CagVec3 a = {h[4 * d], h[4 * d + 1], h[4 * d + 2]};
    double binomial = 1; // C(d, j)
    for (int j = 1; j <= d; j++) {
      binomial = binomial * (d - j + 1) / j;
      a = cag_madd(a, -binomial * h[4 * j + 3], out[d - j]);
    }
    out[d] = h[3] == 1 ? a : cag_scaled(a, w);
  }
}
