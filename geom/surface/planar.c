// A planar surface: the part of a placed XY plane within a region.
//
// The rectangle of parameters is the region's bounding box; points of it outside the region can be
// evaluated but do not belong to the surface, so area, volume, bounds, and meshes use the region.

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geom/surface/family.h"

typedef struct Planar {
  CagSurface base;
  CagRegion *region;
  CagTransform frame; // affine
} Planar;

static const CagSurfaceKind planar_kind;

static CagVec3 column(const CagTransform *t, int j) {
  return cag_vec3(t->m[0][j], t->m[1][j], t->m[2][j]);
}

static CagStatus planar_eval(const CagSurface *s, double u, double v, int n, CagSide su, CagSide sv,
                             CagVec3 *out, CagError *err) {
  (void)su;
  (void)sv;
  (void)err;
  const Planar *p = (const Planar *)s;
  for (int i = 0; i <= n; i++)
    for (int j = 0; i + j <= n; j++) out[cag_partial(n, i, j)] = cag_vec3(0, 0, 0);
  out[0] = cag_transform_point(&p->frame, cag_vec3(u, v, 0));
  if (n == 0) return CAG_OK;
  out[cag_partial(n, 1, 0)] = column(&p->frame, 0);
  out[cag_partial(n, 0, 1)] = column(&p->frame, 1);
  return CAG_OK;
}

// Covers the whole rectangle, so it is exact only if the region is one.
static CagStatus planar_to_nurbs(const CagSurface *s, CagSurface **out, CagError *err) {
  const Planar *p = (const Planar *)s;
  double area, rectangle = (s->u1 - s->u0) * (s->v1 - s->v0);
  CagStatus status = cag_region_area(p->region, &area, NULL, err);
  if (status) return status;
  if (fabs(area - rectangle) > CAG_SURFACE_SAME * rectangle)
    return cag_fail(err, CAG_E_UNSUPPORTED, CAG_ERR_no_exact_form, "surface", -1,
                    "a trimmed plane is not one NURBS surface unless its region is a rectangle "
                    "along the axes; use its boundary, or tessellate it");
  CagVec3 net[4];
  for (int i = 0; i < 4; i++)
    net[i] =
        cag_transform_point(&p->frame, cag_vec3(i / 2 ? s->u1 : s->u0, i % 2 ? s->v1 : s->v0, 0));
  const double ku[4] = {s->u0, s->u0, s->u1, s->u1}, kv[4] = {s->v0, s->v0, s->v1, s->v1};
  return cag_surface_nurbs(net, NULL, 2, 2, 1, 1, ku, kv, out, err);
}

static CagStatus planar_transform(const CagSurface *s, const CagTransform *t, CagSurface **out,
                                  CagError *err) {
  const Planar *p = (const Planar *)s;
  if (!cag_transform_is_affine(t)) return cag_surface_transform_placed(s, t, out, err);
  CagTransform frame = cag_transform_multiply(t, &p->frame);
  return cag_surface_planar(p->region, &frame, out, err);
}

static void planar_describe(const CagSurface *s, char *buffer, size_t size) {
  const Planar *p = (const Planar *)s;
  snprintf(buffer, size, "within %zu closed %s", p->region->count,
           p->region->count == 1 ? "curve" : "curves");
}

static void planar_destroy(CagSurface *s) { cag_region_release(((Planar *)s)->region); }

static void planar_digest(const CagSurface *surface, CagDigest *d) {
  const Planar *s = (const Planar *)surface;
  cag_region_digest(s->region, d);
  cag_transform_digest(&s->frame, d);
}

static const CagSurfaceKind planar_kind = {
    .name = "planar",
    .eval = planar_eval,
    .to_nurbs = planar_to_nurbs,
    .transform = planar_transform,
    .describe = planar_describe,
    .destroy = planar_destroy,
    .digest = planar_digest,
};

CagStatus cag_surface_planar(const CagRegion *region, const CagTransform *frame, CagSurface **out,
                             CagError *err) {
  if (!cag_transform_is_affine(frame))
    return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_not_affine, "frame", -1,
                    "`frame` must be affine, found a projection");
  CagTransform map = *frame;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) map.m[i][j] /= frame->m[3][3];
  map.planar = false;
  CagVec3 normal = cag_cross(column(&map, 0), column(&map, 1));
  if (!(cag_norm(normal) > 0))
    return cag_fail(err, CAG_E_DEGENERATE, CAG_ERR_degenerate_direction, "frame", -1,
                    "`frame` flattens the plane to a line: its x and y axes must not be parallel");
  CagBounds box;
  CagStatus status = cag_region_bounds(region, &box, err);
  if (status) return status;
  CagSurface *s;
  status = cag_surface_block(sizeof(Planar), &planar_kind, box.min.x, box.max.x, box.min.y,
                             box.max.y, &s, err);
  if (status) return status;
  Planar *p = (Planar *)s;
  p->region = cag_region_retain(region);
  p->frame = map;
  *out = s;
  return CAG_OK;
}

bool cag_surface_planar_view(const CagSurface *s, const CagRegion **region, CagTransform *frame) {
  if (s->kind != &planar_kind) return false;
  const Planar *p = (const Planar *)s;
  if (region) *region = p->region;
  if (frame) *frame = p->frame;
  return true;
}
