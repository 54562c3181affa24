// The progress of a batch on one line of the terminal; nothing on a pipe.

#ifndef CAG_CLI_BATCH_PROGRESS_H
#define CAG_CLI_BATCH_PROGRESS_H

#include "cli/batch.h"

typedef struct CagBatchProgress {
  bool shown;         // standard error is a terminal, and is to be used
  double begun, seen; // seconds; when it began, when it was drawn
  size_t left;        // tasks that were waiting when it began
} CagBatchProgress;

void cag_batch_progress_begin(CagBatchProgress *p, const CagBatch *b);
// Draws it, a few times a second however often it is called. `at_work` are processes or, with a
// queue, its tasks.
void cag_batch_progress_show(CagBatchProgress *p, const CagBatch *b, size_t at_work);
// Takes it away, before something is said.
void cag_batch_progress_clear(CagBatchProgress *p);

#endif
