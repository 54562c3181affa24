#include "live/model_answers.h"

#include <cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "live/measures.h"
#include "live/model_files.h"

enum { SIDE_MOST = 8192 };

// --- Files that are written in a folder of their own ---

typedef int WriteFile(CagSession *s, const char *path, void *context);

static CagModelAnswer failure(int status, const char *error, const char *help) {
  return (CagModelAnswer){.status = status, .error = error, .help = help};
}

static CagModelAnswer failure_of_session(const CagSession *s) {
  CagErrorView e = {0};
  if (cag_session_error_count(s) > 0) cag_session_error(s, cag_session_error_count(s) - 1, &e);
  return failure(422, e.message ? e.message : "it failed", e.help);
}

static CagModelAnswer write_and_read(CagSession *s, const char *name, const char *type,
                                     WriteFile *write, void *context) {
  char folder[] = "/tmp/cag-view-XXXXXX", path[sizeof folder + CAG_ANSWER_NAME];
  const char *why;
  CagModelAnswer out = {.status = 200, .type = type};
  if (!s) return failure(409, "the script has not run without errors yet", NULL);
  if (!mkdtemp(folder)) return failure(500, "cannot create a folder in /tmp", NULL);
  snprintf(path, sizeof path, "%s/%s", folder, name);
  if (write(s, path, context) != CAG_STATUS_OK) out = failure_of_session(s);
  else if (!cag_model_read(folder, name, &out.bytes, &out.size, &why))
    out = failure(500, why, NULL);
  unlink(path);
  rmdir(folder);
  return out;
}

static int write_export(CagSession *s, const char *path, void *context) {
  return cag_session_export(s, path, context);
}

CagModelAnswer cag_answer_export(CagSession *s, const char *script, const char *format) {
  char name[CAG_ANSWER_NAME];
  const char *slash = strrchr(script, '/');
  if (!cag_export_format_story(format))
    return failure(400, "expected a format of cag export", NULL);
  snprintf(name, sizeof name - strlen(format) - 1, "%s", slash ? slash + 1 : script);
  char *dot = strrchr(name, '.');
  if (dot) *dot = 0;
  const size_t n = strlen(name);
  snprintf(name + n, sizeof name - n, ".%s", format);
  CagModelAnswer out =
      write_and_read(s, name, "application/octet-stream", write_export, (void *)format);
  memcpy(out.name, name, sizeof name);
  return out;
}

static int write_image(CagSession *s, const char *path, void *context) {
  return cag_session_export_image(s, path, "png", &(CagImageOptions){.image = context});
}

CagModelAnswer cag_answer_image(CagSession *s, const char *image) {
  return write_and_read(s, "image.png", "image/png", write_image, (void *)image);
}

CagModelAnswer cag_answer_measure(CagSession *s, const char *script, const char *part_name) {
  CagModelAnswer out = failure(404, "there is no such part", NULL);
  CagMeasuring m = {NULL, CAG_STATUS_SCRIPT};
  if (s) m = cag_measure(s, script, NULL);
  const cJSON *part, *parts = cJSON_GetObjectItemCaseSensitive(m.whole, "parts");
  cJSON_ArrayForEach(part, parts) {
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(part, "name");
    if (cJSON_IsString(name) && !strcmp(name->valuestring, part_name))
      out.bytes = cJSON_PrintUnformatted(part);
    if (out.bytes) break;
  }
  if (out.bytes) out = (CagModelAnswer){200, out.bytes, strlen(out.bytes), NULL, "", NULL, NULL};
  else if (s && m.status != CAG_STATUS_OK) out = failure_of_session(s);
  cJSON_Delete(m.whole);
  return out;
}

// --- Pictures ---

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

static void read_view(const cJSON *json, CagPictureRequest *out) {
  const cJSON *fov = cJSON_GetObjectItemCaseSensitive(json, "fov"),
              *width = cJSON_GetObjectItemCaseSensitive(json, "width");
  CagCameraView *v = &out->view;
  *v = (CagCameraView){.name = "page",
                       .orthographic = !cJSON_IsNumber(fov),
                       .fov = cJSON_IsNumber(fov) ? fov->valuedouble : 0,
                       .width = cJSON_IsNumber(width) ? width->valuedouble : 100,
                       .size = {out->width, out->height}};
  out->has_view = read_point(json, "eye", v->eye) && read_point(json, "target", v->target) &&
                  read_point(json, "up", v->up);
}

bool cag_picture_request_read(const char *text, size_t size, CagPictureRequest *out) {
  cJSON *json = cJSON_ParseWithLength(text, size);
  const cJSON *camera = cJSON_GetObjectItemCaseSensitive(json, "camera");
  const bool ok = cJSON_IsObject(json);
  *out = (CagPictureRequest){0};
  read_word(json, "engine", out->engine, sizeof out->engine);
  read_word(json, "quality", out->quality, sizeof out->quality);
  out->width = read_side(json, "width", 960);
  out->height = read_side(json, "height", 540);
  if (cJSON_IsObject(camera)) read_view(camera, out);
  else read_word(json, "camera", out->camera, sizeof out->camera);
  cJSON_Delete(json);
  return ok;
}

typedef struct Picture {
  const CagPictureRequest *request;
  void (*progress)(void *context, double percent, const char *phase);
  void *context;
} Picture;

static int write_picture(CagSession *s, const char *path, void *context) {
  const Picture *p = context;
  const CagPictureRequest *r = p->request;
  CagRenderOptions o;
  cag_render_options_init(&o);
  if (*r->engine) o.engine = r->engine;
  if (*r->quality) o.quality = r->quality;
  if (*r->camera) o.camera = r->camera;
  if (r->has_view) o.view = &r->view;
  o.width = r->width;
  o.height = r->height;
  o.progress = p->progress;
  o.progress_context = p->context;
  return cag_session_render(s, &o, path);
}

CagModelAnswer cag_answer_picture(CagSession *s, const CagPictureRequest *request,
                                  void (*progress)(void *context, double percent,
                                                   const char *phase),
                                  void *context) {
  Picture p = {request, progress, context};
  return write_and_read(s, "picture.png", "image/png", write_picture, &p);
}

// --- Hello ---

void cag_hello_write(const CagHello *h, CagString *out) {
  CagJson j = {.to = out};
  const char *const *formats = cag_export_formats();
  cag_json_open(&j, '{');
  cag_json_text(&j, "version", cag_version());
  cag_json_text(&j, "file", h->file);
  cag_json_text(&j, "folder", h->folder);
  cag_json_bool(&j, "readOnly", h->read_only);
  cag_json_bool(&j, "untitled", h->untitled);
  cag_json_text(&j, "engine", h->engine);
  cag_json_bool(&j, "povray", h->povray);
  cag_json_open_in(&j, "formats", '[');
  for (size_t i = 0; formats[i]; i++) {
    cag_json_open(&j, '[');
    cag_json_text(&j, NULL, formats[i]);
    cag_json_text(&j, NULL, cag_export_format_story(formats[i]));
    cag_json_close(&j, ']');
  }
  cag_json_close(&j, ']');
  cag_json_close(&j, '}');
}
