// cag mcp [FOLDER]: serves the Model Context Protocol on standard input and output.

#include "live/mcp.h"

#include <sys/stat.h>
#include <unistd.h>

#include "cli/tool.h"

int cag_tool_mcp(CagTool *t, int argc, char **argv) {
  const char *folder = argc > 0 ? argv[0] : ".";
  struct stat st;
  if (stat(folder, &st) != 0 || !S_ISDIR(st.st_mode))
    return cag_tool_fail(t, CAG_STATUS_FILE, "name a folder that contains scripts",
                         "cannot read the folder '%s'", folder);
  if (isatty(STDIN_FILENO))
    cag_tool_say(t, "waiting for requests of the Model Context Protocol; a client starts this "
                    "command");
  const CagMcpOptions options = {
      .session = t->session, .folder = folder, .interrupt = &cag_tool_interrupt};
  return cag_mcp_serve(&options, STDIN_FILENO, STDOUT_FILENO);
}
