// Lines, circles, ellipses and helices.

#include "interp/builtin/curves.h"

static const double FULL_TURN = 6.283185307179586; // 2 pi

bool cag_curves_line(CagCall *call, const struct cag_curves_line *a, CagValue *result) {
  CagCurve *c = NULL;
  CagStatus status = cag_curve_line(
      a->P.at, a->Q.at, a->P.dimension > a->Q.dimension ? a->P.dimension : a->Q.dimension, &c,
      call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_polyline(CagCall *call, CagValue *result) {
  CagVec3 *points;
  size_t n;
  int dimension;
  bool closed;
  CagCurve *c = NULL;
  if (!cag_arg_bool_or(call, 1, false, &closed) ||
      !cag_arg_points(call, 0, &points, &n, &dimension))
    return false;
  cag_hold(call, points);
  CagStatus status = cag_curve_polyline(points, n, closed, dimension, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

// --- Circles and ellipses ---

// A frame at the center with z along the normal. Of a normal along Z its x is X, else x is level.
static CagStatus level_frame(CagVec3 center, CagVec3 normal, CagTransform *out, CagError *err) {
  CagVec3 x = cag_cross(cag_vec3(0, 0, 1), normal);
  if (x.x == 0 && x.y == 0) x = cag_vec3(1, 0, 0);
  return cag_axes(center, x, cag_cross(normal, x), out, err);
}

bool cag_arg_circle_frame(CagCall *call, int at, CagTransform *out) {
  CagVec3 center, normal;
  int dimension = 2;
  bool has_normal = cag_given(call, at + 1);
  if (!cag_arg_vec_or(call, at, cag_vec3(0, 0, 0), &center, &dimension)) return false;
  if (!cag_given(call, at)) dimension = 2;
  *out = cag_translate(center);
  out->planar = dimension == 2 && !has_normal;
  if (!has_normal) return true;
  if (!cag_arg_direction(call, at + 1, center, &normal, NULL) ||
      !cag_geometry_ok(call, level_frame(center, normal, out, call->err)))
    return false;
  out->planar = false;
  return true;
}

// A range of angles, full circle where it is not given.
static bool read_turn(CagCall *call, int argument, double *from, double *to) {
  *from = 0;
  *to = FULL_TURN;
  return !cag_given(call, argument) || cag_arg_parameter_range(call, argument, true, from, to);
}

// The arc over a range of angles; from the larger to the smaller one it runs clockwise.
static bool give_arc(CagCall *call, double a, double b, double from, double to, int frame_at,
                     CagValue *result) {
  CagTransform frame;
  CagCurve *c = NULL;
  if (!cag_arg_circle_frame(call, frame_at, &frame)) return false;
  CagStatus status = cag_curve_arc(a, b, fmin(from, to), fmax(from, to), &frame, &c, call->err);
  if (status != CAG_OK || from < to) return cag_curve_result(call, status, &c, result);
  CagCurve *clockwise = NULL;
  status = cag_curve_reverse(c, &clockwise, call->err);
  cag_curve_release(c);
  return cag_curve_result(call, status, &clockwise, result);
}

bool cag_curves_circle(CagCall *call, CagValue *result) {
  double radius;
  return cag_arg_positive(call, 0, &radius) &&
         give_arc(call, radius, radius, 0, FULL_TURN, 1, result);
}

bool cag_curves_arc(CagCall *call, CagValue *result) {
  double radius, from, to;
  return cag_arg_positive(call, 0, &radius) && read_turn(call, 1, &from, &to) &&
         give_arc(call, radius, radius, from, to, 2, result);
}

bool cag_curves_ellipse(CagCall *call, CagValue *result) {
  double a, b, from, to;
  return cag_arg_positive(call, 0, &a) && cag_arg_positive(call, 1, &b) &&
         read_turn(call, 2, &from, &to) && give_arc(call, a, b, from, to, 3, result);
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
        "the three points lie on one line (or two are the same): no circle goes through "
        "them");
  // (|a|^2 b - |b|^2 a) x n / 2 |n|^2 leads from the first point to the center.
  CagVec3 w = cag_sub(cag_scaled(b, cag_dot(a, a)), cag_scaled(a, cag_dot(b, b)));
  *center = cag_madd(p[0], 1 / (2 * nn), cag_cross(w, n));
  *normal = n;
  return CAG_OK;
}

static bool read_three(CagCall *call, CagVec3 p[3], int *dimension) {
  *dimension = 2;
  for (int i = 0; i < 3; i++) {
    int d;
    if (!cag_arg_vec(call, i, &p[i], &d)) return false;
    if (d == 3) *dimension = 3;
  }
  return true;
}

bool cag_curves_circle_through(CagCall *call, CagValue *result) {
  CagVec3 p[3], center, normal;
  int dimension;
  CagTransform frame;
  CagCurve *c = NULL;
  if (!read_three(call, p, &dimension) ||
      !cag_geometry_ok(call, circumcircle(p, &center, &normal, call->err)))
    return false;
  double radius = cag_norm(cag_sub(p[0], center));
  CagStatus status = CAG_OK;
  frame = cag_translate(center);
  if (dimension == 3) status = level_frame(center, normal, &frame, call->err);
  frame.planar = dimension == 2;
  if (status == CAG_OK) status = cag_curve_arc(radius, radius, 0, FULL_TURN, &frame, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_arc_through(CagCall *call, CagValue *result) {
  CagVec3 p[3], center, normal;
  int dimension;
  CagTransform frame;
  CagCurve *c = NULL;
  if (!read_three(call, p, &dimension) ||
      !cag_geometry_ok(call, circumcircle(p, &center, &normal, call->err)))
    return false;
  // The first point is at angle 0, and the normal is such that the second comes before the third.
  CagVec3 x = cag_sub(p[0], center), y = cag_cross(normal, x), last = cag_sub(p[2], center);
  double radius = cag_norm(x);
  double sweep = atan2(cag_dot(last, cag_unit(y)), cag_dot(last, cag_unit(x)));
  if (sweep <= 0) sweep += FULL_TURN;
  CagStatus status = cag_axes(center, x, y, &frame, call->err);
  frame.planar = dimension == 2;
  if (status == CAG_OK) status = cag_curve_arc(radius, radius, 0, sweep, &frame, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_curves_helix(CagCall *call, const struct cag_curves_helix *a, CagValue *result) {
  CagCurve *c = NULL;
  CagStatus status = cag_curve_helix(a->radius, a->pitch, a->turns, a->taper, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}
