// Arcs of circles and ellipses: center + cos(angle) x + sin(angle) y with any two vectors x, y.
//
// Every affine image of an arc is an arc again: x and y need not be perpendicular. The angle is
// phase + rate * t, which is t itself until the curve is reparametrized. A closed arc ends in its
// first point bit for bit.

#include <float.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Axes are equal and perpendicular within this fraction of their length, so that circles stay
// circles despite rounding.
#define ROUND CAG_ROUNDING

typedef struct Arc {
  CagCurve base;
  double a, b;
  CagTransform frame; // affine; x, y of the curve are a and b times its first two columns
  CagVec3 center, x, y;
  double phase, rate;
} Arc;

static const CagCurveKind arc_kind, circle_kind, ellipse_kind;

static bool is_arc(const CagCurve *c) {
  return c->kind == &arc_kind || c->kind == &circle_kind || c->kind == &ellipse_kind;
}

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static bool is_round(const Arc *c) {
  double xx = cag_dot(c->x, c->x), yy = cag_dot(c->y, c->y);
  return fabs(xx - yy) <= ROUND * xx && fabs(cag_dot(c->x, c->y)) <= ROUND * xx;
}

static bool whole_turns(double sweep) {
  double turns = sweep / (2 * M_PI), whole = nearbyint(turns);
  return whole != 0 && fabs(turns - whole) <= 4 * DBL_EPSILON * fabs(whole);
}

static CagStatus make(double a, double b, const CagTransform *frame, double start, double end,
                      double phase, double rate, int dimension, CagCurve **out, CagError *err) {
  CagCurve *base;
  CagStatus status = cag_curve_block(sizeof(Arc), &arc_kind, dimension, start, end, &base, err);
  if (status) return status;
  Arc *c = (Arc *)base;
  c->a = a;
  c->b = b;
  c->frame = *frame;
  const double w = frame->m[3][3];
  if (w != 1)
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) c->frame.m[i][j] /= w;
  c->x = cag_scaled(column(&c->frame, 0), a);
  c->y = cag_scaled(column(&c->frame, 1), b);
  c->center = column(&c->frame, 3);
  if (dimension == 2) c->x.z = c->y.z = c->center.z = 0;
  c->phase = phase;
  c->rate = rate;
  base->angular = rate == 1;
  base->closed = whole_turns(rate * (end - start));
  if (base->closed) base->kind = is_round(c) ? &circle_kind : &ellipse_kind;
  *out = base;
  return CAG_OK;
}

static CagStatus check_semi(double r, const char *name, CagError *err) {
  char text[32];
  CagStatus status = cag_curve_check_number(r, name, err);
  if (status || r > 0) return status;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_not_positive, name, -1,
                  "`%s` must be positive, found %s", name, cag_number_text(r, text));
}

CagStatus cag_curve_arc(double a, double b, double start, double end, const CagTransform *frame,
                        CagCurve **out, CagError *err) {
  const bool circle = a == b;
  CagStatus status = check_semi(a, circle ? "radius" : "a", err);
  if (!status) status = check_semi(b, circle ? "radius" : "b", err);
  if (!status) status = cag_curve_check_number(start, "range", err);
  if (!status) status = cag_curve_check_number(end, "range", err);
  if (status) return status;
  if (!(start < end))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "range", -1,
                    "the range %.12gdeg..%.12gdeg has no length; its start must be less than its "
                    "end",
                    start * (180 / M_PI), end * (180 / M_PI));
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (!isfinite(frame->m[i][j]))
        return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_finite, "frame", -1,
                        "the arc's frame has an entry that is not a finite number");
  if (!cag_transform_is_affine(frame))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_affine, "frame", -1,
                    "the arc's frame must be affine, found a projection");
  return make(a, b, frame, start, end, 0, 1, frame->planar ? 2 : 3, out, err);
}

bool cag_curve_arc_view(const CagCurve *curve, double *a, double *b, CagTransform *frame) {
  const Arc *c = (const Arc *)curve;
  if (!is_arc(curve) || c->rate != 1 || c->phase != 0) return false;
  *a = c->a;
  *b = c->b;
  *frame = c->frame;
  return true;
}

double cag_curve_stretch(CagVec3 x, CagVec3 y) {
  double xx = cag_dot(x, x), yy = cag_dot(y, y), xy = cag_dot(x, y);
  return sqrt((xx + yy + hypot(xx - yy, 2 * xy)) / 2);
}

bool cag_curve_arc_axes(const CagCurve *curve, CagVec3 *center, CagVec3 *x, CagVec3 *y,
                        double *rate) {
  if (!is_arc(curve)) return false;
  const Arc *c = (const Arc *)curve;
  *center = c->center;
  *x = c->x;
  *y = c->y;
  *rate = c->rate;
  return true;
}

bool cag_curve_arc_coil(const CagCurve *curve, CagCoil *out) {
  if (!is_arc(curve)) return false;
  const Arc *c = (const Arc *)curve;
  *out = (CagCoil){
      .center = c->center, .x = c->x, .y = c->y, .radius = 1, .phase = c->phase, .rate = c->rate};
  return true;
}

static double angle_at(const Arc *c, double t) {
  if (c->base.closed && t == c->base.end) t = c->base.start;
  return c->phase + c->rate * t;
}

// cos x + sin y, turned by k quarter turns: the k-th derivative by the angle.
static CagVec3 turned(const Arc *c, double sine, double cosine, int k) {
  const double s[4] = {sine, cosine, -sine, -cosine}, d[4] = {cosine, -sine, -cosine, sine};
  return cag_madd(cag_scaled(c->x, d[k & 3]), s[k & 3], c->y);
}

static void derivatives(const Arc *c, double t, int order, CagVec3 *out) {
  double s, d, scale = 1;
  cag_sincos(angle_at(c, t), &s, &d);
  out[0] = cag_add(c->center, turned(c, s, d, 0));
  for (int k = 1; k <= order; k++) {
    scale *= c->rate;
    out[k] = cag_scaled(turned(c, s, d, k), scale);
  }
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)side;
  (void)err;
  derivatives((const Arc *)curve, t, order, out);
  return CAG_OK;
}

static CagStatus eval_many(const CagCurve *curve, const double *t, size_t n, int order,
                           CagVec3 *out, CagError *err) {
  (void)err;
  for (size_t i = 0; i < n; i++)
    derivatives((const Arc *)curve, t[i], order, out + i * (size_t)(order + 1));
  return CAG_OK;
}

// Pieces of at most a quarter turn, knots 0, 0, 0, 1, 1, 2, 2, .. (Piegl and Tiller 1997,
// section 7.5).
static CagStatus to_nurbs(const CagCurve *curve, CagCurve **out, CagError *err) {
  const Arc *c = (const Arc *)curve;
  const double from = c->phase + c->rate * curve->start,
               sweep = c->rate * (curve->end - curve->start);
  // A sweep that is a quarter turn up to rounding is one piece.
  const double slack = CAG_PARALLEL;
  const size_t m = (size_t)fmax(1, ceil(fabs(sweep) / (M_PI / 2) - slack)), n = 2 * m + 1;
  CagVec3 *points = cag_malloc(sizeof *points * n);
  double *weights = cag_malloc(sizeof *weights * n), *knots = cag_malloc(sizeof *knots * (n + 3));
  CagStatus status = CAG_OK;
  if (!points || !weights || !knots) status = cag_fail_memory(err);
  if (!status) {
    double half_sine, half_cosine, s, d;
    cag_sincos(sweep / (double)(2 * m), &half_sine, &half_cosine);
    for (size_t i = 0; i < n; i++) {
      size_t k = curve->closed && i == n - 1 ? 0 : i;
      weights[i] = i % 2 ? half_cosine : 1;
      cag_sincos(from + sweep * (double)k / (double)(2 * m), &s, &d);
      points[i] = cag_madd(c->center, 1 / weights[i], turned(c, s, d, 0));
    }
    if (!curve->closed) status = eval(curve, curve->end, 0, CAG_SIDE_LEFT, &points[n - 1], err);
    for (size_t i = 0; i < n + 3; i++) knots[i] = i < 3 ? 0 : (double)((i - 1) / 2);
    knots[n + 2] = (double)m;
  }
  if (!status) status = cag_curve_nurbs(points, weights, n, 2, knots, curve->dimension, out, err);
  cag_free(points);
  cag_free(weights);
  cag_free(knots);
  return status;
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const Arc *c = (const Arc *)curve;
  if (!cag_transform_is_affine(t)) return cag_curve_transform_nurbs(curve, t, out, err);
  CagTransform frame = cag_transform_multiply(t, &c->frame);
  return make(c->a, c->b, &frame, curve->start, curve->end, c->phase, c->rate,
              cag_curve_image_dimension(curve, t), out, err);
}

// Backwards the angle is sum - angle: x and y are rotated and reflected, and the phase stays.
static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const Arc *c = (const Arc *)curve;
  const double rate = c->rate * cag_part_rate(p), phase = c->phase + c->rate * cag_part_origin(p);
  if (rate > 0)
    return make(c->a, c->b, &c->frame, p->start, p->end, phase, rate, curve->dimension, out, err);
  double s, d;
  cag_sincos(phase + c->phase, &s, &d);
  // In units of a and b: x -> cos x + sin y, y -> sin x - cos y.
  CagTransform turn = cag_transform_identity();
  turn.m[0][0] = d;
  turn.m[1][0] = s * (c->b / c->a);
  turn.m[0][1] = s * (c->a / c->b);
  turn.m[1][1] = -d + 0.0;
  CagTransform frame = cag_transform_multiply(&c->frame, &turn);
  return make(c->a, c->b, &frame, p->start, p->end, c->phase, -rate, curve->dimension, out, err);
}

// Exact: the ends, and the extrema of each coordinate inside the range.
static CagBounds hull(const CagCurve *curve, double a, double b) {
  const Arc *c = (const Arc *)curve;
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagVec3 p;
  derivatives(c, a, 0, &p);
  cag_bounds_add(&box, p);
  derivatives(c, b, 0, &p);
  cag_bounds_add(&box, p);
  const double from = c->phase + c->rate * a, to = c->phase + c->rate * b;
  const double x[3] = {c->x.x, c->x.y, c->x.z}, y[3] = {c->y.x, c->y.y, c->y.z};
  const double m[3] = {c->center.x, c->center.y, c->center.z};
  double *lo[3] = {&box.min.x, &box.min.y, &box.min.z};
  double *hi[3] = {&box.max.x, &box.max.y, &box.max.z};
  for (int i = 0; i < 3; i++) {
    double r = hypot(x[i], y[i]), top = atan2(y[i], x[i]);
    if (top + 2 * M_PI * ceil((from - top) / (2 * M_PI)) <= to) *hi[i] = fmax(*hi[i], m[i] + r);
    top += M_PI;
    if (top + 2 * M_PI * ceil((from - top) / (2 * M_PI)) <= to) *lo[i] = fmin(*lo[i], m[i] - r);
  }
  return box;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  (void)curve;
  (void)out;
  (void)capacity;
  return 0;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const Arc *c = (const Arc *)curve;
  char a[32], b[32];
  if (is_round(c)) snprintf(buffer, size, "radius %s", cag_number_text(cag_norm(c->x), a));
  else
    snprintf(buffer, size, "semi-axes %s and %s", cag_number_text(cag_norm(c->x), a),
             cag_number_text(cag_norm(c->y), b));
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Arc *c = (const Arc *)curve;
  cag_vec3s_digest(&c->center, 1, d);
  cag_vec3s_digest(&c->x, 1, d);
  cag_vec3s_digest(&c->y, 1, d);
  cag_digest_number(d, c->phase);
  cag_digest_number(d, c->rate);
}

#define ARC_KIND(NAME)                                                                             \
  { NAME, eval, eval_many, to_nurbs, transform, part, hull, breaks, describe, NULL, digest }
static const CagCurveKind arc_kind = ARC_KIND("arc");
static const CagCurveKind circle_kind = ARC_KIND("circle");
static const CagCurveKind ellipse_kind = ARC_KIND("ellipse");
