// Replaces the C library's qsort, which does not keep the order of equal elements. That of glibc
// does, and with the same order, results are the same as those of the native program.

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef int Compare(const void *a, const void *b);

// Sorts by insertion.
static void sort_few(char *items, size_t n, size_t size, Compare *compare, char *spare) {
  for (size_t i = 1; i < n; i++) {
    size_t at = i;
    while (at > 0 && compare(items + (at - 1) * size, items + i * size) > 0) at--;
    if (at == i) continue;
    memcpy(spare, items + i * size, size);
    memmove(items + (at + 1) * size, items + at * size, (i - at) * size);
    memcpy(items + at * size, spare, size);
  }
}

static void sort(char *items, size_t n, size_t size, Compare *compare, char *spare) {
  enum { FEW = 8 };
  if (n <= FEW) {
    sort_few(items, n, size, compare, spare);
    return;
  }
  const size_t half = n / 2;
  char *a = spare, *b = items + half * size, *to = items, *a_end = spare + half * size,
       *b_end = items + n * size;
  sort(items, half, size, compare, spare);
  sort(b, n - half, size, compare, spare);
  memcpy(spare, items, half * size);
  while (a < a_end) {
    const bool first = b == b_end || compare(a, b) <= 0;
    memcpy(to, first ? a : b, size);
    *(first ? &a : &b) += size;
    to += size;
  }
}

void qsort(void *items, size_t n, size_t size, Compare *compare) {
  char few[1024], *spare = few;
  if (n < 2 || size == 0) return;
  const size_t bytes = (n / 2 + 1) * size;
  if (bytes > sizeof few && !(spare = malloc(bytes))) abort(); // it cannot fail
  sort(items, n, size, compare, spare);
  if (spare != few) free(spare);
}
