// Stopping long work: the thread's stop flag.

#include "base/stop.h"

#include <string.h>

_Thread_local const volatile int *cag_stop_flag;

const volatile int *cag_stop_lend(const volatile int *flag) {
  const volatile int *before = cag_stop_flag;
  cag_stop_flag = flag;
  return before;
}

CagStatus cag_stop_fail(CagError *err) {
  // Does not call cag_fail, because loops that ignore failures should end quickly.
  err->status = CAG_E_CALLBACK;
  err->id = CAG_ERR_interrupted;
  err->argument[0] = 0;
  err->index = -1;
  err->help[0] = 0;
  strcpy(err->message, "it was interrupted");
  return err->status;
}
