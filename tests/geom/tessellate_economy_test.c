// The number of triangles: compared with the minimum from closed forms, and independent of the
// parametrization of a surface.

#include "geom/tessellate/tessellate.h"
#include "tests/geom/net_support.h"
#include "tests/geom/random.h"

static double triangles_of(const CagSurface *s, const CagTessellation *how) {
  CagMesh *m;
  OK(cag_surface_tessellate(s, how, &m, &err));
  const double n = (double)m->triangle_count;
  cag_mesh_release(m);
  return n;
}

// z = (a x^2 + 2 c x y + b y^2) / 2 over [0, width] x [0, height].
static Net parabolic(double width, double height, double a, double b, double c) {
  Net net = {.n = {3, 3}};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      const double z = (i == 2) * a * width * width / 2 + (k == 2) * b * height * height / 2 +
                       c * width * height * i * k / 4.0;
      net.p[i][k] = cag_vec3(width * i / 2.0, height * k / 2.0, z);
    }
  return net;
}

// The deviation of triangles on lines of slopes u, v over a parabolic surface is a quadratic form
// of their edges divided by 8. Right triangles with the legs h, k along x and y need a h^2 + b k^2
// <= 8 tolerance if a and b have the same sign, and at least max(|a| h^2, |b| k^2) <= 8 tolerance
// otherwise.
static void parabolic_surfaces_take_little_more_than_the_fewest(void **state) {
  (void)state;
  double sum[2] = {0, 0};
  seed = 31;
  for (int k = 0; k < 60; k++) {
    const double width = uniform(3, 12);
    const double height = uniform(3, 12);
    const double a = uniform(0.004, 0.02);
    const double b = uniform(0.004, 0.02) * (k % 3 == 1 ? -1 : 1);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    const double area = width * height, fewest = sqrt(a * fabs(b)) * area / 2;
    how.tolerance = fewest / uniform(300, 3000);
    how.angle = 1;
    const Net net = parabolic(width, height, a, b, 0);
    CagSurface *s = surface_of(&net, k % 8);
    const double ratio = triangles_of(s, &how) * how.tolerance / fewest;
    const int saddle = k % 3 == 1;
    assert_true(ratio >= (saddle ? 0.5 : 1) && ratio < 1.4);
    sum[saddle] += ratio;
    cag_surface_release(s);
  }
  assert_true(sum[0] / 40 < 1.235 && sum[1] / 20 < 0.765); // on average
}

static Net random_net(int k) {
  Net net = {.n = {(size_t)(2 + k % 3), (size_t)(2 + k / 3 % 3)}};
  for (size_t i = 0; i < net.n[0]; i++)
    for (size_t j = 0; j < net.n[1]; j++) {
      const double x = uniform(-1, 1);
      const double y = uniform(-1, 1);
      const double z = uniform(-1, 1);
      const double share[2] = {(double)i / (double)(net.n[0] - 1),
                               (double)j / (double)(net.n[1] - 1)};
      net.p[i][j] = cag_vec3(10 * share[0] + x, 6 * share[1] + y, 2 * z);
    }
  return net;
}

// The same net with its rows and columns exchanged or reversed. Without significant curvature, only
// the maximum edge length matters, so the counts are exactly equal. The upper bounds are slightly
// above the counts needed for each tolerance.
static void triangles_do_not_depend_on_how_parameters_run(void **state) {
  (void)state;
  enum { NETS = 18, TURNS = 8 };
  static const double most[3] = {0.55, 0.75, 0}, together[3] = {507000, 351000, 870000};
  double sum[3] = {0};
  seed = 32;
  for (int k = 0; k < NETS; k++) {
    const Net net = random_net(k);
    for (int i = 0; i < 3; i++) {
      CagTessellation how = CAG_TESSELLATION_DEFAULT;
      double n[TURNS];
      how.tolerance = i == 0 ? 0.002 : 0.3;
      how.angle = i == 1 ? 0.08 : 1.5;
      how.max_edge = i == 2 ? 0.4 : 0;
      for (int turn = 0; turn < TURNS; turn++) {
        CagSurface *s = surface_of(&net, turn);
        n[turn] = triangles_of(s, &how);
        sum[i] += n[turn];
        assert_true(fabs(n[turn] / n[0] - 1) <= most[i]);
        cag_surface_release(s);
      }
    }
  }
  for (int i = 0; i < 3; i++) assert_true(sum[i] <= together[i]);
}

// A cap whose rows meet at a pole, at either end of either parameter.
static void poles_are_alike_at_all_ends(void **state) {
  (void)state;
  enum { NETS = 30, TURNS = 8 };
  seed = 34;
  for (int k = 0; k < NETS; k++) {
    Net net = {.n = {3, 4}};
    const double wide = uniform(0.3, 1.5);
    const double high = uniform(0.5, 3);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    double n[TURNS];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 4; j++) {
        const double angle = (j - 1.5) * wide, radius = (i + uniform(0, 0.3)) * (i > 0) * 5;
        net.p[i][j] = cag_vec3(radius * cos(angle), radius * sin(angle), -high * i * i);
      }
    how.tolerance = exp(uniform(-7, -4));
    how.angle = 1.5;
    for (int turn = 0; turn < TURNS; turn++) {
      CagSurface *s = surface_of(&net, turn);
      n[turn] = triangles_of(s, &how);
      assert_true(fabs(n[turn] / n[turn & 1] - 1) <= 0.01);
      assert_true(fabs(n[turn] / n[0] - 1) <= 0.06);
      cag_surface_release(s);
    }
  }
}

// The normals of a cone rotate by the same angle at its tip as elsewhere, so all its triangles
// reach the tip.
static void cones_have_one_row_of_triangles(void **state) {
  (void)state;
  seed = 35;
  for (int k = 0; k < 32; k++) {
    Net net = {.n = {2, 4}};
    const double wide = uniform(0.3, 1);
    const double high = uniform(1, 3);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    for (int j = 0; j < 4; j++) {
      const double angle = (j - 1.5) * wide;
      net.p[0][j] = cag_vec3(0, 0, 0);
      net.p[1][j] = cag_vec3(5 * cos(angle), 5 * sin(angle), -high);
    }
    how.tolerance = exp(uniform(-6, -4));
    how.angle = 0.05;
    CagSurface *s = surface_of(&net, k % 8);
    // From the first side of the net to the last, tangents rotate by twice the angle.
    assert_true(triangles_of(s, &how) <= 1.15 * 2 * wide / how.angle + 2);
    cag_surface_release(s);
  }
}

// A limit equal to the number of triangles is accepted, and one less is not.
static void limits_of_triangles_are_exact(void **state) {
  (void)state;
  seed = 33;
  for (int k = 0; k < 18; k++) {
    const Net net = random_net(k);
    CagSurface *s = surface_of(&net, k % 8);
    CagTessellation how = CAG_TESSELLATION_DEFAULT;
    CagMesh *m;
    how.tolerance = k % 2 ? 0.5 : 0.02;
    how.angle = 1.5;
    const double n = triangles_of(s, &how);
    how.max_triangles = (size_t)n;
    assert_true(triangles_of(s, &how) == n);
    how.max_triangles--;
    FAILS(cag_surface_tessellate(s, &how, &m, &err), "triangle-limit");
    cag_surface_release(s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(parabolic_surfaces_take_little_more_than_the_fewest),
      cmocka_unit_test(triangles_do_not_depend_on_how_parameters_run),
      cmocka_unit_test(limits_of_triangles_are_exact),
      cmocka_unit_test(poles_are_alike_at_all_ends),
      cmocka_unit_test(cones_have_one_row_of_triangles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
