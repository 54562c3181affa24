// The plan of an array job: what its elements run, and where they leave the results.

#ifndef CAG_CLI_SLURM_PLAN_H
#define CAG_CLI_SLURM_PLAN_H

#include "cli/batch.h"

typedef struct CagPlanTask {
  char key[CAG_JOURNAL_KEY_SIZE];
  char **words; // NULL at the end; NULL in a plan of one's own
} CagPlanTask;

// Element e of `elements` runs the tasks e, e + elements, e + 2 elements, ...
typedef struct CagPlan {
  size_t elements, count, retries;
  double max_time, limit; // seconds: of the message, and when a process is stopped
  char *folder;           // where the processes start
  CagPlanTask *tasks;
} CagPlan;

// Writes and reads a plan. Reading gives NULL or false, after a message, for a file that is none.
bool cag_plan_write(const CagPlan *plan, const char *path, CagError *err);
bool cag_plan_read(const CagTool *t, CagPlan *plan, const char *path);
void cag_plan_free(CagPlan *plan);

// A task's result. The path is malloc'd.
char *cag_plan_result_path(const char *folder, const char *key);
bool cag_plan_write_result(const char *path, const CagTask *task, CagError *err);
// False where there is none yet.
bool cag_plan_read_result(const char *path, CagTask *task);

#endif
