// Arenas: a list of blocks, of which the first one is in use. Small allocations are cut from it one
// after the other.

#include "base/arena.h"

#include <stdalign.h>
#include <string.h>

#include "base/memory.h"

struct CagArenaBlock {
  CagArenaBlock *next;
  size_t used, size;
  alignas(max_align_t) char bytes[];
};

// Blocks grow from small (the REPL makes a tree for each line) to large (a generated script of many
// megabytes).
#define FIRST_BLOCK ((size_t)4 << 10)
#define LARGEST_BLOCK ((size_t)256 << 10)

static CagArenaBlock *block_new(size_t size) {
  CagArenaBlock *b = cag_checked(cag_calloc(1, sizeof *b + size));
  b->size = size;
  return b;
}

void *cag_arena_alloc(CagArena *a, size_t size) {
  const size_t unit = alignof(max_align_t);
  size = (size + unit - 1) / unit * unit;
  CagArenaBlock *b = a->first;
  if (!b || b->size - b->used < size) {
    size_t next = b ? 2 * b->size : FIRST_BLOCK;
    if (next > LARGEST_BLOCK) next = LARGEST_BLOCK;
    if (b && size > next / 4) { // a block of its own, after the one in use
      CagArenaBlock *own = block_new(size);
      own->used = size;
      own->next = b->next;
      b->next = own;
      return own->bytes;
    }
    CagArenaBlock *fresh = block_new(size > next ? size : next);
    fresh->next = b;
    a->first = b = fresh;
  }
  void *p = b->bytes + b->used;
  b->used += size;
  return p;
}

char *cag_arena_copy(CagArena *a, const char *bytes, size_t length) {
  char *copy = cag_arena_alloc(a, length + 1);
  if (length) memcpy(copy, bytes, length);
  return copy;
}

void cag_arena_reset(CagArena *a) {
  CagArenaBlock *kept = a->first;
  if (!kept) return;
  a->first = kept->next;
  cag_arena_free(a);
  memset(kept->bytes, 0, kept->used);
  kept->used = 0;
  kept->next = NULL;
  a->first = kept;
}

void cag_arena_free(CagArena *a) {
  while (a->first) {
    CagArenaBlock *b = a->first;
    a->first = b->next;
    cag_free(b);
  }
}
