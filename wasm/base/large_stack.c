// Replaces base/large_stack.c where there are no threads.
//
// WebAssembly has two stacks. The one in memory has a fixed size (STACK in wasm/build.mk). The other
// belongs to the browser, which ends the program if it overflows. Its size and use are unknown, but
// it grows with the first one, so less of the first one is used than there is.

#include "base/large_stack.h"

#include <stddef.h>

// Chosen by measurement: the recursions of tests/web/playground.mjs end in an error of the script.
// They need at most half of the stack of a worker in Chromium, whose stack is the smallest.
#define STACK_BYTES ((size_t)704 << 10)

bool cag_large_stack_run(void (*work)(void *context, char *low), void *context) {
  char here;
  work(context, &here - STACK_BYTES);
  return true;
}
