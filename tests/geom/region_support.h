// Checks of the points in regions and their offsets.

#ifndef CAG_TESTS_GEOM_REGION_SUPPORT_H
#define CAG_TESTS_GEOM_REGION_SUPPORT_H

#include "geom/curve/region.h"
#include "tests/geom/support.h"

static inline bool holds(const CagRegion *r, double x, double y) {
  bool in;
  OK(cag_region_contains(r, cag_vec3(x, y, 0), &in, &err));
  return in;
}

static inline double distance_to_boundary(const CagRegion *r, CagVec3 from) {
  double nearest = INFINITY;
  for (size_t k = 0; k < r->count; k++) {
    double t, distance;
    CagVec3 p;
    OK(cag_curve_closest(r->loops[k], from, &t, &p, &distance, &err));
    nearest = fmin(nearest, distance);
  }
  return nearest;
}

// Checks that the boundary of the offset region is at the distance, on the correct side.
static inline void check_boundary(const CagRegion *r, const CagRegion *offset, double d,
                                  double tolerance) {
  enum { SAMPLES = 40 };
  for (size_t k = 0; k < offset->count; k++) {
    const CagCurve *c = offset->loops[k];
    double area;
    assert_true(c->closed);
    OK(cag_curve_area(c, &area, NULL, &err));
    assert_int_equal(area > 0, offset->outer[k] == k);
    for (int i = 0; i < SAMPLES; i++) {
      CagVec3 p;
      OK(cag_curve_point(c, c->start + (c->end - c->start) * (i + 0.31) / SAMPLES, &p, &err));
      NEAR(distance_to_boundary(r, p), fabs(d), tolerance);
      assert_int_equal(holds(r, p.x, p.y), d < 0);
    }
  }
}

// Checks that points of a grid are in the offset region if and only if they are within the
// distance.
static inline void check_distances(CagRegion *r, double d, double tolerance) {
  CagRegion *g;
  CagBounds b;
  OK(cag_region_offset(r, d, tolerance, &g, &err));
  OK(cag_region_bounds(r, &b, &err));
  for (int i = 0; i < 400; i++) {
    const double x = b.min.x - 1.5 + (b.max.x - b.min.x + 3) * (i % 20 + 0.43) / 20,
                 y = b.min.y - 1.5 + (b.max.y - b.min.y + 3) * (i / 20 + 0.57) / 20;
    const double nearest = distance_to_boundary(r, cag_vec3(x, y, 0));
    if (fabs(nearest - fabs(d)) < 4 * tolerance) continue;
    const bool in = holds(r, x, y);
    assert_int_equal(holds(g, x, y), d > 0 ? in || nearest < d : in && nearest > -d);
  }
  check_boundary(r, g, d, 2 * tolerance);
  cag_region_release(g);
}

#endif
