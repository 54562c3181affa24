// A line such as `[#######-------] 37 of 200 done, 2 at work, 1 failed, 0:41 left`.

#include "cli/batch_progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/batch_child.h"

// Columns beside the bar, and the maximum width of the bar.
#define BESIDE 60
#define WIDEST 30

// Seconds between two drawings.
#define DRAW_INTERVAL 0.1

typedef struct {
  size_t done, failed, waiting;
} Counts;

static Counts count(const CagBatch *b) {
  Counts c = {0};
  for (size_t i = 0; i < b->task_count; i++) {
    const CagTaskState s = b->tasks[i].state;
    c.done += s == CAG_TASK_DONE || s == CAG_TASK_KEPT;
    c.failed += s == CAG_TASK_FAILED;
    c.waiting += s == CAG_TASK_WAITING || s == CAG_TASK_RUNNING;
  }
  return c;
}

void cag_batch_progress_begin(CagBatchProgress *p, const CagBatch *b) {
  const CagTool *t = b->tool;
  *p = (CagBatchProgress){.shown = isatty(STDERR_FILENO) && !t->quiet && t->style != CAG_STYLE_JSON,
                          .begun = cag_clock_seconds(),
                          .left = count(b).waiting};
}

static int bar_width(void) {
  struct winsize w = {0};
  const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &w) == 0 && w.ws_col ? w.ws_col : 80;
  const int room = columns - BESIDE;
  return room < 0 ? 0 : room > WIDEST ? WIDEST : room;
}

// Writes the estimated remaining time, at the current pace.
static void write_rest(const CagBatchProgress *p, const Counts *c) {
  const size_t ended = p->left - (c->waiting < p->left ? c->waiting : p->left);
  if (!ended || !c->waiting) return;
  const double seconds = (p->seen - p->begun) / (double)ended * (double)c->waiting;
  const long minutes = (long)(seconds / 60);
  fprintf(stderr, ", %ld:%02ld left", minutes, (long)seconds - 60 * minutes);
}

void cag_batch_progress_show(CagBatchProgress *p, const CagBatch *b, size_t at_work) {
  const double now = cag_clock_seconds();
  if (!p->shown || now - p->seen < DRAW_INTERVAL) return;
  p->seen = now;
  const Counts c = count(b);
  const int width = bar_width();
  const int full = (int)((double)width * (double)(c.done + c.failed) / (double)b->task_count);
  fputs("\r\033[K", stderr);
  if (width > 0) fputc('[', stderr);
  for (int i = 0; i < width; i++) fputc(i < full ? '#' : '-', stderr);
  fprintf(stderr, "%s%zu of %zu done, %zu running", width > 0 ? "] " : "", c.done, b->task_count,
          at_work);
  if (c.failed) fprintf(stderr, ", %zu failed", c.failed);
  write_rest(p, &c);
  fflush(stderr);
}

void cag_batch_progress_clear(CagBatchProgress *p) {
  if (p->shown && p->seen > 0) fputs("\r\033[K", stderr);
}
