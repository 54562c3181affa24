// The scripts that operands of a command stand for.

#ifndef CAG_CLI_SCRIPTS_H
#define CAG_CLI_SCRIPTS_H

#include "cli/tool.h"

typedef struct CagToolScripts {
  CagTool *tool;
  // Called for each script, "-" for standard input. What it gives back other than CAG_STATUS_OK
  // ends the walk.
  int (*each)(void *context, const char *path);
  void *context;
  size_t count; // of scripts so far
  int status;   // CAG_STATUS_FILE after a path that could not be read, which was told
} CagToolScripts;

// Walks through paths: a folder stands for the scripts below it in the order of their names (what
// begins with a dot is passed over), no path for the folder one is in.
int cag_tool_each_script(CagToolScripts *s, int count, char **paths);

// The bytes of a file ("-": of standard input), malloc'd; NULL after a message.
char *cag_tool_read_file(const CagTool *t, const char *path, size_t *length);

#endif
