// Hashes of data, and an index that finds items by their hash.
//
// An index holds pairs of a hash and a number, usually the position of an item in an array. It does
// not know the items: the caller computes the hashes and compares the candidates. For example, to
// find a name in a list:
//
//     const uint64_t hash = cag_hash_text(CAG_HASH_START, name);
//     size_t i;
//     for (CagHashWalk w = cag_hash_walk(&index, hash); cag_hash_next(&w, &i);)
//       if (strcmp(list[i].name, name) == 0) return i;
//
// Numbers with equal hashes are found in the order in which they were added. A zeroed index is
// empty.

#ifndef CAG_BASE_HASH_H
#define CAG_BASE_HASH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The hash of an empty sequence. Each function below adds to a hash and returns the new one.
#define CAG_HASH_START UINT64_C(14695981039346656037)

uint64_t cag_hash_bytes(uint64_t hash, const void *bytes, size_t n);
// Adds the bytes of the text without its terminating zero.
uint64_t cag_hash_text(uint64_t hash, const char *text);
uint64_t cag_hash_word(uint64_t hash, uint64_t word);
// Equal numbers add the same, including 0 and -0.
uint64_t cag_hash_number(uint64_t hash, double x);

typedef struct CagHashSlot {
  uint64_t hash;
  size_t number; // plus 1; 0: the slot is free
} CagHashSlot;

typedef struct CagHashIndex {
  CagHashSlot *slots; // open addressing; at most half of the slots are in use
  size_t size, count; // the size is a power of two, or 0
} CagHashIndex;

// Makes room for n pairs in all, so that adding them cannot fail. Returns false if memory ran out;
// the index is then unchanged.
bool cag_hash_reserve(CagHashIndex *x, size_t n);
// Adds a pair. Returns false if memory ran out; the index is then unchanged.
bool cag_hash_add(CagHashIndex *x, uint64_t hash, size_t number);
void cag_hash_free(CagHashIndex *x);

// A walk over the numbers with one hash. Adding to the index ends it.
typedef struct CagHashWalk {
  const CagHashIndex *index;
  uint64_t hash;
  size_t at;
} CagHashWalk;

CagHashWalk cag_hash_walk(const CagHashIndex *x, uint64_t hash);
// Writes the next number to *number. Returns false at the end of the walk.
bool cag_hash_next(CagHashWalk *w, size_t *number);

#endif
