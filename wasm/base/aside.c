// Replaces base/aside.c where there are no threads: the caller does the work.

#include "base/aside.h"

bool cag_run_aside(void (*work)(void *data), void (*release)(void *data), void *data) {
  (void)release;
  work(data);
  return true;
}
