// Library calls that cannot be interrupted.
//
// A library such as GLU or cJSON may work for seconds on large input and cannot be stopped. Such
// work runs on a separate thread. If the run must end meanwhile, the caller returns at once, and
// the thread finishes in the background and releases its data.

#ifndef CAG_BASE_ASIDE_H
#define CAG_BASE_ASIDE_H

#include <stdbool.h>

// Runs work(data) on another thread and waits for it. Returns true if the work is done; the caller
// then owns `data`. Returns false if the caller's thread is asked to stop first (base/stop.h). The
// other thread then owns `data` and calls release(data) when the work ends, so the work must not
// use anything else of the caller's. The other thread has no account: its allocations are not
// charged (see cag_adopt), and what it frees is not credited. If no thread can be created, the work
// runs on the caller's thread, and the result is true.
bool cag_run_aside(void (*work)(void *data), void (*release)(void *data), void *data);

#endif
