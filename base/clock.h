// Elapsed time.

#ifndef CAG_BASE_CLOCK_H
#define CAG_BASE_CLOCK_H

#include <time.h>

// Returns the seconds since a fixed time before the program started. Changes of the system date do
// not affect it.
static inline double cag_clock_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
