// Processes of a batch: what becomes of them, as a status and a line for the report.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/batch_child.h"
#include "cli/batch_result.h"
#include "tests/fuzz/failing.h"

volatile int cag_tool_interrupt;

static void wait_for(CagChild *c) {
  while (!cag_child_look(c)) poll(NULL, 0, 5);
}

// Runs a command of the shell as a task; gives the status, and the message in `out`.
static int run(const char *command, double limit, CagChildStop stop, char *out, size_t size) {
  char *words[] = {"sh", "-c", (char *)(size_t)command, NULL}, *message = NULL;
  CagChild c;
  assert_true(cag_child_start(&c, words, "/", limit, false));
  if (stop != CAG_CHILD_RUNS) {
    cag_child_stop(&c, stop);
    cag_child_stop(&c, CAG_CHILD_STOP_ASKED); // the first reason counts
  }
  wait_for(&c);
  const int status = cag_child_result(&c, limit, 64 << 20, &message);
  snprintf(out, size, "%s", message ? message : "");
  free(message);
  cag_child_free(&c);
  return status;
}

#define ERROR "{\"severity\":\"error\",\"code\":\"E0301\",\"message\":\"sin expects an angle\""
#define NO_CODE "{\"severity\":\"error\",\"code\":null,\"message\":\"no output\"}"
#define WARNING "{\"severity\":\"warning\",\"message\":\"unused\"}"
#define FIELDS "\"file\":\"a.cag\",\"line\":3}"

static void test_ends(void **state) {
  (void)state;
  static const struct {
    const char *command;
    int status;
    const char *message;
  } rows[] = {
      {"exit 0", 0, ""},
      {"echo told >&2; exit 0", 0, ""},
      {"exit 7", 7, "failed with exit status 7"},
      // what it writes to standard output is not kept
      {"echo out; exit 3", 3, "failed with exit status 3"},
      {"echo first >&2; echo last >&2; echo >&2; exit 3", 3, "last"},
      {"printf 'a\\rb' >&2; exit 3", 3, "a b"},
      {"pwd >&2; exit 1", 1, "/"},
      {"echo '" ERROR "," FIELDS "' >&2; echo more >&2; exit 1", 1,
       "a.cag:3: E0301: sin expects an angle"},
      {"echo '" ERROR "}' >&2; exit 1", 1, "E0301: sin expects an angle"},
      {"echo '" WARNING "' >&2; echo '" NO_CODE "' >&2; exit 2", 2, "no output"},
      {"echo '{\"severity\":\"error\"}' >&2; exit 2", 2, "{\"severity\":\"error\"}"},
      {"echo '{\"message\":\"m\"}' >&2; exit 2", 2, "{\"message\":\"m\"}"},
      {"echo '{torn' >&2; exit 2", 2, "{torn"},
      {"exec 2>&- ; sleep 0.1; exit 4", 4, "failed with exit status 4"},
      {"kill -KILL $$", 1, "killed by signal 9 (Killed); the system may have run out of memory"},
      {"kill -SEGV $$", 1, "ended by signal 11 (Segmentation fault)"},
      {"sleep 30 & exit 3", 3, "failed with exit status 3"},
      // a flood: its end is kept
      {"head -c 500000 /dev/zero | tr '\\0' x >&2; echo >&2; echo last >&2; exit 3", 3, "last"},
  };
  char message[1024];
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const int status = run(rows[i].command, 0, CAG_CHILD_RUNS, message, sizeof message);
    if (status != rows[i].status || strcmp(message, rows[i].message) != 0)
      print_error("%s: %d, \"%s\"\n", rows[i].command, status, message);
    assert_int_equal(status, rows[i].status);
    assert_string_equal(message, rows[i].message);
  }
}

static void test_limits(void **state) {
  (void)state;
  char message[1024];
  assert_int_equal(run("sleep 30", 0.2, CAG_CHILD_RUNS, message, sizeof message), 5);
  assert_string_equal(message, "exceeded the time limit of 0.2 s");
  assert_int_equal(run("sleep 30", 0, CAG_CHILD_STOP_MEMORY, message, sizeof message), 5);
  assert_string_equal(message, "exceeded the memory limit of 64 MB");
  // One that does not listen is killed.
  assert_int_equal(
      run("trap '' TERM; while :; do sleep 1; done", 0.2, CAG_CHILD_RUNS, message, sizeof message),
      5);
}

static int seven(void *context) {
  *(int *)context = 1; // of the copy
  return 7;
}

static void test_work(void **state) {
  (void)state;
  CagChild c;
  int here = 0;
  char *message;
  assert_true(cag_child_start_work(&c, seven, &here, 0));
  wait_for(&c);
  assert_int_equal(cag_child_result(&c, 0, 0, &message), 7);
  assert_int_equal(here, 0);
  assert_true(c.memory > 0);
  free(message);
  cag_child_free(&c);
}

static void test_run(void **state) {
  (void)state;
  char *text = NULL;
  char *good[] = {"sh", "-c", "echo out; echo err >&2; exit 3", NULL};
  assert_int_equal(cag_child_run(good, 10, NULL, &text), 3);
  assert_string_equal(text, "out\nerr\n");
  free(text);
  char *missing[] = {"/no/such/program", NULL};
  assert_int_equal(cag_child_run(missing, 10, NULL, &text), -1);
  free(text);
  char *slow[] = {"sleep", "30", NULL}, *killed[] = {"sh", "-c", "kill -KILL $$", NULL};
  assert_int_equal(cag_child_run(slow, 0.1, NULL, &text), -1);
  free(text);
  assert_int_equal(cag_child_run(killed, 0, NULL, &text), -1);
  free(text);
  volatile int interrupted = 1;
  assert_int_equal(cag_child_run(slow, 0, &interrupted, &text), -1);
  free(text);
  CagChild c;
  assert_true(cag_child_start(&c, good, "/no/such/folder", 0, false));
  wait_for(&c);
  assert_int_not_equal(c.status, 0);
  cag_child_free(&c);
}

// Without memory nothing starts, or some of what it said is lost.
static void test_failing_memory(void **state) {
  (void)state;
  char *words[] = {"sh", "-c", "echo '" ERROR "}' >&2; exit 3", NULL};
  for (size_t at = 1; at <= 8; at++) {
    CagChild c;
    char *message = NULL;
    made = 0;
    failing = at;
    const bool started = cag_child_start(&c, words, NULL, 0, false);
    int status = 3;
    if (started) {
      wait_for(&c);
      status = cag_child_result(&c, 0, 0, &message);
      cag_child_free(&c);
    }
    failing = 0;
    free(message);
    assert_int_equal(status, 3);
    assert_true(started == (at > 1));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ends),           cmocka_unit_test(test_limits),
      cmocka_unit_test(test_work),           cmocka_unit_test(test_run),
      cmocka_unit_test(test_failing_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
