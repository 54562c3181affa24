// Hash functions, and the index: open addressing with linear probes.

#include "base/hash.h"

#include <string.h>

#include "base/memory.h"

// FNV-1a (Fowler, Noll, Vo), 64 bits.
uint64_t cag_hash_bytes(uint64_t hash, const void *bytes, size_t n) {
  const unsigned char *at = bytes;
  for (size_t i = 0; i < n; i++) hash = (hash ^ at[i]) * UINT64_C(1099511628211);
  return hash;
}

uint64_t cag_hash_text(uint64_t hash, const char *text) {
  return cag_hash_bytes(hash, text, strlen(text));
}

// The finisher of MurmurHash3 (Appleby), in which every bit of the word changes half of the bits.
uint64_t cag_hash_word(uint64_t hash, uint64_t word) {
  uint64_t h = (hash ^ word) + UINT64_C(0x9e3779b97f4a7c15);
  h = (h ^ h >> 33) * UINT64_C(0xff51afd7ed558ccd);
  h = (h ^ h >> 33) * UINT64_C(0xc4ceb9fe1a85ec53);
  return h ^ h >> 33;
}

uint64_t cag_hash_number(uint64_t hash, double x) {
  uint64_t bits;
  if (x == 0) x = 0; // 0 and -0
  memcpy(&bits, &x, sizeof bits);
  return cag_hash_word(hash, bits);
}

// The low bits of a sum of bytes are the worst mixed, but the index uses them.
static size_t first_slot(const CagHashIndex *x, uint64_t hash) {
  return (size_t)(hash ^ hash >> 32) & (x->size - 1);
}

static void insert_slot(CagHashIndex *x, CagHashSlot s) {
  size_t at = first_slot(x, s.hash);
  while (x->slots[at].number) at = (at + 1) & (x->size - 1);
  x->slots[at] = s;
}

// Slots are moved in probe order, starting after a free slot, so that numbers with equal hashes
// keep their order.
static void move_slots(CagHashIndex *to, const CagHashIndex *from) {
  size_t start = 0;
  while (start < from->size && from->slots[start].number) start++;
  for (size_t i = 0; i < from->size; i++) {
    const CagHashSlot *s = &from->slots[(start + i) & (from->size - 1)];
    if (s->number) insert_slot(to, *s);
  }
}

bool cag_hash_reserve(CagHashIndex *x, size_t n) {
  CagHashIndex larger = {.size = x->size ? x->size : 16, .count = x->count};
  if (n > SIZE_MAX / 4 / sizeof *x->slots) return false;
  while (larger.size < 2 * n) larger.size *= 2;
  if (larger.size == x->size) return true;
  larger.slots = cag_calloc(larger.size, sizeof *larger.slots);
  if (!larger.slots) return false;
  move_slots(&larger, x);
  cag_free(x->slots);
  *x = larger;
  return true;
}

bool cag_hash_add(CagHashIndex *x, uint64_t hash, size_t number) {
  if (!cag_hash_reserve(x, x->count + 1)) return false;
  insert_slot(x, (CagHashSlot){hash, number + 1});
  x->count++;
  return true;
}

void cag_hash_free(CagHashIndex *x) {
  cag_free(x->slots);
  *x = (CagHashIndex){0};
}

CagHashWalk cag_hash_walk(const CagHashIndex *x, uint64_t hash) {
  return (CagHashWalk){x, hash, x->size ? first_slot(x, hash) : 0};
}

bool cag_hash_next(CagHashWalk *w, size_t *number) {
  const CagHashIndex *x = w->index;
  if (!x->size) return false;
  for (; x->slots[w->at].number; w->at = (w->at + 1) & (x->size - 1)) {
    if (x->slots[w->at].hash != w->hash) continue;
    *number = x->slots[w->at].number - 1;
    w->at = (w->at + 1) & (x->size - 1);
    return true;
  }
  return false;
}
