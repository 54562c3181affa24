// Work that may run out of memory at any point, or be asked to stop (cag_source_check).
//
// A parser or a printer allocates in a hundred places. Such work runs in a guard: a failed
// allocation jumps out of the work, and the guard reports the failure. The caller of the guard
// releases everything reachable from its context, and cleanups release the rest. Guards can be
// nested, and each thread has its own.

#ifndef CAG_BASE_GUARD_H
#define CAG_BASE_GUARD_H

#include <stdbool.h>
#include <stddef.h>

// Runs work(context). Returns false if memory ran out and the work was abandoned.
bool cag_memory_guard(void (*work)(void *context), void *context);
// Abandons the work of this thread's innermost guard, after running the cleanups pushed in it.
// There must be a guard.
_Noreturn void cag_memory_leave(void);
// Returns `memory`, or abandons the work of the innermost guard if it is NULL.
void *cag_checked(void *memory);

// An action to run if the work is abandoned before the cleanup is popped. It is a local variable of
// the function that holds the resource. Cleanups are popped in reverse order.
typedef struct CagCleanup {
  struct CagCleanup *outer;
  void (*release)(void *what);
  void *what;
} CagCleanup;
void cag_cleanup_push(CagCleanup *c, void (*release)(void *what), void *what);
void cag_cleanup_pop(CagCleanup *c);
// Pops the cleanup and runs it.
void cag_cleanup_run(CagCleanup *c);
// Allocates n items that are freed when the cleanup runs.
void *cag_temporary(CagCleanup *c, size_t n, size_t size);

#endif
