// A server of the Model Context Protocol (revision 2025-06-18), over which language models and other
// programs check, run, render, and measure scripts.
//
// Messages are JSON-RPC 2.0, one per line. This thread reads them and answers at once what needs no
// script. Calls of tools wait in a queue for one other thread, each in a session of its own, so that
// calls can be cancelled while one runs. Answers are in the order of the calls.

#ifndef CAG_LIVE_MCP_H
#define CAG_LIVE_MCP_H

#include "cag.h"

typedef struct CagMcpOptions {
  CagSessionOptions session;     // limits, tolerance, and module path; the rest is ignored
  const char *folder;            // scripts are read below it, and below the module path
  const volatile int *interrupt; // nonzero ends the server; may be NULL
} CagMcpOptions;

// Reads requests from the file descriptor `in` until its end, and writes answers to `out`. Returns
// CAG_STATUS_OK, CAG_STATUS_INTERRUPTED, CAG_STATUS_FILE if `in` cannot be read or the reader of
// `out` is gone, or CAG_STATUS_LIMIT if memory ran out.
int cag_mcp_serve(const CagMcpOptions *options, int in, int out);

#endif
