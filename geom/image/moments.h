// Mixed and polar central moments of images and regions, and the turn between two of them.

#ifndef CAG_GEOM_IMAGE_MOMENTS_H
#define CAG_GEOM_IMAGE_MOMENTS_H

#include "geom/curve/region.h"
#include "geom/image/measures.h"

// The highest order m + n of a mixed moment, and of a polar moment.
#define CAG_MOMENT_MOST 40
#define CAG_POLAR_MOMENT_MOST 7

// What moments are taken of: an image, whose gray values in channel 0 are weights, or a region.
typedef struct CagMassOf {
  const CagRaster *raster; // NULL: the region
  const CagRegion *region;
  CagMass mass; // of the pixels
} CagMassOf;

// The integral of (x - xg)^m (y - yg)^n over the figure, y up, where [xg, yg] is the centroid. It
// is not divided by the area. Fails with "empty-image", "empty-silhouette", or "gray-weight".
CagStatus cag_moment(const CagMassOf *of, int m, int n, double *out, CagError *err);

// The integrals of r^n cos(m t) and r^n sin(m t) over the figure, in polar coordinates about the
// centroid. n - m is even and at least 0. A rotation by t turns this vector by m t.
CagStatus cag_polar_moment(const CagMassOf *of, int m, int n, double out[2], CagError *err);

// The angle by which `seen` is rotated against `reference`, in degrees in [0, 360 / m). It is
// computed from the polar moments of m with n = m, or n = 3 for m = 1, because the first-order one
// about the centroid is 0. *defined is false if one of them is 0: the figure looks the same after a
// rotation by 360 degrees / k, for a k that does not divide m.
CagStatus cag_turn_between(const CagMassOf *reference, const CagMassOf *seen, int m, bool *defined,
                           double *angle, CagError *err);

#endif
