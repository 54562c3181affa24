// The thread that checks the clock while work runs.

#include "interp/session/watch.h"

#include <errno.h>
#include <math.h>
#include <time.h>

#include "base/clock.h"

// Seconds between checks of the interrupt flag, because a signal handler that sets it wakes no
// thread.
#define LOOK_INTERVAL 0.02

// Seconds after the limit until work counts as overdue. Work that checks the flag has ended long
// before.
#define OVERDUE 0.6

// Waits, with the mutex held, until the work is done or this many seconds have passed.
static void wait_for_end(CagWatch *w, double seconds) {
  const double until = cag_clock_seconds() + fmax(seconds, 0), whole = floor(until);
  const struct timespec t = {(time_t)whole, (long)((until - whole) * 1e9)};
  while (!w->finished && pthread_cond_timedwait(&w->done, &w->mutex, &t) != ETIMEDOUT) {}
}

static void *watch(void *context) {
  CagWatch *w = context;
  bool told = !w->overdue;
  pthread_mutex_lock(&w->mutex);
  while (!w->finished) {
    const double passed = cag_clock_seconds() - w->begun;
    const bool late = w->seconds > 0 && passed >= w->seconds;
    if (late || (w->interrupt && *w->interrupt)) *w->stop = 1;
    if (late && !told && passed >= w->seconds + OVERDUE) {
      told = true;
      w->overdue(w->context);
    }
    const double left = w->seconds > 0 && !late ? w->seconds - passed : LOOK_INTERVAL;
    wait_for_end(w, fmin(left, LOOK_INTERVAL));
  }
  pthread_mutex_unlock(&w->mutex);
  return NULL;
}

void cag_watch_begin(CagWatch *w) {
  pthread_condattr_t attributes;
  // An interrupt that came before is not left to the thread, which may be slower than the work.
  *w->stop = w->interrupt && *w->interrupt;
  w->begun = cag_clock_seconds();
  w->finished = false;
  pthread_mutex_init(&w->mutex, NULL);
  pthread_condattr_init(&attributes);
  pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
  pthread_cond_init(&w->done, &attributes);
  pthread_condattr_destroy(&attributes);
  w->started = (w->seconds > 0 || w->interrupt) && pthread_create(&w->thread, NULL, watch, w) == 0;
}

double cag_watch_end(CagWatch *w) {
  pthread_mutex_lock(&w->mutex);
  w->finished = true;
  pthread_cond_signal(&w->done);
  pthread_mutex_unlock(&w->mutex);
  if (w->started) pthread_join(w->thread, NULL);
  pthread_cond_destroy(&w->done);
  pthread_mutex_destroy(&w->mutex);
  return cag_clock_seconds() - w->begun;
}
