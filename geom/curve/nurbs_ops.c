// Splitting, Bezier pieces, degree elevation, and knot insertion of NURBS curves.

#include "geom/curve/nurbs_ops.h"

#include <string.h>

#include "base/memory.h"
#include "base/stop.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"

static CagStatus fail_inside(const CagCurve *c, double t, CagError *err) {
  char x[32], a[32], b[32];
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_parameter_range, "t", -1,
                  "`t` = %s does not lie inside the domain %s..%s", cag_number_text(t, x),
                  cag_number_text(c->start, a), cag_number_text(c->end, b));
}

CagStatus cag_curve_split(const CagCurve *c, double t, CagCurve *out[2], CagError *err) {
  if (!(t > c->start && t < c->end)) return fail_inside(c, t, err);
  CagCurve *first, *second;
  CagStatus status = cag_curve_trim(c, c->start, t, &first, err);
  if (status) return status;
  status = cag_curve_trim(c, t, c->end, &second, err);
  if (status) {
    cag_curve_release(first);
    return status;
  }
  out[0] = first;
  out[1] = second;
  return CAG_OK;
}

CagStatus cag_curve_to_bezier(const CagCurve *c, CagCurve ***out, size_t *n, CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  const CagNurbs *nurbs = cag_nurbs_data(exact);
  const int p = nurbs->degree;
  double knots[2 * (CAG_MAX_DEGREE + 1)];
  cag_knots_open((size_t)p + 1, p, knots);
  CagCurve **pieces = cag_calloc(nurbs->pieces, sizeof *pieces);
  if (!pieces) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < nurbs->pieces; i++)
    status = cag_nurbs_new(cag_nurbs_bezier(nurbs, i), (size_t)p + 1, p, knots, nurbs->rational, 0,
                           CAG_NURBS_BEZIER, c->dimension, &pieces[i], err);
  if (status) {
    for (size_t i = 0; pieces && i < nurbs->pieces; i++) cag_curve_release(pieces[i]);
    cag_free(pieces);
  } else {
    *out = pieces;
    *n = nurbs->pieces;
  }
  cag_curve_release(exact);
  return status;
}

// The curve as an open NURBS with both ends clamped.
static CagStatus clamped(const CagCurve *c, CagCurve **out, CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  const CagNurbs *n = cag_nurbs_data(exact);
  const size_t last = n->count + (size_t)n->degree;
  if (n->knots[0] == exact->start && n->knots[last] == exact->end) {
    *out = exact;
    return CAG_OK;
  }
  status = cag_nurbs_clamped(exact, exact->start, exact->end, out, err);
  cag_curve_release(exact);
  return status;
}

CagStatus cag_curve_clamp(const CagCurve *c, CagCurve **out, CagError *err) {
  return clamped(c, out, err);
}

static CagNurbsKind plain_kind(const CagNurbs *c) {
  return c->rational ? CAG_NURBS_RATIONAL : CAG_NURBS_BSPLINE;
}

// --- Elevation ---

static CagStatus elevate_once(const CagCurve *curve, CagCurve **out, CagError *err) {
  const CagNurbs *c = cag_nurbs_data(curve);
  const int p = c->degree;
  if (p >= CAG_MAX_DEGREE)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "times", -1,
                    "the degree must be at most %d", CAG_MAX_DEGREE);
  const size_t room = 2 * (c->count + (size_t)p + 1);
  double *z = cag_malloc(sizeof(double) * room), *h = cag_malloc(sizeof(double) * 4 * room);
  size_t n = 0;
  CagStatus status = z && h ? CAG_OK : cag_fail_memory(err);
  if (!status) {
    n = cag_bspline_elevated_knots(c->knots, c->count, p, z) - (size_t)p - 2;
    status = cag_bspline_elevate(c->homogeneous, 4, c->knots, c->count, p, z, h, err);
  }
  for (size_t j = 0; !status && !c->rational && j < n; j++) h[4 * j + 3] = 1;
  if (!status) {
    bool bezier = c->pieces == 1 && strcmp(curve->kind->name, "bezier") == 0;
    status = cag_nurbs_new(h, n, p + 1, z, c->rational, 0,
                           bezier ? CAG_NURBS_BEZIER : plain_kind(c), curve->dimension, out, err);
  }
  cag_free(z);
  cag_free(h);
  return status;
}

CagStatus cag_curve_elevate(const CagCurve *c, int times, CagCurve **out, CagError *err) {
  if (times < 0)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_order_range, "times", -1,
                    "`times` must not be negative, found %d", times);
  CagCurve *now, *next;
  CagStatus status = clamped(c, &now, err);
  for (int i = 0; !status && i < times; i++) {
    status = elevate_once(now, &next, err);
    cag_curve_release(now);
    now = next;
  }
  if (!status) *out = now;
  return status;
}

// --- Insertion ---

CagStatus cag_curve_insert_knots(const CagCurve *c, const double *t, size_t n, CagCurve **out,
                                 CagError *err) {
  CagCurve *open;
  CagStatus status = clamped(c, &open, err);
  if (status) return status;
  const CagNurbs *from = cag_nurbs_data(open);
  const int p = from->degree;
  size_t count = from->count;
  double *h = cag_malloc(sizeof(double) * 4 * (count + n));
  double *knots = cag_malloc(sizeof(double) * (count + n + (size_t)p + 1));
  if (!h || !knots) status = cag_fail_memory(err);
  if (!status) {
    memcpy(h, from->homogeneous, sizeof(double) * 4 * count);
    memcpy(knots, from->knots, sizeof(double) * (count + (size_t)p + 1));
  }
  char text[32];
  for (size_t i = 0; !status && i < n; i++) {
    if ((status = cag_stop_check(err)) != CAG_OK) break;
    if (!(t[i] > open->start && t[i] < open->end)) {
      status = fail_inside(open, t[i], err);
    } else if (cag_knots_multiplicity(knots, count, p, t[i]) >= p) {
      status = cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_knot_multiplicity, "t", (long)i,
                        "the knot %s occurs %d times already, as often as degree %d allows",
                        cag_number_text(t[i], text), p, p);
    } else {
      cag_bspline_insert(h, knots, count++, p, t[i]);
    }
  }
  if (!status)
    status = cag_nurbs_new(h, count, p, knots, from->rational, 0, plain_kind(from), open->dimension,
                           out, err);
  cag_free(h);
  cag_free(knots);
  cag_curve_release(open);
  return status;
}

// Blossom of the polynomial on the span, at p arguments.
static void span_blossom(const CagNurbs *c, size_t span, const double *args, double *d,
                         double out[4]) {
  const int p = c->degree;
  memcpy(d, c->homogeneous + 4 * (span - (size_t)p), sizeof(double) * 4 * (size_t)(p + 1));
  for (int s = 1; s <= p; s++)
    for (int i = p; i >= s; i--) {
      const size_t k = span - (size_t)p + (size_t)i;
      const double lo = c->knots[k], hi = c->knots[k + (size_t)(p + 1 - s)];
      const double f = (args[s - 1] - lo) / (hi - lo);
      for (int x = 0; x < 4; x++) d[4 * i + x] = cag_mix(d[4 * (i - 1) + x], d[4 * i + x], f);
    }
  memcpy(out, d + 4 * p, sizeof(double) * 4);
}

// Control points over the refined knots `y` for n points: point j is the blossom at y[j + 1] .. y[j
// + p], on a span of the usable range within the point's support.
static CagStatus refined_points(const CagNurbs *c, const double *y, size_t n, double *h,
                                CagError *err) {
  const size_t p = (size_t)c->degree;
  double *work = cag_malloc(sizeof(double) * 4 * (p + 1));
  if (!work) return cag_fail_memory(err);
  for (size_t j = 0; j < n; j++) {
    double from = fmax(y[j], c->base.start), to = fmin(y[j + p + 1], c->base.end);
    double middle = from + (to - from) / 2;
    size_t span = cag_knots_span(c->knots, c->count, c->degree, middle, false, p);
    span_blossom(c, span, y + j + 1, work, h + 4 * j);
    if (!c->rational) h[4 * j + 3] = 1;
  }
  cag_free(work);
  return CAG_OK;
}

// Uniform knots at half the spacing, with the usable range of the curve.
static CagStatus halve_uniform(const CagNurbs *c, CagCurve **out, CagError *err) {
  const size_t p = (size_t)c->degree, spans = c->count - p, n = 2 * spans + p;
  double *y = cag_malloc(sizeof(double) * (n + p + 1 + 4 * n));
  if (!y) return cag_fail_memory(err);
  double *h = y + n + p + 1;
  const double start = c->base.start, step = (c->base.end - start) / (double)(2 * spans);
  for (size_t i = 0; i < n + p + 1; i++)
    y[i] = i == n ? c->base.end : start + ((double)i - (double)p) * step;
  CagStatus status = refined_points(c, y, n, h, err);
  // A periodic curve's last points are its first, bit for bit.
  const size_t distinct = c->periodic ? 2 * c->distinct : 0;
  for (size_t i = distinct; distinct && i < n; i++)
    memcpy(h + 4 * i, h + 4 * (i - distinct), 4 * sizeof(double));
  if (!status)
    status = cag_nurbs_new(h, n, c->degree, y, c->rational, distinct, plain_kind(c),
                           c->base.dimension, out, err);
  cag_free(y);
  return status;
}

CagStatus cag_curve_insert_midpoints(const CagCurve *c, CagCurve **out, CagError *err) {
  CagCurve *exact;
  CagStatus status = cag_curve_to_nurbs(c, &exact, err);
  if (status) return status;
  const CagNurbs *n = cag_nurbs_data(exact);
  if (strcmp(cag_knots_class(n->knots, n->count, n->degree), "uniform") == 0) {
    status = halve_uniform(n, out, err);
    cag_curve_release(exact);
    return status;
  }
  double *middles = cag_malloc(sizeof(double) * n->pieces);
  if (!middles) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n->pieces; i++)
    middles[i] = n->cuts[i] + (n->cuts[i + 1] - n->cuts[i]) / 2;
  if (!status) status = cag_curve_insert_knots(exact, middles, n->pieces, out, err);
  cag_free(middles);
  cag_curve_release(exact);
  return status;
}
