// Numbers as decimal text (see decimal.h).
//
// A number is m / 2^shift with a whole m of 53 bits. Its decimal digits are the whole number nearest
// to m 10^power / 2^shift, whose product fits 128 bits.

#include "base/decimal.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/assert.h"

__extension__ typedef unsigned __int128 Wide;

#define MANTISSA_BITS 53

static const char two_digits[] = "00010203040506070809101112131415161718192021222324252627282930313"
                                 "23334353637383940414243444546474849505152535455565758596061626364"
                                 "65666768697071727374757677787980818283848586878889909192939495969"
                                 "79899";

char *cag_decimal_index(char *at, uint64_t n) {
  char digits[20];
  int k = 20;
  while (n >= 100) {
    k -= 2;
    memcpy(digits + k, two_digits + 2 * (n % 100), 2);
    n /= 100;
  }
  if (n >= 10) {
    k -= 2;
    memcpy(digits + k, two_digits + 2 * n, 2);
  } else digits[--k] = (char)('0' + n);
  memcpy(at, digits + k, (size_t)(20 - k));
  return at + 20 - k;
}

static Wide power_of_ten(int power) {
  Wide out = 1;
  for (; power > 0; power--) out *= 10;
  return out;
}

// Splits x > 0 into m / 2^shift.
static uint64_t split(double x, int *shift) {
  int exponent;
  const double fraction = frexp(x, &exponent);
  *shift = MANTISSA_BITS - exponent;
  return (uint64_t)ldexp(fraction, MANTISSA_BITS);
}

// Returns the whole number nearest to product / 2^shift; the even one of two. 0 < shift < 128.
static uint64_t rounded(Wide product, int shift, Wide *error) {
  const Wide one = (Wide)1 << shift, rest = product & (one - 1);
  const uint64_t whole = (uint64_t)(product >> shift);
  const bool up = rest > one / 2 || (rest == one / 2 && whole % 2 == 1);
  *error = up ? one - rest : rest;
  return whole + up;
}

// --- Significant digits ---

enum { LEAST_DIGITS = 15, MOST_DIGITS = 17, LEAST_EXPONENT = -4, MOST_EXPONENT = 14 };

// The decimal exponent of x, which is between 1e-4 and 1e15.
static int exponent_of(double x) {
  static const double bound[] = {1e-3, 1e-2, 1e-1, 1,   1e1,  1e2,  1e3,  1e4,  1e5,
                                 1e6,  1e7,  1e8,  1e9, 1e10, 1e11, 1e12, 1e13, 1e14};
  int k = 0;
  while (k < (int)(sizeof bound / sizeof *bound) && x >= bound[k]) k++;
  return k + LEAST_EXPONENT;
}

// Writes digits without trailing zeros, the first one of which stands for 10^exponent.
static char *write_digits(char *at, uint64_t value, int exponent) {
  char digits[20];
  int n = (int)(cag_decimal_index(digits, value) - digits);
  while (n > 1 && digits[n - 1] == '0') n--;
  if (exponent < 0) {
    memcpy(at, "0.000", (size_t)(1 - exponent));
    at += 1 - exponent;
    memcpy(at, digits, (size_t)n);
    return at + n;
  }
  for (int i = 0; i <= exponent; i++) *at++ = i < n ? digits[i] : '0';
  if (n <= exponent + 1) return at;
  *at++ = '.';
  memcpy(at, digits + exponent + 1, (size_t)(n - exponent - 1));
  return at + n - exponent - 1;
}

char *cag_decimal_shortest(char *at, double x) {
  const double size = fabs(x);
  int shift;
  if (x == 0 && !signbit(x)) {
    *at = '0';
    return at + 1;
  }
  if (!(size >= 1e-4 && size < 1e15)) return NULL;
  const int exponent = exponent_of(size);
  const uint64_t m = split(size, &shift);
  // A power of two is nearer to its lower neighbor, which only an exact text can ignore.
  const bool even_gaps = m != (uint64_t)1 << (MANTISSA_BITS - 1);
  Wide scale = power_of_ten(LEAST_DIGITS - 1 - exponent);
  uint64_t least = (uint64_t)power_of_ten(LEAST_DIGITS - 1);
  for (int n = LEAST_DIGITS; n <= MOST_DIGITS; n++, scale *= 10, least *= 10) {
    Wide error;
    const uint64_t digits = rounded(m * scale, shift, &error);
    if (digits < least || digits >= 10 * least || (error > 0 && !even_gaps)) return NULL;
    if (2 * error >= scale) continue; // not nearer to x than half of the gap to its neighbor
    if (x < 0) *at++ = '-';
    return write_digits(at, digits, exponent);
  }
  return NULL;
}

// --- Decimals ---

enum { DECIMALS = 13 };

char *cag_decimal_fixed(char *at, double x) {
  const uint64_t one = 10000000000000; // 10^DECIMALS
  // m 10^13 has less than this number of bits: if it is shifted by more, nothing remains.
  const int product_bits = 97;
  uint64_t whole = 0;
  CAG_ASSERT(fabs(x) < CAG_DECIMAL_FIXED_LIMIT);
  if (x != 0) {
    int shift;
    Wide error;
    const uint64_t m = split(fabs(x), &shift);
    if (shift <= product_bits) whole = rounded((Wide)m * one, shift, &error);
  }
  if (x < 0 && whole > 0) *at++ = '-';
  at = cag_decimal_index(at, whole / one);
  *at++ = '.';
  uint64_t fraction = whole % one;
  int n = fraction == 0 ? 0 : DECIMALS;
  while (n > 0 && fraction % 10 == 0) fraction /= 10, n--;
  for (char *to = at + n; to > at; fraction /= 10) *--to = (char)('0' + fraction % 10);
  return at + n;
}
