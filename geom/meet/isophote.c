// Isophotes as zero curves of n.d - c |n|, n = S_u x S_v: the factor |n| keeps the function smooth
// where the normal is, and avoids the division.

#include "geom/meet/isophote.h"

// The level's constant is the cosine.
static double isophote_value(const CagLevel *level, const CagVec3 *d, int n, double *gradient) {
  CagVec3 su = d[cag_partial(n, 1, 0)], sv = d[cag_partial(n, 0, 1)], normal = cag_cross(su, sv);
  double length = cag_norm(normal);
  if (gradient) {
    CagVec3 suu = d[cag_partial(n, 2, 0)], suv = d[cag_partial(n, 1, 1)],
            svv = d[cag_partial(n, 0, 2)];
    const CagVec3 change[2] = {cag_add(cag_cross(suu, sv), cag_cross(su, suv)),
                               cag_add(cag_cross(suv, sv), cag_cross(su, svv))};
    for (int k = 0; k < 2; k++) {
      double stretch = length > 0 ? cag_dot(normal, change[k]) / length : 0;
      gradient[k] = cag_dot(change[k], level->direction) - level->constant * stretch;
    }
  }
  return cag_dot(normal, level->direction) - level->constant * length;
}

CagStatus cag_surface_isophote(const CagSurface *s, CagVec3 direction, double cosine,
                               double tolerance, CagCurveList *out, CagError *err) {
  const CagRegion *region;
  CagTransform frame;
  if (cag_surface_planar_view(s, &region, &frame)) return CAG_OK;
  CagLevel level = {
      .order = 2, .value = isophote_value, .direction = direction, .constant = cosine};
  return cag_surface_level_curves(s, &level, tolerance, out, NULL, err);
}
