// Measures of regions, from integrals along their boundaries.

#include "geom/image/silhouette.h"

#include <math.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/line_integral.h"
#include "geom/image/moments.h"

// Relative tolerance of an integral over a smooth piece of a boundary.
#define INTEGRAL 1e-12
// A median is located to this fraction of the size.
#define MEDIAN 1e-13
// Areas on both sides of a median differ by less than this fraction if they are equal.
#define HALVED 1e-11
// Parts into which a smooth piece of the boundary is divided to find its farthest point.
#define FAR_PARTS 64

// --- The center of area ---

// The line x = at, or y = at.
typedef struct Line {
  int axis;
  double at;
} Line;

// The area on the lower side of the line: the integral of min(x, at) dy, or of -min(y, at) dx.
static void below_integrand(void *context, CagVec3 p, CagVec3 d, double *out) {
  const Line *line = context;
  out[0] = line->axis == 0 ? fmin(p.x, line->at) * d.y : -fmin(p.y, line->at) * d.x;
}

static CagStatus area_below(const CagRegion *r, int axis, double at, double *out, CagError *err) {
  Line line = {axis, at};
  double part;
  CagStatus status = CAG_OK;
  *out = 0;
  for (size_t k = 0; !status && k < r->count; k++) {
    const CagCurve *loop = r->loops[k];
    status = cag_curve_integrate(loop, loop->start, loop->end, below_integrand, &line, 1, INTEGRAL,
                                 &part, err);
    if (!status) *out += part;
  }
  return status;
}

// The lowest location in [low, high] below which lies at least the given area, by regula falsi
// with the Illinois modification (Dowell and Jarratt 1971), because the area grows steadily.
static CagStatus level_of_area(const CagRegion *r, int axis, double low, double high, double target,
                               double total, double *out, CagError *err) {
  const double slack = MEDIAN * fmax(high - low, fmax(fabs(low), fabs(high)));
  double f_low = -target, f_high = total - target;
  int side = 0;
  while (high - low > slack) {
    double at = low + (high - low) * (f_low / (f_low - f_high)), f;
    if (!(at > low && at < high)) at = low + (high - low) / 2;
    CagStatus status = area_below(r, axis, at, &f, err);
    if (!status) status = cag_stop_check(err);
    if (status) return status;
    f -= target;
    if (f == 0) {
      low = high = at;
    } else if (f < 0) {
      low = at;
      f_low = f;
      if (side < 0) f_high /= 2;
      side = -1;
    } else {
      high = at;
      f_high = f;
      if (side > 0) f_low /= 2;
      side = 1;
    }
  }
  *out = low + (high - low) / 2;
  return CAG_OK;
}

// If an entire interval halves the area, its middle.
static CagStatus region_median(const CagRegion *r, int axis, const CagBounds *box, double area,
                               double *out, CagError *err) {
  const double low = axis == 0 ? box->min.x : box->min.y;
  const double high = axis == 0 ? box->max.x : box->max.y;
  double from = low, to = high;
  CagStatus status = level_of_area(r, axis, low, high, area * (0.5 - HALVED), area, &from, err);
  if (!status) status = level_of_area(r, axis, low, high, area * (0.5 + HALVED), area, &to, err);
  *out = from + (to - from) / 2;
  return status;
}

// --- Radii ---

static CagStatus distance_at(const CagCurve *c, double t, CagVec3 from, double *out,
                             CagError *err) {
  CagVec3 p;
  CagStatus status = cag_curve_point(c, t, &p, err);
  if (!status) *out = hypot(p.x - from.x, p.y - from.y);
  return status;
}

// The greatest distance over [a, b], which contains a single maximum, by golden sections (Kiefer
// 1953).
static CagStatus farthest_within(const CagCurve *c, double a, double b, CagVec3 from, double *most,
                                 CagError *err) {
  const double golden = 0.6180339887498949;
  // A distance is accurate to rounding if its parameter is accurate to the root of it.
  const int rounds = 44;
  double t[2] = {b - golden * (b - a), a + golden * (b - a)}, d[2];
  CagStatus status = distance_at(c, t[0], from, &d[0], err);
  if (!status) status = distance_at(c, t[1], from, &d[1], err);
  for (int i = 0; !status && i < rounds; i++) {
    const int k = d[0] < d[1]; // the better one stays inside
    if (k) a = t[0];
    else b = t[1];
    t[1 - k] = t[k];
    d[1 - k] = d[k];
    t[k] = k ? a + golden * (b - a) : b - golden * (b - a);
    status = distance_at(c, t[k], from, &d[k], err);
  }
  if (!status) *most = fmax(*most, fmax(d[0], d[1]));
  return status;
}

// The smooth piece [a, b] of a curve.
static CagStatus farthest_of_piece(const CagCurve *c, double a, double b, CagVec3 from,
                                   double *most, CagError *err) {
  double d[FAR_PARTS + 1];
  CagStatus status = CAG_OK;
  for (int i = 0; !status && i <= FAR_PARTS; i++) {
    status = distance_at(c, a + (b - a) * i / FAR_PARTS, from, &d[i], err);
    if (!status) *most = fmax(*most, d[i]);
  }
  for (int i = 0; !status && i <= FAR_PARTS; i++) {
    if ((i > 0 && d[i - 1] > d[i]) || (i < FAR_PARTS && d[i + 1] > d[i])) continue;
    const int before = i > 0 ? i - 1 : 0, after = i < FAR_PARTS ? i + 1 : FAR_PARTS;
    status = farthest_within(c, a + (b - a) * before / FAR_PARTS, a + (b - a) * after / FAR_PARTS,
                             from, most, err);
  }
  return status;
}

static CagStatus farthest_of_curve(const CagCurve *c, CagVec3 from, double *most, CagError *err) {
  const CagVec3 *vertices;
  size_t n;
  bool closed;
  double *cuts;
  if (cag_curve_vertices(c, &vertices, &n, &closed)) {
    for (size_t i = 0; i < n; i++)
      *most = fmax(*most, hypot(vertices[i].x - from.x, vertices[i].y - from.y));
    return CAG_OK;
  }
  CagStatus status = cag_curve_cuts(c, &cuts, &n, err);
  if (status) return status;
  for (size_t i = 0; !status && i + 1 < n; i++) {
    status = farthest_of_piece(c, cuts[i], cuts[i + 1], from, most, err);
    if (!status) status = cag_stop_check(err);
  }
  cag_free(cuts);
  return status;
}

static CagStatus region_radii(const CagRegion *r, CagVec3 from, CagMeasures *m, CagError *err) {
  CagStatus status = CAG_OK;
  m->r_min = INFINITY;
  for (size_t k = 0; !status && k < r->count; k++) {
    double t, distance;
    CagVec3 p;
    status = cag_curve_closest(r->loops[k], from, &t, &p, &distance, err);
    if (!status) m->r_min = fmin(m->r_min, distance);
    if (!status) status = farthest_of_curve(r->loops[k], from, &m->r_max, err);
  }
  return status;
}

// --- Measures ---

static CagStatus third_moments(const CagRegion *r, double area, double third[4], CagError *err) {
  const CagMassOf of = {.region = r};
  CagStatus status = CAG_OK;
  for (int k = 0; !status && k < 4; k++) {
    status = cag_moment(&of, 3 - k, k, &third[k], err);
    if (!status) third[k] /= area;
  }
  return status;
}

static CagStatus fail_empty(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_empty_silhouette, "", -1,
                  "expected a region with an area, found one without");
}

CagStatus cag_measure_region(const CagRegion *r, CagMeasures *out, CagError *err) {
  CagMeasures m = {0};
  CagVec3 center = {0, 0, 0};
  CagBounds box = {0};
  double third[4];
  if (cag_region_is_empty(r)) return fail_empty(err);
  CagStatus status = cag_region_second_moments(r, &m.area, &center, &m.xx, &m.xy, &m.yy, err);
  if (status) return status;
  if (!(m.area > 0)) return fail_empty(err);
  m.centroid[0] = center.x;
  m.centroid[1] = center.y;
  m.xx /= m.area;
  m.xy /= m.area;
  m.yy /= m.area;
  status = third_moments(r, m.area, third, err);
  if (!status) cag_measures_derive(&m, third);
  if (!status) status = cag_region_bounds(r, &box, err);
  for (int axis = 0; !status && axis < 2; axis++)
    status = region_median(r, axis, &box, m.area, &m.center[axis], err);
  if (!status) status = cag_region_perimeter(r, &m.perimeter, err);
  if (!status) status = region_radii(r, center, &m, err);
  for (size_t k = 0; k < r->count; k++) m.holes += r->outer[k] != k;
  m.euler = (long)r->count - 2 * m.holes;
  if (!status) *out = m;
  return status;
}

// --- Comparison ---

CagStatus cag_compare_figures(const CagRaster *a, const CagRaster *b, double *different,
                              double *overlap, CagError *err) {
  size_t both = 0, either = 0;
  if (a->width != b->width || a->height != b->height)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_compared_sizes, "", -1,
                    "expected images of one size, found %zu x %zu and %zu x %zu pixels", a->width,
                    a->height, b->width, b->height);
  for (size_t y = 0; y < a->height; y++) {
    const double *p = cag_raster_at(a, 0, 0, y), *q = cag_raster_at(b, 0, 0, y);
    for (size_t x = 0; x < a->width; x++) {
      both += p[x] > 0 && q[x] > 0;
      either += p[x] > 0 || q[x] > 0;
    }
    if (cag_stopped()) return cag_stop_fail(err);
  }
  *different = (double)(either - both);
  *overlap = either ? (double)both / (double)either : 1;
  return CAG_OK;
}

static CagStatus area_of(const CagRegion *r, double *out, CagError *err) {
  *out = 0;
  return cag_region_is_empty(r) ? CAG_OK : cag_region_area(r, out, NULL, err);
}

CagStatus cag_compare_regions(const CagRegion *a, const CagRegion *b, double *different,
                              double *overlap, CagError *err) {
  CagRegion *common = NULL;
  double area_a, area_b, both = 0;
  CagStatus status = area_of(a, &area_a, err);
  if (!status) status = area_of(b, &area_b, err);
  if (!status) status = cag_region_boolean(CAG_REGION_INTERSECTION, a, b, &common, err);
  if (!status) status = area_of(common, &both, err);
  cag_region_release(common);
  if (status) return status;
  const double either = area_a + area_b - both;
  *different = fmax(0, either - both);
  *overlap = either > 0 ? both / either : 1;
  return CAG_OK;
}
