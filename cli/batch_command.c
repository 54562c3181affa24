// The command line of a task's process: `cag render` or `cag export` of this program.

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "cli/batch.h"
#include "cli/tiles.h"

// A sequence of words, each terminated by a zero.
typedef struct {
  FILE *out;
  size_t count;
} Words;

static void add(Words *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(Words *w, const char *format, ...) {
  va_list args;
  va_start(args, format);
  vfprintf(w->out, format, args);
  va_end(args);
  fputc('\0', w->out);
  w->count++;
}

// Adds a path in a form that is neither an option nor standard input.
static void add_path(Words *w, const char *before, const char *path) {
  add(w, "%s%s%s", before, *path == '-' ? "./" : "", path);
}

// The output of a frame is parsed as a pattern again, so a % is written as %%.
static void add_output(Words *w, const char *path, bool film) {
  fputs("-o=", w->out);
  if (*path == '-') fputs("./", w->out);
  for (; *path; path++) {
    if (film && *path == '%') fputc('%', w->out);
    fputc(*path, w->out);
  }
  add(w, "%s", "");
}

static void add_film(const CagBatch *b, const CagBatchRow *row, long frame, Words *w) {
  add(w, "--frames=%ld..%ld", frame, frame);
  if (b->tool->loop) add(w, "--loop");
  for (size_t i = 0; i < b->tool->define_count; i++)
    if (!strcmp(b->tool->defines[i].name, "frames")) return;
  add(w, "-Dframes=%ld", row->last + 1);
}

static void add_picture(const CagBatch *b, const CagTask *task, int threads, Words *w) {
  const CagBatchRow *row = &b->rows[task->row];
  char *const *cells = b->jobs.rows[task->row].cells;
  static const CagJobColumn AS_THEY_ARE[] = {CAG_JOB_size, CAG_JOB_quality, CAG_JOB_engine,
                                             CAG_JOB_camera};
  for (size_t i = 0; i < sizeof AS_THEY_ARE / sizeof *AS_THEY_ARE; i++)
    if (cells[AS_THEY_ARE[i]])
      add(w, "--%s=%s", cag_job_column_names[AS_THEY_ARE[i]], cells[AS_THEY_ARE[i]]);
  if (row->film) add_film(b, row, task->frame, w);
  if (task->tile >= 0) {
    const CagRenderRegion r =
        cag_tile(row->width, row->height, row->tile_columns, row->lines, task->tile);
    add(w, "--region=%dx%d+%d+%d", r.width, r.height, r.x, r.y);
  }
  add(w, "--threads=%d", threads);
}

// Adds numbers with all their digits.
static void add_limits(const CagTool *t, Words *w) {
  const CagSessionOptions *o = &t->session;
  add(w, "--max-memory=%zu", o->max_memory);
  add(w, "--max-depth=%zu", o->max_depth);
  add(w, "--max-triangles=%zu", o->max_triangles);
  if (o->max_time > 0) add(w, "--max-time=%.17g", o->max_time);
}

static void add_words(const CagBatch *b, const CagTask *task, int threads, Words *w) {
  const CagTool *t = b->tool;
  const CagJob *job = &b->jobs.rows[task->row];
  const bool renders = b->rows[task->row].renders;
  add(w, "%s", b->program);
  add(w, "%s", renders ? "render" : "export");
  add_path(w, "", job->cells[CAG_JOB_script]);
  add_output(w, task->output, b->rows[task->row].film);
  if (renders) add_picture(b, task, threads, w);
  if (job->cells[CAG_JOB_tolerance]) add(w, "--tolerance=%s", job->cells[CAG_JOB_tolerance]);
  else if (t->session.tolerance > 0) add(w, "--tolerance=%.17g", t->session.tolerance);
  for (size_t i = 0; i < t->define_count; i++)
    add(w, "-D%s=%s", t->defines[i].name, t->defines[i].value);
  for (size_t i = 0; i < job->param_count; i++)
    add(w, "-D%s=%s", job->params[i].name, job->params[i].value);
  for (size_t i = 0; i < t->session.module_path_count; i++)
    add_path(w, "-I=", t->session.module_path[i]);
  add_limits(t, w);
  add(w, "--diagnostics=json");
  add(w, "-q");
}

char **cag_batch_command(const CagBatch *b, const CagTask *task, int threads) {
  char *bytes = NULL;
  size_t size = 0;
  Words w = {.out = open_memstream(&bytes, &size)};
  if (task->joins || !w.out) return w.out ? fclose(w.out), free(bytes), NULL : NULL;
  add_words(b, task, threads, &w);
  const bool failed = fclose(w.out) != 0;
  const size_t table = (w.count + 1) * sizeof(char *);
  char **words = failed ? NULL : malloc(table + size);
  if (words) {
    char *at = memcpy((char *)words + table, bytes, size);
    for (size_t i = 0; i < w.count; i++, at += strlen(at) + 1) words[i] = at;
    words[w.count] = NULL;
  }
  free(bytes);
  return words;
}
