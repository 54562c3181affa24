#include "live/view.h"

#include <cJSON.h>
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "live/json_write.h"
#include "live/lsp_pages.h"
#include "live/model_answers.h"
#include "live/model_files.h"
#include "live/page_files.h"
#include "live/questions.h"
#include "live/render_jobs.h"
#include "live/runner.h"
#include "live/watch_files.h"

// Milliseconds between looks at the flag that ends the server, and at files that cannot be watched.
enum { STOP_EVERY = 50 };
#define MESH_MEMORY ((size_t)512 << 20)
#define UNTITLED "untitled.cag"

typedef struct View {
  const CagViewOptions *options;
  char folder[PATH_MAX], name[PATH_MAX]; // the script is `name` in `folder`
  CagServer *server;
  CagMeshes *meshes;
  CagRunner *runner;
  CagRenderJobs *jobs;
  CagLspPages *editors;
  pthread_mutex_t gate; // held while a request is routed
  bool closing;
  char version[CAG_VERSION_SIZE]; // of the script's file, as last seen
  CagFileWatch *watch;
  // The files that the last run read, as absolute paths. Behind the gate.
  char **read;
  size_t read_count;
  bool read_changed; // since the watch was told
  double began;      // when that run began, by the clock of files
  // POV-Ray is looked for while the page loads, because it must be started for that.
  pthread_t finder;
  bool finding, povray;
} View;

// --- Answers ---

static void answer_text(CagExchange *x, int status, const CagString *s) {
  if (s->failed) cag_exchange_fail(x, 500, "out of memory", NULL);
  else cag_exchange_answer(x, &(CagAnswer){.status = status, .bytes = s->bytes, .size = s->length});
}

static void answer_number(CagExchange *x, int status, const char *key, int number) {
  char text[64];
  const int n = snprintf(text, sizeof text, "{\"%s\":%d}", key, number);
  cag_exchange_answer(x, &(CagAnswer){.status = status, .bytes = text, .size = (size_t)n});
}

static void answer_version(CagExchange *x, int status, const char *version) {
  char text[96];
  const int n = snprintf(text, sizeof text, "{\"version\":\"%s\"}", version);
  cag_exchange_answer(x, &(CagAnswer){.status = status, .bytes = text, .size = (size_t)n});
}

static void answer_out_of_memory(CagExchange *x) {
  cag_exchange_fail(x, 500, "out of memory", NULL);
}

// --- The page's own files ---

static const char *type_of(const char *path) {
  static const char *const TYPES[][2] = {
      {".html", "text/html; charset=utf-8"}, {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},   {".svg", "image/svg+xml"},
      {".wasm", "application/wasm"},         {".txt", "text/plain; charset=utf-8"}};
  const char *dot = strrchr(path, '.');
  for (size_t i = 0; dot && i < sizeof TYPES / sizeof *TYPES; i++)
    if (!strcmp(dot, TYPES[i][0])) return TYPES[i][1];
  return "application/octet-stream";
}

static bool answer_page_file(CagExchange *x) {
  const char *path = cag_exchange_path(x);
  if (!strcmp(path, "/")) path = "/index.html";
  for (const CagPageFile *f = cag_page_files; f->path; f++) {
    if (strcmp(f->path, path) != 0) continue;
    cag_exchange_answer(x, &(CagAnswer){.status = 200,
                                        .type = type_of(path),
                                        .bytes = f->bytes,
                                        .size = f->size,
                                        .gzipped = true});
    return true;
  }
  return false;
}

// --- Runs ---

static void answer_run(View *v, CagExchange *x) {
  size_t size;
  CagLiveRequest q;
  const char *body = cag_exchange_body(x, &size);
  if (cag_live_request_read(body, size, &q))
    answer_number(x, 202, "run", cag_runner_run(v->runner, &q));
  else cag_exchange_fail(x, 400, "expected a JSON object", NULL);
}

static void answer_mesh(View *v, CagExchange *x, const char *id) {
  size_t size;
  unsigned char *bytes = cag_meshes_copy(v->meshes, id, &size);
  if (!bytes) {
    cag_exchange_fail(x, 404, "there is no such mesh", NULL);
    return;
  }
  cag_exchange_answer(x, &(CagAnswer){.status = 200,
                                      .type = "application/octet-stream",
                                      .bytes = bytes,
                                      .size = size,
                                      .lasting = true});
  free(bytes);
}

// --- Files ---

static void answer_text_file(CagExchange *x, const char *text, size_t size) {
  char version[CAG_VERSION_SIZE];
  cag_model_version(text, size, version);
  cag_exchange_answer(x, &(CagAnswer){.status = 200,
                                      .type = "text/plain; charset=utf-8",
                                      .bytes = text,
                                      .size = size,
                                      .etag = version});
}

// A file below the folder, or a module of the library ("std.robots").
static void answer_file(View *v, CagExchange *x, const char *path) {
  char *text;
  size_t size;
  const char *why, *library = cag_library_text(path, &size);
  if (library) {
    answer_text_file(x, library, size);
    return;
  }
  if (!v->options->file && !strcmp(path, v->name)) { // an empty script
    answer_text_file(x, "", 0);
    return;
  }
  if (!cag_model_read(v->folder, path, &text, &size, &why)) {
    cag_exchange_fail(x, 404, why, NULL);
    return;
  }
  answer_text_file(x, text, size);
  free(text);
}

// Whether the file still has the version that the page has changed.
static bool is_missing(const View *v, const char *path) {
  char *real = cag_model_path(v->folder, path);
  const bool missing = real && access(real, F_OK) != 0 && errno == ENOENT;
  free(real);
  return missing;
}

// Whether the file on the disk is the one that the page knows. A file that was deleted can be saved
// again: nothing is lost by it.
static bool is_version(const View *v, CagExchange *x, const char *path,
                       char now[CAG_VERSION_SIZE]) {
  char *text, quoted[CAG_VERSION_SIZE + 2];
  size_t size;
  const char *why, *expected = cag_exchange_header(x, "If-Match");
  if (cag_model_read(v->folder, path, &text, &size, &why)) {
    cag_model_version(text, size, now);
    free(text);
  } else {
    cag_model_version("", 0, now);
  }
  snprintf(quoted, sizeof quoted, "\"%s\"", now);
  return !expected || !strcmp(expected, quoted) || !strcmp(expected, "*") || is_missing(v, path);
}

static void save_file(View *v, CagExchange *x, const char *path) {
  char version[CAG_VERSION_SIZE];
  size_t size;
  const char *text = cag_exchange_body(x, &size);
  if (v->options->read_only || !v->options->file) {
    cag_exchange_fail(x, 403,
                      v->options->read_only ? "the page was opened with --read-only"
                                            : "this script has no file",
                      v->options->read_only ? NULL : "start cag view with the name of a file");
    return;
  }
  if (!is_version(v, x, path, version)) {
    answer_version(x, 412, version);
    return;
  }
  CagError err;
  if (!cag_model_write(v->folder, path, text, size, &err)) {
    cag_exchange_fail(x, 403, err.message, *err.help ? err.help : NULL);
    return;
  }
  cag_model_version(text, size, version);
  if (!strcmp(path, v->name)) memcpy(v->version, version, sizeof version);
  cag_runner_forget_text(v->runner, path);
  cag_runner_again(v->runner);
  answer_version(x, 200, version);
}

static void write_file_entry(const View *v, CagJson *j, const char *path) {
  char *text, version[CAG_VERSION_SIZE];
  size_t size;
  const char *why;
  if (!cag_model_read(v->folder, path, &text, &size, &why)) return;
  cag_model_version(text, size, version);
  free(text);
  cag_json_open(j, '{');
  cag_json_text(j, "path", path);
  cag_json_text(j, "version", version);
  cag_json_close(j, '}');
}

// The path below the folder, or NULL if it is elsewhere.
static const char *path_below(const View *v, const char *path) {
  const size_t n = strlen(v->folder);
  return !strncmp(path, v->folder, n) && path[n] == '/' ? path + n + 1 : NULL;
}

static void answer_files(View *v, CagExchange *x) {
  CagString s = {0};
  CagJson j = {.to = &s};
  cag_json_open(&j, '[');
  write_file_entry(v, &j, v->name);
  for (size_t i = 0; i < v->read_count; i++) {
    const char *below = path_below(v, v->read[i]);
    if (below && strcmp(below, v->name) != 0) write_file_entry(v, &j, below);
  }
  cag_json_close(&j, ']');
  answer_text(x, 200, &s);
  cag_string_free(&s);
}

static void params_path(const View *v, char out[PATH_MAX + 16]) {
  snprintf(out, PATH_MAX + 16, "%s.params.json", v->name);
}

static void answer_params(View *v, CagExchange *x, bool put) {
  char path[PATH_MAX + 16], *text;
  size_t size;
  const char *why, *body;
  CagError err;
  params_path(v, path);
  if (!put && !cag_model_read(v->folder, path, &text, &size, &why)) {
    cag_exchange_answer(x, &(CagAnswer){.status = 200, .bytes = "{}", .size = 2});
  } else if (!put) {
    cag_exchange_answer(x, &(CagAnswer){.status = 200, .bytes = text, .size = size});
    free(text);
  } else if (v->options->read_only || !v->options->file) {
    cag_exchange_fail(x, 403, "sets of params cannot be written here", NULL);
  } else {
    body = cag_exchange_body(x, &size);
    cJSON *json = cJSON_ParseWithLength(body, size);
    char *printed = cJSON_IsObject(json) ? cJSON_Print(json) : NULL;
    if (!printed) cag_exchange_fail(x, 400, "expected a JSON object", NULL);
    else if (!cag_model_write(v->folder, path, printed, strlen(printed), &err))
      cag_exchange_fail(x, 403, err.message, *err.help ? err.help : NULL);
    else cag_exchange_answer(x, &(CagAnswer){.status = 200, .bytes = "{}", .size = 2});
    free(printed);
    cJSON_Delete(json);
  }
}

// --- What needs the last session ---

// An exchange that is answered by the runner's thread.
typedef struct Errand {
  View *view;
  CagExchange *x;
  char *word; // format, the name of an image or part, or a whole request
} Errand;

static void free_errand(Errand *e) {
  free(e->word);
  free(e);
}

static void send_on_errand(View *v, CagExchange *x, const char *word, CagLiveTask *task) {
  Errand *e = calloc(1, sizeof *e);
  if (e) *e = (Errand){v, x, strdup(word)};
  if (e && e->word && cag_runner_do(v->runner, task, e)) return;
  if (e) free_errand(e);
  answer_out_of_memory(x);
}

// Sends what was made, and frees it.
static void send_answer(CagExchange *x, CagModelAnswer *a) {
  if (a->status != 200) cag_exchange_fail(x, a->status, a->error, a->help);
  else
    cag_exchange_answer(x, &(CagAnswer){.status = 200,
                                        .type = a->type,
                                        .bytes = a->bytes,
                                        .size = a->size,
                                        .file = *a->name ? a->name : NULL});
  free(a->bytes);
}

static void do_export(CagSession *s, void *context) {
  Errand *e = context;
  CagModelAnswer a = cag_answer_export(s, e->view->name, e->word);
  send_answer(e->x, &a);
  free_errand(e);
}

// The text of a field in the body, malloc'd, or NULL.
static char *body_text(const CagExchange *x, const char *field) {
  size_t size;
  const char *body = cag_exchange_body(x, &size);
  cJSON *json = cJSON_ParseWithLength(body, size);
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, field);
  char *text = cJSON_IsString(item) ? strdup(item->valuestring) : NULL;
  cJSON_Delete(json);
  return text;
}

static void answer_export(View *v, CagExchange *x) {
  char *format = body_text(x, "format");
  if (!format || !cag_export_format_story(format))
    cag_exchange_fail(x, 400, "expected a format of cag export", NULL);
  else send_on_errand(v, x, format, do_export);
  free(format);
}

static void do_image(CagSession *s, void *context) {
  Errand *e = context;
  CagModelAnswer a = cag_answer_image(s, e->word);
  send_answer(e->x, &a);
  free_errand(e);
}

static void do_measure(CagSession *s, void *context) {
  Errand *e = context;
  CagModelAnswer a = cag_answer_measure(s, e->view->name, e->word);
  send_answer(e->x, &a);
  free_errand(e);
}

static void answer_measure(View *v, CagExchange *x) {
  char *part = body_text(x, "part");
  if (part) send_on_errand(v, x, part, do_measure);
  else cag_exchange_fail(x, 400, "expected the name of a part", NULL);
  free(part);
}

// --- Questions about the last scene ---

static void do_ask(CagSession *s, void *context) {
  Errand *e = context;
  CagString answer = {0};
  size_t size;
  const char *request = cag_exchange_body(e->x, &size);
  const CagLiveMeshes meshes = cag_runner_meshes(e->view->runner);
  const int status = cag_live_ask(e->word, s, request, size, &meshes, &answer);
  answer_text(e->x, status, &answer);
  cag_string_free(&answer);
  free_errand(e);
}

// --- Pictures ---

static void answer_render(View *v, CagExchange *x) {
  size_t size;
  const char *body = cag_exchange_body(x, &size);
  CagLiveRequest last;
  if (!cag_runner_last(v->runner, &last)) {
    answer_out_of_memory(x);
    return;
  }
  const int job = cag_render_jobs_add(v->jobs, body, size, &last);
  if (job > 0) answer_number(x, 202, "job", job);
  else
    cag_exchange_fail(x, job < 0 ? 400 : 503,
                      job < 0 ? "expected a JSON object" : "too many pictures are under way", NULL);
}

static void answer_job(View *v, CagExchange *x, const char *number) {
  char *bytes;
  size_t size;
  const int job = atoi(number);
  if (!strcmp(cag_exchange_method(x), "DELETE")) {
    cag_render_jobs_cancel(v->jobs, job);
    cag_exchange_answer(x, &(CagAnswer){.status = 200, .bytes = "{}", .size = 2});
  } else if (cag_render_jobs_picture(v->jobs, job, &bytes, &size)) {
    cag_exchange_answer(
        x, &(CagAnswer){.status = 200, .type = "image/png", .bytes = bytes, .size = size});
    free(bytes);
  } else {
    cag_exchange_fail(x, 404, "there is no such picture", NULL);
  }
}

// --- Routes ---

static void *look_for_povray(void *context) {
  View *v = context;
  char version[256];
  v->povray = cag_find_povray(version, sizeof version) != NULL;
  return NULL;
}

static bool has_povray(View *v) {
  if (v->finding) pthread_join(v->finder, NULL);
  v->finding = false;
  return v->povray;
}

static void answer_hello(View *v, CagExchange *x) {
  CagString s = {0};
  const CagHello hello = {.file = v->name,
                          .folder = v->folder,
                          .engine = "server",
                          .read_only = v->options->read_only,
                          .untitled = !v->options->file,
                          .povray = has_povray(v)};
  cag_hello_write(&hello, &s);
  answer_text(x, 200, &s);
  cag_string_free(&s);
}

static const char *rest_after(const char *path, const char *start) {
  const size_t n = strlen(start);
  return strncmp(path, start, n) == 0 && path[n] ? path + n : NULL;
}

static bool is_request(CagExchange *x, const char *method, const char *path) {
  return !strcmp(cag_exchange_method(x), method) && !strcmp(cag_exchange_path(x), path);
}

static void route_open(View *v, CagExchange *x) {
  const char *path = cag_exchange_path(x), *rest, *file = cag_exchange_query(x, "path");
  const bool get = !strcmp(cag_exchange_method(x), "GET");
  if (get && answer_page_file(x)) return;
  if (is_request(x, "GET", "/api/hello")) answer_hello(v, x);
  else if (is_request(x, "GET", "/api/events")) cag_exchange_listen(x);
  else if (is_request(x, "POST", "/api/run")) answer_run(v, x);
  else if (get && (rest = rest_after(path, "/api/mesh/"))) answer_mesh(v, x, rest);
  else if (is_request(x, "GET", "/api/files")) answer_files(v, x);
  else if (is_request(x, "GET", "/api/file") && file) answer_file(v, x, file);
  else if (is_request(x, "PUT", "/api/file") && file) save_file(v, x, file);
  else if (is_request(x, "GET", "/api/params")) answer_params(v, x, false);
  else if (is_request(x, "PUT", "/api/params")) answer_params(v, x, true);
  else if (is_request(x, "POST", "/api/export")) answer_export(v, x);
  else if (get && (rest = rest_after(path, "/api/image/"))) send_on_errand(v, x, rest, do_image);
  else if (is_request(x, "POST", "/api/measure")) answer_measure(v, x);
  else if (is_request(x, "POST", "/api/lsp")) cag_lsp_pages_ask(v->editors, x);
  else if (is_request(x, "POST", "/api/render")) answer_render(v, x);
  else if ((rest = rest_after(path, "/api/job/"))) answer_job(v, x, rest);
  else if (!strcmp(cag_exchange_method(x), "POST") && (rest = rest_after(path, "/api/")) &&
           cag_live_is_question(rest))
    send_on_errand(v, x, rest, do_ask);
  else cag_exchange_fail(x, 404, "there is nothing here", NULL);
}

static void route(void *context, CagExchange *x) {
  View *v = context;
  pthread_mutex_lock(&v->gate);
  if (v->closing) cag_exchange_fail(x, 503, "the server is ending", NULL);
  else route_open(v, x);
  pthread_mutex_unlock(&v->gate);
}

// --- Files on disk ---

static void free_list(char **list, size_t n) {
  for (size_t i = 0; i < n; i++) free(list[i]);
  free(list);
}

// Notes which files a run has read. Called by the runner's thread.
static void note_files(void *context, CagSession *s) {
  View *v = context;
  size_t n = 0, kept = 0;
  while (cag_session_read_file(s, n)) n++;
  char **list = calloc(n + 1, sizeof *list);
  for (size_t i = 0; list && i < n; i++)
    if ((list[kept] = strdup(cag_session_read_file(s, i)))) kept++;
  pthread_mutex_lock(&v->gate);
  free_list(v->read, v->read_count);
  v->read = list;
  v->read_count = kept;
  v->read_changed = true;
  pthread_mutex_unlock(&v->gate);
}

// Watches the script and what it has read. Text that was given instead of a file is not among
// these.
static void watch_what_was_read(View *v) {
  char script[2 * PATH_MAX];
  pthread_mutex_lock(&v->gate);
  if (v->read_changed && v->options->file) {
    const char **paths = calloc(v->read_count + 1, sizeof *paths);
    snprintf(script, sizeof script, "%s/%s", v->folder, v->name);
    if (paths) {
      paths[0] = script;
      for (size_t i = 0; i < v->read_count; i++) paths[i + 1] = v->read[i];
      cag_file_watch_set(v->watch, paths, v->read_count + 1, v->began);
      v->began = cag_file_watch_now();
    }
    free(paths);
    v->read_changed = false;
  }
  pthread_mutex_unlock(&v->gate);
}

// Notes the version of the script's file. Returns whether it has changed.
static bool is_new_version(View *v) {
  char *text, version[CAG_VERSION_SIZE];
  size_t size;
  const char *why;
  if (!cag_model_read(v->folder, v->name, &text, &size, &why)) return false;
  cag_model_version(text, size, version);
  free(text);
  pthread_mutex_lock(&v->gate);
  const bool same = !strcmp(version, v->version);
  memcpy(v->version, version, sizeof version);
  pthread_mutex_unlock(&v->gate);
  return !same;
}

static void tell_change(View *v, const char *path, const char *below) {
  CagString s = {0};
  CagJson j = {.to = &s};
  char *text, version[CAG_VERSION_SIZE] = "";
  size_t size;
  const char *why;
  if (below && cag_model_read(v->folder, below, &text, &size, &why)) {
    cag_model_version(text, size, version);
    free(text);
  }
  cag_json_open(&j, '{');
  cag_json_text(&j, "path", below ? below : path);
  cag_json_text(&j, "version", version);
  cag_json_close(&j, '}');
  if (s.bytes) cag_server_publish(v->server, "file", s.bytes, false);
  cag_string_free(&s);
}

// Returns whether the change concerns the script: not if the page has saved it, or if it is the
// same.
static bool note_change(View *v, const char *path) {
  char real[PATH_MAX];
  // Imports are watched by the path that the script asked for as well, such as /a/./b.cag.
  if (realpath(path, real)) path = real;
  const char *below = path_below(v, path);
  if (below && !strcmp(below, v->name) && !is_new_version(v)) return false;
  tell_change(v, path, below);
  if (below) cag_runner_forget_text(v->runner, below);
  return true;
}

// Runs the script again if files have changed.
static void look_at_files(View *v) {
  const char *path;
  watch_what_was_read(v);
  if (!cag_file_watch_look(v->watch, NULL)) return;
  bool changed = false;
  for (size_t i = 0; (path = cag_file_watch_changed(v->watch, i)); i++)
    changed = note_change(v, path) || changed;
  if (changed) cag_runner_again(v->runner);
}

// --- The whole ---

static bool find_names(View *v, char *why, size_t size) {
  char real[PATH_MAX];
  struct stat kind;
  if (!v->options->file) {
    snprintf(v->name, sizeof v->name, UNTITLED);
    if (getcwd(v->folder, sizeof v->folder)) return true;
    snprintf(why, size, "the working folder is not there");
    return false;
  }
  if (!realpath(v->options->file, real) || access(real, R_OK) != 0) {
    snprintf(why, size, "cannot read %s", v->options->file);
    return false;
  }
  if (stat(real, &kind) == 0 && S_ISDIR(kind.st_mode)) {
    snprintf(why, size, "%s is a folder; name a script in it", v->options->file);
    return false;
  }
  char *slash = strrchr(real, '/');
  snprintf(v->name, sizeof v->name, "%s", slash + 1);
  if (slash == real) slash++;
  *slash = 0;
  snprintf(v->folder, sizeof v->folder, "%s", real);
  return true;
}

static bool start_parts(View *v) {
  const CagRunnerOptions runner = {.session = v->options->session,
                                   .has_file = v->options->file != NULL,
                                   .folder = v->folder,
                                   .name = v->name,
                                   .server = &v->server,
                                   .meshes = v->meshes = cag_meshes_new(MESH_MEMORY),
                                   .ran = note_files,
                                   .context = v};
  v->runner = v->meshes ? cag_runner_start(&runner) : NULL;
  v->jobs = v->runner ? cag_render_jobs_new(v->runner, &v->server) : NULL;
  CagSessionOptions checks = v->options->session;
  checks.folder = v->folder;
  v->editors = cag_lsp_pages_new(&checks, v->folder);
  v->watch = cag_file_watch_new(false);
  v->finding = pthread_create(&v->finder, NULL, look_for_povray, v) == 0;
  if (!v->finding) look_for_povray(v);
  return v->jobs && v->editors && v->watch;
}

// From the moment that the gate is closed, requests do not use the other parts.
static void stop_parts(View *v) {
  pthread_mutex_lock(&v->gate);
  v->closing = true;
  has_povray(v);
  pthread_mutex_unlock(&v->gate);
  if (v->jobs) cag_render_jobs_free(v->jobs);
  cag_lsp_pages_free(v->editors);
  if (v->runner) cag_runner_stop(v->runner);
  if (v->server) cag_server_stop(v->server);
  cag_meshes_free(v->meshes);
  cag_file_watch_free(v->watch);
  free_list(v->read, v->read_count);
}

static void tell_address(const View *v) {
  char address[128];
  snprintf(address, sizeof address, "http://localhost:%d/?t=%s", cag_server_port(v->server),
           cag_server_token(v->server));
  if (v->options->ready) v->options->ready(v->options->context, address);
}

static void start_first_run(View *v) {
  const CagViewOptions *o = v->options;
  CagLiveRequest q = {.coarse = 1, .defines = calloc(o->define_count + 1, sizeof *q.defines)};
  for (size_t i = 0; q.defines && i < o->define_count; i++) {
    CagLiveText *d = &q.defines[q.define_count++];
    *d = (CagLiveText){strdup(o->define_names[i]), strdup(o->define_values[i])};
    if (d->name && d->text) continue;
    cag_live_request_free(&q);
    return;
  }
  cag_runner_run(v->runner, &q);
}

static void serve(View *v) {
  pthread_mutex_lock(&v->gate);
  v->closing = false;
  pthread_mutex_unlock(&v->gate);
  is_new_version(v);
  v->began = cag_file_watch_now();
  start_first_run(v);
  tell_address(v);
  struct pollfd files = {.fd = cag_file_watch_descriptor(v->watch), .events = POLLIN};
  while (!(v->options->session.interrupt && *v->options->session.interrupt)) {
    poll(&files, files.fd >= 0, STOP_EVERY);
    look_at_files(v);
  }
}

int cag_view_serve(const CagViewOptions *options, char *why, size_t size) {
  View *v = calloc(1, sizeof *v);
  int status = CAG_STATUS_FILE;
  if (!v) {
    snprintf(why, size, "out of memory");
    return CAG_STATUS_LIMIT;
  }
  v->options = options;
  v->closing = true; // until all parts are there
  pthread_mutex_init(&v->gate, NULL);
  if (find_names(v, why, size)) {
    // The server starts first: what publishes events needs it.
    v->server = cag_server_start(&(CagServerOptions){options->port, route, v}, why, size);
    if (v->server && start_parts(v)) {
      serve(v);
      status = CAG_STATUS_INTERRUPTED;
    } else if (v->server) {
      snprintf(why, size, "out of memory");
      status = CAG_STATUS_LIMIT;
    }
  }
  stop_parts(v);
  pthread_mutex_destroy(&v->gate);
  free(v);
  return status;
}
