// cag run FILE: runs a script and lists what it shows.

#include "cli/tool.h"

int cag_tool_run(CagTool *t, int argc, char **argv) {
  (void)argc;
  CagSession *s = cag_tool_session(t);
  if (!s) return CAG_STATUS_LIMIT;
  const int status = cag_tool_finish(t, s, cag_session_run_file(s, argv[0]));
  if (status == CAG_STATUS_OK && !t->quiet && t->style != CAG_STYLE_JSON)
    cag_session_describe_scene(s, stderr);
  cag_session_free(s);
  return status;
}
