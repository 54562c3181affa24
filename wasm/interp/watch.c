// Replaces interp/session/watch.c where there are no threads. Nothing sets the stop flag: the page
// ends a worker that runs too long.

#include "interp/session/watch.h"

#include "base/clock.h"

void cag_watch_begin(CagWatch *w) {
  *w->stop = w->interrupt && *w->interrupt;
  w->begun = cag_clock_seconds();
  w->finished = w->started = false;
}

double cag_watch_end(CagWatch *w) {
  w->finished = true;
  return cag_clock_seconds() - w->begun;
}
