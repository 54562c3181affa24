// The scripts that the operands of a command select.

#ifndef CAG_CLI_SCRIPTS_H
#define CAG_CLI_SCRIPTS_H

#include "cli/tool.h"

typedef struct CagToolScripts {
  CagTool *tool;
  // Called for each script; "-" is standard input. A result other than CAG_STATUS_OK ends the
  // iteration.
  int (*each)(void *context, const char *path);
  void *context;
  size_t count; // number of scripts so far
  int status;   // CAG_STATUS_FILE after a path that could not be read, which was reported
} CagToolScripts;

// Iterates over paths. A folder stands for the scripts below it in the order of their names, except
// for names that start with a dot. Without paths, the current folder is used.
int cag_tool_each_script(CagToolScripts *s, int count, char **paths);

// Reads a file ("-": standard input). Returns its bytes, allocated with malloc, or NULL, after a
// message.
char *cag_tool_read_file(const CagTool *t, const char *path, size_t *length);
// The same without a message: errno tells why it failed.
char *cag_tool_try_file(const char *path, size_t *length);

#endif
