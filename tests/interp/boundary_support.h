// Boundaries of solids for tests, by cag-brep. Without it, these tests are skipped.

#ifndef CAG_TESTS_INTERP_BOUNDARY_SUPPORT_H
#define CAG_TESTS_INTERP_BOUNDARY_SUPPORT_H

#include "base/memory.h"
#include "geom/solid/csg.h"
#include "interp/kernel/kernel.h"
#include "tests/geom/support.h"
#include "tests/interp/kernel_program.h"

static CagKernel *kernel;

static inline int start_kernel(void **state) {
  (void)state;
  if (use_kernel_program()) kernel = cag_kernel_new();
  return 0;
}

static inline int end_kernel(void **state) {
  (void)state;
  cag_kernel_free(kernel);
  return 0;
}

// The boundary of a solid, which is released, of one part. `turn` chooses among its equal forms.
static inline CagBoundary boundary_turned(CagSolid *s, int turn) {
  CagBoundaries all;
  bool approximate;
  OK(cag_kernel_boundary(kernel, s, 0, turn, &all, &approximate, &err));
  cag_solid_release(s);
  assert_int_equal(all.count, 1);
  const CagBoundary b = all.items[0];
  cag_free(all.items);
  return b;
}

static inline CagBoundary boundary_of(CagSolid *s) { return boundary_turned(s, 0); }

static inline CagSolid *moved(CagSolid *s, CagTransform t) {
  CagSolid *out;
  OK(cag_solid_transform(s, &t, &out, &err));
  cag_solid_release(s);
  return out;
}

static inline CagSolid *shifted(CagSolid *s, double x, double y, double z) {
  return moved(s, cag_translate(cag_vec3(x, y, z)));
}

static inline CagSolid *turned(CagSolid *s, CagVec3 axis, double angle) {
  CagTransform t;
  OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &t, &err));
  return moved(s, t);
}

static inline CagSolid *a_box(double x, double y, double z) {
  CagSolid *s;
  OK(cag_solid_box(cag_vec3(x, y, z), true, &s, &err));
  return s;
}

// Standing on z = 0.
static inline CagSolid *a_cylinder(double height, double radius, double top) {
  CagSolid *s;
  OK(cag_solid_cylinder(height, radius, top, &s, &err));
  return s;
}

static inline CagSolid *a_sphere(double radius) {
  CagSolid *s;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}

static inline CagSolid *a_torus(double major, double minor) {
  CagSolid *s;
  OK(cag_solid_torus(major, minor, &s, &err));
  return s;
}

static inline CagSolid *combined(CagSetOperation op, CagSolid *a, CagSolid *b) {
  CagSolid *const operands[2] = {a, b};
  CagSolid *out;
  OK(cag_solid_combine(op, operands, 2, NULL, &out, &err));
  cag_solid_release(a);
  cag_solid_release(b);
  return out;
}

#endif
