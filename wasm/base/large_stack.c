// Replaces base/large_stack.c in a browser, which gives the program one thread.
//
// WebAssembly has two stacks. The one in memory has a fixed size (WASM_STACK in wasm/build.mk). The
// other belongs to the browser, which ends the program if it overflows. Its size and use are
// unknown, so the levels of recursion are counted: those that ask for room. The recursions of
// tests/web/playground.mjs and playground_page.js end in an error of the script.

#include "base/large_stack.h"

// Some built-ins need more than 1 KiB of the first stack for each level.
#define STACK_BYTES ((size_t)2 << 20)
// A level takes up to 1 KiB of the second stack, which has about 1 MiB.
#define LEVELS_MOST 800

// Where the levels have asked that are under way, from the first to the last: descending addresses.
static const char *levels[LEVELS_MOST];
static size_t level_count;

bool cag_large_stack_run(void (*work)(void *context, char *low), void *context) {
  char here;
  level_count = 0;
  work(context, &here - STACK_BYTES);
  return true;
}

bool cag_large_stack_has_room(const char *here, const char *low, size_t reserve) {
  // Levels that are not above this one have ended.
  while (level_count > 0 && levels[level_count - 1] <= here) level_count--;
  if (level_count == LEVELS_MOST || here - low <= (ptrdiff_t)reserve) return false;
  levels[level_count++] = here;
  return true;
}
