// Curves that rest in one point: the degenerate half of a split, or a Bezier curve of degree 0.
//
// The domain may be a single parameter. All derivatives are zero, and the tangent is undefined.

#include <stdio.h>

#include "geom/curve/family.h"

typedef struct Point {
  CagCurve base;
  CagVec3 p;
} Point;

static const CagCurveKind point_kind;

CagStatus cag_curve_resting(CagVec3 p, int dimension, double start, double end, bool angular,
                            CagCurve **out, CagError *err) {
  CagCurve *c;
  CagStatus status = cag_curve_check_points(&p, 1, "points", err);
  if (!status) status = cag_curve_block(sizeof(Point), &point_kind, dimension, start, end, &c, err);
  if (status) return status;
  c->angular = angular;
  ((Point *)c)->p = p;
  *out = c;
  return CAG_OK;
}

bool cag_curve_resting_view(const CagCurve *c, CagVec3 *p) {
  if (c->kind != &point_kind) return false;
  if (p) *p = ((const Point *)c)->p;
  return true;
}

static CagStatus eval(const CagCurve *c, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  (void)t;
  (void)side;
  (void)err;
  out[0] = ((const Point *)c)->p;
  for (int k = 1; k <= order; k++) out[k] = cag_vec3(0, 0, 0);
  return CAG_OK;
}

// Degree 1 with two identical control points; a single parameter becomes a unit range.
static CagStatus to_nurbs(const CagCurve *c, CagCurve **out, CagError *err) {
  const CagVec3 p = ((const Point *)c)->p, points[2] = {p, p};
  const double end = c->start < c->end ? c->end : c->start + 1;
  const double knots[4] = {c->start, c->start, end, end};
  return cag_curve_nurbs(points, NULL, 2, 1, knots, c->dimension, out, err);
}

static CagStatus transform(const CagCurve *c, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const int dimension = cag_curve_image_dimension(c, t);
  CagVec3 p = cag_transform_point(t, ((const Point *)c)->p);
  if (dimension == 2) p.z = 0;
  return cag_curve_resting(p, dimension, c->start, c->end, c->angular, out, err);
}

static CagStatus part(const CagCurve *c, const CagCurvePart *p, CagCurve **out, CagError *err) {
  return cag_curve_resting(((const Point *)c)->p, c->dimension, p->start, p->end, c->angular, out,
                           err);
}

static CagBounds hull(const CagCurve *c, double a, double b) {
  (void)a;
  (void)b;
  CagBounds box = CAG_BOUNDS_EMPTY;
  cag_bounds_add(&box, ((const Point *)c)->p);
  return box;
}

static void describe(const CagCurve *c, char *buffer, size_t size) {
  const CagVec3 p = ((const Point *)c)->p;
  char x[3][32];
  cag_number_text(p.x, x[0]);
  cag_number_text(p.y, x[1]);
  cag_number_text(p.z, x[2]);
  if (c->dimension == 2) snprintf(buffer, size, "[%s, %s]", x[0], x[1]);
  else snprintf(buffer, size, "[%s, %s, %s]", x[0], x[1], x[2]);
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const Point *c = (const Point *)curve;
  cag_vec3s_digest(&c->p, 1, d);
}

static const CagCurveKind point_kind = {
    .name = "point",
    .eval = eval,
    .to_nurbs = to_nurbs,
    .transform = transform,
    .part = part,
    .hull = hull,
    .describe = describe,
    .digest = digest,
};
