// Intersections of curves with surfaces, compared with exact counts for integer data, and with
// closed forms.

#include "tests/geom/meet_support.h"

#include "geom/solid/solid.h"

static CagVec3 whole_point(double size) {
  const double x = floor(uniform(-size, size + 1)), y = floor(uniform(-size, size + 1));
  return cag_vec3(x, y, floor(uniform(-size, size + 1)));
}

#define POLYLINE 6
#define NET 4

// Uneven knots of degree 1.
static void fill_knots(double *knots, size_t n) {
  knots[0] = knots[1] = 0;
  for (size_t i = 2; i <= n; i++) knots[i] = knots[i - 1] + pow(10, uniform(-2, 0));
  knots[n + 1] = knots[n];
}

// A polyline with very different weights.
static CagCurve *polyline(const CagVec3 *p) {
  double weights[POLYLINE], knots[POLYLINE + 2];
  for (size_t i = 0; i < POLYLINE; i++) weights[i] = pow(10, uniform(-1, 1));
  fill_knots(knots, POLYLINE);
  CagCurve *c;
  OK(cag_curve_nurbs(p, weights, POLYLINE, 1, knots, 3, &c, &err));
  return c;
}

// A net of degree 1.
static CagSurface *net(CagVec3 p[NET][NET]) {
  double knots_u[NET + 2], knots_v[NET + 2];
  fill_knots(knots_u, NET);
  fill_knots(knots_v, NET);
  CagSurface *s;
  OK(cag_surface_nurbs(&p[0][0], NULL, NET, NET, 1, 1, knots_u, knots_v, &s, &err));
  return s;
}

static double volume(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d) {
  return cag_dot(cag_sub(b, a), cag_cross(cag_sub(c, a), cag_sub(d, a)));
}

// How often a segment crosses the parallelogram at o; -1 if rounding decides.
static int passes(CagVec3 a, CagVec3 b, CagVec3 o, CagVec3 e, CagVec3 f) {
  const CagVec3 corner[4] = {o, cag_add(o, e), cag_add(o, cag_add(e, f)), cag_add(o, f)};
  const double h = volume(o, corner[1], corner[3], a), k = volume(o, corner[1], corner[3], b);
  if (h == 0 || k == 0) return -1;
  if ((h < 0) == (k < 0)) return 0;
  int left = 0;
  for (int i = 0; i < 4; i++) {
    const double side = volume(a, b, corner[i], corner[(i + 1) % 4]);
    if (side == 0) return -1;
    left += side < 0;
  }
  return left == 0 || left == 4;
}

// Counts the crossings of both, and releases them.
static size_t crossings(CagSurface *s, CagCurve *c) {
  const size_t n = meetings(s, c, 1e-6, 1);
  cag_surface_release(s);
  cag_curve_release(c);
  return n;
}

static void polylines_pass_a_flat_patch_as_segments_do(void **state) {
  (void)state;
  seed = 1;
  for (int round = 0; round < 300; round++) {
    CagVec3 p[POLYLINE];
    const CagVec3 o = whole_point(9), e = whole_point(9), f = whole_point(9);
    if (cag_norm(cag_cross(e, f)) == 0) continue;
    for (int i = 0; i < POLYLINE; i++) p[i] = whole_point(12);
    int wanted = 0;
    for (int i = 0; i + 1 < POLYLINE && wanted >= 0; i++) {
      const int k = passes(p[i], p[i + 1], o, e, f);
      wanted = k < 0 ? -1 : wanted + k;
    }
    if (wanted < 0) continue;
    // The parallelogram as one rational piece. The weights only change its parametrization.
    const double w = pow(10, uniform(-1, 1)), x = pow(10, uniform(-1, 1));
    const CagVec3 corners[4] = {o, cag_add(o, f), cag_add(o, e), cag_add(o, cag_add(e, f))};
    const double weights[4] = {1, w, x, w * x}, knots[4] = {0, 0, 1, 1};
    CagSurface *s;
    OK(cag_surface_nurbs(corners, weights, 2, 2, 1, 1, knots, knots, &s, &err));
    assert_int_equal(crossings(s, polyline(p)), wanted);
  }
}

// A net with planar cells: the heights over an integer grid are f(x) + g(y).
static void polylines_pass_a_folded_net_as_segments_do(void **state) {
  (void)state;
  seed = 2;
  for (int round = 0; round < 200; round++) {
    CagVec3 p[POLYLINE], q[NET][NET];
    double f[NET], g[NET];
    for (int i = 0; i < NET; i++) f[i] = floor(uniform(-4, 5)), g[i] = floor(uniform(-4, 5));
    for (int i = 0; i < NET; i++)
      for (int j = 0; j < NET; j++) q[i][j] = cag_vec3(5 * i - 7, 5 * j - 8, f[i] + g[j]);
    for (int i = 0; i < POLYLINE; i++) p[i] = whole_point(10);
    int wanted = 0;
    for (int k = 0; k + 1 < POLYLINE; k++)
      for (int i = 0; i + 1 < NET; i++)
        for (int j = 0; j + 1 < NET && wanted >= 0; j++) {
          const int n = passes(p[k], p[k + 1], q[i][j], cag_sub(q[i + 1][j], q[i][j]),
                               cag_sub(q[i][j + 1], q[i][j]));
          wanted = n < 0 ? -1 : wanted + n;
        }
    if (wanted < 0) continue;
    assert_int_equal(crossings(net(q), polyline(p)), wanted);
  }
}

// A line at distance d from the center of a ball of radius r meets it twice, once, or not at all.
static void lines_meet_a_ball_as_their_distance_tells(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 120; round++) {
    const double r = uniform(1, 5), d = round % 3 ? uniform(0, 2) * r : r;
    const CagVec3 center = cag_vec3(uniform(-5, 5), uniform(-5, 5), uniform(-5, 5)),
                  out = cag_unit(cag_vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))),
                  along = cag_unit(
                      cag_cross(out, cag_vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)))),
                  at = cag_madd(center, d, out);
    const CagTransform place = cag_translate(center);
    CagSolid *ball;
    CagSurface *s;
    CagCurve *line;
    OK(cag_solid_sphere(r, &ball, &err));
    OK(cag_surface_transform(ball->faces[0], &place, &s, &err));
    OK(cag_curve_line(cag_madd(at, -uniform(6, 20), along), cag_madd(at, uniform(6, 20), along), 3,
                      &line, &err));
    CagSurfaceMeeting *m;
    size_t n;
    OK(cag_surface_intersect_curve(s, line, &m, &n, &err));
    assert_int_equal(n, d < r ? 2 : d == r);
    for (size_t i = 0; i < n; i++) assert_int_equal(m[i].multiplicity, d == r ? 2 : 1);
    if (n == 1) near_vec(m[0].point, at, 1e-7);
    free(m);
    cag_solid_release(ball);
    cag_surface_release(s);
    cag_curve_release(line);
  }
}

// --- Curves and graphs ---

// A cubic with an inner knot over the rectangle; with `beside`, it may leave the rectangle.
static CagCurve *over(bool beside) {
  const double knots[] = {0, 0, 0, 0, 0.4, 1, 1, 1, 1};
  CagVec3 p[5];
  double weights[5];
  for (int i = 0; i < 5; i++) {
    const double x = beside ? uniform(-1, 4) : uniform(0.01, 2.99);
    const double y = beside ? uniform(-1, 3) : uniform(0.01, 1.99);
    p[i] = cag_vec3(x, y, uniform(-2, 2));
    weights[i] = uniform(0.6, 1.6);
  }
  CagCurve *c;
  OK(cag_curve_nurbs(p, weights, 5, 3, knots, 3, &c, &err));
  return c;
}

// The height of the curve above the graph, or NAN outside; *inside is the distance from the border.
static double height(const CagSurface *s, const CagCurve *c, double t, double *inside) {
  CagVec3 p, q;
  OK(cag_curve_point(c, t, &p, &err));
  *inside = fmin(fmin(p.x, 3 - p.x), fmin(p.y, 2 - p.y));
  if (*inside < 0) return NAN;
  OK(cag_surface_point(s, p.x, p.y, &q, &err));
  return p.z - q.z;
}

// Finds all sign changes of the height. Returns -1 if two of them, or one and the border of the
// rectangle, are too close to be distinguished.
static int sign_changes(const CagSurface *s, const CagCurve *c, double *out) {
  enum { STEPS = 1500 };
  double before = NAN, last = NAN, inside;
  int n = 0;
  for (int i = 0; i <= STEPS; i++) {
    const double now = height(s, c, (double)i / STEPS, &inside);
    if (fabs(inside) < 0.01 && (isnan(now) || fabs(now) < 0.1)) return -1;
    // A minimum between samples that does not reach zero.
    if (fabs(before) < 0.003 && fabs(before) <= fabs(now) && fabs(before) <= fabs(last) &&
        (before < 0) == (now < 0) && (before < 0) == (last < 0))
      return -1;
    if ((before < 0) != (now < 0) && !isnan(before) && !isnan(now)) {
      double a = (i - 1.0) / STEPS, b = (double)i / STEPS;
      for (int k = 0; k < 60; k++) {
        const double m = (a + b) / 2;
        if ((height(s, c, m, &inside) < 0) == (before < 0)) a = m;
        else b = m;
      }
      if (n > 0 && a - out[n - 1] < 0.01) return -1;
      out[n++] = a;
    }
    last = before;
    before = now;
  }
  return n;
}

static void curves_meet_graphs_where_their_height_is_zero(void **state) {
  (void)state;
  seed = 4;
  int told = 0, found = 0;
  CagTransform turn;
  OK(cag_rotate(cag_vec3(3, -1, 2), 1.1, cag_vec3(-4, 2, 1), &turn, &err));
  for (int round = 0; round < 150; round++) {
    CagSurface *s = graph(), *moved = NULL;
    CagCurve *c = over(round % 3 == 0), *with = NULL;
    double at[64];
    const int n = sign_changes(s, c, at);
    if (n >= 0) {
      // Unchanged, or both transformed, the surface by a transform wrapper.
      if (round % 2) {
        OK(cag_surface_transform(s, &turn, &moved, &err));
        OK(cag_curve_transform(c, &turn, &with, &err));
      }
      CagSurfaceMeeting *m;
      size_t count;
      OK(cag_surface_intersect_curve(moved ? moved : s, with ? with : c, &m, &count, &err));
      if (count != (size_t)n) fail_msg("round %d: %zu meetings, not %d", round, count, n);
      for (int i = 0; i < n; i++) {
        CagVec3 p;
        OK(cag_curve_point(c, at[i], &p, &err));
        NEAR(m[i].t, at[i], 1e-9);
        NEAR(m[i].u, p.x, 1e-8);
        NEAR(m[i].v, p.y, 1e-8);
        assert_int_equal(m[i].multiplicity, 1);
        near_vec(m[i].point, moved ? cag_transform_point(&turn, p) : p, 1e-8);
      }
      free(m);
      told++;
      found += n;
    }
    cag_surface_release(s);
    cag_curve_release(c);
    cag_surface_release(moved);
    cag_curve_release(with);
  }
  assert_true(told > 75 && found > 75);
}

// A parabola above a saddle, z = x y. Raised by the smallest height, it touches the saddle once,
// with order 2. A cubic x^3 crosses the plane z = 0 with order 3.
static void the_order_of_contact_is_told(void **state) {
  (void)state;
  seed = 5;
  const CagVec3 corner[4] = {{-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, 1}};
  CagSurface *saddle;
  OK(cag_surface_bezier(corner, NULL, 2, 2, &saddle, &err));
  for (int round = 0; round < 60; round++) {
    // Along the direction (a, b) through (p, q), the height above the saddle is z0 + k s^2 - (p + a
    // s) (q + b s). It has a double root at s = (p b + q a) / (2 (k - a b)).
    const double p = uniform(-0.3, 0.3), q = uniform(-0.3, 0.3), a = uniform(-0.6, 0.6),
                 b = uniform(-0.6, 0.6), bend = uniform(0.6, 1.5) * (round % 2 ? 1 : -1);
    const double k = bend + a * b, half = (p * b + q * a) / 2, at = half / bend;
    if (fabs(at) > 0.9) continue;
    for (int lift = -1; lift <= 1; lift++) {
      const double z = p * q + half * half / bend - lift * 0.01 * bend;
      // The parabola as a Bezier curve over s = -1 .. 1.
      const CagVec3 net[] = {{p - a, q - b, z + k}, {p, q, z - k}, {p + a, q + b, z + k}};
      CagCurve *c;
      CagSurfaceMeeting *m;
      size_t n;
      OK(cag_curve_bezier(net, NULL, 3, 3, &c, &err));
      OK(cag_surface_intersect_curve(saddle, c, &m, &n, &err));
      const double off = 0.1; // sqrt(0.01), from the height bend (s - at)^2 - lift 0.01 bend
      const int wanted = lift < 0 ? 0 : lift == 0 ? 1 : (fabs(at - off) < 1) + (fabs(at + off) < 1);
      assert_int_equal(n, wanted);
      for (size_t i = 0; i < n; i++) {
        const double s = 2 * m[i].t - 1;
        assert_int_equal(m[i].multiplicity, lift == 0 ? 2 : 1);
        NEAR(lift == 0 ? s : fabs(s - at), lift == 0 ? at : off, lift == 0 ? 1e-6 : 1e-9);
      }
      free(m);
      cag_curve_release(c);
    }
  }
  cag_surface_release(saddle);
  const CagVec3 flat[4] = {{-2, -2, 0}, {-2, 2, 0}, {2, -2, 0}, {2, 2, 0}};
  const CagVec3 cubic[4] = {{-1, 0.1, -1}, {-1.0 / 3, 0.1, 1}, {1.0 / 3, 0.1, -1}, {1, 0.1, 1}};
  CagSurface *plane;
  CagCurve *c;
  CagSurfaceMeeting *m;
  size_t n;
  OK(cag_surface_bezier(flat, NULL, 2, 2, &plane, &err));
  OK(cag_curve_bezier(cubic, NULL, 4, 3, &c, &err));
  OK(cag_surface_intersect_curve(plane, c, &m, &n, &err));
  assert_int_equal(n, 1);
  assert_int_equal(m[0].multiplicity, 3);
  NEAR(m[0].t, 0.5, 1e-4);
  free(m);
  cag_curve_release(c);
  cag_surface_release(plane);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(polylines_pass_a_flat_patch_as_segments_do),
      cmocka_unit_test(polylines_pass_a_folded_net_as_segments_do),
      cmocka_unit_test(lines_meet_a_ball_as_their_distance_tells),
      cmocka_unit_test(curves_meet_graphs_where_their_height_is_zero),
      cmocka_unit_test(the_order_of_contact_is_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
