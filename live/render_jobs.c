#include "live/render_jobs.h"

#include <cJSON.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "live/json_write.h"
#include "live/model_files.h"

enum { JOBS = 8, SIDE_MOST = 8192 };

typedef struct Job {
  CagRenderJobs *jobs;
  int number; // 0: the slot is free
  pthread_t thread;
  bool started;
  atomic_bool done;
  volatile int stop;
  CagLiveRequest request;
  char engine[16], quality[16], camera[128];
  int width, height;
  bool has_view;
  CagCameraView view;
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

// --- Requests ---

static void read_word(const cJSON *json, const char *name, char *out, size_t size) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, name);
  snprintf(out, size, "%s", cJSON_IsString(item) ? item->valuestring : "");
}

static int read_side(const cJSON *json, const char *name, int usual) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, name);
  const double x = cJSON_IsNumber(item) ? item->valuedouble : usual;
  return x >= 1 && x <= SIDE_MOST ? (int)x : usual;
}

static bool read_point(const cJSON *json, const char *name, double out[3]) {
  const cJSON *list = cJSON_GetObjectItemCaseSensitive(json, name);
  if (cJSON_GetArraySize(list) != 3) return false;
  for (int i = 0; i < 3; i++) {
    const cJSON *x = cJSON_GetArrayItem(list, i);
    if (!cJSON_IsNumber(x)) return false;
    out[i] = x->valuedouble;
  }
  return true;
}

static void read_view(const cJSON *json, Job *j) {
  const cJSON *fov = cJSON_GetObjectItemCaseSensitive(json, "fov"),
              *width = cJSON_GetObjectItemCaseSensitive(json, "width");
  CagCameraView *v = &j->view;
  *v = (CagCameraView){.name = "page",
                       .orthographic = !cJSON_IsNumber(fov),
                       .fov = cJSON_IsNumber(fov) ? fov->valuedouble : 0,
                       .width = cJSON_IsNumber(width) ? width->valuedouble : 100,
                       .size = {j->width, j->height}};
  j->has_view = read_point(json, "eye", v->eye) && read_point(json, "target", v->target) &&
                read_point(json, "up", v->up);
}

static bool read_job(const char *body, size_t size, Job *j) {
  cJSON *json = cJSON_ParseWithLength(body, size);
  const cJSON *camera = cJSON_GetObjectItemCaseSensitive(json, "camera");
  const bool ok = cJSON_IsObject(json);
  read_word(json, "engine", j->engine, sizeof j->engine);
  read_word(json, "quality", j->quality, sizeof j->quality);
  j->width = read_side(json, "width", 960);
  j->height = read_side(json, "height", 540);
  if (cJSON_IsObject(camera)) read_view(camera, j);
  else read_word(json, "camera", j->camera, sizeof j->camera);
  cJSON_Delete(json);
  return ok;
}

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

static int render_to(Job *j, CagSession *s, const char *path) {
  CagRenderOptions o;
  cag_render_options_init(&o);
  if (*j->engine) o.engine = j->engine;
  if (*j->quality) o.quality = j->quality;
  if (*j->camera) o.camera = j->camera;
  if (j->has_view) o.view = &j->view;
  o.width = j->width;
  o.height = j->height;
  o.progress = note_progress;
  o.progress_context = j;
  return cag_session_render(s, &o, path);
}

static void tell_failure(Job *j, CagSession *s) {
  CagErrorView e = {0};
  if (cag_session_error_count(s) > 0) cag_session_error(s, cag_session_error_count(s) - 1, &e);
  j->done = true;
  publish_progress(j, 100, "rendering", e.message ? e.message : "the picture failed");
}

static void render(Job *j, FILE *out) {
  char folder[] = "/tmp/cag-view-XXXXXX", path[64], *bytes;
  size_t size;
  const char *why;
  int status = CAG_STATUS_LIMIT;
  CagSession *s = cag_runner_session(j->jobs->runner, &j->request, &j->stop, out, &status);
  if (!s) return;
  if (status == CAG_STATUS_OK && mkdtemp(folder)) {
    snprintf(path, sizeof path, "%s/picture.png", folder);
    status = render_to(j, s, path);
    if (status == CAG_STATUS_OK && cag_model_read(folder, "picture.png", &bytes, &size, &why)) {
      pthread_mutex_lock(&j->jobs->mutex);
      j->picture = bytes;
      j->size = size;
      j->done = true;
      pthread_mutex_unlock(&j->jobs->mutex);
      publish_progress(j, 100, "rendering", NULL);
    }
    unlink(path);
    rmdir(folder);
  }
  if (!j->done) tell_failure(j, s);
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
  if (!j || !read_job(body, size, j)) {
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
