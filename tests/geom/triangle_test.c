// Triangular nets: golden vectors of the reference; elevation and subdivision do not change the
// surface.

#include "geom/surface/triangle.h"
#include "tests/geom/support.h"

static const CagVec3 quadratic[] = {{2, 0, 0}, {1, 1, 1}, {1, 0, 1},
                                    {0, 2, 0}, {0, 1, 2}, {0, 0, 0}};
static const CagVec3 cubic[] = {{3, 0, 0}, {2, 1, 1}, {2, 0, 1}, {1, 2, 1}, {1, 1, 3},
                                {1, 0, 1}, {0, 3, 0}, {0, 2, 1}, {0, 1, 1}, {0, 0, 0}};

static void points_and_derivatives_of_the_reference(void **state) {
  (void)state;
  CagTriangleJet j;
  OK(cag_triangle_at(quadratic, 2, (double[]){0.5, 0.25, 0.25}, &j, &err));
  near_vec(j.point, cag_vec3(1, 0.5, 0.75), 1e-15);
  near_vec(j.ds, cag_vec3(2, 0, -1), 1e-15);
  near_vec(j.dt, cag_vec3(0, 2, 0), 1e-15);
  OK(cag_triangle_at(quadratic, 2, (double[]){0, 1, 0}, &j, &err));
  near_vec(j.point, cag_vec3(0, 2, 0), 0);
  near_vec(j.dt, cag_vec3(0, 2, -4), 0);
  OK(cag_triangle_at(cubic, 3, (double[]){0.2, 0.3, 0.5}, &j, &err));
  near_vec(j.point, cag_vec3(0.6, 0.9, 1.2), 1e-14);
  near_vec(j.ds, cag_vec3(3, 0, 1.71), 1e-14);
  near_vec(j.dt, cag_vec3(0, 3, 0.96), 1e-14);
}

static void a_raised_net_is_that_of_the_reference(void **state) {
  (void)state;
  CagVec3 out[10];
  cag_triangle_elevate(quadratic, 2, out);
  near_vec(out[0], cag_vec3(2, 0, 0), 1e-15);
  near_vec(out[1], cag_vec3(4 / 3.0, 2 / 3.0, 2 / 3.0), 1e-15);
  near_vec(out[4], cag_vec3(2 / 3.0, 2 / 3.0, 4 / 3.0), 1e-15);
  near_vec(out[7], cag_vec3(0, 4 / 3.0, 4 / 3.0), 1e-15);
  near_vec(out[9], cag_vec3(0, 0, 0), 0);
}

// The point at W of a part is the point of the whole at the combination of the part's corners by W.
static void parts_lie_on_the_whole(void **state) {
  (void)state;
  const double cut[3] = {0.5, 0.2, 0.3}, w[3] = {0.3, 0.6, 0.1};
  CagVec3 parts[3][10];
  OK(cag_triangle_split(cubic, 3, cut, (CagVec3 *const[]){parts[0], parts[1], parts[2]}, &err));
  for (int c = 0; c < 3; c++) {
    double whole[3];
    for (int k = 0; k < 3; k++) whole[k] = (k == c ? 0 : w[k]) + w[c] * cut[k];
    CagTriangleJet a, b;
    OK(cag_triangle_at(parts[c], 3, w, &a, &err));
    OK(cag_triangle_at(cubic, 3, whole, &b, &err));
    near_vec(a.point, b.point, 1e-14);
  }
}

static void a_single_point_is_a_net(void **state) {
  (void)state;
  const CagVec3 p = {1, 2, 3};
  CagVec3 raised[3];
  CagTriangleJet j;
  OK(cag_triangle_at(&p, 0, (double[]){0.2, 0.3, 0.5}, &j, &err));
  near_vec(j.point, p, 0);
  near_vec(j.ds, cag_vec3(0, 0, 0), 0);
  cag_triangle_elevate(&p, 0, raised);
  for (int i = 0; i < 3; i++) near_vec(raised[i], p, 0);
}

static void coordinates_outside_are_told(void **state) {
  (void)state;
  CagTriangleJet j;
  FAILS(cag_triangle_at(cubic, 3, (double[]){0.5, 0.5, 0.5}, &j, &err), "parameter-range");
  FAILS_AT(cag_triangle_at(cubic, 3, (double[]){1.2, -0.1, -0.1}, &j, &err), "parameter-range", 1);
  FAILS_AT(cag_triangle_at(cubic, 3, (double[]){NAN, 0.5, 0.5}, &j, &err), "parameter-range", 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_and_derivatives_of_the_reference),
      cmocka_unit_test(a_raised_net_is_that_of_the_reference),
      cmocka_unit_test(parts_lie_on_the_whole),
      cmocka_unit_test(a_single_point_is_a_net),
      cmocka_unit_test(coordinates_outside_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
