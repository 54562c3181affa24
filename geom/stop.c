// Long work is asked to end: the thread's flag.

#include "geom/stop.h"

_Thread_local const volatile int *cag_stop_flag;

const volatile int *cag_stop_lend(const volatile int *flag) {
  const volatile int *before = cag_stop_flag;
  cag_stop_flag = flag;
  return before;
}

CagStatus cag_stop_fail(CagError *err) {
  return cag_fail(err, CAG_E_CALLBACK, CAG_ERR_interrupted, "", -1, "it was stopped");
}
