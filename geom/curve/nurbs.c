// Bezier, B-spline, and NURBS curves: construction, evaluation, and the functions of the kind.

#include "geom/curve/nurbs.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#include "base/assert.h"
#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"

static const CagCurveKind kinds[3];

const CagNurbs *cag_nurbs_data(const CagCurve *c) {
  for (int i = 0; i < 3; i++)
    if (c->kind == &kinds[i]) return (const CagNurbs *)c;
  return NULL;
}

static void destroy(CagCurve *c) {
  CagNurbs *n = (CagNurbs *)c;
  cag_free(n->knots);
  cag_free(n->homogeneous);
  cag_free(n->cuts);
  cag_free(n->bezier);
  cag_free(n->taylor);
}

// --- Construction ---

// Coefficients of (t - end)^k about the end of a piece of length `h` that `b` starts or finishes.
static void taylor_about(const double *b, int p, double h, bool right, double *out) {
  double d[4 * (CAG_NURBS_TAYLOR + 1)], factor = 1;
  for (int i = 0; i <= p; i++) memcpy(d + 4 * i, b + 4 * (right ? p - i : i), 4 * sizeof(double));
  const double step = right ? -h : h;
  for (int k = 0; k <= p; k++) {
    for (int c = 0; c < 4; c++) out[4 * k + c] = factor * d[c];
    for (int i = 0; i < 4 * (p - k); i++) d[i] = d[i + 4] - d[i];
    factor *= (p - k) / ((k + 1) * step);
  }
}

// A piece is narrow if the differences of its Bezier points, over powers of its length, lose digits
// that the differences of the control points, over the surrounding knots, keep.
static bool is_narrow(const CagNurbs *c, size_t span) {
  const double part = 0.01;
  const size_t p = (size_t)c->degree;
  return p > 1 &&
         c->knots[span + 1] - c->knots[span] < part * (c->knots[span + p] - c->knots[span + 1 - p]);
}

static void narrow_taylor(const CagNurbs *c, size_t span, double *out) {
  const int p = c->degree;
  for (int right = 0; right < 2; right++) {
    double *at = out + right * 4 * (p + 1), d[4 * (CAG_NURBS_TAYLOR + 1)], factor = 1;
    cag_bspline_piece_derivatives(c->homogeneous, c->knots, p, span, c->knots[span + (size_t)right],
                                  p, d);
    // The ends keep the values of the Bezier points, which neighbors share.
    for (int k = 1; k <= p; k++) {
      factor /= k;
      for (int i = 0; i < 4; i++)
        at[4 * k + i] = i == 3 && !c->rational ? 0 : factor * d[4 * k + i];
    }
  }
}

static CagStatus make_pieces(CagNurbs *c, CagError *err) {
  const int p = c->degree;
  const size_t stride = 4 * (size_t)(p + 1);
  for (size_t i = (size_t)p; i < c->count; i++) c->pieces += c->knots[i] < c->knots[i + 1];
  c->cuts = cag_malloc(sizeof(double) * (c->pieces + 1));
  c->bezier = cag_malloc(sizeof(double) * c->pieces * stride);
  if (p <= CAG_NURBS_TAYLOR) c->taylor = cag_malloc(sizeof(double) * c->pieces * 2 * stride);
  if (!c->cuts || !c->bezier || (p <= CAG_NURBS_TAYLOR && !c->taylor)) return cag_fail_memory(err);
  size_t n = 0;
  for (size_t i = (size_t)p; i < c->count; i++) {
    if (!(c->knots[i] < c->knots[i + 1])) continue;
    double *b = c->bezier + n * stride;
    cag_bspline_piece(c->homogeneous, c->knots, p, i, b);
    if (cag_stop_check(err)) return err->status;
    if (!c->rational)
      for (int k = 0; k <= p; k++) b[4 * k + 3] = 1;
    // A joint is one point for both of its pieces.
    if (n > 0) memcpy(b - 4, b, 4 * sizeof(double));
    c->cuts[n++] = c->knots[i];
  }
  c->cuts[n] = c->base.end;
  double *last = c->bezier + n * stride - 4;
  if (c->periodic) memcpy(last, c->bezier, 4 * sizeof(double));
  for (size_t i = 0; i <= n; i++) {
    double w = i < n ? c->bezier[i * stride + 3] : last[3];
    char text[32];
    if (!(w > 0))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_denominator, "weights", -1,
                      "all control points that influence t = %s have the weight 0, so the curve is "
                      "0/0 there; make one of these weights positive",
                      cag_number_text(c->cuts[i], text));
  }
  if (c->taylor)
    for (size_t i = 0; i < n; i++)
      for (int right = 0; right < 2; right++)
        taylor_about(c->bezier + i * stride, p, c->cuts[i + 1] - c->cuts[i], right,
                     c->taylor + (2 * i + (size_t)right) * stride);
  for (size_t i = (size_t)p, piece = 0; i < c->count; i++) {
    if (!(c->knots[i] < c->knots[i + 1])) continue;
    if (is_narrow(c, i)) {
      c->has_narrow = true;
      if (c->taylor) narrow_taylor(c, i, c->taylor + 2 * piece * stride);
    }
    piece++;
  }
  // Equally spaced cuts are found without a search. If rounding leads to the wrong cut, it is a
  // neighbor of the right one.
  double step = (c->base.end - c->base.start) / (double)n;
  bool even = true;
  for (size_t i = 0; i < n; i++)
    even = even && fabs(c->cuts[i] - (c->base.start + (double)i * step)) < 0.25 * step;
  if (even) c->per_unit = 1 / step;
  return CAG_OK;
}

CagStatus cag_nurbs_new(const double *homogeneous, size_t n, int degree, const double *knots,
                        bool rational, size_t distinct, CagNurbsKind kind, int dimension,
                        CagCurve **out, CagError *err) {
  CAG_ASSERT(cag_check_knots(knots, n, degree));
  char text[32];
  for (size_t i = 0; rational && i < n; i++)
    if (!(homogeneous[4 * i + 3] >= 0))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weights", (long)i,
                      "weights must not be negative: weights[%zu] = %s", i,
                      cag_number_text(homogeneous[4 * i + 3], text));
  CagCurve *base;
  CagStatus status = cag_curve_block(sizeof(CagNurbs), &kinds[kind], dimension, knots[degree],
                                     knots[n], &base, err);
  if (status) return status;
  CagNurbs *c = (CagNurbs *)base;
  c->degree = degree;
  c->count = n;
  c->periodic = distinct > 0;
  c->distinct = distinct ? distinct : n;
  c->rational = rational;
  c->knots = cag_malloc(sizeof(double) * (n + (size_t)degree + 1));
  c->homogeneous = cag_malloc(sizeof(double) * 4 * n);
  if (c->knots && c->homogeneous) {
    memcpy(c->knots, knots, sizeof(double) * (n + (size_t)degree + 1));
    memcpy(c->homogeneous, homogeneous, sizeof(double) * 4 * n);
    status = make_pieces(c, err);
  } else {
    status = cag_fail_memory(err);
  }
  if (status) {
    cag_curve_release(base);
    return status;
  }
  CagVec3 ends[2] = {cag_project(c->bezier),
                     cag_project(c->bezier + c->pieces * 4 * (size_t)(degree + 1) - 4)};
  base->closed = c->periodic ||
                 cag_norm(cag_sub(ends[0], ends[1])) <= CAG_CURVE_SAME * cag_curve_size(ends, 2);
  *out = base;
  return CAG_OK;
}

#define LIFTS_BETWEEN_LOOKS ((size_t)4096)

// Homogeneous control points, with indices that wrap around up to `stored` >= n; malloc'd.
static CagStatus lift(const CagVec3 *points, const double *weights, size_t n, size_t stored,
                      double **out, CagError *err) {
  CagStatus status = cag_curve_check_points(points, n, "points", err);
  if (status) return status;
  char text[32];
  bool positive = !weights;
  for (size_t i = 0; weights && i < n; i++) {
    if (!isfinite(weights[i]))
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "weights", (long)i,
                      "weights[%zu] is not a finite number", i);
    if (weights[i] < 0)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weights", (long)i,
                      "weights must not be negative: weights[%zu] = %s", i,
                      cag_number_text(weights[i], text));
    positive = positive || weights[i] > 0;
  }
  if (!positive)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_denominator, "weights", -1,
                    "all weights are 0; at least one must be positive");
  double *h = cag_malloc(sizeof(double) * 4 * stored);
  if (!h) return cag_fail_memory(err);
  for (size_t i = 0; i < stored; i++) {
    if (i % LIFTS_BETWEEN_LOOKS == 0 && cag_stop_check(err)) {
      cag_free(h);
      return err->status;
    }
    const CagVec3 p = points[i % n];
    const double w = weights ? weights[i % n] : 1;
    h[4 * i] = w * p.x;
    h[4 * i + 1] = w * p.y;
    h[4 * i + 2] = w * p.z;
    h[4 * i + 3] = w;
  }
  *out = h;
  return CAG_OK;
}

CagStatus cag_curve_nurbs(const CagVec3 *points, const double *weights, size_t n, int degree,
                          const double *knots, int dimension, CagCurve **out, CagError *err) {
  CagStatus status = cag_knots_check(knots, n, degree, err);
  if (status) return status;
  double *h;
  status = lift(points, weights, n, n, &h, err);
  if (status) return status;
  status = cag_nurbs_new(h, n, degree, knots, weights != NULL, 0,
                         weights ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE, dimension, out, err);
  cag_free(h);
  return status;
}

// Degree 0. The weight cancels, but must be valid.
static CagStatus single_point(const CagVec3 *point, const double *weight, int dimension,
                              CagCurve **out, CagError *err) {
  if (weight && *weight == 0)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_zero_denominator, "weights", 0,
                    "the weight of a single control point must not be 0");
  if (weight && !(*weight > 0 && isfinite(*weight)))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_negative_weight, "weights", 0,
                    "the weight of a single control point must be positive and finite");
  return cag_curve_resting(*point, dimension, 0, 1, false, out, err);
}

CagStatus cag_curve_bezier(const CagVec3 *points, const double *weights, size_t n, int dimension,
                           CagCurve **out, CagError *err) {
  if (n == 1) return single_point(points, weights, dimension, out, err);
  CagStatus status = cag_degree_check(n,
                                      n < 2                    ? 1
                                      : n > CAG_MAX_DEGREE + 1 ? CAG_MAX_DEGREE + 1
                                                               : (int)n - 1,
                                      err);
  if (status) return status;
  double knots[2 * (CAG_MAX_DEGREE + 1)], *h;
  cag_knots_open(n, (int)n - 1, knots);
  status = lift(points, weights, n, n, &h, err);
  if (status) return status;
  status = cag_nurbs_new(h, n, (int)n - 1, knots, weights != NULL, 0, CAG_NURBS_BEZIER, dimension,
                         out, err);
  cag_free(h);
  return status;
}

CagStatus cag_curve_nurbs_closed(const CagVec3 *points, const double *weights, size_t n, int degree,
                                 int dimension, CagCurve **out, CagError *err) {
  if (n < 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "a closed curve needs at least 2 control points, found %zu", n);
  if (degree < 1 || degree > CAG_MAX_DEGREE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "degree", -1,
                    "the degree of a closed curve must be 1 to %d, found %d", CAG_MAX_DEGREE,
                    degree);
  const size_t stored = n + (size_t)degree;
  double *h, *knots = cag_malloc(sizeof(double) * (stored + (size_t)degree + 1));
  if (!knots) return cag_fail_memory(err);
  for (size_t i = 0; i < stored + (size_t)degree + 1; i++) knots[i] = (double)i - degree;
  CagStatus status = lift(points, weights, n, stored, &h, err);
  if (!status) {
    status = cag_nurbs_new(h, stored, degree, knots, weights != NULL, n,
                           weights ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE, dimension, out, err);
    cag_free(h);
  }
  cag_free(knots);
  return status;
}

CagStatus cag_knots_make(const char *type, size_t n, int degree, const CagVec3 *points,
                         double *knots, CagError *err) {
  CagStatus status = cag_degree_check(n, degree, err);
  if (status) return status;
  if (strcmp(type, "open") == 0) cag_knots_open(n, degree, knots);
  else if (strcmp(type, "periodic") == 0) cag_knots_periodic(n, degree, knots);
  else if (strcmp(type, "chord") == 0) {
    status = cag_curve_check_points(points, n, "points", err);
    if (!status) cag_knots_chord(points, n, degree, knots);
  } else
    status = cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_knot_type, "knots", -1,
        "`knots` must be \"open\", \"periodic\", \"chord\", or a list of numbers, found \"%s\"",
        type);
  return status;
}

// --- Evaluation ---

size_t cag_nurbs_piece(const CagNurbs *c, double t, CagSide side, size_t hint) {
  const double *cuts = c->cuts;
  size_t i;
  if (hint < c->pieces && cuts[hint] <= t && t < cuts[hint + 1]) {
    i = hint;
  } else if (c->per_unit > 0) {
    double guess = (t - c->base.start) * c->per_unit;
    i = guess > 0 ? (size_t)guess : 0;
    if (i >= c->pieces) i = c->pieces - 1;
    while (i > 0 && t < cuts[i]) i--;
    while (i + 1 < c->pieces && t >= cuts[i + 1]) i++;
  } else {
    size_t lo = 0, hi = c->pieces;
    while (hi - lo > 1) {
      size_t mid = lo + (hi - lo) / 2;
      if (cuts[mid] <= t) lo = mid;
      else hi = mid;
    }
    i = lo;
  }
  if (side == CAG_SIDE_LEFT && i > 0 && t == cuts[i]) i--;
  return i;
}

// Values and derivatives of the Taylor polynomial of degree p at s, four coordinates at a time.
static inline void taylor_point(const double *a, int p, double s, double out[4]) {
  for (int c = 0; c < 4; c++) out[c] = a[4 * p + c];
  for (int k = p - 1; k >= 0; k--)
    for (int c = 0; c < 4; c++) out[c] = out[c] * s + a[4 * k + c];
}

// When inlined with a constant degree and order, the loops below unroll and the factors are
// constants.
static inline void taylor_derivatives(const double *a, int p, double s, int order, double *out) {
  static const double falling[CAG_NURBS_TAYLOR + 1][CAG_NURBS_TAYLOR + 1] = {
      {1, 1, 1, 1}, {0, 1, 2, 3}, {0, 0, 2, 6}, {0, 0, 0, 6}}; // k (k - 1) .. (k - d + 1)
  for (int d = 0; d <= order; d++) {
    double *o = out + 4 * d;
    for (int c = 0; c < 4; c++) o[c] = d > p ? 0 : falling[d][p] * a[4 * p + c];
    for (int k = p - 1; k >= d; k--)
      for (int c = 0; c < 4; c++) o[c] = o[c] * s + falling[d][k] * a[4 * k + c];
  }
}

static void taylor_evaluate(const double *a, int p, double s, int order, double *out) {
  if (p == 3 && order == 1) taylor_derivatives(a, 3, s, 1, out);
  else if (p == 3 && order == 2) taylor_derivatives(a, 3, s, 2, out);
  else if (p == 2 && order == 1) taylor_derivatives(a, 2, s, 1, out);
  else if (p == 2 && order == 2) taylor_derivatives(a, 2, s, 2, out);
  else taylor_derivatives(a, p, s, order, out);
}

// Coefficients about the nearer end of the piece, and the distance from it.
static inline const double *nearer_end(const CagNurbs *c, size_t piece, double t, double *s) {
  const double l = t - c->cuts[piece], r = t - c->cuts[piece + 1];
  const bool right = l > -r;
  *s = right ? r : l;
  return c->taylor + (2 * piece + right) * 4 * (size_t)(c->degree + 1);
}

static void homogeneous_derivatives(const CagNurbs *c, size_t piece, double t, int order,
                                    double *out) {
  if (c->taylor) {
    double s;
    const double *a = nearer_end(c, piece, t, &s);
    taylor_evaluate(a, c->degree, s, order, out);
    return;
  }
  const double length = c->cuts[piece + 1] - c->cuts[piece];
  double u = t == c->cuts[piece + 1] ? 1 : (t - c->cuts[piece]) / length;
  if (order > 0 && c->has_narrow) {
    const size_t span =
        cag_knots_span(c->knots, c->count, c->degree, c->cuts[piece], false, c->count);
    if (is_narrow(c, span)) {
      cag_bspline_piece_derivatives(c->homogeneous, c->knots, c->degree, span, t, order, out);
      for (int k = 1; k <= order && !c->rational; k++) out[4 * k + 3] = 0;
      // The point must equal that of order 0 to the last bit.
      cag_bezier_derivatives(cag_nurbs_bezier(c, piece), c->degree, u, 0, out);
      return;
    }
  }
  cag_bezier_derivatives(cag_nurbs_bezier(c, piece), c->degree, u, order, out);
  double scale = 1;
  for (int k = 1; k <= order; k++) {
    scale /= length;
    for (int i = 0; i < 4; i++) out[4 * k + i] *= scale;
  }
}

static inline void one_point(const CagNurbs *c, size_t piece, double t, CagVec3 *out) {
  double s, h[4];
  const double *a = nearer_end(c, piece, t, &s);
  if (c->degree == 3) taylor_point(a, 3, s, h);
  else if (c->degree == 2) taylor_point(a, 2, s, h);
  else taylor_point(a, 1, s, h);
  *out =
      c->rational ? cag_scaled(cag_vec3(h[0], h[1], h[2]), 1 / h[3]) : cag_vec3(h[0], h[1], h[2]);
}

static inline void evaluate(const CagNurbs *c, size_t piece, double t, int order, CagVec3 *out) {
  double h[4 * (CAG_MAX_DERIVATIVE + 1)];
  if (order == 0 && c->taylor) {
    one_point(c, piece, t, out);
    return;
  }
  homogeneous_derivatives(c, piece, t, order, h);
  if (c->rational) {
    cag_rational_derivatives(h, order, out);
    return;
  }
  for (int k = 0; k <= order; k++) out[k] = cag_vec3(h[4 * k], h[4 * k + 1], h[4 * k + 2]);
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)err;
  const CagNurbs *c = (const CagNurbs *)curve;
  evaluate(c, cag_nurbs_piece(c, t, side, c->pieces), t, order, out);
  return CAG_OK;
}

static CagStatus eval_many(const CagCurve *curve, const double *t, size_t n, int order,
                           CagVec3 *out, CagError *err) {
  const CagNurbs *c = (const CagNurbs *)curve;
  if (cag_nurbs_eval_many(c, t, n, order, out)) return CAG_OK;
  size_t piece = 0;
  for (size_t i = 0; i < n; i++) {
    if (cag_stop_check(err)) return err->status;
    piece = cag_nurbs_piece(c, t[i], CAG_SIDE_RIGHT, piece);
    evaluate(c, piece, t[i], order, out + i * (size_t)(order + 1));
  }
  return CAG_OK;
}

// --- Other functions of the kind ---

static CagNurbsKind kind_of(const CagNurbs *c) { return (CagNurbsKind)(c->base.kind - kinds); }

static size_t distinct_of(const CagNurbs *c) { return c->periodic ? c->distinct : 0; }

static CagStatus to_nurbs(const CagCurve *curve, CagCurve **out, CagError *err) {
  (void)err;
  *out = cag_curve_retain(curve);
  return CAG_OK;
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const CagNurbs *c = (const CagNurbs *)curve;
  double *h = cag_malloc(sizeof(double) * 4 * c->count);
  if (!h) return cag_fail_memory(err);
  const bool affine = cag_transform_is_affine(t);
  const bool rational = c->rational || !affine;
  // An affine map does not change the weights.
  CagTransform m = *t;
  if (affine)
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) m.m[i][j] /= t->m[3][3];
  // z stays 0 for a plane curve under planar maps.
  const int dimension = cag_curve_image_dimension(curve, t);
  CagStatus status = CAG_OK;
  for (size_t i = 0; i < c->count; i++) {
    cag_transform_homogeneous(&m, c->homogeneous + 4 * i, h + 4 * i);
    if (dimension == 2) h[4 * i + 2] = 0;
    if (!affine && h[4 * i + 3] <= 0 && c->homogeneous[4 * i + 3] > 0) {
      status = cag_fail(
          err, CAG_E_DEGENERATE, CAG_ERR_negative_weight, "T", (long)i,
          "the projection maps control point %zu to infinity or behind the center; trim the curve to the part in front of it first",
          i);
      break;
    }
  }
  CagNurbsKind kind = kind_of(c);
  if (!affine && kind == CAG_NURBS_BSPLINE) kind = CAG_NURBS_RATIONAL;
  if (!status)
    status = cag_nurbs_new(h, c->count, c->degree, c->knots, rational, distinct_of(c), kind,
                           dimension, out, err);
  cag_free(h);
  return status;
}

// The part over [a, b], with the ends clamped: raises the ends to multiplicity p by Boehm's
// insertion and keeps what lies between.
CagStatus cag_nurbs_clamped(const CagCurve *curve, double a, double b, CagCurve **out,
                            CagError *err) {
  const CagNurbs *c = (const CagNurbs *)curve;
  const int p = c->degree;
  const size_t room = c->count + 2 * (size_t)p;
  double *data = cag_malloc(sizeof(double) * (5 * room + (size_t)p + 1));
  if (!data) return cag_fail_memory(err);
  double *h = data, *knots = data + 4 * room;
  size_t n = c->count;
  memcpy(h, c->homogeneous, sizeof(double) * 4 * n);
  memcpy(knots, c->knots, sizeof(double) * (n + (size_t)p + 1));
  const double ends[2] = {a, b};
  for (int e = 0; e < 2; e++)
    for (int m = cag_knots_multiplicity(knots, n, p, ends[e]); m < p; m++)
      cag_bspline_insert(h, knots, n++, p, ends[e]);
  size_t first = 0, last = n + (size_t)p; // last knot <= a, first knot >= b
  while (knots[first + 1] <= a) first++;
  while (knots[last - 1] >= b) last--;
  const size_t count = last - first + (size_t)p;
  double *kept = h + 4 * (first - (size_t)p);
  size_t inner = last - first - 1;
  memmove(knots + p + 1, knots + first + 1, sizeof(double) * inner);
  for (int i = 0; i <= p; i++) {
    knots[i] = a;
    knots[(size_t)(p + 1 + i) + inner] = b;
  }
  CagStatus status =
      cag_nurbs_new(kept, count, p, knots, c->rational, 0, kind_of(c), curve->dimension, out, err);
  cag_free(data);
  return status;
}

// The same points over [p->start, p->end], backwards if p->from > p->to.
static CagStatus remapped(const CagCurve *curve, const CagCurvePart *p, CagCurve **out,
                          CagError *err) {
  const CagNurbs *c = (const CagNurbs *)curve;
  const bool backwards = p->from > p->to;
  const size_t n = c->count, m = n + (size_t)c->degree + 1;
  double *data = cag_malloc(sizeof(double) * (4 * n + m));
  if (!data) return cag_fail_memory(err);
  double *h = data, *knots = data + 4 * n;
  for (size_t i = 0; i < n; i++)
    memcpy(h + 4 * i, c->homogeneous + 4 * (backwards ? n - 1 - i : i), 4 * sizeof(double));
  for (size_t i = 0; i < m; i++)
    knots[i] = cag_part_parameter(p, c->knots[backwards ? m - 1 - i : i]);
  CagStatus status = cag_nurbs_new(h, n, c->degree, knots, c->rational, distinct_of(c), kind_of(c),
                                   curve->dimension, out, err);
  cag_free(data);
  return status;
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const double lo = fmin(p->from, p->to), hi = fmax(p->from, p->to);
  CagCurve *cut = NULL;
  CagStatus status = CAG_OK;
  if (lo != curve->start || hi != curve->end) status = cag_nurbs_clamped(curve, lo, hi, &cut, err);
  if (status) return status;
  if (cut && p->from == p->start && p->to == p->end) {
    *out = cut;
    return CAG_OK;
  }
  status = remapped(cut ? cut : curve, p, out, err);
  cag_curve_release(cut);
  return status;
}

static CagBounds hull(const CagCurve *curve, double a, double b) {
  const CagNurbs *c = (const CagNurbs *)curve;
  const int p = c->degree;
  double part[4 * (CAG_MAX_DEGREE + 1)];
  CagBounds box = CAG_BOUNDS_EMPTY;
  size_t from = cag_nurbs_piece(c, a, CAG_SIDE_RIGHT, c->pieces);
  for (size_t i = from; i < c->pieces && (i == from || c->cuts[i] < b); i++) {
    const double *bezier = cag_nurbs_bezier(c, i);
    double length = c->cuts[i + 1] - c->cuts[i];
    double u = fmax(0, (a - c->cuts[i]) / length), v = fmin(1, (b - c->cuts[i]) / length);
    if (u > 0 || v < 1) {
      cag_bezier_segment(bezier, p, u, v, part);
      bezier = part;
    }
    for (int k = 0; k <= p; k++)
      if (bezier[4 * k + 3] > 0) cag_bounds_add(&box, cag_project(bezier + 4 * k));
  }
  return box;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  const CagNurbs *c = (const CagNurbs *)curve;
  for (size_t i = 1; i < c->pieces && i <= capacity; i++) out[i - 1] = c->cuts[i];
  return c->pieces - 1;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const CagNurbs *c = (const CagNurbs *)curve;
  snprintf(buffer, size, "degree %d, %zu points%s", c->degree, c->distinct,
           c->periodic ? ", closed" : "");
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const CagNurbs *c = (const CagNurbs *)curve;
  cag_digest_word(d, (uint64_t)c->degree);
  cag_digest_word(d, c->count);
  cag_digest_numbers(d, c->knots, c->count + (size_t)c->degree + 1);
  cag_digest_numbers(d, c->homogeneous, 4 * c->count);
}

#define NURBS_KIND(NAME)                                                                           \
  { NAME, eval, eval_many, to_nurbs, transform, part, hull, breaks, describe, destroy, digest }
static const CagCurveKind kinds[3] = {NURBS_KIND("bezier"), NURBS_KIND("bspline"),
                                      NURBS_KIND("nurbs")};

bool cag_curve_nurbs_view(const CagCurve *curve, CagNurbsView *out) {
  const CagNurbs *c = cag_nurbs_data(curve);
  if (!c) return false;
  *out = (CagNurbsView){c->degree, c->count,       c->distinct, c->periodic,
                        c->knots,  c->homogeneous, c->rational};
  return true;
}
