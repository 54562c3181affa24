// cag batch JOBS: renders and exports the rows of a table.
//
// All rows are read and checked first. Tasks that the journal records as done by an earlier call
// are skipped. The others are run here or submitted to a queue. See batch.h for how rows become
// tasks.

#include "cli/batch.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "cli/scripts.h"
#include "cli/slurm.h"

// --- Names ---

static bool has_ending(const char *path, const char *ending) {
  const size_t n = strlen(path), m = strlen(ending);
  return n > m && strcasecmp(path + n - m, ending) == 0;
}

// Returns the absolute path, because processes run in another folder.
static char *full_path(const char *path) {
  char here[PATH_MAX], *out = NULL;
  if (*path == '/') return strdup(path);
  if (!getcwd(here, sizeof here)) return NULL;
  return asprintf(&out, "%s/%s", here, path) < 0 ? NULL : out;
}

static char *with_ending(const char *path, size_t length, const char *ending) {
  char *out = NULL;
  return asprintf(&out, "%.*s%s", (int)length, path, ending) < 0 ? NULL : out;
}

// Determines all paths: of the job file, of the files beside it, and of this program.
static bool find_places(CagBatch *b) {
  char program[PATH_MAX];
  char *jobs = full_path(b->path);
  if (!jobs) return false;
  const size_t n = strlen(jobs), ending = has_ending(jobs, ".json") ? 5 : 4;
  b->folder = strndup(jobs, (size_t)(strrchr(jobs, '/') - jobs));
  b->journal_path = with_ending(jobs, n, ".journal");
  b->tiles_folder = with_ending(jobs, n, ".tiles");
  // The renderer would interpret a % as the frame number.
  for (char *at = b->tiles_folder ? strrchr(b->tiles_folder, '/') : NULL; at && *at; at++)
    if (*at == '%') *at = '_';
  b->queue_folder = with_ending(jobs, n, ".slurm");
  b->report_path =
      b->tool->report ? full_path(b->tool->report) : with_ending(jobs, n - ending, ".report.csv");
  free(jobs);
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
  b->program = length > 0 ? strndup(program, (size_t)length) : NULL;
  return b->folder && b->journal_path && b->tiles_folder && b->queue_folder && b->report_path &&
         b->program;
}

// Rows run in the folder of the job file, so folders of -I are made absolute.
static bool settle_module_path(CagBatch *b) {
  CagTool *t = b->tool;
  const char **path = (const char **)(size_t)t->session.module_path;
  for (size_t i = 0; i < t->session.module_path_count; i++)
    if (!(path[i] = full_path(path[i]))) return false;
  return b->owns_module_path = true;
}

static void settle_workers(CagBatch *b) {
  const long processors = sysconf(_SC_NPROCESSORS_ONLN);
  const size_t n = processors > 0 ? (size_t)processors : 1;
  // More than on any machine; limits an allocation.
  enum { WORKERS_MAX = 4096 };
  b->workers = b->tool->jobs ? b->tool->jobs : n;
  if (b->workers > WORKERS_MAX) b->workers = WORKERS_MAX;
  b->threads = b->tool->threads ? b->tool->threads : b->workers < n ? (int)(n / b->workers) : 1;
}

// --- The command ---

static int read_jobs(CagBatch *b) {
  size_t length;
  if (!has_ending(b->path, ".csv") && !has_ending(b->path, ".json"))
    return cag_tool_fail(b->tool, CAG_STATUS_USAGE, "name a table of jobs, such as jobs.csv",
                         "'%s' is not a .csv or .json file", b->path);
  char *text = cag_tool_read_file(b->tool, b->path, &length);
  if (!text) return CAG_STATUS_FILE;
  bool ok = cag_jobs_read(&b->jobs, text, length, has_ending(b->path, ".json"));
  free(text);
  // If columns are missing, other errors would be misleading.
  if (ok && b->jobs.count) ok = cag_batch_check(b);
  if (!ok) return cag_tool_fail(b->tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  if (!b->jobs.problem_count) return CAG_STATUS_OK;
  cag_batch_tell_problems(b);
  return CAG_STATUS_USAGE;
}

static bool has_film(const CagBatch *b) {
  for (size_t i = 0; i < b->jobs.count; i++)
    if (b->rows[i].film) return true;
  return false;
}

// Runs the missing tasks. Returns the exit status of the program.
static int run_missing(CagBatch *b) {
  CagError err;
  cag_batch_recall(b);
  int status = b->tool->queue ? cag_slurm_run(b) : cag_batch_run(b);
  const bool interrupted = status == CAG_STATUS_INTERRUPTED;
  if (!cag_batch_write_report(b, &err))
    return cag_tool_fail(b->tool, cag_exit_status(&err), err.help, "%s", err.message);
  const int closed = cag_batch_close(b, interrupted);
  return status == CAG_STATUS_OK ? closed : status;
}

static int run(CagBatch *b) {
  CagError err;
  if (!find_places(b) || !settle_module_path(b))
    return cag_tool_fail(b->tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  settle_workers(b);
  const int status = read_jobs(b);
  if (status != CAG_STATUS_OK) return status;
  if (b->tool->loop && !has_film(b))
    return cag_tool_fail(b->tool, CAG_STATUS_USAGE,
                         "add a column `frames` with values such as 0..47",
                         "--loop applies to films, but no row has frames");
  // The report is written at the end, but an unwritable path is reported at the start.
  const int place = cag_tool_check_output(b->tool, b->report_path);
  if (place != CAG_STATUS_OK) return place;
  if (!cag_batch_make_keys(b))
    return cag_tool_fail(b->tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  if (!cag_journal_open(&b->journal, b->journal_path, b->tool->fresh, &err))
    return cag_tool_fail(b->tool, cag_exit_status(&err), err.help, "%s", err.message);
  return run_missing(b);
}

static void release(CagBatch *b) {
  cag_journal_close(&b->journal);
  for (size_t i = 0; i < b->task_count; i++) {
    free(b->tasks[i].output);
    free(b->tasks[i].message);
  }
  free(b->tasks);
  free(b->rows);
  cag_jobs_free(&b->jobs);
  for (size_t i = 0; b->owns_module_path && i < b->tool->session.module_path_count; i++)
    free((void *)(size_t)b->tool->session.module_path[i]);
  free(b->folder);
  free(b->program);
  free(b->journal_path);
  free(b->report_path);
  free(b->tiles_folder);
  free(b->queue_folder);
}

int cag_tool_batch(CagTool *t, int argc, char **argv) {
  (void)argc;
  if (t->element) return cag_slurm_element(t, argv[0]);
  CagBatch b = {.tool = t, .path = argv[0], .journal = {.fd = -1}};
  const int status = run(&b);
  release(&b);
  return status;
}
