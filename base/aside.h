// Work of libraries that cannot be interrupted.
//
// A library such as GLU or cJSON may work for seconds on large input, and has no way to stop. Such
// work runs on a thread of its own. If the run must end meanwhile, its caller returns at once, and
// the thread finishes alone and releases what it holds.

#ifndef CAG_BASE_ASIDE_H
#define CAG_BASE_ASIDE_H

#include <stdbool.h>

// Runs work(data) on another thread, and waits for it. Returns true when the work is done; `data`
// is then the caller's. Returns false if the caller's thread is asked to stop (base/stop.h) before;
// `data` then belongs to the other thread, which calls release(data) when the work has ended, so
// the work must not use anything of the caller. The other thread has no account: what it allocates
// is not charged (see cag_adopt), and what it releases is not credited. If there can be no thread,
// the work runs on the caller's, and the result is true.
bool cag_run_aside(void (*work)(void *data), void (*release)(void *data), void *data);

#endif
