#include "live/points_json.h"

#include <cJSON.h>
#include <math.h>
#include <string.h>

enum { MOST_PARAMS = 8, MOST_ID = 1000000 };

static void refuse(CagLiveAnswer *out, int status, const char *why) {
  out->status = status;
  out->why = why;
}

// --- The request ---

static const char *text_of(const cJSON *json, const char *field) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, field);
  return cJSON_IsString(item) ? item->valuestring : NULL;
}

static bool find_part(CagSession *s, const char *name, size_t *out) {
  CagPartView part;
  for (size_t i = 0; cag_session_part(s, i, &part); i++) {
    if (strcmp(part.name, name) != 0) continue;
    *out = i;
    return true;
  }
  return false;
}

static const char *message_of(const CagSession *s) {
  CagErrorView e = {0};
  const size_t n = cag_session_error_count(s);
  if (n > 0) cag_session_error(s, n - 1, &e);
  return e.message ? e.message : "the points cannot be found";
}

// --- Points ---

static double norm3(const double *v) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// The plane of a point with two coordinates. Returns false if the map flattens it.
static bool find_normal(const CagPointView *p, double out[3]) {
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = p->map[j][0] * p->map[k][1] - p->map[k][0] * p->map[j][1];
  }
  const double length = norm3(out);
  for (int i = 0; i < 3; i++) out[i] /= length;
  return length > 0 && isfinite(length);
}

static void write_plane(CagJson *j, const CagPointView *p) {
  double normal[3];
  if (p->dimension != 2 || !find_normal(p, normal)) {
    cag_json_null(j, "plane");
    return;
  }
  cag_json_open_in(j, "plane", '{');
  cag_json_numbers(j, "origin", p->at, 3);
  cag_json_numbers(j, "normal", normal, 3);
  cag_json_close(j, '}');
}

static void write_coordinate(CagJson *j, const CagPointNumber *n) {
  if (!n->literal) {
    cag_json_null(j, NULL);
    return;
  }
  cag_json_open(j, '{');
  cag_json_text(j, "file", n->place.file);
  cag_json_number(j, "line", (double)n->place.line);
  cag_json_number(j, "column", (double)n->place.column);
  cag_json_number(j, "endLine", (double)n->place.end_line);
  cag_json_number(j, "endColumn", (double)n->place.end_column);
  cag_json_number(j, "value", n->value);
  cag_json_text(j, "unit", n->unit);
  cag_json_number(j, "scale", n->scale);
  cag_json_close(j, '}');
}

static void write_point(CagJson *j, CagSession *s, size_t i, const CagPointView *p) {
  const char *name;
  cag_json_open(j, '{');
  cag_json_number(j, "id", (double)p->id);
  cag_json_text(j, "call", p->call);
  cag_json_number(j, "dimension", p->dimension);
  cag_json_numbers(j, "at", p->at, 3);
  write_plane(j, p);
  cag_json_numbers(j, "map", p->map[0], 12);
  cag_json_open_in(j, "numbers", '[');
  for (int k = 0; k < p->dimension; k++) write_coordinate(j, &p->numbers[k]);
  cag_json_close(j, ']');
  cag_json_open_in(j, "moved", '[');
  for (int k = 0; k < p->dimension; k++) cag_json_bool(j, NULL, p->moved[k]);
  cag_json_close(j, ']');
  cag_json_text(j, "locked", p->locked);
  cag_json_open_in(j, "params", '[');
  for (size_t k = 0; (name = cag_session_point_param(s, i, k)); k++) cag_json_text(j, NULL, name);
  cag_json_close(j, ']');
  cag_json_close(j, '}');
}

static void write_points(CagSession *s, size_t part, CagLiveAnswer *out) {
  size_t count, omitted;
  CagPointView p;
  const int status = cag_session_points(s, part, &count, &omitted);
  if (status == CAG_STATUS_USAGE) {
    refuse(out, 404, "this part has no points");
    return;
  }
  if (status != CAG_STATUS_OK) {
    refuse(out, 422, message_of(s));
    return;
  }
  CagJson j = {.to = &out->text};
  cag_json_open(&j, '{');
  cag_json_open_in(&j, "points", '[');
  for (size_t i = 0; cag_session_point(s, i, &p); i++) write_point(&j, s, i, &p);
  cag_json_close(&j, ']');
  cag_json_number(&j, "omitted", (double)omitted);
  cag_json_close(&j, '}');
}

void cag_live_points(CagSession *s, const char *request, size_t size, CagLiveAnswer *out) {
  cJSON *json = cJSON_ParseWithLength(request, size);
  const char *name = text_of(json, "part");
  size_t part;
  *out = (CagLiveAnswer){.status = 200};
  if (!name) refuse(out, 400, "expected `part`, the name of a part");
  else if (!find_part(s, name, &part)) refuse(out, 404, "there is no such part");
  else write_points(s, part, out);
  cJSON_Delete(json);
}

// --- Params for a point ---

static bool read_vector(const cJSON *list, double out[3]) {
  if (!cJSON_IsArray(list) || cJSON_GetArraySize(list) != 3) return false;
  for (int i = 0; i < 3; i++) {
    const cJSON *x = cJSON_GetArrayItem(list, i);
    if (!cJSON_IsNumber(x) || !isfinite(x->valuedouble)) return false;
    out[i] = x->valuedouble;
  }
  return true;
}

// Directions may be left out.
static bool read_ignored(const cJSON *json, CagPointGoal *out) {
  const cJSON *item, *list = cJSON_GetObjectItemCaseSensitive(json, "ignored");
  int n = 0;
  if (!list) return true;
  cJSON_ArrayForEach(item, list) if (n == 2 || !read_vector(item, out->ignored[n++])) return false;
  return cJSON_IsArray(list);
}

static bool read_names(const cJSON *json, const char *names[MOST_PARAMS], CagPointGoal *out) {
  const cJSON *item, *list = cJSON_GetObjectItemCaseSensitive(json, "params");
  out->names = names;
  cJSON_ArrayForEach(item, list) {
    if (!cJSON_IsString(item) || out->count == MOST_PARAMS) return false;
    names[out->count++] = item->valuestring;
  }
  return cJSON_IsArray(list) && out->count > 0;
}

static bool read_goal(CagSession *s, const cJSON *json, CagPointGoal *out, CagLiveAnswer *answer) {
  const cJSON *point = cJSON_GetObjectItemCaseSensitive(json, "point"),
              *pixel = cJSON_GetObjectItemCaseSensitive(json, "pixel");
  const char *name = text_of(json, "part");
  const double id = cJSON_IsNumber(point) ? point->valuedouble : -1;
  if (!name) refuse(answer, 400, "expected `part`, the name of a part");
  else if (!(id >= 0 && id < MOST_ID)) refuse(answer, 400, "expected `point`, the id of a point");
  else if (!read_vector(cJSON_GetObjectItemCaseSensitive(json, "target"), out->target))
    refuse(answer, 400, "expected `target`, a list of three numbers");
  else if (!read_ignored(json, out))
    refuse(answer, 400, "expected `ignored`, a list of at most two directions");
  else if (out->count == 0)
    refuse(answer, 400, "expected `params`, a list of 1 to 8 names of params");
  else if (!find_part(s, name, &out->part)) refuse(answer, 404, "there is no such part");
  if (answer->status != 200) return false;
  out->point = (size_t)id;
  out->tolerance = cJSON_IsNumber(pixel) ? pixel->valuedouble : 0;
  return true;
}

static void write_value(void *context, const char *name, const char *value) {
  cag_json_text(context, name, value);
}

void cag_live_solve(CagSession *s, const char *request, size_t size, CagLiveAnswer *out) {
  cJSON *json = cJSON_ParseWithLength(request, size);
  const char *names[MOST_PARAMS];
  CagPointGoal goal = {0};
  double at[3];
  CagJson j = {.to = &out->text};
  *out = (CagLiveAnswer){.status = 200};
  if (!read_names(json, names, &goal)) goal.count = 0;
  if (read_goal(s, json, &goal, out)) {
    cag_json_open(&j, '{');
    cag_json_open_in(&j, "params", '{');
    const int status = cag_session_solve_point(s, &goal, write_value, &j, at);
    cag_json_close(&j, '}');
    if (status == CAG_STATUS_OK) cag_json_numbers(&j, "at", at, 3);
    cag_json_close(&j, '}');
    if (status == CAG_STATUS_USAGE)
      refuse(out, 404, "there is no such point, or no such param with a range");
    else if (status != CAG_STATUS_OK) refuse(out, 422, message_of(s));
  }
  cJSON_Delete(json);
}
