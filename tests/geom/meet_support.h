// Shared by the tests of curves that meet surfaces.

#ifndef CAG_TESTS_GEOM_MEET_SUPPORT_H
#define CAG_TESTS_GEOM_MEET_SUPPORT_H

#include "geom/surface/meet_curve.h"
#include "tests/geom/support.h"

// Counts the points at which the curve meets the surface. Asserts that every point is on both
// within `near`, that the points are in order, and that they have the multiplicity, if it is not 0.
static inline size_t meetings(const CagSurface *s, const CagCurve *c, double near,
                              int multiplicity) {
  CagSurfaceMeeting *m;
  size_t n;
  OK(cag_surface_intersect_curve(s, c, &m, &n, &err));
  for (size_t i = 0; i < n; i++) {
    CagVec3 p, q;
    OK(cag_curve_point(c, m[i].t, &p, &err));
    OK(cag_surface_point(s, m[i].u, m[i].v, &q, &err));
    near_vec(p, q, near);
    if (i > 0) assert_true(m[i].t >= m[i - 1].t);
    if (multiplicity > 0) assert_int_equal(m[i].multiplicity, multiplicity);
  }
  free(m);
  return n;
}

#endif
