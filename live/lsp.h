// The language server: the Language Server Protocol 3.17 (JSON-RPC 2.0) for documents of cag.h.
//
// The server has two parts. CagLsp answers messages, wherever they come from: it is given one at a
// time, and passes its own to a callback. cag_lsp_serve connects it to two files, usually standard
// input and output.
//
// A server is used by one thread. Only cag_lsp_interrupt may be called by others.

#ifndef CAG_LIVE_LSP_H
#define CAG_LIVE_LSP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "cag.h"

typedef struct CagLsp CagLsp;

typedef struct CagLspOptions {
  CagSessionOptions session; // of checks, and of runs after a save: module path, memory, and time
  const char *program;       // path of the program for the commands; NULL: they are not offered
  // An absolute path: documents are below it, and modules of the library are "cag:std.robots"
  // instead of files in the cache folder of the user. NULL: documents are anywhere.
  const char *folder;
  // Receives each message of the server. It may be called on another thread, but not by two at
  // once.
  void (*send)(void *context, const char *json, size_t length);
  // Called on another thread when cag_lsp_work has something to do.
  void (*wake)(void *context);
  void *context;
} CagLspOptions;

// Returns NULL if memory ran out.
CagLsp *cag_lsp_new(const CagLspOptions *options);
// Frees a server, and ends the runs and programs that it has started.
void cag_lsp_free(CagLsp *l);
// Handles a message. A message that is not JSON, or not a request, is answered with an error.
void cag_lsp_receive(CagLsp *l, const char *json, size_t length);
// Does one piece of the work that was postponed until no message is waiting: checks a changed
// document, or reports a run. Returns whether there is more.
bool cag_lsp_work(CagLsp *l);
bool cag_lsp_has_work(CagLsp *l);
// Ends the work under way, which is then begun again or answered as canceled. A change of a
// document makes a running check useless; so does the cancellation of a request.
void cag_lsp_interrupt(CagLsp *l);
// Returns whether the client has asked for the end, and the exit status: 0 after a shutdown, else
// 1.
bool cag_lsp_is_done(const CagLsp *l, int *status);

// Serves the messages of `in`, each with its header, until the client asks for the end or closes
// it. Returns the exit status.
int cag_lsp_serve(const CagSessionOptions *session, const char *program, FILE *in, FILE *out);

#endif
