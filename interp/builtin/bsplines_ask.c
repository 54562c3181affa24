// The spans of a B-spline curve and the control points behind them; circles as NURBS; pictures of
// control polygons and curvature.

#include <limits.h>

#include "base/stop.h"
#include "geom/basis/basis_table.h"
#include "geom/curve/family.h"
#include "geom/curve/nurbs.h"
#include "interp/builtin/curves.h"
#include "interp/builtin/support.h"

// The B-spline of a Bezier or B-spline curve; NULL: it is none, and the error is set.
static const CagNurbs *nurbs_of(CagCall *call, const CagCurve *c) {
  const CagNurbs *nurbs = cag_nurbs_data(c);
  if (!nurbs) cag_fail_no_data(call, c, "control points");
  return nurbs;
}

static CagValue range_of(CagCall *call, const CagNurbs *c, double a, double b) {
  return cag_domain_value(call->vm, c->base.angular, a, b);
}

bool cag_bsplines_spans(CagCall *call, const struct cag_bsplines_spans *a, CagValue *result) {
  const CagNurbs *c = nurbs_of(call, a->C);
  if (!c) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = 0; i < c->pieces; i++)
    if (!cag_builder_add(call->vm, list, range_of(call, c, c->cuts[i], c->cuts[i + 1])))
      return false;
  *result = cag_builder_finish(call->vm, list);
  return true;
}

// Of a closed curve a control point acts about its own place, and where that passes the seam, about
// the other end too: the ranges come one after the other.
bool cag_bsplines_support(CagCall *call, const struct cag_bsplines_support *a, CagValue *result) {
  const CagNurbs *c = nurbs_of(call, a->C);
  long i;
  if (!c || !cag_arg_integer(call, 1, 0, (long)c->distinct - 1, &i)) return false;
  const size_t p = (size_t)c->degree;
  CagBuilder *list = cag_builder_new(call->vm);
  double from = 0, to = 0; // the range in the making, empty at first
  for (size_t k = (size_t)i; k < c->count; k += c->distinct) {
    const double start = fmax(c->knots[k], c->base.start);
    const double end = fmin(c->knots[k + p + 1], c->base.end);
    if (!(start < end)) continue;
    if (from < to && start > to && !cag_builder_add(call->vm, list, range_of(call, c, from, to)))
      return false;
    from = from < to && start <= to ? from : start;
    to = end;
  }
  const CagValue last = from < to ? range_of(call, c, from, to) : cag_none();
  if (c->periodic && !cag_builder_add(call->vm, list, last)) return false;
  *result = c->periodic ? cag_builder_finish(call->vm, list) : last;
  return true;
}

static CagValue control_point(CagCall *call, const CagNurbs *c, size_t i) {
  const double *h = c->homogeneous + 4 * i;
  return h[3] > 0 ? cag_point(call->vm, cag_project(h), c->base.dimension) : cag_none();
}

bool cag_bsplines_acting_points(CagCall *call, const struct cag_bsplines_acting_points *a,
                                CagValue *result) {
  static const char *const names[] = {"span", "indices", "points"};
  const CagNurbs *c = nurbs_of(call, a->C);
  double t;
  if (!c || !cag_arg_at(call, a->C, &t)) return false;
  const size_t p = (size_t)c->degree;
  const size_t span = cag_knots_span(c->knots, c->count, c->degree, t, a->side == CAG_SIDE_LEFT, p);
  CagBuilder *indices = cag_builder_new(call->vm), *points = cag_builder_new(call->vm);
  for (size_t i = span - p; i <= span; i++)
    if (!cag_builder_add(call->vm, indices, cag_number((double)(i % c->distinct))) ||
        !cag_builder_add(call->vm, points, control_point(call, c, i)))
      return false;
  CagValue values[] = {range_of(call, c, c->knots[span], c->knots[span + 1]),
                       cag_builder_finish(call->vm, indices), cag_builder_finish(call->vm, points)};
  *result = cag_record_new(call->vm, names, values, 3);
  return true;
}

// The points that act on a span lie on one line, to rounding.
static bool collinear(const CagNurbs *c, size_t span) {
  const double *h = c->homogeneous + 4 * (span - (size_t)c->degree);
  CagVec3 first = {0}, far = {0};
  double size = 0, length = 0;
  bool begun = false;
  for (int i = 0; i <= c->degree; i++) {
    if (!(h[4 * i + 3] > 0)) continue;
    const CagVec3 p = cag_project(h + 4 * i);
    if (!begun) first = p;
    begun = true;
    size = fmax(size, cag_curve_size(&p, 1));
    const CagVec3 d = cag_sub(p, first);
    if (cag_norm(d) <= length) continue;
    far = d;
    length = cag_norm(d);
  }
  if (!(length > 0)) return true;
  far = cag_scaled(far, 1 / length);
  for (int i = 0; i <= c->degree; i++) {
    if (!(h[4 * i + 3] > 0)) continue;
    const CagVec3 d = cag_sub(cag_project(h + 4 * i), first);
    if (cag_norm(cag_cross(far, d)) > CAG_CURVE_SAME * fmax(size, length)) return false;
  }
  return true;
}

bool cag_bsplines_straight_spans(CagCall *call, const struct cag_bsplines_straight_spans *a,
                                 CagValue *result) {
  const CagNurbs *c = nurbs_of(call, a->C);
  if (!c) return false;
  CagBuilder *list = cag_builder_new(call->vm);
  for (size_t i = (size_t)c->degree; i < c->count; i++) {
    if (!(c->knots[i] < c->knots[i + 1]) || !collinear(c, i)) continue;
    if (!cag_builder_add(call->vm, list, range_of(call, c, c->knots[i], c->knots[i + 1])))
      return false;
  }
  *result = cag_builder_finish(call->vm, list);
  return true;
}

bool cag_bsplines_denominator(CagCall *call, const struct cag_bsplines_denominator *a,
                              CagValue *result) {
  const CagNurbs *c = nurbs_of(call, a->C);
  const long order = a->derivative;
  double t;
  if (!c || !cag_arg_at(call, a->C, &t)) return false;
  const size_t i = cag_nurbs_piece(c, t, (CagSide)a->side, c->pieces);
  const double length = c->cuts[i + 1] - c->cuts[i];
  double out[4 * (CAG_MAX_DERIVATIVE + 1)];
  cag_bezier_derivatives(cag_nurbs_bezier(c, i), c->degree, (t - c->cuts[i]) / length, (int)order,
                         out);
  double value = out[4 * order + 3];
  for (long k = 0; k < order; k++) value /= length;
  return cag_give_number(call, value, result);
}

// --- Circles ---

#define HALF_TURN 180
#define FULL_TURN 6.283185307179586 // 2 pi

// q equal arcs of degree 2 from the angle `from` over the sweep (radians), knots 0..q: the corners
// of the polygon around, with the cosine of half an arc for weight, and the points where it
// touches.
static bool give_arcs(CagCall *call, double radius, double from, double sweep, size_t q,
                      const CagTransform *frame, CagValue *result) {
  const size_t n = 2 * q + 1;
  const bool whole = sweep == FULL_TURN;
  CagCurve *c = NULL;
  CagVec3 *points = cag_hold_array(call, n, sizeof *points);
  double *weights = cag_hold_array(call, 2 * n + 3, sizeof *weights), *knots = weights + n;
  const double half = cos(sweep / 2 / (double)q);
  for (size_t i = 0; i < n; i++) {
    double sine, cosine;
    const size_t k = whole ? i % (n - 1) : i;
    cag_sincos(k == n - 1 ? from + sweep : from + sweep * (double)k / (double)(n - 1), &sine,
               &cosine);
    weights[i] = i % 2 ? half : 1;
    points[i] = cag_transform_point(
        frame, cag_vec3(radius * cosine / weights[i], radius * sine / weights[i], 0));
  }
  for (size_t i = 0; i < n + 3; i++) knots[i] = i == 0 ? 0 : (double)((i - 1) / 2);
  knots[n + 2] = (double)q;
  CagStatus status =
      cag_curve_nurbs(points, weights, n, 2, knots, frame->planar ? 2 : 3, &c, call->err);
  return cag_curve_result(call, status, &c, result);
}

bool cag_bsplines_nurbs_circle(CagCall *call, const struct cag_bsplines_nurbs_circle *a,
                               CagValue *result) {
  CagTransform frame;
  return cag_circle_frame(call, a->center, a->normal, &frame) &&
         give_arcs(call, a->radius, a->start, FULL_TURN, (size_t)a->segments, &frame, result);
}

bool cag_bsplines_nurbs_arc(CagCall *call, const struct cag_bsplines_nurbs_arc *a,
                            CagValue *result) {
  const double from = a->range.start, to = a->range.end, sweep = to - from;
  CagTransform frame;
  char text[32];
  if (!cag_circle_frame(call, a->center, a->normal, &frame)) return false;
  if (!a->range.angle || !isfinite(from) || !isfinite(to))
    return cag_fail_type(call, 1, "a range of angles");
  CagStatus status = CAG_OK;
  if (sweep == 0)
    status = cag_fail(call->err, CAG_E_ARGUMENT, CAG_ERR_empty_range, "range", -1,
                      "the range has no length");
  else if (!(fabs(sweep) / (double)a->segments < HALF_TURN))
    status = cag_fail(
        call->err, CAG_E_ARGUMENT, CAG_ERR_arc_too_wide, "range", -1,
        "one piece of degree 2 must span less than 180 degrees, found %s in %ld; use more `segments`",
        cag_number_text(fabs(sweep), text), a->segments);
  return cag_geometry_ok(call, status) &&
         give_arcs(call, a->radius, from * CAG_RADIANS_PER_DEGREE, sweep * CAG_RADIANS_PER_DEGREE,
                   (size_t)a->segments, &frame, result);
}

// --- Pictures ---

bool cag_bsplines_control_net(CagCall *call, const struct cag_bsplines_control_net *a,
                              CagValue *result) {
  CagCurve *out = NULL;
  const CagVec3 *corners;
  size_t n;
  bool closed;
  if (cag_curve_vertices(a->C, &corners, &n, &closed)) {
    *result = call->values[0];
    return true;
  }
  const CagNurbs *nurbs = nurbs_of(call, a->C);
  if (!nurbs) return false;
  CagVec3 *points = cag_hold_array(call, nurbs->distinct, sizeof *points);
  n = 0;
  for (size_t i = 0; i < nurbs->distinct; i++)
    if (nurbs->homogeneous[4 * i + 3] > 0) points[n++] = cag_project(nurbs->homogeneous + 4 * i);
  CagStatus status =
      cag_curve_polyline(points, n, nurbs->periodic && n > 2, a->C->dimension, &out, call->err);
  return cag_curve_result(call, status, &out, result);
}

// Teeth of a comb for each piece where nothing is said.
#define TEETH 20
#define TEETH_MAX 1000000
// Length of the longest tooth, as part of the size of the curve, where nothing is said.
#define LONGEST_TOOTH 0.25

typedef struct Comb {
  size_t n;
  CagVec3 *feet, *teeth; // curvature vectors, away from the center of curvature
} Comb;

static CagStatus make_comb(const CagCurve *c, Comb *comb, double *most, CagError *err) {
  *most = 0;
  for (size_t i = 0; i < comb->n; i++) {
    const double t = i + 1 == comb->n
                         ? c->end
                         : c->start + (c->end - c->start) * (double)i / (double)(comb->n - 1);
    CagFrenet f;
    CagStatus status = cag_stop_check(err);
    if (!status) status = cag_curve_frenet(c, t, &f, err);
    if (status) return status;
    comb->feet[i] = f.point;
    comb->teeth[i] = cag_scaled(f.normal, -f.curvature);
    *most = fmax(*most, f.curvature);
  }
  return CAG_OK;
}

// Adds a line of the comb to the list.
static bool add_line(CagCall *call, CagStatus status, CagCurve **line, CagBuilder *list) {
  CagValue v;
  return cag_curve_result(call, status, line, &v) && cag_builder_add(call->vm, list, v);
}

static bool give_comb(CagCall *call, const CagCurve *c, const Comb *comb, double scale,
                      CagValue *result) {
  CagVec3 *tips = cag_hold_array(call, comb->n, sizeof *tips);
  CagBuilder *list = cag_builder_new(call->vm);
  CagCurve *line = NULL;
  CagStatus status;
  for (size_t i = 0; i < comb->n; i++) {
    tips[i] = cag_madd(comb->feet[i], scale, comb->teeth[i]);
    if (cag_norm(cag_sub(tips[i], comb->feet[i])) == 0) continue;
    status = cag_curve_line(comb->feet[i], tips[i], c->dimension, &line, call->err);
    if (!add_line(call, status, &line, list)) return false;
  }
  status = cag_curve_polyline(tips, comb->n, false, c->dimension, &line, call->err);
  if (!add_line(call, status, &line, list)) return false;
  *result = cag_group_value(call->vm, cag_builder_finish(call->vm, list));
  return true;
}

bool cag_bsplines_curvature_comb(CagCall *call, const struct cag_bsplines_curvature_comb *a,
                                 CagValue *result) {
  const CagCurve *c = a->C;
  const size_t pieces = (c->kind->breaks ? c->kind->breaks(c, NULL, 0) : 0) + 1;
  const size_t usual = pieces < TEETH_MAX / TEETH ? pieces * TEETH + 1 : TEETH_MAX;
  Comb comb = {.n = cag_given(call, 1) ? (size_t)a->n : usual};
  CagBounds box;
  double scale = a->scale, most = 0;
  if (!cag_geometry_ok(call, cag_curve_bounds(c, &box, call->err))) return false;
  comb.feet = cag_hold_array(call, 2 * comb.n, sizeof(CagVec3));
  comb.teeth = comb.feet + comb.n;
  if (!cag_geometry_ok(call, make_comb(c, &comb, &most, call->err))) return false;
  if (!cag_given(call, 2) && most > 0)
    scale = LONGEST_TOOTH * cag_norm(cag_sub(box.max, box.min)) / most;
  return give_comb(call, c, &comb, scale, result);
}
