#include "live/render_jobs.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "live/json_write.h"
#include "live/model_answers.h"

enum { JOBS = 8 };

typedef struct Job {
  CagRenderJobs *jobs;
  int number; // 0: the slot is free
  pthread_t thread;
  bool started;
  atomic_bool done;
  volatile int stop;
  CagLiveRequest request;
  CagPictureRequest picture_request;
  char *picture;
  size_t size;
} Job;

struct CagRenderJobs {
  const CagRunner *runner;
  CagServer *const *server;
  pthread_mutex_t mutex; // of the jobs' fields that change
  Job items[JOBS];
  int last;
};

// --- Rendering ---

static void publish_progress(const Job *j, double percent, const char *phase, const char *error) {
  CagString s = {0};
  CagJson json = {.to = &s};
  cag_json_open(&json, '{');
  cag_json_number(&json, "job", j->number);
  cag_json_number(&json, "percent", percent);
  cag_json_text(&json, "phase", phase);
  cag_json_bool(&json, "done", j->done);
  cag_json_text(&json, "error", error);
  cag_json_close(&json, '}');
  if (s.bytes && !s.failed) cag_server_publish(*j->jobs->server, "progress", s.bytes, false);
  cag_string_free(&s);
}

static void note_progress(void *context, double percent, const char *phase) {
  publish_progress(context, percent, phase, NULL);
}

static void render(Job *j, FILE *out) {
  int status = CAG_STATUS_LIMIT;
  CagSession *s = cag_runner_session(j->jobs->runner, &j->request, &j->stop, out, &status);
  if (!s) return;
  CagModelAnswer answer = {.error = "the script failed"};
  CagErrorView e = {0};
  if (status == CAG_STATUS_OK)
    answer = cag_answer_picture(s, &j->picture_request, note_progress, j);
  else if (cag_session_error_count(s) > 0) {
    cag_session_error(s, cag_session_error_count(s) - 1, &e);
    answer.error = e.message;
  }
  pthread_mutex_lock(&j->jobs->mutex);
  j->picture = answer.bytes;
  j->size = answer.size;
  j->done = true;
  pthread_mutex_unlock(&j->jobs->mutex);
  publish_progress(j, 100, "rendering", answer.bytes ? NULL : answer.error);
  cag_session_free(s);
}

static void *work(void *context) {
  Job *j = context;
  FILE *out = fopen("/dev/null", "w");
  if (out) {
    render(j, out);
    fclose(out);
  }
  j->done = true;
  return NULL;
}

// --- Jobs ---

CagRenderJobs *cag_render_jobs_new(const CagRunner *runner, CagServer *const *server) {
  CagRenderJobs *jobs = calloc(1, sizeof *jobs);
  if (!jobs) return NULL;
  jobs->runner = runner;
  jobs->server = server;
  pthread_mutex_init(&jobs->mutex, NULL);
  return jobs;
}

static void end_job(Job *j) {
  if (j->started) pthread_join(j->thread, NULL);
  cag_live_request_free(&j->request);
  free(j->picture);
  *j = (Job){0};
}

void cag_render_jobs_free(CagRenderJobs *jobs) {
  for (int i = 0; i < JOBS; i++) jobs->items[i].stop = 1;
  for (int i = 0; i < JOBS; i++) end_job(&jobs->items[i]);
  pthread_mutex_destroy(&jobs->mutex);
  free(jobs);
}

static Job *find_job(CagRenderJobs *jobs, int number) {
  for (int i = 0; number > 0 && i < JOBS; i++)
    if (jobs->items[i].number == number) return &jobs->items[i];
  return NULL;
}

// A free slot, or that of the oldest picture that is done.
static Job *free_slot(CagRenderJobs *jobs) {
  Job *oldest = NULL;
  for (int i = 0; i < JOBS; i++) {
    Job *j = &jobs->items[i];
    if (j->number == 0) return j;
    if (j->done && (!oldest || j->number < oldest->number)) oldest = j;
  }
  if (oldest) end_job(oldest);
  return oldest;
}

int cag_render_jobs_add(CagRenderJobs *jobs, const char *body, size_t size,
                        CagLiveRequest *request) {
  Job *j = free_slot(jobs);
  if (j) *j = (Job){.jobs = jobs};
  if (!j || !cag_picture_request_read(body, size, &j->picture_request)) {
    cag_live_request_free(request);
    return j ? -1 : 0;
  }
  j->request = *request;
  j->number = ++jobs->last;
  j->started = pthread_create(&j->thread, NULL, work, j) == 0;
  if (j->started) return j->number;
  end_job(j);
  return 0;
}

void cag_render_jobs_cancel(CagRenderJobs *jobs, int number) {
  Job *j = find_job(jobs, number);
  if (j) j->stop = 1;
}

bool cag_render_jobs_picture(CagRenderJobs *jobs, int number, char **bytes, size_t *size) {
  pthread_mutex_lock(&jobs->mutex);
  const Job *j = find_job(jobs, number);
  *bytes = j && j->done && j->picture ? malloc(j->size + 1) : NULL;
  if (*bytes) {
    *size = j->size;
    memcpy(*bytes, j->picture, j->size);
  }
  pthread_mutex_unlock(&jobs->mutex);
  return *bytes != NULL;
}
