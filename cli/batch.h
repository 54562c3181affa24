// A batch: the rows of a file of jobs, the tasks that they are made of, and what became of them.
//
// A task is one process: an export, one picture, one frame of a film, or one tile of a picture;
// where there are tiles, a last task joins them. Tasks are what is run at once, kept in the
// journal, and handed to a queue. A task's key is a hash of all that its output depends on: what
// its row says, the options of the command line that change results, and the bytes of the script
// and of the files that it names. A row is done when its tasks are.
//
// Processes start in the folder of the file of jobs, so that the paths of rows can stay as they are
// written.

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
  int tile;     // of the picture's tiles, row after row from the top; -1: none
  int joins;    // how many tasks before this one are the tiles that it joins; 0: it joins none
  char *output; // what it writes, seen from the folder of the jobs
  char key[CAG_JOURNAL_KEY_SIZE];
  CagTaskState state;
  int attempts;
  double seconds; // of all attempts
  size_t memory;  // bytes, the most that one of its processes had
  int status;     // exit status of the last attempt
  char *message;  // why it failed, or NULL
} CagTask;

// What is known of a row beyond its texts.
typedef struct CagBatchRow {
  bool renders;            // a picture; else an export
  bool film;               // frames were given
  long first, last;        // frames
  int width, height;       // of a picture in tiles
  int tile_columns, lines; // of tiles; 0: none
  size_t task, task_count;
} CagBatchRow;

typedef struct CagBatch {
  CagTool *tool;
  const char *path; // of the file of jobs
  char *folder;     // absolute, of that file
  char *program;    // this one
  char *journal_path, *report_path, *tiles_folder, *queue_folder;
  CagJobs jobs;
  CagBatchRow *rows; // as jobs.rows
  CagTask *tasks;
  size_t task_count, task_capacity;
  CagJournal journal;
  size_t workers; // processors that are to be kept busy
  int threads;    // of each renderer
  bool owns_module_path;
} CagBatch;

typedef enum CagRowState {
  CAG_ROW_DONE,
  CAG_ROW_KEPT,
  CAG_ROW_FAILED,
  CAG_ROW_WAITING
} CagRowState;

// What became of a row, from its tasks.
typedef struct CagRowSum {
  CagRowState state;
  double seconds;
  size_t memory;
  int attempts, status;
  const CagTask *failed; // the first of its tasks that failed, or NULL
} CagRowSum;
CagRowSum cag_batch_sum(const CagBatch *b, size_t row);

// --- batch_check.c ---

// Looks at all rows and makes the tasks. What is wrong is added to b->jobs.problems. False: memory
// is out.
bool cag_batch_check(CagBatch *b);

// The path as seen from where the program runs: absolute, malloc'd, or NULL.
char *cag_batch_path(const CagBatch *b, const char *path);

// --- batch_key.c ---

// Gives the keys to all tasks. False: memory is out.
bool cag_batch_make_keys(CagBatch *b);

// --- batch_command.c ---

// The words of a task's command, NULL at the end, malloc'd in one piece. Of a task that joins
// tiles: NULL, it has none. `threads` are the renderer's.
char **cag_batch_command(const CagBatch *b, const CagTask *task, int threads);

// --- batch_run.c ---

// Runs the waiting tasks here. CAG_STATUS_OK when each was done or failed; CAG_STATUS_INTERRUPTED;
// the status of a journal that cannot be written, after a message.
int cag_batch_run(CagBatch *b);
// Runs only the tasks that join tiles, for those whose tiles are there.
int cag_batch_run_joins(CagBatch *b);

// --- batch_end.c ---

// Keeps what became of a task: in the journal, and for who watches. Gives a status.
int cag_batch_end_task(CagBatch *b, CagTask *task);
// Takes from the journal what an earlier call did and is still there.
void cag_batch_recall(CagBatch *b);
// Fails the waiting tasks that join tiles of which one failed.
void cag_batch_fail_joins(CagBatch *b);

// --- batch_report.c ---

// Says all problems on standard error, in the order of the rows.
void cag_batch_tell_problems(CagBatch *b);
// Says what is wrong with a row on standard error.
void cag_batch_tell_row(const CagBatch *b, size_t row, const char *code, const char *message);
bool cag_batch_write_report(const CagBatch *b, CagError *err);
// The closing line, and the status of the program.
int cag_batch_close(const CagBatch *b, bool interrupted);

#endif
