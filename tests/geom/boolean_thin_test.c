// Set operations of meshes with triangles that have no area, or nearly none.

#include "geom/boolean/boolean.h"
#include "geom/mesh/check.h"
#include "tests/geom/support.h"

// A face without area, whose middle corner is merged with a twin that is off the edge: the sliver
// closes the gap beside it. Here it is A, B, M of the tetrahedron A, B, C, D, and N is the twin of M.
static void triangles_that_get_an_area_are_no_gap(void **state) {
  (void)state;
  enum { A, B, C, D, N, M };
  const double ulp = 4e-16;
  const CagVec3 v[6] = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 1, 2}, {1, -ulp, ulp}, {1, 0, 0}};
  static const uint32_t corners[24] = {A, C, B, B, C, D, A, D, C, A, B, M,
                                       A, M, D, M, N, D, N, B, D, M, B, N};
  CagMesh *solid, *nothing, *both;
  double terms[10];
  CagVec3 edge[2];
  OK(cag_mesh_new(6, 8, false, false, false, &solid, &err));
  OK(cag_mesh_new(0, 0, false, false, false, &nothing, &err));
  memcpy(solid->positions, v, sizeof v);
  memcpy(solid->triangles, corners, sizeof corners);
  OK(cag_mesh_boolean(CAG_UNION, solid, nothing, NULL, &both, &err));
  assert_true(cag_mesh_is_watertight(both, edge));
  cag_mesh_volume_terms(both, terms);
  NEAR(terms[0], 4.0 / 3, 1e-12); // AB x AC . AD / 6
  cag_mesh_release(solid);
  cag_mesh_release(nothing);
  cag_mesh_release(both);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(triangles_that_get_an_area_are_no_gap)};
  return cmocka_run_group_tests_name("boolean_thin", tests, NULL, NULL);
}
