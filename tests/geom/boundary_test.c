// Measures, features, and moved copies of boundaries that are made by hand: a cylinder whose wall
// is a cylinder, an extruded or revolved curve, or a spline.

#include "geom/boundary/features.h"
#include "geom/boundary/measure.h"
#include "geom/boundary/moved.h"
#include "geom/boundary/patch.h"
#include "geom/solid/exact.h"
#include "tests/geom/boundary_support.h"

static const CagCarrierKind WALLS[] = {CAG_CARRIER_CYLINDER, CAG_CARRIER_EXTRUDED,
                                       CAG_CARRIER_REVOLVED, CAG_CARRIER_SPLINE};
#define WALL_COUNT (sizeof WALLS / sizeof *WALLS)

static void check_cylinder(const CagBoundary *b, double scale) {
  const double r = scale * WALL_RADIUS, h = scale * WALL_HEIGHT, v = M_PI * r * r * h;
  CagMassProperties m;
  OK(cag_boundary_mass(b, &m, &err));
  NEAR(m.volume, v, 1e-10 * v);
  NEAR(m.area, 2 * M_PI * r * (r + h), 1e-10 * m.area);
  // About the axis, and about the directions across: the trace does not depend on the frame.
  const double along = v * r * r / 2, across = v * (3 * r * r + h * h) / 12;
  NEAR(m.inertia[0][0] + m.inertia[1][1] + m.inertia[2][2], along + 2 * across, 1e-9 * across);
  near_vec(m.volume_centroid, b->centroid, 1e-9 * h);
  near_vec(m.area_centroid, b->centroid, 1e-9 * h);
}

static void all_walls_have_the_measures_of_a_cylinder(void **state) {
  (void)state;
  for (size_t k = 0; k < WALL_COUNT; k++) {
    CagBoundary b = cylinder_boundary(WALLS[k]);
    check_cylinder(&b, 1);
    double area;
    CagVec3 center;
    OK(cag_boundary_face_area(&b, 2, &area, &center, &err));
    NEAR(area, M_PI * WALL_RADIUS * WALL_RADIUS, 1e-10 * area);
    near_vec(center, cag_vec3(0, 0, 0), 1e-10);
    OK(cag_boundary_face_area(&b, 0, &area, NULL, &err));
    NEAR(area, 2 * M_PI * WALL_RADIUS * WALL_HEIGHT, 1e-10 * area);
    cag_boundary_free(&b);
  }
}

static void all_walls_have_two_edges_and_no_corners(void **state) {
  (void)state;
  static const char *const kinds[] = {"cylinder", "extruded", "revolved", "spline"};
  const double r = WALL_RADIUS, h = WALL_HEIGHT;
  for (size_t k = 0; k < WALL_COUNT; k++) {
    CagBoundary b = cylinder_boundary(WALLS[k]);
    CagFeatures f;
    OK(cag_boundary_features(&b, &f, &err));
    assert_int_equal(f.face_count, 3);
    assert_int_equal(f.edge_count, 2);
    assert_int_equal(f.corner_count, 0);
    assert_string_equal(f.faces[0].kind, kinds[k]);
    near_vec(f.faces[0].bounds.min, cag_vec3(-r, -r, 0), 1e-8);
    near_vec(f.faces[0].bounds.max, cag_vec3(r, r, h), 1e-8);
    NEAR(f.faces[0].normal.z, 0, 1e-9);
    near_vec(f.faces[1].normal, cag_vec3(0, 0, 1), 1e-12);
    near_vec(f.faces[2].normal, cag_vec3(0, 0, -1), 1e-12);
    for (size_t i = 0; i < 2; i++) {
      NEAR(f.edges[i].length, 2 * M_PI * r, 1e-9);
      NEAR(f.edges[i].angle, M_PI / 2, 1e-9);
      assert_int_equal(f.edges[i].bend, CAG_EDGE_CONVEX);
      assert_int_equal(f.edges[i].count, 2);
      // The wall's normal, then the cap's.
      NEAR(f.edges[i].normals[0].z, 0, 1e-9);
      NEAR(f.edges[i].normals[1].z, i == 0 ? -1 : 1, 1e-9);
    }
    cag_features_free(&f);
    cag_boundary_free(&b);
  }
}

static void moved_copies_have_the_measures_of_the_image(void **state) {
  (void)state;
  for (size_t k = 0; k < WALL_COUNT; k++) {
    CagBoundary b = cylinder_boundary(WALLS[k]), to;
    CagTransform turn, mirror, scale;
    CagFeatures f;
    OK(cag_rotate(cag_vec3(1, 2, 3), 0.7, cag_vec3(4, 0, 0), &turn, &err));
    OK(cag_reflect(cag_vec3(1, -1, 0.5), cag_vec3(0, 0, 3), &mirror, &err));
    OK(cag_scale(cag_vec3(3, 3, 3), cag_vec3(1, 1, 1), &scale, &err));
    const CagTransform moves[] = {turn, scale, mirror, cag_transform_multiply(&mirror, &scale)};
    for (int i = 0; i < 4; i++) {
      OK(cag_boundary_moved(&b, &moves[i], &to, &err));
      check_cylinder(&to, i % 2 ? 3 : 1);
      near_vec(to.centroid, cag_transform_point(&moves[i], b.centroid), 1e-12);
      OK(cag_boundary_features(&to, &f, &err));
      assert_int_equal(f.edges[0].bend, CAG_EDGE_CONVEX);
      near_vec(f.faces[1].normal, cag_unit(cag_transform_vector(&moves[i], cag_vec3(0, 0, 1))),
               1e-12);
      cag_features_free(&f);
      cag_boundary_free(&to);
    }
    FAILS(cag_boundary_moved(
              &b, &(CagTransform){.m = {{1, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}},
              &to, &err),
          "no-boundary");
    cag_boundary_free(&b);
  }
}

// A cylinder turned inside out, and one without faces.
static void boundaries_must_enclose_a_volume(void **state) {
  (void)state;
  CagBoundary b = cylinder_boundary(CAG_CARRIER_CYLINDER);
  CagMassProperties m;
  for (size_t i = 0; i < 6; i++) b.uses[i].reversed = !b.uses[i].reversed;
  FAILS(cag_boundary_mass(&b, &m, &err), "no-boundary");
  const CagBoundary none = {0};
  FAILS(cag_boundary_mass(&none, &m, &err), "no-boundary");
  cag_boundary_free(&b);
}

// The volume that the kernel found must be that of the faces.
static void exact_solids_are_checked_by_their_volume(void **state) {
  (void)state;
  for (int k = 0; k < 2; k++) {
    CagBoundary b = cylinder_boundary(CAG_CARRIER_CYLINDER);
    CagSolid *s;
    if (k == 1) b.volume *= 1.01;
    OK(cag_solid_exact(&b, 1, &s, &err));
    if (k == 0) OK(cag_solid_exact_check(s, &err));
    else FAILS(cag_solid_exact_check(s, &err), "no-boundary");
    cag_solid_release(s);
  }
}

// Files of other programs have traces that leave the domain of a spline slightly.
static void traces_outside_of_a_spline_are_moved_to_its_edge(void **state) {
  (void)state;
  CagBoundary b = cylinder_boundary(CAG_CARRIER_SPLINE);
  CagSurface *s;
  double area;
  CagCurve **top = &b.uses[2].trace;
  const double from = (*top)->start, to = (*top)->end;
  cag_curve_release(*top);
  *top = straight_trace(from, to, from, 1 + 2e-4, to, 1 - 1e-12);
  OK(cag_boundary_surface(&b, 0, &s, &err));
  OK(cag_surface_area(s, &area, NULL, &err));
  NEAR(area, 2 * M_PI * WALL_RADIUS * WALL_HEIGHT, 1e-9);
  cag_surface_release(s);
  // Farther outside, they are an error.
  cag_curve_release(*top);
  *top = straight_trace(from, to, from, 1.5, to, 1);
  FAILS(cag_boundary_surface(&b, 0, &s, &err), "curve-outside");
  cag_boundary_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(all_walls_have_the_measures_of_a_cylinder),
      cmocka_unit_test(all_walls_have_two_edges_and_no_corners),
      cmocka_unit_test(moved_copies_have_the_measures_of_the_image),
      cmocka_unit_test(boundaries_must_enclose_a_volume),
      cmocka_unit_test(traces_outside_of_a_spline_are_moved_to_its_edge),
      cmocka_unit_test(exact_solids_are_checked_by_their_volume),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
