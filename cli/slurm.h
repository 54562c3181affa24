// Runs the tasks of a batch as an array job of Slurm.
//
// The folder JOBS.slurm/NAME beside the job file contains the plan (the commands of all tasks), the
// script that Slurm runs for each element of the array, and a result file for each task, which the
// elements write atomically. So the results do not depend on Slurm's records; Slurm is queried only
// about elements that ended without a result. NAME is the job's name. It is written to the journal
// before the job is submitted, so that a later call can find the job by it.

#ifndef CAG_CLI_SLURM_H
#define CAG_CLI_SLURM_H

#include "cli/batch.h"

// Resumes the job of an earlier call, submits the missing tasks, and waits for the job to end.
// Tasks that Slurm refuses or loses fail. Tasks whose state is unknown wait for the next call.
// Returns CAG_STATUS_INTERRUPTED after Ctrl-C; the job then continues.
int cag_slurm_run(CagBatch *b);

// Runs element --element of the plan. Called by the script of the array.
int cag_slurm_element(CagTool *t, const char *plan);

#endif
