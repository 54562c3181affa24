// Submits, watches, and resumes an array job of Slurm.
//
// Slurm is accessed through its command-line programs, each with a time limit, because they wait
// long for a controller that is down. If Slurm stops responding while a job is being watched, it is
// given time to recover.

#include "cli/slurm.h"

#include <ftw.h>
#include <math.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "cli/batch_child.h"
#include "cli/batch_progress.h"
#include "cli/slurm_plan.h"

#define CODE_QUEUE "E0918"

// The time limit, in seconds, for a program of Slurm.
#define ANSWER_LIMIT 30.0
// The time, in seconds, that Slurm may not respond while a job is being watched.
#define SILENCE_LIMIT 60.0
// Seconds between queries of Slurm, which serves others, too; and milliseconds between checks for
// results.
#define ASK_INTERVAL 2.0
#define LOOK_INTERVAL 200 // milliseconds
// An element that ended without a result is checked this often before it counts as lost, because
// files of another machine may become visible late.
#define LOOKS_FOR_RESULT 3
// The maximum size of an array if Slurm does not tell.
#define ELEMENTS_USUAL 1000

typedef struct {
  CagBatch *batch;
  char name[CAG_JOURNAL_KEY_SIZE]; // of the job
  char *folder;                    // of its plan and results
  CagTask **tasks;                 // of the plan; NULL if the row no longer exists
  size_t count, elements;
  unsigned char *missed; // for each element: checks since it ended without all results
  CagBatchProgress progress;
  double asked, answered;
  bool silent; // silence was reported
  bool gone;   // Slurm knows none of its elements
} Array;

static void free_array(Array *a) {
  free(a->folder);
  free(a->tasks);
  free(a->missed);
}

static void say_once(const CagBatch *b, const char *message) {
  cag_tool_fail(b->tool, CAG_STATUS_OK, NULL, CODE_QUEUE ": %s", message);
}

// Returns the last line of a program's output, without its line end.
static const char *last_line(char *text) {
  size_t n = strlen(text);
  while (n && (text[n - 1] == '\n' || text[n - 1] == ' ')) text[--n] = '\0';
  const char *line = strrchr(text, '\n');
  return line ? line + 1 : text;
}

// --- Submitting ---

// Fails all tasks of the job, after one message for all.
static void refuse(CagBatch *b, const char *what, char *said) {
  char *message = NULL;
  const char *line = said ? last_line(said) : "no answer";
  if (asprintf(&message, "%s: %s", what, *line ? line : "no answer") < 0) return;
  say_once(b, message);
  for (size_t i = 0; i < b->task_count; i++) {
    CagTask *task = &b->tasks[i];
    if (task->state != CAG_TASK_WAITING || task->joins) continue;
    task->state = CAG_TASK_FAILED;
    task->status = CAG_STATUS_RENDERER;
    task->message = strdup(message);
  }
  free(message);
}

// Returns the maximum size of an array, or 0, with the rows failed, if Slurm does not respond.
static size_t ask_elements(CagBatch *b) {
  char *const words[] = {"scontrol", "show", "config", NULL}, *said = NULL;
  const int status = cag_child_run(words, ANSWER_LIMIT, &cag_tool_interrupt, &said);
  const char *at = status == 0 ? strstr(said, "MaxArraySize") : NULL;
  const char *equals = at ? strchr(at, '=') : NULL;
  size_t elements = equals ? strtoul(equals + 1, NULL, 10) : 0;
  if (elements < 2) elements = ELEMENTS_USUAL;
  if (status != 0 && !cag_tool_interrupt) {
    refuse(b, said ? "Slurm does not respond" : "cannot run Slurm's programs", said);
    elements = 0;
  }
  free(said);
  // Slurm's limit is exclusive and applies to the largest index.
  return elements ? elements - 1 : 0;
}

// Writes a text quoted for the shell.
static void write_quoted(CagAtomicFile *f, const char *text) {
  cag_atomic_file_text(f, "'");
  for (; *text; text++)
    if (*text == '\'') cag_atomic_file_text(f, "'\\''");
    else cag_atomic_file_write(f, text, 1);
  cag_atomic_file_text(f, "'");
}

static bool write_script(const Array *a, const char *path, CagError *err) {
  CagAtomicFile *f = cag_atomic_file_open(path, err);
  if (!f) return false;
  cag_atomic_file_text(f, "#!/bin/sh\n# An element of the array job of `cag batch`.\nexec ");
  write_quoted(f, a->batch->program);
  cag_atomic_file_text(f, " batch ");
  cag_atomic_file_text(f, "--element=\"$SLURM_ARRAY_TASK_ID\" ");
  char *plan = NULL;
  if (asprintf(&plan, "%s/plan.json", a->folder) >= 0) write_quoted(f, plan);
  free(plan);
  cag_atomic_file_text(f, "\n");
  return cag_atomic_file_commit(f, err);
}

static bool write_plan(const Array *a, const char *path, CagError *err) {
  const CagBatch *b = a->batch;
  const double max_time = b->tool->session.max_time;
  CagPlan plan = {.elements = a->elements,
                  .retries = b->tool->retries,
                  .max_time = max_time,
                  .limit = max_time > 0 ? 1.1 * max_time + 1 : 0,
                  .folder = b->folder,
                  .tasks = calloc(a->count, sizeof *plan.tasks)};
  bool ok = plan.tasks != NULL;
  for (size_t i = 0; ok && i < a->count; i++) {
    CagPlanTask *p = &plan.tasks[plan.count++];
    strcpy(p->key, a->tasks[i]->key);
    p->words = cag_batch_command(b, a->tasks[i], b->tool->threads ? b->tool->threads : 1);
    ok = p->words != NULL;
  }
  ok = ok ? cag_plan_write(&plan, path, err) : cag_fail_io(err, CAG_E_LIMIT, NULL, "out of memory");
  for (size_t i = 0; i < plan.count; i++) free(plan.tasks[i].words);
  free(plan.tasks);
  return ok;
}

// Collects the waiting tasks, except those that join others.
static bool gather(Array *a) {
  CagBatch *b = a->batch;
  a->tasks = malloc((b->task_count + 1) * sizeof *a->tasks);
  for (size_t i = 0; a->tasks && i < b->task_count; i++)
    if (b->tasks[i].state == CAG_TASK_WAITING && !b->tasks[i].joins)
      a->tasks[a->count++] = &b->tasks[i];
  return a->tasks != NULL;
}

static bool settle_names(Array *a) {
  unsigned long long digits = 0;
  if (getrandom(&digits, sizeof digits, 0) != sizeof digits) digits = (unsigned long long)getpid();
  snprintf(a->name, sizeof a->name, "cag-%016llx", digits);
  return asprintf(&a->folder, "%s/%s", a->batch->queue_folder, a->name) >= 0;
}

// Creates the folder with plan and script.
static bool prepare(const Array *a, char **script, CagError *err) {
  const CagBatch *b = a->batch;
  char *plan = NULL;
  mkdir(b->queue_folder, 0777);
  bool ok = mkdir(a->folder, 0777) == 0 ||
            cag_fail_io(err, CAG_E_FILE, NULL, "cannot create the folder '%s'", a->folder);
  ok = ok && asprintf(&plan, "%s/plan.json", a->folder) >= 0 &&
       asprintf(script, "%s/array.sh", a->folder) >= 0 && write_plan(a, plan, err) &&
       write_script(a, *script, err);
  free(plan);
  return ok;
}

// Returns the time limit of an element in minutes, if its tasks have one.
static double minutes(const Array *a) {
  const CagTool *t = a->batch->tool;
  const double tasks = ceil((double)a->count / (double)a->elements);
  enum { START_SECONDS = 60 };
  const double seconds = (1.1 * t->session.max_time + 1) * (double)(t->retries + 1) * tasks;
  return ceil((seconds + START_SECONDS) / 60);
}

// Calls sbatch. Returns false, with the rows failed, if it refuses the job.
static bool submit(Array *a, char *script) {
  const CagTool *t = a->batch->tool;
  char array[64], name[64], time[64], threads[32], output[4096 + 32];
  char *said = NULL;
  const size_t last = a->elements - 1;
  if (t->jobs) snprintf(array, sizeof array, "--array=0-%zu%%%zu", last, t->jobs);
  else snprintf(array, sizeof array, "--array=0-%zu", last);
  snprintf(name, sizeof name, "--job-name=%s", a->name);
  // Slurm would interpret a % in the name.
  if (strchr(a->folder, '%')) snprintf(output, sizeof output, "--output=/dev/null");
  else snprintf(output, sizeof output, "--output=%s/said-%%a.txt", a->folder);
  snprintf(time, sizeof time, "--time=%.0f", t->session.max_time > 0 ? minutes(a) : 0);
  snprintf(threads, sizeof threads, "--cpus-per-task=%d", t->threads);
  // Slurm does not requeue a task of a failed node: it is reported, and the next call runs it.
  char *words[10] = {"sbatch", "--parsable", "--no-requeue", array, name, output};
  size_t n = 6;
  if (t->session.max_time > 0) words[n++] = time;
  if (t->threads) words[n++] = threads;
  words[n] = script;
  const int status = cag_child_run(words, ANSWER_LIMIT, NULL, &said);
  if (status != 0) refuse(a->batch, "Slurm refused the job", said);
  else cag_tool_say(t, "submitted Slurm job %s with %zu tasks", last_line(said), a->count);
  free(said);
  return status == 0;
}

// --- Watching ---

static bool is_open(const CagTask *task) { return task && task->state == CAG_TASK_WAITING; }

// Collects the available results. Returns a status, and the number of unfinished tasks.
static int collect(Array *a, size_t *open) {
  CagBatch *b = a->batch;
  int status = CAG_STATUS_OK;
  *open = 0;
  for (size_t i = 0; i < a->count && status == CAG_STATUS_OK; i++) {
    CagTask *task = a->tasks[i];
    if (!is_open(task)) continue;
    char *path = cag_plan_result_path(a->folder, task->key);
    if (path && cag_plan_read_result(path, task)) {
      task->state = task->status == CAG_STATUS_OK ? CAG_TASK_DONE : CAG_TASK_FAILED;
      cag_batch_progress_clear(&a->progress);
      status = cag_batch_end_task(b, task);
    } else {
      ++*open;
    }
    free(path);
  }
  return status;
}

// An element ended or is unknown: after some time, its unfinished tasks count as lost.
static int lose(Array *a, size_t element, const char *state) {
  int status = CAG_STATUS_OK;
  if (++a->missed[element] < LOOKS_FOR_RESULT) return status;
  for (size_t i = element; i < a->count && status == CAG_STATUS_OK; i += a->elements) {
    CagTask *task = a->tasks[i];
    if (!is_open(task)) continue;
    task->state = CAG_TASK_FAILED;
    task->status = CAG_STATUS_RENDERER;
    if (asprintf(&task->message, "Slurm ended its task %zu without a result: %s", element, state) <
        0)
      task->message = NULL;
    cag_batch_progress_clear(&a->progress);
    status = cag_batch_end_task(a->batch, task);
  }
  return status;
}

static bool is_over(const char *state) {
  static const char *const OVER[] = {"BOOT_FAIL", "CANCELLED", "COMPLETED", "DEADLINE",
                                     "FAILED",    "NODE_FAIL", "PREEMPTED", "OUT_OF_MEMORY",
                                     "REVOKED",   "TIMEOUT"};
  for (size_t i = 0; i < sizeof OVER / sizeof *OVER; i++)
    if (!strcmp(state, OVER[i])) return true;
  return false;
}

// Parses lines "ELEMENT STATE" of squeue. Elements that are not listed have ended long ago.
static int read_states(Array *a, char *said) {
  int status = CAG_STATUS_OK;
  bool *seen = calloc(a->elements, sizeof *seen);
  a->gone = true;
  if (!seen) return CAG_STATUS_LIMIT;
  for (char *line = strtok(said, "\n"); line; line = strtok(NULL, "\n")) {
    char state[32];
    size_t element;
    if (sscanf(line, "%zu %31s", &element, state) != 2 || element >= a->elements) continue;
    seen[element] = true;
    a->gone = false;
    if (is_over(state) && status == CAG_STATUS_OK) status = lose(a, element, state);
  }
  for (size_t e = 0; e < a->elements && status == CAG_STATUS_OK; e++)
    if (!seen[e]) status = lose(a, e, "the job is no longer known");
  free(seen);
  return status;
}

// Queries the states of the elements from Slurm. Sets `*silent` if it has not responded for long.
static int query_states(Array *a, bool *silent) {
  char name[64], *said = NULL;
  snprintf(name, sizeof name, "--name=%s", a->name);
  char *const words[] = {"squeue", "--noheader",     "--array", "--states=all",
                         name,     "--format=%K %T", NULL};
  const int code = cag_child_run(words, ANSWER_LIMIT, &cag_tool_interrupt, &said);
  int status = CAG_STATUS_OK;
  const double now = cag_clock_seconds();
  a->asked = now;
  if (code == 0) {
    a->answered = now;
    a->silent = false;
    status = read_states(a, said);
  } else if (!cag_tool_interrupt) {
    cag_batch_progress_clear(&a->progress);
    if (!a->silent)
      cag_tool_say(a->batch->tool, "Slurm does not respond (%s), waiting",
                   said ? last_line(said) : "cannot run squeue");
    a->silent = true;
    *silent = now - a->answered > SILENCE_LIMIT;
  }
  free(said);
  return status;
}

static int tell_interrupted(const Array *a) {
  cag_tool_say(a->batch->tool, "the Slurm job continues; run the same command to resume");
  return CAG_STATUS_INTERRUPTED;
}

// Watches the job until all its tasks have ended. Sets `*over` if they have.
static int follow(Array *a, bool *over) {
  size_t open;
  bool silent = false;
  *over = false;
  a->answered = cag_clock_seconds();
  cag_batch_progress_begin(&a->progress, a->batch);
  int status = collect(a, &open);
  while (status == CAG_STATUS_OK && open && !silent) {
    if (cag_tool_interrupt) {
      cag_batch_progress_clear(&a->progress);
      return tell_interrupted(a);
    }
    if (cag_clock_seconds() - a->asked > ASK_INTERVAL) status = query_states(a, &silent);
    cag_batch_progress_show(&a->progress, a->batch, open);
    poll(NULL, 0, LOOK_INTERVAL);
    if (status == CAG_STATUS_OK) status = collect(a, &open);
  }
  cag_batch_progress_clear(&a->progress);
  if (silent)
    say_once(a->batch, "Slurm does not respond; the next call collects the results of its job");
  *over = status == CAG_STATUS_OK && !open;
  return status;
}

// --- The whole job ---

static int remove_entry(const char *path, const struct stat *st, int type, struct FTW *at) {
  (void)st, (void)type, (void)at;
  remove(path);
  return 0;
}

static int keep_in_journal(CagBatch *b, CagJournalWhat what, const char *name) {
  CagError err;
  CagJournalEntry entry = {.what = what};
  strcpy(entry.key, name);
  if (cag_journal_add(&b->journal, &entry, &err)) return CAG_STATUS_OK;
  return cag_tool_fail(b->tool, cag_exit_status(&err), err.help, "%s", err.message);
}

// Cleans up after the job is over and its results are in the journal.
static int finish(Array *a) {
  enum { OPEN_FOLDERS = 8 };
  const int status = keep_in_journal(a->batch, CAG_JOURNAL_COLLECTED, a->name);
  if (status != CAG_STATUS_OK) return status;
  nftw(a->folder, remove_entry, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
  rmdir(a->batch->queue_folder);
  return CAG_STATUS_OK;
}

static int by_key(const void *a, const void *b) {
  return strcmp((*(CagTask *const *)a)->key, (*(CagTask *const *)b)->key);
}

static int key_with_task(const void *key, const void *task) {
  return strcmp(key, (*(CagTask *const *)task)->key);
}

// Finds the tasks of the plan among those of the batch.
static bool match(Array *a, const CagPlan *plan) {
  CagBatch *b = a->batch;
  CagTask **sorted = malloc((b->task_count + 1) * sizeof *sorted);
  a->tasks = calloc(plan->count + 1, sizeof *a->tasks);
  a->missed = calloc(plan->elements, 1);
  const bool ok = sorted && a->tasks && a->missed;
  for (size_t i = 0; ok && i < b->task_count; i++) sorted[i] = &b->tasks[i];
  if (ok) qsort(sorted, b->task_count, sizeof *sorted, by_key);
  for (size_t i = 0; ok && i < plan->count; i++) {
    CagTask **found =
        bsearch(plan->tasks[i].key, sorted, b->task_count, sizeof *sorted, key_with_task);
    a->tasks[i] = found ? *found : NULL;
  }
  a->count = plan->count;
  a->elements = plan->elements;
  free(sorted);
  return ok;
}

// Tests whether Slurm knows the job. Returns true if Slurm does not respond, which is reported
// later.
static bool is_known(Array *a) {
  bool silent;
  if (query_states(a, &silent) != CAG_STATUS_OK) return true;
  memset(a->missed, 0, a->elements);
  return !a->gone;
}

// Resumes the job of an earlier call. If it never reached Slurm, or Slurm has forgotten it, its
// unfinished tasks are left for the next job.
static int take_up(CagBatch *b, bool *over) {
  Array a = {.batch = b};
  CagPlan plan;
  char *path = NULL;
  int status = CAG_STATUS_OK;
  size_t open;
  *over = true;
  strcpy(a.name, b->journal.job);
  if (asprintf(&a.folder, "%s/%s", b->queue_folder, a.name) < 0 ||
      asprintf(&path, "%s/plan.json", a.folder) < 0)
    return CAG_STATUS_LIMIT;
  if (access(path, R_OK) != 0) {
    status = finish(&a); // it was removed, so its state is unknown
  } else if (!cag_plan_read(b->tool, &plan, path)) {
    status = CAG_STATUS_FILE;
  } else {
    if (!match(&a, &plan)) status = CAG_STATUS_LIMIT;
    cag_plan_free(&plan);
    cag_batch_progress_begin(&a.progress, b);
    if (status == CAG_STATUS_OK) status = collect(&a, &open);
    if (status == CAG_STATUS_OK && open && is_known(&a)) {
      cag_tool_say(b->tool, "resuming Slurm job %s", a.name);
      status = follow(&a, over);
    }
    if (status == CAG_STATUS_OK && *over) status = finish(&a);
  }
  free(path);
  free_array(&a);
  return status;
}

// Submits the waiting tasks.
static int hand_in(CagBatch *b) {
  Array a = {.batch = b};
  char *script = NULL;
  bool over = true;
  CagError err = {.status = CAG_E_LIMIT, .message = "out of memory"};
  if (!gather(&a) || !settle_names(&a)) return free_array(&a), CAG_STATUS_LIMIT;
  const size_t most = a.count ? ask_elements(b) : 0;
  if (cag_tool_interrupt) return free_array(&a), CAG_STATUS_INTERRUPTED;
  if (!most) return free_array(&a), CAG_STATUS_OK;
  a.elements = a.count < most ? a.count : most;
  a.missed = calloc(a.elements, 1);
  int status = CAG_STATUS_OK;
  if (!a.missed || !prepare(&a, &script, &err))
    status = cag_tool_fail(b->tool, cag_exit_status(&err), err.help, "%s", err.message);
  if (status == CAG_STATUS_OK) status = keep_in_journal(b, CAG_JOURNAL_SUBMITTED, a.name);
  if (status == CAG_STATUS_OK && submit(&a, script)) status = follow(&a, &over);
  if (status == CAG_STATUS_OK && over) status = finish(&a);
  free(script);
  free_array(&a);
  return status;
}

int cag_slurm_run(CagBatch *b) {
  bool over = true;
  int status = *b->journal.job ? take_up(b, &over) : CAG_STATUS_OK;
  if (status == CAG_STATUS_OK && over) status = hand_in(b);
  cag_batch_fail_joins(b);
  return status == CAG_STATUS_OK ? cag_batch_run_joins(b) : status;
}
