// The number of concurrent processes of a batch, from files like those of /proc. proc(5) describes
// their fields.

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/batch_load.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

static char folder[] = "/tmp/cag-load-XXXXXX";

static void write_file(const char *name, const char *text) {
  FILE *f = fopen(name, "w");
  assert_non_null(f);
  assert_true(fputs(text, f) >= 0);
  assert_int_equal(fclose(f), 0);
}

static int begin(void **state) {
  (void)state;
  return mkdtemp(folder) ? chdir(folder) : -1;
}

static int end(void **state) {
  (void)state;
  static const char *const files[] = {"stat",   "meminfo",   "loadavg", "7/stat", "8/stat",
                                      "9/stat", "10/stat",   "7",       "8",      "9",
                                      "10",     "self/stat", "self"};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) remove(files[i]);
  return chdir("/") ? -1 : rmdir(folder);
}

#define PLENTY "MemTotal: 1000000 kB\nMemFree: 1 kB\nMemAvailable: 900000 kB\nBuffers: 3 kB\n"
#define NONE_RUNNABLE "0.5 0.4 0.3 1/500 4242\n"
#define MANY_RUNNABLE "0.5 0.4 0.3 400/500 4242\n"

static size_t processors(void) { return (size_t)sysconf(_SC_NPROCESSORS_ONLN); }

static CagLoad load_of(size_t workers) {
  CagLoad l;
  cag_load_begin(&l, workers, folder);
  return l;
}

// The limit when the load is measured this many seconds after the previous time.
static size_t limit_after(CagLoad *l, double seconds, size_t running, size_t waiting) {
  l->looked -= seconds;
  l->seen -= seconds;
  return cag_load_limit(l, running, waiting);
}

// --- Fractions of time ---

typedef struct Share {
  int niceness;
  const char *before, *after;
  bool idle;
} Share;

#define START "cpu 1000 2000 3000 4000 5000 6000 7000 8000 0 0\ncpu0 1 2 3 4\n"

// Below 95 % utilization, the processors count as idle.
static const Share SHARES[] = {
    {0, START, "cpu 1100 2000 3000 4000 5000 6000 7000 8000 0 0\n", false},
    {0, START, "cpu 1096 2000 3000 4004 5000 6000 7000 8000 0 0\n", false},
    {0, START, "cpu 1094 2000 3000 4006 5000 6000 7000 8000 0 0\n", true},
    // waiting for a disk is idle, too
    {0, START, "cpu 1096 2000 3000 4000 5004 6000 7000 8000 0 0\n", false},
    {0, START, "cpu 1094 2000 3000 4000 5006 6000 7000 8000 0 0\n", true},
    {0, START, "cpu 1094 2000 3000 4003 5003 6000 7000 8000 0 0\n", true},
    // time of the system, interrupts, and other guests of the machine is busy
    {0, START, "cpu 1000 2000 3096 4004 5000 6000 7000 8000 0 0\n", false},
    {0, START, "cpu 1000 2000 3000 4004 5000 6096 7000 8000 0 0\n", false},
    {0, START, "cpu 1000 2000 3000 4004 5000 6000 7096 8000 0 0\n", false},
    {0, START, "cpu 1000 2000 3000 4004 5000 6000 7000 8096 0 0\n", false},
    // fewer fields of older kernels
    {0, "cpu 10 20 30 40\n", "cpu 104 20 30 46\n", true},
    {0, "cpu 10 20 30 40\n", "cpu 106 20 30 44\n", false},
    {0, "cpu 10 20 30\n", "cpu 10 20 30\n", false},
    {0, "cpu 10 20 30\n", "cpu 10 20 40\n", false},
    // unreadable data, and no elapsed time
    {0, START, "intr 1100 2000 3000 4900 5000 6000 7000 8000 0 0\n", false},
    {0, START, START, false},
    // processes with lower priority count as idle, and those with higher priority as busy
    {0, START, "cpu 1050 2050 3000 4000 5000 6000 7000 8000 0 0\n", true},
    {1, START, "cpu 1050 2050 3000 4000 5000 6000 7000 8000 0 0\n", false},
    {1, START, "cpu 1044 2050 3000 4006 5000 6000 7000 8000 0 0\n", true},
};

static void shares_of_time_tell_an_idle_processor(void **state) {
  (void)state;
  write_file("meminfo", PLENTY);
  write_file("loadavg", MANY_RUNNABLE);
  setpriority(PRIO_PROCESS, 0, 0); // other users may not be allowed to do this at a lower priority
  for (size_t i = 0; i < sizeof SHARES / sizeof *SHARES; i++) {
    const Share *row = &SHARES[i];
    if (row->niceness) setpriority(PRIO_PROCESS, 0, row->niceness);
    const int niceness = getpriority(PRIO_PROCESS, 0);
    if ((niceness > 0) != (row->niceness > 0)) continue;
    write_file("stat", row->before);
    CagLoad l = load_of(processors());
    write_file("stat", row->after);
    const size_t limit = limit_after(&l, 1, processors(), 1000);
    if ((limit > processors()) != row->idle) fail_msg("row %zu: limit %zu", i, limit);
  }
}

// Fractions measured over less than 0.15 s are ignored, because the kernel counts in ticks of 0.01
// s.
static void shares_need_a_while(void **state) {
  (void)state;
  write_file("meminfo", PLENTY);
  write_file("loadavg", MANY_RUNNABLE);
  write_file("stat", START);
  CagLoad l = load_of(processors());
  write_file("stat", "cpu 1000 2000 3000 4100 5000 6000 7000 8000 0 0\n");
  assert_int_equal(limit_after(&l, 0.1, processors(), 1000), processors());
  assert_true(limit_after(&l, 0.1, processors(), 1000) > processors());
}

// --- Running threads ---

typedef struct Runnable {
  const char *text;
  bool idle;
} Runnable;

static void few_runnable_threads_leave_a_processor_idle(void **state) {
  (void)state;
  // The measuring thread is one of them.
  static const Runnable rows[] = {
      {"0.1 0.2 0.3 0/90 7\n", true},
      {"0.1 0.2 0.3 1/90 7\n", true},
      {"0.1 0.2 0.3 4/90 7\n", true},
      {"0.1 0.2 0.3 5/90 7\n", false},
      {"0.1 0.2 0.3 60/90 7\n", false},
      {"0.1 0.2 0.3\n", false},
      {"none\n", false},
      {"", false},
  };
  write_file("meminfo", PLENTY);
  write_file("stat", START);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    write_file("loadavg", rows[i].text);
    CagLoad l = load_of(4);
    const size_t limit = limit_after(&l, 0.1, 4, 1000);
    if ((limit > 4) != rows[i].idle) fail_msg("%s: limit %zu", rows[i].text, limit);
  }
  remove("loadavg");
  CagLoad l = load_of(4);
  assert_int_equal(limit_after(&l, 0.1, 4, 1000), 4);
}

// --- The number of processes ---

static void the_limit_grows_while_a_processor_is_idle_and_sinks_while_none_is(void **state) {
  (void)state;
  write_file("meminfo", PLENTY);
  write_file("stat", START);
  write_file("loadavg", NONE_RUNNABLE);
  CagLoad l = load_of(2), large = load_of(16);
  assert_int_equal(limit_after(&l, 0, 0, 1000), 2);
  assert_int_equal(limit_after(&l, 0.01, 2, 1000), 3);       // by at least one
  assert_int_equal(limit_after(&large, 0.01, 16, 1000), 18); // by an eighth
  // The limit does not rise if it was not reached.
  assert_int_equal(limit_after(&l, 0.01, 2, 1000), 3);
  // At most six per processor until one has ended, and then 32.
  assert_int_equal(limit_after(&l, 0.01, 11, 1000), 12);
  assert_int_equal(limit_after(&l, 0.01, 12, 1000), 12);
  cag_load_ended(&l, 1000);
  assert_int_equal(limit_after(&l, 0.01, 12, 1000), 13);
  assert_int_equal(limit_after(&l, 0.01, 63, 1000), 64);
  assert_int_equal(limit_after(&l, 0.01, 64, 1000), 64);
  // By one in two seconds, but never below one per processor.
  write_file("loadavg", MANY_RUNNABLE);
  assert_int_equal(limit_after(&l, 1.9, 64, 1000), 63);
  assert_int_equal(limit_after(&l, 2.2, 64, 1000), 61);
  assert_int_equal(limit_after(&l, 1000, 61, 1000), 2);
  cag_load_refused(&l, 5);
  assert_int_equal(cag_load_limit(&l, 4, 1000), 5);
}

// If processes sleep, all waiting ones are started at once, up to the limit.
static void the_last_of_a_batch_of_sleepers_begin_at_once(void **state) {
  (void)state;
  write_file("meminfo", PLENTY);
  write_file("stat", START);
  write_file("loadavg", MANY_RUNNABLE);
  CagLoad l = load_of(4);
  cag_load_refused(&l, 8);
  assert_int_equal(cag_load_limit(&l, 6, 8), 8); // none of them has ended
  cag_load_ended(&l, 1000);
  assert_int_equal(cag_load_limit(&l, 6, 9), 8);
  assert_int_equal(cag_load_limit(&l, 6, 8), 14);
  assert_int_equal(cag_load_limit(&l, 6, 1), 8);
  cag_load_refused(&l, 7);
  assert_int_equal(cag_load_limit(&l, 6, 7), 7);
}

// --- Memory ---

static void further_processes_need_free_memory(void **state) {
  (void)state;
  static const struct {
    const char *meminfo;
    size_t largest, running, limit; // 8 are allowed
  } rows[] = {
      {"MemTotal: 1000000 kB\nMemAvailable: 260000 kB\n", 1024, 5, 8},
      {"MemTotal: 1000000 kB\nMemAvailable: 240000 kB\n", 1024, 5, 5},
      {"MemTotal: 1000000 kB\nMemAvailable: 240000 kB\n", 1024, 3, 4}, // one per processor
      {"MemTotal: 1000000 kB\n", 1024, 5, 5},
      {"", 1024, 5, 5},
      // six may use three quarters of it, 122880 kB each
      {"MemTotal: 1000000 kB\nMemAvailable: 900000 kB\n", (size_t)124000 << 10, 5, 8},
      {"MemTotal: 1000000 kB\nMemAvailable: 900000 kB\n", (size_t)126000 << 10, 5, 5},
      {"MemTotal: 1000000 kB\nMemAvailable: 900000 kB\n", (size_t)126000 << 10, 4, 8},
  };
  write_file("stat", START);
  write_file("loadavg", MANY_RUNNABLE);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    write_file("meminfo", rows[i].meminfo);
    CagLoad l = load_of(4);
    cag_load_refused(&l, 8);
    cag_load_ended(&l, rows[i].largest);
    cag_load_ended(&l, 1);
    const size_t limit = cag_load_limit(&l, rows[i].running, 1000);
    if (limit != rows[i].limit) fail_msg("row %zu: limit %zu", i, limit);
  }
}

static void write_process(const char *number, const char *name, int parent, int pages) {
  char path[64], text[512];
  assert_int_equal(mkdir(number, 0700), 0);
  snprintf(path, sizeof path, "%s/stat", number);
  snprintf(text, sizeof text,
           "%s (%s) S %d 11 12 13 14 4194304 21 22 23 24 31 32 33 34 20 0 1 0 555 66666 %d 777\n",
           number, name, parent, pages);
  write_file(path, text);
}

static void memory_is_that_of_a_process_and_its_children(void **state) {
  (void)state;
  write_process("7", "cag", 1, 100);
  write_process("8", "a ) name (", 7, 20); // names may contain any characters
  write_process("9", "grandchild", 8, 3);
  write_process("10", "other", 1, 5000);
  write_process("self", "no number", 7, 60000);
  const size_t page = (size_t)sysconf(_SC_PAGESIZE);
  const pid_t processes[] = {8, 7, 77};
  size_t bytes[] = {1, 2, 3};
  cag_load_memory(folder, processes, 3, bytes);
  assert_int_equal(bytes[0], 23 * page);
  assert_int_equal(bytes[1], 120 * page);
  assert_int_equal(bytes[2], 0);
  cag_load_memory("none", processes, 3, bytes);
  assert_int_equal(bytes[0] + bytes[1] + bytes[2], 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shares_of_time_tell_an_idle_processor),
      cmocka_unit_test(shares_need_a_while),
      cmocka_unit_test(few_runnable_threads_leave_a_processor_idle),
      cmocka_unit_test(the_limit_grows_while_a_processor_is_idle_and_sinks_while_none_is),
      cmocka_unit_test(the_last_of_a_batch_of_sleepers_begin_at_once),
      cmocka_unit_test(further_processes_need_free_memory),
      cmocka_unit_test(memory_is_that_of_a_process_and_its_children),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
