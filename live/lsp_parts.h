// What the files of the language server share: its state, and helpers for JSON and places.

#ifndef CAG_LIVE_LSP_PARTS_H
#define CAG_LIVE_LSP_PARTS_H

#include <cjson/cJSON.h>
#include <pthread.h>

#include "live/lsp.h"

// An error answer (JSON-RPC 2.0, and LSP).
enum {
  LSP_PARSE_ERROR = -32700,
  LSP_INVALID_REQUEST = -32600,
  LSP_METHOD_NOT_FOUND = -32601,
  LSP_INVALID_PARAMS = -32602,
  LSP_INTERNAL_ERROR = -32603,
  LSP_NOT_INITIALIZED = -32002,
  LSP_REQUEST_CANCELLED = -32800,
  LSP_REQUEST_FAILED = -32803
};

// A document that the client has opened.
typedef struct LspDocument {
  char *uri;  // as the client writes it
  char *file; // name in the workspace
  double version;
  bool is_library;  // read-only; its text is that of the library
  cJSON *ran;       // diagnostics of the last run, by file; NULL: none, or the text has changed
  cJSON *published; // files for which this document has reported problems: { file: [...] }
} LspDocument;

// A run of a script after a save, or a program that a command has started.
typedef struct LspJob {
  struct LspJob *next;
  CagLsp *lsp;
  enum { JOB_RUN, JOB_COMMAND } kind;
  char *file;
  pthread_t thread;
  volatile int interrupt;
  bool shows;    // RUN: build the scene as well
  bool done;     // set by its thread, under the lock
  cJSON *result; // RUN: a list of diagnostics
  // COMMAND:
  char **arguments; // ends with NULL
  cJSON *id;        // the request to be answered
  char *output;     // of the program
  char *picture;    // to be shown at the end; NULL: none
  int status;
  int pid; // 0: it does not run
} LspJob;

struct CagLsp {
  CagLspOptions options;
  CagWorkspace *workspace;
  volatile int interrupt;
  bool initialized, shut_down, done;
  CagColumns columns;
  struct { // what the client supports
    bool snippets, edit_range, markdown, links, changes, watched_files, show_document, tags,
        hierarchy;
  } client;
  struct { // settings
    bool run_on_save, hints;
  } set;
  LspDocument *documents;
  size_t document_count;
  char **folders;
  size_t folder_count;
  char *library; // folder of the files of the library; NULL: not known
  // The last semantic words, for changes.
  struct {
    char *file;
    unsigned *data;
    size_t count, id;
  } words;
  size_t next_id;       // of requests of the server
  pthread_mutex_t lock; // of the jobs, and of sending
  LspJob *jobs;
  char **module_path; // with that of the client's options
};

// --- lsp.c ---
void lsp_send(CagLsp *l, cJSON *message); // frees it
void lsp_answer(CagLsp *l, const cJSON *id, cJSON *result);
void lsp_answer_raw(CagLsp *l, const cJSON *id, const char *result);
void lsp_fail(CagLsp *l, const cJSON *id, int code, const char *message);
void lsp_notify(CagLsp *l, const char *method, cJSON *params);
void lsp_request(CagLsp *l, const char *method, cJSON *params);
LspDocument *lsp_find(CagLsp *l, const char *uri);
LspDocument *lsp_find_file(CagLsp *l, const char *file);
void lsp_publish(CagLsp *l, LspDocument *d);                           // checks and publishes
void lsp_publish_run(CagLsp *l, const char *file, cJSON *diagnostics); // takes them

// --- lsp_files.c ---
// Returns the name of a document in the workspace (malloc).
char *lsp_file_of_uri(CagLsp *l, const char *uri);
// Returns the URI of a document (malloc), or NULL: for a module of the library whose file cannot be
// written.
char *lsp_uri_of_file(CagLsp *l, const char *file);
void lsp_add_folder(CagLsp *l, const char *uri);
void lsp_scan_folders(CagLsp *l);
void lsp_remove_folder(CagLsp *l, const char *uri);
// Adds the scripts beside a document that is in no folder of the workspace.
void lsp_scan_beside(CagLsp *l, const char *file);

// --- lsp_requests.c ---
typedef cJSON *LspHandler(CagLsp *l, const cJSON *params);
// Answers a request. Returns false if its method is unknown.
bool lsp_handle(CagLsp *l, const char *method, const cJSON *id, const cJSON *params);
cJSON *lsp_capabilities(CagLsp *l);

// --- lsp_jobs.c ---
void lsp_run_saved(CagLsp *l, LspDocument *d);
void lsp_stop_run(CagLsp *l, const char *file);
void lsp_execute(CagLsp *l, const cJSON *id, const cJSON *params);
bool lsp_jobs_done(CagLsp *l);
void lsp_finish_jobs(CagLsp *l); // reports those that are done
void lsp_end_jobs(CagLsp *l);

// --- JSON ---
static inline const char *lsp_text(const cJSON *o, const char *key) {
  const cJSON *v = cJSON_GetObjectItemCaseSensitive(o, key);
  return cJSON_IsString(v) ? v->valuestring : NULL;
}
static inline const cJSON *lsp_get(const cJSON *o, const char *key) {
  return cJSON_GetObjectItemCaseSensitive(o, key);
}
static inline bool lsp_is_true(const cJSON *o, const char *key) {
  return cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(o, key));
}
cJSON *lsp_position_json(CagLsp *l, const char *file, size_t offset);
cJSON *lsp_range_json(CagLsp *l, const CagPlace *place);
// Reads { line, character }. Returns false if it is none.
bool lsp_offset(CagLsp *l, const char *file, const cJSON *position, size_t *out);
bool lsp_range(CagLsp *l, const char *file, const cJSON *range, size_t *start, size_t *end);
char *lsp_copy(const char *text); // strdup

#endif
