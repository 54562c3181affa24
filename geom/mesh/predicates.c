// Signs of determinants in floating point, made exact where rounding could turn them (Shewchuk
// 1997).
//
// A determinant is computed in doubles together with a bound of its rounding. Where the bound does
// not settle the sign it is computed again as an expansion: a sum of doubles that do not overlap,
// smallest first, whose sign is that of the last. Coordinates of which products underflow are not
// exact any more; their differences are below 1e-140.

#include "geom/mesh/predicates.h"

#include <float.h>

#define MOST_TERMS 192 // of three products of three differences

typedef struct Expansion {
  int n;
  double term[MOST_TERMS];
} Expansion;

static void two_sum(double a, double b, double *sum, double *rest) {
  *sum = a + b;
  const double part = *sum - a;
  *rest = (a - (*sum - part)) + (b - part);
}

static void push(Expansion *e, double x) {
  if (x != 0) e->term[e->n++] = x;
}

static Expansion difference(double a, double b) {
  Expansion e = {0};
  double sum, rest;
  two_sum(a, -b, &sum, &rest);
  push(&e, rest);
  push(&e, sum);
  return e;
}

// e += x
static void grow(Expansion *e, double x) {
  Expansion out;
  out.n = 0;
  for (int i = 0; i < e->n; i++) {
    double rest;
    two_sum(x, e->term[i], &x, &rest);
    push(&out, rest);
  }
  push(&out, x);
  *e = out;
}

static Expansion product(const Expansion *a, const Expansion *b) {
  Expansion e = {0};
  for (int i = 0; i < a->n; i++)
    for (int k = 0; k < b->n; k++) {
      const double p = a->term[i] * b->term[k];
      grow(&e, fma(a->term[i], b->term[k], -p));
      grow(&e, p);
    }
  return e;
}

static void add(Expansion *e, const Expansion *more, double factor) {
  for (int i = 0; i < more->n; i++) grow(e, factor * more->term[i]);
}

static int sign(double x) { return (x > 0) - (x < 0); }

static int expansion_sign(const Expansion *e) { return e->n ? sign(e->term[e->n - 1]) : 0; }

// a d - b c
static Expansion minor_of(const Expansion *a, const Expansion *b, const Expansion *c,
                          const Expansion *d) {
  Expansion e = product(a, d);
  const Expansion other = product(b, c);
  add(&e, &other, -1);
  return e;
}

int cag_side_of_line(CagVec3 a, CagVec3 b, CagVec3 c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double bound = 4 * DBL_EPSILON * (fabs(left) + fabs(right)), value = left - right;
  if (fabs(value) > bound) return sign(value);
  const Expansion ax = difference(a.x, c.x), ay = difference(a.y, c.y);
  const Expansion bx = difference(b.x, c.x), by = difference(b.y, c.y);
  const Expansion e = minor_of(&ax, &ay, &bx, &by);
  return expansion_sign(&e);
}

static int exact_side(const CagVec3 p[3], CagVec3 d) {
  Expansion x[3], y[3], sum = {0};
  for (int i = 0; i < 3; i++) {
    x[i] = difference(p[i].x, d.x);
    y[i] = difference(p[i].y, d.y);
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Expansion z = difference(p[i].z, d.z), flat = minor_of(&x[j], &y[j], &x[k], &y[k]);
    const Expansion part = product(&z, &flat);
    add(&sum, &part, -1);
  }
  return expansion_sign(&sum);
}

int cag_side_of_plane(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d) {
  const CagVec3 p[3] = {a, b, c};
  double value = 0, size = 0;
  for (int i = 0; i < 3; i++) {
    const CagVec3 q = p[(i + 1) % 3], r = p[(i + 2) % 3];
    const double one = (q.x - d.x) * (r.y - d.y), two = (q.y - d.y) * (r.x - d.x);
    value -= (p[i].z - d.z) * (one - two);
    size += fabs(p[i].z - d.z) * (fabs(one) + fabs(two));
  }
  if (fabs(value) > 8 * DBL_EPSILON * size) return sign(value);
  return exact_side(p, d);
}
