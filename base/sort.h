// Interruptible sorting.

#ifndef CAG_BASE_SORT_H
#define CAG_BASE_SORT_H

#include <stddef.h>

#include "base/status.h"

// Sorts like qsort. If the work is to stop, returns an error, and the order of the elements is
// undefined.
CagStatus cag_sort(void *items, size_t n, size_t size, int (*compare)(const void *, const void *),
                   CagError *err);

#endif
