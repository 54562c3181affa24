// Meshes of boundaries that cag-brep computed: watertight, and within the tolerance of the faces.

#include "geom/boundary/carrier.h"
#include "geom/boundary/measure.h"
#include "geom/boundary/mesh.h"
#include "tests/interp/boundary_support.h"

#define REQUIRE_KERNEL()                                                                           \
  if (!kernel) skip()

// The distance of a point from a carrier, near the parameters of one of its faces.
static double distance_from(const CagBoundaryFace *f, CagVec3 p) {
  const double middle[2] = {(f->domain[0] + f->domain[1]) / 2, (f->domain[2] + f->domain[3]) / 2};
  double uv[2];
  CagCarrierPoint at;
  if (!cag_carrier_is_analytic(&f->carrier)) return INFINITY;
  cag_carrier_parameters(&f->carrier, p, middle, uv);
  OK(cag_carrier_eval(&f->carrier, uv[0], uv[1], &at, &err));
  return cag_norm(cag_sub(at.point, p));
}

static double nearest_carrier(const CagBoundary *b, CagVec3 p) {
  double least = INFINITY;
  for (size_t i = 0; i < b->face_count; i++) least = fmin(least, distance_from(&b->faces[i], p));
  return least;
}

// The middle of each triangle is within the tolerance of a face's carrier.
static void check_distances(const CagBoundary *b, const CagMesh *m, double tolerance) {
  for (size_t i = 0; i < m->triangle_count; i++) {
    const uint32_t *t = m->triangles + 3 * i;
    const CagVec3 sum =
        cag_add(cag_add(m->positions[t[0]], m->positions[t[1]]), m->positions[t[2]]);
    const double d = nearest_carrier(b, cag_scaled(sum, 1.0 / 3));
    if (!(d <= 1.01 * tolerance)) fail_msg("triangle %zu is %g away, beyond %g", i, d, tolerance);
  }
}

// Meshes of several tolerances; `euler`: the Euler characteristic of the surface.
static void check_meshes(CagSolid *s, int turn, long euler) {
  static const double TOLERANCES[] = {1, 0.1, 0.01};
  CagBoundary b = boundary_turned(s, turn);
  bool analytic = true;
  CagMassProperties mass;
  OK(cag_boundary_mass(&b, &mass, &err));
  for (size_t i = 0; i < b.face_count; i++)
    analytic = analytic && cag_carrier_is_analytic(&b.faces[i].carrier);
  for (size_t k = 0; k < sizeof TOLERANCES / sizeof *TOLERANCES; k++) {
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    bool watertight;
    CagVec3 edge[2];
    double terms[10] = {0};
    how.tolerance = TOLERANCES[k];
    OK(cag_boundary_mesh(&b, &how, false, &m, &err));
    OK(cag_mesh_watertight(m, &watertight, edge, &err));
    assert_true(watertight);
    assert_int_equal(cag_mesh_euler_characteristic(m), euler);
    cag_mesh_volume_terms(m, terms);
    NEAR(terms[0], mass.volume, how.tolerance * mass.area);
    if (analytic) check_distances(&b, m, how.tolerance);
    cag_mesh_release(m);
  }
  cag_boundary_free(&b);
}

static void plates_and_holes(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    check_meshes(a_box(40, 30, 20), turn, 2);
    check_meshes(
        combined(CAG_DIFFERENCE, a_box(40, 30, 20), shifted(a_cylinder(40, 5, 5), 8, 0, -20)), turn,
        0);
    CagSolid *tilted =
        turned(shifted(a_cylinder(60, 6, 6), 0, 0, -30), cag_vec3(0, 1, 0), M_PI / 6);
    check_meshes(combined(CAG_DIFFERENCE, a_box(60, 50, 10), tilted), turn, 0);
    // Five holes, one of them inside of the face's other ones' bounds.
    CagSolid *s = a_box(60, 60, 10);
    for (int k = 0; k < 5; k++)
      s = combined(CAG_DIFFERENCE, s, shifted(a_cylinder(40, 4, 4), 15 * cos(k), 15 * sin(k), -20));
    check_meshes(s, turn, 2 - 2 * 5);
  }
}

static void round_bodies(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    check_meshes(a_sphere(7), turn, 2);
    check_meshes(a_torus(10, 3), turn, 0);
    check_meshes(a_cylinder(30, 10, 0), turn, 2);
    check_meshes(a_cylinder(12, 4, 6), turn, 2);
    check_meshes(combined(CAG_UNION, a_sphere(10), shifted(a_box(20, 20, 20), 10, 10, 10)), turn,
                 2);
    check_meshes(combined(CAG_DIFFERENCE, a_torus(10, 3), shifted(a_box(60, 60, 60), -30, 0, 0)),
                 turn, 2);
    check_meshes(
        combined(CAG_DIFFERENCE, a_cylinder(30, 10, 0), shifted(a_box(80, 80, 80), 44, 0, 0)), turn,
        2);
  }
}

// Two surfaces, the cavity's and the outer one.
static void a_cavity(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  check_meshes(combined(CAG_DIFFERENCE, a_box(20, 20, 20), a_sphere(5)), 0, 4);
}

static void crossed_cylinders(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  for (int turn = 0; turn < CAG_TURNS; turn++) {
    CagSolid *a = shifted(a_cylinder(40, 6, 6), 0, 0, -20);
    CagSolid *b = turned(shifted(a_cylinder(40, 3, 3), 0, 0, -20), cag_vec3(1, 0, 0), M_PI / 2);
    check_meshes(combined(CAG_UNION, cag_solid_retain(a), cag_solid_retain(b)), turn, 2);
    check_meshes(combined(CAG_DIFFERENCE, a, b), turn, 0);
    CagSolid *c = shifted(a_cylinder(40, 6, 6), 0, 0, -20);
    CagSolid *d = turned(cag_solid_retain(c), cag_vec3(1, 0, 0), M_PI / 2);
    check_meshes(combined(CAG_INTERSECTION, c, d), turn, 2);
  }
}

static void splines(void **state) {
  (void)state;
  REQUIRE_KERNEL();
  CagTransform t;
  OK(cag_scale(cag_vec3(1, 2, 3), cag_vec3(0, 0, 0), &t, &err));
  check_meshes(moved(a_sphere(5), t), 0, 2);
  check_meshes(
      combined(CAG_DIFFERENCE, moved(a_sphere(5), t), shifted(a_cylinder(40, 3, 3), 0, 0, -20)), 0,
      0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(plates_and_holes), cmocka_unit_test(round_bodies),
      cmocka_unit_test(a_cavity),         cmocka_unit_test(crossed_cylinders),
      cmocka_unit_test(splines),
  };
  return cmocka_run_group_tests(tests, start_kernel, end_kernel);
}
