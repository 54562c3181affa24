// Stops work that takes too long or that the caller interrupts.
//
// While work runs, a separate thread checks the clock and the caller's interrupt flag, and sets one
// stop flag for both. Everything that can run for long checks the stop flag: the machine's loop,
// the geometry core (base/stop.h), the writers of files, and the code that waits for a renderer.

#ifndef CAG_INTERP_SESSION_WATCH_H
#define CAG_INTERP_SESSION_WATCH_H

#include <pthread.h>
#include <stdbool.h>

typedef struct CagWatch {
  volatile int *stop;            // the flag
  const volatile int *interrupt; // may be NULL
  double seconds;                // the time limit; 0: no limit
  // Called once, on the watch's thread, if work continues long after its limit; may be NULL.
  void (*overdue)(void *context);
  void *context;
  // Private to the watch.
  pthread_t thread;
  pthread_mutex_t mutex;
  pthread_cond_t done;
  double begun;
  bool started, finished;
} CagWatch;

// Clears the stop flag and starts the watch described by `w`. If no thread can be created, nothing
// stops the work early.
void cag_watch_begin(CagWatch *w);
// Ends the watch, and returns the seconds that the work took.
double cag_watch_end(CagWatch *w);

#endif
