// The table of names: linear probing over pointers to the heads of names.

#include "lang/names.h"

#include <string.h>

#include "base/memory.h"

#define FIRST_CAPACITY 256

static CagNameHead **slots_new(size_t capacity) {
  return cag_checked(cag_calloc(capacity, sizeof(CagNameHead *)));
}

void cag_names_init(CagNames *n, CagArena *arena) {
  *n = (CagNames){arena, slots_new(FIRST_CAPACITY), FIRST_CAPACITY, 0};
}

void cag_names_release(CagNames *n) {
  cag_free(n->slots);
  n->slots = NULL;
}

static uint32_t hash_of(const char *bytes, size_t length) {
  uint32_t h = CAG_NAME_HASH;
  for (size_t i = 0; i < length; i++) h = cag_name_hash(h, (unsigned char)bytes[i]);
  return h;
}

static void grow(CagNames *n) {
  size_t capacity = 2 * n->capacity;
  CagNameHead **slots = slots_new(capacity);
  for (size_t i = 0; i < n->capacity; i++) {
    CagNameHead *head = n->slots[i];
    if (!head) continue;
    size_t k = head->hash & (capacity - 1);
    while (slots[k]) k = (k + 1) & (capacity - 1);
    slots[k] = head;
  }
  cag_free(n->slots);
  n->slots = slots;
  n->capacity = capacity;
}

CagNameHead *cag_names_intern(CagNames *n, const char *bytes, size_t length) {
  return cag_names_intern_hashed(n, bytes, length, hash_of(bytes, length));
}

CagNameHead *cag_names_intern_hashed(CagNames *n, const char *bytes, size_t length, uint32_t hash) {
  size_t k = hash & (n->capacity - 1);
  for (CagNameHead *head; (head = n->slots[k]); k = (k + 1) & (n->capacity - 1))
    if (head->hash == hash && head->length == length && memcmp(head->bytes, bytes, length) == 0)
      return head;
  CagNameHead *fresh = cag_arena_alloc(n->arena, sizeof *fresh + length + 1);
  fresh->hash = hash;
  fresh->index = (uint32_t)n->count++;
  fresh->length = (uint32_t)length;
  memcpy(fresh->bytes, bytes, length);
  n->slots[k] = fresh;
  if (2 * n->count > n->capacity) grow(n);
  return fresh;
}
