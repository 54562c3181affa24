// Interruptible sorting: blocks are sorted by qsort and merged.

#include "base/sort.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/stop.h"

// Elements per block: a few milliseconds of qsort.
#define BLOCK ((size_t)1 << 14)
// Elements merged between two checks of the stop flag.
#define MERGED_BETWEEN_LOOKS ((size_t)1 << 12)

typedef struct Sort {
  size_t n, size;
  int (*compare)(const void *, const void *);
} Sort;

// Merges the sorted runs [0, middle) and [middle, n) of `from`. Stable: equal elements of the first
// run come first.
static CagStatus merge(const Sort *s, const char *from, size_t middle, size_t n, char *to,
                       CagError *err) {
  const size_t size = s->size;
  const char *a = from, *b = from + middle * size, *a_end = b, *b_end = from + n * size;
  for (size_t k = 0; a < a_end && b < b_end; k++, to += size) {
    if (k % MERGED_BETWEEN_LOOKS == 0 && cag_stop_check(err)) return err->status;
    const char **next = s->compare(a, b) <= 0 ? &a : &b;
    memcpy(to, *next, size);
    *next += size;
  }
  memcpy(to, a, (size_t)(a_end - a));
  memcpy(to + (a_end - a), b, (size_t)(b_end - b));
  return CAG_OK;
}

CagStatus cag_sort(void *items, size_t n, size_t size, int (*compare)(const void *, const void *),
                   CagError *err) {
  const Sort s = {n, size, compare};
  char *from = items, *spare = NULL;
  for (size_t i = 0; i < n; i += BLOCK) {
    qsort(from + i * size, n - i < BLOCK ? n - i : BLOCK, size, compare);
    if (cag_stop_check(err)) return err->status;
  }
  if (n <= BLOCK) return CAG_OK;
  char *to = spare = cag_malloc(n * size);
  if (!spare) return cag_fail_memory(err);
  CagStatus status = CAG_OK;
  for (size_t run = BLOCK; !status && run < n; run *= 2) {
    for (size_t i = 0; !status && i < n; i += 2 * run) {
      const size_t rest = n - i, whole = rest < 2 * run ? rest : 2 * run;
      status = merge(&s, from + i * size, run < whole ? run : whole, whole, to + i * size, err);
    }
    char *sorted = to;
    to = from;
    from = sorted;
  }
  if (!status && from == spare) memcpy(items, spare, n * size);
  cag_free(spare);
  return status;
}
