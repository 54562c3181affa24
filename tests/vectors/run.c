// Runs golden vectors in the language: passes each vector's `given` to the function of its kind in
// kinds.cag, and compares the result with its `expect`.
//
//     run KINDS_FOLDER FILE.json ...
//
// A file is a record with a list `vectors`, or that list itself. A vector is a record with `id`,
// `kind`, `given`, `expect`, and `tolerance`. There is one session for a file. The script reads the
// file itself, and writes each result as a line of JSON, which is compared here. A vector passes if
// the result has every field of `expect` and these agree: numbers within the tolerance (relative
// above 1), lists and records element by element, null only with null. Additional fields are
// ignored. If `expect` has `error` (or the status "error"), the script must stop with an error that
// is not a limit; with `reason`, the error's short name must be equal. Parameters `t` that are only
// in `expect`, next to their `points`, and `test_points` are passed as well. The table below has
// rules for single fields.

#include <fnmatch.h>
#include <libgen.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "cag.h"

// The default tolerance.
#define USUAL_TOLERANCE 1e-9
// The maximum number of seconds for one vector.
#define LONGEST 120

typedef enum Rule {
  PLAIN,
  UP_TO_FACTOR,  // a list of numbers, or each list of numbers in a list, up to a nonzero factor
  ANY_ORDER,     // the elements of a list in any order
  FACTOR_ORDER,  // both of these
  SOME_OF,       // a list whose elements are among the found ones, in any order
  MODULO_TURN,   // degrees modulo full turns
  ANY_ORDER_TURN // a list in any order of degrees, or of lists and records of degrees
} Rule;

// Fields with special rules, by the sections of the references on vector kinds. Kinds and fields
// are patterns, and the first matching row applies.
static const struct {
  const char *kind, *field;
  Rule rule;
} rules[] = {
    {"t2.*", "homogeneous", UP_TO_FACTOR},
    {"t2.*", "equivalent_rotation_deg", MODULO_TURN},
    {"t2.*", "coef", UP_TO_FACTOR},
    {"t2.classify", "fixed_lines", FACTOR_ORDER},
    {"conic.line_intersection", "points", ANY_ORDER},
    {"conic.standard", "lines", FACTOR_ORDER},
    {"conic.classify", "lines", FACTOR_ORDER},
    {"conic.*", "coef", UP_TO_FACTOR},
    {"conic.*", "coef_4_2", UP_TO_FACTOR},
    {"pc.line_implicit", "coef", UP_TO_FACTOR},
    {"pc.point_at_x", "points", ANY_ORDER},
    {"*", "joints", SOME_OF},
    {"*", "left_at_knots", SOME_OF},
    {"quadric-from-geometry", "coefficients", UP_TO_FACTOR},
    {"quadric-classify", "axis_direction", UP_TO_FACTOR},
    {"quadric-rulings", "directions", FACTOR_ORDER},
    {"ik*", "solutions", ANY_ORDER_TURN},
};

typedef struct Check {
  double tolerance;
  char path[256];
  char problem[512]; // describes the first difference
} Check;

static Rule rule_of(const char *kind, const char *field) {
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
    if (fnmatch(rules[i].kind, kind, 0) == 0 && fnmatch(rules[i].field, field, 0) == 0)
      return rules[i].rule;
  return PLAIN;
}

static bool differ(Check *c, const char *format, ...) {
  va_list list;
  va_start(list, format);
  int n = snprintf(c->problem, sizeof c->problem, "%s: ", c->path[0] ? c->path : "the result");
  vsnprintf(c->problem + n, sizeof c->problem - (size_t)n, format, list);
  va_end(list);
  return false;
}

// Formats an item as short JSON text; to be freed.
static char *shown(const cJSON *item) {
  enum { MOST = 100 };
  char *text = cJSON_PrintUnformatted(item);
  if (!text) return strdup("?");
  if (strlen(text) > MOST) memcpy(text + MOST - 3, "...", 4);
  return text;
}

static bool differ_items(Check *c, const cJSON *expect, const cJSON *found) {
  char *a = shown(expect), *b = shown(found);
  differ(c, "expected %s, found %s", a, b);
  free(a);
  free(b);
  return false;
}

static bool near(const Check *c, double expected, double found) {
  return fabs(found - expected) <= c->tolerance * fmax(1, fabs(expected));
}

static bool compare(Check *c, const cJSON *expect, const cJSON *found, bool turn);

// Appends the name or index to `path` during the comparison.
static bool compare_at(Check *c, const char *name, int index, const cJSON *expect,
                       const cJSON *found, bool turn) {
  size_t n = strlen(c->path);
  if (name) snprintf(c->path + n, sizeof c->path - n, "%s%s", n ? "." : "", name);
  else snprintf(c->path + n, sizeof c->path - n, "[%d]", index);
  bool good = compare(c, expect, found, turn);
  c->path[n] = 0;
  return good;
}

static bool compare_list(Check *c, const cJSON *expect, const cJSON *found, bool turn) {
  if (cJSON_GetArraySize(expect) != cJSON_GetArraySize(found))
    return differ(c, "expected %d elements, found %d", cJSON_GetArraySize(expect),
                  cJSON_GetArraySize(found));
  int i = 0;
  for (const cJSON *e = expect->child, *f = found->child; e; e = e->next, f = f->next, i++)
    if (!compare_at(c, NULL, i, e, f, turn)) return false;
  return true;
}

static bool compare_record(Check *c, const cJSON *expect, const cJSON *found, bool turn) {
  const cJSON *e;
  cJSON_ArrayForEach(e, expect) {
    const cJSON *f = cJSON_GetObjectItemCaseSensitive(found, e->string);
    if (!f) return differ(c, "the field `%s` is missing", e->string);
    if (!compare_at(c, e->string, 0, e, f, turn)) return false;
  }
  return true;
}

static bool compare(Check *c, const cJSON *expect, const cJSON *found, bool turn) {
  if (cJSON_IsArray(expect) && cJSON_IsArray(found)) return compare_list(c, expect, found, turn);
  if (cJSON_IsObject(expect) && cJSON_IsObject(found))
    return compare_record(c, expect, found, turn);
  bool good = false;
  if (cJSON_IsNumber(expect) && cJSON_IsNumber(found)) {
    double e = expect->valuedouble, f = found->valuedouble;
    good = near(c, e, f) || (turn && near(c, 0, remainder(f - e, 360)));
  } else if (cJSON_IsString(expect) && cJSON_IsString(found)) {
    good = strcmp(expect->valuestring, found->valuestring) == 0;
  } else if (cJSON_IsBool(expect) && cJSON_IsBool(found)) {
    good = cJSON_IsTrue(expect) == cJSON_IsTrue(found);
  } else {
    good = cJSON_IsNull(expect) && cJSON_IsNull(found);
  }
  return good || differ_items(c, expect, found);
}

// Compares lists of numbers that are equal up to a factor: divides each by its element at the
// position of the largest expected one.
static bool compare_factor(Check *c, const cJSON *expect, const cJSON *found) {
  if (!cJSON_IsArray(expect) || !cJSON_IsArray(found) ||
      cJSON_GetArraySize(expect) != cJSON_GetArraySize(found))
    return differ_items(c, expect, found);
  const cJSON *pivot = NULL, *same = NULL, *e, *f;
  for (e = expect->child, f = found->child; e; e = e->next, f = f->next) {
    if (cJSON_IsArray(e)) {
      if (!compare_factor(c, e, f)) return false;
      continue;
    }
    if (!cJSON_IsNumber(e) || !cJSON_IsNumber(f)) return differ_items(c, expect, found);
    if (pivot && fabs(e->valuedouble) <= fabs(pivot->valuedouble)) continue;
    pivot = e;
    same = f;
  }
  if (!pivot || pivot->valuedouble == 0) return true;
  if (same->valuedouble == 0) return differ_items(c, expect, found);
  for (e = expect->child, f = found->child; e; e = e->next, f = f->next)
    if (!near(c, e->valuedouble / pivot->valuedouble, f->valuedouble / same->valuedouble))
      return differ_items(c, expect, found);
  return true;
}

static bool compare_element(Check *c, Rule rule, const cJSON *expect, const cJSON *found) {
  if (rule == FACTOR_ORDER) return compare_factor(c, expect, found);
  return compare(c, expect, found, rule == ANY_ORDER_TURN);
}

// Assigns to each expected element the first equal found element that is not yet assigned.
static bool compare_order(Check *c, Rule rule, const cJSON *expect, const cJSON *found) {
  if (!cJSON_IsArray(expect) || !cJSON_IsArray(found)) return differ_items(c, expect, found);
  int n = cJSON_GetArraySize(found);
  if (rule != SOME_OF && cJSON_GetArraySize(expect) != n) return differ_items(c, expect, found);
  bool *taken = calloc((size_t)n + 1, sizeof *taken), good = taken != NULL;
  for (const cJSON *e = expect->child; good && e; e = e->next) {
    int i = 0;
    const cJSON *f = found->child;
    for (; f; f = f->next, i++)
      if (!taken[i] && compare_element(c, rule, e, f)) break;
    good = f != NULL;
    if (good) taken[i] = true;
  }
  free(taken);
  return good || differ_items(c, expect, found);
}

static bool compare_vector(Check *c, const char *kind, const cJSON *expect, const cJSON *found) {
  if (!cJSON_IsObject(expect)) return compare(c, expect, found, false);
  if (!cJSON_IsObject(found)) return differ_items(c, expect, found);
  const cJSON *e;
  cJSON_ArrayForEach(e, expect) {
    const cJSON *f = cJSON_GetObjectItemCaseSensitive(found, e->string);
    if (!f) return differ(c, "the field `%s` is missing", e->string);
    snprintf(c->path, sizeof c->path, "%s", e->string);
    bool good;
    Rule rule = rule_of(kind, e->string);
    if (rule == UP_TO_FACTOR) good = compare_factor(c, e, f);
    else if (rule >= ANY_ORDER && rule != MODULO_TURN) good = compare_order(c, rule, e, f);
    else good = compare(c, e, f, rule == MODULO_TURN);
    c->path[0] = 0;
    if (!good) return false;
  }
  return true;
}

// --- A session for a file ---

typedef struct File {
  CagSession *session;
  FILE *out;
  char *bytes; // output
  size_t size;
} File;

// Runs a text and returns its output (to be freed), or NULL with the reason in `problem`.
static char *ask(File *f, const char *text, char *problem, size_t size) {
  fflush(f->out);
  size_t before = f->size;
  int status = cag_session_input(f->session, text, strlen(text), NULL, NULL);
  fflush(f->out);
  if (status == CAG_STATUS_OK) return strdup(f->bytes + before);
  CagErrorView view = {0};
  if (cag_session_error_count(f->session) > 0) cag_session_error(f->session, 0, &view);
  snprintf(problem, size, "%s (%s%s%s:%zu)", view.message ? view.message : "the session failed",
           view.code ? view.code : "?", view.file ? ", " : "", view.file ? view.file : "",
           view.line);
  return NULL;
}

static bool wants_error(const cJSON *expect) {
  const cJSON *error = cJSON_GetObjectItemCaseSensitive(expect, "error");
  const cJSON *status = cJSON_GetObjectItemCaseSensitive(expect, "status");
  return (error && !cJSON_IsFalse(error) && !cJSON_IsNull(error)) ||
         (cJSON_IsString(status) && strcmp(status->valuestring, "error") == 0);
}

// The script stopped, which is correct if an error is expected, and has the expected reason if
// there is one.
static bool check_stop(Check *c, const cJSON *expect, const cJSON *stopped) {
  const cJSON *reason = cJSON_GetObjectItemCaseSensitive(stopped, "reason");
  const char *message = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(stopped, "message"));
  if (!wants_error(expect)) return differ(c, "stopped: %s", message ? message : "?");
  const cJSON *wanted = cJSON_GetObjectItemCaseSensitive(expect, "reason");
  if (!cJSON_IsString(wanted)) return true;
  if (cJSON_IsString(reason) && strcmp(reason->valuestring, wanted->valuestring) == 0) return true;
  return differ(c, "expected the error %s, found %s: %s", wanted->valuestring,
                cJSON_IsString(reason) ? reason->valuestring : "one without a reason",
                message ? message : "?");
}

static bool run_vector(File *f, const cJSON *vector, size_t i, Check *c) {
  const cJSON *expect = cJSON_GetObjectItemCaseSensitive(vector, "expect");
  const char *kind = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(vector, "kind"));
  const cJSON *tolerance = cJSON_GetObjectItemCaseSensitive(vector, "tolerance");
  if (!kind || !expect) return differ(c, "it has no `kind` or no `expect`");
  c->tolerance = cJSON_IsNumber(tolerance) ? tolerance->valuedouble : USUAL_TOLERANCE;
  char text[1024];
  snprintf(
      text, sizeof text,
      "print if vectors[%zu].kind in kinds.kinds then\n"
      "  attempt(() => json({value: (kinds.kinds[vectors[%zu].kind])(given_of(vectors[%zu]))}),\n"
      "    err => json({stopped: {reason: err.reason, message: "
      "err.message}}))\n"
      "else json({unknown: true})\n",
      i, i, i);
  char *line = ask(f, text, c->problem, sizeof c->problem);
  if (!line) return false;
  cJSON *result = cJSON_Parse(line);
  free(line);
  const cJSON *value = cJSON_GetObjectItemCaseSensitive(result, "value");
  const cJSON *stopped = cJSON_GetObjectItemCaseSensitive(result, "stopped");
  bool good;
  if (!result) good = differ(c, "cannot be read back");
  else if (stopped) good = check_stop(c, expect, stopped);
  else if (value) good = compare_vector(c, kind, expect, value);
  else good = differ(c, "kinds.cag has no function for this kind");
  cJSON_Delete(result);
  return good;
}

static char *read_whole(const char *path) {
  FILE *in = fopen(path, "rb");
  char *bytes = NULL;
  size_t size = 0;
  FILE *out = in ? open_memstream(&bytes, &size) : NULL;
  char part[4096];
  for (size_t n; out && (n = fread(part, 1, sizeof part, in)) > 0;) fwrite(part, 1, n, out);
  if (out) fclose(out);
  if (in) fclose(in);
  return bytes;
}

static bool start(File *f, const char *kinds_folder, const char *path, const char *folder,
                  char *problem, size_t size) {
  const char *folders[] = {kinds_folder, folder};
  CagSessionOptions options;
  cag_session_options_init(&options);
  options.module_path = folders;
  options.module_path_count = 2;
  options.max_time = LONGEST;
  f->out = open_memstream(&f->bytes, &f->size);
  options.out = f->out;
  f->session = f->out ? cag_session_new(&options) : NULL;
  snprintf(problem, size, "no session");
  if (!f->session) return false;
  char *text;
  cJSON *name = cJSON_CreateString(path); // the path as a text of the language
  char *quoted = name ? cJSON_PrintUnformatted(name) : NULL;
  int n = asprintf(&text,
                   "import kinds\nfile = read_json(%s)\n"
                   "vectors = if type_of(file) == \"list\" then file else file.vectors\n"
                   "given_of(v) = if \"t\" in v.expect and \"points\" in v.expect\n"
                   "  then {t: v.expect.t, ...get(v, \"given\", {})}\n"
                   "  else if \"test_points\" in v.expect\n"
                   "  then {test_points: v.expect.test_points, ...get(v, \"given\", {})}\n"
                   "  else get(v, \"given\", {})\n"
                   "print len(vectors)\n",
                   quoted ? quoted : "\"\"");
  char *answer = n < 0 ? NULL : ask(f, text, problem, size);
  if (n >= 0) free(text);
  free(quoted);
  cJSON_Delete(name);
  free(answer);
  return answer != NULL;
}

static void run_file(const char *kinds_folder, const char *path, size_t *passed, size_t *failed) {
  char real[PATH_MAX], folder[PATH_MAX], problem[512];
  char *bytes = realpath(path, real) ? read_whole(real) : NULL;
  cJSON *file = bytes ? cJSON_Parse(bytes) : NULL;
  free(bytes);
  const cJSON *vectors =
      cJSON_IsArray(file) ? file : cJSON_GetObjectItemCaseSensitive(file, "vectors");
  if (!cJSON_IsArray(vectors)) {
    printf("FAIL %s: cannot be read as a file of vectors\n", path);
    (*failed)++;
    cJSON_Delete(file);
    return;
  }
  snprintf(folder, sizeof folder, "%s", real);
  File f = {0};
  bool started = start(&f, kinds_folder, real, dirname(folder), problem, sizeof problem);
  if (!started) printf("FAIL %s: %s\n", path, problem);
  if (!started && !vectors->child) (*failed)++;
  size_t i = 0;
  const cJSON *vector;
  cJSON_ArrayForEach(vector, vectors) {
    Check c = {0};
    const char *id = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(vector, "id"));
    const char *kind = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(vector, "kind"));
    bool good = started && run_vector(&f, vector, i++, &c);
    if (good) (*passed)++;
    else (*failed)++;
    if (started && !good) printf("FAIL %s (%s): %s\n", id ? id : "?", kind ? kind : "?", c.problem);
  }
  if (f.session) cag_session_free(f.session);
  if (f.out) fclose(f.out);
  free(f.bytes);
  cJSON_Delete(file);
}

int main(int argc, char **argv) {
  if (argc < 3) {
    fprintf(stderr, "usage: %s KINDS_FOLDER FILE.json ...\n", argv[0]);
    return CAG_STATUS_USAGE;
  }
  size_t passed = 0, failed = 0;
  for (int i = 2; i < argc; i++) run_file(argv[1], argv[i], &passed, &failed);
  printf("%zu passed, %zu failed, 0 skipped\n", passed, failed);
  return failed ? 1 : 0;
}
