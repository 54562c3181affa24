// Restricts a process to the files that it needs, through the kernel (Landlock, Linux 5.13 and
// later).
//
// A ruleset is prepared before fork, because it allocates memory, and is entered by the child
// before exec. If the kernel has no Landlock, nothing is restricted, and only the caller's own
// checks apply.

#ifndef CAG_INTERP_RENDER_SANDBOX_H
#define CAG_INTERP_RENDER_SANDBOX_H

#include <stdbool.h>
#include <stddef.h>

// Prepares a ruleset: everything below the `readable` paths can be read and executed, and
// everything below `folder` can also be written. Paths that do not exist are skipped. Returns a
// file descriptor to close, or -1 if the kernel has no Landlock.
int cag_sandbox_prepare(const char *const *readable, size_t count, const char *folder);

// Restricts this process and its children permanently. Async-signal-safe. Returns true for the
// descriptor -1.
bool cag_sandbox_enter(int ruleset);

#endif
