// Boundaries that are recognized in meshes, and what is made of them without the kernel.

#include "geom/mesh/check.h"
#include "geom/solid/hollow.h"
#include "geom/solid/incline.h"
#include "geom/solid/rolling.h"
#include "geom/solid/tessellate.h"
#include "tests/geom/recognized_support.h"

#define TOLERANCE 0.01

// The volume of the mesh of a solid, which must be watertight. Takes the solid.
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

static size_t count_kind(const CagFeatures *f, const char *kind) {
  size_t n = 0;
  for (size_t i = 0; i < f->edge_count; i++) n += strcmp(f->edges[i].kind, kind) == 0;
  return n;
}

static void check_holed_block(CagSolid *s, double slack) {
  CagFeatures f = features_of(s);
  assert_int_equal(f.face_count, 7);
  assert_int_equal(f.edge_count, 14);
  assert_int_equal(f.corner_count, 8);
  assert_int_equal(count_kind(&f, "line"), 12);
  assert_int_equal(count_kind(&f, "circle"), 2);
  for (size_t i = 0; i < f.edge_count; i++) {
    const CagEdgeFeature *e = &f.edges[i];
    assert_int_equal(e->bend, CAG_EDGE_CONVEX);
    NEAR(e->angle, M_PI / 2, 1e-6);
    if (strcmp(e->kind, "circle") == 0) NEAR(e->length, 8 * M_PI, slack);
    else NEAR(e->length, fabs(e->direction.z) > 0.5 ? 10 : 20, 1e-9);
  }
  cag_features_free(&f);
  cag_solid_release(s);
}

static void operands_keep_their_faces(void **state) {
  (void)state;
  check_holed_block(recognized(holed_block(), TOLERANCE), 1e-6);
}

// The same shape as a mesh, without any knowledge of its cylinder.
static void cylinders_are_recognized(void **state) {
  (void)state;
  CagSolid *block = holed_block(), *s;
  CagTessellation how = CAG_TESSELLATION_DEFAULT;
  CagMesh *m;
  how.tolerance = TOLERANCE;
  OK(cag_solid_tessellate(block, &how, &m, &err));
  OK(cag_solid_from_mesh(m, &s, &err));
  cag_mesh_release(m);
  cag_solid_release(block);
  check_holed_block(recognized(s, TOLERANCE), 1e-3);
}

static void a_ball_has_no_edges(void **state) {
  (void)state;
  CagSolid *ball;
  OK(cag_solid_sphere(5, &ball, &err));
  ball = recognized(ball, TOLERANCE);
  CagFeatures f = features_of(ball);
  assert_int_equal(f.edge_count, 0);
  assert_int_equal(f.face_count, 1);
  NEAR(f.faces[0].area, 100 * M_PI, 2 * TOLERANCE * 4 * M_PI * 5);
  cag_features_free(&f);
  cag_solid_release(ball);
}

// The area between two perpendicular lines and a circle that touches both is (1 - pi/4) r^2.
static void edges_are_rounded(void **state) {
  (void)state;
  CagSolid *s = recognized(holed_block(), TOLERANCE / 2), *out;
  CagFeatures f = features_of(s);
  CagRolledEdge upright[4], rims[2];
  size_t n = 0, rim = 0;
  for (size_t i = 0; i < f.edge_count; i++) {
    const CagRolledEdge edge = {0, f.edges[i].edge, {2, 2}};
    if (strcmp(f.edges[i].kind, "circle") == 0) rims[rim++] = edge;
    else if (fabs(f.edges[i].direction.z) > 0.5) upright[n++] = edge;
  }
  assert_int_equal(n, 4);
  assert_int_equal(rim, 2);
  const double block = 4000 - 160 * M_PI, layer = 1300 * TOLERANCE;
  OK(cag_solid_roll(s, upright, 4, TOLERANCE, NULL, &out, &err));
  NEAR(volume_of(out), block - 4 * 10 * (1 - M_PI / 4) * 4, layer / 4);
  // Pappus: the section between a square of side 2 and its quarter of a circle, about the axis. Its
  // moment is that of the square less that of the quarter.
  const double moment = 4 * (4 + 1) - (M_PI * (6 - 8 / (3 * M_PI)));
  OK(cag_solid_roll(s, rims, 2, TOLERANCE, NULL, &out, &err));
  NEAR(volume_of(out), block - 2 * 2 * M_PI * moment, layer / 4);
  cag_features_free(&f);
  cag_solid_release(s);
}

static void tops_are_left_open(void **state) {
  (void)state;
  CagSolid *s, *out;
  OK(cag_solid_box(cag_vec3(10, 20, 30), false, &s, &err));
  s = recognized(s, TOLERANCE);
  CagFeatures f = features_of(s);
  CagSolidFace open = {0, 0};
  for (size_t i = 0; i < f.face_count; i++)
    if (f.faces[i].normal.z > 0.9) open.face = i;
  OK(cag_solid_hollow(s, 1, false, &open, 1, 0.02, &out, &err));
  NEAR(volume_of(out), 6000 - 8 * 18 * 29, 1e-6 * 6000);
  cag_features_free(&f);
  cag_solid_release(s);
}

// A block whose hole widens with its sides: Simpson's rule is exact for the sections of the block,
// and the hole stays round.
static void sides_are_inclined(void **state) {
  (void)state;
  CagSolid *s = recognized(holed_block(), TOLERANCE), *out;
  CagFeatures f = features_of(s);
  CagSolidFace sides[8];
  size_t n = 0;
  for (size_t i = 0; i < f.face_count; i++)
    if (strcmp(f.faces[i].kind, "plane") == 0 && fabs(f.faces[i].normal.z) < 0.1)
      sides[n++] = (CagSolidFace){0, i};
  assert_int_equal(n, 4);
  OK(cag_solid_incline(s, sides, n, atan(0.1), cag_vec3(0, 0, 0), cag_vec3(0, 0, 1), TOLERANCE,
                       &out, &err));
  NEAR(volume_of(out), 10.0 / 6 * (400 + 4 * 361 + 324) - 160 * M_PI, 250 * TOLERANCE);
  cag_features_free(&f);
  cag_solid_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operands_keep_their_faces), cmocka_unit_test(cylinders_are_recognized),
      cmocka_unit_test(a_ball_has_no_edges),       cmocka_unit_test(edges_are_rounded),
      cmocka_unit_test(tops_are_left_open),        cmocka_unit_test(sides_are_inclined),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
