// Regions for trimming surfaces.

#ifndef CAG_TESTS_TRIMMED_SUPPORT_H
#define CAG_TESTS_TRIMMED_SUPPORT_H

#include "tests/geom/surface_support.h"

// The first circle (x, y, radius) is the outline, and the others are holes.
static inline CagRegion *disks(const double (*circles)[3], size_t n) {
  CagCurve *loops[4] = {0};
  CagRegion *r = NULL;
  for (size_t i = 0; i < n; i++) {
    CagTransform frame = cag_translate(cag_vec3(circles[i][0], circles[i][1], 0));
    frame.planar = true;
    MUST(cag_curve_arc(circles[i][2], circles[i][2], 0, 2 * M_PI, &frame, &loops[i], err));
  }
  MUST(cag_region_from_loops(loops, n, &r, err));
  for (size_t i = 0; i < n; i++) cag_curve_release(loops[i]);
  return r;
}

#endif
