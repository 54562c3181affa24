// What the commands that run scripts share: the session, and the check of an output's place.

#include <string.h>
#include <unistd.h>

#include "interp/render/atomic_file.h"
#include "interp/tool/tool.h"

// The run is in a step that does not look up (a decomposition of a huge matrix): the program ends,
// on the spot, as it does after a second Ctrl-C.
static void end_overdue(CagSession *s, void *context) {
  const CagTool *t = context;
  // What was printed stands before, unless it is just that which takes so long.
  if (ftrylockfile(stdout) == 0) {
    fflush_unlocked(stdout);
    funlockfile(stdout);
  }
  cag_session_write_overdue(s, t->style, stderr);
  cag_atomic_files_cleanup();
  _exit(CAG_STATUS_LIMIT);
}

CagSession *cag_tool_session(CagTool *t) {
  t->session.overdue = end_overdue;
  t->session.overdue_context = t;
  CagSession *s = cag_session_new(&t->session);
  if (!s) {
    cag_tool_fail(t, CAG_STATUS_LIMIT, NULL, "out of memory");
    return NULL;
  }
  for (size_t i = 0; i < t->define_count; i++)
    cag_session_define(s, t->defines[i].name, t->defines[i].value);
  return s;
}

int cag_tool_check_output(const CagTool *t, const char *path) {
  CagIoError err;
  if (cag_atomic_file_try(path, &err)) return CAG_STATUS_OK;
  return cag_tool_fail(t, err.exit_status, err.help, "%s", err.message);
}
