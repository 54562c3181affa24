// Second moments of area of a region, by Green's theorem on its exact boundary.

#include "geom/curve/line_integral.h"
#include "geom/curve/region.h"

// Relative tolerance of an integral over a smooth piece.
#define INTEGRAL 1e-11

// d(x^3 / 3) dy, x^2 y / 2 dy, and -y^3 / 3 dx about the center.
static void integrand(void *context, CagVec3 p, CagVec3 d, double *out) {
  const CagVec3 *center = context;
  const double x = p.x - center->x, y = p.y - center->y;
  out[0] = x * x * x / 3 * d.y;
  out[1] = x * x * y / 2 * d.y;
  out[2] = -y * y * y / 3 * d.x;
}

CagStatus cag_region_second_moments(const CagRegion *r, double *area, CagVec3 *center, double *xx,
                                    double *xy, double *yy, CagError *err) {
  double sum[3] = {0, 0, 0}, part[3];
  CagStatus status = cag_region_area(r, area, center, err);
  for (size_t i = 0; !status && i < r->count; i++) {
    const CagCurve *loop = r->loops[i];
    status = cag_curve_integrate(loop, loop->start, loop->end, integrand, center, 3, INTEGRAL, part,
                                 err);
    for (int k = 0; !status && k < 3; k++) sum[k] += part[k];
  }
  *xx = sum[0];
  *xy = sum[1];
  *yy = sum[2];
  return status;
}
