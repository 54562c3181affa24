// Lines of curvature of ellipsoids: one of both confocal coordinates stays as it is (Dupin).

#include "tests/geom/random.h"
#include "tests/geom/support.h"

#include "geom/solid/solid.h"
#include "geom/surface/curvature_line.h"

// Squares of the semi-axes, descending, and the moved ellipsoid.
typedef struct Ellipsoid {
  double a[3];
  CagTransform back;
  CagSurface *s;
} Ellipsoid;

static Ellipsoid ellipsoid(double a, double b, double c, int order) {
  Ellipsoid e = {.a = {a * a, b * b, c * c}};
  CagTransform size = cag_transform_identity(), turn, move;
  CagSolid *ball;
  // The axis of the parameters is that of any of the three.
  memset(size.m, 0, sizeof size.m);
  size.planar = false;
  size.m[3][3] = 1;
  size.m[0][order % 3] = a;
  size.m[1][(order + 1) % 3] = b;
  size.m[2][(order + 2) % 3] = c;
  const double x = uniform(-1, 1), y = uniform(-1, 1), angle = uniform(0, 6);
  OK(cag_rotate(cag_vec3(x, y, 1), angle, cag_vec3(0.3, 0.1, 1), &turn, &err));
  OK(cag_transform_inverse(&turn, &e.back, &err));
  move = cag_transform_multiply(&turn, &size);
  OK(cag_solid_sphere(1, &ball, &err));
  OK(cag_surface_transform(ball->faces[0], &move, &e.s, &err));
  cag_solid_release(ball);
  return e;
}

// Both roots other than 0 of x^2 / (a - r) + y^2 / (b - r) + z^2 / (c - r) = 1, ascending; the
// roots are those of a cubic without constant.
static void confocal(const Ellipsoid *e, CagVec3 p, double out[2]) {
  const double *a = e->a, x = p.x * p.x, y = p.y * p.y, z = p.z * p.z;
  const double sum = a[0] + a[1] + a[2] - x - y - z;
  const double product = a[0] * a[1] + a[1] * a[2] + a[2] * a[0] - x * (a[1] + a[2]) -
                         y * (a[0] + a[2]) - z * (a[0] + a[1]);
  const double root = sqrt(fmax(0, sum * sum / 4 - product));
  out[0] = sum / 2 - root;
  out[1] = sum / 2 + root;
}

// The whole line on which one coordinate is `fixed`: four times that on which the other goes from
// one end to the other, as lo + (hi - lo) sin^2.
static double line_length(const Ellipsoid *e, double fixed, double lo, double hi) {
  enum { STEPS = 2000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    const double t = (i + 0.5) / STEPS * M_PI / 2, m = lo + (hi - lo) * sin(t) * sin(t);
    // Of the three factors two vanish at the ends; these are (hi - lo) sin^2 and (hi - lo) cos^2.
    double rest = 1;
    for (int k = 0; k < 3; k++)
      if (e->a[k] != lo && e->a[k] != hi) rest *= fabs(e->a[k] - m);
    sum += sqrt(m * fabs(m - fixed) / rest) * M_PI / 2 / STEPS;
  }
  return 4 * sum;
}

static void lines_on_ellipsoids_are_confocal(void **state) {
  (void)state;
  seed = 98;
  int told = 0;
  for (int round = 0; round < 18; round++) {
    const double c = uniform(1, 1.5), b = c * uniform(1.3, 1.6), a = b * uniform(1.3, 1.6);
    const Ellipsoid e = ellipsoid(a, b, c, round / 2);
    const bool larger = round % 2;
    const CagSurface *s = e.s;
    const double u = s->u0 + (s->u1 - s->u0) * uniform(0.05, 0.95);
    const double v = s->v0 + (s->v1 - s->v0) * uniform(0.2, 0.8);
    CagCurve *curve;
    CagPrincipal at;
    bool found;
    double first[2], length;
    OK(cag_surface_principal(s, u, v, &found, &at, &err));
    assert_true(found);
    confocal(&e, cag_transform_point(&e.back, at.point), first);
    // Not near the umbilics, where both are the middle square.
    if (first[1] - first[0] < 0.3) {
      cag_surface_release(e.s);
      continue;
    }
    told++;
    // Along the direction of the line the other coordinate changes.
    double step[2];
    const CagVec3 beside = cag_madd(at.point, 1e-5, at.direction[larger]);
    confocal(&e, cag_transform_point(&e.back, beside), step);
    const int fixed = fabs(step[0] - first[0]) > fabs(step[1] - first[1]);
    OK(cag_surface_curvature_line(s, u, v, larger, &curve, &err));
    assert_true(curve->closed);
    double nearest;
    for (int i = 0; i <= 80; i++) {
      CagVec3 p, q;
      double now[2];
      OK(cag_curve_point(curve, curve->start + (curve->end - curve->start) * i / 80, &p, &err));
      q = cag_transform_point(&e.back, p);
      NEAR(q.x * q.x / e.a[0] + q.y * q.y / e.a[1] + q.z * q.z / e.a[2], 1, 1e-5);
      confocal(&e, q, now);
      NEAR(now[fixed], first[fixed], 2e-4);
    }
    double t;
    CagVec3 foot;
    OK(cag_curve_closest(curve, at.point, &t, &foot, &nearest, &err));
    NEAR(nearest, 0, 1e-8);
    OK(cag_curve_length(curve, curve->start, curve->end, &length, &err));
    const double lo = fixed ? e.a[2] : e.a[1], hi = fixed ? e.a[1] : e.a[0];
    NEAR(length, line_length(&e, first[fixed], lo, hi), 2e-4 * length);
    cag_curve_release(curve);
    cag_surface_release(e.s);
  }
  assert_true(told > 9);
}

// Of a spheroid they are circles and whole meridians, which pass its poles.
static void lines_on_spheroids_are_circles_and_meridians(void **state) {
  (void)state;
  seed = 99;
  for (int round = 0; round < 8; round++) {
    const double wide = uniform(1, 2), high = wide * (round % 4 < 2 ? 0.6 : 1.7);
    const Ellipsoid e = ellipsoid(wide, wide, high, 0);
    const double u = uniform(0.5, 5), v = e.s->v0 + (e.s->v1 - e.s->v0) * uniform(0.2, 0.8);
    const bool larger = round % 2;
    CagCurve *curve;
    CagVec3 start;
    OK(cag_surface_point(e.s, u, v, &start, &err));
    start = cag_transform_point(&e.back, start);
    OK(cag_surface_curvature_line(e.s, u, v, larger, &curve, &err));
    assert_true(curve->closed);
    const double angle = atan2(start.y, start.x), radius = hypot(start.x, start.y);
    double level = 0, upright = 0, length, wanted = 0, least = INFINITY, most = -INFINITY;
    for (int i = 0; i <= 60; i++) {
      CagVec3 p;
      OK(cag_curve_point(curve, curve->start + (curve->end - curve->start) * i / 60, &p, &err));
      p = cag_transform_point(&e.back, p);
      level = fmax(level, fabs(p.z - start.z));
      upright = fmax(upright, fabs(p.x * sin(angle) - p.y * cos(angle)));
      least = fmin(least, p.z);
      most = fmax(most, p.z);
    }
    const bool circle = level < 1e-5;
    assert_true(circle || upright < 1e-5);
    // The length of the ellipse by the trapezoidal rule, which is exact for periods.
    for (int i = 0; i < 400; i++) {
      const double t = 2 * M_PI * i / 400;
      wanted += hypot(wide * sin(t), high * cos(t)) * 2 * M_PI / 400;
    }
    if (circle) wanted = 2 * M_PI * radius;
    else assert_true(most > 0.9 * high && least < -0.9 * high);
    OK(cag_curve_length(curve, curve->start, curve->end, &length, &err));
    NEAR(length, wanted, 1e-4 * wanted);
    // The other kind is another line.
    cag_curve_release(curve);
    OK(cag_surface_curvature_line(e.s, u, v, !larger, &curve, &err));
    double other;
    OK(cag_curve_length(curve, curve->start, curve->end, &other, &err));
    assert_true(fabs(other - length) > 1e-3 || fabs(radius - wide) < 1e-3);
    cag_curve_release(curve);
    cag_surface_release(e.s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_on_ellipsoids_are_confocal),
      cmocka_unit_test(lines_on_spheroids_are_circles_and_meridians),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
