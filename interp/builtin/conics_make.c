// Conics made: by their axes, their equation, through points, as arcs, and as points.

#include "base/memory.h"
#include "geom/curve/family.h"
#include "interp/builtin/conics.h"
#include "interp/builtin/holds.h"
#include "interp/builtin/support.h"

// --- Parabola and hyperbola ---

#define FAIL_DOMAIN(call, argument, ...)                                                           \
  cag_fail_core(call, CAG_E_DOMAIN, CAG_ERR_conic_domain, argument, -1, __VA_ARGS__)

// The parameter where x or y is reached; x on the upper half.
typedef bool (*Inverse)(CagCall *call, double a, double b, double value, bool is_x, double *t);

static bool parabola_at(CagCall *call, double a, double b, double value, bool is_x, double *t) {
  (void)b;
  if (is_x && value < 0)
    return FAIL_DOMAIN(call, "x", "a parabola begins at x = 0; it has no point at x = %.17g",
                       value);
  *t = is_x ? sqrt(value / a) : value / (2 * a);
  return true;
}

static bool hyperbola_at(CagCall *call, double a, double b, double value, bool is_x, double *t) {
  if (is_x && value < a)
    return FAIL_DOMAIN(
        call, "x", "the right branch begins at x = %.17g; it has no point at x = %.17g", a, value);
  // asinh of y keeps its digits near the vertex, where acosh of x loses them.
  *t = asinh(is_x ? sqrt((value - a) * (value + a)) / a : value / b);
  return true;
}

// Exactly one of the range, x, and y is given: the range stands three places before x, and y after
// it. Sets the range of the parameter, radians if it is an angle.
static bool find_range(CagCall *call, int x_at, double a, double b, Inverse inverse,
                       CagRangeEnds *range) {
  const bool x = cag_given(call, x_at), y = cag_given(call, x_at + 1);
  if (cag_given(call, x_at - 3) + x + y != 1)
    return cag_fail_call(call, -1, CAG_ERR_value,
                         "needs one of `range`, `x`, and `y`, to select a part of the curve");
  range->angle = false;
  if (x || y) {
    double first, last;
    return cag_arg_interval(call, x ? x_at : x_at + 1, &first, &last, NULL) &&
           inverse(call, a, b, first, x, &range->start) &&
           inverse(call, a, b, last, x, &range->end);
  }
  if (!cag_arg_interval(call, x_at - 3, &range->start, &range->end, &range->angle)) return false;
  if (range->angle) range->start *= CAG_RADIANS_PER_DEGREE;
  if (range->angle) range->end *= CAG_RADIANS_PER_DEGREE;
  return true;
}

bool cag_conics_parabola(CagCall *call, const struct cag_conics_parabola *a, CagValue *result) {
  CagRangeEnds r;
  CagTransform frame;
  CagCurve *c = NULL;
  if (!find_range(call, 4, a->a, 0, parabola_at, &r) ||
      !cag_circle_frame(call, a->center, a->normal, &frame))
    return false;
  CagStatus status =
      cag_curve_parabola(a->a, r.angle ? CAG_FORM_TANGENT : CAG_FORM_QUADRATIC,
                         fmin(r.start, r.end), fmax(r.start, r.end), &frame, &c, call->err);
  return cag_ranged_curve_result(call, status, r.start > r.end, &c, result);
}

bool cag_conics_hyperbola(CagCall *call, const struct cag_conics_hyperbola *a, CagValue *result) {
  CagRangeEnds r;
  CagTransform frame;
  CagCurve *c = NULL;
  if (!find_range(call, 5, a->a, a->b, hyperbola_at, &r) ||
      !cag_circle_frame(call, a->center, a->normal, &frame))
    return false;
  CagStatus status =
      cag_curve_hyperbola(a->a, a->b, r.angle ? CAG_FORM_SECANT : CAG_FORM_HYPERBOLIC,
                          fmin(r.start, r.end), fmax(r.start, r.end), &frame, &c, call->err);
  return cag_ranged_curve_result(call, status, r.start > r.end, &c, result);
}

// --- By equation ---

// 6 numbers, or 3 rows of a symmetric matrix.
static bool read_equation(CagCall *call, int argument, CagConic *out) {
  CagList *list;
  if (!cag_arg_list(call, argument, &list)) return false;
  if (list->dim == 1 && list->length == 6) {
    for (int i = 0; i < 6; i++) out->c[i] = list->as.numbers[i];
  } else if (list->dim == 3 && list->length == 3) {
    const double *s = list->as.numbers;
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < i; j++)
        if (s[3 * i + j] != s[3 * j + i])
          return cag_fail_call(
              call, argument, CAG_ERR_value,
              "expects a symmetric matrix, but rows[%d][%d] and rows[%d][%d] differ", i, j, j, i);
    *out = (CagConic){{s[0], 2 * s[1], s[4], 2 * s[2], 2 * s[5], s[8]}};
  } else {
    return cag_fail_call(call, argument, CAG_ERR_value,
                         "expects the 6 coefficients [A, B, C, D, E, F] of A x^2 + B xy + C y^2 + "
                         "D x + E y + F = 0, or the 3 rows of its symmetric matrix");
  }
  return cag_geometry_ok(call, cag_conic_check(out, call->err));
}

bool cag_arg_conic(CagCall *call, int argument, CagConic *out) {
  CagCurve *c;
  if (call->values[argument].type == CAG_LIST) return read_equation(call, argument, out);
  return cag_arg_curve(call, argument, &c) &&
         cag_geometry_ok(call, cag_conic_of_curve(c, out, call->err));
}

bool cag_conics_conic(CagCall *call, const struct cag_conics_conic *a, CagValue *result) {
  CagConic k;
  CagCurve *c = NULL;
  if (!read_equation(call, 0, &k)) return false;
  if (a->halved) {
    k.c[1] *= 2;
    k.c[3] *= 2;
    k.c[4] *= 2;
  }
  return cag_curve_result(call, cag_curve_conic(&k, &c, call->err), &c, result);
}

bool cag_conics_conic_of_curve(CagCall *call, CagValue *result) {
  CagConic k;
  CagCurve *c = NULL;
  if (!cag_arg_conic(call, 0, &k)) return false;
  return cag_curve_result(call, cag_curve_conic(&k, &c, call->err), &c, result);
}

bool cag_conics_branches(CagCall *call, const struct cag_conics_branches *a, CagValue *result) {
  const CagRangeEnds range = a->range;
  CagConic k;
  CagValue items[2];
  if (!cag_arg_conic(call, 0, &k)) return false;
  if (range.angle) return cag_fail_type(call, 1, "a range of numbers");
  CagCurveList *b = cag_hold_curve_list(call);
  b->items = cag_give_held(call, cag_hold_array(call, 2, sizeof *b->items));
  CagStatus status = cag_conic_branches(&k, range.start, range.end, b->items, &b->count, call->err);
  if (!cag_geometry_ok(call, status)) return false;
  for (size_t i = 0; i < b->count; i++)
    items[i] = cag_curve_value(call->vm, cag_curve_retain(b->items[i]));
  *result = cag_list_values(call->vm, items, b->count);
  return true;
}

// --- From conditions ---

static bool make_by(CagCall *call, const CagVec3 *points, size_t n, const CagConicTangent *tangents,
                    size_t m, CagConicShape shape, CagValue *result) {
  CagConic k;
  CagCurve *c = NULL;
  CagStatus status = cag_conic_from_conditions(points, n, tangents, m, shape, &k, call->err);
  if (!status) status = cag_curve_conic(&k, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

static bool check_plane(CagCall *call, int argument, int dimension) {
  return dimension == 2 || cag_fail_value(call, argument, "points [x, y] of the plane");
}

bool cag_conics_conic_through(CagCall *call, CagValue *result) {
  CagVec3 *points;
  size_t n;
  int dimension;
  if (call->count > 1) {
    // Five points one by one.
    CagVec3 five[5];
    if (call->count != 5)
      return cag_fail_call(call, -1, CAG_ERR_value, "expects 5 points, or one list of them");
    for (int i = 0; i < 5; i++)
      if (!cag_arg_vec(call, i, &five[i], &dimension) || !check_plane(call, i, dimension))
        return false;
    return make_by(call, five, 5, NULL, 0, CAG_CONIC_GENERAL, result);
  }
  if (!cag_arg_points(call, 0, &points, &n, &dimension)) return false;
  cag_hold(call, points);
  return check_plane(call, 0, dimension) &&
         make_by(call, points, n, NULL, 0, CAG_CONIC_GENERAL, result);
}

// A tangent is {point, direction} or [point, direction].
static bool read_tangent(CagCall *call, CagValue v, size_t index, CagConicTangent *out) {
  CagValue part[2] = {cag_unset(), cag_unset()};
  if (v.type == CAG_RECORD) {
    part[0] = cag_record_get(CAG_AS_RECORD(v), "point");
    part[1] = cag_record_get(CAG_AS_RECORD(v), "direction");
  } else if (v.type == CAG_LIST && CAG_AS_LIST(v)->length == 2) {
    for (size_t i = 0; i < 2; i++) part[i] = cag_list_get(call->vm, CAG_AS_LIST(v), i);
  }
  CagVec3 *to[2] = {&out->point, &out->direction};
  for (int i = 0; i < 2; i++) {
    const double *x;
    size_t n;
    if (!cag_as_vector(part[i], &x, &n) || n != 2)
      return cag_fail_call(
          call, 1, CAG_ERR_value,
          "expects tangents as {point: [x, y], direction: [u, v]} or [[x, y], [u, v]]; tangents[%zu] is neither",
          index);
    *to[i] = cag_vec3(x[0], x[1], 0);
  }
  return true;
}

bool cag_conics_conic_by(CagCall *call, CagValue *result) {
  static const char *const kinds[] = {"general", "axis", "circle", "line", NULL};
  CagList *list = NULL;
  CagVec3 *points = NULL;
  size_t n = 0;
  int kind, dimension = 2;
  if (!cag_arg_choice(call, 2, kinds, &kind) ||
      (cag_given(call, 1) && !cag_arg_list(call, 1, &list)))
    return false;
  const bool none = call->values[0].type == CAG_LIST && CAG_AS_LIST(call->values[0])->length == 0;
  if (!none && !cag_arg_points(call, 0, &points, &n, &dimension)) return false;
  cag_hold_for(call, cag_free, points);
  if (!check_plane(call, 0, dimension)) return false;
  const size_t m = list ? list->length : 0;
  CagConicTangent *tangents = cag_hold_array(call, m, sizeof *tangents);
  for (size_t i = 0; i < m; i++)
    if (!read_tangent(call, cag_list_get(call->vm, list, i), i, &tangents[i])) return false;
  return make_by(call, points, n, tangents, m, (CagConicShape)kind, result);
}

// --- Arcs ---

bool cag_conics_conic_arc(CagCall *call, const struct cag_conics_conic_arc *a, CagValue *result) {
  const CagVec3 p = a->P.at, apex = a->apex.at, q = a->Q.at;
  const bool in_space = a->P.dimension == 3 || a->apex.dimension == 3 || a->Q.dimension == 3;
  double weight = a->weight;
  CagCurve *c = NULL;
  if (cag_given(call, 3) + cag_given(call, 4) + cag_given(call, 5) != 1)
    return cag_fail_call(
        call, -1, CAG_ERR_value,
        "needs one of `rho`, `shoulder`, and `weight`, to determine the fullness of the arc");
  if (cag_given(call, 3)) {
    if (!(a->rho >= 0 && a->rho < 1))
      return cag_fail_value(call, 3,
                            "a number from 0 (the chord) to less than 1 (0.5: a parabola)");
    weight = a->rho / (1 - a->rho);
  } else if (cag_given(call, 4) &&
             !cag_geometry_ok(
                 call, cag_conic_shoulder_weight(p, apex, q, a->shoulder.at, &weight, call->err))) {
    return false;
  }
  return cag_curve_result(call, cag_conic_arc(p, apex, q, weight, in_space ? 3 : 2, &c, call->err),
                          &c, result);
}

bool cag_conics_conic_segment(CagCall *call, const struct cag_conics_conic_segment *a,
                              CagValue *result) {
  CagConic k;
  CagCurve *c = NULL;
  if (!cag_arg_conic(call, 0, &k)) return false;
  if (a->x.angle) return cag_fail_type(call, 1, "a range of numbers");
  return cag_curve_result(
      call, cag_conic_segment(&k, a->x.start, a->x.end, a->branch, &c, call->err), &c, result);
}

// --- Points ---

// An arc in the axes of its ellipse: angle from..to of the parameter.
typedef struct Axes {
  CagVec3 center, x, y; // unit vectors
  double a, b, from, to;
} Axes;

static bool read_axes(CagCall *call, const CagCurve *c, Axes *out) {
  CagVec3 x, y, p;
  double rate;
  if (!cag_curve_arc_axes(c, &out->center, &x, &y, &rate))
    return cag_fail_call(call, 0, CAG_ERR_value, "accepts this `by` only for circles and ellipses");
  // Any two conjugate half diameters will do for an arc; from them to the axes the angle shifts.
  const double same = 1e-9; // cosine of axes perpendicular to each other, and angles that are one
  if (fabs(cag_dot(x, y)) > same * cag_norm(x) * cag_norm(y)) {
    const double shift = atan2(2 * cag_dot(x, y), cag_dot(x, x) - cag_dot(y, y)) / 2;
    const CagVec3 axis = cag_madd(cag_scaled(x, cos(shift)), sin(shift), y);
    y = cag_madd(cag_scaled(y, cos(shift)), -sin(shift), x);
    x = axis;
  }
  out->a = cag_norm(x);
  out->b = cag_norm(y);
  out->x = cag_unit(x);
  out->y = cag_unit(y);
  if (!cag_geometry_ok(call, cag_curve_point(c, c->start, &p, call->err))) return false;
  const CagVec3 d = cag_sub(p, out->center);
  out->from = atan2(cag_dot(d, out->y) / out->b, cag_dot(d, out->x) / out->a);
  if (c->angular && fabs(remainder(out->from - c->start, 2 * M_PI)) < same) out->from = c->start;
  out->to = out->from + rate * (c->end - c->start);
  return true;
}

static CagVec3 axes_point(const Axes *k, double x, double y) {
  return cag_madd(cag_madd(k->center, x, k->x), y, k->y);
}

// The polar angle of the point with this parameter: in its quadrant.
static double polar_angle(const Axes *k, double t) {
  double s, c;
  cag_sincos(t, &s, &c);
  return t + (atan2(k->b * s, k->a * c) - atan2(s, c));
}

static bool by_angle(CagCall *call, const CagCurve *c, size_t n, CagVec3 *out) {
  Axes k;
  if (!read_axes(call, c, &k)) return false;
  const double from = polar_angle(&k, k.from), to = polar_angle(&k, k.to);
  for (size_t i = 0; i < n; i++) {
    double s, cosine;
    cag_sincos(from + (to - from) * ((double)i / (double)(n - 1)), &s, &cosine);
    const double r = k.a * k.b / hypot(k.b * cosine, k.a * s);
    out[i] = axes_point(&k, r * cosine, r * s);
  }
  return true;
}

static bool by_rational(CagCall *call, const CagCurve *c, size_t n, CagVec3 *out) {
  Axes k;
  if (!read_axes(call, c, &k)) return false;
  if (fmin(k.from, k.to) <= -M_PI || fmax(k.from, k.to) >= M_PI)
    return FAIL_DOMAIN(
        call, "",
        "the rational form cannot reach 180deg: the arc must lie between -180deg and 180deg");
  const double from = tan(k.from / 2), to = tan(k.to / 2);
  for (size_t i = 0; i < n; i++) {
    const double t = from + (to - from) * ((double)i / (double)(n - 1)), d = 1 + t * t;
    out[i] = axes_point(&k, k.a * ((1 - t) * (1 + t) / d), k.b * (2 * t / d));
  }
  return true;
}

static bool by_length(CagCall *call, const CagCurve *c, size_t n, CagVec3 *out) {
  double whole, t;
  CagStatus status = cag_curve_length(c, c->start, c->end, &whole, call->err);
  for (size_t i = 0; !status && i < n; i++) {
    t = i + 1 == n ? c->end : c->start;
    if (i > 0 && i + 1 < n)
      status = cag_curve_parameter_at_length(c, whole * (double)i / (double)(n - 1), &t, call->err);
    if (!status) status = cag_curve_point(c, t, &out[i], call->err);
  }
  return cag_geometry_ok(call, status);
}

// Halvings that exhaust a double's digits.
#define HALVINGS 100

// The point of abscissa x between t = low, where it is less, and high.
static CagStatus find_x(const CagCurve *c, double x, double low, double high, CagVec3 *out,
                        CagError *err) {
  for (int i = 0; i < HALVINGS; i++) {
    const double m = low + (high - low) / 2;
    CagStatus status = cag_curve_point(c, m, out, err);
    if (status) return status;
    if (m == low || m == high) break;
    if (out->x < x) low = m;
    else high = m;
  }
  return CAG_OK;
}

static bool by_x(CagCall *call, const CagCurve *c, size_t n, CagVec3 *out) {
  CagStatus status = cag_curve_point(c, c->start, &out[0], call->err);
  if (!status) status = cag_curve_point(c, c->end, &out[n - 1], call->err);
  const double from = out[0].x, to = out[n - 1].x;
  CagBounds box = c->kind->hull(c, c->start, c->end);
  const double slack = 1e-9 * (box.max.x - box.min.x);
  if (!status && (box.min.x < fmin(from, to) - slack || box.max.x > fmax(from, to) + slack))
    return FAIL_DOMAIN(call, "", "x must increase or decrease throughout the arc");
  for (size_t i = 1; !status && i + 1 < n; i++) {
    const double x = from + (to - from) * ((double)i / (double)(n - 1));
    status = find_x(c, x, from < to ? c->start : c->end, from < to ? c->end : c->start, &out[i],
                    call->err);
    out[i].x = x;
  }
  return cag_geometry_ok(call, status);
}

static bool by_parameter(CagCall *call, const CagCurve *c, size_t n, CagVec3 *out) {
  return cag_geometry_ok(call, cag_conic_points(c, n, out, call->err));
}

bool cag_conics_conic_points(CagCall *call, const struct cag_conics_conic_points *a,
                             CagValue *result) {
  // In the order of the words of `by`.
  static bool (*const make[])(CagCall *, const CagCurve *, size_t,
                              CagVec3 *) = {by_parameter, by_angle, by_length, by_rational, by_x};
  const CagCurve *c = cag_curve_conic_branch(a->C) ? cag_curve_conic_branch(a->C) : a->C;
  CagVec3 *points = cag_hold(call, cag_malloc(sizeof *points * (size_t)a->n));
  if (!make[a->by](call, c, (size_t)a->n, points)) return false;
  *result = cag_points_value(call->vm, points, (size_t)a->n, c->dimension);
  return true;
}
