// Reproducible random numbers for comparisons. Set the seed first.

#ifndef CAG_TESTS_GEOM_RANDOM_H
#define CAG_TESTS_GEOM_RANDOM_H

#include <stdint.h>

static uint64_t seed;

// Knuth's linear congruential generator.
static inline double uniform(double low, double high) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

#endif
