// The results of tasks: recording them, restoring those of earlier calls, and totals of rows.

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/batch.h"

// A task is done if the journal says so and its output exists. The tiles of a finished picture have
// been removed.
void cag_batch_recall(CagBatch *b) {
  for (size_t i = 0; i < b->task_count; i++) {
    CagTask *task = &b->tasks[i];
    const CagJournalEntry *e = cag_journal_find(&b->journal, task->key);
    struct stat st;
    char *path = e && e->what == CAG_JOURNAL_DONE ? cag_batch_path(b, task->output) : NULL;
    const bool there = path && stat(path, &st) == 0 && st.st_size > 0;
    free(path);
    if (!there) continue;
    task->state = CAG_TASK_KEPT;
    task->seconds = e->seconds;
    task->memory = e->memory;
    task->attempts = e->attempts;
    for (int k = 1; k <= task->joins; k++) b->tasks[i - (size_t)k].state = CAG_TASK_KEPT;
  }
}

void cag_batch_fail_joins(CagBatch *b) {
  for (size_t i = 0; i < b->task_count; i++) {
    CagTask *task = &b->tasks[i];
    bool failed = false;
    for (int k = 1; k <= task->joins; k++)
      failed |= b->tasks[i - (size_t)k].state == CAG_TASK_FAILED;
    if (!failed || task->state != CAG_TASK_WAITING) continue;
    task->state = CAG_TASK_FAILED;
    task->status = CAG_STATUS_SCRIPT;
    task->message = strdup("a tile of the picture is missing");
  }
}

static void tell_task(const CagBatch *b, const CagTask *task) {
  char place[64] = "", *message = NULL;
  const CagBatchRow *row = &b->rows[task->row];
  if (row->film) snprintf(place, sizeof place, "frame %ld: ", task->frame);
  if (task->tile >= 0)
    snprintf(place + strlen(place), sizeof place - strlen(place), "tile %d of %d: ", task->tile + 1,
             row->tile_columns * row->lines);
  if (asprintf(&message, "%s%s", place, task->message ? task->message : "it failed") < 0) return;
  cag_batch_tell_row(b, task->row, "E0917", message);
  free(message);
}

int cag_batch_end_task(CagBatch *b, CagTask *task) {
  const bool done = task->state == CAG_TASK_DONE;
  CagJournalEntry entry = {.what = done ? CAG_JOURNAL_DONE : CAG_JOURNAL_FAILED,
                           .seconds = task->seconds,
                           .memory = task->memory,
                           .attempts = task->attempts};
  strcpy(entry.key, task->key);
  if (!done) tell_task(b, task);
  else if (b->tool->verbose && task->tile >= 0)
    cag_tool_say(b->tool, "row %zu: tile %d of %d in %.1f s", b->jobs.rows[task->row].number,
                 task->tile + 1, b->rows[task->row].tile_columns * b->rows[task->row].lines,
                 task->seconds);
  else if (b->tool->verbose)
    cag_tool_say(b->tool, "row %zu: wrote %s in %.1f s with %.0f MB",
                 b->jobs.rows[task->row].number, task->output, task->seconds,
                 (double)task->memory / 1e6);
  CagError err;
  if (cag_journal_write(&b->journal, &entry, &err)) return CAG_STATUS_OK;
  return cag_tool_fail(b->tool, cag_exit_status(&err), err.help, "%s", err.message);
}

CagRowSum cag_batch_sum(const CagBatch *b, size_t row) {
  CagRowSum sum = {.state = CAG_ROW_KEPT};
  bool waits = false;
  for (size_t i = 0; i < b->rows[row].task_count; i++) {
    const CagTask *task = &b->tasks[b->rows[row].task + i];
    sum.seconds += task->seconds;
    if (task->memory > sum.memory) sum.memory = task->memory;
    if (task->attempts > sum.attempts) sum.attempts = task->attempts;
    if (task->state == CAG_TASK_FAILED && !sum.failed) sum.failed = task;
    if (task->state == CAG_TASK_DONE) sum.state = CAG_ROW_DONE;
    waits |= task->state == CAG_TASK_WAITING || task->state == CAG_TASK_RUNNING;
  }
  if (sum.failed) {
    sum.state = CAG_ROW_FAILED;
    sum.status = sum.failed->status;
  } else if (waits) {
    sum.state = CAG_ROW_WAITING;
  }
  return sum;
}
