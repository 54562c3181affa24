// Two hashes of 64 bits with different constants, each with the finisher of MurmurHash3 (Appleby).

#include "base/digest.h"

#include <string.h>

static uint64_t mixed(uint64_t h) {
  h = (h ^ h >> 33) * UINT64_C(0xff51afd7ed558ccd);
  h = (h ^ h >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
  return h ^ h >> 33;
}

CagDigest cag_digest_start(void) {
  return (CagDigest){.a = UINT64_C(0x9e3779b97f4a7c15), .b = UINT64_C(0xd1b54a32d192ed03)};
}

void cag_digest_word(CagDigest *d, uint64_t word) {
  d->a = mixed((d->a ^ word) + UINT64_C(0x9e3779b97f4a7c15));
  d->b = mixed((d->b + word) * UINT64_C(0xa24baed4963ee407) ^ d->a);
}

void cag_digest_numbers(CagDigest *d, const double *x, size_t n) {
  for (size_t i = 0; i < n; i++) {
    uint64_t bits;
    memcpy(&bits, &x[i], sizeof bits);
    cag_digest_word(d, bits);
  }
}

void cag_digest_bytes(CagDigest *d, const void *bytes, size_t n) {
  const unsigned char *at = bytes;
  cag_digest_word(d, n);
  for (; n >= 8; n -= 8, at += 8) {
    uint64_t word;
    memcpy(&word, at, 8);
    cag_digest_word(d, word);
  }
  uint64_t rest = 0;
  if (n > 0) memcpy(&rest, at, n);
  cag_digest_word(d, rest);
}

void cag_digest_text(CagDigest *d, const char *text) { cag_digest_bytes(d, text, strlen(text)); }
