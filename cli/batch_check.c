// Checks the rows of a batch before anything runs, and divides them into tasks.
//
// Values are set on a temporary command line by the functions for the real one, so a column accepts
// exactly the values of its option.

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/atomic_file.h"
#include "cli/batch.h"
#include "cli/frames.h"
#include "cli/tiles.h"

#define CODE_VALUE "E0912"
#define CODE_SCRIPT "E0913"
#define CODE_TWICE "E0914"
#define CODE_PLACE "E0915"
#define CODE_FORMAT "E0916"

// The maximum number of tasks of a batch. More are probably a typing error.
#define TASKS_MAX 1000000

char *cag_batch_path(const CagBatch *b, const char *path) {
  char *out = NULL;
  if (*path == '/') return strdup(path);
  return asprintf(&out, "%s/%s", b->folder, path) < 0 ? NULL : out;
}

// --- The fields of a row ---

static const char *ending(const char *path) {
  const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
  const char *point = strrchr(name, '.');
  return point && point > name && point[1] ? point + 1 : NULL;
}

static bool is_picture(const char *format) {
  return !strcasecmp(format, "exr") || !strcasecmp(format, "png");
}

static bool is_export(const char *format) {
  for (const char *const *f = cag_export_formats(); *f; f++)
    if (!strcasecmp(format, *f)) return true;
  return false;
}

static bool check_script(CagBatch *b, const CagJob *job) {
  const char *name = job->cells[CAG_JOB_script];
  struct stat st;
  if (!name)
    return cag_jobs_problem(&b->jobs, job, CODE_SCRIPT, "name a .cag file",
                            "the script is missing");
  char *path = cag_batch_path(b, name);
  if (!path) return false;
  const char *why = NULL;
  if (!strcmp(name, "-")) why = "rows cannot share standard input";
  else if (stat(path, &st) != 0) why = strerror(errno);
  else if (!S_ISREG(st.st_mode)) why = "it is not a regular file";
  else if (access(path, R_OK) != 0) why = strerror(errno);
  free(path);
  if (!why) return true;
  return cag_jobs_problem(&b->jobs, job, CODE_SCRIPT,
                          *name == '/' ? NULL : "paths are relative to the folder of the table",
                          "cannot read the script '%s': %s", name, why);
}

static bool check_format(CagBatch *b, const CagJob *job, CagBatchRow *row) {
  const char *output = job->cells[CAG_JOB_output];
  if (!output)
    return cag_jobs_problem(&b->jobs, job, CODE_FORMAT, "name a file, such as vase.png",
                            "the output is missing");
  const char *format = ending(output);
  row->renders = format && is_picture(format);
  if (row->renders || (format && is_export(format))) return true;
  char help[300] = "the formats are .exr .png";
  for (const char *const *f = cag_export_formats(); *f; f++)
    if (!is_picture(*f)) snprintf(help + strlen(help), sizeof help - strlen(help), " .%s", *f);
  if (!format)
    return cag_jobs_problem(&b->jobs, job, CODE_FORMAT, help,
                            "the output '%s' has no extension that determines its format", output);
  return cag_jobs_problem(&b->jobs, job, CODE_FORMAT, help, "unknown format '.%s'", format);
}

// Sets the fields on a temporary command line, which stores their values.
static bool check_values(CagBatch *b, const CagJob *job, const CagBatchRow *row, CagTool *scratch) {
  static const CagJobColumn PICTURES[] = {CAG_JOB_frames, CAG_JOB_size,   CAG_JOB_quality,
                                          CAG_JOB_engine, CAG_JOB_camera, CAG_JOB_tiles};
  CagToolRefusal why;
  bool ok = true;
  for (size_t i = CAG_JOB_output + 1; ok && i < CAG_JOB_COLUMN_COUNT; i++) {
    const char *value = job->cells[i];
    if (value && !cag_tool_try(scratch, cag_job_column_names[i], value, &why))
      ok = cag_jobs_problem(&b->jobs, job, CODE_VALUE, why.help, "%s %s", cag_job_column_names[i],
                            why.message);
  }
  if (row->renders || !job->cells[CAG_JOB_output]) return ok;
  for (size_t i = 0; ok && i < sizeof PICTURES / sizeof *PICTURES; i++)
    if (job->cells[PICTURES[i]])
      ok = cag_jobs_problem(&b->jobs, job, CODE_VALUE, "leave the field empty",
                            "an export has no %s", cag_job_column_names[PICTURES[i]]);
  return ok;
}

// The output of a film must contain a placeholder for the frame number; other outputs must not.
static bool check_pattern(CagBatch *b, const CagJob *job, const CagBatchRow *row) {
  static const char HELP[] = "write the number as %04d, such as film.%04d.png, and a % as %%";
  const char *output = job->cells[CAG_JOB_output];
  const int places = row->renders ? cag_frames_places(output) : 0;
  if (!row->film && places > 0)
    return cag_jobs_problem(
        &b->jobs, job, CODE_VALUE, "fill in frames, such as 0..47",
        "the output '%s' has a placeholder for a frame number, but the row has no "
        "frames",
        output);
  if (row->film && (places < 0 || places > 1))
    return cag_jobs_problem(&b->jobs, job, CODE_VALUE, HELP,
                            places < 0
                                ? "a %% in the output '%s' is not a placeholder for a frame number"
                                : "the output '%s' has several placeholders for a frame number",
                            output);
  if (row->film && places == 0 && row->last > row->first)
    return cag_jobs_problem(&b->jobs, job, CODE_TWICE, HELP,
                            "all frames would be written to the same output '%s'", output);
  return true;
}

static bool check_tiles(CagBatch *b, const CagJob *job, CagBatchRow *row, const CagTool *scratch) {
  const char *tiles = scratch->tiles ? scratch->tiles : b->tool->tiles;
  if (!tiles || !row->renders || !cag_tiles_read(tiles, &row->tile_columns, &row->lines))
    return true;
  if (row->tile_columns * row->lines == 1) {
    row->tile_columns = 0;
    return true;
  }
  row->width = scratch->width;
  row->height = scratch->height;
  if (!row->width)
    return cag_jobs_problem(&b->jobs, job, CODE_VALUE, "fill in size, such as 7680x4320",
                            "a picture in tiles needs its size");
  if (cag_tiles_fit(row->width, row->tile_columns) && cag_tiles_fit(row->height, row->lines))
    return true;
  return cag_jobs_problem(&b->jobs, job, CODE_VALUE, "use fewer tiles",
                          "tiles %s of a picture of %d by %d pixels are smaller than %d pixels",
                          tiles, row->width, row->height, CAG_TILE_STEP);
}

// Checks the length of films given by -D frames=N for all rows.
static bool check_length(CagBatch *b, const CagJob *job, const CagBatchRow *row) {
  for (size_t i = 0; row->film && i < b->tool->define_count; i++) {
    const CagToolDefine *d = &b->tool->defines[i];
    char *end;
    if (strcmp(d->name, "frames") != 0) continue;
    const double frames = strtod(d->value, &end);
    if (*end || !(frames > (double)row->last))
      return cag_jobs_problem(&b->jobs, job, CODE_VALUE, "the frames of a film of N are 0..N-1",
                              "frames %ld..%ld exceed -D frames=%s", row->first, row->last,
                              d->value);
  }
  return true;
}

static bool check_row(CagBatch *b, size_t i) {
  const CagJob *job = &b->jobs.rows[i];
  CagBatchRow *row = &b->rows[i];
  CagTool scratch = {0};
  bool ok = check_script(b, job) && check_format(b, job, row);
  ok = ok && check_values(b, job, row, &scratch);
  row->film = row->renders && scratch.has_frames;
  row->first = scratch.first_frame;
  row->last = scratch.last_frame;
  return ok && check_pattern(b, job, row) && check_tiles(b, job, row, &scratch) &&
         check_length(b, job, row);
}

// --- Tasks ---

static CagTask *add_task(CagBatch *b, size_t row, long frame) {
  if (!CAG_RESERVE(b->tasks, b->task_capacity, b->task_count + 1)) return NULL;
  CagTask *task = &b->tasks[b->task_count++];
  *task = (CagTask){.row = row, .frame = frame, .tile = -1};
  b->rows[row].task_count++;
  return task;
}

static char *output_name(const CagJob *job, const CagBatchRow *row, long frame) {
  char name[4096];
  const char *pattern = job->cells[CAG_JOB_output];
  if (!row->film) return strdup(pattern);
  return cag_frames_name(pattern, frame, name, sizeof name) ? strdup(name) : NULL;
}

static bool make_tasks(CagBatch *b, size_t i) {
  const CagJob *job = &b->jobs.rows[i];
  CagBatchRow *row = &b->rows[i];
  const int tiles = row->tile_columns * row->lines;
  row->task = b->task_count;
  const double count = ((double)row->last - (double)row->first + 1) * (tiles + 1);
  if (count + (double)b->task_count > TASKS_MAX)
    return cag_jobs_problem(&b->jobs, job, CODE_VALUE, "split the table into several files",
                            "with this row, the batch has more than %d pictures", TASKS_MAX);
  for (long frame = row->first; frame <= row->last; frame++) {
    for (int tile = 0; tile < tiles; tile++) {
      CagTask *task = add_task(b, i, frame);
      if (!task) return false;
      task->tile = tile;
    }
    CagTask *task = add_task(b, i, frame);
    if (!task) return false;
    task->joins = tiles;
    task->output = output_name(job, row, frame);
    if (!task->output) return false;
  }
  return true;
}

// --- Outputs ---

typedef struct {
  char *path; // absolute, with links in its folder resolved
  size_t row, order;
} Output;

static int by_path(const void *a, const void *b) {
  const Output *p = a, *q = b;
  const int order = strcmp(p->path, q->path);
  return order ? order : (p->order > q->order) - (p->order < q->order);
}

// Returns the path with links resolved, at least those of its folder if the file does not exist, so
// that two paths of the same file are detected.
static char *real_output(const CagBatch *b, const char *name) {
  char *path = cag_batch_path(b, name);
  char *out = path ? realpath(path, NULL) : NULL, *slash = path ? strrchr(path, '/') : NULL;
  if (out) free(path);
  if (out || !slash) return out ? out : path;
  *slash = '\0';
  char *folder = realpath(*path ? path : "/", NULL);
  if (folder && asprintf(&out, "%s/%s", strcmp(folder, "/") ? folder : "", slash + 1) < 0)
    out = NULL;
  *slash = '/';
  free(folder);
  if (!out) return path;
  free(path);
  return out;
}

// Outputs must not be scripts or files that the batch itself reads and writes.
static bool add_reserved(CagBatch *b, Output *outputs, size_t *count) {
  const char *own[] = {b->journal_path, b->report_path};
  for (size_t i = 0; i < 2; i++)
    outputs[(*count)++] = (Output){real_output(b, own[i]), SIZE_MAX, 0};
  char *jobs = realpath(b->path, NULL);
  outputs[(*count)++] = (Output){jobs ? jobs : strdup(b->path), SIZE_MAX, 0};
  for (size_t i = 0; i < b->jobs.count; i++)
    if (b->jobs.rows[i].cells[CAG_JOB_script])
      outputs[(*count)++] =
          (Output){real_output(b, b->jobs.rows[i].cells[CAG_JOB_script]), SIZE_MAX, 0};
  for (size_t i = 0; i < *count; i++)
    if (!outputs[i].path) return false;
  return true;
}

static bool tell_twice(CagBatch *b, const Output *first, const Output *second) {
  const CagJob *job = &b->jobs.rows[second->row];
  if (first->row == SIZE_MAX)
    return cag_jobs_problem(&b->jobs, job, CODE_TWICE, "choose another name",
                            "the output '%s' is one of the batch's own files", second->path);
  return cag_jobs_problem(&b->jobs, job, CODE_TWICE, "give each row its own output",
                          "the output '%s' is also the output of row %zu", second->path,
                          b->jobs.rows[first->row].number);
}

static bool check_outputs(CagBatch *b) {
  Output *outputs = malloc((b->task_count + b->jobs.count + 3) * sizeof *outputs);
  size_t count = 0;
  bool ok = outputs && add_reserved(b, outputs, &count);
  for (size_t i = 0; ok && i < b->task_count; i++) {
    if (!b->tasks[i].output) continue;
    outputs[count] = (Output){real_output(b, b->tasks[i].output), b->tasks[i].row, i + 1};
    ok = outputs[count++].path != NULL;
  }
  if (ok) qsort(outputs, count, sizeof *outputs, by_path);
  size_t told = SIZE_MAX; // conflicts of a film are reported once
  for (size_t i = 1; ok && i < count; i++) {
    if (outputs[i].row == SIZE_MAX || outputs[i].row == told ||
        strcmp(outputs[i].path, outputs[i - 1].path) != 0)
      continue;
    told = outputs[i].row;
    ok = tell_twice(b, &outputs[i - 1], &outputs[i]);
  }
  while (count) free(outputs[--count].path);
  free(outputs);
  return ok;
}

// Tests whether a row's first output can be written.
static bool check_place(CagBatch *b, size_t i) {
  const CagBatchRow *row = &b->rows[i];
  const CagJob *job = &b->jobs.rows[i];
  const CagTask *task =
      row->task_count ? &b->tasks[row->task + (size_t)(row->tile_columns * row->lines)] : NULL;
  if (!task) return true;
  CagError err;
  char *path = cag_batch_path(b, task->output);
  if (!path) return false;
  const bool good = cag_tool_try_place(path, &err);
  free(path);
  return good || cag_jobs_problem(&b->jobs, job, CODE_PLACE, err.help, "%s", err.message);
}

bool cag_batch_check(CagBatch *b) {
  b->rows = calloc(b->jobs.count + 1, sizeof *b->rows);
  bool ok = b->rows != NULL;
  for (size_t i = 0; ok && i < b->jobs.count; i++) {
    const size_t problems = b->jobs.problem_count;
    ok = check_row(b, i);
    if (ok && b->jobs.problem_count == problems) ok = make_tasks(b, i);
  }
  ok = ok && check_outputs(b);
  for (size_t i = 0; ok && i < b->jobs.count; i++) ok = check_place(b, i);
  return ok;
}
