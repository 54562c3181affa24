// Numbers as decimal text without printf, for files with millions of numbers.
//
// The text is exactly that of printf: products of 128 bits are rounded, so that there is no error
// of floating-point arithmetic. Functions write at `at`, without a zero, and return the end.

#ifndef CAG_BASE_DECIMAL_H
#define CAG_BASE_DECIMAL_H

#include <stdint.h>

// The most bytes that cag_decimal_shortest writes.
#define CAG_DECIMAL_ROOM 26
// Numbers below this one can be written by cag_decimal_fixed.
#define CAG_DECIMAL_FIXED_LIMIT 1000.0

// Writes the decimal digits of n, at most 20 bytes.
char *cag_decimal_index(char *at, uint64_t n);

// Writes the shortest of 15 to 17 significant digits that read back as x, without trailing zeros,
// as printf does with %.15g to %.17g. Returns NULL, with nothing of use at `at`, for numbers that
// printf would write with an exponent, for those that are not finite, and for a few others.
char *cag_decimal_shortest(char *at, double x);

// Writes x with up to 13 decimals, without trailing zeros, but always with a point: "0.5", "1.". x
// must be between -CAG_DECIMAL_FIXED_LIMIT and CAG_DECIMAL_FIXED_LIMIT.
char *cag_decimal_fixed(char *at, double x);

#endif
