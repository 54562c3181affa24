// Curves on surfaces with one fixed parameter.
//
// For NURBS surfaces they are exact NURBS curves: the net contracted with the basis at the fixed
// parameter. For revolutions they are circles and the rotated profile. For other kinds they are
// curves of the kind "isocurve", which evaluates the surface and keeps its parameter; they have a
// NURBS form if the surface has one with the same parameters.

#include <math.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/basis/bspline.h"
#include "geom/curve/family.h"
#include "geom/surface/family.h"

typedef struct Isocurve {
  CagCurve base;
  CagSurface *surface;
  int direction; // 0: u is fixed
  double at;
  double offset, factor; // the surface's running parameter is offset + factor t
} Isocurve;

static const CagCurveKind isocurve_kind;

static double running(const Isocurve *c, double t) {
  double w = c->offset + c->factor * t;
  double lo = c->direction == 0 ? c->surface->v0 : c->surface->u0;
  double hi = c->direction == 0 ? c->surface->v1 : c->surface->u1;
  return fmin(fmax(w, lo), hi);
}

static CagStatus isocurve_eval(const CagCurve *curve, double t, int order, CagSide side,
                               CagVec3 *out, CagError *err) {
  const Isocurve *c = (const Isocurve *)curve;
  if (order > CAG_MAX_PARTIAL)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_derivative_order, "order", -1,
                    "an isocurve of %s %s surface has derivatives up to order %d, not %d",
                    cag_article(c->surface->kind->name), c->surface->kind->name, CAG_MAX_PARTIAL,
                    order);
  CagVec3 d[(CAG_MAX_PARTIAL + 1) * (CAG_MAX_PARTIAL + 1)];
  double w = running(c, t);
  if (c->factor < 0) side = side == CAG_SIDE_LEFT ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT;
  CagStatus status =
      c->direction == 0
          ? cag_surface_eval(c->surface, c->at, w, order, CAG_SIDE_RIGHT, side, d, err)
          : cag_surface_eval(c->surface, w, c->at, order, side, CAG_SIDE_RIGHT, d, err);
  double factor = 1;
  for (int k = 0; !status && k <= order; k++) {
    size_t from = c->direction == 0 ? cag_partial(order, 0, k) : cag_partial(order, k, 0);
    out[k] = cag_scaled(d[from], factor);
    factor *= c->factor;
  }
  return status;
}

// The curve over [start, end] that runs through the surface's parameters from `from` to `to`.
static CagStatus isocurve_new(const CagSurface *s, int direction, double at, double from, double to,
                              double start, double end, CagCurve **out, CagError *err) {
  CagCurve *curve;
  CagStatus status = cag_curve_block(sizeof(Isocurve), &isocurve_kind, 3, start, end, &curve, err);
  if (status) return status;
  Isocurve *c = (Isocurve *)curve;
  c->surface = cag_surface_retain(s);
  c->direction = direction;
  c->at = at;
  c->factor = (to - from) / (end - start);
  c->offset = from - c->factor * start;
  curve->angular = direction == 0 ? s->angular_v : s->angular_u;
  CagVec3 first, last;
  CagBounds box;
  status =
      cag_surface_point(s, direction == 0 ? at : from, direction == 0 ? from : at, &first, err);
  if (!status)
    status = cag_surface_point(s, direction == 0 ? at : to, direction == 0 ? to : at, &last, err);
  if (!status) status = cag_surface_bounds(s, &box, err);
  if (status) {
    cag_curve_release(curve);
    return status;
  }
  curve->closed =
      cag_norm(cag_sub(first, last)) <= CAG_SURFACE_SAME * cag_norm(cag_sub(box.max, box.min));
  *out = curve;
  return CAG_OK;
}

static CagStatus isocurve_transform(const CagCurve *curve, const CagTransform *t, CagCurve **out,
                                    CagError *err) {
  const Isocurve *c = (const Isocurve *)curve;
  CagSurface *moved;
  CagStatus status = cag_surface_transform(c->surface, t, &moved, err);
  if (status) return status;
  status = isocurve_new(moved, c->direction, c->at, running(c, curve->start),
                        running(c, curve->end), curve->start, curve->end, out, err);
  if (!status) (*out)->dimension = cag_curve_image_dimension(curve, t);
  cag_surface_release(moved);
  return status;
}

static CagStatus isocurve_part(const CagCurve *curve, const CagCurvePart *p, CagCurve **out,
                               CagError *err) {
  const Isocurve *c = (const Isocurve *)curve;
  CagStatus status = isocurve_new(c->surface, c->direction, c->at, running(c, p->from),
                                  running(c, p->to), p->start, p->end, out, err);
  if (!status) (*out)->dimension = curve->dimension;
  return status;
}

static CagBounds isocurve_hull(const CagCurve *curve, double a, double b) {
  const Isocurve *c = (const Isocurve *)curve;
  CagBounds box;
  CagError ignored;
  if (!cag_curve_sampled_hull(curve, a, b, &box)) cag_surface_bounds(c->surface, &box, &ignored);
  return box;
}

static size_t isocurve_breaks(const CagCurve *curve, double *out, size_t capacity) {
  const Isocurve *c = (const Isocurve *)curve;
  const CagSurface *s = c->surface;
  int direction = c->direction == 0 ? 1 : 0;
  size_t n = s->kind->breaks ? s->kind->breaks(s, direction, NULL, 0) : 0;
  if (n == 0) return 0;
  double *all = cag_malloc(n * sizeof *all);
  if (!all) return cag_note_memory(), 0;
  s->kind->breaks(s, direction, all, n);
  for (size_t i = 0; i < n; i++) all[i] = (all[i] - c->offset) / c->factor;
  n = cag_surface_tidy_breaks(all, n, curve->start, curve->end);
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = all[i];
  cag_free(all);
  return n;
}

static void isocurve_describe(const CagCurve *curve, char *buffer, size_t size) {
  const Isocurve *c = (const Isocurve *)curve;
  bool angular = c->direction == 0 ? c->surface->angular_u : c->surface->angular_v;
  char text[32];
  // Degrees to ten digits: 30deg is not exactly representable in radians.
  double shown = angular ? round(c->at * 180 / M_PI * 1e10) / 1e10 : c->at;
  snprintf(buffer, size, "of %s %s surface at %c = %s%s", cag_article(c->surface->kind->name),
           c->surface->kind->name, c->direction == 0 ? 'u' : 'v', cag_number_text(shown, text),
           angular ? "deg" : "");
}

static void isocurve_destroy(CagCurve *c) { cag_surface_release(((Isocurve *)c)->surface); }

// The exact form is accepted if a few points, at odd fractions, agree.
static bool agrees(const CagCurve *curve, const CagCurve *exact) {
  enum { POINTS = 7 };
  const double offset = 0.37, same = 1e-11;
  double size = 0, off = 0;
  CagVec3 first = {0, 0, 0};
  for (int i = 0; i < POINTS; i++) {
    double t = curve->start + (curve->end - curve->start) * (i + offset) / POINTS;
    CagVec3 p, q;
    CagError ignored;
    if (cag_curve_point(curve, t, &p, &ignored) || cag_curve_point(exact, t, &q, &ignored))
      return false;
    if (i == 0) first = p;
    size = fmax(size, cag_norm(cag_sub(p, first)) + cag_norm(p));
    off = fmax(off, cag_norm(cag_sub(p, q)));
  }
  return off <= same * size;
}

static CagStatus isocurve_to_nurbs(const CagCurve *curve, CagCurve **out, CagError *err) {
  const Isocurve *c = (const Isocurve *)curve;
  CagSurface *exact = NULL;
  CagCurve *whole = NULL, *made = NULL;
  CagError ignored;
  const CagCurvePart own = {running(c, curve->start), running(c, curve->end), curve->start,
                            curve->end};
  CagStatus status = cag_surface_to_nurbs(c->surface, &exact, &ignored);
  if (!status) status = cag_surface_isocurve(exact, c->direction, c->at, &whole, &ignored);
  if (!status) status = cag_curve_part(whole, &own, &made, &ignored);
  bool good = !status && agrees(curve, made);
  cag_surface_release(exact);
  cag_curve_release(whole);
  if (good) {
    *out = made;
    return CAG_OK;
  }
  if (!status) cag_curve_release(made);
  return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "curve", -1,
                  "an isocurve of %s %s surface has no exact NURBS form; approximate it to a "
                  "tolerance",
                  cag_article(c->surface->kind->name), c->surface->kind->name);
}

static void isocurve_digest(const CagCurve *curve, CagDigest *d) {
  const Isocurve *s = (const Isocurve *)curve;
  cag_surface_digest(s->surface, d);
  cag_digest_word(d, (uint64_t)s->direction);
  cag_digest_numbers(d, (const double[]){s->at, s->offset, s->factor}, 3);
}

static const CagCurveKind isocurve_kind = {
    .name = "isocurve",
    .eval = isocurve_eval,
    .to_nurbs = isocurve_to_nurbs,
    .transform = isocurve_transform,
    .part = isocurve_part,
    .hull = isocurve_hull,
    .breaks = isocurve_breaks,
    .describe = isocurve_describe,
    .destroy = isocurve_destroy,
    .digest = isocurve_digest,
};

// --- NURBS ---

static CagStatus of_nurbs(const CagSurfaceNurbsView *view, int direction, double at, CagSide side,
                          CagCurve **out, CagError *err) {
  int p = direction == 0 ? view->degree_u : view->degree_v;
  size_t fixed = direction == 0 ? view->nu : view->nv, n = direction == 0 ? view->nv : view->nu;
  const double *knots = direction == 0 ? view->knots_u : view->knots_v;
  size_t span = cag_knots_span(knots, fixed, p, at, side == CAG_SIDE_LEFT, (size_t)p);
  double *basis = cag_malloc((size_t)(p + 1) * sizeof *basis);
  CagVec3 *points = cag_malloc(n * sizeof *points);
  double *weights = cag_malloc(n * sizeof *weights);
  CagStatus status = basis && points && weights ? CAG_OK : cag_fail_memory(err);
  if (!status) cag_bspline_basis(knots, p, span, at, basis);
  for (size_t j = 0; !status && j < n; j++) {
    double h[4] = {0, 0, 0, 0};
    for (int k = 0; k <= p; k++) {
      size_t line = span - (size_t)p + (size_t)k;
      const double *b =
          view->homogeneous + 4 * (direction == 0 ? line * view->nv + j : j * view->nv + line);
      for (int c = 0; c < 4; c++) h[c] += basis[k] * b[c];
    }
    weights[j] = h[3];
    points[j] = h[3] > 0 ? cag_vec3(h[0] / h[3], h[1] / h[3], h[2] / h[3]) : cag_vec3(0, 0, 0);
  }
  if (!status)
    status = cag_curve_nurbs(points, view->rational ? weights : NULL, n,
                             direction == 0 ? view->degree_v : view->degree_u,
                             direction == 0 ? view->knots_v : view->knots_u, 3, out, err);
  cag_free(basis);
  cag_free(points);
  cag_free(weights);
  return status;
}

// --- Revolutions ---

// The circle of a profile point, or the rotated profile; false if the point is on the axis, or the
// angle exceeds that of an arc.
static bool of_revolution(const CagSurface *s, int direction, double at, CagCurve **out) {
  const CagCurve *profile;
  CagVec3 axis, through, p;
  CagTransform turn = cag_transform_identity();
  CagError ignored;
  if (!cag_surface_revolution_view(s, &profile, &axis, &through, NULL, NULL)) return false;
  if (direction == 1)
    return !cag_rotate(axis, at, through, &turn, &ignored) &&
           !cag_curve_transform(profile, &turn, out, &ignored);
  if (cag_curve_point(profile, at, &p, &ignored)) return false;
  CagVec3 from = cag_sub(p, through), along = cag_scaled(axis, cag_dot(axis, from));
  CagVec3 x = cag_sub(from, along), center = cag_add(through, along);
  double radius = cag_norm(x);
  if (radius <= CAG_SURFACE_SAME * (cag_norm(from) + cag_norm(through))) return false;
  x = cag_scaled(x, 1 / radius);
  const CagVec3 columns[4] = {x, cag_cross(axis, x), axis, center};
  for (int j = 0; j < 4; j++) {
    turn.m[0][j] = columns[j].x;
    turn.m[1][j] = columns[j].y;
    turn.m[2][j] = columns[j].z;
  }
  turn.planar = false;
  return !cag_curve_arc(radius, radius, s->v0, s->v1, &turn, out, &ignored);
}

CagStatus cag_surface_isocurve(const CagSurface *s, int direction, double at, CagCurve **out,
                               CagError *err) {
  // Evaluating a point checks the parameter, with its message.
  CagVec3 unused;
  CagStatus status = direction == 0 ? cag_surface_point(s, at, s->v0, &unused, err)
                                    : cag_surface_point(s, s->u0, at, &unused, err);
  if (status) return status;
  double lo = direction == 0 ? s->u0 : s->v0, hi = direction == 0 ? s->u1 : s->v1;
  at = fmin(fmax(at, lo), hi);
  CagSurfaceNurbsView view;
  if (cag_surface_nurbs_view(s, &view))
    return of_nurbs(&view, direction, at, at >= hi ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT, out, err);
  if (of_revolution(s, direction, at, out)) return CAG_OK;
  double from = direction == 0 ? s->v0 : s->u0, to = direction == 0 ? s->v1 : s->u1;
  return isocurve_new(s, direction, at, from, to, from, to, out, err);
}
