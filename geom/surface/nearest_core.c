// Nearest points of tubes and offsets, found from their center lines and base surfaces.

#include "geom/surface/nearest_core.h"

#include <math.h>

#include "geom/surface/reshape.h"
#include "geom/surface/swept.h"

static CagStatus candidate_at(const CagSurface *s, CagVec3 p, double u, double v,
                              CagSurfaceNearest *out, CagError *err) {
  *out = (CagSurfaceNearest){.u = u, .v = v};
  CagStatus status = cag_surface_point(s, u, v, &out->point, err);
  out->distance = cag_norm(cag_sub(out->point, p));
  return status;
}

// Finds the nearest point of the plane section at the foot on the center line.
static CagStatus by_line(const CagSurface *s, const CagCurve *center, double radius, CagVec3 p,
                         double *bound, CagSurfaceNearest *out, CagError *err) {
  double t, distance;
  CagVec3 foot, x, y;
  CagStatus status = cag_curve_closest(center, p, &t, &foot, &distance, err);
  const double v = fmin(fmax(t, s->v0), s->v1);
  if (!status) status = cag_surface_point(s, 0, v, &x, err);
  if (!status) status = cag_surface_point(s, M_PI / 2, v, &y, err);
  if (status) return status;
  const CagVec3 r = cag_sub(p, foot);
  double u = atan2(cag_dot(r, cag_sub(y, foot)), cag_dot(r, cag_sub(x, foot)));
  if (u < 0) u += 2 * M_PI;
  *bound = distance - radius;
  return candidate_at(s, p, u, v, out, err);
}

CagStatus cag_surface_nearest_by_core(const CagSurface *s, CagVec3 p, double *bound,
                                      CagSurfaceNearest *out, bool *known, CagError *err) {
  const CagCurve *center;
  const CagSurface *inner;
  CagTransform map, back;
  double distance, scale;
  CagStatus status = CAG_OK;
  *known = true;
  if (cag_surface_tube_view(s, &center, &distance))
    return by_line(s, center, distance, p, bound, out, err);
  if (cag_surface_offset_view(s, &inner, &distance)) {
    status = cag_surface_closest(inner, p, out, err);
    if (status) return status;
    *bound = out->distance - fabs(distance);
    return candidate_at(s, p, out->u, out->v, out, err);
  }
  *known = false;
  if (!cag_surface_placed_view(s, &inner, &map) || !cag_transform_is_similarity(&map, &scale))
    return CAG_OK;
  status = cag_transform_inverse(&map, &back, err);
  if (!status)
    status =
        cag_surface_nearest_by_core(inner, cag_transform_point(&back, p), bound, out, known, err);
  if (status || !*known) return status;
  *bound *= scale;
  // v may run in the opposite direction.
  CagSurfaceNearest other;
  const double u = out->u, v = out->v;
  status = candidate_at(s, p, u, v, out, err);
  if (!status) status = candidate_at(s, p, u, s->v0 + s->v1 - v, &other, err);
  if (!status && other.distance < out->distance) *out = other;
  return status;
}
