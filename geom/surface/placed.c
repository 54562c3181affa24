// A surface under an affine map, optionally flipped: the image of kinds without a transform of
// their own.
//
// Kind "transformed". S'(u, v) = M S(u, v), or M S(u, v0 + v1 - v) if it is flipped. Placing a
// placed surface composes the maps, so wrappers are never nested.

#include <stdio.h>

#include "base/memory.h"
#include "geom/surface/family.h"

typedef struct Placed {
  CagSurface base;
  CagSurface *inner;
  CagTransform map;
  bool flip;
  CagKeptBreaks breaks; // if flipped: those of `inner` in v
} Placed;

static const CagSurfaceKind placed_kind;

static double turned_v(const Placed *p, double v) { return p->base.v0 + p->base.v1 - v; }

static double inner_v(const Placed *p, double v) {
  if (!p->flip) return v;
  // Ends map to ends and breaks to breaks exactly. Next to a break of `inner`, both limits would be
  // the same.
  if (v == p->base.v0) return p->base.v1;
  if (v == p->base.v1) return p->base.v0;
  size_t lo = 0, hi = p->breaks.n;
  while (lo < hi) {
    const size_t middle = lo + (hi - lo) / 2;
    const double at = turned_v(p, p->breaks.at[middle]);
    if (at == v) return p->breaks.at[middle];
    if (at > v) lo = middle + 1;
    else hi = middle;
  }
  return turned_v(p, v);
}

static CagStatus placed_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                             CagVec3 *out, CagError *err) {
  const Placed *p = (const Placed *)s;
  CagSide side = p->flip ? (sv == CAG_SIDE_LEFT ? CAG_SIDE_RIGHT : CAG_SIDE_LEFT) : sv;
  CagStatus status = p->inner->kind->eval(p->inner, u, inner_v(p, v), n, su, side, out, err);
  if (status) return status;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) {
      CagVec3 *d = &out[cag_partial(n, i, j)];
      *d = i + j ? cag_transform_vector(&p->map, *d) : cag_transform_point(&p->map, *d);
      if (p->flip && j % 2) *d = cag_scaled(*d, -1);
    }
  return CAG_OK;
}

static CagStatus placed_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                             size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  const Placed *p = (const Placed *)s;
  double *turned = NULL;
  if (p->flip) {
    turned = cag_malloc((nv ? nv : 1) * sizeof *turned);
    if (!turned) return cag_fail_memory(err);
    for (size_t j = 0; j < nv; j++) turned[j] = inner_v(p, vs[j]);
  }
  CagStatus status =
      cag_surface_eval_grid(p->inner, us, nu, turned ? turned : vs, nv, points, du, dv, err);
  cag_free(turned);
  if (status) return status;
  double sign = p->flip ? -1 : 1;
  for (size_t i = 0; i < nu * nv; i++) {
    points[i] = cag_transform_point(&p->map, points[i]);
    if (du) du[i] = cag_transform_vector(&p->map, du[i]);
    if (dv) dv[i] = cag_scaled(cag_transform_vector(&p->map, dv[i]), sign);
  }
  return CAG_OK;
}

static CagStatus placed_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Placed *p = (const Placed *)s;
  CagSurface *exact = NULL, *moved = NULL;
  CagStatus status = cag_surface_to_nurbs(p->inner, &exact, err);
  if (status) return status;
  status = cag_surface_transform(exact, &p->map, &moved, err);
  cag_surface_release(exact);
  if (status || !p->flip) {
    if (!status) *out = moved;
    return status;
  }
  status = cag_surface_flip(moved, out, err);
  cag_surface_release(moved);
  return status;
}

static CagStatus placed_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                  CagError *err) {
  const Placed *p = (const Placed *)s;
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  CagTransform both = cag_transform_multiply(t, &p->map);
  return cag_surface_placed(p->inner, &both, p->flip, out, err);
}

static size_t placed_breaks(const CagSurface *s, int direction, double *out, size_t capacity) {
  const Placed *p = (const Placed *)s;
  if (direction == 0 || !p->flip)
    return p->inner->kind->breaks ? p->inner->kind->breaks(p->inner, direction, out, capacity) : 0;
  const size_t n = p->breaks.n;
  for (size_t i = 0; i < n && i < capacity; i++) out[i] = turned_v(p, p->breaks.at[n - 1 - i]);
  return n;
}

static void placed_describe(const CagSurface *s, char *buffer, size_t size) {
  const Placed *p = (const Placed *)s;
  char inner[160] = "";
  if (p->inner->kind->describe) p->inner->kind->describe(p->inner, inner, sizeof inner);
  snprintf(buffer, size, "of %s %s surface%s%s%s", cag_article(p->inner->kind->name),
           p->inner->kind->name, *inner ? ", " : "", inner, p->flip ? ", flipped" : "");
}

static void placed_destroy(CagSurface *s) {
  Placed *p = (Placed *)s;
  cag_surface_release(p->inner);
  cag_free(p->breaks.at);
}

static void placed_digest(const CagSurface *surface, CagDigest *d) {
  const Placed *s = (const Placed *)surface;
  cag_surface_digest(s->inner, d);
  cag_transform_digest(&s->map, d);
  cag_digest_word(d, s->flip);
}

static const CagSurfaceKind placed_kind = {
    .name = "transformed",
    .eval = placed_eval,
    .eval_grid = placed_grid,
    .to_nurbs = placed_to_nurbs,
    .transform = placed_transform,
    .breaks = placed_breaks,
    .describe = placed_describe,
    .destroy = placed_destroy,
    .digest = placed_digest,
};

static bool is_identity(const CagTransform *t) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (t->m[i][j] != (i == j)) return false;
  return true;
}

CagStatus cag_surface_placed(const CagSurface *inner, const CagTransform *t, bool flip,
                             CagSurface **out, CagError *err) {
  CagTransform map = *t;
  if (inner->kind == &placed_kind) {
    const Placed *p = (const Placed *)inner;
    map = cag_transform_multiply(t, &p->map);
    flip = flip != p->flip;
    inner = p->inner;
  }
  double w = map.m[3][3];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) map.m[i][j] /= w;
  if (!flip && is_identity(&map)) {
    *out = cag_surface_retain(inner);
    return CAG_OK;
  }
  CagKeptBreaks breaks = {0};
  CagStatus status =
      flip ? cag_surface_keep_breaks(inner, 1, inner->v0, inner->v1, &breaks, err) : CAG_OK;
  if (status) return status;
  CagSurface *s;
  status = cag_surface_block(sizeof(Placed), &placed_kind, inner->u0, inner->u1, inner->v0,
                             inner->v1, &s, err);
  if (status) {
    cag_free(breaks.at);
    return status;
  }
  Placed *p = (Placed *)s;
  p->inner = cag_surface_retain(inner);
  p->map = map;
  p->flip = flip;
  p->breaks = breaks;
  s->angular_u = inner->angular_u;
  s->angular_v = inner->angular_v;
  s->closed_u = inner->closed_u;
  s->closed_v = inner->closed_v;
  s->pole_u0 = inner->pole_u0;
  s->pole_u1 = inner->pole_u1;
  s->pole_v0 = flip ? inner->pole_v1 : inner->pole_v0;
  s->pole_v1 = flip ? inner->pole_v0 : inner->pole_v1;
  *out = s;
  return CAG_OK;
}

bool cag_surface_placed_view(const CagSurface *s, const CagSurface **inner, CagTransform *map) {
  if (s->kind != &placed_kind) return false;
  *inner = ((const Placed *)s)->inner;
  *map = ((const Placed *)s)->map;
  return true;
}

bool cag_surface_is_flipped(const CagSurface *s) {
  return s->kind == &placed_kind && ((const Placed *)s)->flip;
}
