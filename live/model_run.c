#include "live/model_run.h"

#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "live/model_files.h"

// What a session prints, which lives as long as the session.
typedef struct CagModelPrints {
  FILE *file;
  char *text;
  size_t length;
} Prints;

static void define_all(CagSession *s, const CagLiveRequest *q) {
  char time[40];
  for (size_t i = 0; i < q->define_count; i++)
    cag_session_define(s, q->defines[i].name, q->defines[i].text);
  cag_session_set_loop(s, q->loop);
  if (!q->has_time) return;
  const double steps = q->frames > 1 ? q->frames - (q->loop ? 0 : 1) : 0;
  cag_session_set_frame(s, q->time * steps, q->frames > 1 ? q->frames : 1);
  snprintf(time, sizeof time, "%.17g", q->time);
  cag_session_define(s, "time", time);
}

// What a session needs to find the texts of a request.
typedef struct Overlay {
  const CagLiveRequest *request;
  const char *folder;
} Overlay;

static const char *find_import(void *context, const char *path, size_t *length) {
  const Overlay *o = context;
  const size_t n = strlen(o->folder);
  const bool below = !strncmp(path, o->folder, n) && path[n] == '/';
  const char *text = below ? cag_live_request_text(o->request, path + n + 1) : NULL;
  if (text) *length = strlen(text);
  return text;
}

CagSession *cag_model_session(const CagModel *model, const CagLiveRequest *request,
                              const volatile int *interrupt, FILE *out, int *status) {
  CagSessionOptions o = model->session;
  o.interrupt = interrupt;
  o.out = o.messages = out;
  o.folder = model->folder;
  // Modules are loaded by the run below alone.
  Overlay overlay = {request, model->folder};
  o.find_text = find_import;
  o.find_text_context = &overlay;
  CagSession *s = cag_session_new(&o);
  if (!s) return NULL;
  define_all(s, request);
  char *read = NULL;
  const char *unsaved = cag_live_request_text(request, model->name), *text = unsaved ? unsaved : "",
             *why;
  size_t size = strlen(text);
  // The script is run as a text, so that locations have paths below the folder.
  if (!unsaved && model->has_file && cag_model_read(model->folder, model->name, &read, &size, &why))
    text = read;
  *status = cag_session_run_text(s, model->name, text, size);
  free(read);
  return s;
}

static void publish_state(const CagModel *model, int run, bool running) {
  char text[64];
  snprintf(text, sizeof text, "{\"run\":%d,\"running\":%s}", run, running ? "true" : "false");
  model->publish(model->context, "state", text);
}

static void publish_messages(const CagModel *model, CagSession *s, const CagLiveRun *told) {
  CagString messages = {0};
  cag_live_messages(s, told, &messages);
  if (messages.bytes && !messages.failed)
    model->publish(model->context, "messages", messages.bytes);
  cag_string_free(&messages);
}

static void drop_session(CagSession *s, Prints *p) {
  cag_session_free(s);
  if (p && p->file) fclose(p->file);
  if (p) free(p->text);
  free(p);
}

void cag_model_run_free(CagModelRun *run) {
  drop_session(run->session, run->prints);
  *run = (CagModelRun){0};
}

// All times of a film have the default tolerance of the first one shown, so that meshes stay the
// same, unless the size of the scene changes a lot. Returns it.
static double keep_tolerance(CagSession *s, const CagLiveRequest *q, double before) {
  const double most = 8; // ratio
  const double own = cag_session_default_tolerance(s);
  const bool later = q->has_time && q->time > 0;
  if (!later || own == before || !(own <= most * before && before <= most * own)) return own;
  return cag_session_set_default_tolerance(s, before) ? before : own;
}

// What is written of a run.
typedef struct Showing {
  CagSession *session;
  const CagModel *model;
  const CagLiveRequest *request;
  int run, status;
  double tolerance; // before: of the last run
  CagString scene;
} Showing;

static void write_scene(void *context) {
  Showing *w = context;
  const CagModel *m = w->model;
  const CagLiveModel model = {w->run, m->name, m->folder, w->request->coarse};
  w->tolerance = keep_tolerance(w->session, w->request, w->tolerance);
  w->status = cag_live_scene(w->session, &model, &m->meshes, &w->scene);
}

void cag_model_run(const CagModel *model, const CagLiveRequest *request, int number,
                   const volatile int *interrupt, CagModelRun *last) {
  Prints *prints = calloc(1, sizeof *prints); // its addresses are in use until it is closed
  CagLiveRun told = {.run = number, .status = CAG_STATUS_LIMIT};
  const double begin = cag_clock_seconds();
  publish_state(model, number, true);
  if (prints) prints->file = open_memstream(&prints->text, &prints->length);
  CagSession *s = prints && prints->file
                      ? cag_model_session(model, request, interrupt, prints->file, &told.status)
                      : NULL;
  if (model->begin_scene) model->begin_scene(model->context);
  Showing shown = {s, model, request, number, told.status, last->tolerance, {0}};
  if (s && told.status == CAG_STATUS_OK) cag_session_together(s, write_scene, &shown);
  told.status = shown.status;
  told.seconds = cag_clock_seconds() - begin;
  if (s) {
    fflush(prints->file);
    told.prints = prints->text;
    if (model->ran) model->ran(model->context, s);
    if (told.status != CAG_STATUS_INTERRUPTED) publish_messages(model, s, &told);
  }
  const bool good = s && told.status == CAG_STATUS_OK && shown.scene.bytes;
  if (good) model->publish(model->context, "scene", shown.scene.bytes);
  publish_state(model, number, false);
  cag_string_free(&shown.scene);
  if (good) {
    cag_model_run_free(last);
    *last = (CagModelRun){s, prints, shown.tolerance};
  } else {
    drop_session(s, prints);
  }
}
