// Traced runs as curves: lines, arcs of conics, or cubics through the points.

#include <float.h>
#include <math.h>

#include "base/memory.h"
#include "geom/curve/cubic.h"
#include "geom/meet/section.h"

// Points lie on a line, a plane, or a conic if they are closer to it than this fraction of the
// surface's size, which is their accuracy.
#define EXACT 1e-10
#define FULL_TURN 6.283185307179586

// --- Lines and planes ---

// The two points of the run that are roughly farthest apart, and the point farthest from their
// line.
typedef struct Spread {
  CagVec3 from, to, beside;
  double length, height;
} Spread;

static Spread spread_of(const CagTrace *t) {
  Spread s = {t->points[0], t->points[0], t->points[0], 0, 0};
  for (size_t i = 1; i < t->count; i++) {
    double d = cag_norm(cag_sub(t->points[i], s.from));
    if (d > s.length) {
      s.length = d;
      s.to = t->points[i];
    }
  }
  CagVec3 along = cag_unit(cag_sub(s.to, s.from));
  for (size_t k = 0; k < t->count + t->check_count; k++) {
    CagVec3 p = k < t->count ? t->points[k] : t->checks[k - t->count];
    double d = cag_norm(cag_cross(along, cag_sub(p, s.from)));
    if (d > s.height) {
      s.height = d;
      s.beside = p;
    }
  }
  return s;
}

static CagVec3 point_of(const CagTrace *t, size_t k) {
  return k < t->count ? t->points[k] : t->checks[k - t->count];
}

// A frame of the run's plane; false if it is not planar.
static bool plane_of(const CagTrace *t, const Spread *s, double size, CagTransform *frame) {
  CagVec3 x = cag_unit(cag_sub(s->to, s->from));
  CagVec3 n = cag_unit(cag_cross(x, cag_sub(s->beside, s->from)));
  CagPlane plane = {s->from, n};
  for (size_t k = 0; k < t->count + t->check_count; k++)
    if (fabs(cag_dot(n, cag_sub(point_of(t, k), s->from))) > EXACT * size) return false;
  *frame = cag_plane_frame(&plane);
  return true;
}

// --- Conics ---

// Coordinates in the plane relative to one of its points, in units of `unit`.
typedef struct Chart {
  CagTransform frame;
  double unit;
} Chart;

static CagVec3 in_chart(const Chart *c, CagVec3 p) {
  const CagTransform *f = &c->frame;
  CagVec3 d = cag_sub(p, cag_vec3(f->m[0][3], f->m[1][3], f->m[2][3]));
  return cag_vec3((d.x * f->m[0][0] + d.y * f->m[1][0] + d.z * f->m[2][0]) / c->unit,
                  (d.x * f->m[0][1] + d.y * f->m[1][1] + d.z * f->m[2][1]) / c->unit, 0);
}

// If the gradient vanishes, infinite or not a number.
static double distance_from(const CagConic *k, CagVec3 p) {
  const double *c = k->c;
  double gx = 2 * c[0] * p.x + c[1] * p.y + c[3], gy = c[1] * p.x + 2 * c[2] * p.y + c[4];
  return fabs(cag_conic_value(k, p)) / hypot(gx, gy);
}

static bool fits(const CagTrace *t, const Chart *chart, const CagConic *k, double size) {
  for (size_t i = 0; i < t->count + t->check_count; i++)
    if (!(distance_from(k, in_chart(chart, point_of(t, i))) * chart->unit <= EXACT * size))
      return false;
  return true;
}

enum { NEEDED = 5 };

// The same number of the run's points, spread over its length.
static void spread_points(const CagTrace *t, size_t distinct, CagVec3 *out) {
  const size_t parts = t->closed ? NEEDED : NEEDED - 1;
  double whole = 0, length = 0;
  for (size_t i = 1; i < t->count; i++) whole += cag_norm(cag_sub(t->points[i], t->points[i - 1]));
  size_t at = 0;
  for (size_t k = 0; k < NEEDED; k++) {
    // After the previous one, and leaving enough points for the rest.
    const size_t least = k == 0 ? 0 : at + 1, most = distinct - (NEEDED - k);
    for (; at < least || (at < most && length * (double)parts < (double)k * whole); at++)
      length += cag_norm(cag_sub(t->points[at + 1], t->points[at]));
    out[k] = t->points[at];
  }
}

// The conic through five of the points. At least two more are needed to verify it.
static CagStatus guess(const CagTrace *t, const Chart *chart, CagConic *out, bool *found,
                       CagError *err) {
  enum { TRIED = 2 };
  CagVec3 p[NEEDED];
  *found = false;
  size_t distinct = t->closed ? t->count - 1 : t->count;
  if (distinct + t->check_count < NEEDED + TRIED) return CAG_OK;
  if (distinct >= NEEDED) spread_points(t, distinct, p);
  else
    for (size_t i = 0; i < NEEDED; i++)
      p[i] = point_of(t, i < distinct ? i : t->count + i - distinct);
  for (size_t i = 0; i < NEEDED; i++) p[i] = in_chart(chart, p[i]);
  const CagStatus status =
      cag_conic_from_conditions(p, NEEDED, NULL, 0, CAG_CONIC_GENERAL, out, err);
  *found = !status;
  return cag_is_final(status) ? status : CAG_OK;
}

// Whether the rounding of coordinates about the conic's center is below the accuracy of the points.
static bool is_near(const Chart *chart, const CagConicClass *k, double size) {
  return (cag_norm(k->center) + k->a) * chart->unit * 2 * DBL_EPSILON <= EXACT * size;
}

// The least-squares parabola through the points whose axis is that of the conic's smaller
// eigenvalue: h = k0 + k1 s + k2 s^2 along the axis.
static void flatten(const CagTrace *t, const Chart *chart, CagConic *conic) {
  double *c = conic->c;
  const double w = atan2(c[1], c[0] - c[2]) / 2 + (c[0] + c[2] < 0 ? FULL_TURN / 4 : 0);
  const double x = cos(w), y = sin(w);
  // Polynomials 1, s - p, (s - q) (s - p) - r that are orthogonal on the points.
  const size_t n = t->count + t->check_count;
  double p = 0, q = 0, r = 0, square = 0, fourth = 0, k[3] = {0};
  for (size_t i = 0; i < n; i++) {
    const CagVec3 at = in_chart(chart, point_of(t, i));
    p += (x * at.x + y * at.y) / (double)n;
  }
  for (size_t i = 0; i < n; i++) {
    const CagVec3 at = in_chart(chart, point_of(t, i));
    const double s = x * at.x + y * at.y, d = s - p;
    square += d * d;
    q += d * d * s;
  }
  q /= square;
  r = square / (double)n;
  for (size_t i = 0; i < n; i++) {
    const CagVec3 at = in_chart(chart, point_of(t, i));
    const double s = x * at.x + y * at.y, h = x * at.y - y * at.x, d = s - p, e = (s - q) * d - r;
    k[0] += h / (double)n;
    k[1] += h * d / square;
    k[2] += h * e;
    fourth += e * e;
  }
  k[2] /= fourth;
  // k0 + k1 (s - p) + k2 (s^2 - (p + q) s + p q - r) - h = 0
  const double linear = k[1] - k[2] * (p + q);
  c[0] = k[2] * x * x;
  c[1] = 2 * k[2] * x * y;
  c[2] = k[2] * y * y;
  c[3] = linear * x + y;
  c[4] = linear * y - x;
  c[5] = k[0] - k[1] * p + k[2] * (p * q - r);
}

// The frame of the conic's axes in the world: x, y rotated by the angle about its center.
static CagTransform own_frame(const Chart *chart, const CagConicClass *k, bool other_branch) {
  double turn = k->angle + (other_branch ? FULL_TURN / 2 : 0), c = cos(turn), s = sin(turn);
  CagTransform in_plane = {.m = {{c, -s, 0, k->center.x * chart->unit},
                                 {s, c, 0, k->center.y * chart->unit},
                                 {0, 0, 1, 0},
                                 {0, 0, 0, 1}}};
  return cag_transform_multiply(&chart->frame, &in_plane);
}

static CagStatus ellipse_arc(const CagTrace *t, const Chart *chart, const CagConicClass *k,
                             CagCurve **out, CagError *err) {
  CagTransform frame = own_frame(chart, k, false);
  Chart own = {frame, 1};
  double a = k->a * chart->unit, b = k->b * chart->unit, from = 0, sum = 0, before = 0;
  if (t->closed) return cag_curve_arc(a, b, 0, FULL_TURN, &frame, out, err);
  for (size_t i = 0; i < t->count; i++) {
    CagVec3 p = in_chart(&own, t->points[i]);
    double angle = atan2(p.y / b, p.x / a);
    if (i == 0) from = angle;
    else sum += remainder(angle - before, FULL_TURN);
    before = angle;
  }
  double start = fmin(from, from + sum);
  double whole = start < 0 ? FULL_TURN : 0;
  return cag_curve_arc(a, b, start + whole, start + whole + fabs(sum), &frame, out, err);
}

static CagStatus open_arc(const CagTrace *t, const Chart *chart, const CagConicClass *k,
                          CagCurve **out, CagError *err) {
  bool parabola = k->eccentricity == 1;
  CagTransform frame = own_frame(chart, k, false);
  Chart own = {frame, 1};
  double a = k->a * chart->unit, b = k->b * chart->unit;
  if (!parabola && in_chart(&own, t->points[0]).x < 0) {
    frame = own_frame(chart, k, true);
    own.frame = frame;
  }
  double y0 = in_chart(&own, t->points[0]).y, y1 = in_chart(&own, t->points[t->count - 1]).y;
  double unit = parabola ? 2 * a : b, low = fmin(y0, y1) / unit, high = fmax(y0, y1) / unit;
  if (parabola) return cag_curve_parabola(a, CAG_FORM_QUADRATIC, low, high, &frame, out, err);
  return cag_curve_hyperbola(a, b, CAG_FORM_HYPERBOLIC, asinh(low), asinh(high), &frame, out, err);
}

// *out is NULL if the run is not an arc of a conic.
static CagStatus conic_arc(const CagTrace *t, const CagQuadric *quadric, const Spread *s,
                           double size, CagCurve **out, CagError *err) {
  Chart chart = {.unit = s->length / 2};
  CagConic conic;
  CagConicClass k;
  *out = NULL;
  if (!plane_of(t, s, size, &chart.frame)) return CAG_OK;
  if (quadric) {
    CagTransform scaled = chart.frame;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) scaled.m[i][j] *= chart.unit;
    cag_quadric_section(quadric, &scaled, &conic);
  } else {
    bool found;
    const CagStatus status = guess(t, &chart, &conic, &found, err);
    if (status || !found) return status;
  }
  if (!fits(t, &chart, &conic, size)) return CAG_OK;
  if (cag_conic_classify(&conic, &k, err) || !(k.a > 0)) return CAG_OK;
  if (!is_near(&chart, &k, size)) {
    flatten(t, &chart, &conic);
    if (!fits(t, &chart, &conic, size) || cag_conic_classify(&conic, &k, err) || !(k.a > 0) ||
        !is_near(&chart, &k, size))
      return CAG_OK;
  }
  if (k.eccentricity < 1) return ellipse_arc(t, &chart, &k, out, err);
  return t->closed ? CAG_OK : open_arc(t, &chart, &k, out, err);
}

// --- Cubics ---

static CagStatus cubics(const CagTrace *t, CagCurve **out, CagError *err) {
  double *parameters = cag_malloc(t->count * sizeof *parameters);
  if (!parameters) return cag_fail_memory(err);
  parameters[0] = 0;
  for (size_t i = 1; i < t->count; i++)
    parameters[i] = parameters[i - 1] + cag_norm(cag_sub(t->points[i], t->points[i - 1]));
  CagStatus status = cag_curve_hermite(t->points, t->tangents, t->count, parameters, 3, out, err);
  cag_free(parameters);
  return status;
}

CagStatus cag_trace_curve(const CagTrace *t, const CagQuadric *quadric, double size, CagCurve **out,
                          CagError *err) {
  Spread s = spread_of(t);
  if (s.height <= EXACT * size && !t->closed)
    return cag_curve_line(t->points[0], t->points[t->count - 1], 3, out, err);
  CagStatus status = conic_arc(t, quadric, &s, size, out, err);
  if (status || *out) return status;
  return cubics(t, out, err);
}
