// Second moments of area of a region, by Green's theorem on its exact boundary.

#include <stdlib.h>

#include "geom/basis/quadrature.h"
#include "geom/curve/family.h"
#include "geom/curve/region.h"

// Error of an integral over a smooth piece, as a part of it.
#define INTEGRAL 1e-11

typedef struct Loop {
  const CagCurve *c;
  CagVec3 middle;
} Loop;

// d(x^3 / 3) dy, x^2 y / 2 dy and - y^3 / 3 dx.
static CagStatus integrand(void *context, double t, double *out, CagError *err) {
  const Loop *loop = context;
  CagVec3 d[2];
  CagStatus status = cag_curve_eval(loop->c, t, 1, CAG_SIDE_RIGHT, d, err);
  if (status) return status;
  const double x = d[0].x - loop->middle.x, y = d[0].y - loop->middle.y;
  out[0] = x * x * x / 3 * d[1].y;
  out[1] = x * x * y / 2 * d[1].y;
  out[2] = -y * y * y / 3 * d[1].x;
  return CAG_OK;
}

CagStatus cag_region_second_moments(const CagRegion *r, double *area, CagVec3 *center, double *xx,
                                    double *xy, double *yy, CagError *err) {
  double sum[3] = {0, 0, 0};
  CagStatus status = cag_region_area(r, area, center, err);
  for (size_t i = 0; !status && i < r->count; i++) {
    Loop loop = {r->loops[i], *center};
    double *cuts, part[3] = {0, 0, 0};
    size_t n;
    status = cag_curve_cuts(r->loops[i], &cuts, &n, err);
    if (status) break;
    status = cag_integrate(integrand, &loop, cuts, n, 3, INTEGRAL, part, err);
    free(cuts);
    for (int k = 0; k < 3; k++) sum[k] += part[k];
  }
  *xx = sum[0];
  *xy = sum[1];
  *yy = sum[2];
  return status;
}
