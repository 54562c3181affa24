#include "live/request.h"

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>

// Meshes are coarser by this factor while something is dragged.
#define COARSE 8.0

static void free_text(CagLiveText *t) {
  free(t->name);
  free(t->text);
}

static void free_texts(CagLiveText *texts, size_t n) {
  for (size_t i = 0; i < n; i++) free_text(&texts[i]);
  free(texts);
}

void cag_live_request_free(CagLiveRequest *r) {
  free_texts(r->defines, r->define_count);
  free_texts(r->texts, r->text_count);
  *r = (CagLiveRequest){0};
}

static bool copy_texts(const CagLiveText *from, size_t n, CagLiveText **out, size_t *count) {
  *count = 0;
  *out = calloc(n + 1, sizeof **out);
  for (; *out && *count < n; ++*count) {
    CagLiveText *t = &(*out)[*count];
    *t = (CagLiveText){strdup(from[*count].name), strdup(from[*count].text)};
    if (t->name && t->text) continue;
    free_text(t);
    return false;
  }
  return *out;
}

bool cag_live_request_copy(const CagLiveRequest *from, CagLiveRequest *to) {
  *to = *from;
  to->texts = NULL;
  to->text_count = 0;
  const bool ok = copy_texts(from->defines, from->define_count, &to->defines, &to->define_count) &&
                  copy_texts(from->texts, from->text_count, &to->texts, &to->text_count);
  if (!ok) cag_live_request_free(to);
  return ok;
}

// Reads the texts of an object, with their names.
static bool read_texts(const cJSON *object, CagLiveText **out, size_t *count) {
  *out = calloc((size_t)cJSON_GetArraySize(object) + 1, sizeof **out);
  if (!*out) return false;
  const cJSON *item;
  cJSON_ArrayForEach(item, object) {
    if (!cJSON_IsString(item)) continue;
    CagLiveText *t = &(*out)[(*count)++];
    *t = (CagLiveText){strdup(item->string), strdup(item->valuestring)};
    if (!t->name || !t->text) return false;
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
  const bool ok =
      read_texts(cJSON_GetObjectItemCaseSensitive(json, "params"), &out->defines,
                 &out->define_count) &&
      read_texts(cJSON_GetObjectItemCaseSensitive(json, "files"), &out->texts, &out->text_count);
  cJSON_Delete(json);
  if (!ok) cag_live_request_free(out);
  return ok;
}

const char *cag_live_request_text(const CagLiveRequest *r, const char *path) {
  for (size_t i = 0; i < r->text_count; i++)
    if (!strcmp(r->texts[i].name, path)) return r->texts[i].text;
  return NULL;
}

void cag_live_request_drop_text(CagLiveRequest *r, const char *path) {
  for (size_t i = 0; i < r->text_count; i++) {
    if (strcmp(r->texts[i].name, path) != 0) continue;
    free_text(&r->texts[i]);
    r->texts[i] = r->texts[--r->text_count];
    return;
  }
}
