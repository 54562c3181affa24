// The end of work that takes too long, or that somebody asked to end.
//
// While work runs, a thread of its own looks at the clock and at the caller's interrupt, and sets
// one flag for both. Everything that runs for long looks at this flag: the machine's loop, the
// geometry core (base/stop.h), writers of files, and who waits for a renderer.

#ifndef CAG_INTERP_SESSION_WATCH_H
#define CAG_INTERP_SESSION_WATCH_H

#include <pthread.h>
#include <stdbool.h>

typedef struct CagWatch {
  volatile int *stop;            // the flag
  const volatile int *interrupt; // may be NULL
  double seconds;                // that the work may take; 0: as long as it likes
  // Called once, on the thread of the watch, when work goes on long after its time; may be NULL.
  void (*overdue)(void *context);
  void *context;
  // Kept by the watch itself.
  pthread_t thread;
  pthread_mutex_t mutex;
  pthread_cond_t done;
  double begun;
  bool started, finished;
} CagWatch;

// Clears the flag and begins to watch; `w` holds what is asked for. Where the system gives no
// thread, nothing ends the work early.
void cag_watch_begin(CagWatch *w);
// Gives the seconds that the work took.
double cag_watch_end(CagWatch *w);

#endif
