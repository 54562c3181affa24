// Fillets and chamfers of meshes by rolling balls, at boundaries that cag-brep computed.

#include "geom/boundary/features.h"
#include "geom/mesh/check.h"
#include "geom/solid/exact.h"
#include "geom/solid/rolling.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

#define EDGES_MOST 64

// A solid with its features and the edges that are chosen.
typedef struct Shape {
  CagSolid *solid;
  CagFeatures f;
  CagRolledEdge edges[EDGES_MOST];
  size_t n;
} Shape;

static Shape shape_of(CagSolid *s) {
  Shape out = {0};
  CagBoundary b = boundary_of(s);
  OK(cag_solid_exact(&b, 1, &out.solid, &err));
  size_t n;
  OK(cag_boundary_features(cag_solid_boundaries(out.solid, &n), &out.f, &err));
  return out;
}

static void shape_free(Shape *s) {
  cag_features_free(&s->f);
  cag_solid_release(s->solid);
}

typedef bool Chooses(const CagEdgeFeature *e);

static void choose(Shape *s, Chooses *chooses, double from, double to) {
  s->n = 0;
  for (size_t i = 0; i < s->f.edge_count; i++)
    if (chooses(&s->f.edges[i]))
      s->edges[s->n++] = (CagRolledEdge){0, s->f.edges[i].edge, {from, to}};
}

static bool is_any(const CagEdgeFeature *e) { return e->bend != CAG_EDGE_SMOOTH; }
static bool is_concave(const CagEdgeFeature *e) { return e->bend == CAG_EDGE_CONCAVE; }
static bool is_circle(const CagEdgeFeature *e) { return strcmp(e->kind, "circle") == 0; }
static bool is_vertical(const CagEdgeFeature *e) {
  return strcmp(e->kind, "line") == 0 && fabs(e->direction.z) > 0.999;
}
static bool is_top(const CagEdgeFeature *e) {
  return fabs(e->direction.z) < 1e-6 && e->start.z > 1e-6;
}

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

static double rolled_volume(const Shape *s, double tolerance) {
  CagSolid *out;
  double within;
  OK(cag_solid_roll(s->solid, s->edges, s->n, tolerance, NULL, &within, &out, &err));
  assert_true(within >= tolerance && within <= fmax(tolerance, s->edges[0].size[0] / 6));
  return volume_of(out);
}

// The area between two perpendicular lines and a circle of radius 1 that touches both.
#define CORNER_AREA (1 - M_PI / 4)

static void vertical_edges_of_a_box(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_box(10, 8, 6));
  choose(&s, is_vertical, 2, 2);
  assert_int_equal(s.n, 4);
  // Off by at most the tolerance over the area of the fillets.
  NEAR(rolled_volume(&s, 1e-3), 480 - 4 * 6 * 4 * CORNER_AREA, 4 * 6 * M_PI * 1e-3);
  shape_free(&s);
}

// The formula of rounded_box: a box, its six sides, twelve quarters of cylinders, and a ball.
static double rounded_box_volume(double a, double b, double c, double r) {
  const double x = a - 2 * r, y = b - 2 * r, z = c - 2 * r;
  return x * y * z + 2 * r * (x * y + y * z + z * x) + M_PI * r * r * (x + y + z) +
         4 * M_PI / 3 * r * r * r;
}

static void all_edges_of_a_box(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_box(10, 8, 6));
  choose(&s, is_any, 1.5, 1.5);
  assert_int_equal(s.n, 12);
  const double area = 2 * (80 + 48 + 60);
  NEAR(rolled_volume(&s, 1e-3), rounded_box_volume(10, 8, 6, 1.5), area * 1e-3);
  NEAR(rolled_volume(&s, 1e-2), rounded_box_volume(10, 8, 6, 1.5), area * 1e-2);
  shape_free(&s);
}

static void all_edges_of_a_turned_box(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(turned(shifted(a_box(10, 8, 6), 3, 2, 1), cag_vec3(1, 2, 3), 0.7));
  choose(&s, is_any, 1.5, 1.5);
  assert_int_equal(s.n, 12);
  NEAR(rolled_volume(&s, 1e-3), rounded_box_volume(10, 8, 6, 1.5), 0.376);
  shape_free(&s);
}

// An L of two boxes: one concave edge, of length 10.
static void a_concave_edge_is_filled(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s =
      shape_of(combined(CAG_DIFFERENCE, a_box(20, 20, 10), shifted(a_box(20, 20, 20), 10, 10, 0)));
  choose(&s, is_concave, 3, 3);
  assert_int_equal(s.n, 1);
  NEAR(rolled_volume(&s, 1e-3), 3000 + 10 * 9 * CORNER_AREA, 10 * 5 * 1e-3);
  shape_free(&s);
}

// The rounded rim of a cylinder: by Pappus, the corner area at its centroid is removed. The
// centroid of the area between two lines and a circle of radius 1 is (5/6 - pi/4) / (1 - pi/4) from
// the lines.
static void the_rim_of_a_cylinder(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_cylinder(10, 5, 5));
  choose(&s, is_circle, 1, 1);
  assert_int_equal(s.n, 2);
  const double centroid = 5 - (5.0 / 6 - M_PI / 4) / CORNER_AREA;
  const double volume = 250 * M_PI - 2 * 2 * M_PI * centroid * CORNER_AREA;
  NEAR(rolled_volume(&s, 1e-3), volume, 1e-3 * 150 * M_PI);
  shape_free(&s);
}

static void the_rims_of_a_hole_in_a_tilted_box(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *hole = shifted(a_cylinder(40, 5, 5), 8, 0, -20);
  Shape s =
      shape_of(turned(combined(CAG_DIFFERENCE, a_box(40, 30, 20), hole), cag_vec3(1, 1, 0), 0.5));
  choose(&s, is_circle, 1, 1);
  assert_int_equal(s.n, 2);
  const double centroid = 5 + (5.0 / 6 - M_PI / 4) / CORNER_AREA;
  const double volume = 24000 - 500 * M_PI - 2 * 2 * M_PI * centroid * CORNER_AREA;
  NEAR(rolled_volume(&s, 1e-3), volume, 1e-3 * 300 * M_PI);
  shape_free(&s);
}

static void what_does_not_fit(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_box(10, 8, 6));
  CagSolid *out;
  CagRollLimit limit;
  choose(&s, is_any, 3.5, 3.5);
  FAILS_AMONG(cag_solid_roll(s.solid, s.edges, s.n, 1e-3, &limit, NULL, &out, &err),
              "rounding-too-large", 0, 11);
  NEAR(limit.factor * 3.5, 3, 0.01);
  choose(&s, is_vertical, 5, 5);
  FAILS_AMONG(cag_solid_roll(s.solid, s.edges, s.n, 1e-3, &limit, NULL, &out, &err),
              "rounding-too-large", 0, 3);
  NEAR(limit.factor * 5, 4, 0.1);
  choose(&s, is_vertical, 9, 9);
  FAILS_AT(cag_solid_roll(s.solid, s.edges, 1, 1e-3, &limit, NULL, &out, &err),
           "rounding-too-large", 0);
  NEAR(limit.factor * 9, 8, 0.01);
  shape_free(&s);
}

static CagSolid *an_l(void) {
  return combined(CAG_DIFFERENCE, a_box(20, 20, 10), shifted(a_box(20, 20, 20), 10, 10, 0));
}

// The upper edges of an L: a slice below the top is the L moved inward by d, with the area 300 - 80
// d + 5 d^2 for the convex corners - pi/4 d^2 for the concave one, and d = 1 - sqrt(1 - (1 - z)^2)
// has the integral 1 - pi/4 and that of its square is 5/3 - pi/2.
static void a_ball_turns_about_a_concave_edge(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(an_l());
  choose(&s, is_top, 1, 1);
  assert_int_equal(s.n, 6);
  const double volume = 3000 - 80 * CORNER_AREA + (5 - M_PI / 4) * (5.0 / 3 - M_PI / 2);
  NEAR(rolled_volume(&s, 1e-3), volume, 80 * M_PI / 2 * 1e-3);
  shape_free(&s);
}

// Its slices are those of the L with rounded corners, whose outline has the length 68 + 3 pi.
static void all_edges_of_an_l(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(an_l());
  choose(&s, is_any, 1, 1);
  assert_int_equal(s.n, 18);
  const double volume = 10 * (300 - 4 * CORNER_AREA) - 2 * (68 + 3 * M_PI) * CORNER_AREA +
                        2 * M_PI * (5.0 / 3 - M_PI / 2);
  NEAR(rolled_volume(&s, 1e-3), volume, 240 * M_PI / 2 * 1e-3);
  shape_free(&s);
}

// A box on a plate: the fillet around it is straight along 28, and turns at the corners.
static void a_ball_turns_about_a_convex_edge(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(combined(CAG_UNION, a_box(20, 20, 4), shifted(a_box(6, 8, 20), 0, 0, 9)));
  choose(&s, is_concave, 1, 1);
  assert_int_equal(s.n, 4);
  const double turns = 2 * M_PI * (5.0 / 6 - M_PI / 4);
  NEAR(rolled_volume(&s, 1e-3), 1600 + 48 * 17 + 28 * CORNER_AREA + turns, 35 * M_PI / 2 * 1e-3);
  shape_free(&s);
}

static void bevels(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *out;
  Shape s = shape_of(a_box(10, 8, 6));
  choose(&s, is_vertical, 1, 2);
  OK(cag_solid_bevel(s.solid, s.edges, s.n, 1e-3, NULL, NULL, &out, &err));
  NEAR(volume_of(out), 480 - 4 * 6, 1e-9);
  shape_free(&s);
  // Each corner of the L's top removes a third of a cube less, or more.
  s = shape_of(an_l());
  choose(&s, is_top, 1, 1);
  OK(cag_solid_bevel(s.solid, s.edges, s.n, 1e-3, NULL, NULL, &out, &err));
  NEAR(volume_of(out), 3000 - 40 + 5.0 / 3 - 1.0 / 3, 1e-9);
  shape_free(&s);
}

static void a_radius_changes_along_edges(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_box(10, 8, 6));
  choose(&s, is_vertical, 1, 2);
  NEAR(rolled_volume(&s, 1e-3), 480 - 4 * 6 * CORNER_AREA * 7 / 3, 4 * 6 * M_PI * 1e-3);
  shape_free(&s);
}

static void what_is_not_an_edge(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  Shape s = shape_of(a_box(10, 8, 6));
  CagSolid *out, *plain = a_box(1, 1, 1);
  choose(&s, is_vertical, 1, 1);
  FAILS(cag_solid_roll(plain, s.edges, s.n, 1e-3, NULL, NULL, &out, &err), "no-boundary");
  FAILS(cag_solid_roll(s.solid, s.edges, s.n, 0, NULL, NULL, &out, &err), "tolerance-not-positive");
  s.edges[1] = s.edges[0];
  FAILS_AT(cag_solid_roll(s.solid, s.edges, s.n, 1e-3, NULL, NULL, &out, &err), "no-boundary", 1);
  s.edges[1].edge = 99;
  FAILS_AT(cag_solid_roll(s.solid, s.edges, s.n, 1e-3, NULL, NULL, &out, &err), "no-boundary", 1);
  s.edges[0].size[1] = 0;
  FAILS_AT(cag_solid_roll(s.solid, s.edges, s.n, 1e-3, NULL, NULL, &out, &err),
           "radius-not-positive", 0);
  cag_solid_release(plain);
  shape_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(vertical_edges_of_a_box),
      cmocka_unit_test(all_edges_of_a_box),
      cmocka_unit_test(all_edges_of_a_turned_box),
      cmocka_unit_test(a_concave_edge_is_filled),
      cmocka_unit_test(the_rim_of_a_cylinder),
      cmocka_unit_test(the_rims_of_a_hole_in_a_tilted_box),
      cmocka_unit_test(a_ball_turns_about_a_concave_edge),
      cmocka_unit_test(all_edges_of_an_l),
      cmocka_unit_test(a_ball_turns_about_a_convex_edge),
      cmocka_unit_test(bevels),
      cmocka_unit_test(a_radius_changes_along_edges),
      cmocka_unit_test(what_does_not_fit),
      cmocka_unit_test(what_is_not_an_edge),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
