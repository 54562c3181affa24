// The language server: messages, documents, and their diagnostics.

#include "live/lsp_parts.h"

#include <stdlib.h>
#include <string.h>

// Limits of a check.
#define CHECK_SECONDS 20
#define CHECK_MEMORY ((size_t)2 << 30)

// --- Sending ---

void lsp_send(CagLsp *l, cJSON *message) {
  if (!message) return;
  cJSON_AddStringToObject(message, "jsonrpc", "2.0");
  char *text = cJSON_PrintUnformatted(message);
  cJSON_Delete(message);
  if (text) l->options.send(l->options.context, text, strlen(text));
  free(text);
}

static cJSON *answer_to(const cJSON *id) {
  cJSON *o = cJSON_CreateObject();
  cJSON_AddItemToObject(o, "id", id ? cJSON_Duplicate(id, true) : cJSON_CreateNull());
  return o;
}

void lsp_answer(CagLsp *l, const cJSON *id, cJSON *result) {
  cJSON *o = answer_to(id);
  cJSON_AddItemToObject(o, "result", result ? result : cJSON_CreateNull());
  lsp_send(l, o);
}

void lsp_answer_raw(CagLsp *l, const cJSON *id, const char *result) {
  cJSON *o = answer_to(id);
  cJSON_AddRawToObject(o, "result", result);
  lsp_send(l, o);
}

void lsp_fail(CagLsp *l, const cJSON *id, int code, const char *message) {
  cJSON *o = answer_to(id), *error = cJSON_AddObjectToObject(o, "error");
  cJSON_AddNumberToObject(error, "code", code);
  cJSON_AddStringToObject(error, "message", message);
  lsp_send(l, o);
}

void lsp_notify(CagLsp *l, const char *method, cJSON *params) {
  cJSON *o = cJSON_CreateObject();
  cJSON_AddStringToObject(o, "method", method);
  cJSON_AddItemToObject(o, "params", params);
  lsp_send(l, o);
}

void lsp_request(CagLsp *l, const char *method, cJSON *params) {
  cJSON *o = cJSON_CreateObject();
  char id[32];
  snprintf(id, sizeof id, "cag-%zu", ++l->next_id);
  cJSON_AddStringToObject(o, "id", id);
  cJSON_AddStringToObject(o, "method", method);
  cJSON_AddItemToObject(o, "params", params);
  lsp_send(l, o);
}

// --- Places ---

// Positions are written as text: lists have thousands, and cJSON is slow with numbers.
static int write_position(CagLsp *l, const char *file, size_t offset, char *out, size_t size) {
  size_t line, column;
  cag_document_position(l->workspace, file, offset, l->columns, &line, &column);
  return snprintf(out, size, "{\"line\":%zu,\"character\":%zu}", line, column);
}

cJSON *lsp_position_json(CagLsp *l, const char *file, size_t offset) {
  char text[80];
  write_position(l, file, offset, text, sizeof text);
  return cJSON_CreateRaw(text);
}

cJSON *lsp_range_json(CagLsp *l, const CagPlace *place) {
  char start[80], end[80], text[200];
  write_position(l, place->file, place->start, start, sizeof start);
  write_position(l, place->file, place->end, end, sizeof end);
  snprintf(text, sizeof text, "{\"start\":%s,\"end\":%s}", start, end);
  return cJSON_CreateRaw(text);
}

// Reads a number of a position. Numbers beyond the range of a protocol integer are its largest.
static bool read_count(const cJSON *v, size_t *out) {
  if (!cJSON_IsNumber(v) || !(v->valuedouble >= 0)) return false;
  *out = v->valuedouble > 2147483647.0 ? 2147483647u : (size_t)v->valuedouble;
  return true;
}

bool lsp_offset(CagLsp *l, const char *file, const cJSON *position, size_t *out) {
  size_t line, column;
  if (!read_count(lsp_get(position, "line"), &line) ||
      !read_count(lsp_get(position, "character"), &column))
    return false;
  *out = cag_document_offset(l->workspace, file, line, column, l->columns);
  return true;
}

bool lsp_range(CagLsp *l, const char *file, const cJSON *range, size_t *start, size_t *end) {
  return lsp_offset(l, file, lsp_get(range, "start"), start) &&
         lsp_offset(l, file, lsp_get(range, "end"), end) && *start <= *end;
}

// --- Documents ---

LspDocument *lsp_find(CagLsp *l, const char *uri) {
  for (size_t i = 0; uri && i < l->document_count; i++)
    if (strcmp(l->documents[i].uri, uri) == 0) return &l->documents[i];
  return NULL;
}

LspDocument *lsp_find_file(CagLsp *l, const char *file) {
  for (size_t i = 0; i < l->document_count; i++)
    if (strcmp(l->documents[i].file, file) == 0) return &l->documents[i];
  return NULL;
}

static void free_document(LspDocument *d) {
  free(d->uri);
  free(d->file);
  cJSON_Delete(d->ran);
  cJSON_Delete(d->published);
}

static void did_open(CagLsp *l, const cJSON *params) {
  const cJSON *item = lsp_get(params, "textDocument");
  const char *uri = lsp_text(item, "uri"), *text = lsp_text(item, "text");
  if (!uri || !text) return;
  LspDocument *d = lsp_find(l, uri);
  if (!d) {
    LspDocument *documents = realloc(l->documents, (l->document_count + 1) * sizeof *l->documents);
    if (!documents) return;
    l->documents = documents;
    d = &l->documents[l->document_count];
    *d = (LspDocument){.uri = strdup(uri), .file = lsp_file_of_uri(l, uri)};
    if (!d->uri || !d->file) {
      free_document(d);
      return;
    }
    l->document_count++;
  }
  const cJSON *version = lsp_get(item, "version");
  d->version = cJSON_IsNumber(version) ? version->valuedouble : 0;
  d->is_library = strncmp(d->file, "std.", 4) == 0;
  if (d->is_library) return;
  cag_workspace_open(l->workspace, d->file, text, strlen(text));
  lsp_scan_beside(l, d->file);
}

static void change(CagLsp *l, const LspDocument *d, const cJSON *item) {
  const char *text = lsp_text(item, "text");
  const cJSON *range = lsp_get(item, "range");
  size_t start, end;
  if (!text) return;
  if (!range) cag_workspace_open(l->workspace, d->file, text, strlen(text));
  else if (lsp_range(l, d->file, range, &start, &end))
    cag_workspace_change(l->workspace, d->file, start, end, text, strlen(text));
}

static void did_change(CagLsp *l, const cJSON *params) {
  const cJSON *document = lsp_get(params, "textDocument"), *item;
  LspDocument *d = lsp_find(l, lsp_text(document, "uri"));
  const cJSON *version = lsp_get(document, "version");
  if (!d || d->is_library) return;
  if (cJSON_IsNumber(version)) d->version = version->valuedouble;
  cJSON_ArrayForEach(item, lsp_get(params, "contentChanges")) { change(l, d, item); }
  lsp_stop_run(l, d->file);
  cJSON_Delete(d->ran);
  d->ran = NULL;
}

static void did_save(CagLsp *l, const cJSON *params) {
  LspDocument *d = lsp_find(l, lsp_text(lsp_get(params, "textDocument"), "uri"));
  if (d && !d->is_library && l->set.run_on_save && strchr(d->file, '/')) lsp_run_saved(l, d);
}

// --- Diagnostics ---

typedef struct Publishing {
  CagLsp *l;
  const LspDocument *d;
  cJSON *files; // { file: [diagnostics] }
} Publishing;

static cJSON *list_for(cJSON *files, const char *file) {
  cJSON *list = cJSON_GetObjectItemCaseSensitive(files, file);
  return list ? list : cJSON_AddArrayToObject(files, file);
}

static void add_related(CagLsp *l, cJSON *o, const CagProblem *p) {
  cJSON *list = cJSON_CreateArray();
  for (size_t i = 0; i < p->note_count; i++) {
    char *uri = p->notes[i].place.file ? lsp_uri_of_file(l, p->notes[i].place.file) : NULL;
    if (!uri) continue;
    cJSON *item = cJSON_CreateObject(), *location = cJSON_AddObjectToObject(item, "location");
    cJSON_AddStringToObject(location, "uri", uri);
    cJSON_AddItemToObject(location, "range", lsp_range_json(l, &p->notes[i].place));
    cJSON_AddStringToObject(item, "message", *p->notes[i].text ? p->notes[i].text : "here");
    cJSON_AddItemToArray(list, item);
    free(uri);
  }
  if (cJSON_GetArraySize(list)) cJSON_AddItemToObject(o, "relatedInformation", list);
  else cJSON_Delete(list);
}

static void add_problem(void *context, const CagProblem *p) {
  const Publishing *pub = context;
  CagLsp *l = pub->l;
  const CagPlace start = {pub->d->file, 0, 0}, *place = p->place.file ? &p->place : &start;
  cJSON *o = cJSON_CreateObject();
  char message[2048];
  snprintf(message, sizeof message, "%s%s%s", p->message ? p->message : "",
           p->help ? "\nhelp: " : "", p->help ? p->help : "");
  cJSON_AddItemToObject(o, "range", lsp_range_json(l, place));
  cJSON_AddNumberToObject(o, "severity", p->unused ? 4 : p->warning ? 2 : 1);
  cJSON_AddStringToObject(o, "code", p->code);
  cJSON_AddStringToObject(o, "source", "cag");
  cJSON_AddStringToObject(o, "message", message);
  if (p->unused || p->deprecated) {
    const int tag = p->unused ? 1 : 2;
    cJSON_AddItemToObject(o, "tags", cJSON_CreateIntArray(&tag, 1));
  }
  add_related(l, o, p);
  cJSON_AddItemToArray(list_for(pub->files, place->file), o);
}

// Tests whether a list has a diagnostic with the same code and range.
static bool has_same(const cJSON *list, const cJSON *diagnostic) {
  const cJSON *other;
  cJSON_ArrayForEach(other, list) {
    if (cJSON_Compare(lsp_get(other, "code"), lsp_get(diagnostic, "code"), true) &&
        cJSON_Compare(lsp_get(other, "range"), lsp_get(diagnostic, "range"), true))
      return true;
  }
  return false;
}

// Adds the diagnostics of `more` that are not in `out`, in which one document has them once.
static void add_new(cJSON *out, const cJSON *more) {
  const bool first = !out->child;
  const cJSON *item;
  cJSON_ArrayForEach(item, more) {
    if (first || !has_same(out, item)) cJSON_AddItemToArray(out, cJSON_Duplicate(item, true));
  }
}

// Adds what documents have found in a file. An open document counts for itself.
static void collect(CagLsp *l, const char *file, cJSON *out) {
  const LspDocument *own = lsp_find_file(l, file);
  for (size_t i = 0; i < l->document_count; i++) {
    const LspDocument *d = &l->documents[i];
    if (!own || own == d) add_new(out, lsp_get(d->published, file));
    add_new(out, lsp_get(d->ran, file));
  }
}

static void publish_file(CagLsp *l, const char *file) {
  char *uri = lsp_uri_of_file(l, file);
  if (!uri) return;
  const LspDocument *d = lsp_find_file(l, file);
  cJSON *params = cJSON_CreateObject(), *list = cJSON_CreateArray();
  collect(l, file, list);
  cJSON_AddStringToObject(params, "uri", uri);
  if (d) cJSON_AddNumberToObject(params, "version", d->version);
  cJSON_AddItemToObject(params, "diagnostics", list);
  lsp_notify(l, "textDocument/publishDiagnostics", params);
  free(uri);
}

// Publishes the document, and the other files that it had or has problems in.
static void publish_files(CagLsp *l, const LspDocument *d, const cJSON *before, const cJSON *now) {
  const cJSON *item;
  publish_file(l, d->file);
  cJSON_ArrayForEach(item, now) {
    if (strcmp(item->string, d->file) != 0) publish_file(l, item->string);
  }
  cJSON_ArrayForEach(item, before) {
    if (strcmp(item->string, d->file) != 0 && !lsp_get(now, item->string))
      publish_file(l, item->string);
  }
}

void lsp_publish(CagLsp *l, LspDocument *d) {
  Publishing p = {l, d, cJSON_CreateObject()};
  const int status = cag_document_check(l->workspace, d->file, add_problem, &p);
  if (status == CAG_STATUS_INTERRUPTED) { // a change is waiting
    cJSON_Delete(p.files);
    return;
  }
  if (status == CAG_STATUS_LIMIT && !cJSON_GetArraySize(p.files)) {
    CagProblem limit = {.place = {d->file, 0, 0},
                        .code = "E0602",
                        .message = "the check exceeds the limits of memory or time"};
    add_problem(&p, &limit);
  }
  cJSON *before = d->published;
  d->published = p.files;
  publish_files(l, d, before, p.files);
  cJSON_Delete(before);
}

void lsp_publish_run(CagLsp *l, const char *file, cJSON *diagnostics) {
  LspDocument *d = lsp_find_file(l, file);
  if (!d || cag_document_is_stale(l->workspace, file)) {
    cJSON_Delete(diagnostics);
    return;
  }
  cJSON *before = d->ran;
  d->ran = diagnostics;
  publish_files(l, d, before, diagnostics);
  cJSON_Delete(before);
}

static void did_close(CagLsp *l, const cJSON *params) {
  LspDocument *d = lsp_find(l, lsp_text(lsp_get(params, "textDocument"), "uri"));
  if (!d) return;
  cag_workspace_close(l->workspace, d->file);
  lsp_stop_run(l, d->file);
  LspDocument old = *d;
  *d = l->documents[--l->document_count];
  const cJSON *item;
  // Its problems are shown only if another document has found them.
  cJSON *own = cJSON_CreateObject();
  cJSON_AddArrayToObject(own, old.file);
  cJSON_ArrayForEach(item, old.published) { list_for(own, item->string); }
  cJSON_ArrayForEach(item, old.ran) { list_for(own, item->string); }
  cJSON_ArrayForEach(item, own) {
    cJSON *cleared = cJSON_CreateObject(), *list = cJSON_CreateArray();
    char *uri = strcmp(item->string, old.file) ? lsp_uri_of_file(l, item->string) : strdup(old.uri);
    collect(l, item->string, list);
    cJSON_AddStringToObject(cleared, "uri", uri ? uri : "");
    cJSON_AddItemToObject(cleared, "diagnostics", list);
    if (uri) lsp_notify(l, "textDocument/publishDiagnostics", cleared);
    else cJSON_Delete(cleared);
    free(uri);
  }
  cJSON_Delete(own);
  free_document(&old);
}

// --- The life of the server ---

static void read_client(CagLsp *l, const cJSON *params) {
  const cJSON *all = lsp_get(params, "capabilities"), *text = lsp_get(all, "textDocument"),
              *workspace = lsp_get(all, "workspace"), *item;
  const cJSON *completion = lsp_get(lsp_get(text, "completion"), "completionItem");
  const cJSON *defaults =
      lsp_get(lsp_get(lsp_get(text, "completion"), "completionList"), "itemDefaults");
  cJSON_ArrayForEach(item, defaults) {
    if (cJSON_IsString(item) && strcmp(item->valuestring, "editRange") == 0)
      l->client.edit_range = true;
  }
  l->client.snippets = lsp_is_true(completion, "snippetSupport");
  l->client.hierarchy =
      lsp_is_true(lsp_get(text, "documentSymbol"), "hierarchicalDocumentSymbolSupport");
  l->client.links = lsp_is_true(lsp_get(text, "definition"), "linkSupport");
  l->client.changes = lsp_is_true(lsp_get(workspace, "workspaceEdit"), "documentChanges");
  l->client.watched_files =
      lsp_is_true(lsp_get(workspace, "didChangeWatchedFiles"), "dynamicRegistration");
  l->client.show_document = lsp_is_true(lsp_get(lsp_get(all, "window"), "showDocument"), "support");
  const cJSON *formats = lsp_get(lsp_get(text, "hover"), "contentFormat");
  l->client.markdown = !formats;
  cJSON_ArrayForEach(item, formats) {
    if (cJSON_IsString(item) && !strcmp(item->valuestring, "markdown")) l->client.markdown = true;
  }
  l->columns = CAG_COLUMNS_UTF16;
  cJSON_ArrayForEach(item, lsp_get(lsp_get(all, "general"), "positionEncodings")) {
    if (cJSON_IsString(item) && strcmp(item->valuestring, "utf-8") == 0)
      l->columns = CAG_COLUMNS_UTF8;
  }
}

static void read_settings(CagLsp *l, const cJSON *settings) {
  const cJSON *own = lsp_get(settings, "cag");
  if (own) settings = own;
  const cJSON *run = lsp_get(settings, "runOnSave"), *hints = lsp_get(settings, "inlayHints");
  if (cJSON_IsBool(run)) l->set.run_on_save = cJSON_IsTrue(run);
  if (cJSON_IsBool(hints)) l->set.hints = cJSON_IsTrue(hints);
}

// Adds the folders of the client's options to the module path.
static void read_module_path(CagLsp *l, const cJSON *options) {
  const cJSON *list = lsp_get(options, "modulePath"), *item;
  CagSessionOptions *o = &l->options.session;
  const size_t given = o->module_path_count, more = (size_t)cJSON_GetArraySize(list);
  if (!cJSON_IsArray(list) || l->module_path || l->options.folder) return;
  l->module_path = calloc(given + more + 1, sizeof *l->module_path);
  if (!l->module_path) return;
  size_t n = 0;
  for (; n < given; n++) l->module_path[n] = strdup(o->module_path[n]);
  cJSON_ArrayForEach(item, list) {
    if (cJSON_IsString(item)) l->module_path[n++] = strdup(item->valuestring);
  }
  o->module_path = (const char *const *)l->module_path;
  o->module_path_count = n;
}

static void read_folders(CagLsp *l, const cJSON *params) {
  const cJSON *folders = lsp_get(params, "workspaceFolders"), *item;
  if (cJSON_IsArray(folders)) {
    cJSON_ArrayForEach(item, folders) {
      if (lsp_text(item, "uri")) lsp_add_folder(l, lsp_text(item, "uri"));
    }
  } else if (lsp_text(params, "rootUri")) {
    lsp_add_folder(l, lsp_text(params, "rootUri"));
  } else if (lsp_text(params, "rootPath")) {
    lsp_add_folder(l, lsp_text(params, "rootPath"));
  }
}

static void initialize(CagLsp *l, const cJSON *id, const cJSON *params) {
  if (l->initialized) {
    lsp_fail(l, id, LSP_INVALID_REQUEST, "the server is initialized already");
    return;
  }
  read_client(l, params);
  read_settings(l, lsp_get(params, "initializationOptions"));
  read_module_path(l, lsp_get(params, "initializationOptions"));
  CagSessionOptions options = l->options.session;
  options.interrupt = &l->interrupt;
  if (!(options.max_time > 0) || options.max_time > CHECK_SECONDS) options.max_time = CHECK_SECONDS;
  if (options.max_memory > CHECK_MEMORY) options.max_memory = CHECK_MEMORY;
  l->workspace = cag_workspace_new(&options);
  if (!l->workspace) {
    lsp_fail(l, id, LSP_INTERNAL_ERROR, "not enough memory");
    return;
  }
  l->initialized = true;
  read_folders(l, params);
  cJSON *result = cJSON_CreateObject(), *info = cJSON_CreateObject();
  cJSON_AddItemToObject(result, "capabilities", lsp_capabilities(l));
  cJSON_AddStringToObject(info, "name", "cag");
  cJSON_AddStringToObject(info, "version", cag_version());
  cJSON_AddItemToObject(result, "serverInfo", info);
  lsp_answer(l, id, result);
}

// Reads the library once, so that the first completion need not.
static void ignore_symbol(void *context, const CagSymbolView *s) {
  (void)context;
  (void)s;
}

static void did_initialize(CagLsp *l) {
  const char *module;
  lsp_scan_folders(l);
  for (size_t i = 0; (module = cag_library_module(i)); i++)
    cag_document_symbols(l->workspace, module, ignore_symbol, NULL);
  if (!l->client.watched_files) return;
  lsp_request(l, "client/registerCapability",
              cJSON_Parse("{\"registrations\":[{\"id\":\"files\",\"method\":"
                          "\"workspace/didChangeWatchedFiles\",\"registerOptions\":{\"watchers\":"
                          "[{\"globPattern\":\"**/*.cag\"}]}}]}"));
}

static void did_change_files(CagLsp *l, const cJSON *params) {
  const cJSON *item;
  cJSON_ArrayForEach(item, lsp_get(params, "changes")) {
    const char *uri = lsp_text(item, "uri");
    char *file = uri ? lsp_file_of_uri(l, uri) : NULL;
    const cJSON *type = lsp_get(item, "type");
    if (file && strchr(file, '/')) {
      if (cJSON_IsNumber(type) && type->valueint == 3)
        cag_workspace_remove_file(l->workspace, file);
      else if (cJSON_IsNumber(type) && type->valueint == 1)
        cag_workspace_add_file(l->workspace, file);
      cag_workspace_file_changed(l->workspace, file);
    }
    free(file);
  }
}

static void did_change_folders(CagLsp *l, const cJSON *params) {
  const cJSON *event = lsp_get(params, "event"), *item;
  cJSON_ArrayForEach(item, lsp_get(event, "removed")) {
    if (lsp_text(item, "uri")) lsp_remove_folder(l, lsp_text(item, "uri"));
  }
  cJSON_ArrayForEach(item, lsp_get(event, "added")) {
    if (lsp_text(item, "uri")) lsp_add_folder(l, lsp_text(item, "uri"));
  }
  lsp_scan_folders(l);
}

static void handle_notification(CagLsp *l, const char *method, const cJSON *params) {
  if (strcmp(method, "exit") == 0) l->done = true;
  if (!l->initialized || l->shut_down) return;
  if (strcmp(method, "initialized") == 0) did_initialize(l);
  else if (strcmp(method, "textDocument/didOpen") == 0) did_open(l, params);
  else if (strcmp(method, "textDocument/didChange") == 0) did_change(l, params);
  else if (strcmp(method, "textDocument/didSave") == 0) did_save(l, params);
  else if (strcmp(method, "textDocument/didClose") == 0) did_close(l, params);
  else if (strcmp(method, "workspace/didChangeWatchedFiles") == 0) did_change_files(l, params);
  else if (strcmp(method, "workspace/didChangeWorkspaceFolders") == 0)
    did_change_folders(l, params);
  else if (strcmp(method, "workspace/didChangeConfiguration") == 0)
    read_settings(l, lsp_get(params, "settings"));
}

static void handle_request(CagLsp *l, const char *method, const cJSON *id, const cJSON *params) {
  if (strcmp(method, "initialize") == 0) {
    initialize(l, id, params);
  } else if (!l->initialized) {
    lsp_fail(l, id, LSP_NOT_INITIALIZED, "the server is not initialized");
  } else if (l->shut_down) {
    lsp_fail(l, id, LSP_INVALID_REQUEST, "the server is shut down");
  } else if (strcmp(method, "shutdown") == 0) {
    l->shut_down = true;
    lsp_end_jobs(l);
    lsp_answer(l, id, NULL);
  } else if (!lsp_handle(l, method, id, params)) {
    lsp_fail(l, id, LSP_METHOD_NOT_FOUND, "unknown method");
  }
}

// A zero byte would end the texts of the parser. It is replaced by the substitute character, which
// has the same width, so that positions stay correct.
static char *without_zeros(const char *json, size_t length) {
  char *copy = malloc(length + 1);
  if (!copy) return NULL;
  for (size_t i = 0; i < length; i++) {
    copy[i] = json[i];
    if (json[i] != '\\' || i + 1 >= length) continue;
    copy[i + 1] = json[i + 1];
    if (i + 5 < length && strncmp(json + i, "\\u0000", 6) == 0) {
      memcpy(copy + i, "\\u001a", 6);
      i += 5;
    } else i++;
  }
  copy[length] = 0;
  return copy;
}

static bool is_utf8(const char *text, size_t length) {
  const unsigned char *s = (const unsigned char *)text;
  for (size_t i = 0; i < length;) {
    const size_t n = s[i] < 0x80                   ? 1
                     : s[i] >= 0xC2 && s[i] < 0xE0 ? 2
                     : s[i] >= 0xE0 && s[i] < 0xF0 ? 3
                     : s[i] >= 0xF0 && s[i] < 0xF5 ? 4
                                                   : 0;
    if (n == 0 || s[i] == 0 || i + n > length) return false;
    for (size_t k = 1; k < n; k++)
      if ((s[i + k] & 0xC0) != 0x80) return false;
    if ((s[i] == 0xE0 && s[i + 1] < 0xA0) || (s[i] == 0xED && s[i + 1] >= 0xA0) ||
        (s[i] == 0xF0 && s[i + 1] < 0x90) || (s[i] == 0xF4 && s[i + 1] >= 0x90))
      return false;
    i += n;
  }
  return true;
}

void cag_lsp_receive(CagLsp *l, const char *json, size_t length) {
  l->interrupt = 0;
  if (!is_utf8(json, length)) {
    lsp_fail(l, NULL, LSP_PARSE_ERROR, "the message is not UTF-8");
    return;
  }
  char *text = without_zeros(json, length);
  const char *end = NULL;
  cJSON *message = text ? cJSON_ParseWithLengthOpts(text, length + 1, &end, true) : NULL;
  free(text);
  const cJSON *id = lsp_get(message, "id");
  const char *method = lsp_text(message, "method");
  if (id && !cJSON_IsNumber(id) && !cJSON_IsString(id)) id = NULL;
  if (!message) lsp_fail(l, NULL, LSP_PARSE_ERROR, "the message is not JSON");
  else if (!cJSON_IsObject(message)) lsp_fail(l, NULL, LSP_INVALID_REQUEST, "expected an object");
  else if (method && id) handle_request(l, method, id, lsp_get(message, "params"));
  else if (method) handle_notification(l, method, lsp_get(message, "params"));
  else if (!lsp_get(message, "result") && !lsp_get(message, "error"))
    lsp_fail(l, id, LSP_INVALID_REQUEST, "expected a method");
  cJSON_Delete(message);
}

// --- Work between messages ---

static LspDocument *next_stale(CagLsp *l) {
  for (size_t i = l->document_count; i-- > 0;)
    if (!l->documents[i].is_library && cag_document_is_stale(l->workspace, l->documents[i].file))
      return &l->documents[i];
  return NULL;
}

bool cag_lsp_has_work(CagLsp *l) {
  return l->initialized && !l->shut_down && (next_stale(l) || lsp_jobs_done(l));
}

bool cag_lsp_work(CagLsp *l) {
  if (!l->initialized || l->shut_down) return false;
  l->interrupt = 0;
  LspDocument *d = next_stale(l);
  if (d) lsp_publish(l, d);
  else lsp_finish_jobs(l);
  return cag_lsp_has_work(l);
}

void cag_lsp_interrupt(CagLsp *l) { l->interrupt = 1; }

bool cag_lsp_is_done(const CagLsp *l, int *status) {
  *status = l->shut_down ? 0 : 1;
  return l->done;
}

CagLsp *cag_lsp_new(const CagLspOptions *options) {
  CagLsp *l = calloc(1, sizeof *l);
  if (!l) return NULL;
  l->options = *options;
  l->columns = CAG_COLUMNS_UTF16;
  l->set.run_on_save = true;
  pthread_mutex_init(&l->lock, NULL);
  return l;
}

void cag_lsp_free(CagLsp *l) {
  if (!l) return;
  lsp_end_jobs(l);
  for (size_t i = 0; i < l->document_count; i++) free_document(&l->documents[i]);
  free(l->documents);
  for (size_t i = 0; i < l->folder_count; i++) free(l->folders[i]);
  free(l->folders);
  cag_workspace_free(l->workspace);
  for (size_t i = 0; l->module_path && l->module_path[i]; i++) free(l->module_path[i]);
  free(l->module_path);
  free(l->library);
  free(l->words.file);
  free(l->words.data);
  pthread_mutex_destroy(&l->lock);
  free(l);
}
