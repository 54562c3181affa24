// Runs one element of an array job, on the machine that Slurm chose: its tasks in sequence.

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "cli/batch_child.h"
#include "cli/batch_result.h"
#include "cli/slurm.h"
#include "cli/slurm_plan.h"

// Milliseconds between checks of the process.
#define LOOK_INTERVAL 20

static void run_once(const CagPlan *plan, char *const *words, CagTask *task) {
  CagChild c;
  task->attempts++;
  free(task->message);
  task->message = NULL;
  task->status = CAG_STATUS_LIMIT;
  if (!cag_child_start(&c, words, plan->folder, plan->limit, false)) {
    task->message = strdup(strerror(errno));
    return;
  }
  while (!cag_child_look(&c)) {
    poll(&(struct pollfd){.fd = c.said, .events = POLLIN}, 1, LOOK_INTERVAL);
    if (cag_tool_interrupt) cag_child_stop(&c, CAG_CHILD_STOP_ASKED);
  }
  task->seconds += c.seconds;
  if (c.memory > task->memory) task->memory = c.memory;
  task->status = cag_child_result(&c, plan->max_time, 0, &task->message);
  cag_child_free(&c);
}

// A task that Slurm starts again is not run twice. One that Slurm ends leaves no result, and the
// batch asks Slurm for the reason.
static int run_task(CagTool *t, const CagPlan *plan, const CagPlanTask *p, const char *folder) {
  char *path = cag_plan_result_path(folder, p->key);
  CagTask task = {0};
  CagError err;
  int status = CAG_STATUS_OK;
  if (!path) return CAG_STATUS_LIMIT;
  if (!cag_plan_read_result(path, &task) || task.status != CAG_STATUS_OK) {
    free(task.message);
    task = (CagTask){0};
    do run_once(plan, p->words, &task);
    while (task.status != CAG_STATUS_OK && (size_t)task.attempts <= plan->retries &&
           !cag_tool_interrupt);
    if (cag_tool_interrupt) status = CAG_STATUS_INTERRUPTED;
    else if (!cag_plan_write_result(path, &task, &err))
      status = cag_tool_fail(t, cag_exit_status(&err), err.help, "%s", err.message);
  }
  free(task.message);
  free(path);
  return status;
}

int cag_slurm_element(CagTool *t, const char *path) {
  CagPlan plan;
  if (!cag_plan_read(t, &plan, path)) return CAG_STATUS_FILE;
  const char *slash = strrchr(path, '/');
  char *folder = slash ? strndup(path, (size_t)(slash - path)) : strdup(".");
  int status = folder ? CAG_STATUS_OK : CAG_STATUS_LIMIT;
  for (size_t i = strtoul(t->element, NULL, 10); status == CAG_STATUS_OK && i < plan.count;
       i += plan.elements)
    status = run_task(t, &plan, &plan.tasks[i], folder);
  free(folder);
  cag_plan_free(&plan);
  return status;
}
