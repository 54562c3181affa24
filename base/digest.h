// The identity of data: equal data have equal digests, and different data practically never do (128
// bits). Digests are those of one program: they depend on the machine's order of bytes.
//
// A digest is unknown if something went into it that cannot be compared, such as a function of a
// script. An unknown digest equals nothing.

#ifndef CAG_BASE_DIGEST_H
#define CAG_BASE_DIGEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CagDigest {
  uint64_t a, b;
  bool unknown;
} CagDigest;

CagDigest cag_digest_start(void);
// Each of these adds to the digest. 0 and -0 are different numbers.
void cag_digest_word(CagDigest *d, uint64_t word);
void cag_digest_numbers(CagDigest *d, const double *x, size_t n);
void cag_digest_bytes(CagDigest *d, const void *bytes, size_t n); // with their count
void cag_digest_text(CagDigest *d, const char *text);
static inline void cag_digest_number(CagDigest *d, double x) { cag_digest_numbers(d, &x, 1); }
static inline bool cag_digest_equal(const CagDigest *p, const CagDigest *q) {
  return !p->unknown && !q->unknown && p->a == q->a && p->b == q->b;
}

#endif
