#include "base/reserve.h"

#include <sys/mman.h>

const size_t cag_reserve_ample = (size_t)256 << 20;

void *cag_reserve(size_t bytes) {
  void *p =
      mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return p == MAP_FAILED ? NULL : p;
}

void cag_unreserve(void *start, size_t bytes) {
  if (start) munmap(start, bytes);
}
