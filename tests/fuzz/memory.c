// Runs scripts with failing allocations.
//
//     memory [-n POINTS] [-s SEED] [-b NAME] [-a ALLOCATION] [-l] [-x] [FILE...]
//
// Each script runs once without failures, and POINTS times (default 4) with failing allocations,
// which are drawn from SEED (default 1). At every second point, one allocation fails; at the
// others, it and all later ones fail. The scripts are the given files, or the examples of the
// built-ins (-b: of one of them). With -x, the files are also exported in every format. -a runs a
// single point in the process itself: allocation number ALLOCATION fails, or with a minus sign all
// allocations from this one on.
//
// With -l, allocations do not fail, but the memory limit is small: at the points, it rises from
// what an empty script needs to 4 MiB more, in geometric steps. -a is then the limit in bytes.
//
// A run passes if it ends with an error or with the output of the run without failures. The program
// is linked with wrapped allocation functions, so only allocations of cag itself fail. Runs are
// made in child processes: a crash ends one run and is reported. If the program is built with
// AddressSanitizer, memory leaks are reported as well.

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cag.h"
#include "failing.h"

#define SECONDS 10.0 // limit of one run
#define HANG 60      // seconds until a run counts as hanging

// Available only in builds with AddressSanitizer.
__attribute__((weak)) int __lsan_do_recoverable_leak_check(void);

// --- Work ---

// A script, or its export in one format.
typedef struct Job {
  const char *name; // of the file or built-in
  const char *text; // of an example; NULL: read the file
  const char *format;
  bool cut; // by PLANE; without a format, what is left is measured
} Job;

typedef struct Shared {
  size_t job, point, passed, failed;
  long failing; // as -a
  bool lost;    // whether memory leaked
} Shared;

static Job *jobs;
static size_t job_count;
static Shared *shared;
static bool by_limit;                            // -l
static size_t start_bytes;                       // the memory limit that an empty script needs
static char folder[] = "/tmp/cag-memory-XXXXXX"; // receives exports

static size_t draw(uint64_t *state, size_t n) {
  *state += 0x9e3779b97f4a7c15u; // splitmix64
  uint64_t z = *state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (size_t)((z ^ (z >> 31)) % n);
}

// A section in general position through most scripts, which are near the origin.
static const double PLANE[4] = {0.1, 0.2, 1, 0.3};

static void print_measures(void *out, const CagMeasures *m) {
  fprintf(out, "%s %s %.9g %.9g %.9g\n", m->name, m->type, m->length, m->area, m->volume);
}

// Runs a job with failing allocations as given by -a. Returns the status and the output, which the
// caller frees.
static int run_job(const Job *j, long point, char **output, size_t *allocations) {
  CagSessionOptions options;
  size_t size = 0;
  char path[64];
  *output = NULL;
  cag_session_options_init(&options);
  options.max_time = SECONDS;
  options.out = __real_open_memstream(output, &size);
  options.messages = fopen("/dev/null", "w");
  alarm(HANG);
  made = 0;
  failing = by_limit ? 0 : (size_t)labs(point);
  failing_on = point < 0;
  if (by_limit && point) options.max_memory = (size_t)point;
  CagSession *s = cag_session_new(&options);
  int status = CAG_STATUS_LIMIT;
  if (s && j->text)
    status = cag_session_run_text(s, "tests/language/example.cag", j->text, strlen(j->text));
  else if (s) status = cag_session_run_file(s, j->name);
  if (status == CAG_STATUS_OK && j->cut && !cag_session_set_section(s, PLANE))
    status = CAG_STATUS_LIMIT;
  if (status == CAG_STATUS_OK && j->format) {
    snprintf(path, sizeof path, "%s/out.%s", folder, j->format);
    status = cag_session_export(s, path, NULL);
  } else if (status == CAG_STATUS_OK && j->cut) {
    status = cag_session_measure(s, print_measures, options.out);
  }
  *allocations = made;
  if (status != CAG_STATUS_OK && s)
    cag_session_write_diagnostics(s, CAG_STYLE_TEXT, options.messages);
  cag_session_free(s);
  failing = 0;
  alarm(0);
  fclose(options.out);
  fclose(options.messages);
  return status;
}

static void complain(const char *what) {
  const Job *j = &jobs[shared->job];
  shared->failed++;
  printf("--- %s, with -a %ld%s%s%s: %s\n%s\n", what, shared->failing, j->cut ? ", cut" : "",
         j->format ? ", exported as " : "", j->format ? j->format : "", j->name,
         j->text ? j->text : "");
  fflush(stdout);
}

static void try_point(const Job *j, long point, int expected_status, const char *expected) {
  char *output;
  size_t ignored;
  shared->failing = point;
  const int status = run_job(j, point, &output, &ignored);
  const bool other = status == CAG_STATUS_OK &&
                     (expected_status != CAG_STATUS_OK || strcmp(output, expected) != 0);
  free(output);
  if (__lsan_do_recoverable_leak_check && __lsan_do_recoverable_leak_check()) {
    complain("memory leak");
    shared->lost = true;
  } else if (other) {
    complain("a different result");
  } else {
    shared->passed++;
  }
}

// Finds the lowest memory limit, to 1 KiB, with which an empty script runs.
static size_t find_start_bytes(void) {
  const Job empty = {.name = "", .text = ""};
  size_t low = 0, high = (size_t)64 << 20, ignored;
  while (high - low > 1024) {
    char *output;
    const size_t middle = low + (high - low) / 2;
    const int status = run_job(&empty, (long)middle, &output, &ignored);
    free(output);
    if (status == CAG_STATUS_OK) high = middle;
    else low = middle;
  }
  return high;
}

// The memory limit at a point: 1 KiB to 4 MiB above the start.
static size_t limit_at(size_t point, size_t points) {
  return start_bytes + (size_t)(1024 * pow(4096, (double)point / (double)points));
}

// Runs the remaining points of one job, or a single one.
static void try_job(size_t points, uint64_t seed, long single) {
  const Job *j = &jobs[shared->job], empty = {.name = "", .text = ""};
  char *expected, *output;
  size_t allocations = 0, start = 0;
  run_job(&empty, 0, &output, &start);
  free(output);
  const int status = run_job(j, 0, &expected, &allocations);
  if (status == CAG_STATUS_LIMIT) complain("it fails although it has all its memory");
  if (single) try_point(j, single, status, expected);
  while (shared->point < points) {
    uint64_t state = seed + shared->job * 0x2545f4914f6cdd1du + shared->point++;
    // One in sixteen points fails during the start of the session, which is the same for all
    // scripts.
    const size_t first = draw(&state, 16) == 0 || start >= allocations ? 0 : start;
    const long point = (long)(1 + first + draw(&state, allocations - first));
    if (by_limit) try_point(j, (long)limit_at(shared->point, points), status, expected);
    else try_point(j, shared->point % 2 ? point : -point, status, expected);
    if (shared->lost) break;
  }
  free(expected);
}

// Fails each allocation of the start of a session in turn, each in a new process, because the
// tables of built-ins are created once per process.
static void try_start(void) {
  static const Job start = {"the start of a session", "", NULL, false};
  jobs = (Job *)&start;
  for (long point = 1, more = 1; more; point++) {
    shared->failing = point;
    shared->lost = true; // until the child reports success
    fflush(stdout);
    const pid_t child = fork();
    if (child < 0) exit(2);
    if (child == 0) {
      char *output;
      size_t allocations;
      const int status = run_job(&start, point, &output, &allocations);
      const bool reached = (size_t)point <= allocations;
      free(output);
      shared->job = reached;
      // If the first allocation fails, there is no session at all, and a second session has all the
      // memory that it needs.
      if (point == 1)
        failing = 1, made = 0, shared->lost = cag_session_new(&(CagSessionOptions){0});
      else shared->lost = status == CAG_STATUS_OK && reached;
      failing = 0;
      if (run_job(&start, 0, &output, &allocations) != CAG_STATUS_OK) shared->lost = true;
      free(output);
      exit(0);
    }
    int status;
    waitpid(child, &status, 0);
    more = shared->job;
    shared->job = 0;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) complain("a crash");
    else if (shared->lost) complain("no error");
    else shared->passed++;
  }
  shared->lost = false;
}

// --- Jobs ---

static void add_job(Job j) {
  jobs = realloc(jobs, (job_count + 1) * sizeof *jobs);
  if (!jobs) exit(2);
  jobs[job_count++] = j;
}

static void add_examples(const char *only) {
  const char *signature, *example;
  for (size_t i = 0; cag_builtin_row(i, &signature, NULL, &example, NULL); i++) {
    const size_t n = strcspn(signature, "(");
    if (example && (!only || (strlen(only) == n && strncmp(only, signature, n) == 0)))
      add_job((Job){signature, example, NULL, false});
  }
}

static void add_file(const char *name, bool exports) {
  char *output;
  size_t ignored;
  const Job plain = {name, NULL, NULL, false};
  add_job(plain);
  for (const char *const *f = cag_export_formats(); exports && *f; f++) {
    const Job j = {name, NULL, *f, false};
    if (run_job(&j, 0, &output, &ignored) == CAG_STATUS_OK) add_job(j);
    free(output);
  }
  for (int k = 0; exports && k < 3; k++) { // what is left as a mesh, the outlines, and the measures
    static const char *const formats[] = {"stl", "svg", NULL};
    const Job j = {name, NULL, formats[k], true};
    if (run_job(&j, 0, &output, &ignored) == CAG_STATUS_OK) add_job(j);
    free(output);
  }
}

static void remove_folder(void) {
  DIR *d = opendir(folder);
  char path[512];
  for (struct dirent *f; d && (f = readdir(d));) {
    snprintf(path, sizeof path, "%s/%s", folder, f->d_name);
    if (f->d_name[0] != '.') unlink(path);
  }
  if (d) closedir(d);
  rmdir(folder);
}

// Runs jobs in child processes, and starts a new one after each crash, until all are done.
static void run_all(size_t points, uint64_t seed) {
  while (shared->job < job_count) {
    fflush(stdout);
    const pid_t child = fork();
    if (child < 0) exit(2);
    if (child == 0) {
      for (; shared->job < job_count; shared->job++, shared->point = 0) {
        try_job(points, seed, 0);
        if (shared->lost) break; // a new child starts without the leak
      }
      exit(0);
    }
    int status;
    waitpid(child, &status, 0);
    const bool endless = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
    const bool ended = WIFEXITED(status) && (WEXITSTATUS(status) == 0 || shared->lost);
    if (!ended && !endless) psignal(WIFSIGNALED(status) ? WTERMSIG(status) : 0, "memory");
    if (!ended) complain(endless ? "it does not terminate" : "a crash");
    shared->lost = false;
  }
}

int main(int argc, char **argv) {
  size_t points = 4;
  uint64_t seed = 1;
  long single = 0;
  const char *only = NULL;
  bool exports = false;
  for (int option; (option = getopt(argc, argv, "n:s:b:a:lx")) != -1;) {
    switch (option) {
    case 'n': points = strtoul(optarg, NULL, 10); break;
    case 's': seed = strtoull(optarg, NULL, 10); break;
    case 'b': only = optarg; break;
    case 'a': single = strtol(optarg, NULL, 10); break;
    case 'l': by_limit = true; break;
    case 'x': exports = true; break;
    default: return 2;
    }
  }
  shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED || !mkdtemp(folder)) return 2;
  setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
  if (by_limit) start_bytes = find_start_bytes();
  else if (!only && !single) try_start();
  jobs = NULL;
  if (optind == argc) add_examples(only);
  for (int i = optind; i < argc; i++) add_file(argv[i], exports);
  for (; single && shared->job < job_count; shared->job++) try_job(0, 0, single);
  run_all(points, seed);
  remove_folder();
  printf("%zu passed, %zu failed, 0 skipped\n", shared->passed, shared->failed);
  return shared->failed > 0;
}
