#include "live/request.h"

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>

// Meshes are coarser by this factor while something is dragged.
#define COARSE 8.0

static void free_text(CagLiveText *t) {
  free(t->path);
  free(t->text);
}

void cag_live_request_free(CagLiveRequest *r) {
  for (size_t i = 0; i < r->define_count; i++) {
    free(r->defines[i].name);
    free(r->defines[i].value);
  }
  free(r->defines);
  for (size_t i = 0; i < r->text_count; i++) free_text(&r->texts[i]);
  free(r->texts);
  *r = (CagLiveRequest){0};
}

bool cag_live_request_copy(const CagLiveRequest *from, CagLiveRequest *to) {
  *to = *from;
  to->defines = calloc(from->define_count + 1, sizeof *to->defines);
  to->texts = calloc(from->text_count + 1, sizeof *to->texts);
  bool ok = to->defines && to->texts;
  for (size_t i = 0; ok && i < from->define_count; i++) {
    to->defines[i].name = strdup(from->defines[i].name);
    to->defines[i].value = strdup(from->defines[i].value);
    ok = to->defines[i].name && to->defines[i].value;
  }
  for (size_t i = 0; ok && i < from->text_count; i++) {
    to->texts[i].path = strdup(from->texts[i].path);
    to->texts[i].text = strdup(from->texts[i].text);
    ok = to->texts[i].path && to->texts[i].text;
  }
  if (!to->defines) to->define_count = 0;
  if (!to->texts) to->text_count = 0;
  if (!ok) cag_live_request_free(to);
  return ok;
}

static bool read_defines(const cJSON *params, CagLiveRequest *q) {
  const int n = cJSON_GetArraySize(params);
  q->defines = calloc((size_t)n + 1, sizeof *q->defines);
  if (!q->defines) return false;
  const cJSON *item;
  cJSON_ArrayForEach(item, params) {
    if (!cJSON_IsString(item)) continue;
    CagLiveDefine *d = &q->defines[q->define_count++];
    d->name = strdup(item->string);
    d->value = strdup(item->valuestring);
    if (!d->name || !d->value) return false;
  }
  return true;
}

static bool read_texts(const cJSON *files, CagLiveRequest *q) {
  const int n = cJSON_GetArraySize(files);
  q->texts = calloc((size_t)n + 1, sizeof *q->texts);
  if (!q->texts) return false;
  const cJSON *item;
  cJSON_ArrayForEach(item, files) {
    if (!cJSON_IsString(item)) continue;
    CagLiveText *t = &q->texts[q->text_count++];
    t->path = strdup(item->string);
    t->text = strdup(item->valuestring);
    if (!t->path || !t->text) return false;
  }
  return true;
}

bool cag_live_request_read(const char *text, size_t size, CagLiveRequest *out) {
  cJSON *json = cJSON_ParseWithLength(text, size);
  if (!cJSON_IsObject(json)) {
    cJSON_Delete(json);
    return false;
  }
  const cJSON *time = cJSON_GetObjectItemCaseSensitive(json, "time"),
              *frames = cJSON_GetObjectItemCaseSensitive(json, "frames");
  *out = (CagLiveRequest){
      .coarse = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(json, "coarse")) ? COARSE : 1,
      .loop = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(json, "loop")),
      .has_time = cJSON_IsNumber(time),
      .time = cJSON_IsNumber(time) ? time->valuedouble : 0,
      .frames = cJSON_IsNumber(frames) ? frames->valuedouble : 1};
  const bool ok = read_defines(cJSON_GetObjectItemCaseSensitive(json, "params"), out) &&
                  read_texts(cJSON_GetObjectItemCaseSensitive(json, "files"), out);
  cJSON_Delete(json);
  if (!ok) cag_live_request_free(out);
  return ok;
}

const char *cag_live_request_text(const CagLiveRequest *r, const char *path) {
  for (size_t i = 0; i < r->text_count; i++)
    if (!strcmp(r->texts[i].path, path)) return r->texts[i].text;
  return NULL;
}

void cag_live_request_drop_text(CagLiveRequest *r, const char *path) {
  for (size_t i = 0; i < r->text_count; i++) {
    if (strcmp(r->texts[i].path, path) != 0) continue;
    free_text(&r->texts[i]);
    r->texts[i] = r->texts[--r->text_count];
    return;
  }
}
