// The progress bar of a renderer, on a terminal; on a pipe lines, when asked for.

#ifndef CAG_INTERP_TOOL_PROGRESS_H
#define CAG_INTERP_TOOL_PROGRESS_H

#include "interp/tool/tool.h"

typedef struct CagProgress {
  bool shown; // standard error is a terminal, and is to be used
  long frame, first, last;
  bool dirty;        // the bar stands on the line
  int tenths;        // what it shows, so that it is drawn only when that changes; -1: nothing
  const char *phase; // of the renderer; NULL: not begun
  bool lines;        // instead of a bar; `tenths` is then of the last one
  // Of this picture, its phase, and the last line; 0: nothing rendered yet.
  double begun, phase_begun, line_time;
  long begun_frame;
} CagProgress;

void cag_progress_begin(CagProgress *p, const CagTool *t);
// For CagRenderOptions; the context is the CagProgress.
void cag_progress_show(void *context, double percent, const char *phase);
// Takes the bar away.
void cag_progress_end(CagProgress *p);

#endif
