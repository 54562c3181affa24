// Signs of determinants in floating point, computed exactly if rounding could change them.
//
// A determinant is computed in doubles together with a bound of its rounding error (after Shewchuk
// 1997). If the bound does not determine the sign, it is recomputed exactly.

#include "geom/mesh/predicates.h"

#include <float.h>

#include "geom/mesh/exact.h"

// A product of three differences of doubles has at most 3 * 2100 bits, 99 limbs; about 40 numbers
// of that size and their intermediate results are made.
#define SPACE_LIMBS 8192

static int sign(double x) { return (x > 0) - (x < 0); }

static int exact_side_of_line(CagVec3 a, CagVec3 b, CagVec3 c) {
  uint64_t limbs[SPACE_LIMBS / 8]; // products of two differences are few and short
  CagExactSpace s = {limbs, 0, sizeof limbs / sizeof *limbs, false};
  return cag_exact_minor(&s, cag_exact_step(&s, a.x, c.x), cag_exact_step(&s, a.y, c.y),
                         cag_exact_step(&s, b.x, c.x), cag_exact_step(&s, b.y, c.y))
      .sign;
}

int cag_side_of_line(CagVec3 a, CagVec3 b, CagVec3 c) {
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double bound = 4 * DBL_EPSILON * (fabs(left) + fabs(right)) + DBL_MIN;
  const double value = left - right;
  if (fabs(value) > bound) return sign(value);
  if ((a.x == c.x && b.x == c.x) || (a.y == c.y && b.y == c.y)) return 0;
  return exact_side_of_line(a, b, c);
}

static int exact_side_of_plane(const CagVec3 p[3], CagVec3 d) {
  uint64_t limbs[SPACE_LIMBS];
  CagExactSpace s = {limbs, 0, SPACE_LIMBS, false};
  CagExact x[3], y[3], z[3], sum = {0};
  for (int i = 0; i < 3; i++) {
    x[i] = cag_exact_step(&s, p[i].x, d.x);
    y[i] = cag_exact_step(&s, p[i].y, d.y);
    z[i] = cag_exact_step(&s, p[i].z, d.z);
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (z[i].sign == 0) continue;
    const CagExact flat = cag_exact_minor(&s, x[j], x[k], y[j], y[k]);
    sum = cag_exact_difference(&s, sum, cag_exact_product(&s, z[i], flat));
  }
  return sum.sign;
}

int cag_side_of_plane(CagVec3 a, CagVec3 b, CagVec3 c, CagVec3 d) {
  const CagVec3 p[3] = {a, b, c};
  double value = 0, size = 0, heights = 1;
  for (int i = 0; i < 3; i++) {
    const CagVec3 q = p[(i + 1) % 3], r = p[(i + 2) % 3];
    const double one = (q.x - d.x) * (r.y - d.y), two = (q.y - d.y) * (r.x - d.x);
    value -= (p[i].z - d.z) * (one - two);
    size += fabs(p[i].z - d.z) * (fabs(one) + fabs(two));
    heights += fabs(p[i].z - d.z);
  }
  if (fabs(value) > 8 * DBL_EPSILON * size + DBL_MIN * heights) return sign(value);
  if (a.x == d.x && b.x == d.x && c.x == d.x) return 0;
  if (a.y == d.y && b.y == d.y && c.y == d.y) return 0;
  if (a.z == d.z && b.z == d.z && c.z == d.z) return 0;
  return exact_side_of_plane(p, d);
}
