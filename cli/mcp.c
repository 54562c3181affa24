// cag mcp [FOLDER]: serves the Model Context Protocol on standard input and output.

#include "live/mcp.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/tool.h"

static int serve(CagTool *t, const char *folder) {
  const char **names = calloc(t->define_count + 1, sizeof *names),
             **values = calloc(t->define_count + 1, sizeof *values);
  int status = CAG_STATUS_LIMIT;
  for (size_t i = 0; names && values && i < t->define_count; i++) {
    names[i] = t->defines[i].name;
    values[i] = t->defines[i].value;
  }
  const CagMcpOptions options = {.session = t->session,
                                 .folder = folder,
                                 .names = names,
                                 .values = values,
                                 .define_count = t->define_count,
                                 .interrupt = &cag_tool_interrupt};
  if (names && values) status = cag_mcp_serve(&options, STDIN_FILENO, STDOUT_FILENO);
  free((void *)(size_t)names);
  free((void *)(size_t)values);
  return status;
}

int cag_tool_mcp(CagTool *t, int argc, char **argv) {
  const char *folder = argc > 0 ? argv[0] : ".";
  struct stat st;
  if (stat(folder, &st) != 0 || !S_ISDIR(st.st_mode))
    return cag_tool_fail(t, CAG_STATUS_FILE, "name a folder that contains scripts",
                         "cannot read the folder '%s'", folder);
  if (isatty(STDIN_FILENO))
    cag_tool_say(t, "waiting for requests of the Model Context Protocol; a client starts this "
                    "command");
  return serve(t, folder);
}
