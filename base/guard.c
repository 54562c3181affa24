// Guards against exhausted memory: a chain of jump targets for each thread.

#include "base/guard.h"

#include <setjmp.h>
#include <stdlib.h>

#include "base/memory.h"

typedef struct Guard {
  struct Guard *outer;
  CagCleanup *cleanups; // pushed before this guard
  jmp_buf left;
} Guard;

static _Thread_local Guard *innermost;
static _Thread_local CagCleanup *cleanups;

bool cag_memory_guard(void (*work)(void *context), void *context) {
  Guard g = {.outer = innermost, .cleanups = cleanups};
  innermost = &g;
  const bool done = setjmp(g.left) == 0;
  if (done) work(context);
  innermost = g.outer;
  cleanups = g.cleanups;
  return done;
}

_Noreturn void cag_memory_leave(void) {
  if (!innermost) abort(); // a bug: work that leaves must run in a guard
  while (cleanups != innermost->cleanups) cag_cleanup_run(cleanups);
  longjmp(innermost->left, 1);
}

void *cag_checked(void *memory) {
  if (!memory) cag_memory_leave();
  return memory;
}

void cag_cleanup_push(CagCleanup *c, void (*release)(void *what), void *what) {
  *c = (CagCleanup){cleanups, release, what};
  cleanups = c;
}

void cag_cleanup_pop(CagCleanup *c) { cleanups = c->outer; }

void cag_cleanup_run(CagCleanup *c) {
  cag_cleanup_pop(c);
  c->release(c->what);
}

void *cag_temporary(CagCleanup *c, size_t n, size_t size) {
  void *memory = cag_checked(cag_calloc(n ? n : 1, size));
  cag_cleanup_push(c, cag_free, memory);
  return memory;
}
