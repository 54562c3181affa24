// Rings, for the tests of intersections with trimmed surfaces.

#ifndef CAG_TESTS_GEOM_RING_SUPPORT_H
#define CAG_TESTS_GEOM_RING_SUPPORT_H

#include "geom/surface/trimmed.h"
#include "tests/geom/meet_support.h"

static inline CagCurve *circle(double x, double y, double r) {
  CagTransform frame = cag_transform_identity();
  CagCurve *c;
  frame.m[0][3] = x;
  frame.m[1][3] = y;
  OK(cag_curve_arc(r, r, 0, 2 * M_PI, &frame, &c, &err));
  return c;
}

// A disk with a hole, in the plane z = 0 or in a graph whose u and v are x and y.
static inline CagSurface *ring(const CagSurface *s, const double disk[3], const double hole[3]) {
  CagCurve *outer = circle(disk[0], disk[1], disk[2]), *inner = circle(hole[0], hole[1], hole[2]);
  CagRegion *region;
  CagSurface *out;
  const CagTransform frame = cag_transform_identity();
  OK(cag_region_new(outer, &inner, 1, &region, &err));
  if (s) OK(cag_surface_trimmed(s, region, &out, &err));
  else OK(cag_surface_planar(region, &frame, &out, &err));
  cag_region_release(region);
  cag_curve_release(outer);
  cag_curve_release(inner);
  return out;
}

// How far a point is inside the ring.
static inline double inside_of(double x, double y, const double disk[3], const double hole[3]) {
  return fmin(disk[2] - hypot(x - disk[0], y - disk[1]), hypot(x - hole[0], y - hole[1]) - hole[2]);
}

#endif
