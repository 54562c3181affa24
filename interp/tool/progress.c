// A bar on one line of the terminal, drawn over itself.

#include "interp/tool/progress.h"

#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

// Columns beside the bar, for the frame, the percentage and the phase; and the widest bar.
#define BESIDE 44
#define WIDEST 40

void cag_progress_begin(CagProgress *p, const CagTool *t) {
  *p = (CagProgress){.shown = isatty(STDERR_FILENO) && !t->quiet && t->style != CAG_STYLE_JSON,
                     .first = t->first_frame,
                     .frame = t->first_frame,
                     .last = t->last_frame,
                     .tenths = -1};
}

static int bar_width(void) {
  struct winsize w = {0};
  const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &w) == 0 && w.ws_col ? w.ws_col : 80;
  const int room = columns - BESIDE;
  return room < 0 ? 0 : room > WIDEST ? WIDEST : room;
}

void cag_progress_show(void *context, double percent, const char *phase) {
  CagProgress *p = context;
  const int tenths = percent < 0 ? 0 : percent > 100 ? 1000 : (int)(10 * percent);
  if (!p->shown || (p->dirty && tenths == p->tenths && !strcmp(phase, p->phase))) return;
  const int width = bar_width(), full = width * tenths / 1000;
  fputs("\r\033[K", stderr);
  if (p->last > p->first) fprintf(stderr, "frame %ld of %ld..%ld  ", p->frame, p->first, p->last);
  if (width > 0) fputc('[', stderr);
  for (int i = 0; i < width; i++) fputc(i < full ? '#' : '-', stderr);
  fprintf(stderr, "%s%3d%% %s", width > 0 ? "] " : "", tenths / 10, phase);
  fflush(stderr);
  p->dirty = true;
  p->tenths = tenths;
  p->phase = phase;
}

void cag_progress_end(CagProgress *p) {
  if (p->dirty) fputs("\r\033[K", stderr);
  p->dirty = false;
}
