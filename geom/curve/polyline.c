// Lines and polylines: straight pieces between vertices with given parameters.
//
// Vertex i has the parameter params[i], strictly ascending; a closed polyline stores its first
// vertex again at the end. A line is a polyline of two vertices with another name. Vertices are
// exact from both sides.

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/basis/bernstein.h"
#include "geom/curve/family.h"

typedef struct Polyline {
  CagCurve base;
  size_t n;  // number of vertices, including the repeated first of a closed polyline
  bool ring; // constructed as closed: the last vertex is the first
  CagVec3 *points;
  double *params;
} Polyline;

static const CagCurveKind line_kind, polyline_kind;

static CagStatus make(const CagVec3 *points, const double *params, size_t n, bool ring,
                      const CagCurveKind *kind, int dimension, CagCurve **out, CagError *err) {
  CagCurve *base;
  CagStatus status =
      cag_curve_block(sizeof(Polyline), kind, dimension, params[0], params[n - 1], &base, err);
  if (status) return status;
  Polyline *c = (Polyline *)base;
  c->n = n;
  c->ring = ring;
  c->points = cag_malloc(sizeof *points * n);
  c->params = cag_malloc(sizeof *params * n);
  if (!c->points || !c->params) {
    cag_curve_release(base);
    return cag_fail_memory(err);
  }
  memcpy(c->points, points, sizeof *points * n);
  memcpy(c->params, params, sizeof *params * n);
  const CagVec3 ends[2] = {points[0], points[n - 1]};
  base->closed =
      n > 2 && cag_norm(cag_sub(ends[0], ends[1])) <= CAG_CURVE_SAME * cag_curve_size(ends, 2);
  *out = base;
  return CAG_OK;
}

static void destroy(CagCurve *c) {
  cag_free(((Polyline *)c)->points);
  cag_free(((Polyline *)c)->params);
}

CagStatus cag_curve_line(CagVec3 p, CagVec3 q, int dimension, CagCurve **out, CagError *err) {
  const CagVec3 points[2] = {p, q};
  const double params[2] = {0, 1};
  CagStatus status = cag_curve_check_points(points, 1, "P", err);
  if (!status) status = cag_curve_check_points(points + 1, 1, "Q", err);
  if (status) {
    err->index = -1;
    return status;
  }
  return make(points, params, 2, false, &line_kind, dimension, out, err);
}

CagStatus cag_curve_polyline(const CagVec3 *points, size_t n, bool closed, int dimension,
                             CagCurve **out, CagError *err) {
  CagStatus status = cag_curve_check_points(points, n, "points", err);
  if (status) return status;
  // A closed list may repeat its first point.
  while (closed && n > 1 && memcmp(&points[n - 1], &points[0], sizeof *points) == 0) n--;
  const size_t least = closed ? 3 : 2;
  if (n < least)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_too_few_points, "points", -1,
                    "%s polyline needs at least %zu different points, found %zu",
                    closed ? "a closed" : "a", least, n);
  const size_t stored = n + closed;
  CagVec3 *all = cag_malloc(sizeof *all * stored);
  double *params = cag_malloc(sizeof *params * stored);
  if (all && params) {
    memcpy(all, points, sizeof *all * n);
    if (closed) all[n] = points[0];
    for (size_t i = 0; i < stored; i++) params[i] = (double)i;
    status = make(all, params, stored, closed, &polyline_kind, dimension, out, err);
  } else {
    status = cag_fail_memory(err);
  }
  cag_free(all);
  cag_free(params);
  return status;
}

CagStatus cag_curve_polyline_over(const CagVec3 *points, const double *t, size_t n, int dimension,
                                  CagCurve **out, CagError *err) {
  return make(points, t, n, false, &polyline_kind, dimension, out, err);
}

bool cag_curve_vertices(const CagCurve *curve, const CagVec3 **points, size_t *n, bool *closed) {
  if (curve->kind != &line_kind && curve->kind != &polyline_kind) return false;
  const Polyline *c = (const Polyline *)curve;
  *points = c->points;
  *n = c->n - c->ring;
  *closed = c->ring;
  return true;
}

// Index of the edge that t lies on: 0 .. n - 2.
static size_t edge_of(const Polyline *c, double t, CagSide side) {
  size_t lo = 0, hi = c->n - 1;
  while (hi - lo > 1) {
    size_t mid = lo + (hi - lo) / 2;
    if (c->params[mid] <= t) lo = mid;
    else hi = mid;
  }
  if (side == CAG_SIDE_LEFT && lo > 0 && t == c->params[lo]) lo--;
  return lo;
}

static CagVec3 mixed(CagVec3 p, CagVec3 q, double u) {
  return cag_vec3(cag_mix(p.x, q.x, u), cag_mix(p.y, q.y, u), cag_mix(p.z, q.z, u));
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)err;
  const Polyline *c = (const Polyline *)curve;
  size_t i = edge_of(c, t, side);
  const CagVec3 p = c->points[i], q = c->points[i + 1];
  const double a = c->params[i], b = c->params[i + 1];
  out[0] = t == b ? q : mixed(p, q, (t - a) / (b - a));
  if (order > 0) out[1] = cag_scaled(cag_sub(q, p), 1 / (b - a));
  for (int k = 2; k <= order; k++) out[k] = cag_vec3(0, 0, 0);
  return CAG_OK;
}

static CagStatus to_nurbs(const CagCurve *curve, CagCurve **out, CagError *err) {
  const Polyline *c = (const Polyline *)curve;
  double *knots = cag_malloc(sizeof *knots * (c->n + 2));
  if (!knots) return cag_fail_memory(err);
  memcpy(knots + 1, c->params, sizeof *knots * c->n);
  knots[0] = curve->start;
  knots[c->n + 1] = curve->end;
  CagStatus status = cag_curve_nurbs(c->points, NULL, c->n, 1, knots, curve->dimension, out, err);
  cag_free(knots);
  return status;
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const Polyline *c = (const Polyline *)curve;
  if (!cag_transform_is_affine(t)) return cag_curve_transform_nurbs(curve, t, out, err);
  CagVec3 *images = cag_malloc(sizeof *images * c->n);
  if (!images) return cag_fail_memory(err);
  const int dimension = cag_curve_image_dimension(curve, t);
  for (size_t i = 0; i < c->n; i++) {
    images[i] = cag_transform_point(t, c->points[i]);
    if (dimension == 2) images[i].z = 0;
  }
  CagStatus status = make(images, c->params, c->n, c->ring, curve->kind, dimension, out, err);
  cag_free(images);
  return status;
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const Polyline *c = (const Polyline *)curve;
  const double lo = fmin(p->from, p->to), hi = fmax(p->from, p->to);
  const bool whole = lo == curve->start && hi == curve->end;
  const size_t first = edge_of(c, lo, CAG_SIDE_RIGHT), last = edge_of(c, hi, CAG_SIDE_LEFT);
  const size_t n = last - first + 2;
  CagVec3 *points = cag_malloc(sizeof *points * n);
  double *params = cag_malloc(sizeof *params * n);
  CagStatus status = CAG_OK;
  if (!points || !params) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < n; i++) {
    const double t = i == 0 ? lo : i == n - 1 ? hi : c->params[first + i];
    const size_t k = p->from < p->to ? i : n - 1 - i;
    params[k] = cag_part_parameter(p, t);
    status = eval(curve, t, 0, CAG_SIDE_LEFT, &points[k], err);
  }
  if (!status)
    status = make(points, params, n, whole && c->ring, curve->kind, curve->dimension, out, err);
  cag_free(points);
  cag_free(params);
  return status;
}

static CagBounds hull(const CagCurve *curve, double a, double b) {
  const Polyline *c = (const Polyline *)curve;
  CagBounds box = CAG_BOUNDS_EMPTY;
  CagError ignored;
  CagVec3 p;
  eval(curve, a, 0, CAG_SIDE_RIGHT, &p, &ignored);
  cag_bounds_add(&box, p);
  for (size_t i = edge_of(c, a, CAG_SIDE_RIGHT) + 1; i < c->n && c->params[i] < b; i++)
    cag_bounds_add(&box, c->points[i]);
  eval(curve, b, 0, CAG_SIDE_LEFT, &p, &ignored);
  cag_bounds_add(&box, p);
  return box;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  const Polyline *c = (const Polyline *)curve;
  for (size_t i = 1; i + 1 < c->n && i <= capacity; i++) out[i - 1] = c->params[i];
  return c->n - 2;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const Polyline *c = (const Polyline *)curve;
  if (curve->kind == &line_kind) {
    char text[6][32];
    const CagVec3 p = c->points[0], q = c->points[1];
    const double x[6] = {p.x, p.y, p.z, q.x, q.y, q.z};
    for (int i = 0; i < 6; i++) cag_number_text(x[i], text[i]);
    if (curve->dimension == 2)
      snprintf(buffer, size, "[%s, %s] to [%s, %s]", text[0], text[1], text[3], text[4]);
    else
      snprintf(buffer, size, "[%s, %s, %s] to [%s, %s, %s]", text[0], text[1], text[2], text[3],
               text[4], text[5]);
    return;
  }
  snprintf(buffer, size, "%zu points%s", c->n - c->ring, c->ring ? ", closed" : "");
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Polyline *c = (const Polyline *)curve;
  cag_vec3s_digest(c->points, c->n, d);
  cag_digest_numbers(d, c->params, c->n);
}

#define STRAIGHT_KIND(NAME)                                                                        \
  { NAME, eval, NULL, to_nurbs, transform, part, hull, breaks, describe, destroy, digest }
static const CagCurveKind line_kind = STRAIGHT_KIND("line");
static const CagCurveKind polyline_kind = STRAIGHT_KIND("polyline");
