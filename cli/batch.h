// A batch: the rows of a job file, the tasks of which they consist, and their results.
//
// A task is one process: an export, a picture, a frame of a film, or a tile of a picture. If there
// are tiles, a final task joins them. Tasks are the unit of parallel execution, of the journal, and
// of queues. A task's key is a hash of everything on which its output depends: the fields of its
// row, the command-line options that affect results, and the contents of the script and of the
// files that it names. A row is done when all its tasks are done.
//
// Processes start in the folder of the job file, so that paths in rows can be used as written.

#ifndef CAG_CLI_BATCH_H
#define CAG_CLI_BATCH_H

#include "cli/jobs.h"
#include "cli/journal.h"
#include "cli/tool.h"

typedef enum CagTaskState {
  CAG_TASK_WAITING,
  CAG_TASK_RUNNING,
  CAG_TASK_DONE,   // by this call
  CAG_TASK_KEPT,   // by an earlier one
  CAG_TASK_FAILED, // its last attempt
} CagTaskState;

typedef struct CagTask {
  size_t row;   // index of its row
  long frame;   // of a film
  int tile;     // index of the tile, row by row from the top; -1: none
  int joins;    // number of preceding tasks whose tiles it joins; 0: none
  char *output; // path of the output, relative to the folder of the job file
  char key[CAG_JOURNAL_KEY_SIZE];
  CagTaskState state;
  int attempts;
  double seconds; // of all attempts
  size_t memory;  // largest memory of its processes, in bytes
  int status;     // exit status of the last attempt
  char *message;  // why it failed, or NULL
} CagTask;

// Properties of a row that are derived from its fields.
typedef struct CagBatchRow {
  bool renders;            // a picture; otherwise an export
  bool film;               // frames were given
  long first, last;        // frames
  int width, height;       // of a picture in tiles
  int tile_columns, lines; // of tiles; 0: none
  size_t task, task_count;
} CagBatchRow;

typedef struct CagBatch {
  CagTool *tool;
  const char *path; // of the job file
  char *folder;     // absolute, of that file
  char *program;    // path of this program
  char *journal_path, *report_path, *tiles_folder, *queue_folder;
  CagJobs jobs;
  CagBatchRow *rows; // parallel to jobs.rows
  CagTask *tasks;
  size_t task_count, task_capacity;
  CagJournal journal;
  size_t workers; // processors to keep busy
  int threads;    // of each renderer
  bool owns_module_path;
} CagBatch;

typedef enum CagRowState {
  CAG_ROW_DONE,
  CAG_ROW_KEPT,
  CAG_ROW_FAILED,
  CAG_ROW_WAITING
} CagRowState;

// The result of a row, summed up from its tasks.
typedef struct CagRowSum {
  CagRowState state;
  double seconds;
  size_t memory;
  int attempts, status;
  const CagTask *failed; // its first failed task, or NULL
} CagRowSum;
CagRowSum cag_batch_sum(const CagBatch *b, size_t row);

// --- batch_check.c ---

// Checks all rows and makes the tasks. Adds errors to b->jobs.problems. Returns false if memory ran
// out.
bool cag_batch_check(CagBatch *b);

// Converts a path to an absolute one, allocated with malloc, or NULL.
char *cag_batch_path(const CagBatch *b, const char *path);

// --- batch_key.c ---

// Computes the keys of all tasks. Returns false if memory ran out.
bool cag_batch_make_keys(CagBatch *b);

// --- batch_command.c ---

// Returns the words of a task's command, ending with NULL, in one malloc'd block, or NULL for a
// task that joins tiles. `threads` is the renderer's number of threads.
char **cag_batch_command(const CagBatch *b, const CagTask *task, int threads);

// --- batch_run.c ---

// Runs the waiting tasks on this machine. Returns CAG_STATUS_OK if each was done or failed,
// CAG_STATUS_INTERRUPTED, or, after a message, the status of a journal that cannot be written.
int cag_batch_run(CagBatch *b);
// Runs only the tasks that join tiles and whose tiles are done.
int cag_batch_run_joins(CagBatch *b);

// --- batch_end.c ---

// Records the result of a task in the journal, and shows it. Returns a status.
int cag_batch_end_task(CagBatch *b, CagTask *task);
// Restores from the journal the results of earlier calls whose outputs still exist.
void cag_batch_recall(CagBatch *b);
// Fails the waiting tasks that join tiles of which one failed.
void cag_batch_fail_joins(CagBatch *b);

// --- batch_report.c ---

// Writes all problems to standard error, in the order of the rows.
void cag_batch_tell_problems(CagBatch *b);
// Writes an error of a row to standard error.
void cag_batch_tell_row(const CagBatch *b, size_t row, const char *code, const char *message);
bool cag_batch_write_report(const CagBatch *b, CagError *err);
// Writes the summary line, and returns the exit status of the program.
int cag_batch_close(const CagBatch *b, bool interrupted);

#endif
