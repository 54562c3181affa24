// Replaces base/aside.c in a browser, which gives the program one thread: the caller does the work.

#include "base/aside.h"

bool cag_run_aside(void (*work)(void *data), void (*release)(void *data), void *data) {
  (void)release;
  work(data);
  return true;
}
