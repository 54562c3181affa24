// Work that needs a large C stack.

#ifndef CAG_BASE_LARGE_STACK_H
#define CAG_BASE_LARGE_STACK_H

#include <stdbool.h>
#include <stddef.h>

// Runs work(context, low) on a thread with a large stack and waits for it. `low` is the lowest
// address that the stack may reach. The stack takes memory only where it is used. Returns false if
// no such thread can be created; the work has not started then.
bool cag_large_stack_run(void (*work)(void *context, char *low), void *context);
// Returns whether such work may go deeper: whether there are more than `reserve` bytes between
// `here`, the address of a local variable, and `low`. Recursive work asks this at each level.
bool cag_large_stack_has_room(const char *here, const char *low, size_t reserve);

#endif
