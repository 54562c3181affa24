// Integrals over the part of a box in which a quadratic form is negative, independent of the
// library. The integration along y uses closed forms. The integrations along x and z use the double
// exponential rule between the positions where the bounds change, because the integrands have
// square roots and logarithms there.

#ifndef CAG_TESTS_BOX_INTEGRAL_H
#define CAG_TESTS_BOX_INTEGRAL_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geom/surface/quadric.h"

enum { INTEGRALS = 10, POINTS = 55 };
#define REACH 3.2

typedef struct BoxIntegral {
  double k[10]; // the form
  CagBounds box;
  double node[POINTS], weight[POINTS]; // on 0..1
} BoxIntegral;

// The double exponential rule (Takahasi and Mori 1974).
static inline void set_rule(BoxIntegral *b) {
  const double step = 2 * REACH / (POINTS - 1);
  for (int i = 0; i < POINTS; i++) {
    const double s = i * step - REACH, t = M_PI / 2 * sinh(s);
    b->node[i] = 1 / (1 + exp(-2 * t));
    b->weight[i] = step * M_PI / 4 * cosh(s) / (cosh(t) * cosh(t));
  }
}

// Adds the roots of a t^2 + b t + c within lo..hi, or the real part of complex roots.
static inline void roots_within(double a, double b, double c, double lo, double hi, double *cuts,
                                int *n) {
  const double rest = b * b - 4 * a * c, q = b < 0 ? sqrt(rest) - b : -sqrt(rest) - b;
  const double t[2] = {rest < 0 ? -b / (2 * a) : q / (2 * a), rest < 0 ? NAN : 2 * c / q};
  for (int i = 0; i < 2; i++)
    if (t[i] > lo && t[i] < hi) cuts[(*n)++] = t[i];
}

static inline int by_number(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Integrals of 1, y, y^2 along y over the negative part of the form.
static inline void along_y(const BoxIntegral *b, double x, double z, double out[3]) {
  const double *k = b->k;
  const double u = k[1], v = k[3] * x + k[4] * z + k[7];
  const double w = k[0] * x * x + k[2] * z * z + k[5] * x * z + k[6] * x + k[8] * z + k[9];
  double cuts[5] = {b->box.min.y};
  int n = 1;
  roots_within(u, v, w, b->box.min.y, b->box.max.y, cuts, &n);
  cuts[n++] = b->box.max.y;
  qsort(cuts, (size_t)n, sizeof *cuts, by_number);
  out[0] = out[1] = out[2] = 0;
  for (int i = 0; i + 1 < n; i++) {
    const double p = cuts[i], q = cuts[i + 1], m = (p + q) / 2;
    if ((u * m + v) * m + w > 0) continue;
    out[0] += q - p;
    out[1] += (q - p) * m;
    out[2] += (q * q * q - p * p * p) / 3;
  }
}

// Integrals over x and y at one z: 1, x, y, x x, y y, x y.
static inline void across(const BoxIntegral *b, double z, double out[6]) {
  const double *k = b->k, lo = b->box.min.x, hi = b->box.max.x;
  const double sides[2] = {b->box.min.y, b->box.max.y};
  double cuts[12] = {lo};
  int n = 1;
  const double d = k[4] * z + k[7], e = k[5] * z + k[6], f = (k[2] * z + k[8]) * z + k[9];
  roots_within(k[3] * k[3] - 4 * k[1] * k[0], 2 * k[3] * d - 4 * k[1] * e, d * d - 4 * k[1] * f, lo,
               hi, cuts, &n);
  for (int i = 0; i < 2; i++) {
    const double y = sides[i];
    roots_within(k[0], k[3] * y + e, (k[1] * y + d) * y + f, lo, hi, cuts, &n);
  }
  if (k[1] == 0 && k[3] != 0 && -d / k[3] > lo && -d / k[3] < hi) cuts[n++] = -d / k[3];
  cuts[n++] = hi;
  qsort(cuts, (size_t)n, sizeof *cuts, by_number);
  for (int i = 0; i < 6; i++) out[i] = 0;
  for (int i = 0; i + 1 < n; i++)
    for (int g = 0; g < POINTS; g++) {
      const double width = cuts[i + 1] - cuts[i];
      const double x = cuts[i] + width * b->node[g];
      const double w = b->weight[g] * width;
      double y[3];
      along_y(b, x, z, y);
      const double add[6] = {y[0], x * y[0], y[1], x * x * y[0], y[2], x * y[1]};
      for (int j = 0; j < 6; j++) out[j] += w * add[j];
    }
}

static inline double det3(const double m[3][3]) {
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    sum += m[0][i] * (m[1][j] * m[2][l] - m[1][l] * m[2][j]);
  }
  return sum;
}

// The determinant of the conic at z, which is quadratic in z.
static inline double conic_det(const double k[10], double z) {
  const double d = (k[5] * z + k[6]) / 2, e = (k[4] * z + k[7]) / 2;
  const double m[3][3] = {
      {k[0], k[3] / 2, d}, {k[3] / 2, k[1], e}, {d, e, (k[2] * z + k[8]) * z + k[9]}};
  return det3(m);
}

// Where the conic at z touches a side of the rectangle, on which the form is a t^2 + (b z + c) t +
// d z^2 + e z + f.
static inline void touches(double a, double b, double c, double d, double e, double f, double lo,
                           double hi, double *cuts, int *n) {
  roots_within(b * b - 4 * a * d, 2 * b * c - 4 * a * e, c * c - 4 * a * f, lo, hi, cuts, n);
}

static inline int cuts_of_z(const BoxIntegral *b, double *cuts) {
  const double *k = b->k, lo = b->box.min.z, hi = b->box.max.z;
  const double xs[2] = {b->box.min.x, b->box.max.x}, ys[2] = {b->box.min.y, b->box.max.y};
  int n = 0;
  cuts[n++] = lo;
  for (int i = 0; i < 2; i++) {
    const double x = xs[i], y = ys[i];
    touches(k[1], k[4], k[3] * x + k[7], k[2], k[5] * x + k[8], (k[0] * x + k[6]) * x + k[9], lo,
            hi, cuts, &n);
    touches(k[0], k[5], k[3] * y + k[6], k[2], k[4] * y + k[8], (k[1] * y + k[7]) * y + k[9], lo,
            hi, cuts, &n);
    for (int j = 0; j < 2; j++)
      roots_within(k[2], k[5] * xs[j] + k[4] * y + k[8],
                   (k[0] * xs[j] + k[3] * y + k[6]) * xs[j] + (k[1] * y + k[7]) * y + k[9], lo, hi,
                   cuts, &n);
  }
  const double at[3] = {conic_det(k, -1), conic_det(k, 0), conic_det(k, 1)};
  roots_within((at[0] + at[2]) / 2 - at[1], (at[2] - at[0]) / 2, at[1], lo, hi, cuts, &n);
  cuts[n++] = hi;
  qsort(cuts, (size_t)n, sizeof *cuts, by_number);
  return n;
}

// Integrals of 1, x, y, z, x x, y y, z z, x y, y z, z x.
static inline void box_integrals(const CagQuadric *q, const CagBounds *box, double out[INTEGRALS]) {
  BoxIntegral b = {.box = *box};
  double cuts[32];
  memcpy(b.k, q->c, sizeof b.k);
  set_rule(&b);
  const int n = cuts_of_z(&b, cuts);
  for (int i = 0; i < INTEGRALS; i++) out[i] = 0;
  for (int i = 0; i + 1 < n; i++)
    for (int g = 0; g < POINTS; g++) {
      const double width = cuts[i + 1] - cuts[i];
      const double z = cuts[i] + width * b.node[g];
      const double w = b.weight[g] * width;
      double a[6];
      across(&b, z, a);
      const double add[INTEGRALS] = {a[0], a[1],         a[2], z * a[0], a[3],
                                     a[4], z * z * a[0], a[5], z * a[2], z * a[1]};
      for (int j = 0; j < INTEGRALS; j++) out[j] += w * add[j];
    }
}

// The area of the form's negative part at one z.
static inline double area_at_z(const CagQuadric *q, const CagBounds *box, double z) {
  BoxIntegral b = {.box = *box};
  double a[6];
  memcpy(b.k, q->c, sizeof b.k);
  set_rule(&b);
  across(&b, z, a);
  return a[0];
}

#endif
