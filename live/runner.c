#include "live/runner.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/model_run.h"

typedef struct Task {
  CagLiveTask *work;
  void *context;
  struct Task *next;
} Task;

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
  CagModelRun good;
};

// --- What a run needs and publishes ---

static bool has_mesh(void *context, const char *id) { return cag_meshes_has(context, id); }

static bool keep_mesh(void *context, const CagMeshView *m) {
  unsigned char *bytes;
  size_t size;
  return cag_live_mesh_bytes(m, &bytes, &size) && cag_meshes_keep(context, m->id, bytes, size);
}

CagLiveMeshes cag_runner_meshes(const CagRunner *r) {
  return (CagLiveMeshes){has_mesh, keep_mesh, r->options.meshes};
}

static void publish(void *context, const char *event, const char *json) {
  const CagRunner *r = context;
  cag_server_publish(*r->options.server, event, json, true);
}

static void begin_scene(void *context) {
  const CagRunner *r = context;
  cag_meshes_begin_scene(r->options.meshes);
}

static void note_run(void *context, CagSession *s) {
  const CagRunner *r = context;
  if (r->options.ran) r->options.ran(r->options.context, s);
}

static CagModel runner_model(const CagRunner *r) {
  const CagRunnerOptions *o = &r->options;
  return (CagModel){.session = o->session,
                    .has_file = o->has_file,
                    .folder = o->folder,
                    .name = o->name,
                    .meshes = {has_mesh, keep_mesh, o->meshes},
                    .publish = publish,
                    .begin_scene = begin_scene,
                    .ran = note_run,
                    .context = (void *)r};
}

CagSession *cag_runner_session(const CagRunner *r, const CagLiveRequest *request,
                               const volatile int *interrupt, FILE *out, int *status) {
  const CagModel model = runner_model(r);
  return cag_model_session(&model, request, interrupt, out, status);
}

// --- The thread ---

static void work_on_run(CagRunner *r) {
  const CagModel model = runner_model(r);
  CagLiveRequest request = r->pending;
  const int number = r->number;
  r->pending = (CagLiveRequest){0};
  r->is_pending = false;
  r->running = true;
  r->interrupt = 0;
  CagLiveRequest kept;
  if (cag_live_request_copy(&request, &kept)) {
    cag_live_request_free(&r->last);
    r->last = kept;
    r->has_last = true;
  }
  pthread_mutex_unlock(&r->mutex);
  cag_model_run(&model, &request, number, &r->interrupt, &r->good);
  cag_live_request_free(&request);
  pthread_mutex_lock(&r->mutex);
  r->running = false;
}

typedef struct Asked {
  CagSession *session;
  const Task *task;
} Asked;

static void answer_task(void *context) {
  const Asked *a = context;
  a->task->work(a->session, a->task->context);
}

static void work_on_task(CagRunner *r) {
  Task *t = r->tasks;
  r->tasks = t->next;
  if (!r->tasks) r->tasks_end = &r->tasks;
  r->interrupt = 0;
  pthread_mutex_unlock(&r->mutex);
  Asked asked = {r->good.session, t};
  if (asked.session) cag_session_together(asked.session, answer_task, &asked);
  else answer_task(&asked);
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
  cag_model_run_free(&r->good);
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

void cag_runner_forget_text(CagRunner *r, const char *path) {
  pthread_mutex_lock(&r->mutex);
  cag_live_request_drop_text(&r->last, path);
  pthread_mutex_unlock(&r->mutex);
}

void cag_runner_again(CagRunner *r) {
  CagLiveRequest again = {.coarse = 1};
  pthread_mutex_lock(&r->mutex);
  if (!r->is_pending && r->has_last && !cag_live_request_copy(&r->last, &again))
    again = (CagLiveRequest){.coarse = 1};
  if (!r->is_pending) {
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
  const bool ok = cag_live_request_copy(r->has_last ? &r->last : &none, out);
  pthread_mutex_unlock(&r->mutex);
  return ok;
}
