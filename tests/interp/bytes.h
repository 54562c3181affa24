// Reads numbers from the bytes of binary files.

#ifndef CAG_TESTS_INTERP_BYTES_H
#define CAG_TESTS_INTERP_BYTES_H

#include <stdint.h>
#include <string.h>

static inline float float_at(const char *p) {
  float x;
  memcpy(&x, p, 4);
  return x;
}

static inline uint32_t word_at(const char *p) {
  uint32_t x;
  memcpy(&x, p, 4);
  return x;
}

#endif
