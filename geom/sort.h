// Sorting that can be stopped.

#ifndef CAG_GEOM_SORT_H
#define CAG_GEOM_SORT_H

#include <stddef.h>

#include "geom/status.h"

// Sorts like qsort. If the work is to end, returns an error, and the order of the elements is
// undefined.
CagStatus cag_sort(void *items, size_t n, size_t size, int (*compare)(const void *, const void *),
                   CagError *err);

#endif
