// Exact numbers: integers of any length times a power of two. Every double is such a number, and
// sums and products are exact; quotients are rounded once, correctly.

#ifndef CAG_GEOM_MESH_EXACT_H
#define CAG_GEOM_MESH_EXACT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// sign * sum(limb[i] 2^(64 i)) * 2^exponent. Zero has no limbs; otherwise the first and the last
// limb are nonzero. The limbs belong to the space in which the number was made.
typedef struct CagExact {
  const uint64_t *limb;
  int n, exponent, sign;
} CagExact;

// Memory for the numbers of one computation; used = 0 frees them all. If it is too small, `full` is
// set and the numbers are wrong, but memory is safe as long as no single number needs more than
// `size`.
typedef struct CagExactSpace {
  uint64_t *limbs;
  size_t used, size;
  bool full;
} CagExactSpace;

CagExact cag_exact(CagExactSpace *s, double x); // x must be finite
CagExact cag_exact_sum(CagExactSpace *s, CagExact a, CagExact b);
CagExact cag_exact_product(CagExactSpace *s, CagExact a, CagExact b);
static inline CagExact cag_exact_negative(CagExact a) {
  a.sign = -a.sign;
  return a;
}
static inline CagExact cag_exact_difference(CagExactSpace *s, CagExact a, CagExact b) {
  return cag_exact_sum(s, a, cag_exact_negative(b));
}
// a - b, of doubles
CagExact cag_exact_step(CagExactSpace *s, double a, double b);
// a d - b c
CagExact cag_exact_minor(CagExactSpace *s, CagExact a, CagExact b, CagExact c, CagExact d);
// The double nearest to x / w, w > 0; the lower one in a tie; 0 below 2^-960. Equal quotients
// result in equal doubles, and the result is monotone.
double cag_exact_quotient(CagExactSpace *s, CagExact x, CagExact w);

#endif
