// Library calls that cannot be interrupted: they run on a thread that the caller can abandon.

#include "base/aside.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

#include "base/stop.h"

// How often the caller checks whether it must stop.
#define CHECK_NANOSECONDS 10000000

typedef struct Aside {
  pthread_mutex_t mutex;
  pthread_cond_t ended;
  bool done, left; // the work has ended; the caller has returned early
  void (*work)(void *data);
  void (*release)(void *data);
  void *data;
} Aside;

static void free_aside(Aside *a) {
  pthread_mutex_destroy(&a->mutex);
  pthread_cond_destroy(&a->ended);
  free(a);
}

static Aside *new_aside(void (*work)(void *data), void (*release)(void *data), void *data) {
  Aside *a = malloc(sizeof *a); // may outlive the account of the caller
  if (!a) return NULL;
  *a = (Aside){.work = work, .release = release, .data = data};
  pthread_condattr_t steady;
  pthread_condattr_init(&steady);
  pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
  pthread_mutex_init(&a->mutex, NULL);
  pthread_cond_init(&a->ended, &steady);
  pthread_condattr_destroy(&steady);
  return a;
}

static void *run_work(void *context) {
  Aside *a = context;
  a->work(a->data);
  pthread_mutex_lock(&a->mutex);
  a->done = true;
  const bool left = a->left;
  pthread_cond_signal(&a->ended);
  pthread_mutex_unlock(&a->mutex);
  if (!left) return NULL; // the caller is waiting and frees it
  a->release(a->data);
  free_aside(a);
  return NULL;
}

// Starts the thread with all signals blocked, so that the program's own threads handle them.
static bool start_thread(Aside *a, pthread_t *thread) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const bool started = pthread_create(thread, NULL, run_work, a) == 0;
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return started;
}

// Waits until the work has ended, or the caller must stop. Returns whether it has ended.
static bool wait_for(Aside *a) {
  pthread_mutex_lock(&a->mutex);
  while (!a->done && !cag_stopped()) {
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += CHECK_NANOSECONDS;
    if (until.tv_nsec >= 1000000000) {
      until.tv_nsec -= 1000000000;
      until.tv_sec++;
    }
    pthread_cond_timedwait(&a->ended, &a->mutex, &until);
  }
  const bool done = a->done;
  a->left = !done;
  pthread_mutex_unlock(&a->mutex);
  return done;
}

bool cag_run_aside(void (*work)(void *data), void (*release)(void *data), void *data) {
  Aside *a = new_aside(work, release, data);
  pthread_t thread;
  if (!a || !start_thread(a, &thread)) {
    if (a) free_aside(a);
    work(data);
    return true;
  }
  if (!wait_for(a)) {
    pthread_detach(thread); // the thread frees it
    return false;
  }
  pthread_join(thread, NULL);
  free_aside(a);
  return true;
}
