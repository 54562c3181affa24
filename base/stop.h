// Long work is asked to end.
//
// Who begins work on a thread lends it a flag, and takes it back at the end; loops that may run for
// long look at it now and then, and fail with CAG_E_CALLBACK, "interrupted", when it is not 0. Why
// it was set (a Ctrl-C, a limit of time) is known to who set it. The flag belongs to the thread, as
// its stack does: threads know nothing of each other's, and work without a flag never ends early.
//
// A loop whose length depends on input asks at least once in some milliseconds. Functions without a
// status return early instead, and their callers ask. Their results are then valid but meaningless.

#ifndef CAG_BASE_STOP_H
#define CAG_BASE_STOP_H

#include "base/status.h"

extern _Thread_local const volatile int *cag_stop_flag; // NULL: none

// Lends the thread a flag (NULL: none); gives the one that it had.
const volatile int *cag_stop_lend(const volatile int *flag);

static inline bool cag_stopped(void) { return cag_stop_flag && *cag_stop_flag; }

CagStatus cag_stop_fail(CagError *err);

// Fails when the work is to end.
static inline CagStatus cag_stop_check(CagError *err) {
  return cag_stopped() ? cag_stop_fail(err) : CAG_OK;
}

#endif
