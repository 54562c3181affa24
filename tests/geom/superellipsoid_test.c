// Superellipsoids: the implicit equation, and partials against central differences of the partials
// of one order less.

#include <math.h>

#include "geom/surface/surface.h"
#include "random.h"
#include "support.h"

static CagSurface *made(double e, double n) {
  CagSurface *s;
  OK(cag_surface_superellipsoid(cag_vec3(2, 4, 6), e, n, &s, &err));
  return s;
}

static void points_satisfy_the_equation(void **state) {
  (void)state;
  for (int k = 0; k < 300; k++) {
    const double e = uniform(0.02, 2), n = uniform(0.02, 2);
    CagSurface *s = made(e, n);
    CagVec3 p;
    OK(cag_surface_point(s, uniform(s->u0, s->u1), uniform(s->v0, s->v1), &p, &err));
    const double flat = pow(pow(fabs(p.x), 2 / e) + pow(fabs(p.y / 2), 2 / e), e / n);
    NEAR(pow(flat + pow(fabs(p.z / 3), 2 / n), n / 2), 1, 1e-12);
    cag_surface_release(s);
  }
}

static void partials_are_those_of_differences(void **state) {
  (void)state;
  enum { ORDER = 4, ROW = ORDER + 1 };
  const double h = 1e-4;
  for (int k = 0; k < 200; k++) {
    CagSurface *s = made(uniform(0.4, 2), uniform(0.4, 2));
    // Away from the axes, where higher derivatives are large.
    const double u = M_PI / 2 * (k % 4) + uniform(0.3, 1.2),
                 v = (k % 8 < 4 ? 1 : -1) * uniform(0.3, 1.2);
    CagVec3 d[ROW * ROW], low[ROW * ROW], high[ROW * ROW];
    OK(cag_surface_eval(s, u, v, ORDER, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
    for (int way = 0; way < 2; way++) {
      const double du = way == 0 ? h : 0, dv = way == 1 ? h : 0;
      OK(cag_surface_eval(s, u - du, v - dv, ORDER, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, low, &err));
      OK(cag_surface_eval(s, u + du, v + dv, ORDER, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, high, &err));
      for (int i = 0; i < ORDER; i++)
        for (int j = 0; i + j < ORDER; j++) {
          const int at = cag_partial(ORDER, i, j);
          const CagVec3 slope = cag_scaled(cag_sub(high[at], low[at]), 1 / (2 * h));
          const CagVec3 exact = d[cag_partial(ORDER, i + (way == 0), j + (way == 1))];
          assert_true(cag_norm(cag_sub(slope, exact)) <= 1e-4 * (1 + cag_norm(exact)));
        }
    }
    cag_surface_release(s);
  }
}

// On the axes: a limit from each side, and the exact derivatives of even powers.
static void limits_on_axes_are_one_sided(void **state) {
  (void)state;
  CagSurface *s = made(2, 1);
  CagVec3 left[4], right[4];
  OK(cag_surface_eval(s, M_PI / 2, 0, 1, CAG_SIDE_LEFT, CAG_SIDE_RIGHT, left, &err));
  OK(cag_surface_eval(s, M_PI / 2, 0, 1, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, right, &err));
  // x = cos / (cos + sin) to the left of the y axis: slopes -1 of x and 1 of y; y is halved.
  near_vec(left[cag_partial(1, 1, 0)], cag_vec3(-1, 2, 0), 1e-12);
  near_vec(right[cag_partial(1, 1, 0)], cag_vec3(-1, -2, 0), 1e-12);
  cag_surface_release(s);
  s = made(0.5, 1);
  // (cos^4 + sin^4)^(-1/4) has the second derivative 1 at 0, and so x'' = 1 - 1 = 0.
  CagVec3 d[9];
  OK(cag_surface_eval(s, 0, 0, 2, CAG_SIDE_RIGHT, CAG_SIDE_RIGHT, d, &err));
  near_vec(d[cag_partial(2, 2, 0)], cag_vec3(0, 0, 0), 1e-12);
  cag_surface_release(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_satisfy_the_equation),
      cmocka_unit_test(partials_are_those_of_differences),
      cmocka_unit_test(limits_on_axes_are_one_sided),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
