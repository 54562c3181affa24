// Lines of curvature of ellipsoids: one of the two confocal coordinates is constant (Dupin).

#include "tests/geom/random_point.h"
#include "tests/geom/support.h"

#include "geom/meet/curvature_line.h"
#include "geom/solid/solid.h"

// The squares of the semi-axes in descending order, and the moved ellipsoid.
typedef struct Ellipsoid {
  double a[3];
  CagTransform back;
  CagSurface *s;
} Ellipsoid;

static Ellipsoid ellipsoid(double a, double b, double c, int order) {
  Ellipsoid e = {.a = {a * a, b * b, c * c}};
  CagTransform size = cag_transform_identity(), turn, move;
  CagSolid *ball;
  // The axis of the parametrization may be any of the three.
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

// The two nonzero roots of x^2 / (a - r) + y^2 / (b - r) + z^2 / (c - r) = 1, ascending. If p is on
// the ellipsoid, the constant term of the cubic vanishes.
static void confocal(const Ellipsoid *e, CagVec3 p, double out[2]) {
  const double *a = e->a, on = p.x * p.x / a[0] + p.y * p.y / a[1] + p.z * p.z / a[2];
  const double x = p.x * p.x / on, y = p.y * p.y / on, z = p.z * p.z / on;
  const double sum = a[0] + a[1] + a[2] - x - y - z;
  const double product = a[0] * a[1] + a[1] * a[2] + a[2] * a[0] - x * (a[1] + a[2]) -
                         y * (a[0] + a[2]) - z * (a[0] + a[1]);
  const double root = sqrt(fmax(0, sum * sum / 4 - product));
  out[0] = sum / 2 - root;
  out[1] = sum / 2 + root;
}

// The length of the whole line on which one coordinate is `fixed`: four times that of the part on
// which the other coordinate runs from one end to the other, as lo + (hi - lo) sin^2.
static double line_length(const Ellipsoid *e, double fixed, double lo, double hi) {
  enum { STEPS = 2000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    const double t = (i + 0.5) / STEPS * M_PI / 2, m = lo + (hi - lo) * sin(t) * sin(t);
    // Two of the three factors vanish at the ends; these are (hi - lo) sin^2 and (hi - lo) cos^2.
    double rest = 1;
    for (int k = 0; k < 3; k++)
      if (e->a[k] != lo && e->a[k] != hi) rest *= fabs(e->a[k] - m);
    sum += sqrt(m * fabs(m - fixed) / rest) * M_PI / 2 / STEPS;
  }
  return 4 * sum;
}

// Each semi-axis is longer than the previous one by a factor of 1 + more to 1 + 2 more.
static void check_ellipsoids(int rounds, double more) {
  int told = 0;
  for (int round = 0; round < rounds; round++) {
    const double c = uniform(1, 1.5), b = c * (1 + uniform(more, 2 * more)),
                 a = b * (1 + uniform(more, 2 * more)), spread = a * a - c * c;
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
    // Avoids umbilics, where both coordinates are the middle square.
    if (first[1] - first[0] < 0.1 * spread) {
      cag_surface_release(e.s);
      continue;
    }
    told++;
    // Along the direction of the line, the other coordinate changes.
    double step[2];
    const CagVec3 beside = cag_madd(at.point, 1e-3, at.direction[larger]);
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
      NEAR(now[fixed], first[fixed], 1e-7 * spread);
    }
    double t;
    CagVec3 foot;
    OK(cag_curve_closest(curve, at.point, &t, &foot, &nearest, &err));
    NEAR(nearest, 0, 1e-8);
    OK(cag_curve_length(curve, curve->start, curve->end, &length, &err));
    const double lo = fixed ? e.a[2] : e.a[1], hi = fixed ? e.a[1] : e.a[0];
    NEAR(length, line_length(&e, first[fixed], lo, hi), 1e-7 * length);
    cag_curve_release(curve);
    cag_surface_release(e.s);
  }
  assert_true(told > rounds / 2);
}

static void lines_on_ellipsoids_are_confocal(void **state) {
  (void)state;
  seed = 98;
  check_ellipsoids(18, 0.3);
}

// If both curvatures are almost equal, lines pass the poles of the parametrization in the same way.
static void lines_on_nearly_round_ellipsoids_are_confocal(void **state) {
  (void)state;
  seed = 101;
  check_ellipsoids(30, 2e-4);
}

// The lines of a spheroid are circles and whole meridians, which pass its poles.
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
    // The length of the ellipse from the trapezoidal rule, which converges fast for periodic
    // functions.
    for (int i = 0; i < 400; i++) {
      const double t = 2 * M_PI * i / 400;
      wanted += hypot(wide * sin(t), high * cos(t)) * 2 * M_PI / 400;
    }
    if (circle) wanted = 2 * M_PI * radius;
    else assert_true(most > 0.9 * high && least < -0.9 * high);
    OK(cag_curve_length(curve, curve->start, curve->end, &length, &err));
    NEAR(length, wanted, 1e-4 * wanted);
    // The other family has another line.
    cag_curve_release(curve);
    OK(cag_surface_curvature_line(e.s, u, v, !larger, &curve, &err));
    double other;
    OK(cag_curve_length(curve, curve->start, curve->end, &other, &err));
    assert_true(fabs(other - length) > 1e-3 || fabs(radius - wide) < 1e-3);
    cag_curve_release(curve);
    cag_surface_release(e.s);
  }
}

// A bowl with the profile r = wide t, z = deep t^2 + flare t^4, t in 0..1, about a random axis. Its
// vertex is a pole of the parametrization, at the start or the end of u or v.
typedef struct Bowl {
  double wide, deep, flare, turn;
  CagTransform map, back;
  CagSurface *s;
} Bowl;

// The same surface with u and v exchanged, as a NURBS surface.
static CagSurface *exchanged(const CagSurface *s) {
  enum { MOST = 200 };
  CagSurface *exact, *out;
  CagSurfaceNurbsView n;
  CagVec3 net[MOST];
  double weights[MOST];
  OK(cag_surface_to_nurbs(s, &exact, &err));
  assert_true(cag_surface_nurbs_view(exact, &n) && n.nu * n.nv <= MOST);
  for (size_t i = 0; i < n.nu; i++)
    for (size_t j = 0; j < n.nv; j++) {
      const double *h = n.homogeneous + 4 * (i * n.nv + j);
      weights[j * n.nu + i] = h[3];
      net[j * n.nu + i] = cag_scaled(cag_vec3(h[0], h[1], h[2]), 1 / h[3]);
    }
  OK(cag_surface_nurbs(net, weights, n.nv, n.nu, n.degree_v, n.degree_u, n.knots_v, n.knots_u, &out,
                       &err));
  cag_surface_release(exact);
  return out;
}

static void replace(CagSurface **s, CagSurface *by) {
  cag_surface_release(*s);
  *s = by;
}

static Bowl random_bowl(double turn, bool reversed, bool flipped, bool swapped) {
  Bowl b = {.turn = turn};
  b.wide = uniform(1, 2);
  b.deep = b.wide * uniform(0.8, 1.5);
  b.flare = b.wide * uniform(0.05, 0.4);
  CagTransform away;
  const CagVec3 axis = random_point(1), at = random_point(1);
  OK(cag_rotate(axis, uniform(1, 5), at, &away, &err));
  const CagTransform shift = cag_translate(random_point(1));
  b.map = cag_transform_multiply(&shift, &away);
  OK(cag_transform_inverse(&b.map, &b.back, &err));
  CagVec3 p[5];
  const double z[5] = {0, 0, b.deep / 6, b.deep / 2, b.deep + b.flare};
  for (int i = 0; i < 5; i++)
    p[reversed ? 4 - i : i] = cag_transform_point(&b.map, cag_vec3(b.wide * i / 4, 0, z[i]));
  CagCurve *profile;
  OK(cag_curve_bezier(p, NULL, 5, 3, &profile, &err));
  OK(cag_surface_revolve(profile, cag_transform_vector(&b.map, cag_vec3(0, 0, 1)),
                         cag_transform_point(&b.map, cag_vec3(0, 0, 0)), 0, turn, &b.s, &err));
  cag_curve_release(profile);
  if (swapped) replace(&b.s, exchanged(b.s));
  if (flipped) {
    CagSurface *other;
    OK(cag_surface_flip(b.s, &other, &err));
    replace(&b.s, other);
  }
  return b;
}

// From the vertex to the rim, by Simpson's rule.
static double profile_length(const Bowl *b) {
  enum { STEPS = 400 };
  double sum = 0;
  for (int i = 0; i <= STEPS; i++) {
    const double t = (double)i / STEPS;
    const double weight = i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2;
    sum += weight * hypot(b->wide, 2 * b->deep * t + 4 * b->flare * t * t * t);
  }
  return sum / (3 * STEPS);
}

// Meridians continue through the vertex of a bowl to the opposite rim. If the surface is not
// revolved far enough, they end at or just before the vertex, where the curvatures are equal up to
// rounding.
static void meridians_go_on_through_the_vertex(void **state) {
  (void)state;
  seed = 100;
  int whole = 0, half = 0;
  for (int round = 0; round < 32; round++) {
    const double turn = round / 8 % 4 == 3 ? 2 * M_PI : uniform(2, 5.5);
    const Bowl b = random_bowl(turn, round % 2, round / 2 % 2, round / 4 % 2);
    const CagSurface *s = b.s;
    const double u = s->u0 + (s->u1 - s->u0) * uniform(0.2, 0.8);
    const double v = s->v0 + (s->v1 - s->v0) * uniform(0.2, 0.8);
    CagPrincipal at;
    bool found;
    OK(cag_surface_principal(b.s, u, v, &found, &at, &err));
    assert_true(found);
    CagVec3 p = cag_transform_point(&b.back, at.point);
    const double angle = atan2(p.y, p.x) + (p.y < 0 ? 2 * M_PI : 0);
    const CagVec3 across = cag_transform_vector(&b.map, cag_vec3(-sin(angle), cos(angle), 0));
    const bool larger = fabs(cag_dot(at.direction[1], across)) < 0.5;
    CagCurve *c;
    OK(cag_surface_curvature_line(b.s, u, v, larger, &c, &err));
    assert_false(c->closed);
    // Few steps suffice, even if the line ends at the vertex.
    CagNurbsView steps;
    assert_true(cag_curve_nurbs_view(c, &steps));
    assert_true(steps.count < 4000);
    // The opposite angle is on the surface.
    const bool through = turn == 2 * M_PI || angle > M_PI || angle + M_PI < turn;
    const int sides = through ? 2 : 1;
    whole += through;
    half += !through;
    double length, outward = 0;
    OK(cag_curve_length(c, c->start, c->end, &length, &err));
    const double missed = through ? 1e-8 : 1e-3;
    NEAR(length, sides * profile_length(&b), missed * length);
    for (int i = 0; i <= 40; i++) {
      OK(cag_curve_point(c, c->start + (c->end - c->start) * i / 40, &p, &err));
      p = cag_transform_point(&b.back, p);
      const double along = p.x * cos(angle) + p.y * sin(angle), part = along / b.wide;
      NEAR(p.y * cos(angle), p.x * sin(angle), through ? 1e-8 : 1e-6);
      NEAR(p.z, b.deep * part * part + b.flare * part * part * part * part, 1e-6);
      outward = fmin(outward, part);
    }
    NEAR(outward, through ? -1 : 0, missed);
    cag_curve_release(c);
    cag_surface_release(b.s);
  }
  assert_true(whole > 10 && half > 5);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lines_on_ellipsoids_are_confocal),
      cmocka_unit_test(lines_on_nearly_round_ellipsoids_are_confocal),
      cmocka_unit_test(lines_on_spheroids_are_circles_and_meridians),
      cmocka_unit_test(meridians_go_on_through_the_vertex),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
