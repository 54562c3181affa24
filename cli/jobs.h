// The job file of a batch, as rows of texts: CSV with a header line, or JSON, a list of records.
//
// Only the names of columns are interpreted here; batch_check.c checks the values. Errors are kept
// as a list of problems with row numbers, so that all of them can be reported at once.

#ifndef CAG_CLI_JOBS_H
#define CAG_CLI_JOBS_H

#include <stdbool.h>
#include <stddef.h>

// CAG_JOB_COLUMN(name): the columns with a fixed meaning. All others are params of the script.
#define CAG_JOB_COLUMNS(CAG_JOB_COLUMN)                                                            \
  CAG_JOB_COLUMN(script)                                                                           \
  CAG_JOB_COLUMN(output)                                                                           \
  CAG_JOB_COLUMN(frames)                                                                           \
  CAG_JOB_COLUMN(size)                                                                             \
  CAG_JOB_COLUMN(quality)                                                                          \
  CAG_JOB_COLUMN(engine)                                                                           \
  CAG_JOB_COLUMN(camera)                                                                           \
  CAG_JOB_COLUMN(tolerance)                                                                        \
  CAG_JOB_COLUMN(tiles)

typedef enum CagJobColumn {
#define CAG_JOB_COLUMN(name) CAG_JOB_##name,
  CAG_JOB_COLUMNS(CAG_JOB_COLUMN)
#undef CAG_JOB_COLUMN
      CAG_JOB_COLUMN_COUNT
} CagJobColumn;

extern const char *const cag_job_column_names[CAG_JOB_COLUMN_COUNT];

typedef struct CagJobParam {
  char *name, *value;
} CagJobParam;

// A row. Texts are NULL if they are not given, which includes empty fields.
typedef struct CagJob {
  size_t number; // from 1, without the header line
  size_t line;   // line of the file where it starts; 0: unknown (JSON)
  char *cells[CAG_JOB_COLUMN_COUNT];
  CagJobParam *params; // sorted by name
  size_t param_count;
} CagJob;

typedef struct CagJobProblem {
  size_t row, line; // 0: applies to the file
  const char *code;
  char *message, *help; // help may be NULL
} CagJobProblem;

typedef struct CagJobs {
  CagJob *rows;
  size_t count, capacity;
  CagJobProblem *problems;
  size_t problem_count, problem_capacity;
} CagJobs;

// Parses the text of a job file as CSV or, with `is_json`, as JSON. Initialize with {0}. Release
// with cag_jobs_free, even after problems. Returns false only if memory ran out.
bool cag_jobs_read(CagJobs *jobs, const char *text, size_t length, bool is_json);
void cag_jobs_free(CagJobs *jobs);

// Adds a problem of a row (NULL: of the whole file). Returns false if memory ran out.
bool cag_jobs_problem(CagJobs *jobs, const CagJob *row, const char *code, const char *help,
                      const char *format, ...) __attribute__((format(printf, 5, 6)));

#endif
