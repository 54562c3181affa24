// Circles tangent to two lines or circles, and tangent lines of curves.
//
// A circle of radius R is tangent to a line if its center lies on one of the two parallels at
// distance R, and to a circle of radius r if the distance of the centers is r + R (touching from
// outside) or |r - R| (one inside the other). So each center is an intersection of lines and
// circles, and the choice selects one of them.

#include "geom/curve/circles.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/memory.h"
#include "geom/curve/family.h"
#include "geom/linalg/tolerance.h"

// Directions whose sine is below this are parallel; also the relative tolerance of lengths.
#define PARALLEL CAG_ROUNDING
#define SAME_LENGTH CAG_ROUNDING

static CagVec3 left_of(CagVec3 d) { return cag_vec3(-d.y, d.x, 0); }
static double cross2(CagVec3 a, CagVec3 b) { return a.x * b.y - a.y * b.x; }

// --- Circles of a given radius ---

static CagStatus no_circle(CagError *err, const char *why) {
  return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_no_tangent_circle, "", -1,
                  "no circle of this radius is tangent to both in this way: %s", why);
}

static CagVec3 foot(const CagTouched *line, CagVec3 p) {
  const CagVec3 d = cag_unit(line->d);
  return cag_madd(line->p, cag_dot(cag_sub(p, line->p), d), d);
}

static CagStatus touch_lines(const CagTouched *a, const CagTouched *b, double radius,
                             CagTouchChoice choice, CagVec3 *center, CagError *err) {
  const CagVec3 da = cag_unit(a->d), db = cag_unit(b->d), nb = left_of(db);
  const double sine = cross2(da, db);
  if (fabs(sine) <= PARALLEL)
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_parallel_lines, "", -1,
                    "the two lines are parallel: they have no corner");
  // The far side of b is the one that the direction of a points to.
  const double far_side = cag_dot(da, nb) > 0 ? 1 : -1;
  const CagVec3 p = cag_madd(a->p, choice.right ? -radius : radius, left_of(da));
  const CagVec3 q = cag_madd(b->p, choice.near ? -far_side * radius : far_side * radius, nb);
  *center = cag_madd(p, cross2(cag_sub(q, p), db) / sine, da);
  return CAG_OK;
}

// Distance of the centers of two tangent circles.
static double reach(double r, double radius, bool inside) {
  return inside ? fabs(r - radius) : r + radius;
}

static CagStatus touch_line_circle(const CagTouched *line, const CagTouched *circle, double radius,
                                   CagTouchChoice choice, bool inside, CagVec3 *center,
                                   CagError *err) {
  const CagVec3 d = cag_unit(line->d);
  CagTouched parallel = *line;
  parallel.p = cag_madd(line->p, choice.right ? -radius : radius, left_of(d));
  const CagVec3 near = foot(&parallel, circle->p);
  const double h = cag_norm(cag_sub(near, circle->p)), r = reach(circle->radius, radius, inside);
  double square = (r - h) * (r + h);
  if (fabs(r - h) <= SAME_LENGTH * (r + h + cag_norm(circle->p))) square = 0;
  if (square < 0 || r == 0)
    return no_circle(
        err, inside
                 ? "the line is too far from the inside of the circle, or the radius is too large"
                 : "the line is too far from the circle on this side");
  *center = cag_madd(near, choice.near ? -sqrt(square) : sqrt(square), d);
  return CAG_OK;
}

static CagStatus touch_circles(const CagTouched *a, const CagTouched *b, double radius,
                               CagTouchChoice choice, CagVec3 *center, CagError *err) {
  const CagVec3 between = cag_sub(b->p, a->p), e = cag_unit(between);
  const double d = cag_norm(between);
  if (!(d > 0)) return no_circle(err, "the circles are concentric");
  const double ra = reach(a->radius, radius, choice.inside[0]);
  const double rb = reach(b->radius, radius, choice.inside[1]);
  const double x = (d * d + (ra - rb) * (ra + rb)) / (2 * d);
  double square = (ra - x) * (ra + x);
  if (fabs(ra - fabs(x)) <= SAME_LENGTH * (ra + d + cag_norm(a->p))) square = 0;
  if (square < 0)
    return no_circle(err, "the radius is too small to reach both, or too large to fit");
  *center = cag_madd(cag_madd(a->p, x, e), choice.right ? -sqrt(square) : sqrt(square), left_of(e));
  return CAG_OK;
}

static CagVec3 touch_point(const CagTouched *t, CagVec3 center, double radius, bool inside) {
  if (t->radius == 0) return foot(t, center);
  // A circle around the other touches it on the side away from its own center.
  const double sign = inside && radius > t->radius ? -1 : 1;
  return cag_madd(t->p, sign * t->radius, cag_unit(cag_sub(center, t->p)));
}

CagStatus cag_tangent_circle(const CagTouched *a, const CagTouched *b, double radius,
                             CagTouchChoice choice, CagVec3 *center, CagVec3 touch[2],
                             CagError *err) {
  char text[32];
  CagStatus status;
  if (!(radius > 0) || !isfinite(radius))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_radius_not_positive, "radius", -1,
                    "`radius` must be positive, found %s", cag_number_text(radius, text));
  for (int i = 0; i < 2; i++) {
    const CagTouched *t = i == 0 ? a : b;
    if (t->radius == 0 && cag_norm(t->d) == 0)
      return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_zero_vector, "", i, "a line has zero length");
  }
  if (a->radius == 0 && b->radius == 0) status = touch_lines(a, b, radius, choice, center, err);
  else if (a->radius == 0)
    status = touch_line_circle(a, b, radius, choice, choice.inside[1], center, err);
  else if (b->radius == 0)
    status = touch_line_circle(b, a, radius, choice, choice.inside[0], center, err);
  else status = touch_circles(a, b, radius, choice, center, err);
  if (status) return status;
  touch[0] = touch_point(a, *center, radius, choice.inside[0]);
  touch[1] = touch_point(b, *center, radius, choice.inside[1]);
  return CAG_OK;
}

// --- Tangent lines ---

// Number of samples of a smooth piece in the search for tangents. A piece of degree p has at most 2
// p - 2 tangents through a point.
#define SAMPLES 64
#define HALVINGS 100
#define NEWTON_STEPS 30
// Fractions of the size of the data: rounding of the distance from a tangent; a point is on a
// curve; two tangents are identical.
#define ROUNDING 1e-14
#define ON_CURVE 1e-10
#define TWICE 1e-7

typedef struct Found {
  CagTangentLine *items;
  size_t n, capacity;
  double size; // of the data
} Found;

static CagStatus keep(Found *f, CagTangentLine line, CagError *err) {
  for (size_t i = 0; i < f->n; i++)
    if (cag_norm(cag_sub(f->items[i].p, line.p)) <= TWICE * f->size &&
        cag_norm(cag_sub(f->items[i].q, line.q)) <= TWICE * f->size)
      return CAG_OK;
  if (!CAG_RESERVE(f->items, f->capacity, f->n + 1)) return cag_fail_memory(err);
  f->items[f->n++] = line;
  return CAG_OK;
}

static int by_t(const void *a, const void *b) {
  const CagTangentLine *x = a, *y = b;
  if (x->t != y->t) return x->t < y->t ? -1 : 1;
  return (x->t2 > y->t2) - (x->t2 < y->t2);
}

static CagStatus finish(Found *f, CagStatus status, CagTangentLine **out, size_t *n) {
  if (status) {
    cag_free(f->items);
    return status;
  }
  if (f->n > 0) qsort(f->items, f->n, sizeof *f->items, by_t);
  *out = f->items;
  *n = f->n;
  return CAG_OK;
}

static double size_of(const CagCurve *c) {
  const CagBounds b = c->kind->hull(c, c->start, c->end);
  return cag_norm(cag_sub(b.max, b.min)) + fmax(cag_norm(b.min), cag_norm(b.max));
}

static CagStatus check_plane_curve(const CagCurve *c, CagError *err) {
  if (c->dimension == 2) return CAG_OK;
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_planar, "", -1,
                  "expects a curve of the plane, with points [x, y]");
}

// C' x (C - p), normalized by the sizes: zero if the tangent at t passes through p.
static CagStatus aside(const CagCurve *c, CagVec3 p, double t, CagSide side, double *out,
                       CagError *err) {
  CagVec3 d[2];
  CagStatus status = cag_curve_eval(c, t, 1, side, d, err);
  if (!status) *out = cross2(cag_unit(d[1]), cag_sub(d[0], p));
  return status;
}

static CagStatus tangents_in_cell(const CagCurve *c, CagVec3 p, double a, double b, Found *f,
                                  CagError *err) {
  double fa = 0, fb = 0, fm = 0;
  CagStatus status = aside(c, p, a, CAG_SIDE_RIGHT, &fa, err);
  if (!status) status = aside(c, p, b, CAG_SIDE_LEFT, &fb, err);
  // A tangent at the end of a cell is found in both cells and stored once.
  const bool from_start = fabs(fa) <= ROUNDING * f->size, from_end = fabs(fb) <= ROUNDING * f->size;
  if (status || (from_start && from_end)) return status; // straight, with p on its line
  if (from_start) b = a;
  else if (from_end) a = b;
  else if ((fa < 0) == (fb < 0)) return CAG_OK;
  for (int i = 0; !status && i < HALVINGS && a < b; i++) {
    const double m = a + (b - a) / 2;
    if (m <= a || m >= b) break;
    status = aside(c, p, m, CAG_SIDE_RIGHT, &fm, err);
    if ((fm < 0) == (fa < 0)) a = m;
    else b = m;
  }
  CagTangentLine line = {.t = b, .q = p};
  if (!status) status = cag_curve_point(c, b, &line.p, err);
  if (!status && cag_norm(cag_sub(line.p, p)) > TWICE * f->size) status = keep(f, line, err);
  return status;
}

CagStatus cag_tangents_from_point(const CagCurve *c, CagVec3 p, CagTangentLine **out, size_t *n,
                                  CagError *err) {
  Found f = {.size = size_of(c) + cag_norm(p)};
  double *cuts = NULL, distance;
  size_t count = 0;
  CagTangentLine on = {.q = p};
  CagStatus status = check_plane_curve(c, err);
  if (!status) status = cag_curve_cuts(c, &cuts, &count, err);
  for (size_t i = 0; !status && i + 1 < count; i++)
    for (int k = 0; !status && k < SAMPLES; k++) {
      const double step = (cuts[i + 1] - cuts[i]) / SAMPLES;
      const double a = cuts[i] + step * k, b = k + 1 == SAMPLES ? cuts[i + 1] : a + step;
      status = tangents_in_cell(c, p, a, b, &f, err);
    }
  // The tangent at p itself, where the sign does not change.
  if (!status) status = cag_curve_closest(c, p, &on.t, &on.p, &distance, err);
  if (!status && distance <= ON_CURVE * f.size) {
    CagVec3 tangent;
    status = cag_curve_tangent(c, on.t, CAG_SIDE_RIGHT, &tangent, err);
    on.q = cag_add(on.p, tangent);
    if (!status) status = keep(&f, on, err);
  }
  cag_free(cuts);
  return finish(&f, status, out, n);
}

static bool round_arc(const CagCurve *c, CagVec3 *center, double *radius) {
  CagVec3 x, y;
  double rate;
  if (!cag_curve_arc_axes(c, center, &x, &y, &rate)) return false;
  *radius = cag_norm(x);
  return fabs(cag_norm(y) - *radius) <= SAME_LENGTH * *radius &&
         fabs(cag_dot(x, y)) <= SAME_LENGTH * *radius * *radius;
}

// Adds the line that touches both curves at these points, if the points are on the arcs.
static CagStatus keep_on_arcs(const CagCurve *a, const CagCurve *b, CagVec3 p, CagVec3 q, Found *f,
                              CagError *err) {
  CagTangentLine line;
  double off, off2;
  CagStatus status = cag_curve_closest(a, p, &line.t, &line.p, &off, err);
  if (!status) status = cag_curve_closest(b, q, &line.t2, &line.q, &off2, err);
  if (status || off > ON_CURVE * f->size || off2 > ON_CURVE * f->size) return status;
  if (cag_norm(cag_sub(line.p, line.q)) <= TWICE * f->size) {
    // The circles touch here.
    CagVec3 tangent;
    status = cag_curve_tangent(a, line.t, CAG_SIDE_RIGHT, &tangent, err);
    line.q = cag_add(line.p, tangent);
  }
  return status ? status : keep(f, line, err);
}

static CagStatus tangents_of_circles(const CagCurve *a, const CagCurve *b, CagVec3 ca, double ra,
                                     CagVec3 cb, double rb, Found *f, CagError *err) {
  const CagVec3 d = cag_sub(cb, ca), e = cag_unit(d);
  const double distance = cag_norm(d);
  if (distance <= SAME_LENGTH * f->size) return CAG_OK;
  CagStatus status = CAG_OK;
  // Outer lines have both circles on one side, inner ones between them.
  for (int sign = 1; sign >= -1; sign -= 2) {
    const double cosine = (ra - sign * rb) / distance;
    double square = (1 - cosine) * (1 + cosine);
    if (fabs(distance - fabs(ra - sign * rb)) <= SAME_LENGTH * f->size) square = 0;
    if (square < 0) continue;
    for (int k = 1; !status && k >= (square > 0 ? -1 : 1); k -= 2) {
      const CagVec3 n = cag_madd(cag_scaled(e, cosine), k * sqrt(square), left_of(e));
      status = keep_on_arcs(a, b, cag_madd(ca, ra, n), cag_madd(cb, sign * rb, n), f, err);
    }
  }
  return status;
}

typedef struct Pair {
  CagVec3 a[3], b[3]; // points and two derivatives
} Pair;

static CagStatus read_pair(const CagCurve *a, const CagCurve *b, double t, double u, Pair *out,
                           CagError *err) {
  CagStatus status = cag_curve_eval(a, t, 2, CAG_SIDE_RIGHT, out->a, err);
  return status ? status : cag_curve_eval(b, u, 2, CAG_SIDE_RIGHT, out->b, err);
}

// Newton's method for a' x (b - a) = 0, b' x (b - a) = 0 from (t, u); *end: the result.
static CagStatus polish(const CagCurve *a, const CagCurve *b, double t, double u, Found *f,
                        double end[2], CagError *err) {
  Pair p;
  end[0] = end[1] = INFINITY;
  CagStatus status = CAG_OK;
  double change = 1;
  for (int i = 0; i < NEWTON_STEPS && change > 1e-15; i++) {
    status = read_pair(a, b, t, u, &p, err);
    if (status) return status;
    const CagVec3 d = cag_sub(p.b[0], p.a[0]);
    const double f1 = cross2(p.a[1], d), f2 = cross2(p.b[1], d), across = cross2(p.a[1], p.b[1]);
    const double f1t = cross2(p.a[2], d), f2u = cross2(p.b[2], d);
    // f1 by u is a' x b', f2 by t is -b' x a', the same.
    const double det = f1t * f2u - across * across;
    if (det == 0) return CAG_OK;
    const double dt = (f1 * f2u - f2 * across) / det, du = (f2 * f1t - f1 * across) / det;
    const double t1 = fmin(a->end, fmax(a->start, t - dt)),
                 u1 = fmin(b->end, fmax(b->start, u - du));
    change = fabs(t1 - t) / (a->end - a->start) + fabs(u1 - u) / (b->end - b->start);
    t = t1;
    u = u1;
  }
  end[0] = t;
  end[1] = u;
  status = read_pair(a, b, t, u, &p, err);
  if (status) return status;
  const CagVec3 d = cag_sub(p.b[0], p.a[0]);
  const double off = fabs(cross2(cag_unit(p.a[1]), d)) + fabs(cross2(cag_unit(p.b[1]), d));
  // Both equations also vanish at an intersection of the curves, without a common tangent.
  if (off > ON_CURVE * f->size || cag_norm(d) <= TWICE * f->size) return CAG_OK;
  return keep(f, (CagTangentLine){t, u, p.a[0], p.b[0]}, err);
}

typedef struct Grid {
  double *t;
  CagVec3 *d; // point and derivative
  size_t n;
} Grid;

static CagStatus make_grid(const CagCurve *c, Grid *g, CagError *err) {
  double *cuts;
  size_t count;
  CagStatus status = cag_curve_cuts(c, &cuts, &count, err);
  if (status) return status;
  g->n = (count - 1) * SAMPLES + 1;
  g->t = cag_malloc(sizeof *g->t * g->n);
  g->d = cag_malloc(sizeof *g->d * g->n * 2);
  if (!g->t || !g->d) status = cag_fail_memory(err);
  for (size_t i = 0; !status && i < g->n; i++) {
    const size_t k = i / SAMPLES, j = i % SAMPLES;
    g->t[i] = j == 0 ? cuts[k] : cuts[k] + (cuts[k + 1] - cuts[k]) * ((double)j / SAMPLES);
  }
  cag_free(cuts);
  return status ? status : cag_curve_eval_many(c, g->t, g->n, 1, g->d, err);
}

static bool changes(double a, double b, double c, double d) {
  return fmin(fmin(a, b), fmin(c, d)) <= 0 && fmax(fmax(a, b), fmax(c, d)) >= 0;
}

// Starts from the middle of the cell and, if the search leaves the cell, from its quarters.
static CagStatus search_cell(const CagCurve *a, const CagCurve *b, const double t[2],
                             const double u[2], Found *f, CagError *err) {
  const double wide = t[1] - t[0], high = u[1] - u[0];
  double end[2];
  CagStatus status = polish(a, b, t[0] + wide / 2, u[0] + high / 2, f, end, err);
  if (end[0] >= t[0] && end[0] <= t[1] && end[1] >= u[0] && end[1] <= u[1]) return status;
  for (int k = 0; !status && k < 4; k++)
    status = polish(a, b, t[0] + wide * (k & 1 ? 0.75 : 0.25), u[0] + high * (k & 2 ? 0.75 : 0.25),
                    f, end, err);
  return status;
}

static CagStatus tangents_by_grid(const CagCurve *a, const CagCurve *b, Found *f, CagError *err) {
  Grid g = {0}, h = {0};
  CagStatus status = make_grid(a, &g, err);
  if (!status) status = make_grid(b, &h, err);
  for (size_t i = 0; !status && i + 1 < g.n; i++)
    for (size_t j = 0; !status && j + 1 < h.n; j++) {
      double f1[4], f2[4];
      for (size_t k = 0; k < 4; k++) {
        const CagVec3 *p = g.d + 2 * (i + (k & 1)), *q = h.d + 2 * (j + (k >> 1));
        const CagVec3 d = cag_sub(q[0], p[0]);
        f1[k] = cross2(p[1], d);
        f2[k] = cross2(q[1], d);
      }
      if (changes(f1[0], f1[1], f1[2], f1[3]) && changes(f2[0], f2[1], f2[2], f2[3]))
        status = search_cell(a, b, g.t + i, h.t + j, f, err);
    }
  cag_free(g.t);
  cag_free(g.d);
  cag_free(h.t);
  cag_free(h.d);
  return status;
}

CagStatus cag_tangents_of_two(const CagCurve *a, const CagCurve *b, CagTangentLine **out, size_t *n,
                              CagError *err) {
  Found f = {.size = size_of(a) + size_of(b)};
  CagVec3 ca, cb;
  double ra, rb;
  CagStatus status = check_plane_curve(a, err);
  if (!status) status = check_plane_curve(b, err);
  if (!status)
    status = round_arc(a, &ca, &ra) && round_arc(b, &cb, &rb)
                 ? tangents_of_circles(a, b, ca, ra, cb, rb, &f, err)
                 : tangents_by_grid(a, b, &f, err);
  return finish(&f, status, out, n);
}
