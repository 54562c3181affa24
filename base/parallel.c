#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdatomic.h>

#include "base/stop.h"

static atomic_int chosen; // 0: the number of processors

typedef struct Loop {
  size_t n;
  atomic_size_t next;
  void (*work)(void *context, size_t i, int thread);
  void *context;
  const volatile int *stop;
} Loop;

typedef struct Worker {
  Loop *loop;
  int thread;
  pthread_t id;
} Worker;

static int processor_count(void) {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  const int n = CPU_COUNT(&set);
  return n < 1 ? 1 : n > CAG_THREADS_MAX ? CAG_THREADS_MAX : n;
}

int cag_thread_count(void) {
  const int n = atomic_load(&chosen);
  return n > 0 ? n : processor_count();
}

void cag_set_thread_count(int n) {
  atomic_store(&chosen, n < 0 ? 0 : n > CAG_THREADS_MAX ? CAG_THREADS_MAX : n);
}

static void run_iterations(Loop *loop, int thread) {
  for (size_t i; (i = atomic_fetch_add(&loop->next, 1)) < loop->n;)
    loop->work(loop->context, i, thread);
}

static void *run_worker(void *context) {
  Worker *w = context;
  cag_stop_lend(w->loop->stop);
  run_iterations(w->loop, w->thread);
  return NULL;
}

// Signals are for the thread that the host has chosen.
static int start_workers(Worker *workers, int wanted, Loop *loop) {
  sigset_t all, before;
  int started = 0;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  while (started < wanted) {
    workers[started] = (Worker){.loop = loop, .thread = started + 1};
    if (pthread_create(&workers[started].id, NULL, run_worker, &workers[started]) != 0) break;
    started++;
  }
  pthread_sigmask(SIG_SETMASK, &before, NULL);
  return started;
}

void cag_parallel(size_t n, void (*work)(void *context, size_t i, int thread), void *context) {
  Loop loop = {.n = n, .work = work, .context = context, .stop = cag_stop_flag};
  Worker workers[CAG_THREADS_MAX];
  int wanted = cag_thread_count() - 1;
  if ((size_t)wanted + 1 > n) wanted = n ? (int)n - 1 : 0;
  const int started = start_workers(workers, wanted, &loop);
  run_iterations(&loop, 0);
  for (int i = 0; i < started; i++) pthread_join(workers[i].id, NULL);
}
