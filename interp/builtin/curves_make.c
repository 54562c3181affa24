// Lines, circles, ellipses and helices.

#include "interp/builtin/curves.h"

#define FULL_TURN 6.283185307179586 // 2 pi

bool cag_curves_line(CagCall *call, const struct cag_curves_line *a, CagValue *result) {
  CagCurve *c = NULL;
  CagStatus status = cag_curve_line(
      a->P.at, a->Q.at, a->P.dimension > a->Q.dimension ? a->P.dimension : a->Q.dimension, &c,
      call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_polyline(CagCall *call, const struct cag_curves_polyline *a, CagValue *result) {
  CagCurve *c = NULL;
  CagStatus status = cag_curve_polyline(a->points.items, a->points.count, a->closed,
                                        a->points.dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// --- Circles and ellipses ---

// A frame at the center with z along the normal. Of a normal along Z its x is X, else x is level.
static CagStatus level_frame(CagVec3 center, CagVec3 normal, CagTransform *out, CagError *err) {
  CagVec3 x = cag_cross(cag_vec3(0, 0, 1), normal);
  if (x.x == 0 && x.y == 0) x = cag_vec3(1, 0, 0);
  return cag_axes(center, x, cag_cross(normal, x), out, err);
}

bool cag_circle_frame(CagCall *call, CagPoint center, CagPoint normal, CagTransform *out) {
  const bool flat = cag_norm(normal.at) == 0;
  *out = cag_translate(center.at);
  if (!flat && !cag_geometry_ok(call, level_frame(center.at, normal.at, out, call->err)))
    return false;
  out->planar = flat && center.dimension == 2;
  return true;
}

bool cag_ranged_curve_result(CagCall *call, CagStatus status, bool backwards, CagCurve **made,
                             CagValue *result) {
  if (status || !backwards) return cag_curve_result(call, status, made, result);
  CagCurve *reversed = NULL;
  status = cag_curve_reverse(*made, &reversed, call->err);
  cag_curve_release(*made);
  return cag_curve_result(call, status, &reversed, result);
}

// The arc over a range of angles in degrees; from the larger to the smaller one it runs clockwise.
static bool give_arc(CagCall *call, double a, double b, CagRangeEnds range, CagPoint center,
                     CagPoint normal, CagValue *result) {
  CagTransform frame;
  CagCurve *c = NULL;
  if (!cag_circle_frame(call, center, normal, &frame)) return false;
  const double from = range.start * CAG_RADIANS_PER_DEGREE, to = range.end * CAG_RADIANS_PER_DEGREE;
  CagStatus status = cag_curve_arc(a, b, fmin(from, to), fmax(from, to), &frame, &c, call->err);
  return cag_ranged_curve_result(call, status, !(from < to), &c, result);
}

bool cag_curves_circle(CagCall *call, const struct cag_curves_circle *a, CagValue *result) {
  return give_arc(call, a->radius, a->radius, (CagRangeEnds){0, 360, true}, a->center, a->normal,
                  result);
}

bool cag_curves_arc(CagCall *call, const struct cag_curves_arc *a, CagValue *result) {
  if (!a->range.angle) return cag_fail_type(call, 1, "a range of angles");
  return give_arc(call, a->radius, a->radius, a->range, a->center, a->normal, result);
}

bool cag_curves_ellipse(CagCall *call, const struct cag_curves_ellipse *a, CagValue *result) {
  if (!a->range.angle) return cag_fail_type(call, 2, "a range of angles");
  return give_arc(call, a->a, a->b, a->range, a->center, a->normal, result);
}

// --- Through three points ---

// Three points are on one line when their triangle is flatter than this share of its sides.
#define FLAT_TRIANGLE 1e-12

static CagStatus circumcircle(const CagVec3 p[3], CagVec3 *center, CagVec3 *normal, CagError *err) {
  CagVec3 a = cag_sub(p[1], p[0]), b = cag_sub(p[2], p[0]), n = cag_cross(a, b);
  double nn = cag_dot(n, n);
  if (sqrt(nn) <= FLAT_TRIANGLE * cag_norm(a) * cag_norm(b))
    return cag_fail(
        err, CAG_E_ARGUMENT, CAG_ERR_collinear, "", -1,
        "the three points are collinear (or two are the same), so no circle passes through them");
  // (|a|^2 b - |b|^2 a) x n / 2 |n|^2 leads from the first point to the center.
  CagVec3 w = cag_sub(cag_scaled(b, cag_dot(a, a)), cag_scaled(a, cag_dot(b, b)));
  *center = cag_madd(p[0], 1 / (2 * nn), cag_cross(w, n));
  *normal = n;
  return CAG_OK;
}

static int dimension_of_three(CagPoint p, CagPoint q, CagPoint r) {
  return p.dimension == 3 || q.dimension == 3 || r.dimension == 3 ? 3 : 2;
}

bool cag_curves_circle_through(CagCall *call, const struct cag_curves_circle_through *a,
                               CagValue *result) {
  const CagVec3 p[] = {a->P.at, a->Q.at, a->R.at};
  const int dimension = dimension_of_three(a->P, a->Q, a->R);
  CagVec3 center, normal;
  CagTransform frame;
  CagCurve *c = NULL;
  if (!cag_geometry_ok(call, circumcircle(p, &center, &normal, call->err))) return false;
  double radius = cag_norm(cag_sub(p[0], center));
  CagStatus status = CAG_OK;
  frame = cag_translate(center);
  if (dimension == 3) status = level_frame(center, normal, &frame, call->err);
  frame.planar = dimension == 2;
  if (!status) status = cag_curve_arc(radius, radius, 0, FULL_TURN, &frame, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_arc_through(CagCall *call, const struct cag_curves_arc_through *a,
                            CagValue *result) {
  const CagVec3 p[] = {a->P.at, a->Q.at, a->R.at};
  const int dimension = dimension_of_three(a->P, a->Q, a->R);
  CagVec3 center, normal;
  CagTransform frame;
  CagCurve *c = NULL;
  if (!cag_geometry_ok(call, circumcircle(p, &center, &normal, call->err))) return false;
  // The first point is at angle 0, and the normal is such that the second comes before the third.
  CagVec3 x = cag_sub(p[0], center), y = cag_cross(normal, x), last = cag_sub(p[2], center);
  double radius = cag_norm(x);
  double sweep = atan2(cag_dot(last, cag_unit(y)), cag_dot(last, cag_unit(x)));
  if (sweep <= 0) sweep += FULL_TURN;
  CagStatus status = cag_axes(center, x, y, &frame, call->err);
  frame.planar = dimension == 2;
  if (!status) status = cag_curve_arc(radius, radius, 0, sweep, &frame, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_helix(CagCall *call, const struct cag_curves_helix *a, CagValue *result) {
  CagCurve *c = NULL;
  CagStatus status = cag_curve_helix(a->radius, a->pitch, a->turns, a->taper, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}
