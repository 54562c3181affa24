// Drafts of meshes, at boundaries that cag-brep computed.

#include "geom/boundary/features.h"
#include "geom/mesh/check.h"
#include "geom/solid/csg.h"
#include "geom/solid/exact.h"
#include "geom/solid/incline.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

static CagSolid *exact_of(CagSolid *s) {
  CagBoundary b = boundary_of(s);
  CagSolid *out;
  OK(cag_solid_exact(&b, 1, &out, &err));
  return out;
}

static CagSolid *a_box_on_ground(double side, double height) {
  return shifted(a_box(side, side, height), 0, 0, height / 2);
}

// The flat faces that are parallel to Z.
static size_t upright_faces(const CagSolid *s, CagSolidFace out[16]) {
  CagFeatures f;
  size_t n, count = 0;
  const CagBoundary *b = cag_solid_boundaries(s, &n);
  OK(cag_boundary_features(b, &f, &err));
  for (size_t i = 0; i < f.face_count; i++)
    if (b->faces[i].carrier.kind == CAG_CARRIER_PLANE && fabs(f.faces[i].normal.z) < 1e-9)
      out[count++] = (CagSolidFace){0, i};
  cag_features_free(&f);
  return count;
}

static double drafted_volume(CagSolid *s, const CagSolidFace *faces, size_t n, double slope,
                             double z) {
  CagSolid *out;
  CagMesh *m;
  CagMeshCheck check;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  OK(cag_solid_incline(s, faces, n, atan(slope), cag_vec3(0, 0, z), cag_vec3(0, 0, 1), 1e-3, &out,
                       &err));
  OK(cag_solid_tessellate(out, &how, &m, &err));
  OK(cag_mesh_check(m, &check, &err));
  assert_true(check.solid);
  cag_mesh_release(m);
  cag_solid_release(out);
  return check.volume;
}

// The frustum of a pyramid: h/3 (A + B + sqrt(A B)).
static void a_box_becomes_a_frustum(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *box = exact_of(a_box_on_ground(10, 10));
  CagSolidFace faces[16];
  const size_t n = upright_faces(box, faces);
  assert_int_equal(n, 4);
  NEAR(drafted_volume(box, faces, n, 0.1, 0), 10.0 / 3 * (100 + 64 + 80), 1e-6);
  // From the middle plane, by Simpson's rule with the sides 11, 10, 9.
  NEAR(drafted_volume(box, faces, n, 0.1, 5), 10.0 / 6 * (121 + 400 + 81), 1e-6);
  NEAR(drafted_volume(box, faces, 1, 0.1, 0), 1000 - 0.5 * 10 * 10 * 1, 1e-6);
  cag_solid_release(box);
}

// A box with a pocket, all of whose sides are inclined: the pocket becomes wider to the top.
static void a_pocket_opens(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *pocket = shifted(a_box_on_ground(8, 20), 0, 0, 4);
  CagSolid *exact = exact_of(combined(CAG_DIFFERENCE, a_box_on_ground(20, 10), pocket));
  CagSolidFace faces[16];
  const size_t n = upright_faces(exact, faces);
  assert_int_equal(n, 8);
  // Simpson's rule: sides 20, 19, 18 over the height 10; 8.8, 9.4, 10 over the upper 6.
  const double body = 10.0 / 6 * (400 + 4 * 361 + 324);
  const double hole = 6.0 / 6 * (8.8 * 8.8 + 4 * 9.4 * 9.4 + 100);
  NEAR(drafted_volume(exact, faces, n, 0.1, 0), body - hole, 1e-5);
  cag_solid_release(exact);
}

static void what_cannot_be_drafted(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *box = exact_of(a_box_on_ground(10, 10)), *pin = exact_of(a_cylinder(10, 3, 3)), *out;
  const CagVec3 at = {0, 0, 0}, pull = {0, 0, 1};
  CagSolidFace all[16];
  for (size_t i = 0; i < 6; i++) all[i] = (CagSolidFace){0, i};
  FAILS_AT(cag_solid_incline(box, all, 6, 0.1, at, pull, 1e-2, &out, &err), "no-boundary", 2);
  FAILS_AT(cag_solid_incline(pin, all, 3, 0.1, at, pull, 1e-2, &out, &err), "no-boundary", 0);
  // The sides would meet below the top.
  const size_t n = upright_faces(box, all);
  FAILS_AT(cag_solid_incline(box, all, n, 1, at, pull, 1e-2, &out, &err), "no-boundary", 0);
  cag_solid_release(box);
  cag_solid_release(pin);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_becomes_a_frustum),
      cmocka_unit_test(a_pocket_opens),
      cmocka_unit_test(what_cannot_be_drafted),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
