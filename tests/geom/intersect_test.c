// Intersections of Bezier curves, all of them.

#include "tests/geom/support.h"

#include "geom/curve/intersect.h"

static double binomial(int n, int k) {
  double b = 1;
  for (int i = 1; i <= k; i++) b *= (double)(n - k + i) / i;
  return b;
}

// The graph of the Chebyshev polynomial T_n over [-1, 1], whose Bernstein coefficients are
// (-1)^(n - i) C(2n, 2i) / C(n, i); turned: x and y exchanged.
static CagCurve *chebyshev(int n, bool turned) {
  CagVec3 p[16];
  CagCurve *c;
  for (int i = 0; i <= n; i++) {
    const double x = -1 + 2.0 * i / n,
                 y = ((n - i) % 2 ? -1 : 1) * binomial(2 * n, 2 * i) / binomial(n, i);
    p[i] = turned ? cag_vec3(y, x, 0) : cag_vec3(x, y, 0);
  }
  OK(cag_curve_bezier(p, NULL, (size_t)n + 1, 2, &c, &err));
  return c;
}

static void chebyshev_graphs_meet_their_mirror_images_n_squared_times(void **state) {
  (void)state;
  // x = cos a, T_n(x) = cos na = y, T_n(y) = cos nna = x: nn a = +-a + 2 pi k.
  for (int n = 2; n <= 7; n++) {
    CagCurve *a = chebyshev(n, false), *b = chebyshev(n, true);
    CagMeeting *m;
    size_t count;
    OK(cag_curve_intersect(a, b, &m, &count, &err));
    assert_int_equal(count, n * n);
    for (size_t i = 0; i < count; i++) {
      const double angle = acos(fmin(1, fmax(-1, m[i].point.x)));
      NEAR(m[i].point.y, cos(n * angle), 1e-7);
      NEAR(cos(n * n * angle), m[i].point.x, 1e-6);
    }
    free(m);
    cag_curve_release(a);
    cag_curve_release(b);
  }
}

static void a_line_meets_a_chebyshev_graph_n_times_or_touches_it(void **state) {
  (void)state;
  const int n = 9;
  CagCurve *c = chebyshev(n, false), *line;
  CagMeeting *m;
  size_t count;
  OK(cag_curve_line(cag_vec3(-2, 0, 0), cag_vec3(2, 0, 0), 2, &line, &err));
  OK(cag_curve_intersect(line, c, &m, &count, &err));
  assert_int_equal(count, n);
  for (int i = 0; i < n; i++) NEAR(m[i].point.x, -cos((2 * i + 1) * M_PI / (2 * n)), 1e-12);
  free(m);
  cag_curve_release(line);
  // y = 1 touches the tops between, and meets the end.
  OK(cag_curve_line(cag_vec3(-2, 1, 0), cag_vec3(2, 1, 0), 2, &line, &err));
  OK(cag_curve_intersect(line, c, &m, &count, &err));
  assert_int_equal(count, (n + 1) / 2);
  for (size_t i = 0; i < count; i++)
    NEAR(m[i].point.x, cos(2 * M_PI * (double)(count - 1 - i) / n), 1e-5);
  free(m);
  cag_curve_release(line);
  cag_curve_release(c);
}

static void rational_circles_meet_like_circles(void **state) {
  (void)state;
  CagTransform frame = cag_translate(cag_vec3(1, 0, 0));
  frame.planar = true;
  CagCurve *a, *b, *p, *q;
  CagMeeting *m;
  size_t count;
  OK(cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &b, &err));
  frame.m[0][3] = 0;
  OK(cag_curve_arc(1, 1, 0, 2 * M_PI, &frame, &a, &err));
  OK(cag_curve_to_nurbs(a, &p, &err));
  OK(cag_curve_to_nurbs(b, &q, &err));
  OK(cag_curve_intersect(p, q, &m, &count, &err));
  assert_int_equal(count, 2);
  near_vec(m[0].point, cag_vec3(0.5, sqrt(0.75), 0), 1e-14);
  near_vec(m[1].point, cag_vec3(0.5, -sqrt(0.75), 0), 1e-14);
  free(m);
  FAILS(cag_curve_intersect(p, p, &m, &count, &err), "overlap");
  cag_curve_release(a);
  cag_curve_release(b);
  cag_curve_release(p);
  cag_curve_release(q);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(chebyshev_graphs_meet_their_mirror_images_n_squared_times),
      cmocka_unit_test(a_line_meets_a_chebyshev_graph_n_times_or_touches_it),
      cmocka_unit_test(rational_circles_meet_like_circles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
