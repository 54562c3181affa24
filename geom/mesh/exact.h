// Numbers without rounding: whole numbers of any length times a power of two. Every double is one,
// and sums and products stay exact; a quotient is rounded once, correctly.

#ifndef CAG_GEOM_MESH_EXACT_H
#define CAG_GEOM_MESH_EXACT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// sign * sum(limb[i] 2^(64 i)) * 2^exponent. Zero has no limbs; else the first and the last are not
// zero. The limbs belong to the space that the number was made in.
typedef struct CagExact {
  const uint64_t *limb;
  int n, exponent, sign;
} CagExact;

// Room for the numbers of one computation; used = 0 frees them all. Where it does not suffice,
// `full` is set and the numbers are wrong, but memory is safe as long as no single number needs
// more than `size`.
typedef struct CagExactSpace {
  uint64_t *limbs;
  size_t used, size;
  bool full;
} CagExactSpace;

CagExact cag_exact(CagExactSpace *s, double x); // x finite
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
// The double nearest to x / w, w > 0; of two as near the lower one; 0 below 2^-960. Equal quotients
// give equal doubles, and larger ones never smaller doubles.
double cag_exact_quotient(CagExactSpace *s, CagExact x, CagExact w);

#endif
