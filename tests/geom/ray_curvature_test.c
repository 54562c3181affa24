// Curvatures where rays meet exact shapes are those of the formulas of differential geometry.

#include "geom/ray/caster.h"
#include "geom/ray/ray_curvature.h"
#include "geom/solid/csg.h"
#include "tests/geom/random.h"
#include "tests/geom/surface_support.h"

// The curvature where the first rays from `from` towards `to` meet the solid.
static CagBend bend_of(const CagSolid *s, CagVec3 from, CagVec3 to, CagVec3 *at) {
  CagCaster *c = NULL;
  CagCrossings work = {0};
  CagCrossing x;
  CagBend bend;
  bool met, known;
  const CagRay ray = {from, cag_unit(cag_sub(to, from)), 0, INFINITY};
  MUST(cag_caster_of_solid(s, &c, err));
  MUST(cag_caster_first(c, &ray, &work, &x, &met, err));
  assert_true(met);
  *at = cag_ray_point(&ray, x.t);
  MUST(cag_crossing_bend(&x, *at, &bend, &known, err));
  assert_true(known);
  cag_crossings_free(&work);
  cag_caster_free(c);
  return bend;
}

static CagTransform scaling(double x, double y, double z) {
  CagTransform t = cag_transform_identity();
  t.m[0][0] = x;
  t.m[1][1] = y;
  t.m[2][2] = z;
  return t;
}

// x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 (do Carmo, Differential Geometry of Curves and Surfaces, 3-3).
static void an_ellipsoid_has_its_curvatures(void **state) {
  (void)state;
  const double a = 3, b = 2, c = 5;
  const CagTransform stretch = scaling(a, b, c);
  CagSolid *ball, *s;
  MUST(cag_solid_sphere(1, &ball, err));
  MUST(cag_solid_transform(ball, &stretch, &s, err));
  for (int k = 0; k < 100; k++) {
    const CagVec3 to = cag_vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    CagVec3 p;
    const CagBend bend = bend_of(s, cag_vec3(uniform(-30, 30), 20, uniform(-30, 30)), to, &p);
    const double sum = p.x * p.x / pow(a, 4) + p.y * p.y / pow(b, 4) + p.z * p.z / pow(c, 4);
    const double abc = a * a * b * b * c * c;
    assert_near(bend.gaussian, 1 / (abc * sum * sum), 1e-10, "Gaussian");
    assert_near(bend.mean, (a * a + b * b + c * c - cag_dot(p, p)) / (2 * abc * pow(sum, 1.5)),
                1e-10, "mean");
  }
  cag_solid_release(ball);
  cag_solid_release(s);
}

static void a_cone_has_the_curvature_of_its_circles(void **state) {
  (void)state;
  CagSolid *cone;
  CagVec3 p;
  // The radius is 1 half way up; the normal is 45 degrees above the plane of the circle.
  MUST(cag_solid_cylinder(2, 2, 0, &cone, err));
  CagBend bend = bend_of(cone, cag_vec3(9, 0, 1), cag_vec3(0, 0, 1), &p);
  assert_near(p.x, 1, 1e-12, "radius");
  assert_near(bend.mean, sqrt(0.5) / 2, 1e-12, "mean");
  assert_near(bend.gaussian, 0, 1e-12, "Gaussian");
  bend = bend_of(cone, cag_vec3(0.5, 0, -4), cag_vec3(0.5, 0, 0), &p);
  assert_near(bend.mean, 0, 0, "flat end");
  cag_solid_release(cone);
}

static void a_torus_has_the_curvatures_of_its_circles(void **state) {
  (void)state;
  CagSolid *torus;
  CagVec3 p;
  MUST(cag_solid_torus(5, 2, &torus, err));
  CagBend bend = bend_of(torus, cag_vec3(20, 0, 0), cag_vec3(0, 0, 0), &p);
  assert_near(bend.mean, (1 / 2.0 + 1 / 7.0) / 2, 1e-12, "outer mean");
  assert_near(bend.gaussian, 1 / 14.0, 1e-12, "outer Gaussian");
  bend = bend_of(torus, cag_vec3(0, 0, 0), cag_vec3(1, 0, 0), &p);
  assert_near(bend.mean, (1 / 2.0 - 1 / 3.0) / 2, 1e-12, "inner mean");
  assert_near(bend.gaussian, -1 / 6.0, 1e-12, "inner Gaussian");
  cag_solid_release(torus);
}

// A body with faces, made 3 times as large as an operand: a torus again, subtracted from a box.
static void operands_have_their_own_curvatures(void **state) {
  (void)state;
  CagCurve *circle;
  CagRegion *disk;
  CagSolid *ring, *box, *hollow, *large;
  CagVec3 p;
  CagTransform frame = cag_transform_identity(), grow = scaling(3, 3, 3);
  frame.m[0][3] = 5;
  MUST(cag_curve_arc(2, 2, 0, 2 * M_PI, &frame, &circle, err));
  MUST(cag_region_new(circle, NULL, 0, &disk, err));
  MUST(cag_solid_revolve(disk, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * M_PI, &ring, err));
  MUST(cag_solid_box(cag_vec3(40, 40, 0.5), true, &box, err));
  CagSolid *operands[2] = {box, ring};
  MUST(cag_solid_combine(CAG_DIFFERENCE, operands, 2, NULL, &hollow, err));
  MUST(cag_solid_transform(hollow, &grow, &large, err));
  // From the middle of the groove outward: the inner side of the outer wall at z = 0.
  const CagBend bend = bend_of(large, cag_vec3(15, 0, 0), cag_vec3(30, 0, 0), &p);
  assert_near(p.x, 21, 1e-9, "point");
  assert_near(bend.mean, -(1 / 6.0 + 1 / 21.0) / 2, 1e-9, "mean");
  assert_near(bend.gaussian, 1 / 126.0, 1e-9, "Gaussian");
  cag_solid_release(large);
  cag_solid_release(hollow);
  cag_solid_release(box);
  cag_solid_release(ring);
  cag_region_release(disk);
  cag_curve_release(circle);
}

// The saddle z = xy has the principal curvatures 1 and -1 in the middle, on either side.
static void a_surface_has_the_sign_of_its_normal(void **state) {
  (void)state;
  CagSurface *saddle, *bowl;
  CagBend bend;
  bool known;
  MUST(cag_surface_bilinear(cag_vec3(-1, -1, 1), cag_vec3(-1, 1, -1), cag_vec3(1, -1, -1),
                            cag_vec3(1, 1, 1), &saddle, err));
  MUST(cag_surface_bend(saddle, 0.5, 0.5, cag_vec3(0, 0, 1), &bend, &known, err));
  assert_true(known);
  assert_near(bend.mean, 0, 1e-12, "mean");
  assert_near(bend.gaussian, -1, 1e-12, "Gaussian");
  MUST(cag_surface_torus(5, 2, &bowl, err));
  MUST(cag_surface_bend(bowl, 0, 0, cag_vec3(-1, 0, 0), &bend, &known, err));
  assert_near(bend.mean, -(1 / 2.0 + 1 / 7.0) / 2, 1e-12, "mean from inside");
  assert_near(bend.gaussian, 1 / 14.0, 1e-12, "Gaussian from inside");
  cag_surface_release(saddle);
  cag_surface_release(bowl);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_ellipsoid_has_its_curvatures),
      cmocka_unit_test(a_cone_has_the_curvature_of_its_circles),
      cmocka_unit_test(a_torus_has_the_curvatures_of_its_circles),
      cmocka_unit_test(operands_have_their_own_curvatures),
      cmocka_unit_test(a_surface_has_the_sign_of_its_normal),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
