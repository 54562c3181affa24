// The plan of an array job: the commands of its elements, and the location of their results.

#ifndef CAG_CLI_SLURM_PLAN_H
#define CAG_CLI_SLURM_PLAN_H

#include "cli/batch.h"

typedef struct CagPlanTask {
  char key[CAG_JOURNAL_KEY_SIZE];
  char **words; // ends with NULL; NULL while a plan is being made
} CagPlanTask;

// Element e of `elements` runs the tasks e, e + elements, e + 2 elements, ...
typedef struct CagPlan {
  size_t elements, count, retries;
  double max_time, limit; // seconds: the limit in messages, and the time after which a process is
                          // stopped
  char *folder;           // working folder of the processes
  CagPlanTask *tasks;
} CagPlan;

// Write and read a plan. Reading returns NULL or false, after a message, for an invalid file.
bool cag_plan_write(const CagPlan *plan, const char *path, CagError *err);
bool cag_plan_read(const CagTool *t, CagPlan *plan, const char *path);
void cag_plan_free(CagPlan *plan);

// Returns the path of a task's result, allocated with malloc.
char *cag_plan_result_path(const char *folder, const char *key);
bool cag_plan_write_result(const char *path, const CagTask *task, CagError *err);
// Returns false if there is no result yet.
bool cag_plan_read_result(const char *path, CagTask *task);

#endif
