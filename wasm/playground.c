// What the worker of the playground calls (web/src/worker.js).
//
// The files of the model are in /model, in the file system that emscripten keeps in memory. Texts
// are UTF-8 and end with a NUL. Functions that return a status leave an answer, which is read by
// playground_bytes and its neighbors and is valid until the next call.

#include <cJSON.h>
#include <emscripten.h>
#include <stdlib.h>
#include <string.h>

#include "cag.h"
#include "live/lsp.h"
#include "live/measures.h"
#include "live/model_answers.h"
#include "live/model_run.h"
#include "live/questions.h"

#define FOLDER "/model"
// A run may take this much memory. The last good run is kept while the next one is under way, and
// there are at most 2 GiB.
#define MEMORY_MOST ((size_t)800 << 20)

// The host is an object of the worker.
EM_JS(void, host_event, (const char *name, const char *json),
      { Module["host"].event(UTF8ToString(name), UTF8ToString(json)); })
EM_JS(int, host_has_mesh, (const char *id), { return Module["host"].hasMesh(UTF8ToString(id)); })
EM_JS(void, host_keep_mesh, (const char *id, const unsigned char *bytes, size_t size),
      { Module["host"].keepMesh(UTF8ToString(id), HEAPU8.slice(bytes, bytes + size).buffer); })
EM_JS(void, host_progress, (double percent, const char *phase),
      { Module["host"].progress(percent, UTF8ToString(phase)); })

static CagModelRun good;
static CagModelAnswer answer;

// --- Answers ---

static int keep_answer(CagModelAnswer a) {
  free(answer.bytes);
  answer = a;
  return a.status;
}

static int keep_text(char *text, size_t size, const char *type) {
  return keep_answer(text ? (CagModelAnswer){200, text, size, type, "", NULL, NULL}
                          : (CagModelAnswer){.status = 500, .error = "out of memory"});
}

EMSCRIPTEN_KEEPALIVE const char *playground_bytes(void) { return answer.bytes; }
EMSCRIPTEN_KEEPALIVE size_t playground_size(void) { return answer.size; }
EMSCRIPTEN_KEEPALIVE const char *playground_type(void) { return answer.type; }
EMSCRIPTEN_KEEPALIVE const char *playground_name(void) { return answer.name; }
EMSCRIPTEN_KEEPALIVE const char *playground_error(void) { return answer.error; }
EMSCRIPTEN_KEEPALIVE const char *playground_help(void) { return answer.help; }

EMSCRIPTEN_KEEPALIVE int playground_hello(const char *script) {
  CagString s = {0};
  const CagHello hello = {.file = script, .folder = FOLDER, .engine = "worker"};
  cag_hello_write(&hello, &s);
  if (s.failed) cag_string_free(&s);
  return keep_text(s.bytes, s.length, NULL);
}

// --- Runs ---

static bool has_mesh(void *context, const char *id) {
  (void)context;
  return host_has_mesh(id);
}

static bool keep_mesh(void *context, const CagMeshView *mesh) {
  unsigned char *bytes;
  size_t size;
  (void)context;
  if (!cag_live_mesh_bytes(mesh, &bytes, &size)) return false;
  host_keep_mesh(mesh->id, bytes, size);
  free(bytes);
  return true;
}

static void publish(void *context, const char *event, const char *json) {
  (void)context;
  host_event(event, json);
}

static CagSessionOptions session_options(void) {
  CagSessionOptions o;
  cag_session_options_init(&o);
  o.max_memory = MEMORY_MOST;
  o.folder = FOLDER;
  return o;
}

// Runs the script of the request, and publishes what it shows. Returns whether the request is
// valid.
EMSCRIPTEN_KEEPALIVE int playground_run(const char *script, int number, const char *request) {
  CagLiveRequest q;
  const CagModel model = {.session = session_options(),
                          .has_file = true,
                          .folder = FOLDER,
                          .name = script,
                          .meshes = {has_mesh, keep_mesh, NULL},
                          .publish = publish};
  if (!cag_live_request_read(request, strlen(request), &q)) return 0;
  cag_model_run(&model, &q, number, NULL, &good);
  cag_live_request_free(&q);
  return 1;
}

// --- Questions about the last good run ---

EMSCRIPTEN_KEEPALIVE int playground_export(const char *script, const char *format) {
  return keep_answer(cag_answer_export(good.session, script, format));
}

EMSCRIPTEN_KEEPALIVE int playground_image(const char *name) {
  return keep_answer(cag_answer_image(good.session, name));
}

// The measures of a part, or of all if its name is empty.
EMSCRIPTEN_KEEPALIVE int playground_measure(const char *script, const char *part) {
  if (!*part && good.session) {
    CagMeasuring m = cag_measure(good.session, script, NULL);
    char *text = cJSON_PrintUnformatted(m.whole);
    cJSON_Delete(m.whole);
    return keep_text(text, text ? strlen(text) : 0, NULL);
  }
  return keep_answer(cag_answer_measure(good.session, script, part));
}

// See live/questions.h. An answer with "error" is a refusal.
EMSCRIPTEN_KEEPALIVE int playground_question(const char *question, const char *request) {
  CagString s = {0};
  const CagLiveMeshes meshes = {has_mesh, keep_mesh, NULL};
  cag_live_ask(question, good.session, request, strlen(request), &meshes, &s);
  if (s.failed) cag_string_free(&s);
  return keep_text(s.bytes, s.length, NULL);
}

static void tell_progress(void *context, double percent, const char *phase) {
  (void)context;
  host_progress(percent, phase);
}

EMSCRIPTEN_KEEPALIVE int playground_picture(const char *request) {
  CagPictureRequest r;
  if (!cag_picture_request_read(request, strlen(request), &r))
    return keep_answer((CagModelAnswer){.status = 400, .error = "expected a JSON object"});
  return keep_answer(cag_answer_picture(good.session, &r, tell_progress, NULL));
}

// --- The language server ---

static CagLsp *language;
static CagString outbox; // messages, separated by commas

static void put_message(void *context, const char *json, size_t length) {
  (void)context;
  if (outbox.length > 0) cag_string_add(&outbox, ",", 1);
  cag_string_add(&outbox, json, length);
}

static void ignore_wake(void *context) { (void)context; }

// Handles a list of messages, and looks for problems if `check` is "true". Answers with a list of
// messages.
EMSCRIPTEN_KEEPALIVE int playground_lsp(const char *messages, const char *check) {
  const CagLspOptions options = {
      .session = session_options(), .folder = FOLDER, .send = put_message, .wake = ignore_wake};
  if (!language) language = cag_lsp_new(&options);
  cJSON *list = cJSON_Parse(messages);
  const cJSON *message;
  cJSON_ArrayForEach(message, list) {
    char *text = cJSON_PrintUnformatted(message);
    if (text && language) cag_lsp_receive(language, text, strlen(text));
    free(text);
  }
  cJSON_Delete(list);
  while (language && !strcmp(check, "true") && cag_lsp_has_work(language)) cag_lsp_work(language);
  CagString all = {0};
  cag_string_add(&all, "[", 1);
  if (outbox.bytes) cag_string_add(&all, outbox.bytes, outbox.length);
  cag_string_add(&all, "]", 1);
  all.failed |= outbox.failed || !language;
  cag_string_free(&outbox);
  if (all.failed) cag_string_free(&all);
  return keep_text(all.bytes, all.length, NULL);
}

// The text of a module of the library.
EMSCRIPTEN_KEEPALIVE int playground_library(const char *module) {
  size_t size;
  const char *text = cag_library_text(module, &size);
  if (!text)
    return keep_answer((CagModelAnswer){.status = 404, .error = "there is no such module"});
  return keep_text(strndup(text, size), size, "text/plain");
}

// --- Texts ---

static int fail_with(CagSession *s, const char *message) {
  static char kept[512];
  CagErrorView e = {0};
  if (s && cag_session_error_count(s) > 0) cag_session_error(s, 0, &e);
  snprintf(kept, sizeof kept, "%s", e.message ? e.message : message);
  return keep_answer((CagModelAnswer){.status = 422, .error = kept});
}

// Formats a script.
EMSCRIPTEN_KEEPALIVE int playground_format(const char *script, const char *text) {
  char *out = NULL;
  size_t size = 0;
  const CagSessionOptions o = session_options();
  CagSession *s = cag_session_new(&o);
  int status;
  if (s && cag_session_format(s, script, text, strlen(text), &out, &size) == CAG_STATUS_OK)
    status = keep_text(out, size, "text/plain");
  else status = fail_with(s, "the script cannot be formatted");
  cag_session_free(s);
  return status;
}

// The documentation of a name, as `cag doc` prints it.
EMSCRIPTEN_KEEPALIVE int playground_document(const char *name) {
  char *text = NULL;
  size_t size = 0;
  const CagSessionOptions o = session_options();
  CagSession *s = cag_session_new(&o);
  FILE *f = open_memstream(&text, &size);
  const bool known = s && f && cag_session_document(s, *name ? name : NULL, false, f);
  if (f) fclose(f);
  int status;
  if (known) status = keep_text(text, size, "text/plain");
  else {
    free(text);
    status = fail_with(s, "there is no documentation of this name");
  }
  cag_session_free(s);
  return status;
}
