#include "geom/ray/ray.h"

#include "base/array.h"
#include "base/memory.h"

CagCrossing *cag_crossings_add(CagCrossings *list, CagError *err) {
  if (!CAG_RESERVE(list->items, list->capacity, list->n + 1)) {
    cag_fail_memory(err);
    return NULL;
  }
  return &list->items[list->n++];
}

// Lists are short, and mostly in order already.
void cag_crossings_sort(CagCrossings *list) {
  for (size_t i = 1; i < list->n; i++) {
    const CagCrossing c = list->items[i];
    size_t k = i;
    for (; k > 0 && list->items[k - 1].t > c.t; k--) list->items[k] = list->items[k - 1];
    list->items[k] = c;
  }
}

void cag_crossings_free(CagCrossings *list) {
  cag_free(list->items);
  *list = (CagCrossings){0};
}
