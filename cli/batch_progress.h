// The progress of a batch on one line of the terminal. Nothing is shown on a pipe.

#ifndef CAG_CLI_BATCH_PROGRESS_H
#define CAG_CLI_BATCH_PROGRESS_H

#include "cli/batch.h"

typedef struct CagBatchProgress {
  bool shown;         // standard error is a terminal, and progress is wanted
  double begun, seen; // time of the start and of the last drawing, in seconds
  size_t left;        // number of tasks that were waiting at the start
} CagBatchProgress;

void cag_batch_progress_begin(CagBatchProgress *p, const CagBatch *b);
// Draws the line, at most a few times per second. `at_work` counts processes or, with a queue, its
// tasks.
void cag_batch_progress_show(CagBatchProgress *p, const CagBatch *b, size_t at_work);
// Clears the line, before a message is written.
void cag_batch_progress_clear(CagBatchProgress *p);

#endif
