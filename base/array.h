// Growing arrays.
//
// An array is a pointer, a count, and a capacity in whatever structure owns it:
//
//     if (!CAG_RESERVE(list->items, list->capacity, list->count + 1)) return cag_fail_memory(err);
//     list->items[list->count++] = item;

#ifndef CAG_BASE_ARRAY_H
#define CAG_BASE_ARRAY_H

#include <stdbool.h>
#include <stddef.h>

// Makes room for at least `count` items. The capacity at least doubles, so adding n items one by
// one takes O(n) time. Returns false if memory ran out; the array is then unchanged. Allocates with
// cag_realloc (base/memory.h).
#define CAG_RESERVE(items, capacity, count)                                                        \
  cag_array_reserve(&(items), &(capacity), (count), sizeof *(items))

// Allocates exactly `count` items, for arrays that share a capacity or that never grow item by
// item. Returns false if memory ran out; the array is then unchanged.
#define CAG_RESIZE(items, count) cag_array_resize(&(items), (count), sizeof *(items))

bool cag_array_resize(void *items, size_t count, size_t size);

// Called by cag_array_reserve if the capacity is too small.
bool cag_array_grow(void *items, size_t *capacity, size_t count, size_t size);

// `items` is the address of the pointer to items of `size` bytes.
static inline bool cag_array_reserve(void *items, size_t *capacity, size_t count, size_t size) {
  return count <= *capacity || cag_array_grow(items, capacity, count, size);
}

#endif
