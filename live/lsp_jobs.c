// Runs of scripts after a save, and programs that commands start.
//
// A run has a session on a thread of its own, with limits of time and memory, and can be stopped at
// any time. Its results count only if the text has not changed since. Programs are copies of this
// one: `cag view`, `cag test`, and `cag render`.

#include "live/lsp_parts.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

// Limits of a run after a save.
#define RUN_SECONDS 10
#define RUN_MEMORY ((size_t)1 << 30)
// Longer output of a program is cut.
#define OUTPUT_MAX 65536

extern char **environ;

// --- The list ---

static void free_job(LspJob *j) {
  cJSON_Delete(j->result);
  cJSON_Delete(j->id);
  for (char **a = j->arguments; a && *a; a++) free(*a);
  free(j->arguments);
  free(j->file);
  free(j->output);
  free(j->picture);
  free(j);
}

static void finish(LspJob *j) {
  CagLsp *l = j->lsp;
  pthread_mutex_lock(&l->lock);
  j->done = true;
  pthread_mutex_unlock(&l->lock);
  if (l->options.wake) l->options.wake(l->options.context);
}

static bool start(LspJob *j, void *(*work)(void *job)) {
  CagLsp *l = j->lsp;
  pthread_mutex_lock(&l->lock);
  const bool started = pthread_create(&j->thread, NULL, work, j) == 0;
  if (started) {
    j->next = l->jobs;
    l->jobs = j;
  }
  pthread_mutex_unlock(&l->lock);
  if (!started) free_job(j);
  return started;
}

bool lsp_jobs_done(CagLsp *l) {
  bool any = false;
  pthread_mutex_lock(&l->lock);
  for (const LspJob *j = l->jobs; j; j = j->next) any |= j->done;
  pthread_mutex_unlock(&l->lock);
  return any;
}

// Removes a job that is done from the list, or NULL.
static LspJob *take_done(CagLsp *l) {
  LspJob *taken = NULL;
  pthread_mutex_lock(&l->lock);
  for (LspJob **at = &l->jobs; *at && !taken; at = taken ? at : &(*at)->next) {
    if (!(*at)->done) continue;
    taken = *at;
    *at = taken->next;
  }
  pthread_mutex_unlock(&l->lock);
  if (taken) pthread_join(taken->thread, NULL);
  return taken;
}

static void stop_program(LspJob *j) {
  if (j->pid > 0) kill(j->pid, SIGTERM);
}

void lsp_stop_run(CagLsp *l, const char *file) {
  pthread_mutex_lock(&l->lock);
  for (LspJob *j = l->jobs; j; j = j->next)
    if (j->kind == JOB_RUN && strcmp(j->file, file) == 0) j->interrupt = 1;
  pthread_mutex_unlock(&l->lock);
}

void lsp_end_jobs(CagLsp *l) {
  pthread_mutex_lock(&l->lock);
  LspJob *jobs = l->jobs;
  l->jobs = NULL;
  for (LspJob *j = jobs; j; j = j->next) {
    j->interrupt = 1;
    stop_program(j);
  }
  pthread_mutex_unlock(&l->lock);
  while (jobs) {
    LspJob *next = jobs->next;
    pthread_join(jobs->thread, NULL);
    free_job(jobs);
    jobs = next;
  }
}

// --- Runs ---

static cJSON *text_position(size_t line, size_t column) {
  cJSON *o = cJSON_CreateObject();
  cJSON_AddNumberToObject(o, "line", line ? (double)line - 1 : 0);
  cJSON_AddNumberToObject(o, "character", column ? (double)column - 1 : 0);
  return o;
}

static void add_place(cJSON *o, const char *file, size_t line, size_t column, size_t end_line,
                      size_t end_column) {
  cJSON *range = cJSON_AddObjectToObject(o, "range");
  if (file) cJSON_AddStringToObject(o, "file", file);
  cJSON_AddItemToObject(range, "start", text_position(line, column));
  cJSON_AddItemToObject(range, "end", text_position(end_line, end_column));
}

// Returns the diagnostics of a session. Columns count characters.
static cJSON *errors_of(CagSession *s) {
  cJSON *list = cJSON_CreateArray();
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    CagNoteView n;
    cag_session_error(s, i, &e);
    cJSON *o = cJSON_CreateObject(), *notes = cJSON_CreateArray();
    add_place(o, e.file, e.line, e.column, e.end_line, e.end_column);
    cJSON_AddStringToObject(o, "code", e.code);
    cJSON_AddStringToObject(o, "message", e.message ? e.message : "");
    if (e.help) cJSON_AddStringToObject(o, "help", e.help);
    cJSON_AddBoolToObject(o, "warning", e.warning);
    for (size_t k = 0; cag_session_error_note(s, i, k, &n); k++) {
      if (!n.file) continue;
      cJSON *note = cJSON_CreateObject();
      char text[256];
      snprintf(text, sizeof text, "%s%s%s", n.is_call ? "called from here" : "",
               n.is_call && *n.text ? " in " : "", n.text);
      add_place(note, n.file, n.line, n.column, n.end_line, n.end_column);
      cJSON_AddStringToObject(note, "message", text);
      cJSON_AddItemToArray(notes, note);
    }
    cJSON_AddItemToObject(o, "notes", notes);
    cJSON_AddItemToArray(list, o);
  }
  return list;
}

static void *run_script(void *job) {
  LspJob *j = job;
  CagSessionOptions o = j->lsp->options.session;
  FILE *sink = fopen("/dev/null", "w");
  o.out = o.messages = sink;
  o.interrupt = &j->interrupt;
  if (!(o.max_time > 0) || o.max_time > RUN_SECONDS) o.max_time = RUN_SECONDS;
  if (o.max_memory > RUN_MEMORY) o.max_memory = RUN_MEMORY;
  CagSession *s = sink ? cag_session_new(&o) : NULL;
  if (s) {
    CagShownCounts counts;
    const int status = cag_session_run_file(s, j->file);
    if (status == CAG_STATUS_OK && j->shows) cag_session_scene(s, &counts);
    j->result = errors_of(s);
  }
  cag_session_free(s);
  if (sink) fclose(sink);
  finish(j);
  return NULL;
}

void lsp_run_saved(CagLsp *l, LspDocument *d) {
  CagDocumentUse use;
  LspJob *j = calloc(1, sizeof *j);
  if (!j) return;
  lsp_stop_run(l, d->file);
  *j = (LspJob){.lsp = l, .kind = JOB_RUN, .file = lsp_copy(d->file)};
  j->shows = cag_document_use(l->workspace, d->file, &use) && use.shows;
  if (j->file) start(j, run_script);
  else free_job(j);
}

// Converts a range whose columns count characters to the columns of the client.
static cJSON *client_range(CagLsp *l, const char *file, const cJSON *range) {
  size_t ends[2] = {0, 0};
  const char *const keys[] = {"start", "end"};
  for (int i = 0; i < 2; i++) {
    const cJSON *p = lsp_get(range, keys[i]);
    ends[i] = cag_document_offset(l->workspace, file, (size_t)lsp_get(p, "line")->valuedouble,
                                  (size_t)lsp_get(p, "character")->valuedouble, CAG_COLUMNS_UTF32);
  }
  return lsp_range_json(l, &(CagPlace){file, ends[0], ends[1]});
}

static cJSON *client_diagnostic(CagLsp *l, const char *file, const cJSON *found) {
  cJSON *o = cJSON_CreateObject(), *related = cJSON_CreateArray();
  const cJSON *note;
  const char *help = lsp_text(found, "help");
  char message[2048];
  snprintf(message, sizeof message, "%s%s%s", lsp_text(found, "message"), help ? "\nhelp: " : "",
           help ? help : "");
  cJSON_AddItemToObject(o, "range", client_range(l, file, lsp_get(found, "range")));
  cJSON_AddNumberToObject(o, "severity", lsp_is_true(found, "warning") ? 2 : 1);
  cJSON_AddStringToObject(o, "code", lsp_text(found, "code"));
  cJSON_AddStringToObject(o, "source", "cag run");
  cJSON_AddStringToObject(o, "message", message);
  cJSON_ArrayForEach(note, lsp_get(found, "notes")) {
    const char *other = lsp_text(note, "file");
    char *uri = lsp_uri_of_file(l, other);
    if (!uri) continue;
    cJSON *item = cJSON_CreateObject(), *location = cJSON_AddObjectToObject(item, "location");
    cJSON_AddStringToObject(location, "uri", uri);
    cJSON_AddItemToObject(location, "range", client_range(l, other, lsp_get(note, "range")));
    cJSON_AddStringToObject(item, "message", lsp_text(note, "message"));
    cJSON_AddItemToArray(related, item);
    free(uri);
  }
  if (cJSON_GetArraySize(related)) cJSON_AddItemToObject(o, "relatedInformation", related);
  else cJSON_Delete(related);
  return o;
}

static void report_run(CagLsp *l, LspJob *j) {
  cJSON *files = cJSON_CreateObject();
  const cJSON *found;
  if (j->interrupt) { // its text has changed
    cJSON_Delete(files);
    return;
  }
  cJSON_ArrayForEach(found, j->result) {
    const char *file = lsp_text(found, "file");
    if (!file || file[0] == '<') file = j->file;
    cJSON *list = cJSON_GetObjectItemCaseSensitive(files, file);
    if (!list) list = cJSON_AddArrayToObject(files, file);
    cJSON_AddItemToArray(list, client_diagnostic(l, file, found));
  }
  lsp_publish_run(l, j->file, files);
}

// --- Commands ---

static void read_output(LspJob *j, int fd) {
  size_t length = 0;
  j->output = calloc(1, OUTPUT_MAX + 1);
  for (;;) {
    char scrap[4096];
    const bool room = j->output && length < OUTPUT_MAX;
    const ssize_t n =
        read(fd, room ? j->output + length : scrap, room ? OUTPUT_MAX - length : sizeof scrap);
    if (n <= 0) break;
    if (room) length += (size_t)n;
  }
}

// Starts the program, with its output to a pipe. Returns false if that fails.
static bool spawn(LspJob *j, int *output) {
  int ends[2];
  pid_t pid;
  posix_spawn_file_actions_t actions;
  if (pipe2(ends, O_CLOEXEC) != 0) return false;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  pthread_mutex_lock(&j->lsp->lock);
  const bool good = !j->interrupt && posix_spawn(&pid, j->lsp->options.program, &actions, NULL,
                                                 j->arguments, environ) == 0;
  if (good) j->pid = pid;
  pthread_mutex_unlock(&j->lsp->lock);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  *output = ends[0];
  if (!good) close(ends[0]);
  return good;
}

static void *run_program(void *job) {
  LspJob *j = job;
  int output, status = 0;
  j->status = CAG_STATUS_FILE;
  if (spawn(j, &output)) {
    read_output(j, output);
    close(output);
    const pid_t pid = j->pid;
    siginfo_t ended;
    // The number stays valid until it is no longer used to stop the program.
    while (waitid(P_PID, (id_t)pid, &ended, WEXITED | WNOWAIT) != 0 && !j->done) {}
    pthread_mutex_lock(&j->lsp->lock);
    j->pid = 0;
    pthread_mutex_unlock(&j->lsp->lock);
    waitpid(pid, &status, 0);
    j->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  finish(j);
  return NULL;
}

static void show_message(CagLsp *l, int type, const char *text) {
  cJSON *o = cJSON_CreateObject();
  cJSON_AddNumberToObject(o, "type", type);
  cJSON_AddStringToObject(o, "message", text);
  lsp_notify(l, "window/showMessage", o);
}

// Replaces bytes that are not ASCII, because output may be cut within a character.
static void clean(char *text) {
  for (; text && *text; text++)
    if ((unsigned char)*text >= 0x80) *text = '?';
}

static void report_command(CagLsp *l, LspJob *j) {
  clean(j->output);
  if (j->status != 0 && j->id) {
    char text[1024];
    snprintf(text, sizeof text, "cag %s: %.900s", j->arguments[1], j->output ? j->output : "");
    show_message(l, 1, text);
  } else if (j->picture && l->client.show_document) {
    char *uri = lsp_uri_of_file(l, j->picture);
    cJSON *o = cJSON_CreateObject();
    cJSON_AddStringToObject(o, "uri", uri ? uri : "");
    cJSON_AddTrueToObject(o, "external");
    lsp_request(l, "window/showDocument", o);
    free(uri);
  }
  if (!j->id) return;
  cJSON *result = cJSON_CreateObject();
  cJSON_AddNumberToObject(result, "status", j->status);
  cJSON_AddStringToObject(result, "output", j->output ? j->output : "");
  if (j->picture) cJSON_AddStringToObject(result, "picture", j->picture);
  lsp_answer(l, j->id, result);
}

void lsp_finish_jobs(CagLsp *l) {
  LspJob *j;
  while ((j = take_done(l))) {
    if (j->kind == JOB_RUN) report_run(l, j);
    else report_command(l, j);
    free_job(j);
  }
}

static char *picture_of(const char *file) {
  const size_t n = strlen(file), stem = n > 4 && !strcmp(file + n - 4, ".cag") ? n - 4 : n;
  char *out = malloc(stem + 5);
  if (out) sprintf(out, "%.*s.png", (int)stem, file);
  return out;
}

// Sets the arguments of the program: `cag NAME FILE`, and `-o PICTURE` for a picture.
static bool set_arguments(LspJob *j, const char *name) {
  const char *words[8] = {"cag", name, j->file};
  size_t n = 3;
  if (j->picture) {
    words[n++] = "-o";
    words[n++] = j->picture;
  }
  j->arguments = calloc(n + 1, sizeof *j->arguments);
  for (size_t i = 0; j->arguments && i < n; i++)
    if (!(j->arguments[i] = lsp_copy(words[i]))) return false;
  return j->arguments != NULL;
}

void lsp_execute(CagLsp *l, const cJSON *id, const cJSON *params) {
  const char *command = lsp_text(params, "command");
  const cJSON *argument = cJSON_GetArrayItem(lsp_get(params, "arguments"), 0);
  const bool preview = command && strcmp(command, "cag.preview") == 0,
             render = command && strcmp(command, "cag.render") == 0,
             test = command && strcmp(command, "cag.runTest") == 0;
  if (!l->options.program || !(preview || render || test)) {
    lsp_fail(l, id, LSP_INVALID_PARAMS, "unknown command");
    return;
  }
  char *file = cJSON_IsString(argument) ? lsp_file_of_uri(l, argument->valuestring) : NULL;
  LspJob *j = file && strchr(file, '/') ? calloc(1, sizeof *j) : NULL;
  if (!j) {
    free(file);
    lsp_fail(l, id, LSP_INVALID_PARAMS, "expected the URI of a file");
    return;
  }
  *j = (LspJob){.lsp = l, .kind = JOB_COMMAND, .file = file};
  if (render) j->picture = picture_of(file);
  if (!preview) j->id = cJSON_Duplicate(id, true); // it is answered when the program ends
  if (!set_arguments(j, preview ? "view" : render ? "render" : "test")) {
    free_job(j);
    lsp_fail(l, id, LSP_INTERNAL_ERROR, "not enough memory");
  } else if (!start(j, run_program)) {
    lsp_fail(l, id, LSP_INTERNAL_ERROR, "cannot start a thread");
  } else if (preview) {
    lsp_answer(l, id, NULL);
  }
}
