// --watch: work that is done again when the script, or a file that it read, is saved.

#ifndef CAG_CLI_WATCH_H
#define CAG_CLI_WATCH_H

#include "cli/tool.h"

// The work of a command: runs its script in the session, writes the output, and returns the status
// of cag_tool_finish.
typedef int CagToolWork(CagTool *t, CagSession *s, void *context);

// Does the work once, in a session with the options of the command line. With --watch, does it
// again after each save, until Ctrl-C or until the reader of standard output closes it; a save
// during the work stops it first.
int cag_tool_rounds(CagTool *t, const char *script, CagToolWork *work, void *context);

#endif
