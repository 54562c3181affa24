// Work that may run out of memory anywhere.
//
// A parser or a printer allocates in a hundred places, each of which would have to tell its callers
// that there was no memory. Such work runs in a guard instead: a failed allocation leaves the work
// by a jump, and the guard reports it. What the work has taken is released by who called the guard,
// where its context leads there, or else by a cleanup. Guards nest, and each thread has its own.

#ifndef CAG_LANG_MEMORY_H
#define CAG_LANG_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

// Runs work(context). False: memory ran out, and the work was left where it stood.
bool cag_memory_guard(void (*work)(void *context), void *context);
// Leaves the work of this thread's innermost guard, after the cleanups pushed in it. There must be
// one.
_Noreturn void cag_memory_leave(void);
// The same memory; leaves the innermost guard when it is NULL.
void *cag_checked(void *memory);

// What is to be done when the work is left before the cleanup is popped: a variable of the function
// that holds what is to be released. The last one pushed is popped first.
typedef struct CagCleanup {
  struct CagCleanup *outer;
  void (*release)(void *what);
  void *what;
} CagCleanup;
void cag_cleanup_push(CagCleanup *c, void (*release)(void *what), void *what);
void cag_cleanup_pop(CagCleanup *c);
// Pops it, and does it.
void cag_cleanup_run(CagCleanup *c);
// Memory for n things, freed when the cleanup runs.
void *cag_temporary(CagCleanup *c, size_t n, size_t size);

#endif
