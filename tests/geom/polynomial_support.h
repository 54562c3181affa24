// Graphs of bivariate polynomials over the unit square, as surfaces.

#ifndef CAG_TESTS_GEOM_POLYNOMIAL_SUPPORT_H
#define CAG_TESTS_GEOM_POLYNOMIAL_SUPPORT_H

#include "geom/surface/surface.h"
#include "tests/geom/random.h"
#include "tests/geom/support.h"

enum { DEGREE = 4, SIDE = DEGREE + 1 };

// The coefficients of x^i y^j.
typedef struct Polynomial {
  double c[SIDE][SIDE];
} Polynomial;

static inline double choose(int n, int k) {
  double out = 1;
  for (int i = 1; i <= k; i++) out = out * (n - k + i) / i;
  return out;
}

static inline Polynomial sum(const Polynomial *a, const Polynomial *b, double factor) {
  Polynomial out;
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++) out.c[i][j] = a->c[i][j] + factor * b->c[i][j];
  return out;
}

// The product up to the degree; all terms used are within it.
static inline Polynomial product(const Polynomial *a, const Polynomial *b) {
  Polynomial out = {{{0}}};
  for (int i = 0; i < SIDE; i++)
    for (int j = 0; j < SIDE; j++)
      for (int k = 0; i + k < SIDE; k++)
        for (int l = 0; j + l < SIDE; l++) out.c[i + k][j + l] += a->c[i][j] * b->c[k][l];
  return out;
}

static inline double value(const Polynomial *p, double x, double y) {
  double out = 0;
  for (int i = DEGREE; i >= 0; i--) {
    double row = 0;
    for (int j = DEGREE; j >= 0; j--) row = row * y + p->c[i][j];
    out = out * x + row;
  }
  return out;
}

// The graph over the unit square, with u = x per[0] and v = y per[1]. The domains begin at 0, or
// below it if the factors are not 1. The graph is translated.
static inline CagSurface *graph(const Polynomial *p, const double per[2],
                                const CagTransform *move) {
  CagVec3 net[SIDE * SIDE];
  double knots[2][2 * SIDE];
  CagSurface *s, *moved;
  for (int k = 0; k < SIDE; k++)
    for (int l = 0; l < SIDE; l++) {
      double z = 0;
      for (int i = 0; i <= k; i++)
        for (int j = 0; j <= l; j++)
          z += p->c[i][j] * choose(k, i) / choose(DEGREE, i) * choose(l, j) / choose(DEGREE, j);
      net[k * SIDE + l] = cag_vec3((double)k / DEGREE, (double)l / DEGREE, z);
    }
  for (int d = 0; d < 2; d++)
    for (int i = 0; i < 2 * SIDE; i++)
      knots[d][i] = (i < SIDE ? 0 : per[d]) - (per[d] == 1 ? 0 : 0.3 * per[d]);
  OK(cag_surface_nurbs(net, NULL, SIDE, SIDE, DEGREE, DEGREE, knots[0], knots[1], &s, &err));
  OK(cag_surface_transform(s, move, &moved, &err));
  cag_surface_release(s);
  return moved;
}

static inline CagVec3 direction(void) {
  const double x = uniform(-1, 1), y = uniform(-1, 1);
  return cag_unit(cag_vec3(x, y, uniform(-1, 1)));
}

// The factors x - x0, y - y0, and x - x0 + s (y - y0), and the equation of a circle.
static inline Polynomial line_x(double x0) { return (Polynomial){{{-x0}, {1}}}; }
static inline Polynomial line_y(double y0) { return (Polynomial){{{-y0, 1}}}; }
static inline Polynomial slanted(double x0, double y0, double slope) {
  return (Polynomial){{{-x0 - slope * y0, slope}, {1}}};
}
static inline Polynomial circle(double x0, double y0, double r) {
  return (Polynomial){{{x0 * x0 + y0 * y0 - r * r, -2 * y0, 1}, {-2 * x0}, {1}}};
}

#endif
