// Interned names: one string for each different name of a tree, so that names can be compared as
// pointers.
//
// Each name has its number (0, 1, 2 ... in the order of first appearance) and, if it is a reserved
// word, its token; both are found from the string's address. Strings are in the arena of the tree,
// and the table lives only as long as the parser.

#ifndef CAG_LANG_NAMES_H
#define CAG_LANG_NAMES_H

#include "base/arena.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct CagNameHead {
  uint32_t hash, index, length, token; // token: 0 for an ordinary name
  char bytes[];
} CagNameHead;

typedef struct CagNames {
  CagArena *arena;
  CagNameHead **slots; // open addressing; a power of two, at most half full
  size_t capacity, count;
} CagNames;

void cag_names_init(CagNames *n, CagArena *arena);
void cag_names_release(CagNames *n);

// Returns the unique string for these bytes, which must be in NFC.
CagNameHead *cag_names_intern(CagNames *n, const char *bytes, size_t length);

// The same for callers that have computed the hash while they searched for the end of the name:
// FNV-1a, starting from CAG_NAME_HASH, byte by byte.
CagNameHead *cag_names_intern_hashed(CagNames *n, const char *bytes, size_t length, uint32_t hash);
#define CAG_NAME_HASH 2166136261u
static inline uint32_t cag_name_hash(uint32_t hash, unsigned char byte) {
  return (hash ^ byte) * 16777619u;
}

static inline const CagNameHead *cag_name_head(const char *name) {
  return (const CagNameHead *)(const void *)(name - offsetof(CagNameHead, bytes));
}

#endif
