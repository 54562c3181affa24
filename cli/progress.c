// A bar on one line of the terminal, or, with --progress, lines without a terminal. Both show the
// estimated time left at the current pace.

#include "cli/progress.h"

#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"

// Columns beside the bar for the frame, the percentage, and the phase; and the maximum width of the
// bar.
#define BESIDE 64
#define WIDEST 40
// Seconds of a picture after which its pace is meaningful.
#define PACE_TIME 1.0
// Minimum percentage between two lines, and minimum seconds.
#define LINE_PERCENT 10
#define LINE_TIME 10.0

void cag_progress_begin(CagProgress *p, const CagTool *t) {
  const bool bar = isatty(STDERR_FILENO) && !t->quiet && t->style != CAG_STYLE_JSON;
  *p = (CagProgress){.shown = bar,
                     .lines = t->progress && !bar,
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

// Formats ", about 40 s left", estimated from the pace of the current phase and the remaining
// pictures of the film. The text is empty until an estimate is possible.
static void left_words(const CagProgress *p, double percent, char *out, size_t size) {
  const double at = cag_clock_seconds(), spent = at - p->phase_begun;
  out[0] = '\0';
  if (!(percent > 1) || spent < PACE_TIME) return;
  const double here = spent * (100 - percent) / percent;
  const double left = here + (double)(p->last - p->frame) * (at - p->begun + here);
  if (left < 100) snprintf(out, size, ", about %.0f s left", left);
  else snprintf(out, size, ", about %.0f min left", left / 60);
}

static void show_line(CagProgress *p, double percent, const char *phase) {
  const double at = cag_clock_seconds();
  const int part = (int)percent / LINE_PERCENT;
  if (part <= p->tenths && at - p->line_time < LINE_TIME) return;
  char left[64];
  left_words(p, percent, left, sizeof left);
  if (p->last > p->first) fprintf(stderr, "frame %ld of %ld..%ld: ", p->frame, p->first, p->last);
  fprintf(stderr, "%.0f%% %s%s\n", percent, phase, left);
  fflush(stderr);
  p->tenths = part;
  p->line_time = at;
}

void cag_progress_show(void *context, double percent, const char *phase) {
  CagProgress *p = context;
  if (!(p->begun > 0) || p->begun_frame != p->frame) {
    p->begun = p->line_time = cag_clock_seconds();
    p->begun_frame = p->frame;
  }
  if (!p->phase || strcmp(phase, p->phase) != 0) {
    p->phase = phase;
    p->phase_begun = cag_clock_seconds();
    p->tenths = -1;
  }
  if (p->lines) {
    show_line(p, percent, phase);
    return;
  }
  const int tenths = percent < 0 ? 0 : percent > 100 ? 1000 : (int)(10 * percent);
  if (!p->shown || (p->dirty && tenths == p->tenths)) return;
  const int width = bar_width(), full = width * tenths / 1000;
  fputs("\r\033[K", stderr);
  if (p->last > p->first) fprintf(stderr, "frame %ld of %ld..%ld  ", p->frame, p->first, p->last);
  if (width > 0) fputc('[', stderr);
  for (int i = 0; i < width; i++) fputc(i < full ? '#' : '-', stderr);
  char left[64];
  left_words(p, percent, left, sizeof left);
  fprintf(stderr, "%s%3d%% %s%s", width > 0 ? "] " : "", tenths / 10, phase, left);
  fflush(stderr);
  p->dirty = true;
  p->tenths = tenths;
}

void cag_progress_end(CagProgress *p) {
  if (p->dirty) fputs("\r\033[K", stderr);
  p->dirty = false;
  p->tenths = -1;
  p->begun = 0;
  p->phase = NULL;
}
