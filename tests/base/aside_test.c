// Work on a separate thread, which the caller may abandon.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <time.h>

#include "base/aside.h"
#include "base/clock.h"
#include "base/stop.h"

static void wait_seconds(double seconds) {
  const struct timespec t = {(time_t)seconds, (long)(1e9 * (seconds - (double)(time_t)seconds))};
  nanosleep(&t, NULL);
}

typedef struct Job {
  double seconds;
  pthread_t thread;
  atomic_int ended, released;
} Job;

static void work(void *data) {
  Job *job = data;
  job->thread = pthread_self();
  wait_seconds(job->seconds);
  job->ended++;
}

static void release(void *data) { ((Job *)data)->released++; }

static void work_runs_on_another_thread_to_its_end(void **state) {
  (void)state;
  for (int round = 0; round < 50; round++) {
    Job job = {.seconds = round == 0 ? 0.03 : 0};
    assert_true(cag_run_aside(work, release, &job));
    assert_int_equal(job.ended, 1);
    assert_int_equal(job.released, 0);
    assert_false(pthread_equal(job.thread, pthread_self()));
  }
}

static void a_caller_that_must_stop_leaves_the_work_behind(void **state) {
  (void)state;
  static Job jobs[5];
  volatile int stop = 1;
  cag_stop_lend(&stop);
  for (int i = 0; i < 5; i++) {
    jobs[i].seconds = 0.3;
    const double start = cag_clock_seconds();
    assert_false(cag_run_aside(work, release, &jobs[i]));
    assert_true(cag_clock_seconds() - start < 0.2);
    assert_int_equal(jobs[i].released, 0);
  }
  cag_stop_lend(NULL);
  for (int i = 0; i < 5; i++) {
    for (int k = 0; k < 1000 && !jobs[i].released; k++) wait_seconds(0.01);
    assert_int_equal(jobs[i].ended, 1);
    assert_int_equal(jobs[i].released, 1);
  }
}

static volatile int late_stop;
static void *stop_soon(void *none) {
  wait_seconds(0.05);
  late_stop = 1;
  return none;
}

static void a_stop_is_noticed_while_the_work_runs(void **state) {
  (void)state;
  static Job job = {.seconds = 0.5};
  pthread_t thread;
  cag_stop_lend(&late_stop);
  pthread_create(&thread, NULL, stop_soon, NULL);
  const double start = cag_clock_seconds();
  assert_false(cag_run_aside(work, release, &job));
  assert_true(cag_clock_seconds() - start < 0.4);
  cag_stop_lend(NULL);
  pthread_join(thread, NULL);
  for (int k = 0; k < 1000 && !job.released; k++) wait_seconds(0.01);
  assert_int_equal(job.released, 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(work_runs_on_another_thread_to_its_end),
      cmocka_unit_test(a_caller_that_must_stop_leaves_the_work_behind),
      cmocka_unit_test(a_stop_is_noticed_while_the_work_runs),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
