// Interned names: one string per different name of a tree, so that names compare as pointers.
//
// Each name carries its number (0, 1, 2 ... in the order of first appearance) and, when it is a
// reserved word, the token it makes; both are read back from the string's address. Strings live in
// the arena of the tree, the table only as long as the parser.

#ifndef CAG_LANG_NAMES_H
#define CAG_LANG_NAMES_H

#include "lang/arena.h"

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

static inline const CagNameHead *cag_name_head(const char *name) {
  return (const CagNameHead *)(const void *)(name - offsetof(CagNameHead, bytes));
}

#endif
