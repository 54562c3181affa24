// Measures of parts, and their total.

#include "live/measures.h"

#include <math.h>

typedef struct Total {
  cJSON *parts;
  size_t count;
  double min[3], max[3], area, volume, moment[3];
  bool bounded;
} Total;

static void add_box(cJSON *to, const double *min, const double *max) {
  double size[3];
  for (int i = 0; i < 3; i++) size[i] = max[i] - min[i];
  cJSON *box = cJSON_AddObjectToObject(to, "bounds");
  cag_json_add_numbers(box, "min", min, 3);
  cag_json_add_numbers(box, "max", max, 3);
  cag_json_add_numbers(box, "size", size, 3);
}

static void add_point(cJSON *to, const char *name, const double *p) {
  if (isfinite(p[0])) cag_json_add_numbers(to, name, p, 3);
  else cJSON_AddNullToObject(to, name);
}

static void sum_up(Total *t, const CagMeasures *m) {
  t->count++;
  if (isfinite(m->area)) t->area += m->area;
  if (isfinite(m->volume)) t->volume += m->volume;
  for (int i = 0; i < 3; i++) {
    if (isfinite(m->volume) && isfinite(m->centroid[i])) t->moment[i] += m->volume * m->centroid[i];
    if (m->empty) continue;
    t->min[i] = t->bounded ? fmin(t->min[i], m->min[i]) : m->min[i];
    t->max[i] = t->bounded ? fmax(t->max[i], m->max[i]) : m->max[i];
  }
  t->bounded = t->bounded || !m->empty;
}

static void add_part(void *context, const CagMeasures *m) {
  Total *t = context;
  cJSON *part = cJSON_CreateObject();
  cJSON_AddStringToObject(part, "name", m->name);
  cJSON_AddStringToObject(part, "type", m->type);
  cJSON_AddStringToObject(part, "kind", m->kind);
  cJSON_AddBoolToObject(part, "empty", m->empty);
  if (m->empty) cJSON_AddNullToObject(part, "bounds");
  else add_box(part, m->min, m->max);
  cag_json_add_number(part, "length", m->length);
  cag_json_add_number(part, "area", m->area);
  cag_json_add_number(part, "volume", m->volume);
  add_point(part, "centroid", m->centroid);
  // A curve has no mesh of its own.
  if (isfinite(m->area)) cJSON_AddBoolToObject(part, "watertight", m->closed);
  else cJSON_AddNullToObject(part, "watertight");
  cJSON_AddBoolToObject(part, "closed", m->closed);
  cJSON_AddBoolToObject(part, "exact", m->exact);
  if (m->has_faces) cJSON_AddNumberToObject(part, "faces", (double)m->faces);
  else cJSON_AddNullToObject(part, "faces");
  cJSON_AddNumberToObject(part, "triangles", (double)m->triangles);
  cJSON_AddItemToArray(t->parts, part);
  sum_up(t, m);
}

static void add_total(cJSON *whole, const Total *t) {
  cJSON *total = cJSON_AddObjectToObject(whole, "total");
  double centroid[3];
  for (int i = 0; i < 3; i++) centroid[i] = t->volume > 0 ? t->moment[i] / t->volume : NAN;
  cJSON_AddNumberToObject(total, "parts", (double)t->count);
  if (t->bounded) add_box(total, t->min, t->max);
  else cJSON_AddNullToObject(total, "bounds");
  cag_json_add_number(total, "area", t->area);
  cag_json_add_number(total, "volume", t->volume);
  add_point(total, "centroid", centroid);
}

typedef struct Definition {
  cJSON *whole;
  bool shown;
} Definition;

static void note_definition(void *context, const char *text, const char *type, bool shown) {
  Definition *d = context;
  d->shown = shown;
  if (shown) return;
  cJSON_AddStringToObject(d->whole, "value", text);
  cJSON_AddStringToObject(d->whole, "type", type);
}

CagMeasuring cag_measure(CagSession *s, const char *file, const char *name) {
  CagMeasuring out = {cJSON_CreateObject(), CAG_STATUS_OK};
  Definition d = {out.whole, true};
  cJSON_AddStringToObject(out.whole, "file", file);
  if (name) cJSON_AddStringToObject(out.whole, "name", name);
  else cJSON_AddNullToObject(out.whole, "name");
  cJSON_AddStringToObject(out.whole, "unit", "mm");
  if (name) out.status = cag_session_definition(s, name, note_definition, &d);
  Total total = {.parts = cJSON_AddArrayToObject(out.whole, "parts")};
  if (out.status != CAG_STATUS_OK || !d.shown) return out;
  if (!cag_session_show_only(s, name)) out.status = CAG_STATUS_LIMIT;
  else out.status = cag_session_measure(s, add_part, &total);
  add_total(out.whole, &total);
  return out;
}
