// Replaces base/reserve.c where all memory is used that is reserved.

#include "base/reserve.h"

#include <stdlib.h>

const size_t cag_reserve_ample = (size_t)8 << 20;

void *cag_reserve(size_t bytes) { return calloc(1, bytes); }

void cag_unreserve(void *start, size_t bytes) {
  (void)bytes;
  free(start);
}
