#include "geom/surface/nearest_revolved.h"

#include <math.h>

// The angle in the range, if whole turns bring it there.
static bool angle_in_range(double *v, double from, double to) {
  const double full = 2 * M_PI, slack = 1e-14 * full;
  *v -= full * floor((*v - from + slack) / full);
  const bool within = *v <= to + slack;
  *v = fmin(fmax(*v, from), to);
  return within;
}

CagStatus cag_surface_revolved_closest(const CagSurface *s, CagVec3 p, CagSurfaceNearest *out,
                                       bool *known, CagError *err) {
  const CagCurve *profile;
  CagVec3 axis, through, radial;
  double from, to;
  bool one_sided;
  *known = false;
  if (!cag_surface_meridian_view(s, &radial, &one_sided) ||
      !cag_surface_revolution_view(s, &profile, &axis, &through, &from, &to))
    return CAG_OK;
  // p in the plane of the profile: on the side of `radial`, and on the other one.
  const CagVec3 off = cag_sub(p, through), foot = cag_madd(through, cag_dot(off, axis), axis);
  const CagVec3 out_of_axis = cag_sub(p, foot), across = cag_cross(axis, radial);
  const double rho = cag_norm(out_of_axis);
  const double turn = atan2(cag_dot(out_of_axis, across), cag_dot(out_of_axis, radial));
  CagSurfaceNearest best = {.distance = INFINITY};
  for (int k = 0; k < (one_sided ? 1 : 2); k++) {
    CagVec3 point;
    double u, distance, v = turn + k * M_PI;
    const CagVec3 q = cag_madd(foot, k ? -rho : rho, radial);
    CagStatus status = cag_curve_closest(profile, q, &u, &point, &distance, err);
    if (status) return status;
    if (!(distance < best.distance)) continue;
    *known = angle_in_range(&v, from, to);
    best = (CagSurfaceNearest){.u = u, .v = v, .distance = distance};
  }
  if (!*known) return CAG_OK;
  CagStatus status = cag_surface_point(s, best.u, best.v, &best.point, err);
  if (status) return status;
  best.distance = cag_norm(cag_sub(best.point, p));
  *out = best;
  return CAG_OK;
}
