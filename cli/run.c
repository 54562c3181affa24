// cag run FILE: runs a script and lists what it shows.

#include "cli/tool.h"
#include "cli/watch.h"

static int run_script(CagTool *t, CagSession *s, void *path) {
  const int status = cag_tool_finish(t, s, cag_session_run_file(s, path));
  if (status == CAG_STATUS_OK && !t->quiet && t->style != CAG_STYLE_JSON)
    cag_session_describe_scene(s, stderr);
  return status;
}

int cag_tool_run(CagTool *t, int argc, char **argv) {
  (void)argc;
  return cag_tool_rounds(t, argv[0], run_script, argv[0]);
}
