// The file of jobs of a batch, as rows of texts: CSV with a line of names above, or JSON, a list of
// records.
//
// Nothing is understood here but the columns' names; whether a size is a size is looked at by
// batch_check.c. What is wrong with the file is kept as a list of problems with the rows' numbers,
// so that all of them can be told at once.

#ifndef CAG_CLI_JOBS_H
#define CAG_CLI_JOBS_H

#include <stdbool.h>
#include <stddef.h>

// CAG_JOB_COLUMN(name): the columns that have a meaning. All others are params of the script.
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

// A row. Texts are NULL where nothing was given: an empty field is nothing given.
typedef struct CagJob {
  size_t number; // from 1, the line of names not counted
  size_t line;   // where it begins in the file; 0: not known (JSON)
  char *cells[CAG_JOB_COLUMN_COUNT];
  CagJobParam *params; // by name
  size_t param_count;
} CagJob;

typedef struct CagJobProblem {
  size_t row, line; // 0: of the file
  const char *code;
  char *message, *help; // help may be NULL
} CagJobProblem;

typedef struct CagJobs {
  CagJob *rows;
  size_t count, capacity;
  CagJobProblem *problems;
  size_t problem_count, problem_capacity;
} CagJobs;

// Reads the text of a file of jobs; `is_json` says as what. Begins with {0}; release with
// cag_jobs_free, also after problems. False only when memory is out.
bool cag_jobs_read(CagJobs *jobs, const char *text, size_t length, bool is_json);
void cag_jobs_free(CagJobs *jobs);

// Adds a problem of a row (NULL: of the whole file). False: memory is out.
bool cag_jobs_problem(CagJobs *jobs, const CagJob *row, const char *code, const char *help,
                      const char *format, ...) __attribute__((format(printf, 5, 6)));

#endif
