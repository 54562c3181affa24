// Single cubic segments: polynomial form, shape, end curvatures, and continuation.

#include <string.h>

#include "base/memory.h"
#include "geom/curve/cubic.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "geom/linalg/tolerance.h"

// --- Polynomials ---

CagStatus cag_curve_polynomial(const CagVec3 *coefficients, size_t n, double length, int dimension,
                               CagCurve **out, CagError *err) {
  CagStatus status = cag_degree_check(n, n < 2 || n > CAG_MAX_DEGREE + 1 ? 1 : (int)n - 1, err);
  if (!status) status = cag_curve_check_points(coefficients, n, "coefficients", err);
  if (status) return status;
  char text[32];
  if (n > CAG_MAX_DEGREE + 1)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "coefficients", -1,
                    "the degree must be at most %d, found %zu coefficients", CAG_MAX_DEGREE, n);
  if (!(length > 0) || !isfinite(length))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter_length, "length", -1,
                    "the length of a segment must be positive and finite, found %s",
                    cag_number_text(length, text));
  // b_i = sum over k <= i of binomial(i, k) / binomial(degree, k) c_k h^k
  const int p = (int)n - 1;
  CagVec3 b[CAG_MAX_DEGREE + 1];
  double knots[2 * (CAG_MAX_DEGREE + 1)];
  for (int i = 0; i <= p; i++) {
    double factor = 1;
    b[i] = coefficients[0];
    for (int k = 1; k <= i; k++) {
      factor *= length * (i - k + 1) / (p - k + 1);
      b[i] = cag_madd(b[i], factor, coefficients[k]);
    }
    knots[i] = 0;
    knots[p + 1 + i] = length;
  }
  return cag_curve_nurbs(b, NULL, n, p, knots, dimension, out, err);
}

// Coefficients by s in 0..h of a piece: differences of its points.
static void piece_coefficients(const double *bezier, int p, double h, CagVec3 *out) {
  for (int i = 0; i <= p; i++)
    out[i] = cag_vec3(bezier[4 * i], bezier[4 * i + 1], bezier[4 * i + 2]);
  for (int k = 1; k <= p; k++)
    for (int i = p; i >= k; i--) out[i] = cag_sub(out[i], out[i - 1]);
  double factor = 1;
  for (int k = 1; k <= p; k++) {
    factor *= (p - k + 1) / (k * h);
    out[k] = cag_scaled(out[k], factor);
  }
}

CagStatus cag_curve_coefficients(const CagCurve *curve, CagVec3 **out, size_t *pieces, int *degree,
                                 CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(curve, &exact, err);
  if (status) return status;
  const CagNurbs *c = cag_nurbs_data(exact);
  CagVec3 *a = NULL;
  if (!c || c->rational) {
    status = cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_not_polynomial, "", -1,
                      "a curve of kind %s is not a polynomial: it is a quotient of two",
                      curve->kind->name);
  } else {
    const size_t stride = (size_t)c->degree + 1;
    a = cag_malloc(c->pieces * stride * sizeof *a);
    if (!a) status = cag_fail_memory(err);
    for (size_t i = 0; a && i < c->pieces; i++)
      piece_coefficients(cag_nurbs_bezier(c, i), c->degree, c->cuts[i + 1] - c->cuts[i],
                         a + i * stride);
    *pieces = c->pieces;
    *degree = c->degree;
  }
  cag_curve_release(exact);
  if (!status) *out = a;
  return status;
}

// --- Limiting tangents ---

void cag_hermite_limit(const CagVec3 *points, CagVec3 *tangents, size_t n, const double *parameters,
                       double limit) {
  for (size_t i = 0; i < n; i++) {
    double most = INFINITY;
    for (size_t k = i ? i - 1 : 0; k <= i && k + 1 < n; k++)
      most = fmin(most, limit * cag_norm(cag_sub(points[k + 1], points[k])) /
                            (parameters[k + 1] - parameters[k]));
    const double speed = cag_norm(tangents[i]);
    if (speed > most) tangents[i] = cag_scaled(tangents[i], most / speed);
  }
}

// --- Shape ---

static double flat_cross(CagVec3 a, CagVec3 b) { return a.x * b.y - a.y * b.x; }

// Cross products below this fraction of the factors' magnitudes are rounding of parallel vectors.
#define PARALLEL 1e-13
// A discriminant below this fraction of its terms is rounding of a double root.
#define DOUBLE_ROOT CAG_ROUNDING

static double cross_or_zero(CagVec3 a, CagVec3 b) {
  const double c = flat_cross(a, b);
  return fabs(c) <= PARALLEL * cag_norm(a) * cag_norm(b) ? 0 : c;
}

// Real roots of a t^2 + b t + c, ascending, disc = b^2 - 4 a c >= 0.
static size_t quadratic_roots(double a, double b, double c, double disc, double out[2]) {
  if (a == 0) {
    if (b == 0) return 0;
    out[0] = -c / b;
    return 1;
  }
  const double q = -(b + copysign(sqrt(disc), b)) / 2;
  const double r = q / a, s = q != 0 ? c / q : 0;
  out[0] = fmin(r, s);
  out[1] = fmax(r, s);
  return 2;
}

CagStatus cag_hermite_shape(CagVec3 p, CagVec3 q, CagVec3 dp, CagVec3 dq, CagHermiteShape *out,
                            CagError *err) {
  const CagVec3 d = cag_sub(q, p), ends[2] = {p, q}, tangents[2] = {dp, dq};
  CagHermiteShape s = {.chord = cag_norm(d)};
  if (!(s.chord > CAG_CURVE_SAME * cag_curve_size(ends, 2)))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_coincident_points, "Q", -1,
                    "both ends of the segment coincide, so its chord is zero");
  for (int i = 0; i < 2; i++) {
    s.speed[i] = cag_norm(tangents[i]);
    s.ratio[i] = s.speed[i] / s.chord;
    s.projection[i] = cag_dot(tangents[i], d) / (s.chord * s.chord);
  }
  s.within_limit = s.ratio[0] <= 3 && s.ratio[1] <= 3;
  // Inflections, where P' x P'' = 0, are the roots of 3 A t^2 + 3 B t + C.
  const CagVec3 a1 = dp, a2 = cag_sub(cag_sub(cag_scaled(d, 3), cag_scaled(dp, 2)), dq);
  const CagVec3 a3 = cag_add(cag_add(dp, dq), cag_scaled(d, -2));
  const double a = cross_or_zero(a2, a3), b = cross_or_zero(a1, a3), c = cross_or_zero(a1, a2);
  const double disc = 9 * b * b - 12 * a * c;
  const bool twice = a != 0 && fabs(disc) <= DOUBLE_ROOT * (9 * b * b + fabs(12 * a * c));
  if (twice) {
    s.cusp = -b / (2 * a);
    s.has_cusp = s.cusp >= 0 && s.cusp <= 1;
  } else if (disc < 0) {
    const double sum = -b / a, product = sum * sum - c / a;
    quadratic_roots(1, -sum, product, sum * sum - 4 * product, s.loop);
    s.has_loop = s.loop[0] >= 0 && s.loop[1] <= 1;
  } else {
    double roots[2];
    size_t n = quadratic_roots(3 * a, 3 * b, c, disc, roots);
    for (size_t i = 0; i < n; i++)
      if (roots[i] > 0 && roots[i] < 1) s.inflection[s.inflections++] = roots[i];
  }
  *out = s;
  return CAG_OK;
}

// --- End curvatures ---

#define QUARTIC 4

static double polynomial(const double *a, int degree, double x) {
  double y = a[degree];
  for (int k = degree - 1; k >= 0; k--) y = y * x + a[k];
  return y;
}

// The root between lo and hi, where the polynomial has opposite signs; bisection ends when no
// double lies between.
static double bisect(const double *a, int degree, double lo, double hi) {
  const bool rising = polynomial(a, degree, hi) > 0;
  for (;;) {
    const double mid = lo + (hi - lo) / 2;
    if (mid <= lo || mid >= hi) return mid;
    if ((polynomial(a, degree, mid) > 0) == rising) hi = mid;
    else lo = mid;
  }
}

// Roots in (0, most], ascending: at most one between two neighboring roots of the derivative.
static size_t positive_roots(const double *a, int degree, double most, double *out) {
  while (degree > 0 && a[degree] == 0) degree--;
  if (degree == 0) return 0;
  double slope[QUARTIC] = {0}, turns[QUARTIC];
  for (int k = 1; k <= degree; k++) slope[k - 1] = k * a[k];
  const size_t n = positive_roots(slope, degree - 1, most, turns);
  size_t found = 0;
  double lo = 0, at_lo = a[0];
  for (size_t i = 0; i <= n; i++) {
    const double hi = i < n ? turns[i] : most, at_hi = polynomial(a, degree, hi);
    if (at_hi == 0) out[found++] = hi;
    else if (at_lo != 0 && (at_lo > 0) != (at_hi > 0)) out[found++] = bisect(a, degree, lo, hi);
    lo = hi;
    at_lo = at_hi;
  }
  return found;
}

size_t cag_hermite_by_curvature(CagVec3 p, CagVec3 q, CagVec3 dp, CagVec3 dq, const double k[2],
                                double out[4][2]) {
  // k[0] x^2 = a - 2 c y, k[1] y^2 = b - 2 c x with the lengths x and y.
  const CagVec3 d = cag_sub(q, p);
  const double a = 6 * flat_cross(dp, d), b = -6 * flat_cross(dq, d), c = flat_cross(dp, dq);
  size_t n = 0;
  if (fabs(c) <= PARALLEL) {
    // The equations are decoupled.
    const double x = sqrt(a / k[0]), y = sqrt(b / k[1]);
    if (!(x > 0 && y > 0 && isfinite(x) && isfinite(y))) return 0;
    out[0][0] = x;
    out[0][1] = y;
    return 1;
  }
  // y substituted into the second equation
  const double u = a / (2 * c), v = k[0] / (2 * c);
  const double quartic[QUARTIC + 1] = {k[1] * u * u - b, 2 * c, -2 * k[1] * u * v, 0, k[1] * v * v};
  int degree = QUARTIC;
  while (degree > 1 && quartic[degree] == 0) degree--;
  double most = 0, roots[QUARTIC];
  for (int i = 0; i < degree; i++) most = fmax(most, fabs(quartic[i] / quartic[degree]));
  const size_t found = positive_roots(quartic, degree, 1 + most, roots);
  for (size_t i = 0; i < found; i++) {
    const double y = u - v * roots[i] * roots[i];
    if (!(y > 0) || !(roots[i] > 0)) continue;
    out[n][0] = roots[i];
    out[n++][1] = y;
  }
  return n;
}

// --- Continuation ---

CagStatus cag_bezier_join(const CagCurve *c, int m, int order, double ratio, CagVec3 *out,
                          CagError *err) {
  char text[32];
  if (order < 0 || order > 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_order, "order", -1,
                    "the order of a join must be 0, 1, or 2, found %d", order);
  if (m < 1 || m < order)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_order, "degree", -1,
                    "a curve of degree %d cannot continue a derivative of order %d", m,
                    order < 1 ? 1 : order);
  if (!(ratio > 0) || !isfinite(ratio))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_bad_parameter, "ratio", -1,
                    "the ratio of the speeds must be positive and finite, found %s",
                    cag_number_text(ratio, text));
  CagVec3 d[3];
  CagStatus status = cag_curve_eval(c, c->end, order, CAG_SIDE_LEFT, d, err);
  if (status) return status;
  out[0] = d[0];
  if (order > 0) out[1] = cag_madd(d[0], 1 / (ratio * m), d[1]);
  if (order > 1)
    out[2] =
        cag_madd(cag_sub(cag_scaled(out[1], 2), out[0]), 1 / (ratio * ratio * m * (m - 1)), d[2]);
  return CAG_OK;
}
