#include "live/questions.h"

#include <cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "live/place_json.h"
#include "live/points_json.h"
#include "live/robot_json.h"

enum { OK = 200, BAD = 400, MISSING = 404, NOT_YET = 409, REFUSED = 422, BROKEN = 500 };

typedef struct Question {
  CagSession *session;
  const cJSON *request;
  const CagLiveMeshes *meshes;
  CagJson *answer; // within an object that is open
  const char *error, *help;
  bool failed; // memory ran out
} Question;

static int complain(Question *q, int status, const char *error, const char *help) {
  q->error = error;
  q->help = help;
  return status;
}

static int complain_of_session(Question *q) {
  CagErrorView e = {0};
  const size_t n = cag_session_error_count(q->session);
  if (n > 0) cag_session_error(q->session, n - 1, &e);
  return complain(q, REFUSED, e.message ? e.message : "it failed", e.help);
}

// --- Requests ---

static const char *text_field(const Question *q, const char *name) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(q->request, name);
  return cJSON_IsString(item) ? item->valuestring : NULL;
}

static bool number_field(const Question *q, const char *name, double *out) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(q->request, name);
  *out = cJSON_IsNumber(item) ? item->valuedouble : 0;
  return cJSON_IsNumber(item) && isfinite(*out);
}

// A line or column. Larger numbers than a text can have are not found in it.
static bool count_field(const Question *q, const char *name, size_t *out) {
  const double most = 1e9;
  double x;
  if (!number_field(q, name, &x) || x < 1 || x > most || x != floor(x)) return false;
  *out = (size_t)x;
  return true;
}

static bool find_part(const Question *q, size_t *out) {
  const char *name = text_field(q, "part");
  CagPartView p;
  for (*out = 0; name && cag_session_part(q->session, *out, &p); ++*out)
    if (!strcmp(p.name, name) && strcmp(p.type, "ground") != 0) return true;
  return false;
}

// --- Numbers ---

// Adds a text of base64. The processor stores the least byte first, as all that cag runs on do.
static void add_bytes(Question *q, const char *key, const void *bytes, size_t n) {
  static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const unsigned char *from = bytes;
  char *text = malloc(4 * (n / 3 + 1) + 1), *at = text;
  if (!text) {
    q->failed = true;
    return;
  }
  for (size_t i = 0; i < n; i += 3) {
    const unsigned a = from[i], b = i + 1 < n ? from[i + 1] : 0u, c = i + 2 < n ? from[i + 2] : 0u;
    *at++ = DIGITS[a >> 2];
    *at++ = DIGITS[(a & 3u) << 4 | b >> 4];
    *at++ = i + 1 < n ? DIGITS[(b & 15u) << 2 | c >> 6] : '=';
    *at++ = i + 2 < n ? DIGITS[c & 63u] : '=';
  }
  *at = 0;
  cag_json_text(q->answer, key, text);
  free(text);
}

static void add_floats(Question *q, const char *key, const float *x, size_t n) {
  add_bytes(q, key, x, n * sizeof *x);
}

// --- Questions ---

static int ask_faces(Question *q) {
  CagFacesView f;
  CagJson *j = q->answer;
  size_t part;
  if (!find_part(q, &part)) return complain(q, MISSING, "there is no such part", NULL);
  const int status = cag_session_part_faces(q->session, part, &f);
  if (status == CAG_STATUS_USAGE)
    return complain(q, REFUSED, "the part is not a set operation of solids", NULL);
  if (status != CAG_STATUS_OK) return complain_of_session(q);
  cag_json_text(j, "mesh", f.id);
  cag_json_open_in(j, "operands", '[');
  for (size_t i = 0; i < f.operand_count; i++) cag_json_number(j, NULL, f.sources[i]);
  cag_json_close(j, ']');
  cag_json_open_in(j, "faces", '[');
  for (size_t t = 0, n; t < f.triangle_count; t += n) {
    for (n = 1; t + n < f.triangle_count && f.operands[t + n] == f.operands[t];) n++;
    cag_json_number(j, NULL, (double)n);
    cag_json_number(j, NULL, f.operands[t]);
  }
  cag_json_close(j, ']');
  return OK;
}

static void add_motion(CagJson *j, const CagGhostView *g) {
  if (!g->motion) {
    cag_json_null(j, "motion");
    return;
  }
  cag_json_open_in(j, "motion", '{');
  cag_json_text(j, "kind", g->motion);
  cag_json_numbers(j, "point", g->point, 3);
  cag_json_numbers(j, "direction", g->direction, 3);
  cag_json_number(j, "angle", g->angle);
  if (!strcmp(g->motion, "transform")) cag_json_numbers(j, "frame", g->frame[0], 12);
  else cag_json_null(j, "frame");
  cag_json_close(j, '}');
}

static bool has_mesh(void *context, const char *id) {
  const Question *q = context;
  return q->meshes->has(q->meshes->context, id);
}

static void add_ghost(void *context, const CagGhostView *g, const CagMeshView *m) {
  Question *q = context;
  CagJson *j = q->answer;
  if (m->positions && !q->meshes->keep(q->meshes->context, m)) q->failed = true;
  cag_json_open(j, '{');
  cag_json_text(j, "part", g->part);
  cag_json_text(j, "type", g->type);
  cag_json_text(j, "mesh", m->id);
  cag_json_numbers(j, "placement", m->placement[0], 12);
  cag_json_bool(j, "line", m->line);
  cag_json_number(j, "radius", m->radius);
  add_motion(j, g);
  cag_json_open_in(j, "place", '{');
  cag_live_place(j, &g->place);
  cag_json_close(j, '}');
  cag_json_close(j, '}');
}

static int ask_ghost(Question *q) {
  const char *file = text_field(q, "file");
  size_t line, column;
  if (!file || !count_field(q, "line", &line) || !count_field(q, "column", &column))
    return complain(q, BAD, "expected `file`, `line`, and `column`",
                    "lines and columns count from 1");
  cag_json_open_in(q->answer, "ghosts", '[');
  const int status = cag_session_ghosts(q->session, file, line, column, has_mesh, add_ghost, q);
  cag_json_close(q->answer, ']');
  return status == CAG_STATUS_OK ? OK : complain_of_session(q);
}

// That a part has no such thing is an answer.
static int give_reason(Question *q) {
  complain_of_session(q);
  cag_json_text(q->answer, "reason", q->error);
  return OK;
}

static int ask_surface(Question *q) {
  CagSurfaceView v;
  const char *what = text_field(q, "what");
  size_t part;
  if (!what) return complain(q, BAD, "expected `part` and `what`", NULL);
  if (!find_part(q, &part)) return complain(q, MISSING, "there is no such part", NULL);
  const int status = cag_session_part_surface(q->session, part, what, &v);
  if (status == CAG_STATUS_USAGE)
    return complain(q, BAD, "unknown `what`", "it is curvature, deviation, isolines, or net");
  if (status == CAG_STATUS_SCRIPT) return give_reason(q);
  if (status != CAG_STATUS_OK) return complain_of_session(q);
  cag_json_text(q->answer, "mesh", v.id);
  if (v.mean) add_floats(q, "mean", v.mean, 3 * v.triangle_count);
  if (v.gaussian) add_floats(q, "gaussian", v.gaussian, 3 * v.triangle_count);
  if (v.distance) add_floats(q, "distance", v.distance, v.triangle_count);
  if (v.distance) cag_json_number(q->answer, "farthest", v.farthest);
  if (!v.points) return OK;
  add_floats(q, "points", v.points, 3 * v.point_count);
  cag_json_open_in(q->answer, "sizes", '[');
  for (size_t i = 0; i < v.line_count; i++) cag_json_number(q->answer, NULL, v.line_sizes[i]);
  cag_json_close(q->answer, ']');
  return OK;
}

static void add_section_curve(void *context, const CagSectionCurve *c) {
  Question *q = context;
  cag_json_open(q->answer, '{');
  cag_json_text(q->answer, "part", c->part);
  cag_json_bool(q->answer, "closed", c->closed);
  cag_json_bool(q->answer, "exact", c->exact);
  cag_json_number(q->answer, "length", c->length);
  cag_json_number(q->answer, "area", c->area);
  add_floats(q, "points", c->points, 3 * c->point_count);
  cag_json_close(q->answer, '}');
}

static int ask_section(Question *q) {
  const cJSON *normal = cJSON_GetObjectItemCaseSensitive(q->request, "normal");
  double plane[4];
  bool ok = cJSON_GetArraySize(normal) == 3 && number_field(q, "offset", &plane[3]);
  for (int i = 0; ok && i < 3; i++) {
    const cJSON *x = cJSON_GetArrayItem(normal, i);
    ok = cJSON_IsNumber(x) && isfinite(x->valuedouble);
    if (ok) plane[i] = x->valuedouble;
  }
  if (!ok || (plane[0] == 0 && plane[1] == 0 && plane[2] == 0))
    return complain(q, BAD, "expected `normal`, three numbers that are not all 0, and `offset`",
                    NULL);
  cag_json_open_in(q->answer, "curves", '[');
  const int status = cag_session_section_curves(q->session, plane, add_section_curve, q);
  cag_json_close(q->answer, ']');
  return status == CAG_STATUS_OK ? OK : complain_of_session(q);
}

// --- Answers ---

static const struct {
  const char *name;
  int (*ask)(Question *q);
} QUESTIONS[] = {
    {"faces", ask_faces}, {"ghost", ask_ghost}, {"surface", ask_surface}, {"section", ask_section}};
static int write_refusal(int status, const char *error, const char *help, CagString *out) {
  CagJson j = {.to = out};
  cag_json_open(&j, '{');
  cag_json_text(&j, "error", error);
  cag_json_text(&j, "help", help);
  cag_json_close(&j, '}');
  return status;
}

typedef void PointsAnswerer(CagSession *s, const char *request, size_t size, CagLiveAnswer *out);

static int about_points(PointsAnswerer *answer, CagSession *s, const char *request, size_t size,
                        CagString *out) {
  CagLiveAnswer a = {0};
  if (!s) return write_refusal(NOT_YET, "the script has not run without errors yet", NULL, out);
  answer(s, request, size, &a);
  if (a.status == OK) *out = a.text;
  else cag_string_free(&a.text);
  return a.status == OK ? OK : write_refusal(a.status, a.why, NULL, out);
}

static int answer_points(CagSession *s, const char *request, size_t size, CagString *out) {
  return about_points(cag_live_points, s, request, size, out);
}

static int answer_solve(CagSession *s, const char *request, size_t size, CagString *out) {
  return about_points(cag_live_solve, s, request, size, out);
}

// Questions that other files answer as a whole.
typedef int LiveAnswerer(CagSession *s, const char *request, size_t size, CagString *out);
static const struct {
  const char *name;
  LiveAnswerer *answer;
} ANSWERERS[] = {{"pose", cag_live_pose},
                 {"reach", cag_live_reach},
                 {"points", answer_points},
                 {"solve", answer_solve}};
enum { QUESTION_COUNT = sizeof QUESTIONS / sizeof *QUESTIONS };

static size_t find_question(const char *name) {
  size_t i = 0;
  while (i < QUESTION_COUNT && strcmp(QUESTIONS[i].name, name) != 0) i++;
  return i;
}

static int answer(Question *q, size_t question) {
  CagPartView unused;
  if (!cJSON_IsObject(q->request)) return complain(q, BAD, "expected a JSON object", NULL);
  if (!q->session || !cag_session_part(q->session, 0, &unused))
    return complain(q, NOT_YET, "the script shows no shapes", NULL);
  return QUESTIONS[question].ask(q);
}

static LiveAnswerer *find_answerer(const char *name) {
  for (size_t i = 0; i < sizeof ANSWERERS / sizeof *ANSWERERS; i++)
    if (!strcmp(ANSWERERS[i].name, name)) return ANSWERERS[i].answer;
  return NULL;
}

bool cag_live_is_question(const char *question) {
  return find_question(question) < QUESTION_COUNT || find_answerer(question);
}

int cag_live_ask(const char *question, CagSession *s, const char *request, size_t size,
                 const CagLiveMeshes *meshes, CagString *out) {
  const size_t k = find_question(question);
  LiveAnswerer *answerer = find_answerer(question);
  if (answerer) return answerer(s, request, size, out);
  cJSON *json = cJSON_ParseWithLength(request, size);
  CagJson j = {.to = out};
  Question q = {.session = s, .request = json, .meshes = meshes, .answer = &j};
  if (k == QUESTION_COUNT) return MISSING;
  cag_json_open(&j, '{');
  int status = answer(&q, k);
  cag_json_close(&j, '}');
  if (q.failed || out->failed) status = complain(&q, BROKEN, "out of memory", NULL);
  if (status != OK) {
    cag_string_free(out);
    write_refusal(status, q.error, q.help, out);
  }
  cJSON_Delete(json);
  return status;
}
