// Helpers for the tests of intersections of curves with surfaces.

#ifndef CAG_TESTS_GEOM_MEET_SUPPORT_H
#define CAG_TESTS_GEOM_MEET_SUPPORT_H

#include "geom/meet/meet_curve.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

// Counts the points at which the curve meets the surface. Checks that every point is on both within
// `near`, that the points are in order, and that they have the multiplicity, if it is not 0.
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

// The graph z = f(x, y) over [0, 3] x [0, 2], a cubic net whose x and y are u and v.
static inline CagSurface *graph(void) {
  enum { NU = 6, NV = 5 };
  const double ku[] = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3}, kv[] = {0, 0, 0, 0, 1, 2, 2, 2, 2};
  CagVec3 p[NU * NV];
  for (int i = 0; i < NU; i++)
    for (int j = 0; j < NV; j++) {
      const double x = (ku[i + 1] + ku[i + 2] + ku[i + 3]) / 3;
      const double y = (kv[j + 1] + kv[j + 2] + kv[j + 3]) / 3;
      p[i * NV + j] = cag_vec3(x, y, uniform(-1.2, 1.2));
    }
  CagSurface *s;
  OK(cag_surface_nurbs(p, NULL, NU, NV, 3, 3, ku, kv, &s, &err));
  return s;
}

#endif
