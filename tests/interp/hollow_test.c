// Shells of meshes, with open faces of boundaries that cag-brep computed.

#include "geom/boundary/features.h"
#include "geom/mesh/check.h"
#include "geom/solid/exact.h"
#include "geom/solid/hollow.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

// The volume of the mesh of a solid, which must be watertight.
static double volume_of(CagSolid *s) {
  CagMesh *m;
  CagMeshCheck check;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  OK(cag_solid_tessellate(s, &how, &m, &err));
  OK(cag_mesh_check(m, &check, &err));
  assert_true(check.solid);
  cag_mesh_release(m);
  cag_solid_release(s);
  return check.volume;
}

static double shell_volume(CagSolid *s, double thickness, bool outside, double tolerance) {
  CagSolid *out;
  OK(cag_solid_hollow(s, thickness, outside, NULL, 0, tolerance, &out, &err));
  cag_solid_release(s);
  return volume_of(out);
}

static void closed_shells(void **state) {
  (void)state;
  NEAR(shell_volume(a_box(10, 20, 30), 1, false, 0.05), 6000 - 8 * 18 * 28, 1e-9);
  // Outside, edges and corners are rounded: sides, quarters of cylinders, a ball.
  const double outside = 2 * (200 + 300 + 600) + M_PI * 60 + 4 * M_PI / 3;
  NEAR(shell_volume(a_box(10, 20, 30), 1, true, 0.01), outside, 0.01 * M_PI * 62);
}

static CagSolid *exact_of(CagSolid *s) {
  CagBoundary b = boundary_of(s);
  CagSolid *out;
  OK(cag_solid_exact(&b, 1, &out, &err));
  return out;
}

// The faces whose normals have this z at their centers.
static size_t faces_facing(const CagSolid *s, double z, CagSolidFace out[8]) {
  CagFeatures f;
  size_t n, count = 0;
  OK(cag_boundary_features(cag_solid_boundaries(s, &n), &f, &err));
  for (size_t i = 0; i < f.face_count; i++)
    if (fabs(f.faces[i].normal.z - z) < 1e-6) out[count++] = (CagSolidFace){0, i};
  cag_features_free(&f);
  return count;
}

static void open_boxes(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *box = exact_of(a_box(10, 20, 30)), *out;
  CagSolidFace open[8];
  size_t n = faces_facing(box, 1, open);
  assert_int_equal(n, 1);
  OK(cag_solid_hollow(box, 1, false, open, n, 0.02, &out, &err));
  NEAR(volume_of(out), 6000 - 8 * 18 * 29, 1e-6 * 6000);
  // A tube: bottom and top are open.
  n += faces_facing(box, -1, open + n);
  assert_int_equal(n, 2);
  OK(cag_solid_hollow(box, 1, false, open, n, 0.02, &out, &err));
  NEAR(volume_of(out), 6000 - 8 * 18 * 30, 1e-6 * 6000);
  cag_solid_release(box);
}

static void walls_that_leave_nothing(void **state) {
  (void)state;
  CagSolid *box = a_box(10, 20, 30), *out;
  FAILS(cag_solid_hollow(box, 6, false, NULL, 0, 0.05, &out, &err), "no-boundary");
  cag_solid_release(box);
}

static void open_walls_outside(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *box = exact_of(a_box(10, 20, 30)), *out;
  CagSolidFace open[8];
  const size_t n = faces_facing(box, 1, open);
  FAILS(cag_solid_hollow(box, 1, true, open, n, 0.05, &out, &err), "no-boundary");
  cag_solid_release(box);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(closed_shells),
      cmocka_unit_test(open_boxes),
      cmocka_unit_test(walls_that_leave_nothing),
      cmocka_unit_test(open_walls_outside),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
