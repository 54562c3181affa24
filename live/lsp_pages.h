// The language server for pages. Each page has a server of its own, because its texts are its own.
//
// A page sends messages of the protocol in requests, and gets those of the server in the answers.

#ifndef CAG_LIVE_LSP_PAGES_H
#define CAG_LIVE_LSP_PAGES_H

#include "cag.h"
#include "live/server.h"

// If more pages ask, the server of the one that has been silent longest is given up. Its page gets
// "the server is not initialized" for the next request, and begins again.
enum { CAG_LSP_PAGES = 8 };

typedef struct CagLspPages CagLspPages;

// Documents must be below `folder`, an absolute path. Returns NULL if memory ran out.
CagLspPages *cag_lsp_pages_new(const CagSessionOptions *session, const char *folder);
// Answers what waits, and frees everything. NULL is allowed.
void cag_lsp_pages_free(CagLspPages *p);
// Answers x, later and on another thread. The body is {"page": "a name that the page has chosen",
// "messages": [...], "check": true}. The answer is a list of messages: the answers to these, and
// what the server had to say since the last request. With "check", changed documents are checked
// first; if the page asks again meanwhile, the check ends and its problems are missing.
void cag_lsp_pages_ask(CagLspPages *p, CagExchange *x);

#endif
