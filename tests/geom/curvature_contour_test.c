// Contour lines of curvature in the core: closed forms, jumps, poles, and empty results.

#include "geom/meet/curvature_contour.h"
#include "geom/surface/reshape.h"
#include "random.h"
#include "support.h"

static const double PI = 3.14159265358979323846;

static double length_of(const CagCurve *c) {
  double length;
  OK(cag_curve_length(c, c->start, c->end, &length, &err));
  return length;
}

static CagCurveList contours(const CagSurface *s, CagCurvature of, double level, bool *everywhere) {
  CagCurveList list = {0};
  OK(cag_surface_curvature_contour(s, of, level, 0, &list, everywhere, &err));
  return list;
}

// K = cos t / (r d), d = R + r cos t: d = R / (1 - r^2 K).
static void contours_of_a_torus_are_its_parallels(void **state) {
  (void)state;
  CagSurface *torus;
  OK(cag_surface_torus(5, 2, &torus, &err));
  for (int i = -6; i <= 2; i++) {
    double k = 0.025 * i;
    bool everywhere;
    CagCurveList list = contours(torus, CAG_CURVATURE_GAUSSIAN, k, &everywhere);
    assert_int_equal(list.count, 2);
    assert_false(everywhere);
    for (size_t j = 0; j < list.count; j++) {
      double a, b;
      CagTransform frame;
      assert_true(list.items[j]->closed);
      assert_true(cag_curve_arc_view(list.items[j], &a, &b, &frame));
      NEAR(length_of(list.items[j]), 2 * PI * 5 / (1 - 4 * k), 1e-10);
    }
    cag_curve_list_free(&list);
  }
  cag_surface_release(torus);
}

// If the curvature is constant, the contour is everywhere, and there are no curves. This does not
// depend on the parametrization.
static void constant_curvature_is_told(void **state) {
  (void)state;
  static const double level[] = {0.25, -0.5, -0.5, -0.5};
  CagSolid *ball;
  CagSurface *exact;
  OK(cag_solid_sphere(2, &ball, &err));
  OK(cag_surface_to_nurbs(ball->faces[0], &exact, &err));
  for (int of = 0; of < 4; of++)
    for (int form = 0; form < 2; form++) {
      const CagSurface *s = form ? exact : ball->faces[0];
      bool everywhere;
      CagCurveList list = contours(s, (CagCurvature)of, level[of], &everywhere);
      assert_int_equal(list.count, 0);
      assert_true(everywhere);
      list = contours(s, (CagCurvature)of, level[of] * 1.01, &everywhere);
      assert_int_equal(list.count, 0);
      assert_false(everywhere);
    }
  cag_surface_release(exact);
  cag_solid_release(ball);
}

// The larger curvature of a cone is cot w / s at the distance s along its side, where w is its half
// angle. It is undefined at the tip.
static void contours_come_up_to_the_tip_of_a_cone(void **state) {
  (void)state;
  CagCurve *side;
  CagSurface *cone;
  OK(cag_curve_line(cag_vec3(3, 0, 0), cag_vec3(0, 0, 4), 3, &side, &err));
  OK(cag_surface_revolve(side, cag_vec3(0, 0, 1), cag_vec3(0, 0, 0), 0, 2 * PI, &cone, &err));
  for (double s = 4; s > 1e-2; s /= 3) {
    bool everywhere;
    CagCurveList up = contours(cone, CAG_CURVATURE_MAX, 4 / (3 * s), &everywhere);
    CagCurveList down = contours(cone, CAG_CURVATURE_MIN, -4 / (3 * s), &everywhere);
    assert_int_equal(up.count + down.count, 1);
    NEAR(length_of(up.count ? up.items[0] : down.items[0]), 2 * PI * 0.6 * s, 1e-7 * s);
    cag_curve_list_free(&up);
    cag_curve_list_free(&down);
  }
  cag_surface_release(cone);
  cag_curve_release(side);
}

// Sizes from a micrometer to kilometers, and far from the origin.
static void contours_do_not_depend_on_size_or_place(void **state) {
  (void)state;
  CagSurface *torus, *scaled, *moved;
  OK(cag_surface_torus(5, 2, &torus, &err));
  for (double size = 1e-6; size < 1e7; size *= 1e3) {
    CagTransform grow;
    OK(cag_scale(cag_vec3(size, size, size), cag_vec3(0, 0, 0), &grow, &err));
    CagTransform move = cag_translate(cag_vec3(100 * size, 0, 0));
    OK(cag_surface_transform(torus, &grow, &scaled, &err));
    OK(cag_surface_transform(scaled, &move, &moved, &err));
    bool everywhere;
    CagCurveList list = contours(moved, CAG_CURVATURE_GAUSSIAN, 0.05 / (size * size), &everywhere);
    assert_int_equal(list.count, 2);
    NEAR(length_of(list.items[0]) / size, 12.5 * PI, 1e-6);
    cag_curve_list_free(&list);
    cag_surface_release(scaled);
    cag_surface_release(moved);
  }
  cag_surface_release(torus);
}

// z = x^2 for x < 0 and 2 x^2 otherwise, of order 3 over two knot intervals. The larger curvature
// jumps from 2 to 4 at x = 0. As a function of x, it is 2 a / (1 + 4 a^2 x^2)^(3/2) on each side.
static void a_jump_over_the_level_has_no_curve(void **state) {
  (void)state;
  const double knots_u[] = {-1, -1, -1, 0, 1, 1, 1}, knots_v[] = {0, 0, 1, 1};
  // Blossoms: f(-1, -1), f(-1, 0), f(0, 1), f(1, 1).
  const double x[] = {-1, -0.5, 0.5, 1}, z[] = {1, 0, 0, 2};
  CagVec3 net[8];
  for (int i = 0; i < 8; i++) net[i] = cag_vec3(x[i / 2], i % 2, z[i / 2]);
  CagSurface *s;
  OK(cag_surface_nurbs(net, NULL, 4, 2, 2, 1, knots_u, knots_v, &s, &err));
  bool everywhere;
  CagCurveList list = contours(s, CAG_CURVATURE_MAX, 3, &everywhere);
  assert_int_equal(list.count, 1); // on one side only
  double at = sqrt((pow(4.0 / 3, 2.0 / 3) - 1) / 16);
  CagVec3 p;
  OK(cag_curve_point(list.items[0], list.items[0]->start, &p, &err));
  NEAR(p.x, at, 1e-9);
  NEAR(length_of(list.items[0]), 1, 1e-9);
  cag_curve_list_free(&list);
  list = contours(s, CAG_CURVATURE_MAX, 1, &everywhere);
  assert_int_equal(list.count, 2);
  cag_curve_list_free(&list);
  cag_surface_release(s);
}

// Curvatures of a graph by Monge's formulas.
static double curvature_of_graph(const CagSurface *s, CagCurvature of, double u, double v) {
  CagVec3 d[9];
  OK(cag_surface_eval(s, u, v, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
  const double p = d[cag_partial(2, 1, 0)].z, q = d[cag_partial(2, 0, 1)].z;
  const double r = d[cag_partial(2, 2, 0)].z, m = d[cag_partial(2, 1, 1)].z;
  const double t = d[cag_partial(2, 0, 2)].z, g = 1 + p * p + q * q;
  const double gauss = (r * t - m * m) / (g * g);
  const double mean = ((1 + q * q) * r - 2 * p * q * m + (1 + p * p) * t) / (2 * pow(g, 1.5));
  const double half = sqrt(fmax(0, mean * mean - gauss));
  return of == CAG_CURVATURE_GAUSSIAN ? gauss
         : of == CAG_CURVATURE_MEAN   ? mean
         : of == CAG_CURVATURE_MAX    ? mean + half
                                      : mean - half;
}

// Random graphs over the unit square with few pieces: the contours have as many points as the
// tolerance needs.
static void contours_of_graphs_keep_the_tolerance(void **state) {
  (void)state;
  enum { N = 5 };
  const double tolerance = 1e-5, h = 1e-4;
  seed = 17;
  size_t curves = 0, pieces = 0;
  for (int round = 0; round < 16; round++) {
    const CagCurvature of = (CagCurvature)(round % 4);
    CagVec3 net[N * N];
    for (int i = 0; i < N * N; i++)
      net[i] = cag_vec3(i / N / (N - 1.0), i % N / (N - 1.0), uniform(-0.3, 0.3));
    CagSurface *s;
    CagCurveList list = {0};
    bool everywhere;
    OK(cag_surface_bezier(net, NULL, N, N, &s, &err));
    const double level = curvature_of_graph(s, of, uniform(0.3, 0.7), 0.5);
    OK(cag_surface_curvature_contour(s, of, level, tolerance, &list, &everywhere, &err));
    assert_true(list.count > 0);
    for (size_t k = 0; k < list.count; k++) {
      const CagCurve *c = list.items[k];
      for (int i = 1; i < 200; i++) {
        CagVec3 p, on;
        OK(cag_curve_point(c, c->start + (c->end - c->start) * i / 200, &p, &err));
        OK(cag_surface_point(s, fmin(fmax(p.x, 0), 1), fmin(fmax(p.y, 0), 1), &on, &err));
        NEAR(p.z, on.z, 4 * tolerance);
        const double x = fmin(fmax(p.x, h), 1 - h), y = fmin(fmax(p.y, h), 1 - h);
        const double gx = curvature_of_graph(s, of, x + h, y) - curvature_of_graph(s, of, x - h, y);
        const double gy = curvature_of_graph(s, of, x, y + h) - curvature_of_graph(s, of, x, y - h);
        const double off = curvature_of_graph(s, of, x, y) - level;
        // Along the steepest direction; near a stationary point of the curvature, from its second
        // derivatives.
        if (hypot(gx, gy) > 2e-3)
          assert_true(fabs(off) <= 2 * tolerance * hypot(gx, gy) / (2 * h) + 1e-4);
      }
      CagNurbsView view;
      if (cag_curve_nurbs_view(c, &view)) pieces += view.count;
      curves++;
    }
    cag_curve_list_free(&list);
    cag_surface_release(s);
  }
  assert_true(curves > 30 && pieces < 5500);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contours_of_a_torus_are_its_parallels),
      cmocka_unit_test(constant_curvature_is_told),
      cmocka_unit_test(contours_come_up_to_the_tip_of_a_cone),
      cmocka_unit_test(contours_do_not_depend_on_size_or_place),
      cmocka_unit_test(contours_of_graphs_keep_the_tolerance),
      cmocka_unit_test(a_jump_over_the_level_has_no_curve),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
