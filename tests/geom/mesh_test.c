// Meshes: checks, measures and changes, against bodies whose numbers are known.

#include "geom/mesh/mesh.h"
#include "tests/geom/support.h"

// A cube of side 2 about the origin, as six quadrilaterals seen counter-clockwise from outside.
static const CagVec3 cube_vertices[8] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                         {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
static const uint32_t cube_faces[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                        2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
static const uint32_t fours[6] = {4, 4, 4, 4, 4, 4};

static CagMesh *cube(void) {
  CagMesh *m;
  OK(cag_mesh_from_faces(cube_vertices, 8, cube_faces, fours, 6, &m, &err));
  return m;
}

static void a_cube_is_watertight_and_has_its_measures(void **state) {
  (void)state;
  CagMesh *m = cube();
  CagVec3 edge[2];
  assert_int_equal(m->triangle_count, 12);
  assert_true(cag_mesh_is_watertight(m, edge));
  assert_int_equal(cag_mesh_euler_characteristic(m), 2);
  NEAR(cag_mesh_area(m), 24, 1e-14);
  double terms[10];
  cag_mesh_volume_terms(m, terms);
  NEAR(terms[0], 8, 1e-14);
  for (int k = 1; k < 4; k++) NEAR(terms[k], 0, 1e-14);
  // The integral of x^2 over the cube is 2 * 2 * 2/3.
  for (int k = 4; k < 7; k++) NEAR(terms[k], 8.0 / 3, 1e-14);
  for (int k = 7; k < 10; k++) NEAR(terms[k], 0, 1e-14);
  CagBounds b = cag_mesh_bounds(m);
  near_vec(b.min, cag_vec3(-1, -1, -1), 0);
  near_vec(b.max, cag_vec3(1, 1, 1), 0);
  cag_mesh_release(m);
}

static void a_missing_or_turned_face_is_found(void **state) {
  (void)state;
  CagMesh *m;
  CagVec3 edge[2];
  OK(cag_mesh_from_faces(cube_vertices, 8, cube_faces, fours, 5, &m, &err));
  assert_false(cag_mesh_is_watertight(m, edge));
  NEAR(edge[0].x, 1, 0); // the face x = 1 is missing
  NEAR(edge[1].x, 1, 0);
  assert_int_equal(cag_mesh_euler_characteristic(m), 1);
  cag_mesh_release(m);
  uint32_t turned[24];
  memcpy(turned, cube_faces, sizeof turned);
  turned[1] = 1, turned[3] = 2;
  OK(cag_mesh_from_faces(cube_vertices, 8, turned, fours, 6, &m, &err));
  assert_false(cag_mesh_is_watertight(m, edge));
  cag_mesh_release(m);
}

static void a_mirror_keeps_the_outside_outside(void **state) {
  (void)state;
  CagMesh *m = cube(), *image, *flipped;
  CagTransform mirror = cag_transform_identity();
  mirror.m[0][0] = -3;
  OK(cag_mesh_transform(m, &mirror, &image, &err));
  double terms[10];
  cag_mesh_volume_terms(image, terms);
  NEAR(terms[0], 24, 1e-13);
  OK(cag_mesh_flip(image, &flipped, &err));
  cag_mesh_volume_terms(flipped, terms);
  NEAR(terms[0], -24, 1e-13);
  cag_mesh_release(m);
  cag_mesh_release(image);
  cag_mesh_release(flipped);
}

static void normals_follow_a_transform_as_normals(void **state) {
  (void)state;
  CagMesh *m, *image;
  OK(cag_mesh_new(1, 0, true, false, false, &m, &err));
  double half = sqrt(0.5);
  m->positions[0] = cag_vec3(1, 0, 0);
  m->normals[0] = cag_vec3(half, half, 0); // of the plane x + y = 1
  CagTransform stretch = cag_transform_identity();
  stretch.m[0][0] = -2; // it becomes -x/2 + y = 1
  OK(cag_mesh_transform(m, &stretch, &image, &err));
  near_vec(image->normals[0], cag_unit(cag_vec3(-0.5, 1, 0)), 1e-15);
  cag_mesh_release(m);
  cag_mesh_release(image);
}

static void bad_faces_are_named(void **state) {
  (void)state;
  CagMesh *m;
  uint32_t three = 3, two = 2, four = 4;
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1, 8}, &three, 1, &m, &err),
           "face-index", 0);
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1}, &two, 1, &m, &err),
           "face-degenerate", 0);
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1, 3, 0}, &four, 1, &m, &err),
           "face-degenerate", 0);
  // Two corners exchanged: a bow tie.
  FAILS_AT(cag_mesh_from_faces(cube_vertices, 8, (uint32_t[]){0, 1, 2, 3}, &four, 1, &m, &err),
           "face-degenerate", 0);
  CagVec3 line[4] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {NAN, 0, 0}};
  FAILS_AT(cag_mesh_from_faces(line, 4, (uint32_t[]){0, 1, 2}, &three, 1, &m, &err),
           "vertex-not-finite", 3);
}

static void a_concave_face_is_cut_within_its_outline(void **state) {
  (void)state;
  // An L of area 3 in the plane x = 5.
  CagVec3 l[6] = {{5, 0, 0}, {5, 2, 0}, {5, 2, 1}, {5, 1, 1}, {5, 1, 2}, {5, 0, 2}};
  uint32_t corners[6] = {0, 1, 2, 3, 4, 5}, six = 6;
  CagMesh *m;
  OK(cag_mesh_from_faces(l, 6, corners, &six, 1, &m, &err));
  assert_int_equal(m->triangle_count, 4);
  NEAR(cag_mesh_area(m), 3, 1e-14);
  double terms[10];
  cag_mesh_volume_terms(m, terms); // the cone over it from the origin
  NEAR(terms[0], 5, 1e-14);
  cag_mesh_release(m);
}

// Triangles of the cube, each with corners of its own and a little noise.
static CagMesh *loose_cube(double noise) {
  CagMesh *m = cube(), *loose;
  OK(cag_mesh_new(36, 12, false, false, false, &loose, &err));
  for (uint32_t k = 0; k < 36; k++) {
    loose->positions[k] = m->positions[m->triangles[k]];
    loose->positions[k].x += noise * ((k * 7) % 5) / 4;
    loose->triangles[k] = k;
  }
  cag_mesh_release(m);
  return loose;
}

static void welding_closes_what_is_near(void **state) {
  (void)state;
  CagMesh *loose = loose_cube(1e-4), *welded;
  CagVec3 edge[2];
  assert_false(cag_mesh_is_watertight(loose, edge));
  OK(cag_mesh_weld(loose, 1e-3, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  assert_int_equal(welded->triangle_count, 12);
  assert_true(cag_mesh_is_watertight(welded, edge));
  cag_mesh_release(welded);
  OK(cag_mesh_weld(loose, 1e-6, &welded, &err));
  assert_true(welded->vertex_count > 8);
  cag_mesh_release(welded);
  FAILS(cag_mesh_weld(loose, -1, &welded, &err), "tolerance-negative");
  cag_mesh_release(loose);
  loose = loose_cube(0);
  OK(cag_mesh_weld(loose, 0, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  cag_mesh_release(welded);
  OK(cag_mesh_weld(loose, 10, &welded, &err));
  assert_int_equal(welded->triangle_count, 0);
  cag_mesh_release(welded);
  cag_mesh_release(loose);
}

// A tessellated box has a vertex for each corner of each face, so that its edges are sharp.
static void welding_joins_vertices_across_sharp_edges(void **state) {
  (void)state;
  CagMesh *m = cube(), *doubled, *welded;
  OK(cag_mesh_new(8, 12, true, true, true, &doubled, &err));
  memcpy(doubled->positions, m->positions, 8 * sizeof *m->positions);
  memcpy(doubled->triangles, m->triangles, 36 * sizeof *m->triangles);
  for (uint32_t i = 0; i < 8; i++) {
    doubled->normals[i] = cag_unit(doubled->positions[i]);
    doubled->uv[2 * i] = doubled->uv[2 * i + 1] = 0.5;
    doubled->weld[i] = i;
  }
  CagMesh *pair;
  OK(cag_mesh_append((CagMesh *[]){doubled, doubled}, 2, &pair, &err));
  OK(cag_mesh_weld(pair, 0, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  assert_non_null(welded->normals); // all agree
  assert_non_null(welded->uv);
  assert_null(welded->weld);
  cag_mesh_release(welded);
  pair->normals[12] = cag_scaled(pair->normals[12], -1);
  pair->uv[20] = 0.25;
  OK(cag_mesh_weld(pair, 1e-9, &welded, &err));
  assert_int_equal(welded->vertex_count, 8);
  assert_null(welded->normals);
  assert_null(welded->uv);
  cag_mesh_release(welded);
  cag_mesh_release(pair);
  cag_mesh_release(doubled);
  cag_mesh_release(m);
}

static void meshes_join_to_one(void **state) {
  (void)state;
  CagMesh *a = cube(), *b, *both;
  CagTransform away = cag_translate(cag_vec3(5, 0, 0));
  OK(cag_mesh_transform(a, &away, &b, &err));
  OK(cag_mesh_append((CagMesh *[]){a, b}, 2, &both, &err));
  assert_int_equal(both->triangle_count, 24);
  assert_int_equal(cag_mesh_euler_characteristic(both), 4); // two spheres
  double terms[10];
  cag_mesh_volume_terms(both, terms);
  NEAR(terms[0], 16, 1e-13);
  NEAR(terms[1], 40, 1e-12); // of the second: 8 * 5
  cag_mesh_release(a);
  cag_mesh_release(b);
  cag_mesh_release(both);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_cube_is_watertight_and_has_its_measures),
      cmocka_unit_test(a_missing_or_turned_face_is_found),
      cmocka_unit_test(a_mirror_keeps_the_outside_outside),
      cmocka_unit_test(normals_follow_a_transform_as_normals),
      cmocka_unit_test(bad_faces_are_named),
      cmocka_unit_test(a_concave_face_is_cut_within_its_outline),
      cmocka_unit_test(welding_closes_what_is_near),
      cmocka_unit_test(welding_joins_vertices_across_sharp_edges),
      cmocka_unit_test(meshes_join_to_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
