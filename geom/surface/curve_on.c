// Curves on surfaces.
//
// Derivatives are exact: the Taylor expansions of both coordinates are substituted into that of the
// surface. Images use `map`, which may be projective; reversed, trimmed, and reparametrized curves
// have another plane curve. The curve is as smooth as the plane curve and the surface: it has a
// break where it crosses a break of the surface. Along closed directions parameters are reduced by
// whole turns.

#include "geom/surface/curve_on.h"

#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/curve/intersect.h"
#include "geom/linalg/tolerance.h"
#include "geom/surface/family.h"

#define MOST_ORDER CAG_MAX_PARTIAL
#define PARTIALS ((MOST_ORDER + 1) * (MOST_ORDER + 1))
// A plane curve may leave the domain by this fraction of its width, to allow for rounding.
#define OUTSIDE CAG_COINCIDENT
// Seams and breaks are crossed once per turn; a curve with more turns does not have enough distinct
// parameters.
#define MOST_TURNS 1000000.0

typedef struct OnSurface {
  CagCurve base;
  CagSurface *surface;
  CagCurve *plane; // same domain
  CagTransform map;
  bool mapped;
  size_t break_count;
  double *breaks;
} OnSurface;

static const CagCurveKind on_surface_kind;

// --- Evaluation ---

// One coordinate of the parameter plane at a point.
typedef struct Coordinate {
  double at;
  CagSide side;
  double step[MOST_ORDER + 1]; // Taylor coefficients without the constant
} Coordinate;

// The side from which the surface's parameter is approached: that of t, reversed if it decreases.
static CagSide side_of(const double *step, int order, CagSide side) {
  for (int k = 1; k <= order; k++) {
    if (step[k] == 0) continue;
    const bool rises = (step[k] > 0) == (side == CAG_SIDE_RIGHT || k % 2 == 0);
    return rises ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
  }
  return CAG_SIDE_RIGHT;
}

static void bring_home(Coordinate *x, double lo, double hi, bool closed) {
  const double period = hi - lo;
  if (closed && (x->at < lo || x->at > hi)) {
    x->at -= period * floor((x->at - lo) / period);
    // Within rounding of the seam, it is on the seam.
    if (fmin(x->at - lo, hi - x->at) <= CAG_CURVE_SAME * period) x->at = lo;
  }
  x->at = fmin(fmax(x->at, lo), hi);
  if (closed && x->at == lo && x->side == CAG_SIDE_LEFT) x->at = hi;
  else if (closed && x->at == hi && x->side == CAG_SIDE_RIGHT) x->at = lo;
}

// out = a b up to t^order; b has no constant.
static void multiply(const double *a, const double *b, int order, double *out) {
  double c[MOST_ORDER + 1] = {0};
  for (int i = 0; i < order; i++)
    for (int k = 1; i + k <= order; k++) c[i + k] += a[i] * b[k];
  memcpy(out, c, sizeof c);
}

// Coefficients of sum S_ij / (i! j!) x^i y^j, then derivatives.
static void compose(const CagVec3 *partials, const Coordinate *x, const Coordinate *y, int order,
                    CagVec3 *out) {
  double factorial[MOST_ORDER + 1] = {1}, powers[MOST_ORDER + 1] = {1};
  for (int k = 1; k <= order; k++) factorial[k] = factorial[k - 1] * k;
  for (int k = 0; k <= order; k++) out[k] = cag_vec3(0, 0, 0);
  for (int i = 0; i <= order; i++) {
    double term[MOST_ORDER + 1];
    memcpy(term, powers, sizeof term);
    for (int j = 0; i + j <= order; j++) {
      const double share = 1 / (factorial[i] * factorial[j]);
      for (int k = i + j; k <= order; k++)
        out[k] = cag_madd(out[k], share * term[k], partials[cag_partial(order, i, j)]);
      multiply(term, y->step, order, term);
    }
    multiply(powers, x->step, order, powers);
  }
  for (int k = 2; k <= order; k++) out[k] = cag_scaled(out[k], factorial[k]);
}

static CagStatus fail_infinite(CagError *err) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_not_finite, "", -1,
                  "the projection maps a point of the curve to infinity");
}

static CagStatus eval(const CagCurve *curve, double t, int order, CagSide side, CagVec3 *out,
                      CagError *err) {
  const OnSurface *c = (const OnSurface *)curve;
  const CagSurface *s = c->surface;
  if (order > MOST_ORDER)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_derivative_order, "order", -1,
                    "a curve on %s %s surface has derivatives up to order %d, not %d",
                    cag_article(s->kind->name), s->kind->name, MOST_ORDER, order);
  CagVec3 d[MOST_ORDER + 1], partials[PARTIALS];
  // First derivatives determine the sides, even if only a point is requested.
  const int known = order == 0 ? 1 : order;
  CagStatus status = cag_curve_eval(c->plane, t, known, side, d, err);
  if (status) return status;
  Coordinate x = {.at = d[0].x}, y = {.at = d[0].y};
  double factorial = 1;
  for (int k = 1; k <= known; k++) {
    factorial *= k;
    x.step[k] = d[k].x / factorial;
    y.step[k] = d[k].y / factorial;
  }
  x.side = side_of(x.step, known, side);
  y.side = side_of(y.step, known, side);
  bring_home(&x, s->u0, s->u1, s->closed_u);
  bring_home(&y, s->v0, s->v1, s->closed_v);
  status = cag_surface_eval(s, x.at, y.at, order, x.side, y.side, partials, err);
  if (status) return status;
  compose(partials, &x, &y, order, out);
  return !c->mapped || cag_transform_derivatives(&c->map, order, out) ? CAG_OK : fail_infinite(err);
}

// --- Breaks ---

typedef struct Numbers {
  double *at;
  size_t n;
} Numbers;

static CagStatus push(Numbers *list, double x, CagError *err) {
  if (!CAG_RESIZE(list->at, list->n + 1)) return cag_fail_memory(err);
  list->at[list->n++] = x;
  return CAG_OK;
}

// Where the plane curve crosses the line on which one parameter is `at`.
static CagStatus cross(const CagCurve *plane, int direction, double at, Numbers *list,
                       CagError *err) {
  const CagPlane line =
      direction == 0 ? (CagPlane){{at, 0, 0}, {1, 0, 0}} : (CagPlane){{0, at, 0}, {0, 1, 0}};
  CagMeeting *meetings;
  size_t n;
  CagStatus status = cag_curve_intersect_plane(plane, &line, &meetings, &n, err);
  // A curve that runs along the break is on one side of it, so the break does not matter.
  if (status) return err->id == CAG_ERR_overlap ? CAG_OK : status;
  for (size_t i = 0; !status && i < n; i++) status = push(list, meetings[i].t, err);
  cag_free(meetings);
  return status;
}

// Crossings with a break or seam and its copies at whole turns, within the box of the curve.
static CagStatus cross_turns(const OnSurface *c, int direction, double at, double lo, double hi,
                             Numbers *list, CagError *err) {
  const CagSurface *s = c->surface;
  const bool closed = direction == 0 ? s->closed_u : s->closed_v;
  const double period = direction == 0 ? s->u1 - s->u0 : s->v1 - s->v0;
  const double first = closed ? ceil((lo - at) / period) : 0;
  const double last = closed ? floor((hi - at) / period) : 0;
  CagStatus status = CAG_OK;
  for (double k = first; !status && k <= last; k++)
    status = cross(c->plane, direction, at + k * period, list, err);
  return status;
}

static CagStatus find_breaks(OnSurface *c, const CagBounds *box, CagError *err) {
  const CagSurface *s = c->surface;
  Numbers list = {0};
  CagStatus status = CAG_OK;
  const size_t own = c->plane->kind->breaks ? c->plane->kind->breaks(c->plane, NULL, 0) : 0;
  if (own) {
    list.at = cag_malloc(own * sizeof *list.at);
    if (!list.at) return cag_fail_memory(err);
    list.n = c->plane->kind->breaks(c->plane, list.at, own);
  }
  for (int direction = 0; !status && direction < 2; direction++) {
    const size_t n = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
    double *at = cag_malloc((n + 1) * sizeof *at);
    if (!at) status = cag_fail_memory(err);
    if (!status && n) s->kind->breaks(s, direction, at, n);
    const double lo = direction == 0 ? box->min.x : box->min.y;
    const double hi = direction == 0 ? box->max.x : box->max.y;
    for (size_t i = 0; !status && i < n; i++)
      status = cross_turns(c, direction, at[i], lo, hi, &list, err);
    if (!status && (direction == 0 ? s->closed_u : s->closed_v))
      status = cross_turns(c, direction, direction == 0 ? s->u0 : s->v0, lo, hi, &list, err);
    cag_free(at);
  }
  if (status) {
    cag_free(list.at);
    return status;
  }
  c->breaks = list.at;
  c->break_count =
      list.n ? cag_surface_tidy_breaks(list.at, list.n, c->base.start, c->base.end) : 0;
  return CAG_OK;
}

static size_t breaks(const CagCurve *curve, double *out, size_t capacity) {
  const OnSurface *c = (const OnSurface *)curve;
  for (size_t i = 0; i < c->break_count && i < capacity; i++) out[i] = c->breaks[i];
  return c->break_count;
}

// --- Making ---

static CagStatus check_direction(char name, double lo, double hi, double from, double to,
                                 bool closed, bool angular, CagError *err) {
  char a[32], b[32], x[32];
  const double slack = OUTSIDE * (hi - lo);
  const double worst = from < lo - slack ? from : to;
  if (closed && (to - from) / (hi - lo) <= MOST_TURNS) return CAG_OK;
  if (!closed && from >= lo - slack && to <= hi + slack) return CAG_OK;
  return cag_fail(err, CAG_E_DOMAIN, CAG_ERR_curve_outside, "C", -1,
                  "the plane curve reaches %s = %s, outside of the domain %s..%s of the surface%s",
                  name == 'u' ? "x" : "y", cag_number_text(worst, x), cag_number_text(lo, a),
                  cag_number_text(hi, b), angular ? " (radians)" : "");
}

static CagStatus check_within(const CagSurface *s, const CagBounds *box, CagError *err) {
  CagStatus status =
      check_direction('u', s->u0, s->u1, box->min.x, box->max.x, s->closed_u, s->angular_u, err);
  return status ? status
                : check_direction('v', s->v0, s->v1, box->min.y, box->max.y, s->closed_v,
                                  s->angular_v, err);
}

static CagStatus judge_ends(CagCurve *curve, CagError *err) {
  CagVec3 ends[2];
  CagBounds box;
  CagStatus status = eval(curve, curve->start, 0, CAG_SIDE_RIGHT, &ends[0], err);
  if (!status) status = eval(curve, curve->end, 0, CAG_SIDE_LEFT, &ends[1], err);
  if (!status) status = cag_surface_bounds(((OnSurface *)curve)->surface, &box, err);
  if (status) return status;
  const double size = fmax(cag_norm(cag_sub(box.max, box.min)), cag_norm(ends[0]));
  curve->closed = cag_norm(cag_sub(ends[0], ends[1])) <= CAG_SURFACE_SAME * size;
  return CAG_OK;
}

static CagStatus make(const CagSurface *s, const CagCurve *plane, const CagTransform *map,
                      CagCurve **out, CagError *err) {
  CagCurve *curve;
  CagBounds box;
  CagStatus status = cag_curve_bounds(plane, &box, err);
  if (!status) status = check_within(s, &box, err);
  if (!status)
    status = cag_curve_block(sizeof(OnSurface), &on_surface_kind, 3, plane->start, plane->end,
                             &curve, err);
  if (status) return status;
  OnSurface *c = (OnSurface *)curve;
  c->surface = cag_surface_retain(s);
  c->plane = cag_curve_retain(plane);
  c->mapped = map != NULL;
  if (map) c->map = *map;
  curve->angular = plane->angular;
  status = find_breaks(c, &box, err);
  if (!status) status = judge_ends(curve, err);
  if (status) cag_curve_release(curve);
  else *out = curve;
  return status;
}

CagStatus cag_curve_on_surface(const CagSurface *s, const CagCurve *c, CagCurve **out,
                               CagError *err) {
  if (c->dimension != 2)
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_planar, "C", -1,
                    "`C` must be a plane curve: its x and y are u and v of the surface");
  return make(s, c, NULL, out, err);
}

static CagStatus transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                           CagError *err) {
  const OnSurface *c = (const OnSurface *)curve;
  const CagTransform map = c->mapped ? cag_transform_multiply(t, &c->map) : *t;
  CagStatus status = make(c->surface, c->plane, &map, out, err);
  if (!status) (*out)->dimension = cag_curve_image_dimension(curve, t);
  return status;
}

// The same with another plane curve; takes ownership of the reference.
static CagStatus along(const OnSurface *c, CagCurve *plane, CagCurve **out, CagError *err) {
  CagStatus status = make(c->surface, plane, c->mapped ? &c->map : NULL, out, err);
  cag_curve_release(plane);
  return status;
}

static CagStatus part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out, CagError *err) {
  const OnSurface *c = (const OnSurface *)curve;
  CagCurve *plane;
  CagStatus status = c->plane->kind->part(c->plane, p, &plane, err);
  if (!status) status = along(c, plane, out, err);
  if (!status) (*out)->dimension = curve->dimension;
  return status;
}

static CagBounds hull(const CagCurve *curve, double a, double b) {
  CagBounds box;
  cag_curve_sampled_hull(curve, a, b, &box);
  return box;
}

static void describe(const CagCurve *curve, char *buffer, size_t size) {
  const OnSurface *c = (const OnSurface *)curve;
  snprintf(buffer, size, "%s %s in %s %s surface%s", cag_article(c->plane->kind->name),
           c->plane->kind->name, cag_article(c->surface->kind->name), c->surface->kind->name,
           c->mapped ? ", moved" : "");
}

static void destroy(CagCurve *curve) {
  OnSurface *c = (OnSurface *)curve;
  cag_surface_release(c->surface);
  cag_curve_release(c->plane);
  cag_free(c->breaks);
}

static void digest(const CagCurve *curve, CagDigest *d) {
  const OnSurface *s = (const OnSurface *)curve;
  cag_surface_digest(s->surface, d);
  cag_curve_digest(s->plane, d);
  if (s->mapped) cag_transform_digest(&s->map, d);
}

static const CagCurveKind on_surface_kind = {
    .name = "on surface",
    .eval = eval,
    .transform = transform,
    .part = part,
    .hull = hull,
    .breaks = breaks,
    .describe = describe,
    .destroy = destroy,
    .digest = digest,
};
