// Length, area, planarity.
//
// Lengths and areas are integrals over the smooth pieces; straight pieces and circles have closed
// forms.

#include <float.h>
#include <string.h>

#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/line_integral.h"
#include "geom/curve/nurbs.h"
#include "geom/linalg/tolerance.h"

// Relative tolerance of integrals; 1e-10 is documented.
#define INTEGRAL 1e-13
// Fraction of its size that a curve may deviate from its plane or line.
#define FLAT CAG_COINCIDENT

static void store(double *out, CagVec3 v) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

// The cuts within [a, b], including a and b; malloc'd.
static CagStatus cuts_within(const CagCurve *c, double a, double b, double **out, size_t *n,
                             CagError *err) {
  CagStatus status = cag_curve_cuts(c, out, n, err);
  if (status) return status;
  double *cuts = *out;
  size_t kept = 1;
  for (size_t i = 0; i < *n; i++)
    if (cuts[i] > a && cuts[i] < b) cuts[kept++] = cuts[i];
  // There is room for both ends, since those of the domain are never strictly inside.
  cuts[0] = a;
  cuts[kept++] = b;
  *n = kept;
  return CAG_OK;
}

// --- Length ---

static void speed(void *context, CagVec3 p, CagVec3 d, double *out) {
  (void)context;
  (void)p;
  out[0] = cag_norm(d);
}

// Length of curves with constant speed; false for others.
static bool constant_speed(const CagCurve *c, double *out) {
  CagVec3 center, x, y, d[2];
  double rate, radius, pitch, turns, taper;
  const CagVec3 *points;
  size_t n;
  bool ring;
  CagError ignored;
  const double same = 1e-14;
  if (cag_curve_arc_axes(c, &center, &x, &y, &rate)) {
    double xx = cag_dot(x, x);
    if (fabs(cag_dot(y, y) - xx) > same * xx || fabs(cag_dot(x, y)) > same * xx) return false;
    *out = sqrt(xx) * fabs(rate);
    return true;
  }
  CagTransform frame;
  if (cag_curve_helix_view(c, &radius, &pitch, &turns, &taper, &frame) && taper == 0 &&
      cag_transform_is_similarity(&frame, NULL)) {
    if (cag_curve_eval(c, c->start, 1, CAG_SIDE_RIGHT, d, &ignored)) return false;
    *out = cag_norm(d[1]);
    return true;
  }
  if (cag_curve_vertices(c, &points, &n, &ring) && n == 2) {
    *out = cag_norm(cag_sub(points[1], points[0])) / (c->end - c->start);
    return true;
  }
  return false;
}

static CagStatus piece_length(const CagCurve *c, double a, double b, double *out, CagError *err) {
  double rate, la, lb, v;
  const CagCurve *piece = cag_curve_composite_piece(c, a, b, &la, &lb, &rate);
  if (piece) return piece_length(piece, la, lb, out, err);
  if (constant_speed(c, &v)) {
    *out = v * (b - a);
    return CAG_OK;
  }
  const CagVec3 *points;
  size_t n;
  bool ring;
  CagVec3 ends[2];
  if (cag_curve_vertices(c, &points, &n, &ring)) {
    CagStatus status = cag_curve_eval(c, a, 0, CAG_SIDE_RIGHT, &ends[0], err);
    if (!status) status = cag_curve_eval(c, b, 0, CAG_SIDE_LEFT, &ends[1], err);
    *out = status ? 0 : cag_norm(cag_sub(ends[1], ends[0]));
    return status;
  }
  return cag_curve_integrate(c, a, b, speed, NULL, 1, INTEGRAL, out, err);
}

CagStatus cag_curve_length(const CagCurve *c, double a, double b, double *out, CagError *err) {
  CagVec3 p;
  CagStatus status = cag_curve_point(c, a, &p, err); // checks the ends
  if (!status) status = cag_curve_point(c, b, &p, err);
  if (status) return status;
  a = fmin(fmax(a, c->start), c->end);
  b = fmin(fmax(b, c->start), c->end);
  if (a > b) {
    char x[32], y[32];
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "over", -1,
                    "the range %s..%s is reversed; its start must be less than its end",
                    cag_number_text(a, x), cag_number_text(b, y));
  }
  double *cuts, total = 0, part;
  size_t n;
  status = cuts_within(c, a, b, &cuts, &n, err);
  if (status) return status;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    if (cuts[i] >= cuts[i + 1]) continue;
    status = piece_length(c, cuts[i], cuts[i + 1], &part, err);
    if (!status) total += part;
  }
  cag_free(cuts);
  if (!status) *out = total;
  return status;
}

// Newton's method on the length from a, within a bracket.
static CagStatus solve_length(const CagCurve *c, double a, double b, double total, double s,
                              double *out, CagError *err) {
  const double close = 4 * DBL_EPSILON;
  double lo = a, hi = b, t = a + (b - a) * (s / total), known_t = a, known_s = 0;
  for (int i = 0; i < 200; i++) {
    double part;
    CagStatus status = known_t < t ? piece_length(c, known_t, t, &part, err)
                                   : piece_length(c, t, known_t, &part, err);
    if (status) return status;
    known_s += known_t < t ? part : -part;
    known_t = t;
    double miss = known_s - s;
    if (miss > 0) hi = t;
    else lo = t;
    if (fabs(miss) <= close * total || hi - lo <= close * fmax(fabs(a), fabs(b))) break;
    CagVec3 d[2];
    status = cag_curve_eval(c, t, 1, CAG_SIDE_RIGHT, d, err);
    if (status) return status;
    double v = cag_norm(d[1]), next = v > 0 ? t - miss / v : lo;
    t = next > lo && next < hi ? next : lo + (hi - lo) / 2;
  }
  *out = t;
  return CAG_OK;
}

CagStatus cag_curve_parameter_at_length(const CagCurve *c, double s, double *out, CagError *err) {
  const double slack = CAG_ROUNDING; // relative to the length, since s was computed as well
  CagStatus status = cag_curve_check_number(s, "s", err);
  if (status) return status;
  double *cuts, walked = 0, part = 0;
  size_t n;
  status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  bool found = false;
  for (size_t i = 0; !status && !found && i + 1 < n; i++) {
    status = piece_length(c, cuts[i], cuts[i + 1], &part, err);
    if (status) break;
    if (s >= 0 && s <= walked + part) {
      found = true;
      if (s == walked) *out = cuts[i];
      else if (s == walked + part) *out = cuts[i + 1];
      else status = solve_length(c, cuts[i], cuts[i + 1], part, s - walked, out, err);
    }
    walked += part;
  }
  cag_free(cuts);
  if (status || found) return status;
  if (s > 0 && s <= walked * (1 + slack)) {
    *out = c->end;
    return CAG_OK;
  }
  char a[32], b[32];
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "s", -1,
                  "`s` = %s lies outside 0..%s, the length of the curve", cag_number_text(s, a),
                  cag_number_text(walked, b));
}

// --- Plane and line ---

CagStatus cag_curve_gather(const CagCurve *c, CagVec3 **out, size_t *n, CagError *err) {
  // Samples of a smooth piece of a kind without control points.
  enum { SAMPLES = 32 };
  const CagVec3 *points;
  bool ring;
  const CagNurbs *nurbs = cag_nurbs_data(c);
  size_t count;
  if (nurbs || cag_curve_vertices(c, &points, &count, &ring)) {
    if (nurbs) count = nurbs->count;
    CagVec3 *copy = cag_malloc(sizeof *copy * count);
    if (!copy) return cag_fail_memory(err);
    *n = 0;
    for (size_t i = 0; i < count; i++) {
      if (!nurbs) copy[(*n)++] = points[i];
      else if (nurbs->homogeneous[4 * i + 3] > 0)
        copy[(*n)++] = cag_project(nurbs->homogeneous + 4 * i);
    }
    *out = copy;
    return CAG_OK;
  }
  double *cuts;
  CagStatus status = cag_curve_cuts(c, &cuts, &count, err);
  if (status) return status;
  CagVec3 *samples = cag_malloc(sizeof *samples * ((count - 1) * SAMPLES + 1));
  if (!samples) status = cag_fail_memory(err);
  *n = 0;
  for (size_t i = 0; !status && i + 1 < count; i++)
    for (int k = 0; !status && k < SAMPLES; k++)
      status = cag_curve_eval(c, cuts[i] + (cuts[i + 1] - cuts[i]) * k / SAMPLES, 0, CAG_SIDE_RIGHT,
                              &samples[(*n)++], err);
  if (!status) status = cag_curve_eval(c, c->end, 0, CAG_SIDE_LEFT, &samples[(*n)++], err);
  cag_free(cuts);
  if (status) cag_free(samples);
  else *out = samples;
  return status;
}

// The point farthest from the first one, the point farthest from that, and their distance.
static double longest(const CagVec3 *p, size_t n, CagVec3 *a, CagVec3 *b) {
  size_t i = 0, j = 0;
  for (int round = 0; round < 2; round++) {
    i = j;
    for (size_t k = 0; k < n; k++)
      if (cag_norm(cag_sub(p[k], p[i])) > cag_norm(cag_sub(p[j], p[i]))) j = k;
  }
  *a = p[i];
  *b = p[j];
  return cag_norm(cag_sub(*a, *b));
}

static double from_line(CagVec3 p, CagVec3 a, CagVec3 unit) {
  return cag_norm(cag_cross(cag_sub(p, a), unit));
}

CagStatus cag_curve_is_straight(const CagCurve *c, bool *is, CagError *err) {
  CagVec3 *p, a, b;
  size_t n;
  const CagStatus status = cag_curve_gather(c, &p, &n, err);
  if (status) return status;
  double size = longest(p, n, &a, &b);
  CagVec3 unit = cag_unit(cag_sub(b, a));
  *is = true;
  for (size_t i = 0; i < n; i++) *is = *is && from_line(p[i], a, unit) <= FLAT * size;
  cag_free(p);
  return CAG_OK;
}

// A straight curve lies in many planes; one of them is returned.
CagStatus cag_curve_is_planar(const CagCurve *c, bool *is, CagPlane *plane, CagError *err) {
  if (c->dimension == 2) {
    *is = true;
    if (plane) *plane = (CagPlane){{0, 0, 0}, {0, 0, 1}};
    return CAG_OK;
  }
  CagVec3 *p, a, b, off = {0, 0, 0};
  size_t n;
  const CagStatus status = cag_curve_gather(c, &p, &n, err);
  if (status) return status;
  double size = longest(p, n, &a, &b), farthest = -1;
  CagVec3 unit = cag_unit(cag_sub(b, a));
  for (size_t i = 0; i < n; i++)
    if (from_line(p[i], a, unit) > farthest) {
      farthest = from_line(p[i], a, unit);
      off = p[i];
    }
  CagVec3 normal = cag_unit(cag_cross(unit, cag_sub(off, a)));
  if (farthest <= FLAT * size) {
    // The direction perpendicular to the line that is closest to Z.
    CagVec3 other = fabs(unit.z) < 0.9 ? cag_vec3(0, 0, 1) : cag_vec3(1, 0, 0);
    normal = cag_unit(cag_madd(other, -cag_dot(other, unit), unit));
  }
  *is = true;
  for (size_t i = 0; i < n; i++)
    *is = *is && fabs(cag_dot(cag_sub(p[i], a), normal)) <= FLAT * size;
  cag_free(p);
  if (*is && plane) *plane = (CagPlane){a, normal};
  return CAG_OK;
}

// --- Area ---

typedef struct AreaContext {
  const CagCurve *c;
  CagVec3 origin, x, y;
} AreaContext;

// x dy - y dx, x^2 dy, y^2 dx in the axes of the plane.
static void green(void *context, CagVec3 p, CagVec3 d, double *out) {
  const AreaContext *a = context;
  CagVec3 r = cag_sub(p, a->origin);
  double x = cag_dot(r, a->x), y = cag_dot(r, a->y);
  double dx = cag_dot(d, a->x), dy = cag_dot(d, a->y);
  store(out, cag_vec3(x * dy - y * dx, x * x * dy, y * y * dx));
}

// The same integrals over a straight edge from p to q.
static void green_edge(CagVec3 p, CagVec3 q, double *sum) {
  double cross = p.x * q.y - q.x * p.y;
  sum[0] += cross;
  sum[1] += (p.x * p.x + p.x * q.x + q.x * q.x) / 3 * (q.y - p.y);
  sum[2] += (p.y * p.y + p.y * q.y + q.y * q.y) / 3 * (q.x - p.x);
}

static CagStatus integrate_green(AreaContext *a, double *sum, CagError *err) {
  const CagVec3 *points;
  size_t n;
  bool ring;
  memset(sum, 0, 3 * sizeof *sum);
  if (cag_curve_vertices(a->c, &points, &n, &ring)) {
    CagVec3 p = {0, 0, 0};
    for (size_t i = 1; i < n + ring; i++) {
      CagVec3 r = cag_sub(points[i % n], a->origin);
      CagVec3 q = {cag_dot(r, a->x), cag_dot(r, a->y), 0};
      green_edge(p, q, sum);
      p = q;
    }
    return CAG_OK;
  }
  return cag_curve_integrate(a->c, a->c->start, a->c->end, green, a, 3, INTEGRAL, sum, err);
}

CagStatus cag_curve_area(const CagCurve *c, double *area, CagVec3 *centroid, CagError *err) {
  CagPlane plane;
  bool planar;
  if (!c->closed)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_closed, "C", -1,
                    "only a closed curve bounds an area; the ends of this one do not meet");
  CagStatus status = cag_curve_is_planar(c, &planar, &plane, err);
  if (status) return status;
  if (!planar)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_planar, "C", -1,
                    "only a plane curve bounds an area; this one does not lie in a plane");
  AreaContext a = {c, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  status = cag_curve_point(c, c->start, &a.origin, err);
  if (status) return status;
  if (c->dimension == 3) {
    CagVec3 n = plane.normal;
    CagVec3 other = fabs(n.x) < 0.5 ? cag_vec3(1, 0, 0) : cag_vec3(0, 1, 0);
    a.x = cag_unit(cag_madd(other, -cag_dot(other, n), n));
    a.y = cag_cross(n, a.x);
  }
  double sum[3];
  status = integrate_green(&a, sum, err);
  if (status) return status;
  double value = sum[0] / 2, x = 0, y = 0;
  if (value != 0) {
    x = sum[1] / 2 / value;
    y = -sum[2] / 2 / value;
  }
  // In space the orientation of the plane is arbitrary, so the area is counted positive.
  if (area) *area = c->dimension == 3 ? fabs(value) : value;
  if (centroid) *centroid = cag_madd(cag_madd(a.origin, x, a.x), y, a.y);
  return CAG_OK;
}
