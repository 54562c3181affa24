// The time that has passed.

#ifndef CAG_INTERP_CLOCK_H
#define CAG_INTERP_CLOCK_H

#include <time.h>

// Seconds since some time before the program began; changes of the date do not matter.
static inline double cag_clock_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
