// Interpretation of the exit of a task's process.

#ifndef CAG_CLI_BATCH_RESULT_H
#define CAG_CLI_BATCH_RESULT_H

#include "cli/batch_child.h"

// Returns the exit status of a child process of this program. If it failed, *message is the reason
// as one line (malloc'd), or else NULL. `limit_memory` is the exceeded memory limit in bytes.
int cag_child_result(const CagChild *c, double max_time, size_t limit_memory, char **message);

#endif
