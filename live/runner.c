#include "live/runner.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "live/model_files.h"

typedef struct Task {
  CagLiveTask *work;
  void *context;
  struct Task *next;
} Task;

// What a session prints, which lives as long as the session.
typedef struct Prints {
  FILE *file;
  char *text;
  size_t length;
} Prints;

struct CagRunner {
  CagRunnerOptions options;
  pthread_t thread;
  pthread_mutex_t mutex; // of what follows
  pthread_cond_t woken;
  CagLiveRequest pending, last; // the run that waits, and the one that was begun last
  bool is_pending, has_last, running, stopping;
  int number;             // of the last request
  volatile int interrupt; // of the run under way
  Task *tasks, **tasks_end;
  // Of the last good run; used by the runner's thread alone.
  CagSession *session;
  Prints *prints;
};

// --- Requests ---

void cag_live_request_free(CagLiveRequest *r) {
  for (size_t i = 0; i < r->define_count; i++) {
    free(r->defines[i].name);
    free(r->defines[i].value);
  }
  free(r->defines);
  free(r->text);
  *r = (CagLiveRequest){0};
}

static bool copy_request(const CagLiveRequest *from, CagLiveRequest *to) {
  *to = *from;
  to->text = from->text ? strdup(from->text) : NULL;
  to->defines = calloc(from->define_count + 1, sizeof *to->defines);
  bool ok = to->defines && (to->text || !from->text);
  for (size_t i = 0; ok && i < from->define_count; i++) {
    to->defines[i].name = strdup(from->defines[i].name);
    to->defines[i].value = strdup(from->defines[i].value);
    ok = to->defines[i].name && to->defines[i].value;
  }
  if (!to->defines) to->define_count = 0;
  if (!ok) cag_live_request_free(to);
  return ok;
}

// --- Runs ---

static void define_all(CagSession *s, const CagLiveRequest *q) {
  char time[40];
  for (size_t i = 0; i < q->define_count; i++)
    cag_session_define(s, q->defines[i].name, q->defines[i].value);
  cag_session_set_loop(s, q->loop);
  if (!q->has_time) return;
  const double steps = q->frames > 1 ? q->frames - (q->loop ? 0 : 1) : 0;
  cag_session_set_frame(s, q->time * steps, q->frames > 1 ? q->frames : 1);
  snprintf(time, sizeof time, "%.17g", q->time);
  cag_session_define(s, "time", time);
}

CagSession *cag_runner_session(const CagRunner *r, const CagLiveRequest *request,
                               const volatile int *interrupt, FILE *out, int *status) {
  CagSessionOptions o = r->options.session;
  o.interrupt = interrupt;
  o.out = o.messages = out;
  o.folder = r->options.folder;
  CagSession *s = cag_session_new(&o);
  if (!s) return NULL;
  define_all(s, request);
  char *read = NULL;
  const char *text = request->text ? request->text : "", *why;
  size_t size = strlen(text);
  // The script is run as a text, so that locations have paths below the folder.
  if (!request->text && r->options.has_file &&
      cag_model_read(r->options.folder, r->options.name, &read, &size, &why))
    text = read;
  *status = cag_session_run_text(s, r->options.name, text, size);
  free(read);
  return s;
}

static bool has_mesh(void *context, const char *id) { return cag_meshes_has(context, id); }

static bool keep_mesh(void *context, const CagMeshView *m) {
  unsigned char *bytes;
  size_t size;
  return cag_live_mesh_bytes(m, &bytes, &size) && cag_meshes_keep(context, m->id, bytes, size);
}

CagLiveMeshes cag_runner_meshes(const CagRunner *r) {
  return (CagLiveMeshes){has_mesh, keep_mesh, r->options.meshes};
}

static void publish_state(const CagRunner *r, int run, bool running) {
  char text[64];
  snprintf(text, sizeof text, "{\"run\":%d,\"running\":%s}", run, running ? "true" : "false");
  cag_server_publish(*r->options.server, "state", text, true);
}

static void drop_session(CagSession *s, Prints *p) {
  cag_session_free(s);
  if (p && p->file) fclose(p->file);
  if (p) free(p->text);
  free(p);
}

static void publish_messages(const CagRunner *r, const CagSession *s, const CagLiveRun *told) {
  CagString messages = {0};
  cag_live_messages(s, told, &messages);
  if (messages.bytes && !messages.failed)
    cag_server_publish(*r->options.server, "messages", messages.bytes, true);
  cag_string_free(&messages);
}

static void run(CagRunner *r, const CagLiveRequest *request, int number) {
  Prints *prints = calloc(1, sizeof *prints); // its addresses are in use until it is closed
  CagString scene = {0};
  CagLiveRun told = {.run = number, .status = CAG_STATUS_LIMIT};
  const CagLiveMeshes meshes = cag_runner_meshes(r);
  const double begin = cag_clock_seconds();
  publish_state(r, number, true);
  if (prints) prints->file = open_memstream(&prints->text, &prints->length);
  CagSession *s = prints && prints->file
                      ? cag_runner_session(r, request, &r->interrupt, prints->file, &told.status)
                      : NULL;
  cag_meshes_begin_scene(r->options.meshes);
  if (s && told.status == CAG_STATUS_OK)
    told.status = cag_live_scene(
        s, &(CagLiveModel){number, r->options.name, r->options.folder, request->coarse}, &meshes,
        &scene);
  told.seconds = cag_clock_seconds() - begin;
  if (s) {
    fflush(prints->file);
    told.prints = prints->text;
    if (r->options.ran) r->options.ran(r->options.context, s);
    if (told.status != CAG_STATUS_INTERRUPTED) publish_messages(r, s, &told);
  }
  const bool good = s && told.status == CAG_STATUS_OK && scene.bytes;
  if (good) cag_server_publish(*r->options.server, "scene", scene.bytes, true);
  publish_state(r, number, false);
  cag_string_free(&scene);
  if (good) {
    drop_session(r->session, r->prints);
    r->session = s;
    r->prints = prints;
  } else {
    drop_session(s, prints);
  }
}

// --- The thread ---

static void work_on_run(CagRunner *r) {
  CagLiveRequest request = r->pending;
  const int number = r->number;
  r->pending = (CagLiveRequest){0};
  r->is_pending = false;
  r->running = true;
  r->interrupt = 0;
  CagLiveRequest kept;
  if (copy_request(&request, &kept)) {
    cag_live_request_free(&r->last);
    r->last = kept;
    r->has_last = true;
  }
  pthread_mutex_unlock(&r->mutex);
  run(r, &request, number);
  cag_live_request_free(&request);
  pthread_mutex_lock(&r->mutex);
  r->running = false;
}

static void work_on_task(CagRunner *r) {
  Task *t = r->tasks;
  r->tasks = t->next;
  if (!r->tasks) r->tasks_end = &r->tasks;
  r->interrupt = 0;
  pthread_mutex_unlock(&r->mutex);
  t->work(r->session, t->context);
  free(t);
  pthread_mutex_lock(&r->mutex);
}

// Tasks that were begun are finished in any case, since someone waits for their answers.
static void *work(void *context) {
  CagRunner *r = context;
  pthread_mutex_lock(&r->mutex);
  for (;;) {
    if (r->tasks) work_on_task(r);
    else if (r->stopping) break;
    else if (r->is_pending) work_on_run(r);
    else pthread_cond_wait(&r->woken, &r->mutex);
  }
  pthread_mutex_unlock(&r->mutex);
  return NULL;
}

CagRunner *cag_runner_start(const CagRunnerOptions *options) {
  CagRunner *r = calloc(1, sizeof *r);
  if (!r) return NULL;
  r->options = *options;
  r->tasks_end = &r->tasks;
  pthread_mutex_init(&r->mutex, NULL);
  pthread_cond_init(&r->woken, NULL);
  if (pthread_create(&r->thread, NULL, work, r) == 0) return r;
  pthread_cond_destroy(&r->woken);
  pthread_mutex_destroy(&r->mutex);
  free(r);
  return NULL;
}

void cag_runner_stop(CagRunner *r) {
  pthread_mutex_lock(&r->mutex);
  r->stopping = true;
  r->interrupt = 1;
  pthread_cond_signal(&r->woken);
  pthread_mutex_unlock(&r->mutex);
  pthread_join(r->thread, NULL);
  cag_live_request_free(&r->pending);
  cag_live_request_free(&r->last);
  drop_session(r->session, r->prints);
  pthread_cond_destroy(&r->woken);
  pthread_mutex_destroy(&r->mutex);
  free(r);
}

static int start_pending(CagRunner *r, CagLiveRequest *request) {
  cag_live_request_free(&r->pending);
  r->pending = *request;
  r->is_pending = true;
  if (r->running) r->interrupt = 1;
  pthread_cond_signal(&r->woken);
  return ++r->number;
}

int cag_runner_run(CagRunner *r, CagLiveRequest *request) {
  pthread_mutex_lock(&r->mutex);
  const int number = start_pending(r, request);
  pthread_mutex_unlock(&r->mutex);
  *request = (CagLiveRequest){0};
  return number;
}

void cag_runner_again(CagRunner *r, bool keep_text) {
  CagLiveRequest again = {.coarse = 1};
  pthread_mutex_lock(&r->mutex);
  if (!r->is_pending && r->has_last && !copy_request(&r->last, &again))
    again = (CagLiveRequest){.coarse = 1};
  if (!r->is_pending) {
    if (!keep_text) {
      free(again.text);
      again.text = NULL;
    }
    again.coarse = 1;
    start_pending(r, &again);
  }
  pthread_mutex_unlock(&r->mutex);
}

bool cag_runner_do(CagRunner *r, CagLiveTask *task, void *context) {
  Task *t = malloc(sizeof *t);
  if (!t) return false;
  *t = (Task){task, context, NULL};
  pthread_mutex_lock(&r->mutex);
  *r->tasks_end = t;
  r->tasks_end = &t->next;
  pthread_cond_signal(&r->woken);
  pthread_mutex_unlock(&r->mutex);
  return true;
}

bool cag_runner_last(CagRunner *r, CagLiveRequest *out) {
  pthread_mutex_lock(&r->mutex);
  const CagLiveRequest none = {.coarse = 1};
  const bool ok = copy_request(r->has_last ? &r->last : &none, out);
  pthread_mutex_unlock(&r->mutex);
  return ok;
}
