// Stopping long work.
//
// The caller registers a stop flag for the thread before it starts work, and restores the previous
// flag afterwards. Long loops poll the flag and fail with CAG_E_CALLBACK, "interrupted", once it is
// nonzero. The code that sets the flag knows the reason (Ctrl-C, a time limit). The flag is
// thread-local. Without one, work never ends early.
//
// A loop whose length depends on input polls at least every few milliseconds. Functions without a
// status return early instead, with a valid but meaningless result, and their callers poll.

#ifndef CAG_BASE_STOP_H
#define CAG_BASE_STOP_H

#include "base/status.h"

extern _Thread_local const volatile int *cag_stop_flag; // NULL: none

// Registers a flag for the thread (NULL: none). Returns the previous one.
const volatile int *cag_stop_lend(const volatile int *flag);

static inline bool cag_stopped(void) { return cag_stop_flag && *cag_stop_flag; }

CagStatus cag_stop_fail(CagError *err);

// Fails if the work is to stop.
static inline CagStatus cag_stop_check(CagError *err) {
  return cag_stopped() ? cag_stop_fail(err) : CAG_OK;
}

#endif
