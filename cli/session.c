// Shared by commands that run scripts: the session, and checking an output's path.

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "cli/tool.h"

// Called if the run is in a step that cannot be stopped (such as the decomposition of a huge
// matrix). Ends the program immediately, as a second Ctrl-C does.
static void end_overdue(CagSession *s, void *context) {
  const CagTool *t = context;
  // Earlier output comes first, unless writing it is what takes so long.
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
  t->session.verbose = t->verbose;
  CagSession *s = cag_session_new(&t->session);
  if (!s) {
    cag_tool_fail(t, CAG_STATUS_LIMIT, NULL, "out of memory");
    return NULL;
  }
  for (size_t i = 0; i < t->define_count; i++)
    cag_session_define(s, t->defines[i].name, t->defines[i].value);
  if (t->has_section) cag_session_set_section(s, t->section);
  return s;
}

int cag_tool_check_output(const CagTool *t, const char *path) {
  CagError err;
  if (cag_atomic_file_try(path, &err)) return CAG_STATUS_OK;
  return cag_tool_fail(t, cag_exit_status(&err), err.help, "%s", err.message);
}

bool cag_tool_try_place(const char *path, CagError *err) {
  char above[PATH_MAX], place[PATH_MAX];
  struct stat st;
  snprintf(above, sizeof above, "%s", path);
  snprintf(place, sizeof place, "%s", path);
  // A file in the nearest existing folder shows whether folders can be created there.
  for (char *slash = strrchr(above, '/'); slash && slash > above; slash = strrchr(above, '/')) {
    *slash = '\0';
    if (stat(above, &st) == 0 || errno != ENOENT) break;
    memcpy(place, above, sizeof place);
  }
  return cag_atomic_file_try(place, err);
}

int cag_tool_check_place(const CagTool *t, const char *path) {
  CagError err;
  if (cag_tool_try_place(path, &err)) return CAG_STATUS_OK;
  return cag_tool_fail(t, cag_exit_status(&err), err.help, "%s", err.message);
}

void cag_tool_make_folder(const char *path) {
  char folder[PATH_MAX];
  snprintf(folder, sizeof folder, "%s", path);
  char *last = strrchr(folder, '/');
  if (!last) return;
  *last = '\0';
  for (char *slash = folder; slash; slash = strchr(slash + 1, '/')) {
    if (slash == folder) continue;
    *slash = '\0';
    const bool made = mkdir(folder, 0777) == 0 || errno == EEXIST || errno == EISDIR;
    *slash = '/';
    if (!made) return; // writing the file reports the reason
  }
  (void)!mkdir(folder, 0777);
}
