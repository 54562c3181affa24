// The invariants that builds with sanitizers assert: valid data pass, and data with one defect do
// not.

#include "geom/basis/knots.h"
#include "geom/mesh/mesh.h"
#include "geom/solid/solid.h"
#include "tests/geom/support.h"

static void knots_are_finite_and_ascend(void **state) {
  (void)state;
  double knots[8] = {0, 0, 0, 0, 1, 1, 1, 1};
  assert_true(cag_check_knots(knots, 4, 3));
  assert_false(cag_check_knots(knots, 3, 3)); // there are only as many points as the degree
  assert_false(cag_check_knots(knots, 4, 0));
  knots[5] = 0.5;
  assert_false(cag_check_knots(knots, 4, 3));
  knots[5] = NAN;
  assert_false(cag_check_knots(knots, 4, 3));
  const double empty[8] = {0, 0, 1, 1, 1, 1, 2, 2};
  assert_false(cag_check_knots(empty, 4, 3));
}

static void curves_have_a_dimension_and_a_domain(void **state) {
  (void)state;
  CagCurve *c;
  OK(cag_curve_line(cag_vec3(0, 0, 0), cag_vec3(1, 2, 0), 2, &c, &err));
  assert_true(cag_check_curve(c));
  c->dimension = 4;
  assert_false(cag_check_curve(c));
  c->dimension = 2;
  c->end = -1;
  assert_false(cag_check_curve(c));
  c->end = INFINITY;
  assert_false(cag_check_curve(c));
  c->end = 1;
  assert_true(cag_check_curve(c));
  cag_curve_release(c);
  assert_false(cag_check_curve(NULL));
}

static void meshes_name_their_vertices(void **state) {
  (void)state;
  CagMesh *m;
  OK(cag_mesh_new(4, 2, false, false, true, &m, &err));
  const uint32_t triangles[6] = {0, 1, 2, 0, 2, 3}, weld[4] = {0, 1, 2, 0};
  for (int i = 0; i < 4; i++) m->positions[i] = cag_vec3(i % 3, i % 3 == 2, 0);
  memcpy(m->triangles, triangles, sizeof triangles);
  memcpy(m->weld, weld, sizeof weld);
  assert_true(cag_check_mesh(m));
  m->triangles[5] = 4;
  assert_false(cag_check_mesh(m));
  m->triangles[5] = 2; // a repeated corner
  assert_false(cag_check_mesh(m));
  m->triangles[5] = 3;
  m->weld[3] = 1; // at another position
  assert_false(cag_check_mesh(m));
  m->weld[0] = 3; // a later vertex
  m->weld[3] = 3;
  assert_false(cag_check_mesh(m));
  memcpy(m->weld, weld, sizeof weld);
  m->positions[1].y = NAN;
  assert_false(cag_check_mesh(m));
  cag_mesh_release(m);
}

static void edges_of_solids_name_faces(void **state) {
  (void)state;
  CagSolid *s;
  OK(cag_solid_cylinder(2, 1, 1, &s, &err));
  assert_true(s->edge_count > 0);
  assert_true(cag_check_solid(s));
  const size_t face = s->edges[0].face[1];
  s->edges[0].face[1] = s->face_count;
  assert_false(cag_check_solid(s));
  s->edges[0].face[1] = face;
  const double u1 = s->faces[0]->u1;
  s->faces[0]->u1 = s->faces[0]->u0;
  assert_false(cag_check_solid(s));
  s->faces[0]->u1 = u1;
  s->placement.m[2][3] = NAN;
  assert_false(cag_check_solid(s));
  cag_solid_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(knots_are_finite_and_ascend),
                                     cmocka_unit_test(curves_have_a_dimension_and_a_domain),
                                     cmocka_unit_test(meshes_name_their_vertices),
                                     cmocka_unit_test(edges_of_solids_name_faces)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
