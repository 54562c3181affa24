// A script that a tool runs, with its session and what it prints.

#ifndef CAG_LIVE_MCP_SCRIPT_H
#define CAG_LIVE_MCP_SCRIPT_H

#include "live/mcp_tools.h"

// A text of limited length that can be written like a file. What exceeds the limit is dropped.
typedef struct CagMcpText {
  char *bytes; // zero-terminated, once there is a byte
  size_t length, capacity;
  bool cut;
} CagMcpText;

typedef struct CagMcpScript {
  CagMcpCall *call;
  CagSession *session;
  char *path; // NULL: the text of the arguments
  const char *text;
  FILE *out, *trace; // what the script prints and traces
  CagMcpText printed, traced;
  double begun;
} CagMcpScript;

// Makes the session for the arguments file or text, params, name, and section. Returns false if they
// are invalid, or if memory ran out, with the reason in the call.
bool cag_mcp_open(CagMcpCall *call, CagMcpScript *s);
// Runs the script, or checks it without running.
int cag_mcp_run_script(CagMcpScript *s);
int cag_mcp_check_script(CagMcpScript *s);
// The name of the script for messages.
const char *cag_mcp_script_name(const CagMcpScript *s);
// Adds the diagnostics to the result, as text and as `diagnostics` of the structured content, whose
// `status` becomes the word for the status. Any status but CAG_STATUS_OK is an error.
void cag_mcp_conclude(CagMcpScript *s, int status);
void cag_mcp_close(CagMcpScript *s);

// The structured content, which is made if there is none.
cJSON *cag_mcp_structured(CagMcpCall *call);

// Reads the argument section, such as "z=10", as a plane for cag_session_set_section. Returns false
// if it is invalid. *given: whether there is one.
bool cag_mcp_read_section(CagMcpCall *call, double plane[4], bool *given);

#endif
