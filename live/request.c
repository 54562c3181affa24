#include "live/request.h"

#include <cJSON.h>
#include <stdlib.h>
#include <string.h>

// Meshes are coarser by this factor while something is dragged.
#define COARSE 8.0

void cag_live_request_free(CagLiveRequest *r) {
  for (size_t i = 0; i < r->define_count; i++) {
    free(r->defines[i].name);
    free(r->defines[i].value);
  }
  free(r->defines);
  free(r->text);
  *r = (CagLiveRequest){0};
}

bool cag_live_request_copy(const CagLiveRequest *from, CagLiveRequest *to) {
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

// The unsaved text of the script, if it is among the given files.
static bool read_text(const char *script, const cJSON *files, CagLiveRequest *q) {
  const cJSON *text = cJSON_GetObjectItemCaseSensitive(files, script);
  if (!cJSON_IsString(text)) return true;
  q->text = strdup(text->valuestring);
  return q->text != NULL;
}

bool cag_live_request_read(const char *text, size_t size, const char *script, CagLiveRequest *out) {
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
                  read_text(script, cJSON_GetObjectItemCaseSensitive(json, "files"), out);
  cJSON_Delete(json);
  if (!ok) cag_live_request_free(out);
  return ok;
}
