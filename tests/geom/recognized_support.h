// Solids without the kernel, whose boundaries are recognized in their meshes, for tests.

#ifndef CAG_TESTS_GEOM_RECOGNIZED_SUPPORT_H
#define CAG_TESTS_GEOM_RECOGNIZED_SUPPORT_H

#include "geom/boundary/features.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/recognized.h"
#include "tests/geom/support.h"

// A block with a hole through it: 20 x 20 x 10, radius 4.
static inline CagSolid *holed_block(void) {
  CagSolid *parts[2], *shifted, *out;
  const CagTransform down = cag_translate(cag_vec3(10, 10, -5));
  OK(cag_solid_box(cag_vec3(20, 20, 10), false, &parts[0], &err));
  OK(cag_solid_cylinder(20, 4, 4, &shifted, &err));
  OK(cag_solid_transform(shifted, &down, &parts[1], &err));
  OK(cag_solid_combine(CAG_DIFFERENCE, parts, 2, NULL, &out, &err));
  cag_solid_release(shifted);
  cag_solid_release(parts[0]);
  cag_solid_release(parts[1]);
  return out;
}

// Takes the solid.
static inline CagSolid *recognized(CagSolid *s, double tolerance) {
  CagSolid *out;
  OK(cag_solid_recognized(s, tolerance, &out, &err));
  cag_solid_release(s);
  return out;
}

static inline CagFeatures features_of(const CagSolid *s) {
  CagFeatures f;
  size_t n;
  const CagBoundary *b = cag_solid_boundaries(s, &n);
  assert_int_equal(n, 1);
  OK(cag_boundary_features(b, &f, &err));
  return f;
}

#endif
