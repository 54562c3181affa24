// A batch's tasks as one array job of Slurm.
//
// Beside the file of jobs, in the folder JOBS.slurm/NAME, stand the plan (the commands of all
// tasks), the script that Slurm runs for each element of the array, and a result file for each
// task, which the elements write whole or not at all. So what became of the tasks does not depend
// on what Slurm remembers; it is asked only for elements that ended without a result. NAME is the
// job's name; it is in the journal before the job is handed in, and a later call finds the job by
// it.

#ifndef CAG_CLI_SLURM_H
#define CAG_CLI_SLURM_H

#include "cli/batch.h"

// Takes up the job of an earlier call, hands in what is missing, and follows it to its end. Tasks
// that Slurm does not take or loses are failed; those of which nothing is known wait for the next
// call. CAG_STATUS_INTERRUPTED after Ctrl-C: the job goes on.
int cag_slurm_run(CagBatch *b);

// Runs element --element of the plan; what the script of the array calls.
int cag_slurm_element(CagTool *t, const char *plan);

#endif
