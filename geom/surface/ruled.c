// Ruled, bilinear, and translational surfaces: sums of curves.
//
// A ruled surface keeps its two curves and uses the fraction v of their domains: S(u, v) = (1 - u)
// second(v) + u first(v). A bilinear surface is the ruled surface of two lines. A translational
// surface is a(u) + b(v) - b(start).

#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "geom/surface/compatible.h"
#include "geom/surface/family.h"

typedef struct Pair {
  CagSurface base;
  CagCurve *a, *b; // ruled: u = 0 on a, u = 1 on b; translational: a by u, b by v
  CagVec3 origin;  // translational: b(start)
} Pair;

static const CagSurfaceKind ruled_kind, bilinear_kind, translational_kind;

static double in_domain(const CagCurve *c, double fraction) {
  return fraction >= 1 ? c->end : c->start + fraction * (c->end - c->start);
}

// Point and derivatives with respect to the fraction of the domain.
static CagStatus eval_fraction(const CagCurve *c, double v, int n, CagSide side, CagVec3 *out,
                               CagError *err) {
  CagStatus status = cag_curve_eval(c, in_domain(c, v), n, side, out, err);
  double length = c->end - c->start, factor = 1;
  for (int k = 1; !status && k <= n; k++) {
    factor *= length;
    out[k] = cag_scaled(out[k], factor);
  }
  return status;
}

static CagStatus ruled_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                            CagVec3 *out, CagError *err) {
  (void)su;
  const Pair *p = (const Pair *)s;
  CagVec3 a[CAG_MAX_PARTIAL + 1], b[CAG_MAX_PARTIAL + 1];
  CagStatus status = eval_fraction(p->a, v, n, sv, a, err);
  if (!status) status = eval_fraction(p->b, v, n, sv, b, err);
  if (status) return status;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 *d = &out[cag_partial(n, i, j)];
      if (i == 0) *d = cag_add(cag_scaled(a[j], 1 - u), cag_scaled(b[j], u));
      else *d = i == 1 ? cag_sub(b[j], a[j]) : cag_vec3(0, 0, 0);
    }
  return CAG_OK;
}

static CagStatus ruled_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const Pair *p = (const Pair *)s;
  for (size_t j = 0; j < nv; j++) {
    CagVec3 a[2], b[2];
    CagSide side = vs[j] >= s->v1 ? CAG_SIDE_LEFT : CAG_SIDE_RIGHT;
    CagStatus status = eval_fraction(p->a, vs[j], 1, side, a, err);
    if (!status) status = eval_fraction(p->b, vs[j], 1, side, b, err);
    if (status) return status;
    for (size_t i = 0; i < nu; i++) {
      double u = us[i];
      size_t at = i * nv + j;
      points[at] = cag_add(cag_scaled(a[0], 1 - u), cag_scaled(b[0], u));
      if (du) du[at] = cag_sub(b[0], a[0]);
      if (dv) dv[at] = cag_add(cag_scaled(a[1], 1 - u), cag_scaled(b[1], u));
    }
  }
  return CAG_OK;
}

static CagStatus pair_block(const CagSurfaceKind *kind, const CagCurve *a, const CagCurve *b,
                            Pair **out, CagError *err) {
  CagCurve *mine_a = NULL, *mine_b = NULL;
  CagSurface *s = NULL;
  CagStatus status = cag_surface_space_curve(a, &mine_a, err);
  if (!status) status = cag_surface_space_curve(b, &mine_b, err);
  if (!status) status = cag_surface_block(sizeof(Pair), kind, 0, 1, 0, 1, &s, err);
  if (status) {
    cag_curve_release(mine_a);
    cag_curve_release(mine_b);
    return status;
  }
  *out = (Pair *)s;
  (*out)->a = mine_a;
  (*out)->b = mine_b;
  return CAG_OK;
}

static CagStatus ruled_new(const CagSurfaceKind *kind, const CagCurve *first,
                           const CagCurve *second, CagSurface **out, CagError *err) {
  Pair *p;
  CagStatus status = pair_block(kind, second, first, &p, err);
  if (status) return status;
  cag_surface_judge(&p->base);
  *out = &p->base;
  return CAG_OK;
}

// Both curves moved by an affine map.
static CagStatus moved_curves(const Pair *p, const CagTransform *t, CagCurve **a, CagCurve **b,
                              CagError *err) {
  *a = *b = NULL;
  CagStatus status = cag_curve_transform(p->a, t, a, err);
  if (!status) status = cag_curve_transform(p->b, t, b, err);
  if (status) cag_curve_release(*a);
  return status;
}

static CagStatus ruled_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                 CagError *err) {
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  CagCurve *a, *b;
  CagStatus status = moved_curves((const Pair *)s, t, &a, &b, err);
  if (status) return status;
  status = ruled_new(s->kind, b, a, out, err);
  cag_curve_release(a);
  cag_curve_release(b);
  return status;
}

static size_t curve_breaks(const CagCurve *c, double *out, size_t capacity) {
  return c->kind->breaks ? c->kind->breaks(c, out, capacity) : 0;
}

static size_t ruled_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Pair *p = (const Pair *)s;
  if (direction == 0) return 0;
  size_t na = curve_breaks(p->a, NULL, 0), nb = curve_breaks(p->b, NULL, 0);
  if (na + nb == 0) return 0;
  double *all = cag_malloc((na + nb) * sizeof *all);
  if (!all) return cag_note_memory(), 0;
  curve_breaks(p->a, all, na);
  curve_breaks(p->b, all + na, nb);
  for (size_t i = 0; i < na + nb; i++) {
    const CagCurve *c = i < na ? p->a : p->b;
    all[i] = (all[i] - c->start) / (c->end - c->start);
  }
  size_t n = cag_surface_tidy_breaks(all, na + nb, 0, 1);
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = all[i];
  cag_free(all);
  return n;
}

static void ruled_describe(const CagSurface *s, char *buffer, size_t size) {
  const Pair *p = (const Pair *)s;
  snprintf(buffer, size, "between %s %s and %s %s", cag_article(p->b->kind->name), p->b->kind->name,
           cag_article(p->a->kind->name), p->a->kind->name);
}

static void pair_destroy(CagSurface *s) {
  cag_curve_release(((Pair *)s)->a);
  cag_curve_release(((Pair *)s)->b);
}

// Also exact for rational curves: the parameter along a ruling is then a weighted one.
static CagStatus ruled_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Pair *p = (const Pair *)s;
  CagCompatible both;
  CagStatus status = cag_curves_compatible(p->a, p->b, &both, err);
  if (status) return status;
  double *net = cag_malloc(8 * both.count * sizeof *net);
  if (!net) status = cag_fail_memory(err);
  else {
    const double knots[4] = {0, 0, 1, 1};
    memcpy(net, both.net[0], 4 * both.count * sizeof *net);
    memcpy(net + 4 * both.count, both.net[1], 4 * both.count * sizeof *net);
    status = cag_surface_from_homogeneous(net, 2, both.count, 1, both.degree, knots, both.knots,
                                          out, err);
  }
  cag_free(net);
  cag_compatible_free(&both);
  return status;
}

static void pair_digest(const CagSurface *surface, CagDigest *d) {
  const Pair *s = (const Pair *)surface;
  cag_curve_digest(s->a, d);
  cag_curve_digest(s->b, d);
}

static const CagSurfaceKind ruled_kind = {
    .name = "ruled",
    .eval = ruled_eval,
    .eval_grid = ruled_grid,
    .to_nurbs = ruled_to_nurbs,
    .transform = ruled_transform,
    .breaks = ruled_breaks,
    .describe = ruled_describe,
    .destroy = pair_destroy,
    .digest = pair_digest,
};

CagStatus cag_surface_ruled(const CagCurve *first, const CagCurve *second, CagSurface **out,
                            CagError *err) {
  return ruled_new(&ruled_kind, first, second, out, err);
}

// --- Bilinear ---

CagStatus cag_surface_bilinear(CagVec3 p00, CagVec3 p01, CagVec3 p10, CagVec3 p11, CagSurface **out,
                               CagError *err) {
  // A side that is one point is a pole; a line cannot be a point, so such a patch is a NURBS.
  if (cag_norm(cag_sub(p00, p01)) == 0 || cag_norm(cag_sub(p10, p11)) == 0) {
    const CagVec3 net[4] = {p00, p01, p10, p11};
    const double knots[4] = {0, 0, 1, 1};
    return cag_surface_nurbs(net, NULL, 2, 2, 1, 1, knots, knots, out, err);
  }
  CagCurve *a = NULL, *b = NULL;
  CagStatus status = cag_curve_line(p00, p01, 3, &a, err);
  if (!status) status = cag_curve_line(p10, p11, 3, &b, err);
  if (!status) status = ruled_new(&bilinear_kind, b, a, out, err);
  cag_curve_release(a);
  cag_curve_release(b);
  return status;
}

static CagStatus bilinear_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Pair *p = (const Pair *)s;
  CagVec3 net[4];
  CagStatus status = cag_curve_point(p->a, p->a->start, &net[0], err);
  if (!status) status = cag_curve_point(p->a, p->a->end, &net[1], err);
  if (!status) status = cag_curve_point(p->b, p->b->start, &net[2], err);
  if (!status) status = cag_curve_point(p->b, p->b->end, &net[3], err);
  const double knots[4] = {0, 0, 1, 1};
  return status ? status : cag_surface_nurbs(net, NULL, 2, 2, 1, 1, knots, knots, out, err);
}

static void bilinear_describe(const CagSurface *s, char *buffer, size_t size) {
  (void)s;
  snprintf(buffer, size, "on 4 points");
}

static const CagSurfaceKind bilinear_kind = {
    .name = "bilinear",
    .eval = ruled_eval,
    .eval_grid = ruled_grid,
    .to_nurbs = bilinear_to_nurbs,
    .transform = ruled_transform,
    .describe = bilinear_describe,
    .destroy = pair_destroy,
    .digest = pair_digest,
};

// --- Translational ---

static CagStatus translational_eval(const CagSurface *s, double u, double v, int n, CagSide su,
                                    CagSide sv, CagVec3 *out, CagError *err) {
  const Pair *p = (const Pair *)s;
  CagVec3 a[CAG_MAX_PARTIAL + 1], b[CAG_MAX_PARTIAL + 1];
  CagStatus status = cag_curve_eval(p->a, u, n, su, a, err);
  if (!status) status = cag_curve_eval(p->b, v, n, sv, b, err);
  if (status) return status;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 *d = &out[cag_partial(n, i, j)];
      if (i && j) *d = cag_vec3(0, 0, 0);
      else *d = i ? a[i] : b[j];
    }
  out[0] = cag_add(a[0], cag_sub(b[0], p->origin));
  return CAG_OK;
}

static CagStatus translational_grid(const CagSurface *s, const double *us, size_t nu,
                                    const double *vs, size_t nv, CagVec3 *points, CagVec3 *du,
                                    CagVec3 *dv, CagError *err) {
  const Pair *p = (const Pair *)s;
  CagVec3 *a = cag_malloc(2 * (nu + nv + 1) * sizeof *a);
  if (!a) return cag_fail_memory(err);
  CagVec3 *b = a + 2 * nu;
  CagStatus status = cag_curve_eval_many(p->a, us, nu, 1, a, err);
  if (!status) status = cag_curve_eval_many(p->b, vs, nv, 1, b, err);
  for (size_t i = 0; !status && i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      size_t at = i * nv + j;
      points[at] = cag_add(a[2 * i], cag_sub(b[2 * j], p->origin));
      if (du) du[at] = a[2 * i + 1];
      if (dv) dv[at] = b[2 * j + 1];
    }
  cag_free(a);
  return status;
}

// Weights multiply: sum of all w_i w_j (a_i + b_j) over sum of all w_i w_j is a(u) + b(v).
static CagStatus translational_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Pair *p = (const Pair *)s;
  CagCurve *a = NULL, *b = NULL;
  double *net = NULL;
  CagStatus status = cag_curve_to_nurbs(p->a, &a, err);
  if (!status) status = cag_curve_to_nurbs(p->b, &b, err);
  if (!status) {
    CagNurbsView va, vb;
    cag_curve_nurbs_view(a, &va);
    cag_curve_nurbs_view(b, &vb);
    net = cag_malloc(va.count * vb.count * 4 * sizeof *net);
    if (!net) status = cag_fail_memory(err);
    for (size_t i = 0; net && i < va.count; i++)
      for (size_t j = 0; j < vb.count; j++) {
        const double *ha = va.homogeneous + 4 * i, *hb = vb.homogeneous + 4 * j;
        const double origin[3] = {p->origin.x, p->origin.y, p->origin.z};
        double *h = net + 4 * (i * vb.count + j);
        h[3] = ha[3] * hb[3];
        for (int k = 0; k < 3; k++) h[k] = ha[k] * hb[3] + hb[k] * ha[3] - h[3] * origin[k];
      }
    if (net)
      status = cag_surface_from_homogeneous(net, va.count, vb.count, va.degree, vb.degree, va.knots,
                                            vb.knots, out, err);
  }
  cag_free(net);
  cag_curve_release(a);
  cag_curve_release(b);
  return status;
}

static CagStatus translational_transform(const CagSurface *s, const CagTransform *t,
                                         CagSurface **out, CagError *err) {
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  CagCurve *a, *b;
  CagStatus status = moved_curves((const Pair *)s, t, &a, &b, err);
  if (status) return status;
  status = cag_surface_translational(a, b, out, err);
  cag_curve_release(a);
  cag_curve_release(b);
  return status;
}

static size_t translational_breaks(const CagSurface *s, int direction, double *out,
                                   size_t capacity) {
  const Pair *p = (const Pair *)s;
  return curve_breaks(direction == 0 ? p->a : p->b, out, capacity);
}

static void translational_describe(const CagSurface *s, char *buffer, size_t size) {
  const Pair *p = (const Pair *)s;
  snprintf(buffer, size, "of %s %s along %s %s", cag_article(p->a->kind->name), p->a->kind->name,
           cag_article(p->b->kind->name), p->b->kind->name);
}

CagStatus cag_surface_translational(const CagCurve *a, const CagCurve *b, CagSurface **out,
                                    CagError *err) {
  Pair *p;
  CagStatus status = pair_block(&translational_kind, a, b, &p, err);
  if (status) return status;
  status = cag_curve_point(p->b, p->b->start, &p->origin, err);
  if (status) {
    cag_surface_release(&p->base);
    return status;
  }
  p->base.u0 = p->a->start;
  p->base.u1 = p->a->end;
  p->base.v0 = p->b->start;
  p->base.v1 = p->b->end;
  p->base.angular_u = p->a->angular;
  p->base.angular_v = p->b->angular;
  cag_surface_judge(&p->base);
  *out = &p->base;
  return CAG_OK;
}

static const CagSurfaceKind translational_kind = {
    .name = "translational",
    .eval = translational_eval,
    .eval_grid = translational_grid,
    .to_nurbs = translational_to_nurbs,
    .transform = translational_transform,
    .breaks = translational_breaks,
    .describe = translational_describe,
    .destroy = pair_destroy,
    .digest = pair_digest,
};
