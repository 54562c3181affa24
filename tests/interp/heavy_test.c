// All operations end soon after the time limit, or after an interrupt, in a program without another
// way to end them. Each script of heavy.def would run for many seconds.
//
// The time is not measured precisely, because a loaded machine or a sanitizer must not fail this
// test. It fails for operations that do not check whether they must end. What counts is the time
// of the processors, if it is less: a machine that stands still for seconds is no such operation.
// An operation that ended late runs again, because the first use of memory in a virtual machine
// may take seconds, which count as time of the processors. One that does not check is always late.
// The calls that are active a second after the limit are printed.

#include <dirent.h>
#include <execinfo.h>
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/clock.h"
#include "cag.h"

// Seconds until an operation must end, until it must have ended, and after which the test gives up.
#define LIMIT 0.15
#define LATE 8.0
#define HOPELESS 60
#define SUSPECT 1.0 // from the limit, until the place is printed
#define TRIALS 3    // so often is an operation late that fails the test

// Definitions that the scripts use.
static const char prelude[] =
    "wave(n) = [for i in 0..<n: [i, 100 * sin(i * 37deg), i % 7]]\n"
    "flat(n) = [for i in 0..<n: [i, 100 * sin(i * 37deg)]]\n"
    "net(n, m) = [for i in 0..<n: [for j in 0..<m: [i, j, 3 * sin(i * 31deg) * cos(j * 43deg)]]]\n"
    "square(n) = [for i in 0..<n: random(i, n, over: -0.01..0.01)]\n"
    "gon(n, r = 100) = [for i in 0..<n: (r + 10 * (i % 2)) * [cos(i * 360deg / n), sin(i * 360deg "
    "/ n)]]\n"
    "cloud(n) = [for [x, y, z] in zip(random(1, n, over: 0..100), random(2, n, over: 0..100), "
    "random(3, n, over: 0..100)): [x, y, z]]\n"
    "bumpy = surface((u, v) => [100 * u, 100 * v, sin(4000deg * u) * cos(5000deg * v)])\n"
    "arm(n) = robot([for i in 0..<n: revolute(a: 60, alpha: 30deg)])\n"
    "puma = robot([revolute(d: 432, alpha: -90deg), revolute(a: 432), revolute(a: 20, alpha: "
    "90deg), revolute(d: 432, alpha: -90deg), revolute(alpha: 90deg), revolute(d: 56.5)])\n";

typedef struct Heavy {
  const char *script;
  const char *output; // the format of the slow export; NULL: the script itself is slow
} Heavy;

#define HEAVY(script, output) {script, output},
static const Heavy scripts[] = {
#include "tests/interp/heavy.def"
};
#undef HEAVY
#define COUNT (sizeof scripts / sizeof *scripts)

static char folder[] = "/tmp/cag-heavy-XXXXXX";
static volatile int interrupt;
static const char *now_running;

static void give_up(int signal) {
  (void)signal;
  static const char words[] = " does not end\n";
  if (write(STDERR_FILENO, now_running, strlen(now_running)) < 0 ||
      write(STDERR_FILENO, words, sizeof words - 1) < 0)
    _exit(2);
  _exit(1);
}

// Prints the calls of the thread.
static void write_place(int signal) {
  (void)signal;
  void *calls[64];
  backtrace_symbols_fd(calls, backtrace(calls, sizeof calls / sizeof *calls), STDERR_FILENO);
}

static timer_t suspicion;

// Tells where each thread is.
static void write_places(union sigval unused) {
  (void)unused;
  DIR *tasks = opendir("/proc/self/task");
  fprintf(stderr, "%s\n  is late; its threads are in\n", now_running);
  for (const struct dirent *task; tasks && (task = readdir(tasks));) {
    const pid_t id = (pid_t)atol(task->d_name);
    if (id != 0 && id != gettid()) tgkill(getpid(), id, SIGUSR1);
  }
  if (tasks) closedir(tasks);
}

static int prepare_places(void) {
  struct sigevent by_thread = {.sigev_notify = SIGEV_THREAD, .sigev_notify_function = write_places};
  struct sigaction action = {.sa_handler = write_place, .sa_flags = SA_RESTART};
  void *call;
  backtrace(&call, 1); // the first call loads a library, which a signal handler must not
  return sigaction(SIGUSR1, &action, NULL) || timer_create(CLOCK_MONOTONIC, &by_thread, &suspicion);
}

// 0: never.
static void write_places_after(double seconds) {
  const struct itimerspec once = {
      .it_value = {(time_t)seconds, (long)((seconds - floor(seconds)) * 1e9)}};
  timer_settime(suspicion, 0, &once, NULL);
}

static void *interrupt_later(void *context) {
  (void)context;
  const struct timespec wait = {0, (long)(LIMIT * 1e9)};
  nanosleep(&wait, NULL);
  interrupt = 1;
  return NULL;
}

typedef struct Run {
  CagSession *session;
  FILE *out;
  double begun, begun_processor;
} Run;

static double processor_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void begin_time(Run *r) {
  write_places_after(LIMIT + SUSPECT);
  r->begun = cag_clock_seconds();
  r->begun_processor = processor_seconds();
}

static Run begin(const char *what, double limit) {
  CagSessionOptions options;
  Run r;
  now_running = what;
  interrupt = 0;
  cag_session_options_init(&options);
  options.out = options.messages = r.out = fopen("/dev/null", "w");
  options.max_time = limit;
  options.interrupt = &interrupt;
  options.folder = folder;
  r.session = cag_session_new(&options);
  assert_non_null(r.session);
  alarm(HOPELESS);
  begin_time(&r);
  return r;
}

typedef enum End { ENDED, ENDED_LATE, ENDED_WRONGLY } End;

// Tells and reports the way in which the operation ended.
static End end(Run *r, int status, int wanted) {
  const double late =
      fmin(cag_clock_seconds() - r->begun - LIMIT, processor_seconds() - r->begun_processor);
  alarm(0);
  write_places_after(0);
  const End how = status != wanted ? ENDED_WRONGLY : late > LATE ? ENDED_LATE : ENDED;
  if (how != ENDED) {
    print_error("%s\n  status %d in place of %d, %g s after the limit\n", now_running, status,
                wanted, late);
    cag_session_write_diagnostics(r->session, CAG_STYLE_TEXT, stderr);
  }
  cag_session_free(r->session);
  fclose(r->out);
  return how;
}

// Whether the operation fails the test. It begins again while it ends late.
static bool ends_badly(End (*operation)(const void *context), const void *context) {
  End how = ENDED_LATE;
  for (int k = 0; k < TRIALS && how == ENDED_LATE; k++) how = operation(context);
  return how != ENDED;
}

static int run_script(CagSession *s, const char *script) {
  char text[4096];
  assert_true(snprintf(text, sizeof text, "%s%s\n", prelude, script) < (int)sizeof text);
  return cag_session_run_text(s, "test", text, strlen(text));
}

static End end_of_limited(const void *script) {
  Run r = begin(script, LIMIT);
  return end(&r, run_script(r.session, script), CAG_STATUS_LIMIT);
}

static End end_of_interrupted(const void *script) {
  pthread_t thread;
  Run r = begin(script, 0);
  assert_int_equal(pthread_create(&thread, NULL, interrupt_later, NULL), 0);
  const int status = run_script(r.session, script);
  pthread_join(thread, NULL);
  return end(&r, status, CAG_STATUS_INTERRUPTED);
}

static void a_limit_or_an_interrupt_ends_any_script(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < COUNT; i++)
    if (!scripts[i].output)
      bad += ends_badly(i % 2 == 0 ? end_of_limited : end_of_interrupted, scripts[i].script);
  assert_int_equal(bad, 0);
}

// No part of a file remains.
static End end_of_export(const void *context) {
  const Heavy *h = context;
  char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, h->output);
  pthread_t thread;
  Run r = begin(h->script, 0);
  alarm(0); // making the shapes may take any time
  write_places_after(0);
  const int shown = run_script(r.session, h->script);
  begin_time(&r);
  if (shown != CAG_STATUS_OK) return end(&r, shown, CAG_STATUS_OK);
  alarm(HOPELESS);
  assert_int_equal(pthread_create(&thread, NULL, interrupt_later, NULL), 0);
  const int status = cag_session_export(r.session, path, NULL);
  pthread_join(thread, NULL);
  const End how = end(&r, status, CAG_STATUS_INTERRUPTED);
  if (access(path, F_OK) != 0) return how;
  print_error("%s: an interrupted export left %s\n", h->script, path);
  return ENDED_WRONGLY;
}

static void an_interrupt_ends_any_export(void **state) {
  (void)state;
  size_t bad = 0;
  for (size_t i = 0; i < COUNT; i++)
    if (scripts[i].output) bad += ends_badly(end_of_export, &scripts[i]);
  assert_int_equal(bad, 0);
}

// --- Long texts ---

typedef struct Text {
  char *bytes;
  size_t length;
} Text;

// Repeats the form `n` times; each %d is replaced by the number.
static Text repeated(const char *before, const char *form, const char *behind, int n) {
  Text t;
  FILE *f = open_memstream(&t.bytes, &t.length);
  fputs(before, f);
  for (int i = 0; i < n; i++)
    for (const char *c = form; *c; c++) {
      if (*c == '#') fprintf(f, "%d", i);
      else fputc(*c, f);
    }
  fputs(behind, f);
  fclose(f);
  return t;
}

// What is done with a long script.
typedef struct Reading {
  Text text;
  enum { RUNNING, CHECKING, FORMATTING } way;
} Reading;

static End end_of_reading(const void *context) {
  static const char *const names[] = {"a long script run", "checked", "formatted"};
  const Reading *reading = context;
  const Text t = reading->text;
  char *out = NULL;
  size_t length;
  int status = CAG_STATUS_OK;
  Run r = begin(names[reading->way], LIMIT);
  switch (reading->way) {
  case RUNNING: status = cag_session_run_text(r.session, "long", t.bytes, t.length); break;
  case CHECKING: status = cag_session_check_text(r.session, "long", t.bytes, t.length); break;
  case FORMATTING:
    status = cag_session_format(r.session, "long", t.bytes, t.length, &out, &length);
    break;
  }
  assert_null(out);
  return end(&r, status, CAG_STATUS_LIMIT);
}

static void a_limit_ends_the_reading_of_long_scripts(void **state) {
  (void)state;
  const Text texts[] = {
      repeated("", "v# = [#, sin(# * 1deg), { a: # }]\n", "print v1\n", 600000),
      repeated("f(x, y = 2) = x + y\n", "w# = f(#, y: #) + norm([1, 2, #])\n", "", 600000),
      repeated("x = [", "[#, sin(# * 1deg), 7], ", "1]\nprint len(x)\n", 1000000),
      repeated("x = [", "[[[[f(f(f(f(f(f(#)))))), 7]]]], ", "1]\n", 300000),
  };
  size_t bad = 0;
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
    for (int way = RUNNING; way <= FORMATTING; way++)
      bad += ends_badly(end_of_reading, &(Reading){texts[i], way});
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) free(texts[i].bytes);
  assert_int_equal(bad, 0);
}

// --- Files ---

static void write_text(const char *name, Text t) {
  char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fwrite(t.bytes, 1, t.length, f);
  fclose(f);
  free(t.bytes);
}

static void a_limit_ends_the_reading_of_large_files(void **state) {
  (void)state;
  static const char *const reading[] = {
      "print [for k in 0..<1000: read_mesh(\"large.stl\")]",
      "print [for k in 0..<1000: read_mesh(\"large.ply\")]",
      "print [for k in 0..<1000: read_mesh(\"large.obj\")]",
      "print [for k in 0..<1000: read_mesh(\"large.glb\")]",
      "print [for k in 0..<1000: len(read_json(\"large.json\"))]",
      "print [for k in 0..<1000: len(read_csv(\"large.csv\"))]",
      "print [for k in 0..<10000: len(read_text(\"large.csv\"))]",
      "print [for k in 0..<1000: read_urdf(\"large.urdf\", tip: \"l1\")]",
  };
  static const char *const meshes[] = {"stl", "ply", "obj", "glb"};
  Run r = begin("files", 0);
  assert_int_equal(run_script(r.session, "show tessellate(sphere(100), tolerance: 0.002)"),
                   CAG_STATUS_OK);
  for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
    char path[256];
    snprintf(path, sizeof path, "%s/large.%s", folder, meshes[i]);
    assert_int_equal(cag_session_export(r.session, path, NULL), CAG_STATUS_OK);
  }
  begin_time(&r);
  end(&r, CAG_STATUS_OK, CAG_STATUS_OK);
  write_text("large.json", repeated("[", "{\"a\": #, \"b\": [1.5, #]}, ", "1]", 300000));
  write_text("large.csv", repeated("a,b\n", "#,text #\n", "", 500000));
  write_text("large.urdf", repeated("<robot name=\"r\"><link name=\"base\"/>",
                                    "<link name=\"l#\"/><joint name=\"j#\" type=\"fixed\"><parent "
                                    "link=\"base\"/><child link=\"l#\"/></joint>",
                                    "</robot>", 4000));
  size_t bad = 0;
  for (size_t i = 0; i < sizeof reading / sizeof *reading; i++)
    bad += ends_badly(end_of_limited, reading[i]);
  assert_int_equal(bad, 0);
}

static int make_folder(void **state) {
  (void)state;
  signal(SIGALRM, give_up);
  return mkdtemp(folder) && prepare_places() == 0 ? 0 : -1;
}

static int remove_folder(void **state) {
  (void)state;
  char command[256];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_limit_or_an_interrupt_ends_any_script),
      cmocka_unit_test(an_interrupt_ends_any_export),
      cmocka_unit_test(a_limit_ends_the_reading_of_long_scripts),
      cmocka_unit_test(a_limit_ends_the_reading_of_large_files),
  };
  return cmocka_run_group_tests_name("heavy", tests, make_folder, remove_folder);
}
