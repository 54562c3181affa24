// What the commands that run scripts share: the session, and the check of an output's place.

#include <string.h>
#include <sys/stat.h>

#include "interp/render/atomic_file.h"
#include "interp/tool/tool.h"

CagSession *cag_tool_session(CagTool *t) {
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
  struct stat st;
  // A pipe or a device is not opened on trial: its other end would notice.
  if (!strcmp(path, "-")) return CAG_STATUS_OK;
  if (stat(path, &st) == 0 && (S_ISFIFO(st.st_mode) || S_ISCHR(st.st_mode))) return CAG_STATUS_OK;
  CagIoError err;
  CagAtomicFile *trial = cag_atomic_file_open(path, &err);
  if (!trial) return cag_tool_fail(t, err.exit_status, err.help, "%s", err.message);
  cag_atomic_file_abort(trial);
  return CAG_STATUS_OK;
}
