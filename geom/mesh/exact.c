// Exact arithmetic by schoolbook methods on 64-bit limbs. The numbers in geometric predicates have
// 1 to 20 limbs, for which no other method is faster.

#include "geom/mesh/exact.h"

#include <math.h>
#include <string.h>

#define LIMB_BITS 64
#define MANTISSA_BITS 53

__extension__ typedef unsigned __int128 Wide;

static uint64_t *new_limbs(CagExactSpace *s, size_t n) {
  if (s->used + n > s->size) {
    s->full = true;
    s->used = 0;
  }
  uint64_t *limbs = s->limbs + s->used;
  s->used += n;
  return limbs;
}

static CagExact stripped(const uint64_t *limb, int n, int exponent, int sign) {
  while (n > 0 && limb[n - 1] == 0) n--;
  while (n > 0 && limb[0] == 0) limb++, n--, exponent += LIMB_BITS;
  return n > 0 ? (CagExact){limb, n, exponent, sign} : (CagExact){NULL, 0, 0, 0};
}

CagExact cag_exact(CagExactSpace *s, double x) {
  if (x == 0) return (CagExact){NULL, 0, 0, 0};
  int exponent;
  const double fraction = frexp(fabs(x), &exponent);
  uint64_t mantissa = (uint64_t)ldexp(fraction, MANTISSA_BITS);
  const int zeros = __builtin_ctzll(mantissa);
  uint64_t *limb = new_limbs(s, 1);
  *limb = mantissa >> zeros;
  return (CagExact){limb, 1, exponent - MANTISSA_BITS + zeros, x > 0 ? 1 : -1};
}

// Writes a, shifted left by `shift` bits, to n limbs.
static void write_shifted(const CagExact *a, int shift, uint64_t *to, int n) {
  const int limbs = shift / LIMB_BITS, bits = shift % LIMB_BITS;
  memset(to, 0, (size_t)n * sizeof *to);
  for (int i = 0; i < a->n; i++) {
    to[i + limbs] |= a->limb[i] << bits;
    if (bits) to[i + limbs + 1] |= a->limb[i] >> (LIMB_BITS - bits);
  }
}

static bool is_less(const uint64_t *a, const uint64_t *b, int n) {
  for (int i = n; i-- > 0;)
    if (a[i] != b[i]) return a[i] < b[i];
  return false;
}

CagExact cag_exact_sum(CagExactSpace *s, CagExact a, CagExact b) {
  if (a.sign == 0) return b;
  if (b.sign == 0) return a;
  const int exponent = a.exponent < b.exponent ? a.exponent : b.exponent;
  const int up_a = a.exponent - exponent, up_b = b.exponent - exponent;
  const int n_a = a.n + up_a / LIMB_BITS + 1, n_b = b.n + up_b / LIMB_BITS + 1;
  const int n = (n_a > n_b ? n_a : n_b) + 1;
  uint64_t *large = new_limbs(s, 2 * (size_t)n), *small = large + n;
  write_shifted(&a, up_a, large, n);
  write_shifted(&b, up_b, small, n);
  int sign = a.sign;
  if (a.sign == b.sign) {
    uint64_t carry = 0;
    for (int i = 0; i < n; i++) {
      const Wide sum = (Wide)large[i] + small[i] + carry;
      large[i] = (uint64_t)sum;
      carry = (uint64_t)(sum >> LIMB_BITS);
    }
    return stripped(large, n, exponent, sign);
  }
  if (is_less(large, small, n)) {
    uint64_t *other = large;
    large = small;
    small = other;
    sign = b.sign;
  }
  uint64_t borrow = 0;
  for (int i = 0; i < n; i++) {
    const Wide rest = (Wide)large[i] - small[i] - borrow;
    large[i] = (uint64_t)rest;
    borrow = (uint64_t)(rest >> LIMB_BITS) & 1;
  }
  return stripped(large, n, exponent, sign);
}

CagExact cag_exact_product(CagExactSpace *s, CagExact a, CagExact b) {
  if (a.sign == 0 || b.sign == 0) return (CagExact){NULL, 0, 0, 0};
  const int n = a.n + b.n;
  uint64_t *limb = new_limbs(s, (size_t)n);
  memset(limb, 0, (size_t)n * sizeof *limb);
  for (int i = 0; i < a.n; i++) {
    uint64_t carry = 0;
    for (int k = 0; k < b.n; k++) {
      const Wide sum = (Wide)a.limb[i] * b.limb[k] + limb[i + k] + carry;
      limb[i + k] = (uint64_t)sum;
      carry = (uint64_t)(sum >> LIMB_BITS);
    }
    limb[i + b.n] = carry;
  }
  return stripped(limb, n, a.exponent + b.exponent, a.sign * b.sign);
}

CagExact cag_exact_step(CagExactSpace *s, double a, double b) {
  if (a == b) return (CagExact){NULL, 0, 0, 0};
  return cag_exact_difference(s, cag_exact(s, a), cag_exact(s, b));
}

CagExact cag_exact_minor(CagExactSpace *s, CagExact a, CagExact b, CagExact c, CagExact d) {
  return cag_exact_difference(s, cag_exact_product(s, a, d), cag_exact_product(s, b, c));
}

// a = result * 2^exponent, with a relative error of 2^-52.
static double approximate(const CagExact *a, int *exponent) {
  if (a->n == 0) {
    *exponent = 0;
    return 0;
  }
  const uint64_t high = a->limb[a->n - 1], low = a->n > 1 ? a->limb[a->n - 2] : 0;
  int up;
  const double m = frexp(0x1p64 * (double)high + (double)low, &up);
  *exponent = a->exponent + (a->n - 2) * LIMB_BITS + up;
  return a->sign * m;
}

static double near_quotient(const CagExact *x, const CagExact *w) {
  int up, down;
  const double a = approximate(x, &up), b = approximate(w, &down);
  return ldexp(a / b, up - down);
}

// The sign of x / w - q.
static int compare(CagExactSpace *s, CagExact x, CagExact w, CagExact q) {
  return cag_exact_difference(s, x, cag_exact_product(s, q, w)).sign;
}

double cag_exact_quotient(CagExactSpace *s, CagExact x, CagExact w) {
  const double tiny = 0x1p-960; // below this, doubles lose bits
  if (x.sign == 0) return 0;
  const double q = near_quotient(&x, &w);
  if (fabs(q) < 2 * tiny) {
    CagExact size = x;
    size.sign = 1;
    if (compare(s, size, w, cag_exact(s, tiny)) < 0) return 0;
  }
  // q is off by some units in the last place; one correction with the exact remainder fixes that.
  const CagExact rest = cag_exact_difference(s, x, cag_exact_product(s, cag_exact(s, q), w));
  if (rest.sign == 0) return q;
  const double more = near_quotient(&rest, &w), sum = q + more, left = more - (sum - q);
  const double other = nextafter(sum, left > 0 ? INFINITY : -INFINITY), half = (other - sum) / 2;
  // The relative error of `left` is 2^-50 of `more`, far below this margin of half a unit.
  const double sure = 0.999;
  if (left == 0 || fabs(left) < sure * fabs(half)) return sum;
  const CagExact middle = cag_exact_sum(s, cag_exact(s, sum), cag_exact(s, half));
  const int side = compare(s, x, w, middle);
  if (side == 0) return fmin(sum, other);
  return (side > 0) == (other > sum) ? other : sum;
}
