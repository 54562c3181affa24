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

// Faces are sorted by the mean of the middles of their edges. The middles of the circles are at x = 6,
// so that the faces with them come before those at x = 10; those of the cylinder count as its axis.
static void parts_are_sorted_by_location(void **state) {
  (void)state;
  static const CagVec3 faces[] = {{0, 10, 5},  {10, 10, 0}, {10, 10, 10}, {10, 0, 5},
                                  {10, 10, 5}, {10, 20, 5}, {20, 10, 5}};
  // The middle of the curve, which is opposite the start of a closed one.
  static const CagVec3 edges[] = {{0, 0, 5},   {0, 10, 0},  {0, 10, 10},  {0, 20, 5},  {6, 10, 0},
                                  {6, 10, 10}, {10, 0, 0},  {10, 0, 10},  {10, 20, 0}, {10, 20, 10},
                                  {20, 0, 5},  {20, 10, 0}, {20, 10, 10}, {20, 20, 5}};
  CagSolid *s = recognized(holed_block(), TOLERANCE);
  size_t n;
  const CagBoundary *b = cag_solid_boundaries(s, &n);
  CagFeatures f = features_of(s);
  assert_int_equal(f.face_count, 7);
  assert_int_equal(f.edge_count, 14);
  assert_int_equal(f.corner_count, 8);
  for (size_t i = 0; i < 7; i++)
    NEAR(cag_norm(cag_sub(f.faces[i].center, faces[i])), 0, 10 * TOLERANCE);
  for (size_t i = 0; i < 14; i++) {
    const CagCurve *c = b->edges[f.edges[i].edge].curve;
    CagVec3 p;
    OK(cag_curve_point(c, (c->start + c->end) / 2, &p, &err));
    NEAR(cag_norm(cag_sub(p, edges[i])), 0, 1e-9);
    for (size_t k = 1; k < f.edges[i].count; k++)
      assert_true(f.edge_faces[f.edges[i].first + k - 1] < f.edge_faces[f.edges[i].first + k]);
  }
  for (size_t i = 0; i < 8; i++) {
    const CagVec3 p = cag_vec3(i & 4 ? 20 : 0, i & 2 ? 20 : 0, i & 1 ? 10 : 0);
    NEAR(cag_norm(cag_sub(f.corners[i].point, p)), 0, 1e-9);
  }
  cag_features_free(&f);
  cag_solid_release(s);
}

// A plate with a row of holes: another radius does not change the numbers of its parts, although
// the mesh has other vertices.
static void a_parameter_does_not_change_the_order(void **state) {
  (void)state;
  enum { HOLES = 3 };
  const double radii[] = {2, 2.1, 3.7};
  CagFeatures first = {0};
  for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
    CagSolid *parts[HOLES + 1], *s;
    OK(cag_solid_box(cag_vec3(40, 12, 3), false, &parts[0], &err));
    for (size_t i = 1; i <= HOLES; i++) {
      CagSolid *hole;
      const CagTransform move = cag_translate(cag_vec3(10 * (double)i, 6, -1));
      OK(cag_solid_cylinder(5, radii[k], radii[k], &hole, &err));
      OK(cag_solid_transform(hole, &move, &parts[i], &err));
      cag_solid_release(hole);
    }
    OK(cag_solid_combine(CAG_DIFFERENCE, parts, HOLES + 1, NULL, &s, &err));
    for (size_t i = 0; i <= HOLES; i++) cag_solid_release(parts[i]);
    s = recognized(s, TOLERANCE);
    CagFeatures f = features_of(s);
    cag_solid_release(s);
    assert_int_equal(f.face_count, 6 + HOLES);
    assert_int_equal(f.edge_count, 12 + 2 * HOLES);
    for (size_t i = 0; k > 0 && i < f.face_count; i++) {
      assert_string_equal(f.faces[i].kind, first.faces[i].kind);
      NEAR(cag_norm(cag_sub(f.faces[i].center, first.faces[i].center)), 0, 0.01);
    }
    for (size_t i = 0; k > 0 && i < f.edge_count; i++) {
      // Starts move with the radius only.
      const double most = strcmp(f.edges[i].kind, "circle") == 0 ? radii[k] - radii[0] : 0;
      assert_string_equal(f.edges[i].kind, first.edges[i].kind);
      NEAR(cag_norm(cag_sub(f.edges[i].start, first.edges[i].start)), most, 1e-9);
    }
    if (k == 0) first = f;
    else cag_features_free(&f);
  }
  cag_features_free(&first);
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
  OK(cag_solid_roll(s, upright, 4, TOLERANCE, NULL, NULL, &out, &err));
  NEAR(volume_of(out), block - 4 * 10 * (1 - M_PI / 4) * 4, layer / 4);
  // Pappus: the section between a square of side 2 and its quarter of a circle, about the axis. Its
  // moment is that of the square less that of the quarter.
  const double moment = 4 * (4 + 1) - (M_PI * (6 - 8 / (3 * M_PI)));
  OK(cag_solid_roll(s, rims, 2, TOLERANCE, NULL, NULL, &out, &err));
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

// --- Surfaces of faces ---

// The set operation of a solid and a box that starts at a corner. Takes the
// solid.
static CagSolid *cut_by_box(CagSolid *s, CagSetOperation op, CagVec3 corner, CagVec3 size) {
  CagSolid *parts[2] = {s, NULL}, *box, *out;
  const CagTransform move = cag_translate(corner);
  OK(cag_solid_box(size, false, &box, &err));
  OK(cag_solid_transform(box, &move, &parts[1], &err));
  OK(cag_solid_combine(op, parts, 2, NULL, &out, &err));
  cag_solid_release(box);
  cag_solid_release(parts[0]);
  cag_solid_release(parts[1]);
  return out;
}

// The area of the faces of a kind, as surfaces. Takes the solid.
static double surface_of(CagSolid *s, const char *kind) {
  s = recognized(s, TOLERANCE);
  CagFeatures f = features_of(s);
  double sum = 0, area;
  for (size_t i = 0; i < f.face_count; i++) {
    if (strcmp(f.faces[i].kind, kind) != 0) continue;
    OK(cag_surface_area(s->faces[i], &area, NULL, &err));
    sum += area;
  }
  cag_features_free(&f);
  cag_solid_release(s);
  return sum;
}

static CagSolid *ball(double radius) {
  CagSolid *s;
  OK(cag_solid_sphere(radius, &s, &err));
  return s;
}

static CagSolid *rod(double height, double radius) {
  CagSolid *s;
  OK(cag_solid_cylinder(height, radius, radius, &s, &err));
  return s;
}

// The faces of kernels have seams, those that are recognized have none: they are closed between
// their edges, or up to a pole. The area of a zone of a ball is 2 pi r h.
static void curved_faces_end_at_their_edges(void **state) {
  (void)state;
  const CagVec3 far = {-20, -20, -20}, large = {40, 40, 40};
  NEAR(surface_of(holed_block(), "cylinder"), 80 * M_PI, 1e-6);
  // Around a pole, between two circles, around both poles, and around none.
  const CagVec3 above = {-20, -20, 1};
  NEAR(surface_of(cut_by_box(ball(5), CAG_INTERSECTION, above, large), "sphere"), 40 * M_PI, 1e-4);
  NEAR(surface_of(cut_by_box(ball(5), CAG_INTERSECTION, above, cag_vec3(40, 40, 2)), "sphere"),
       20 * M_PI, 1e-4);
  NEAR(surface_of(cut_by_box(ball(5), CAG_INTERSECTION, far, cag_vec3(23, 40, 40)), "sphere"),
       80 * M_PI, 1e-4);
  NEAR(surface_of(cut_by_box(ball(5), CAG_INTERSECTION, cag_vec3(3, -20, -20), large), "sphere"),
       20 * M_PI, 1e-4);
  // Half of a rod, without a seam, and a rod that is cut at its top.
  NEAR(surface_of(cut_by_box(rod(10, 4), CAG_INTERSECTION, cag_vec3(0, -20, -20), large),
                  "cylinder"),
       40 * M_PI, 1e-4);
  NEAR(surface_of(cut_by_box(rod(10, 4), CAG_DIFFERENCE, cag_vec3(0, -20, 5), large), "cylinder"),
       60 * M_PI, 1e-4);
}

// A rod with a slanted end: its lateral area is the perimeter times the height at the axis.
static void seams_cross_slanted_ends(void **state) {
  (void)state;
  CagSolid *parts[2], *box, *out;
  CagTransform turn;
  OK(cag_rotate(cag_vec3(1, 2, 0), 0.3, cag_vec3(0, 0, 10), &turn, &err));
  const CagTransform up = cag_translate(cag_vec3(-20, -20, 10));
  const CagTransform both = cag_transform_multiply(&turn, &up);
  parts[0] = rod(20, 4);
  OK(cag_solid_box(cag_vec3(40, 40, 40), false, &box, &err));
  OK(cag_solid_transform(box, &both, &parts[1], &err));
  OK(cag_solid_combine(CAG_DIFFERENCE, parts, 2, NULL, &out, &err));
  cag_solid_release(box);
  cag_solid_release(parts[0]);
  cag_solid_release(parts[1]);
  NEAR(surface_of(out, "cylinder"), 80 * M_PI, 1e-4);
}

// Half of a ring: by Pappus, half of 2 pi R 2 pi r.
static void a_bend_has_its_half(void **state) {
  (void)state;
  CagSolid *ring;
  OK(cag_solid_torus(10, 3, &ring, &err));
  NEAR(surface_of(cut_by_box(ring, CAG_INTERSECTION, cag_vec3(-20, 0, -20), cag_vec3(40, 40, 40)),
                  "torus"),
       60 * M_PI * M_PI, 1e-3);
  OK(cag_solid_torus(10, 3, &ring, &err));
  NEAR(surface_of(cut_by_box(ring, CAG_INTERSECTION, cag_vec3(-20, -20, 0), cag_vec3(40, 40, 40)),
                  "torus"),
       60 * M_PI * M_PI, 1e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(operands_keep_their_faces),
      cmocka_unit_test(cylinders_are_recognized),
      cmocka_unit_test(a_ball_has_no_edges),
      cmocka_unit_test(parts_are_sorted_by_location),
      cmocka_unit_test(a_parameter_does_not_change_the_order),
      cmocka_unit_test(curved_faces_end_at_their_edges),
      cmocka_unit_test(seams_cross_slanted_ends),
      cmocka_unit_test(a_bend_has_its_half),
      cmocka_unit_test(edges_are_rounded),
      cmocka_unit_test(tops_are_left_open),
      cmocka_unit_test(sides_are_inclined),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
