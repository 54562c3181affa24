// Arenas: memory for many small allocations that are freed together.

#ifndef CAG_BASE_ARENA_H
#define CAG_BASE_ARENA_H

#include <stddef.h>

#include "base/guard.h"

typedef struct CagArenaBlock CagArenaBlock;
typedef struct CagArena {
  CagArenaBlock *first;
} CagArena;

// Returns zeroed, aligned memory. If memory runs out, abandons the work (base/guard.h).
void *cag_arena_alloc(CagArena *a, size_t size);
char *cag_arena_copy(CagArena *a, const char *bytes, size_t length); // NUL-terminated copy
void cag_arena_free(CagArena *a);
// Invalidates all allocations, but keeps one block for later ones.
void cag_arena_reset(CagArena *a);

#endif
