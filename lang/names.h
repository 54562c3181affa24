// Interned names: one string per different name of a tree, so that names compare as pointers.
//
// Each name carries its number (0, 1, 2 ... in the order of first appearance) and, when it is a
// reserved word, the token it makes; both are read back from the string's address. Strings live in
// the arena of the tree, the table only as long as the parser.

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

// The one string for these bytes (which are NFC already).
CagNameHead *cag_names_intern(CagNames *n, const char *bytes, size_t length);

// The same for a caller that has taken the hash while it looked for the end of the name: FNV-1a,
// from CAG_NAME_HASH on byte by byte.
CagNameHead *cag_names_intern_hashed(CagNames *n, const char *bytes, size_t length, uint32_t hash);
#define CAG_NAME_HASH 2166136261u
static inline uint32_t cag_name_hash(uint32_t hash, unsigned char byte) {
  return (hash ^ byte) * 16777619u;
}

static inline const CagNameHead *cag_name_head(const char *name) {
  return (const CagNameHead *)(const void *)(name - offsetof(CagNameHead, bytes));
}

#endif
