// Areas, volumes, centroids, and inertia of boundaries that cag-brep computed, compared with
// formulas.

#include "geom/boundary/measure.h"
#include "tests/interp/boundary_support.h"

// Of conics on planes and surfaces of revolution, and of other curves.
#define EXACT 1e-9
#define CLOSE 1e-6

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

static CagMassProperties measured(const CagBoundary *b) {
  CagMassProperties m;
  OK(cag_boundary_mass(b, &m, &err));
  double sum = 0;
  for (size_t i = 0; i < b->face_count; i++) {
    double area;
    CagVec3 center;
    OK(cag_boundary_face_area(b, i, &area, &center, &err));
    assert_true(area > 0);
    sum += area;
  }
  NEAR(sum, m.area, 1e-9 * m.area);
  return m;
}

static CagMassProperties mass_turned(CagSolid *s, int turn) {
  CagBoundary b = boundary_turned(s, turn);
  const CagMassProperties m = measured(&b);
  cag_boundary_free(&b);
  return m;
}

static CagMassProperties mass_of(CagSolid *s) { return mass_turned(s, 0); }

static void check(const CagMassProperties *m, double volume, double area, double tolerance) {
  NEAR(m->volume, volume, tolerance * volume);
  NEAR(m->area, area, tolerance * area);
}

static void a_plate_with_a_hole(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *hole = shifted(a_cylinder(40, 5, 5), 8, 0, -20);
  const CagMassProperties m = mass_of(combined(CAG_DIFFERENCE, a_box(40, 30, 20), hole));
  const double drilled = M_PI * 25 * 20, v = 24000 - drilled, x = -8 * drilled / v;
  check(&m, v, 2 * (1200 - 25 * M_PI) + 2 * 20 * 70 + 2 * M_PI * 5 * 20, 1e-12);
  near_vec(m.volume_centroid, cag_vec3(x, 0, 0), 1e-11);
  // About the vertical through the centroid, by Steiner's theorem.
  const double whole = 24000 * (1600 + 900) / 12.0, part = drilled * (12.5 + 64);
  NEAR(m.inertia[2][2], whole - part - v * x * x, 1e-9 * whole);
  NEAR(m.inertia[0][1], 0, 1e-9 * whole);
}

static void whole_round_bodies(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    CagMassProperties m = mass_turned(a_sphere(7), turn);
    check(&m, 4.0 / 3 * M_PI * 343, 4 * M_PI * 49, 1e-12);
    for (int k = 0; k < 3; k++) NEAR(m.inertia[k][k], 0.4 * m.volume * 49, 1e-10 * m.volume * 49);
    m = mass_turned(a_torus(10, 3), turn);
    check(&m, 2 * M_PI * M_PI * 90, 4 * M_PI * M_PI * 30, 1e-12);
    // Of a solid torus: m (R^2 + 3/4 r^2) about its axis.
    NEAR(m.inertia[2][2], m.volume * (100 + 0.75 * 9), 1e-10 * m.volume * 100);
    m = mass_turned(a_cylinder(30, 10, 0), turn);
    check(&m, M_PI * 100 * 30 / 3, M_PI * 100 + M_PI * 10 * sqrt(1000), 1e-12);
    near_vec(m.volume_centroid, cag_vec3(0, 0, 7.5), 1e-11);
    m = mass_turned(a_cylinder(12, 4, 6), turn);
    check(&m, M_PI * 12 / 3 * (16 + 24 + 36), M_PI * (16 + 36) + M_PI * 10 * sqrt(148), 1e-12);
  }
}

static void a_tilted_hole_meets_the_faces_in_ellipses(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *hole = turned(shifted(a_cylinder(60, 6, 6), 0, 0, -30), cag_vec3(0, 1, 0), M_PI / 6);
  const CagMassProperties m = mass_of(combined(CAG_DIFFERENCE, a_box(60, 50, 10), hole));
  const double ellipse = M_PI * 36 / cos(M_PI / 6);
  // The wall of the hole is as high everywhere, along the cylinder.
  const double wall = 2 * M_PI * 6 * 10 / cos(M_PI / 6);
  check(&m, 30000 - ellipse * 10, 2 * (3000 - ellipse) + 2 * 10 * 110 + wall, EXACT);
  near_vec(m.volume_centroid, cag_vec3(0, 0, 0), 1e-7);
}

// A ball without a cap of this height, whose axis is in any direction.
static void check_ball(CagVec3 axis, double angle, double height, int turn) {
  const double r = 10, h = height;
  CagSolid *cutter = shifted(a_box(60, 60, 60), 0, 0, r - h + 30);
  if (angle != 0) cutter = turned(cutter, axis, angle);
  const CagMassProperties m = mass_turned(combined(CAG_DIFFERENCE, a_sphere(r), cutter), turn);
  const double cap = M_PI * h * h * (3 * r - h) / 3, disk = M_PI * (2 * r * h - h * h);
  check(&m, 4.0 / 3 * M_PI * r * r * r - cap, 4 * M_PI * r * r - 2 * M_PI * r * h + disk, EXACT);
  CagTransform t = cag_transform_identity();
  if (angle != 0) OK(cag_rotate(axis, angle, cag_vec3(0, 0, 0), &t, &err));
  const double middle = 3 * (2 * r - h) * (2 * r - h) / (4 * (3 * r - h)); // of the cap
  const CagVec3 expected = cag_vec3(0, 0, -middle * cap / m.volume);
  near_vec(m.volume_centroid, cag_transform_vector(&t, expected), 1e-8);
}

static void balls_cut_in_any_direction(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    check_ball(cag_vec3(0, 0, 1), 0, 4, turn);                // around a pole
    check_ball(cag_vec3(0, 1, 0), M_PI / 2, 4, turn);         // far from both poles
    check_ball(cag_vec3(0, 1, 0), M_PI / 2, 10, turn);        // through both poles
    check_ball(cag_vec3(0, 1, 0), M_PI / 2, 10.001, turn);    // close to them
    check_ball(cag_vec3(1, 2, 0), 0.7, 6.5, turn);            // oblique
    check_ball(cag_vec3(0, 1, 0), acos(0.8), 2, turn);        // through one pole
    check_ball(cag_vec3(0, 1, 0), acos(0.8) + 1e-4, 2, turn); // close to it
  }
}

static void half_a_torus(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  const double r = 10, q = 3;
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    CagSolid *cutter = shifted(a_box(60, 60, 60), -30, 0, 0);
    const CagMassProperties m = mass_turned(combined(CAG_DIFFERENCE, a_torus(r, q), cutter), turn);
    check(&m, M_PI * M_PI * r * q * q, 2 * M_PI * M_PI * r * q + 2 * M_PI * q * q, EXACT);
    // By Pappus's theorem, with the second moment of the circle.
    near_vec(m.volume_centroid, cag_vec3(2 * (r * r + q * q / 4) / (M_PI * r), 0, 0), 1e-8);
  }
}

static void half_a_cone_has_edges_to_its_apex(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *cutter = shifted(a_box(80, 80, 80), -40, 0, 0);
  const CagMassProperties m = mass_of(combined(CAG_DIFFERENCE, a_cylinder(30, 10, 0), cutter));
  const double side = M_PI * 10 * sqrt(1000);
  check(&m, M_PI * 500, (side + M_PI * 100) / 2 + 300, EXACT);
  NEAR(m.volume_centroid.x, 10 / M_PI, 1e-8); // of a half disk: 4 r / (3 pi), weighted by r^2
}

// The part of a cone beyond a plane along its axis, by horizontal segments of circles: the height
// where the radius is r falls by 3 for each unit of r. The substitution r = 4 + s^2 makes the
// integrand smooth; Simpson's rule.
static double segments_beyond(double distance, double radius) {
  const int n = 20000;
  double sum = 0;
  const double most = sqrt(radius - distance);
  for (int i = 0; i <= n; i++) {
    const double s = most * i / n, r = distance + s * s;
    const double area = r * r * acos(distance / r) - distance * sqrt(r * r - distance * distance);
    sum += area * 3 * 2 * s * (i == 0 || i == n ? 1 : i % 2 ? 4 : 2);
  }
  return sum * most / n / 3;
}

static void a_cone_cut_by_a_box_in_a_hyperbola(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *cutter = shifted(a_box(80, 80, 80), 44, 0, 0);
  const CagMassProperties m = mass_of(combined(CAG_DIFFERENCE, a_cylinder(30, 10, 0), cutter));
  const double volume = M_PI * 1000 - segments_beyond(4, 10);
  NEAR(m.volume, volume, CLOSE * volume);
}

static void a_ball_at_the_corner_of_a_box(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    CagSolid *box = shifted(a_box(20, 20, 20), 10, 10, 10);
    const CagMassProperties m = mass_turned(combined(CAG_UNION, a_sphere(10), box), turn);
    check(&m, 8000 + 7.0 / 8 * 4 / 3 * M_PI * 1000, 2400 - 75 * M_PI + 7.0 / 8 * 4 * M_PI * 100,
          EXACT);
  }
}

static void crossed_cylinders(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *a = shifted(a_cylinder(40, 6, 6), 0, 0, -20);
  CagSolid *b = turned(cag_solid_retain(a), cag_vec3(1, 0, 0), M_PI / 2);
  const CagMassProperties m = mass_of(combined(CAG_INTERSECTION, a, b));
  check(&m, 16.0 / 3 * 216, 16 * 36, CLOSE); // Steinmetz's solid
}

static void unequal_crossed_cylinders(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *a = shifted(a_cylinder(40, 6, 6), 0, 0, -20),
           *b = shifted(a_cylinder(40, 3, 3), 0, 0, -20);
  b = turned(b, cag_vec3(1, 0, 0), M_PI / 2);
  CagBoundary body = boundary_of(combined(CAG_DIFFERENCE, a, b));
  const CagMassProperties m = measured(&body);
  // Their common volume is a complete elliptic integral: int of 4 sqrt(36 - z^2) sqrt(9 - z^2) over
  // -3..3, with z = 3 sin t.
  double common = 0;
  const int n = 400; // periodic and smooth: the trapezoidal rule converges geometrically
  for (int i = 0; i < n; i++) {
    const double t = 2 * M_PI * i / n, z = 3 * sin(t);
    common += 4 * sqrt(36 - z * z) * 9 * cos(t) * cos(t) * M_PI / n;
  }
  const double volume = M_PI * 36 * 40 - common;
  NEAR(m.volume, volume, CLOSE * volume);
  NEAR(m.area, body.area, CLOSE * m.area);
  cag_boundary_free(&body);
}

static void a_cavity(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  const CagMassProperties m = mass_of(combined(CAG_DIFFERENCE, a_box(20, 20, 20), a_sphere(5)));
  check(&m, 8000 - 4.0 / 3 * M_PI * 125, 2400 + 4 * M_PI * 25, 1e-12);
}

static void far_away(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *hole = shifted(a_cylinder(40, 5, 5), 0, 0, -20);
  CagSolid *plate = combined(CAG_DIFFERENCE, a_box(40, 30, 20), hole);
  const CagMassProperties m = mass_of(shifted(plate, 1e5, -2e5, 3e5));
  check(&m, 24000 - 500 * M_PI, 2 * (1200 - 25 * M_PI) + 2800 + 200 * M_PI, EXACT);
  near_vec(m.volume_centroid, cag_vec3(1e5, -2e5, 3e5), 1e-8);
}

static void mirrored_bodies(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagTransform t;
  OK(cag_reflect(cag_vec3(1, 2, 3), cag_vec3(1, 0, 0), &t, &err));
  CagSolid *cutter = shifted(a_box(60, 60, 60), -30, 0, 0);
  const CagMassProperties m = mass_of(moved(combined(CAG_DIFFERENCE, a_torus(10, 3), cutter), t));
  check(&m, M_PI * M_PI * 90, 2 * M_PI * M_PI * 30 + 18 * M_PI, EXACT);
  const CagVec3 center = cag_vec3(2 * (100 + 9 / 4.0) / (M_PI * 10), 0, 0);
  near_vec(m.volume_centroid, cag_transform_point(&t, center), 1e-8);
}

static void an_ellipsoid_is_a_spline(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagTransform t;
  OK(cag_scale(cag_vec3(1, 2, 3), cag_vec3(0, 0, 0), &t, &err));
  const CagMassProperties m = mass_of(moved(a_sphere(5), t));
  NEAR(m.volume, 4.0 / 3 * M_PI * 750, CLOSE * m.volume);
}

// A plane curve through points at these distances from the origin, as a closed spline.
static CagRegion *a_spline_region(double x) {
  static const double RADII[8] = {4, 6, 5, 3, 4, 5, 6, 5};
  CagVec3 points[8];
  CagCurve *loop;
  CagRegion *r;
  for (int i = 0; i < 8; i++)
    points[i] = cag_vec3(x + RADII[i] * cos(i * M_PI / 4), RADII[i] * sin(i * M_PI / 4), 0);
  OK(cag_curve_nurbs_closed(points, NULL, 8, 3, 2, &loop, &err));
  OK(cag_region_new(loop, NULL, 0, &r, &err));
  cag_curve_release(loop);
  return r;
}

// The same solid, measured by its faces as cag made them.
static void check_as_made(CagSolid *s) {
  CagMassProperties expected;
  OK(cag_solid_mass(s, &expected, &err));
  const CagMassProperties m = mass_of(s);
  check(&m, expected.volume, expected.area, 1e-8);
  near_vec(m.volume_centroid, expected.volume_centroid, 1e-7);
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      NEAR(m.inertia[i][k], expected.inertia[i][k], 1e-7 * expected.inertia[2][2]);
}

static void extrusions_and_revolutions_of_splines(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagSolid *s;
  CagRegion *r = a_spline_region(0);
  OK(cag_solid_extrude(r, cag_vec3(1, 2, 10), 0, 1, &s, &err));
  check_as_made(s);
  cag_region_release(r);
  r = a_spline_region(12);
  OK(cag_solid_revolve(r, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &s, &err));
  check_as_made(s);
  OK(cag_solid_revolve(r, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0.3, 2, &s, &err));
  check_as_made(s);
  cag_region_release(r);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_plate_with_a_hole),
      cmocka_unit_test(whole_round_bodies),
      cmocka_unit_test(a_tilted_hole_meets_the_faces_in_ellipses),
      cmocka_unit_test(balls_cut_in_any_direction),
      cmocka_unit_test(half_a_torus),
      cmocka_unit_test(half_a_cone_has_edges_to_its_apex),
      cmocka_unit_test(a_cone_cut_by_a_box_in_a_hyperbola),
      cmocka_unit_test(a_ball_at_the_corner_of_a_box),
      cmocka_unit_test(crossed_cylinders),
      cmocka_unit_test(unequal_crossed_cylinders),
      cmocka_unit_test(a_cavity),
      cmocka_unit_test(far_away),
      cmocka_unit_test(mirrored_bodies),
      cmocka_unit_test(an_ellipsoid_is_a_spline),
      cmocka_unit_test(extrusions_and_revolutions_of_splines),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
