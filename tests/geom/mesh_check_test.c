// Faces as boundaries: counts of bodies that are known, whole and damaged.

#include "geom/mesh/check.h"
#include "tests/geom/support.h"

static const CagVec3 cube_vertices[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                         {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const uint32_t cube_faces[24] = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4,
                                        1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
static const uint32_t fours[6] = {4, 4, 4, 4, 4, 4};
static const uint32_t threes[8] = {3, 3, 3, 3, 3, 3, 3, 3};

static void a_cube_is_a_solid(void **state) {
  (void)state;
  CagMeshCheck c;
  OK(cag_faces_check(cube_vertices, 8, cube_faces, fours, 6, &c, &err));
  assert_int_equal(c.vertices, 8);
  assert_int_equal(c.edges, 12);
  assert_int_equal(c.faces, 6);
  assert_int_equal(c.euler, 2);
  assert_int_equal(c.shells, 1);
  assert_int_equal(c.genus, 0);
  assert_true(c.closed && c.oriented && c.solid);
  NEAR(c.volume, 1, 1e-15);
}

static void the_mesh_of_a_cube_is_the_same_body(void **state) {
  (void)state;
  CagMesh *m;
  CagMeshCheck c;
  OK(cag_mesh_from_faces(cube_vertices, 8, cube_faces, fours, 6, &m, &err));
  OK(cag_mesh_check(m, &c, &err));
  assert_int_equal(c.edges, 18); // six diagonals more
  assert_int_equal(c.faces, 12);
  assert_int_equal(c.euler, 2);
  assert_true(c.solid);
  NEAR(c.volume, 1, 1e-15);
  cag_mesh_release(m);
}

static void a_missing_and_a_turned_face_are_told(void **state) {
  (void)state;
  CagMeshCheck c;
  OK(cag_faces_check(cube_vertices, 8, cube_faces, fours, 5, &c, &err));
  assert_int_equal(c.boundary_edges, 4);
  assert_int_equal(c.euler, 1);
  assert_true(!c.closed && c.oriented && !c.solid);
  uint32_t turned[24];
  memcpy(turned, cube_faces, sizeof turned);
  turned[0] = 1, turned[1] = 2, turned[2] = 3, turned[3] = 0;
  OK(cag_faces_check(cube_vertices, 8, turned, fours, 6, &c, &err));
  assert_int_equal(c.boundary_edges, 0);
  assert_true(c.closed && !c.oriented && !c.solid);
}

static void inside_out_has_a_negative_volume(void **state) {
  (void)state;
  CagMeshCheck c;
  uint32_t out[24];
  for (int i = 0; i < 24; i++) out[i] = cube_faces[23 - i];
  OK(cag_faces_check(cube_vertices, 8, out, fours, 6, &c, &err));
  assert_true(c.closed && c.oriented && !c.solid);
  NEAR(c.volume, -1, 1e-15);
}

// Two tetrahedra that share a corner: two shells, each of genus 0.
static void bodies_that_touch_in_a_vertex_are_no_solid(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                       {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const uint32_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
  CagMeshCheck c;
  OK(cag_faces_check(p, 7, faces, threes, 8, &c, &err));
  assert_int_equal(c.edges, 12);
  assert_int_equal(c.euler, 3);
  assert_int_equal(c.shells, 2);
  assert_int_equal(c.nonmanifold_vertices, 1);
  assert_int_equal(c.genus, 0);
  assert_true(c.closed && c.oriented && !c.solid);
  NEAR(c.volume, 2 / 6.0, 1e-15);
}

// A fin on the edge of two triangles.
static void an_edge_of_three_faces_is_told(void **state) {
  (void)state;
  const CagVec3 p[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  const uint32_t faces[] = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  CagMeshCheck c;
  OK(cag_faces_check(p, 5, faces, threes, 3, &c, &err));
  assert_int_equal(c.nonmanifold_edges, 1);
  assert_int_equal(c.boundary_edges, 6);
  assert_int_equal(c.shells, 1);
  assert_int_equal(c.nonmanifold_vertices, 0);
  assert_true(!c.closed && !c.oriented);
}

// A ring of 6 by 12 quadrilaterals, joined at both ends: a torus has 72 vertices, 144 edges, 72
// faces. A vertex that no face names is not counted.
static void a_torus_has_a_handle(void **state) {
  (void)state;
  enum { M = 6, N = 12 };
  CagVec3 p[M * N + 1];
  uint32_t faces[4 * M * N], counts[M * N];
  const double step = 3.14159265358979323846 / 6;
  for (uint32_t i = 0; i < M; i++)
    for (uint32_t j = 0; j < N; j++) {
      double r = 3 + cos(2 * step * i), around = step * j;
      p[i * N + j] = cag_vec3(r * cos(around), r * sin(around), sin(2 * step * i));
      uint32_t *f = faces + 4 * (i * N + j), next_i = (i + 1) % M, next_j = (j + 1) % N;
      counts[i * N + j] = 4;
      f[0] = i * N + j;
      f[1] = i * N + next_j;
      f[2] = next_i * N + next_j;
      f[3] = next_i * N + j;
    }
  p[M * N] = cag_vec3(9, 9, 9);
  CagMeshCheck c;
  OK(cag_faces_check(p, M * N + 1, faces, counts, M * N, &c, &err));
  assert_int_equal(c.vertices, 72);
  assert_int_equal(c.edges, 144);
  assert_int_equal(c.euler, 0);
  assert_int_equal(c.genus, 1);
  assert_true(c.solid);
}

static void bad_faces_are_named(void **state) {
  (void)state;
  CagMeshCheck c;
  const uint32_t twice[] = {0, 1, 2, 1}, beyond[] = {0, 1, 9}, two[] = {2};
  FAILS_AT(cag_faces_check(cube_vertices, 8, twice, fours, 1, &c, &err), "face-degenerate", 0);
  FAILS_AT(cag_faces_check(cube_vertices, 8, twice, two, 1, &c, &err), "face-degenerate", 0);
  FAILS_AT(cag_faces_check(cube_vertices, 8, beyond, threes, 1, &c, &err), "face-index", 0);
  CagVec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}};
  FAILS_AT(cag_faces_check(p, 3, cube_faces, threes, 0, &c, &err), "vertex-not-finite", 2);
  OK(cag_faces_check(cube_vertices, 8, cube_faces, fours, 0, &c, &err));
  assert_true(!c.closed && c.euler == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_cube_is_a_solid),
      cmocka_unit_test(the_mesh_of_a_cube_is_the_same_body),
      cmocka_unit_test(a_missing_and_a_turned_face_are_told),
      cmocka_unit_test(inside_out_has_a_negative_volume),
      cmocka_unit_test(bodies_that_touch_in_a_vertex_are_no_solid),
      cmocka_unit_test(an_edge_of_three_faces_is_told),
      cmocka_unit_test(a_torus_has_a_handle),
      cmocka_unit_test(bad_faces_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
