// cag check PATH ...: reports errors of scripts without running them, and with --interference,
// parts that share volume.

#include <string.h>

#include "cli/scripts.h"

typedef struct Checking {
  CagTool *tool;
  int status; // the worst so far
} Checking;

static int check_interference(CagTool *t, CagSession *s, const char *path) {
  int status = cag_session_run_file(s, path);
  if (status == CAG_STATUS_OK) status = cag_session_interference(s);
  return cag_tool_finish(t, s, status);
}

static int check_script(void *context, const char *path) {
  Checking *c = context;
  CagSession *s = cag_tool_session(c->tool);
  if (!s) return CAG_STATUS_LIMIT;
  // Standard input can be read only once; a run finds the errors as well.
  const bool run_only = c->tool->interference && !strcmp(path, "-");
  int status = CAG_STATUS_OK;
  if (!run_only) status = cag_tool_finish(c->tool, s, cag_session_check_file(s, path));
  if (c->tool->interference && status == CAG_STATUS_OK)
    status = check_interference(c->tool, s, path);
  if (status > c->status) c->status = status;
  if (c->tool->verbose && status == CAG_STATUS_OK && cag_session_error_count(s) == 0)
    cag_tool_say(c->tool, "%s is well", path);
  cag_session_free(s);
  return cag_tool_interrupt ? CAG_STATUS_INTERRUPTED : CAG_STATUS_OK;
}

int cag_tool_check(CagTool *t, int argc, char **argv) {
  Checking c = {.tool = t};
  CagToolScripts scripts = {.tool = t, .each = check_script, .context = &c};
  const int status = cag_tool_each_script(&scripts, argc, argv);
  if (status != CAG_STATUS_OK) return status;
  if (scripts.count == 0 && scripts.status == CAG_STATUS_OK) cag_tool_say(t, "no scripts found");
  return scripts.status > c.status ? scripts.status : c.status;
}
