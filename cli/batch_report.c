// The messages of a batch: its problems, its failed rows, the report, and the summary line.

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "cli/batch.h"

// The maximum number of problems that are reported; a table with the wrong separator has one in
// each row.
#define PROBLEMS_TOLD 50

// --- Problems ---

static void tell_json(const CagBatch *b, size_t row, size_t line, const char *code,
                      const char *message, const char *help) {
  cJSON *object = cJSON_CreateObject();
  cJSON_AddStringToObject(object, "severity", "error");
  cJSON_AddStringToObject(object, "code", code);
  cJSON_AddStringToObject(object, "message", message);
  cJSON_AddStringToObject(object, "file", b->path);
  if (line) cJSON_AddNumberToObject(object, "line", (double)line);
  if (row) cJSON_AddNumberToObject(object, "row", (double)row);
  if (help) cJSON_AddStringToObject(object, "help", help);
  char *text = cJSON_PrintUnformatted(object);
  fprintf(stderr, "%s\n", text ? text : "{\"severity\":\"error\"}");
  cJSON_free(text);
  cJSON_Delete(object);
}

// Writes "jobs.csv:5: E0913: row 4: the script ...".
static void report_problem(const CagBatch *b, size_t row, size_t line, const char *code,
                           const char *message, const char *help) {
  if (b->tool->style == CAG_STYLE_JSON) {
    tell_json(b, row, line, code, message, help);
    return;
  }
  fprintf(stderr, "%s:", b->path);
  if (line) fprintf(stderr, "%zu:", line);
  fprintf(stderr, " %s: ", code);
  if (row) fprintf(stderr, "row %zu: ", row);
  fprintf(stderr, "%s\n", message);
  if (help) fprintf(stderr, "  %s\n", help);
}

// Compares by row. The order of problems of one row is unspecified.
static int by_row(const void *a, const void *b) {
  const CagJobProblem *p = a, *q = b;
  return (p->row > q->row) - (p->row < q->row);
}

void cag_batch_tell_problems(CagBatch *b) {
  CagJobs *jobs = &b->jobs;
  qsort(jobs->problems, jobs->problem_count, sizeof *jobs->problems, by_row);
  for (size_t i = 0; i < jobs->problem_count && i < PROBLEMS_TOLD; i++) {
    const CagJobProblem *p = &jobs->problems[i];
    report_problem(b, p->row, p->line, p->code, p->message, p->help);
  }
  cag_tool_fail(b->tool, CAG_STATUS_USAGE,
                jobs->problem_count > PROBLEMS_TOLD ? "only the first ones are listed" : NULL,
                "%s has %zu problem%s; nothing was run", b->path, jobs->problem_count,
                jobs->problem_count == 1 ? "" : "s");
}

void cag_batch_tell_row(const CagBatch *b, size_t row, const char *code, const char *message) {
  report_problem(b, b->jobs.rows[row].number, b->jobs.rows[row].line, code, message, NULL);
}

// --- The report ---

// Writes a field of CSV, quoted if necessary.
static void write_field(CagAtomicFile *f, const char *text) {
  if (!text) return;
  if (!strpbrk(text, ",\"\n\r;\t")) {
    cag_atomic_file_text(f, text);
    return;
  }
  cag_atomic_file_text(f, "\"");
  for (; *text; text++)
    cag_atomic_file_write(f, *text == '"' ? "\"\"" : text, *text == '"' ? 2 : 1);
  cag_atomic_file_text(f, "\"");
}

static void write_row(CagAtomicFile *f, const CagBatch *b, size_t i) {
  static const char *const STATES[] = {[CAG_ROW_DONE] = "done",
                                       [CAG_ROW_KEPT] = "already done",
                                       [CAG_ROW_FAILED] = "failed",
                                       [CAG_ROW_WAITING] = "not done"};
  const CagJob *job = &b->jobs.rows[i];
  const CagRowSum sum = cag_batch_sum(b, i);
  cag_atomic_file_printf(f, "%zu,", job->number);
  write_field(f, job->cells[CAG_JOB_script]);
  cag_atomic_file_text(f, ",");
  write_field(f, job->cells[CAG_JOB_output]);
  cag_atomic_file_printf(f, ",%s,%.3f,%.1f,%d,%d,", STATES[sum.state], sum.seconds,
                         (double)sum.memory / 1e6, sum.attempts, sum.status);
  write_field(f, sum.failed ? sum.failed->message : NULL);
  cag_atomic_file_text(f, "\n");
}

bool cag_batch_write_report(const CagBatch *b, CagError *err) {
  CagAtomicFile *f = cag_atomic_file_open(b->report_path, err);
  if (!f) return false;
  cag_atomic_file_text(f, "row,script,output,status,seconds,memory_mb,attempts,exit,message\n");
  for (size_t i = 0; i < b->jobs.count; i++) write_row(f, b, i);
  return cag_atomic_file_commit(f, err);
}

// --- The end ---

int cag_batch_close(const CagBatch *b, bool interrupted) {
  size_t counts[4] = {0};
  for (size_t i = 0; i < b->jobs.count; i++) counts[cag_batch_sum(b, i).state]++;
  rmdir(b->tiles_folder); // if it is empty
  if (!b->tool->quiet) {
    printf("%zu done, %zu failed, %zu skipped (already done)", counts[CAG_ROW_DONE],
           counts[CAG_ROW_FAILED], counts[CAG_ROW_KEPT]);
    if (counts[CAG_ROW_WAITING]) printf(", %zu not done", counts[CAG_ROW_WAITING]);
    putchar('\n');
  }
  if (interrupted) return CAG_STATUS_INTERRUPTED;
  return counts[CAG_ROW_FAILED] || counts[CAG_ROW_WAITING] ? CAG_STATUS_SCRIPT : CAG_STATUS_OK;
}
