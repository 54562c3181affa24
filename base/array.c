// Growing arrays.

#include "base/array.h"

#include <stdint.h>
#include <string.h>

#include "base/memory.h"

// Items of the first allocation.
#define FIRST_CAPACITY 16

bool cag_array_resize(void *items, size_t count, size_t size) {
  if (count > SIZE_MAX / 2 / size) return false;
  void *old;
  memcpy(&old, items, sizeof old); // the pointer may be of any type
  void *resized = cag_realloc(old, count * size);
  if (!resized) return false;
  memcpy(items, &resized, sizeof resized);
  return true;
}

bool cag_array_grow(void *items, size_t *capacity, size_t count, size_t size) {
  const size_t most = SIZE_MAX / 2 / size;
  if (count > most) return false;
  size_t larger = *capacity < most / 2 ? 2 * *capacity : most;
  if (larger < FIRST_CAPACITY) larger = FIRST_CAPACITY;
  if (larger < count) larger = count;
  if (!cag_array_resize(items, larger, size)) return false;
  *capacity = larger;
  return true;
}
