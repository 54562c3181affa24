// Where curves and surfaces meet surfaces: random comparisons with counts by whole numbers, and
// closed forms.

#include "tests/geom/meet_support.h"
#include "tests/geom/random.h"

#include "geom/solid/solid.h"
#include "geom/surface/meet_surface.h"

static CagVec3 whole_point(double size) {
  const double x = floor(uniform(-size, size + 1)), y = floor(uniform(-size, size + 1));
  return cag_vec3(x, y, floor(uniform(-size, size + 1)));
}

#define POLYLINE 6
#define NET 4

// Knots of degree 1, uneven.
static void fill_knots(double *knots, size_t n) {
  knots[0] = knots[1] = 0;
  for (size_t i = 2; i <= n; i++) knots[i] = knots[i - 1] + pow(10, uniform(-2, 0));
  knots[n + 1] = knots[n];
}

// A polyline with weights far apart.
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

// Times a segment passes the parallelogram at o; -1 where that is a matter of rounding.
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
    // The parallelogram as one rational piece: weights only change how it is run through.
    const double w = pow(10, uniform(-1, 1)), x = pow(10, uniform(-1, 1));
    const CagVec3 corners[4] = {o, cag_add(o, f), cag_add(o, e), cag_add(o, cag_add(e, f))};
    const double weights[4] = {1, w, x, w * x}, knots[4] = {0, 0, 1, 1};
    CagSurface *s;
    OK(cag_surface_nurbs(corners, weights, 2, 2, 1, 1, knots, knots, &s, &err));
    assert_int_equal(crossings(s, polyline(p)), wanted);
  }
}

// Over a grid of whole numbers the heights of a net whose facets are flat: f(x) + g(y).
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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(polylines_pass_a_flat_patch_as_segments_do),
      cmocka_unit_test(polylines_pass_a_folded_net_as_segments_do),
      cmocka_unit_test(lines_meet_a_ball_as_their_distance_tells),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
