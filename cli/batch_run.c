// Runs the tasks of a batch on this machine.
//
// A single thread starts processes while there is room, waits until one writes something or ends,
// and records the results in the journal. A failed task is queued again, after the others, as long
// as retries are left.

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/clock.h"
#include "cli/batch.h"
#include "cli/batch_child.h"
#include "cli/batch_load.h"
#include "cli/batch_progress.h"
#include "cli/batch_result.h"
#include "cli/tiles.h"

// Milliseconds between checks of everything: normally, while more processes may be started, and
// while a process with closed output is about to end.
#define LOOK_INTERVAL 50
#define LOOK_INTERVAL_WAITING 10
#define LOOK_INTERVAL_CLOSED 1

// Seconds between checks of memory.
#define MEMORY_INTERVAL 0.5

// Memory that a row's processes may use in addition to --max-memory, which limits the values of its
// script.
#define MEMORY_BESIDE ((size_t)64 << 20)

// A process enforces --max-time itself, and reports where it was. It is stopped only if it does
// not.
#define TIME_FACTOR 1.1
#define TIME_BESIDE 1.0

typedef struct {
  CagChild child;
  CagTask *task;
} Slot;

typedef struct {
  CagBatch *batch;
  Slot *slots;
  size_t running, capacity;
  size_t next;    // tasks before it are not waiting, except for those queued again
  bool again;     // there may be some of these
  bool joins;     // run only tasks that join tiles
  size_t waiting; // number of tasks to start
  CagLoad load;
  CagBatchProgress progress;
  size_t limit_memory; // of a row's processes; 0: unlimited
  double memory_seen;
  int status;
} Run;

// --- Selecting tasks ---

static bool is_ready(const Run *r, const CagTask *task) {
  if (task->state != CAG_TASK_WAITING || (r->joins && !task->joins)) return false;
  for (int k = 1; k <= task->joins; k++)
    if (task[-k].state != CAG_TASK_DONE && task[-k].state != CAG_TASK_KEPT) return false;
  return true;
}

static CagTask *choose(Run *r) {
  CagBatch *b = r->batch;
  for (;;) {
    for (; r->next < b->task_count; r->next++)
      if (is_ready(r, &b->tasks[r->next])) return &b->tasks[r->next++];
    if (!r->again) return NULL;
    r->again = false;
    r->next = 0;
  }
}

// --- Joining tiles, in a separate process ---

typedef struct {
  const CagBatch *batch;
  const CagTask *task;
} Join;

static int join(void *context) {
  const Join *j = context;
  const CagTask *task = j->task;
  const CagBatchRow *row = &j->batch->rows[task->row];
  char **tiles = calloc((size_t)task->joins, sizeof *tiles);
  char *output = cag_batch_path(j->batch, task->output);
  CagError err = {.status = CAG_E_LIMIT, .message = "out of memory"};
  bool ok = tiles && output;
  for (int i = 0; ok && i < task->joins; i++)
    ok = (tiles[i] = cag_batch_path(j->batch, task[i - task->joins].output)) != NULL;
  ok = ok && cag_tiles_join((const char *const *)tiles, row->tile_columns, row->lines, row->width,
                            row->height, output, &err);
  for (int i = 0; tiles && i < task->joins; i++) free(tiles[i]);
  free(tiles);
  free(output);
  if (ok) return CAG_STATUS_OK;
  fprintf(stderr, "%s\n", err.message);
  return cag_exit_status(&err);
}

static void remove_tiles(const CagBatch *b, const CagTask *task) {
  for (int i = 1; i <= task->joins; i++) {
    char *path = cag_batch_path(b, task[-i].output);
    if (path) remove(path);
    free(path);
  }
}

// --- Starting and ending ---

static double hard_limit(const CagTool *t) {
  return t->session.max_time > 0 ? TIME_FACTOR * t->session.max_time + TIME_BESIDE : 0;
}

// Ends a task that could not be started.
static void fail_start(Run *r, CagTask *task, const char *why) {
  task->state = CAG_TASK_FAILED;
  task->status = CAG_STATUS_LIMIT;
  task->message = strdup(why);
  r->waiting--;
  r->status = cag_batch_end_task(r->batch, task);
}

// Returns false if the system cannot create a process now; the task then waits.
static bool start(Run *r, CagTask *task) {
  CagBatch *b = r->batch;
  Slot *slot = &r->slots[r->running];
  Join work = {b, task};
  char **words = task->joins ? NULL : cag_batch_command(b, task, b->threads);
  const bool started = task->joins ? cag_child_start_work(&slot->child, join, &work, 0)
                                   : words && cag_child_start(&slot->child, words, b->folder,
                                                              hard_limit(b->tool), false);
  const int code = errno;
  free(words);
  task->attempts++;
  if (!started && r->running) {
    task->attempts--;
    r->again = true;
    cag_load_refused(&r->load, r->running);
    return false;
  }
  if (!started) {
    fail_start(r, task, strerror(code));
    return true;
  }
  task->state = CAG_TASK_RUNNING;
  slot->task = task;
  r->running++;
  r->waiting--;
  return true;
}

// Records the result of a task in the journal, or queues the task again.
static void end(Run *r, Slot *slot) {
  CagBatch *b = r->batch;
  CagTask *task = slot->task;
  task->seconds += slot->child.seconds;
  if (slot->child.memory > task->memory) task->memory = slot->child.memory;
  cag_load_ended(&r->load, slot->child.memory);
  free(task->message);
  task->status =
      cag_child_result(&slot->child, b->tool->session.max_time, r->limit_memory, &task->message);
  cag_child_free(&slot->child);
  r->again = true; // the task that joins this tile, or this task again
  if (task->status != CAG_STATUS_OK && (size_t)task->attempts <= b->tool->retries) {
    task->state = CAG_TASK_WAITING;
    r->waiting++;
    return;
  }
  task->state = task->status == CAG_STATUS_OK ? CAG_TASK_DONE : CAG_TASK_FAILED;
  cag_batch_progress_clear(&r->progress);
  const int status = cag_batch_end_task(b, task);
  if (r->status == CAG_STATUS_OK) r->status = status;
  if (task->state == CAG_TASK_DONE) remove_tiles(b, task);
}

static void check_children(Run *r) {
  for (size_t i = 0; i < r->running;) {
    Slot slot = r->slots[i];
    if (!cag_child_look(&r->slots[i].child)) {
      i++;
      continue;
    }
    slot = r->slots[i];
    r->slots[i] = r->slots[--r->running];
    end(r, &slot);
  }
}

// Stops processes that use too much memory.
static void see_to_memory(Run *r) {
  const double now = cag_clock_seconds();
  if (!r->limit_memory || !r->running || now - r->memory_seen < MEMORY_INTERVAL) return;
  r->memory_seen = now;
  pid_t *processes = malloc(r->running * sizeof *processes);
  size_t *bytes = malloc(r->running * sizeof *bytes);
  for (size_t i = 0; processes && i < r->running; i++) processes[i] = r->slots[i].child.pid;
  if (processes && bytes) {
    cag_load_memory(CAG_LOAD_PROC, processes, r->running, bytes);
    for (size_t i = 0; i < r->running; i++)
      if (bytes[i] > r->limit_memory + MEMORY_BESIDE)
        cag_child_stop(&r->slots[i].child, CAG_CHILD_STOP_MEMORY);
  }
  free(processes);
  free(bytes);
}

static void wait_for_news(Run *r, struct pollfd *waiting) {
  bool closed = false;
  for (size_t i = 0; i < r->running; i++) {
    waiting[i] = (struct pollfd){.fd = r->slots[i].child.said, .events = POLLIN};
    closed |= waiting[i].fd < 0;
  }
  const int interval = closed                                   ? LOOK_INTERVAL_CLOSED
                       : r->waiting && r->running < r->capacity ? LOOK_INTERVAL_WAITING
                                                                : LOOK_INTERVAL;
  poll(waiting, r->running, interval);
}

// After Ctrl-C: stops all processes. Unfinished tasks wait for the next call.
static void stop_all(Run *r, struct pollfd *waiting) {
  for (size_t i = 0; i < r->running; i++) cag_child_stop(&r->slots[i].child, CAG_CHILD_STOP_ASKED);
  while (r->running) {
    wait_for_news(r, waiting);
    for (size_t i = 0; i < r->running;) {
      if (!cag_child_look(&r->slots[i].child)) {
        i++;
        continue;
      }
      r->slots[i].task->state = CAG_TASK_WAITING;
      cag_child_free(&r->slots[i].child);
      r->slots[i] = r->slots[--r->running];
    }
  }
}

static void begin_more(Run *r) {
  while (r->running < r->capacity &&
         r->running < cag_load_limit(&r->load, r->running, r->waiting)) {
    CagTask *task = choose(r);
    if (!task || !start(r, task)) return;
  }
}

static void sync_journal(Run *r) {
  CagError err;
  if (cag_journal_sync(&r->batch->journal, &err)) return;
  const int status =
      cag_tool_fail(r->batch->tool, cag_exit_status(&err), err.help, "%s", err.message);
  if (r->status == CAG_STATUS_OK) r->status = status;
}

static size_t count_waiting(const Run *r) {
  size_t n = 0;
  for (size_t i = 0; i < r->batch->task_count; i++)
    n += r->batch->tasks[i].state == CAG_TASK_WAITING && (!r->joins || r->batch->tasks[i].joins);
  return n;
}

static void run_all(Run *r, struct pollfd *waiting) {
  while (r->status == CAG_STATUS_OK && !cag_tool_interrupt) {
    begin_more(r);
    if (!r->running) return;
    wait_for_news(r, waiting);
    check_children(r);
    begin_more(r); // before the journal is written, which takes time
    sync_journal(r);
    see_to_memory(r);
    cag_batch_progress_show(&r->progress, r->batch, r->running);
  }
}

static int run(CagBatch *b, bool joins) {
  CagSessionOptions usual;
  cag_session_options_init(&usual);
  const size_t given = b->tool->session.max_memory;
  Run r = {.batch = b,
           .joins = joins,
           .capacity = b->workers * CAG_LOAD_MOST,
           .limit_memory = given != usual.max_memory ? given : 0};
  r.slots = calloc(r.capacity, sizeof *r.slots);
  struct pollfd *waiting = calloc(r.capacity, sizeof *waiting);
  if (r.slots && waiting) {
    cag_load_begin(&r.load, b->workers, CAG_LOAD_PROC);
    r.waiting = count_waiting(&r);
    cag_batch_progress_begin(&r.progress, b);
    run_all(&r, waiting);
    sync_journal(&r);
    stop_all(&r, waiting);
    cag_batch_progress_clear(&r.progress);
    cag_batch_fail_joins(b);
  } else {
    r.status = cag_tool_fail(b->tool, CAG_STATUS_LIMIT, NULL, "out of memory");
  }
  free(r.slots);
  free(waiting);
  return cag_tool_interrupt ? CAG_STATUS_INTERRUPTED : r.status;
}

int cag_batch_run(CagBatch *b) { return run(b, false); }

int cag_batch_run_joins(CagBatch *b) { return run(b, true); }
