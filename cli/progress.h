// The progress of a renderer: a bar on a terminal, or, on request, lines on a pipe.

#ifndef CAG_CLI_PROGRESS_H
#define CAG_CLI_PROGRESS_H

#include "cli/tool.h"

typedef struct CagProgress {
  bool shown; // standard error is a terminal, and progress is wanted
  long frame, first, last;
  bool dirty;        // whether the bar is on the screen
  int tenths;        // shown value in tenths; the bar is redrawn only when it changes; -1: nothing
  const char *phase; // phase of the renderer; NULL: not started
  bool lines;        // print lines instead of a bar; `tenths` then belongs to the last line
  // Start times of this picture and its phase, and the time of the last line; 0: nothing rendered
  // yet.
  double begun, phase_begun, line_time;
  long begun_frame;
} CagProgress;

void cag_progress_begin(CagProgress *p, const CagTool *t);
// For CagRenderOptions; the context is the CagProgress.
void cag_progress_show(void *context, double percent, const char *phase);
// Clears the bar.
void cag_progress_end(CagProgress *p);

#endif
