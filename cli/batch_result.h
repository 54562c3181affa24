// What the end of a task's process means.

#ifndef CAG_CLI_BATCH_RESULT_H
#define CAG_CLI_BATCH_RESULT_H

#include "cli/batch_child.h"

// The exit status of a process of this program that has ended, and, where it failed, the reason as
// a line (malloc'd; NULL when it went well). `limit_memory` is what it was stopped for, in bytes.
int cag_child_result(const CagChild *c, double max_time, size_t limit_memory, char **message);

#endif
