// The tools of the server: their table, and what their functions share.

#ifndef CAG_LIVE_MCP_TOOLS_H
#define CAG_LIVE_MCP_TOOLS_H

#include "live/json.h"
#include "live/mcp.h"

// A call of a tool, and its result.
typedef struct CagMcpCall {
  const CagMcpOptions *options;
  const cJSON *arguments; // checked by the table; never NULL
  volatile int stop;      // nonzero if the call is cancelled
  // Reports progress to the client; NULL: it did not ask for that.
  void (*progress)(void *context, double percent, const char *message);
  void *progress_context;

  cJSON *content;    // list of content blocks
  cJSON *structured; // record; NULL: none
  bool is_error;     // of the script, not of the protocol
  char refusal[512]; // why the arguments are invalid; empty: they are valid
} CagMcpCall;

typedef void CagMcpFunction(CagMcpCall *call);
CagMcpFunction cag_mcp_check, cag_mcp_run, cag_mcp_views, cag_mcp_section, cag_mcp_measure,
    cag_mcp_documentation, cag_mcp_examples;

// The answer to tools/list.
cJSON *cag_mcp_tool_list(void);
// Checks the arguments and calls the tool. Returns false, with the reason in call->refusal, if there
// is no such tool or an argument is invalid. Otherwise fills `content`, `structured`, and
// `is_error`.
bool cag_mcp_call_tool(const char *name, CagMcpCall *call);

// Arguments of a call; NULL, or the fallback, if they are not given.
const char *cag_mcp_text(const CagMcpCall *call, const char *name);
double cag_mcp_number(const CagMcpCall *call, const char *name, double fallback);
bool cag_mcp_flag(const CagMcpCall *call, const char *name);

// Sets the reason why the arguments are invalid, and returns false.
bool cag_mcp_refuse(CagMcpCall *call, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
// Adds a block of text to the content.
void cag_mcp_add_text(CagMcpCall *call, const char *text);

#endif
