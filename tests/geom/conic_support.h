// Helpers for the tests of conics: frames and points of the plane, and random conics in any
// position.

#ifndef CAG_TESTS_GEOM_CONIC_SUPPORT_H
#define CAG_TESTS_GEOM_CONIC_SUPPORT_H

#include "geom/curve/conic.h"
#include "geom/curve/curve.h"
#include "random.h"
#include "support.h"

static inline CagTransform plane_frame(double x, double y, double angle) {
  CagTransform t = cag_translate(cag_vec3(x, y, 0));
  t.m[0][0] = t.m[1][1] = cos(angle);
  t.m[1][0] = sin(angle);
  t.m[0][1] = -sin(angle);
  t.planar = true;
  return t;
}

static inline CagVec3 at(const CagCurve *c, double t) {
  CagVec3 p;
  OK(cag_curve_point(c, t, &p, &err));
  return p;
}

// A conic by its standard form alpha u^2 + beta v^2 + delta u = kappa in rotated and translated
// axes u, v.
typedef struct Standard {
  double alpha, beta, delta, kappa, angle, factor;
  CagVec3 center;
} Standard;

static inline CagVec3 placed(const Standard *s, double u, double v) {
  const double c = cos(s->angle), n = sin(s->angle);
  return cag_vec3(s->center.x + u * c - v * n, s->center.y + u * n + v * c, 0);
}

// u = c (x - m) + n (y - k), v = c (y - k) - n (x - m), multiplied out.
static inline CagConic equation(const Standard *s) {
  const double c = cos(s->angle), n = sin(s->angle), m = s->center.x, k = s->center.y;
  const double a = s->alpha * c * c + s->beta * n * n, d = s->alpha * n * n + s->beta * c * c;
  const double b = 2 * c * n * (s->alpha - s->beta);
  const double p = s->delta * c, q = s->delta * n;
  CagConic out = {{a, b, d, p - 2 * a * m - b * k, q - 2 * d * k - b * m,
                   a * m * m + b * m * k + d * k * k - p * m - q * k - s->kappa}};
  for (int i = 0; i < 6; i++) out.c[i] *= s->factor;
  return out;
}

static inline Standard random_standard(double alpha, double beta, double delta, double kappa) {
  Standard s = {alpha, beta, delta, kappa, 0, 0, {0, 0, 0}};
  s.angle = uniform(-M_PI, M_PI);
  s.center.x = uniform(-3, 3);
  s.center.y = uniform(-3, 3);
  s.factor = uniform(-1, 1) < 0 ? -uniform(0.01, 100) : uniform(0.01, 100);
  return s;
}

// Checks that the coefficients are proportional to the expected ones.
static inline void same_conic(const CagConic *k, const CagConic *expected, double tolerance) {
  double dot = 0, one = 0, two = 0;
  for (int i = 0; i < 6; i++) {
    dot += k->c[i] * expected->c[i];
    one += k->c[i] * k->c[i];
    two += expected->c[i] * expected->c[i];
  }
  for (int i = 0; i < 6; i++)
    NEAR(k->c[i] / sqrt(one), (dot < 0 ? -1 : 1) * expected->c[i] / sqrt(two), tolerance);
}

#endif
