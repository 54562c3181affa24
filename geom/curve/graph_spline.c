// Splines of graphs: PCHIP and Akima slopes, and smoothing splines.
//
// A smoothing spline of weight k has the second derivatives g at the inner points with
// (R + k Q^T Q) g = Q^T y, and the values y - k Q g at the points, where R and Q are banded (Green
// and Silverman 1994, section 2.1.2). The matrix has five bands and is factored as L D L^T.

#include "geom/curve/graph_spline.h"

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/cubic.h"
#include "geom/curve/family.h"

// Changes of slope below this fraction of the largest count as equal, as in Akima's algorithm with
// floating-point numbers.
#define SAME_SLOPE 1e-9

static CagStatus check_graph(const double *x, const double *y, size_t n, CagError *err) {
  char a[32], b[32];
  if (n < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "expected at least 2 points, found %zu", n);
  for (size_t i = 0; i < n; i++) {
    if (cag_stop_check(err)) return err->status;
    if (!isfinite(x[i]) || !isfinite(y[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "points", (long)i,
                      "points[%zu] has a coordinate that is not a finite number", i);
    if (i > 0 && !(x[i] > x[i - 1]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter_length, "points", (long)i,
                      "x must increase from point to point: it is %s at points[%zu] and %s at "
                      "points[%zu]",
                      cag_number_text(x[i - 1], a), i - 1, cag_number_text(x[i], b), i);
    if (i > 0 && !isfinite((y[i] - y[i - 1]) / (x[i] - x[i - 1])))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "points", (long)i,
                      "the slope between points[%zu] and points[%zu] overflows", i - 1, i);
  }
  return CAG_OK;
}

static double secant(const double *x, const double *y, size_t i) {
  return (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
}

// --- PCHIP ---

// The slope at the end of two segments of lengths h and g with secants s and r, the first at the end.
static double end_slope(double h, double g, double s, double r) {
  const double d = ((2 * h + g) * s - h * r) / (h + g);
  if (s == 0 || (d > 0) != (s > 0)) return 0;
  return (s > 0) != (r > 0) && fabs(d) > 3 * fabs(s) ? 3 * s : d;
}

CagStatus cag_pchip_slopes(const double *x, const double *y, size_t n, double *out, CagError *err) {
  CagStatus status = check_graph(x, y, n, err);
  if (status) return status;
  out[0] = out[n - 1] = secant(x, y, 0);
  if (n == 2) return CAG_OK;
  for (size_t i = 1; i + 1 < n; i++) {
    const double h = x[i] - x[i - 1], g = x[i + 1] - x[i];
    const double s = secant(x, y, i - 1), r = secant(x, y, i);
    // Weights of the secants before and after: the shorter segment weighs more.
    const double before = h + 2 * g, after = 2 * h + g;
    const bool turns = s == 0 || r == 0 || (s > 0) != (r > 0);
    out[i] = turns ? 0 : (before + after) / (after / r + before / s);
  }
  out[0] = end_slope(x[1] - x[0], x[2] - x[1], secant(x, y, 0), secant(x, y, 1));
  out[n - 1] =
      end_slope(x[n - 1] - x[n - 2], x[n - 2] - x[n - 3], secant(x, y, n - 2), secant(x, y, n - 3));
  return CAG_OK;
}

// --- Akima ---

// Secant i, which continues linearly beyond both ends.
static double extended_secant(const double *x, const double *y, size_t n, long i) {
  const long last = (long)n - 2;
  if (last == 0) return secant(x, y, 0);
  if (i < 0) {
    const double s = secant(x, y, 0), r = secant(x, y, 1);
    return s - (double)-i * (r - s);
  }
  if (i > last) {
    const double s = secant(x, y, (size_t)last), r = secant(x, y, (size_t)last - 1);
    return s - (double)(i - last) * (r - s);
  }
  return secant(x, y, (size_t)i);
}

CagStatus cag_akima_slopes(const double *x, const double *y, size_t n, double *out, CagError *err) {
  CagStatus status = check_graph(x, y, n, err);
  if (status) return status;
  double largest = 0;
  for (int pass = 0; pass < 2; pass++) {
    for (long i = 0; i < (long)n; i++) {
      if (cag_stop_check(err)) return err->status;
      double m[4];
      for (int k = 0; k < 4; k++) m[k] = extended_secant(x, y, n, i - 2 + k);
      const double after = fabs(m[3] - m[2]), before = fabs(m[1] - m[0]), sum = after + before;
      if (pass == 0) largest = fmax(largest, sum);
      else if (sum > SAME_SLOPE * largest) out[i] = (after * m[1] + before * m[2]) / sum;
      else out[i] = (m[0] + m[3]) / 2;
    }
  }
  return CAG_OK;
}

// --- Curves with given slopes ---

typedef CagStatus (*Slopes)(const double *x, const double *y, size_t n, double *out, CagError *err);

static CagStatus curve_with(Slopes slopes, const CagVec3 *points, size_t n, CagCurve **out,
                            CagError *err) {
  double *x = cag_malloc((n ? n : 1) * 3 * sizeof *x);
  CagVec3 *tangents = cag_malloc((n ? n : 1) * sizeof *tangents);
  CagStatus status = x && tangents ? CAG_OK : cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    x[i] = points[i].x;
    x[n + i] = points[i].y;
  }
  if (!status) status = slopes(x, x + n, n, x + 2 * n, err);
  for (size_t i = 0; !status && i < n; i++) tangents[i] = cag_vec3(1, x[2 * n + i], 0);
  if (!status) status = cag_curve_hermite(points, tangents, n, x, 2, out, err);
  cag_free(x);
  cag_free(tangents);
  return status;
}

CagStatus cag_curve_pchip(const CagVec3 *points, size_t n, CagCurve **out, CagError *err) {
  return curve_with(cag_pchip_slopes, points, n, out, err);
}

CagStatus cag_curve_akima(const CagVec3 *points, size_t n, CagCurve **out, CagError *err) {
  return curve_with(cag_akima_slopes, points, n, out, err);
}

// --- Smoothing ---

// The system for m = n - 2 inner second derivatives. Rows of Q^T have the entries q[3 i ...] at the
// points i, i + 1, i + 2. x is scaled to a mean step of 1, and the weight accordingly.
typedef struct Smoother {
  size_t n, m;
  double *x, *y;   // n
  double *q;       // 3 m
  double *f;       // n: values of the spline
  double *d;       // m: D of L D L^T
  double *l1, *l2; // m: L below the diagonal: l1[i] = L(i + 1, i), l2[i] = L(i + 2, i)
  double *g;       // m
  double *inverse; // 3 m: the diagonal and two further bands of the inverse
  double *all;
  double step; // of x before scaling
} Smoother;

static CagStatus smoother_new(const CagVec3 *points, size_t n, Smoother *out, CagError *err) {
  const size_t m = n - 2;
  double *all = cag_calloc(3 * n + 10 * (m ? m : 1), sizeof *all);
  if (!all) return cag_fail_memory(err);
  Smoother s = {.n = n, .m = m, .all = all, .x = all, .y = all + n, .f = all + 2 * n};
  s.q = all + 3 * n;
  s.d = s.q + 3 * m;
  s.l1 = s.d + m;
  s.l2 = s.l1 + m;
  s.g = s.l2 + m;
  s.inverse = s.g + m;
  s.step = (points[n - 1].x - points[0].x) / (double)(n - 1);
  for (size_t i = 0; i < n; i++) {
    s.x[i] = points[i].x / s.step;
    s.y[i] = points[i].y;
  }
  for (size_t i = 0; i < m; i++) {
    const double h = s.x[i + 1] - s.x[i], g = s.x[i + 2] - s.x[i + 1];
    s.q[3 * i] = 1 / h;
    s.q[3 * i + 1] = -1 / h - 1 / g;
    s.q[3 * i + 2] = 1 / g;
  }
  *out = s;
  return CAG_OK;
}

// Entry (i, i + k) of Q^T Q.
static double product_entry(const Smoother *s, size_t i, size_t k) {
  double sum = 0;
  for (size_t j = k; j < 3; j++) sum += s->q[3 * i + j] * s->q[3 * (i + k) + j - k];
  return sum;
}

// Factors R + weight Q^T Q.
static void factor(Smoother *s, double weight) {
  for (size_t i = 0; i < s->m; i++) {
    const double h = s->x[i + 1] - s->x[i], g = s->x[i + 2] - s->x[i + 1];
    double diagonal = (h + g) / 3 + weight * product_entry(s, i, 0);
    double near = i + 1 < s->m ? g / 6 + weight * product_entry(s, i, 1) : 0;
    const double far = i + 2 < s->m ? weight * product_entry(s, i, 2) : 0;
    if (i > 0) {
      diagonal -= s->l1[i - 1] * s->l1[i - 1] * s->d[i - 1];
      near -= s->l1[i - 1] * s->l2[i - 1] * s->d[i - 1];
    }
    if (i > 1) diagonal -= s->l2[i - 2] * s->l2[i - 2] * s->d[i - 2];
    s->d[i] = diagonal;
    s->l1[i] = near / diagonal;
    s->l2[i] = far / diagonal;
  }
}

// Sets f to the values of the smoothing spline. Returns the largest distance from the data, and adds
// up their squares.
static double smooth(Smoother *s, double weight, double *squares) {
  const size_t m = s->m;
  factor(s, weight);
  for (size_t i = 0; i < m; i++) {
    const double *q = s->q + 3 * i, *y = s->y + i;
    s->g[i] = q[2] * (y[2] - y[1]) - q[0] * (y[1] - y[0]);
    if (i > 0) s->g[i] -= s->l1[i - 1] * s->g[i - 1];
    if (i > 1) s->g[i] -= s->l2[i - 2] * s->g[i - 2];
  }
  for (size_t i = 0; i < m; i++) s->g[i] /= s->d[i];
  for (size_t i = m; i-- > 0;) {
    if (i + 1 < m) s->g[i] -= s->l1[i] * s->g[i + 1];
    if (i + 2 < m) s->g[i] -= s->l2[i] * s->g[i + 2];
  }
  memcpy(s->f, s->y, s->n * sizeof *s->f);
  for (size_t i = 0; i < m; i++)
    for (size_t j = 0; j < 3; j++) s->f[i + j] -= weight * s->q[3 * i + j] * s->g[i];
  double largest = 0;
  *squares = 0;
  for (size_t i = 0; i < s->n; i++) {
    const double r = s->y[i] - s->f[i];
    *squares += r * r;
    largest = fmax(largest, fabs(r));
  }
  return largest;
}

// The trace of weight Q (R + weight Q^T Q)^-1 Q^T, which is n minus the degrees of freedom. The bands
// of the inverse follow from the factors, from the last row upwards (Hutchinson and de Hoog 1985).
static double residual_freedom(Smoother *s, double weight) {
  double sum = 0;
  for (size_t i = s->m; i-- > 0;) {
    const bool one = i + 1 < s->m, two = i + 2 < s->m;
    double *b = s->inverse + 3 * i;
    const double a = one ? s->l1[i] : 0, c = two ? s->l2[i] : 0;
    const double b11 = one ? b[3] : 0, b12 = two ? b[4] : 0, b22 = two ? b[6] : 0;
    b[1] = -a * b11 - c * b12;
    b[2] = -a * b12 - c * b22;
    b[0] = 1 / s->d[i] - a * b[1] - c * b[2];
    sum += product_entry(s, i, 0) * b[0];
    if (one) sum += 2 * product_entry(s, i, 1) * b[1];
    if (two) sum += 2 * product_entry(s, i, 2) * b[2];
  }
  return weight * sum;
}

// The mean of the squared deviations over the square of the mean freedom of the residuals.
static double cross_validation(Smoother *s, double weight) {
  double squares;
  smooth(s, weight, &squares);
  const double freedom = residual_freedom(s, weight) / (double)s->n;
  return squares / (double)s->n / (freedom * freedom);
}

// The range of weights to search: from practically interpolation to practically a line, which is
// reached when the weight exceeds the fourth power of the number of steps.
#define LEAST_WEIGHT 1e-8
static double most_weight(const Smoother *s) { return 1e4 * pow((double)s->n, 4); }

// Minimizes by samples at equal ratios, then by golden sections between the neighbors of the best.
#define SAMPLES 60
#define SECTIONS 60
static CagStatus automatic_weight(Smoother *s, double *out, CagError *err) {
  const double low = log(LEAST_WEIGHT), step = (log(most_weight(s)) - low) / SAMPLES;
  double best = INFINITY, at = low;
  for (int i = 0; i <= SAMPLES; i++) {
    if (cag_stop_check(err)) return err->status;
    const double value = cross_validation(s, exp(low + i * step));
    if (value < best) {
      best = value;
      at = low + i * step;
    }
  }
  const double ratio = (sqrt(5) - 1) / 2;
  double a = at - step, b = at + step, p = b - ratio * (b - a), q = a + ratio * (b - a);
  double at_p = cross_validation(s, exp(p)), at_q = cross_validation(s, exp(q));
  for (int i = 0; i < SECTIONS && q - p > 1e-9; i++) {
    if (cag_stop_check(err)) return err->status;
    if (at_p < at_q) {
      b = q, q = p, at_q = at_p;
      p = b - ratio * (b - a);
      at_p = cross_validation(s, exp(p));
    } else {
      a = p, p = q, at_p = at_q;
      q = a + ratio * (b - a);
      at_q = cross_validation(s, exp(q));
    }
  }
  *out = exp((a + b) / 2);
  return CAG_OK;
}

// The largest weight for which no deviation exceeds `most`, by bisection of its logarithm.
#define BISECTIONS 100
static CagStatus weight_of_deviation(Smoother *s, double most, double *out, CagError *err) {
  double squares, low = log(LEAST_WEIGHT), high = log(most_weight(s));
  *out = exp(high);
  if (smooth(s, *out, &squares) <= most) return CAG_OK;
  *out = 0;
  if (smooth(s, exp(low), &squares) > most) return CAG_OK;
  for (int i = 0; i < BISECTIONS && high - low > 1e-14; i++) {
    if (cag_stop_check(err)) return err->status;
    const double middle = (low + high) / 2;
    if (smooth(s, exp(middle), &squares) <= most) low = middle;
    else high = middle;
  }
  *out = exp(low);
  return CAG_OK;
}

static CagStatus choose_weight(Smoother *s, CagSmoothing by, double value, double *out,
                               CagError *err) {
  if (by == CAG_SMOOTHING_AUTO) return automatic_weight(s, out, err);
  if (by == CAG_SMOOTHING_DEVIATION) return weight_of_deviation(s, value, out, err);
  *out = value / s->step / s->step / s->step;
  return CAG_OK;
}

static CagStatus check_points(const CagVec3 *points, size_t n, CagError *err) {
  double *x = cag_malloc((n ? n : 1) * 2 * sizeof *x);
  if (!x) return cag_fail_memory(err);
  for (size_t i = 0; i < n; i++) {
    x[i] = points[i].x;
    x[n + i] = points[i].y;
  }
  CagStatus status = check_graph(x, x + n, n, err);
  cag_free(x);
  return status;
}

CagStatus cag_curve_smoothing(const CagVec3 *points, size_t n, CagSmoothing by, double value,
                              CagCurve **out, CagError *err) {
  static const CagCubicEnds relaxed = {.closing = CAG_CUBIC_ENDS};
  Smoother s;
  double weight = 0, squares;
  CagStatus status = check_points(points, n, err);
  if (!status) status = smoother_new(points, n, &s, err);
  if (status) return status;
  CagVec3 *values = cag_malloc(n * sizeof *values);
  double *x = cag_malloc(n * sizeof *x);
  if (!values || !x) status = cag_fail_memory(err);
  if (!status) status = choose_weight(&s, by, value, &weight, err);
  if (!status) {
    smooth(&s, weight, &squares);
    for (size_t i = 0; i < n; i++) {
      x[i] = points[i].x;
      values[i] = cag_vec3(x[i], s.f[i], 0);
    }
    status = cag_curve_cubic_spline(values, n, x, &relaxed, NULL, 2, out, err);
  }
  cag_free(values);
  cag_free(x);
  cag_free(s.all);
  return status;
}
