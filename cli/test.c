// cag test [PATH ...]: runs scripts as tests, in parallel.
//
// scripts.h defines which scripts are run, and interp/session/expect.h what a test is. Workers take
// the scripts in order. The report of a script is delayed until those before it have been reported,
// so the output does not depend on the number of workers. It goes to standard output: failures,
// with -v also passed tests, and finally `N passed, N failed, N skipped`. Pictures of POV-Ray are
// skipped without it.

#include <cJSON.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "cli/junit.h"
#include "cli/scripts.h"
#include "interp/session/expect.h"

typedef struct Testing Testing;

// A script and its results.
typedef struct Script {
  Testing *testing;
  char *path;
  FILE *out, *messages; // write to the texts below
  char *said, *told;
  size_t said_length, told_length;
  CagTestCounts counts;
  CagJunitCase *cases;
  size_t case_count;
  FILE *failure; // of the current test
  char *failure_text;
  size_t failure_length;
  int status;
  bool done;
  bool lost; // memory ran out for a case of the report
} Script;

struct Testing {
  CagTool *tool;
  CagTestOptions options;
  Script *scripts;
  size_t count, capacity, next;
  pthread_mutex_t mutex;
  pthread_cond_t ended;
};

// --- Report ---

static void add_text(cJSON *object, const char *name, const char *text) {
  if (text) cJSON_AddStringToObject(object, name, text);
}

// Writes the fields of a diagnostic, and the expected and actual output.
static void report_json(FILE *out, const char *severity, const CagTestFailure *f) {
  cJSON *object = cJSON_CreateObject();
  add_text(object, "severity", severity);
  cJSON_AddNullToObject(object, "code");
  add_text(object, "message", f->message);
  add_text(object, "file", f->file);
  if (f->line) cJSON_AddNumberToObject(object, "line", (double)f->line);
  add_text(object, "test", f->test);
  add_text(object, "expected", f->expected);
  add_text(object, "got", f->got);
  add_text(object, "detail", f->detail);
  char *text = cJSON_PrintUnformatted(object);
  fprintf(out, "%s\n", text ? text : "{\"severity\":\"error\"}");
  cJSON_free(text);
  cJSON_Delete(object);
}

static void print_indented(FILE *out, const char *text) {
  while (*text) {
    size_t n = strcspn(text, "\n");
    fprintf(out, "  %.*s\n", (int)n, text);
    text += n + (text[n] == '\n');
  }
}

static void report_text(FILE *out, const CagTestFailure *f) {
  if (f->line) fprintf(out, "  %s:%zu: %s\n", f->file, f->line, f->message);
  else fprintf(out, "  %s: %s\n", f->file, f->message);
  if (f->expected) fprintf(out, "    expected: %s\n", f->expected);
  if (f->got) fprintf(out, "    got:      %s\n", f->got);
  if (f->detail) print_indented(out, f->detail);
}

static void report_failure(void *context, const CagTestFailure *f) {
  Script *s = context;
  if (!s->failure) s->failure = open_memstream(&s->failure_text, &s->failure_length);
  if (s->failure) report_text(s->failure, f);
  if (s->testing->tool->style == CAG_STYLE_JSON) {
    report_json(s->messages, "error", f);
    return;
  }
  fprintf(s->out, "FAILED %s\n", f->test);
  report_text(s->out, f);
}

// Stores a case for the XML report.
static void keep_case(Script *s, const char *test, CagTestOutcome outcome, double seconds,
                      const char *remark) {
  if (s->failure) fclose(s->failure);
  s->failure = NULL;
  CagJunitCase *cases = realloc(s->cases, (s->case_count + 1) * sizeof *cases);
  char *name = strdup(test);
  if (cases) s->cases = cases;
  s->lost = s->lost || !cases || !name;
  if (s->lost) {
    free(name);
    free(s->failure_text);
    s->failure_text = NULL;
    return;
  }
  const bool skipped = outcome == CAG_TEST_SKIPPED;
  cases[s->case_count++] = (CagJunitCase){
      name, seconds,
      outcome == CAG_TEST_FAILED ? (s->failure_text ? s->failure_text : strdup("")) : NULL,
      skipped && remark ? strdup(remark) : NULL};
  if (outcome != CAG_TEST_FAILED) free(s->failure_text);
  s->failure_text = NULL;
}

static void report_skipped(const Script *s, const char *test, const char *why) {
  const CagTool *tool = s->testing->tool;
  if (tool->quiet) return;
  if (tool->style != CAG_STYLE_JSON) {
    fprintf(s->messages, "cag test: %s is skipped: %s\n", test, why);
    return;
  }
  char *message = NULL;
  if (asprintf(&message, "skipped: %s", why) < 0) return;
  report_json(s->messages, "note",
              &(CagTestFailure){.test = test, .file = s->path, .message = message});
  free(message);
}

static void report_end(void *context, const char *test, CagTestOutcome outcome, double seconds,
                       const char *remark) {
  Script *s = context;
  const CagTool *tool = s->testing->tool;
  keep_case(s, test, outcome, seconds, remark);
  if (outcome == CAG_TEST_SKIPPED) {
    report_skipped(s, test, remark);
  } else if (remark && !tool->quiet) {
    fprintf(s->out, "%s: %s\n", test, remark);
  } else if (tool->verbose && outcome == CAG_TEST_PASSED) {
    fprintf(s->out, "passed %s in %.2f s\n", test, seconds);
  }
}

// --- A script ---

static int test_input(Script *s, const CagTestOptions *options) {
  size_t length;
  char *text = cag_tool_read_file(s->testing->tool, "-", &length);
  if (!text) return CAG_STATUS_FILE;
  const int status = cag_test_text("<stdin>", text, length, options, &s->counts);
  free(text);
  return status;
}

static void test_script(Script *s) {
  CagTestOptions options = s->testing->options;
  options.context = s;
  s->out = open_memstream(&s->said, &s->said_length);
  s->messages = open_memstream(&s->told, &s->told_length);
  if (!s->out || !s->messages) s->status = CAG_STATUS_LIMIT;
  else if (strcmp(s->path, "-") == 0) s->status = test_input(s, &options);
  else s->status = cag_test_file(s->path, &options, &s->counts);
  if (s->lost && s->status == CAG_STATUS_OK) s->status = CAG_STATUS_LIMIT;
  if (s->out) fclose(s->out);
  if (s->messages) fclose(s->messages);
}

static void *work(void *context) {
  Testing *t = context;
  pthread_mutex_lock(&t->mutex);
  while (t->next < t->count && !cag_tool_interrupt) {
    Script *s = &t->scripts[t->next++];
    pthread_mutex_unlock(&t->mutex);
    test_script(s);
    pthread_mutex_lock(&t->mutex);
    s->done = true;
    pthread_cond_signal(&t->ended);
  }
  pthread_mutex_unlock(&t->mutex);
  return NULL;
}

// Reports the scripts in order as they finish. Returns the first status that ends everything.
static int report_scripts(Testing *t, CagTestCounts *counts, int *file_status) {
  int status = CAG_STATUS_OK;
  for (size_t i = 0; i < t->count && status == CAG_STATUS_OK; i++) {
    Script *s = &t->scripts[i];
    pthread_mutex_lock(&t->mutex);
    // Started scripts finish. After an interruption, no others are started.
    while (!s->done && !(cag_tool_interrupt && i >= t->next)) {
      struct timespec soon;
      clock_gettime(CLOCK_REALTIME, &soon);
      soon.tv_nsec += 100000000;
      if (soon.tv_nsec >= 1000000000) soon.tv_sec++, soon.tv_nsec -= 1000000000;
      pthread_cond_timedwait(&t->ended, &t->mutex, &soon);
    }
    pthread_mutex_unlock(&t->mutex);
    if (!s->done) return CAG_STATUS_INTERRUPTED;
    fwrite(s->said, 1, s->said_length, stdout);
    fflush(stdout);
    fwrite(s->told, 1, s->told_length, stderr);
    counts->passed += s->counts.passed;
    counts->failed += s->counts.failed;
    counts->skipped += s->counts.skipped;
    if (s->status == CAG_STATUS_FILE) *file_status = CAG_STATUS_FILE;
    else status = s->status;
  }
  return status;
}

static int run_all(Testing *t, CagTestCounts *counts, int *file_status) {
  const long processors = sysconf(_SC_NPROCESSORS_ONLN);
  size_t jobs = t->tool->jobs ? t->tool->jobs : processors > 0 ? (size_t)processors : 1;
  if (jobs > t->count) jobs = t->count;
  pthread_t *threads = malloc((jobs + 1) * sizeof *threads);
  if (!threads) jobs = 0;
  size_t started = 0;
  pthread_mutex_init(&t->mutex, NULL);
  pthread_cond_init(&t->ended, NULL);
  while (started < jobs && pthread_create(&threads[started], NULL, work, t) == 0) started++;
  if (started == 0) work(t); // no thread could be created
  const int status = report_scripts(t, counts, file_status);
  pthread_mutex_lock(&t->mutex);
  t->next = t->count; // after a failure of all: start no others
  pthread_mutex_unlock(&t->mutex);
  for (size_t i = 0; i < started; i++) pthread_join(threads[i], NULL);
  pthread_cond_destroy(&t->ended);
  pthread_mutex_destroy(&t->mutex);
  free(threads);
  return status;
}

// --- The command ---

static int add_script(void *context, const char *path) {
  Testing *t = context;
  if (!CAG_RESERVE(t->scripts, t->capacity, t->count + 1)) return CAG_STATUS_LIMIT;
  char *copy = strdup(path);
  if (!copy) return CAG_STATUS_LIMIT;
  t->scripts[t->count++] = (Script){.testing = t, .path = copy};
  return CAG_STATUS_OK;
}

// Copies the defines of the command line to two lists, in one block.
static bool copy_defines(CagTestOptions *o, const CagTool *t) {
  size_t n = t->define_count;
  const char **texts = malloc((2 * n + 1) * sizeof *texts);
  if (!texts) return false;
  for (size_t i = 0; i < n; i++) {
    texts[i] = t->defines[i].name;
    texts[n + i] = t->defines[i].value;
  }
  o->define_names = texts;
  o->define_values = texts + n;
  o->define_count = n;
  return true;
}

static int write_report(const Testing *t) {
  if (!t->tool->report) return CAG_STATUS_OK;
  CagJunitSuite *suites = calloc(t->count + 1, sizeof *suites);
  if (!suites) return cag_tool_fail(t->tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  for (size_t i = 0; i < t->count; i++)
    suites[i] = (CagJunitSuite){t->scripts[i].path, t->scripts[i].cases, t->scripts[i].case_count};
  CagError err = {0};
  const bool ok = cag_junit_write(t->tool->report, suites, t->count, &err);
  free(suites);
  return ok ? CAG_STATUS_OK : cag_tool_fail(t->tool, CAG_STATUS_FILE, err.help, "%s", err.message);
}

static void release(Testing *t) {
  for (size_t i = 0; i < t->count; i++) {
    Script *s = &t->scripts[i];
    for (size_t k = 0; k < s->case_count; k++) {
      free(s->cases[k].name);
      free(s->cases[k].failure);
      free(s->cases[k].skipped);
    }
    if (s->failure) fclose(s->failure);
    free(s->failure_text);
    free(s->cases);
    free(s->said);
    free(s->told);
    free(s->path);
  }
  free(t->scripts);
  free((void *)(size_t)t->options.define_names);
}

int cag_tool_test(CagTool *tool, int argc, char **argv) {
  Testing t = {.tool = tool};
  cag_test_options_init(&t.options);
  t.options.session = tool->session;
  t.options.filter = tool->filter;
  t.options.update = tool->update;
  t.options.no_pictures = tool->no_pictures;
  t.options.engine = tool->engine;
  t.options.quality = tool->quality;
  t.options.failure = report_failure;
  t.options.ended = report_end;
  if (!copy_defines(&t.options, tool))
    return cag_tool_fail(tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  CagToolScripts scripts = {.tool = tool, .each = add_script, .context = &t};
  CagTestCounts counts = {0};
  int file_status = CAG_STATUS_OK, status = cag_tool_each_script(&scripts, argc, argv);
  if (status == CAG_STATUS_OK) status = run_all(&t, &counts, &file_status);
  if (status == CAG_STATUS_LIMIT) cag_tool_fail(tool, status, NULL, "out of memory");
  if (status == CAG_STATUS_OK && t.count == 0 && scripts.status == CAG_STATUS_OK)
    cag_tool_say(tool, "no scripts found");
  if (status == CAG_STATUS_OK) status = write_report(&t);
  printf("%zu passed, %zu failed, %zu skipped\n", counts.passed, counts.failed, counts.skipped);
  release(&t);
  if (status != CAG_STATUS_OK) return status;
  if (scripts.status != CAG_STATUS_OK) return scripts.status;
  if (file_status != CAG_STATUS_OK) return file_status;
  return counts.failed ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}
