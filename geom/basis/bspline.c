// B-spline basis functions by the triangular scheme (Cox, de Boor), derivatives by differences of
// the lower degrees, Bezier pieces by blossoms, higher degrees by discrete B-splines.

#include "geom/basis/bspline.h"

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

void cag_bspline_basis(const double *knots, int p, size_t span, double t, double *out) {
  out[0] = 1;
  for (int d = 1; d <= p; d++) {
    double carried = 0;
    for (int r = 0; r < d; r++) {
      double right = knots[span + 1 + (size_t)r], left = knots[span + 1 + (size_t)r - (size_t)d];
      double share = out[r] / (right - left);
      out[r] = carried + (right - t) * share;
      carried = (t - left) * share;
    }
    out[d] = carried;
  }
}

// N^(k)_{i,p} = p (N^(k-1)_{i,p-1} / (x_{i+p} - x_i) - N^(k-1)_{i+1,p-1} / (x_{i+p+1} - x_{i+1})):
// from the values of degree p - k, k steps up.
void cag_bspline_derivatives(const double *knots, int p, size_t span, double t, int order,
                             double *out) {
  for (int k = 0; k <= order; k++) {
    double *row = out + (size_t)k * (size_t)(p + 1);
    memset(row, 0, sizeof(double) * (size_t)(p + 1));
    if (k > p) continue;
    int d = p - k;
    cag_bspline_basis(knots, d, span, t, row);
    for (d = p - k + 1; d <= p; d++) {
      // Function j of degree d (support from span - d + j) comes from j - 1 and j of degree d - 1.
      double carried = 0;
      for (int j = 0; j <= d; j++) {
        double lower = 0;
        if (j < d) {
          size_t i = span + (size_t)j - (size_t)d + 1;
          lower = d * row[j] / (knots[i + (size_t)d] - knots[i]);
        }
        row[j] = carried - lower;
        carried = lower;
      }
    }
  }
}

// Whether the piece between knots span and span + 1 is a Bezier curve already: both ends are knots
// of multiplicity p.
static bool is_bezier(const double *knots, int p, size_t span) {
  return knots[span + 1 - (size_t)p] == knots[span] && knots[span + (size_t)p] == knots[span + 1];
}

// Bezier point j is the blossom at (p - j) times the left and j times the right end.
void cag_bspline_piece(const double *homogeneous, const double *knots, int p, size_t span,
                       double *out) {
  double d[4 * (CAG_MAX_DEGREE + 1)];
  const double a = knots[span], b = knots[span + 1];
  const double *first = homogeneous + 4 * (span - (size_t)p);
  if (is_bezier(knots, p, span)) {
    memcpy(out, first, sizeof(double) * 4 * (size_t)(p + 1));
    return;
  }
  // A thousand points take a second; the caller does not use the result of canceled work.
  for (int j = 0; j <= p && !cag_stopped(); j++) {
    memcpy(d, first, sizeof(double) * 4 * (size_t)(p + 1));
    for (int s = 1; s <= p; s++) {
      const double u = s <= j ? b : a;
      for (int i = p; i >= s; i--) {
        size_t k = span - (size_t)p + (size_t)i;
        double lo = knots[k], hi = knots[k + (size_t)(p + 1 - s)];
        double f = (u - lo) / (hi - lo);
        for (int c = 0; c < 4; c++) d[4 * i + c] = cag_mix(d[4 * (i - 1) + c], d[4 * i + c], f);
      }
    }
    memcpy(out + 4 * j, d + 4 * p, sizeof(double) * 4);
  }
}

void cag_bspline_piece_derivatives(const double *homogeneous, const double *knots, int p,
                                   size_t span, double t, int order, double *out) {
  double net[4 * (CAG_MAX_DEGREE + 1)], d[4 * (CAG_MAX_DEGREE + 1)];
  const double *k = knots + (span - (size_t)p); // the piece lies between k[p] and k[p + 1]
  memcpy(net, homogeneous + 4 * (span - (size_t)p), sizeof(double) * 4 * (size_t)(p + 1));
  for (int m = 0; m <= order; m++) {
    const int q = p - m; // the degree of this derivative, of q + 1 points over k[m + 1] ..
    double *value = out + 4 * m;
    for (int c = 0; c < 4; c++) value[c] = 0;
    if (q < 0) continue;
    memcpy(d, net, sizeof(double) * 4 * (size_t)(q + 1));
    for (int s = 1; s <= q; s++)
      for (int i = q; i >= s; i--) {
        const double lo = k[m + i], hi = k[p + 1 + i - s];
        for (int c = 0; c < 4; c++)
          d[4 * i + c] = cag_mix(d[4 * (i - 1) + c], d[4 * i + c], (t - lo) / (hi - lo));
      }
    memcpy(value, d + 4 * q, sizeof(double) * 4);
    for (int i = 0; i < q; i++) {
      const double factor = q / (k[p + 1 + i] - k[m + 1 + i]);
      for (int c = 0; c < 4; c++) net[4 * i + c] = factor * (net[4 * (i + 1) + c] - net[4 * i + c]);
    }
  }
}

void cag_bspline_insert(double *homogeneous, double *knots, size_t n, int p, double t) {
  const size_t r = cag_knots_span(knots, n, p, t, false, 0);
  double *h = homogeneous;
  // Points above the span move up; the p points of the span are interpolated, from the last down.
  memmove(h + 4 * (r + 1), h + 4 * r, sizeof(double) * 4 * (n - r));
  for (size_t i = r; i + (size_t)p > r; i--) {
    double f = (t - knots[i]) / (knots[i + (size_t)p] - knots[i]);
    for (int c = 0; c < 4; c++)
      h[4 * i + (size_t)c] = cag_mix(h[4 * (i - 1) + (size_t)c], h[4 * i + (size_t)c], f);
  }
  memmove(knots + r + 2, knots + r + 1, sizeof(double) * (n + (size_t)p - r));
  knots[r + 1] = t;
}

// --- Elevation ---

size_t cag_bspline_elevated_knots(const double *knots, size_t n, int p, double *out) {
  const size_t count = n + (size_t)p + 1;
  size_t m = 0;
  for (size_t i = 0; i < count; i++) {
    out[m++] = knots[i];
    if (i + 1 == count || knots[i + 1] != knots[i]) out[m++] = knots[i];
  }
  return m;
}

static double part_of(double x, double whole) { return whole > 0 ? x / whole : 0; }

// The step of the Oslo algorithm to discrete B-splines of degree q at the knot u. w[i], i = p - q
// .. p, belongs to B-spline span - p + i, whose knots begin at x[i].
static void raise_discrete(const double *x, int p, int q, double u, double *w) {
  for (int i = p - q; i <= p; i++)
    w[i] = part_of(u - x[i], x[i + q] - x[i]) * w[i] +
           (i < p ? part_of(x[i + q + 1] - u, x[i + q + 1] - x[i + 1]) * w[i + 1] : 0);
}

// The weights of points span - p .. span in the point whose elevated knots are z[0] .. z[p + 2].
// That point is the mean over l of the blossoms at z[1] .. z[p + 1] without z[l] (Ramshaw 1989,
// Blossoms are polar forms). Each of them is a point of the curve over refined knots, so that its
// weights are discrete B-splines, which are not negative (Cohen, Lyche, Riesenfeld 1980). `all` are
// the weights without omission, `sum` the sum of those that omit one knot.
static void elevated_weights(const double *x, int p, const double *z, double *all, double *sum) {
  memset(all, 0, sizeof(double) * (size_t)(p + 1));
  memset(sum, 0, sizeof(double) * (size_t)(p + 1));
  all[p] = 1;
  for (int k = 1; k <= p + 1; k++) {
    if (k > 1) raise_discrete(x, p, k - 1, z[k], sum);
    for (int i = 0; i <= p; i++) sum[i] += all[i];
    if (k <= p) raise_discrete(x, p, k, z[k], all);
  }
  for (int i = 0; i <= p; i++) sum[i] /= p + 1;
}

CagStatus cag_bspline_elevate(const double *points, size_t width, const double *knots, size_t n,
                              int p, const double *elevated, double *out, CagError *err) {
  double *all = cag_malloc(sizeof(double) * (size_t)(2 * p + 2));
  if (!all) return cag_fail_memory(err);
  double *sum = all + p + 1;
  size_t j = 0;
  for (; elevated[j] < knots[n]; j++) {
    if (cag_stop_check(err)) break;
    size_t span = (size_t)p;
    if (n == (size_t)p + 1) { // one Bezier piece: two points each
      memset(sum, 0, sizeof(double) * (size_t)(p + 1));
      const double share = (double)j / (p + 1);
      if (j > 0) sum[j - 1] = share;
      if (j <= (size_t)p) sum[j] = 1 - share;
    } else {
      span = cag_knots_span(knots, n, p, elevated[j], false, (size_t)p);
      elevated_weights(knots + (span - (size_t)p), p, elevated + j, all, sum);
    }
    const double *from = points + (span - (size_t)p) * width;
    double *to = out + j * width;
    memset(to, 0, sizeof(double) * width);
    for (size_t i = 0; i <= (size_t)p; i++)
      for (size_t c = 0; sum[i] != 0 && c < width; c++) to[c] += sum[i] * from[i * width + c];
  }
  cag_free(all);
  if (elevated[j] < knots[n]) return err->status;
  // The ends are those of the curve, bit for bit.
  memcpy(out, points, sizeof(double) * width);
  memcpy(out + (j - 1) * width, points + (n - 1) * width, sizeof(double) * width);
  return CAG_OK;
}
