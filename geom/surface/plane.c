// Parallelograms: S(u, v) = origin + u x + v y over the unit square.

#include <math.h>
#include <stdio.h>

#include "geom/surface/family.h"

typedef struct Parallelogram {
  CagSurface base;
  CagVec3 origin, x, y;
} Parallelogram;

static const CagSurfaceKind plane_kind;

static CagVec3 plane_point(const Parallelogram *p, double u, double v) {
  return cag_madd(cag_madd(p->origin, u, p->x), v, p->y);
}

static CagStatus plane_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                            CagVec3 *out, CagError *err) {
  (void)su;
  (void)sv;
  (void)err;
  const Parallelogram *p = (const Parallelogram *)s;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) out[cag_partial(n, i, j)] = cag_vec3(0, 0, 0);
  out[0] = plane_point(p, u, v);
  if (n == 0) return CAG_OK;
  out[cag_partial(n, 1, 0)] = p->x;
  out[cag_partial(n, 0, 1)] = p->y;
  return CAG_OK;
}

static CagStatus plane_grid(const CagSurface *s, const double *us, size_t nu, const double *vs,
                            size_t nv, CagVec3 *points, CagVec3 *du, CagVec3 *dv, CagError *err) {
  (void)err;
  const Parallelogram *p = (const Parallelogram *)s;
  for (size_t i = 0; i < nu; i++)
    for (size_t j = 0; j < nv; j++) {
      points[i * nv + j] = plane_point(p, us[i], vs[j]);
      if (du) du[i * nv + j] = p->x;
      if (dv) dv[i * nv + j] = p->y;
    }
  return CAG_OK;
}

static CagStatus plane_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Parallelogram *p = (const Parallelogram *)s;
  const CagVec3 net[4] = {p->origin, plane_point(p, 0, 1), plane_point(p, 1, 0),
                          plane_point(p, 1, 1)};
  const double knots[4] = {0, 0, 1, 1};
  return cag_surface_nurbs(net, NULL, 2, 2, 1, 1, knots, knots, out, err);
}

static CagStatus plane_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                 CagError *err) {
  const Parallelogram *p = (const Parallelogram *)s;
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  const double w = t->m[3][3];
  return cag_surface_parallelogram(cag_transform_point(t, p->origin),
                                   cag_scaled(cag_transform_vector(t, p->x), 1 / w),
                                   cag_scaled(cag_transform_vector(t, p->y), 1 / w), out, err);
}

static void plane_describe(const CagSurface *s, char *buffer, size_t size) {
  const Parallelogram *p = (const Parallelogram *)s;
  char x[32], y[32];
  snprintf(buffer, size, "sides %s and %s", cag_number_text(cag_norm(p->x), x),
           cag_number_text(cag_norm(p->y), y));
}

static void plane_digest(const CagSurface *surface, CagDigest *d) {
  const Parallelogram *s = (const Parallelogram *)surface;
  cag_vec3s_digest(&s->origin, 1, d);
  cag_vec3s_digest(&s->x, 1, d);
  cag_vec3s_digest(&s->y, 1, d);
}

static const CagSurfaceKind plane_kind = {
    .name = "plane",
    .eval = plane_eval,
    .eval_grid = plane_grid,
    .to_nurbs = plane_to_nurbs,
    .transform = plane_transform,
    .describe = plane_describe,
    .digest = plane_digest,
};

// What cag_surface_judge would find, from the corners alone.
static void judge_plane(Parallelogram *p) {
  CagBounds box = CAG_BOUNDS_EMPTY;
  for (int k = 0; k < 4; k++) cag_bounds_add(&box, plane_point(p, k & 1, k >> 1));
  const double size = cag_norm(cag_sub(box.max, box.min)) +
                      CAG_SURFACE_SAME * fmax(cag_norm(box.min), cag_norm(box.max));
  const bool no_x = cag_norm(p->x) <= CAG_SURFACE_SAME * size,
             no_y = cag_norm(p->y) <= CAG_SURFACE_SAME * size;
  CagSurface *s = &p->base;
  s->pole_u0 = s->pole_u1 = no_y;
  s->pole_v0 = s->pole_v1 = no_x;
  s->closed_u = no_x && !no_y;
  s->closed_v = no_y && !no_x;
}

CagStatus cag_surface_parallelogram(CagVec3 origin, CagVec3 x, CagVec3 y, CagSurface **out,
                                    CagError *err) {
  CagSurface *s;
  CagStatus status = cag_surface_block(sizeof(Parallelogram), &plane_kind, 0, 1, 0, 1, &s, err);
  if (status) return status;
  Parallelogram *p = (Parallelogram *)s;
  p->origin = origin;
  p->x = x;
  p->y = y;
  judge_plane(p);
  *out = s;
  return CAG_OK;
}

bool cag_surface_parallelogram_view(const CagSurface *s, CagVec3 *origin, CagVec3 *x, CagVec3 *y) {
  if (s->kind != &plane_kind) return false;
  const Parallelogram *p = (const Parallelogram *)s;
  *origin = p->origin;
  *x = p->x;
  *y = p->y;
  return true;
}
