// Scripts as tests: reading the expectations, running, and comparing.
//
// Expectations are read by scanning the script for comments and texts only, without parsing the
// language, because scripts with errors are tests, too. The scan makes a Plan for each run, with
// its options, the expected lines, and the expected errors.

#include "interp/session/expect.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/memory.h"
#include "interp/doc/doc.h"
#include "interp/render/compare.h"
#include "interp/render/exr.h"
#include "interp/render/png.h"
#include "interp/session/expect_image.h"
#include "interp/session/expect_near.h"
#include "interp/session/session.h"

void cag_test_options_init(CagTestOptions *o) {
  *o = (CagTestOptions){0};
  cag_session_options_init(&o->session);
}

// A part of the script's text.
typedef struct Piece {
  const char *start, *end;
} Piece;

typedef struct Expected {
  Piece text; // the line, the error's code, or the path of an image
  Piece name; // of the image; empty: the only one
  size_t line;
  bool is_error, is_image;
  bool alone; // nothing else is on the line
  bool met;
} Expected;

typedef struct Define {
  char *name, *value;
} Define;

typedef struct Plan {
  char *options; // as written after `run:`; NULL: the run without options
  size_t line;
  Define *defines;
  size_t define_count;
  CagSessionOptions limits;
  bool picture; // the reference picture belongs to this run
  Expected *expected;
  size_t count;
  char *problem; // with the options; NULL: none
} Plan;

// A comment that looks like an expectation.
typedef struct Miss {
  Piece text;
  const char *meant;
  size_t line;
} Miss;

typedef struct Plans {
  Plan *items;
  size_t count;
  Miss *misses;
  size_t miss_count;
  bool memory; // memory ran out
} Plans;

// --- Making plans ---

// Makes room for one more. Returns NULL if memory ran out.
static void *grow(void **array, size_t *count, size_t size) {
  char *larger = cag_realloc(*array, (*count + 1) * size);
  if (!larger) return NULL;
  *array = larger;
  void *item = larger + size * (*count)++;
  memset(item, 0, size);
  return item;
}

static void free_plans(Plans *plans) {
  for (size_t i = 0; i < plans->count; i++) {
    Plan *p = &plans->items[i];
    for (size_t k = 0; k < p->define_count; k++) cag_free(p->defines[k].name);
    cag_free(p->defines);
    cag_free(p->expected);
    cag_free(p->options);
    cag_free(p->problem);
  }
  cag_free(plans->items);
  cag_free(plans->misses);
}

static Plan *add_plan(Plans *plans, const CagSessionOptions *limits, size_t line) {
  Plan *p = grow((void **)&plans->items, &plans->count, sizeof *p);
  if (!p) {
    plans->memory = true;
    return NULL;
  }
  p->limits = *limits;
  p->line = line;
  return p;
}

static Piece trim(Piece p) {
  while (p.start < p.end && isspace((unsigned char)*p.start)) p.start++;
  while (p.end > p.start && isspace((unsigned char)p.end[-1])) p.end--;
  return p;
}

// Copies the next word of a line of options to `out` (which is as long as the line), without its
// quotes. Returns its end, or NULL if there is none.
static const char *next_word(const char *at, char *out) {
  while (isspace((unsigned char)*at)) at++;
  if (!*at) return NULL;
  char quote = 0;
  for (; *at && (quote || !isspace((unsigned char)*at)); at++) {
    if (quote && *at == quote) quote = 0;
    else if (!quote && (*at == '"' || *at == '\'')) quote = *at;
    else *out++ = *at;
  }
  *out = 0;
  return at;
}

static bool add_define(Plan *p, const char *word) {
  const char *equals = strchr(word, '=');
  if (!equals || equals == word) return false;
  Define *d = grow((void **)&p->defines, &p->define_count, sizeof *d);
  if (!d || !(d->name = cag_strdup(word))) {
    if (d) p->define_count--;
    return false;
  }
  d->name[equals - word] = 0;
  d->value = d->name + (equals - word) + 1;
  return true;
}

static bool set_limit(Plan *p, const char *name, const char *value) {
  char *end;
  double x = strtod(value, &end);
  if (end == value || *end || !(x > 0)) return false;
  if (!strcmp(name, "--max-depth")) p->limits.max_depth = (size_t)x;
  else if (!strcmp(name, "--max-memory")) p->limits.max_memory = (size_t)x;
  else if (!strcmp(name, "--max-triangles")) p->limits.max_triangles = (size_t)x;
  else if (!strcmp(name, "--max-time")) p->limits.max_time = x;
  else return false;
  return true;
}

static void set_problem(Plan *p, const char *word) {
  static const char FORM[] =
      "`%s` is not an option of `// run:`; the options are -D name=value, --picture, --max-depth, --max-memory, --max-time, and --max-triangles";
  cag_free(p->problem);
  if (cag_asprintf(&p->problem, FORM, word) < 0) p->problem = NULL;
}

// Parses the options of `// run:` into the plan.
static void read_options(Plans *plans, Plan *p, Piece text) {
  p->options = cag_strndup(text.start, (size_t)(text.end - text.start));
  char *word = cag_malloc((size_t)(text.end - text.start) + 1);
  const char *at = p->options;
  if (!at || !word) plans->memory = true;
  while (at && word && (at = next_word(at, word))) {
    char *name = cag_strdup(word);
    bool ok = name != NULL;
    if (ok && !strncmp(name, "-D", 2) && name[2]) ok = add_define(p, name + 2);
    else if (ok && !strcmp(name, "--picture")) p->picture = true;
    else if (ok) {
      const char *value = next_word(at, word);
      ok = value && (!strcmp(name, "-D") ? add_define(p, word) : set_limit(p, name, word));
      if (ok) at = value;
    }
    if (!ok) set_problem(p, name ? name : word);
    cag_free(name);
    if (!ok) break;
  }
  cag_free(word);
}

// --- Reading the script ---

typedef struct Reader {
  const char *start, *end; // of the script
  size_t line;             // of the current byte
  const char *line_start;
  const CagSessionOptions *limits;
  Plans *plans;
} Reader;

static bool begins_with(Piece p, const char *word, Piece *rest) {
  size_t n = strlen(word);
  if ((size_t)(p.end - p.start) < n || memcmp(p.start, word, n) != 0) return false;
  *rest = trim((Piece){p.start + n, p.end});
  return true;
}

// The rest of a text that begins with a word, with its blanks.
static Piece after(Piece p, const char *word) { return (Piece){p.start + strlen(word), p.end}; }

static void add_expected(Reader *r, Piece text, bool is_error, bool alone) {
  if (r->plans->count == 0 && !add_plan(r->plans, r->limits, 0)) return;
  Plan *p = &r->plans->items[r->plans->count - 1];
  Expected *e = grow((void **)&p->expected, &p->count, sizeof *e);
  if (e) *e = (Expected){.text = text, .line = r->line, .is_error = is_error, .alone = alone};
  else r->plans->memory = true;
}

// Parses `E0201, E0203`: several errors of one line.
static void add_errors(Reader *r, Piece text, bool alone) {
  const char *at = text.start;
  while (at < text.end) {
    const char *from = at;
    while (at < text.end && isalnum((unsigned char)*at)) at++;
    if (at > from) add_expected(r, (Piece){from, at}, true, alone);
    else at++;
  }
}

// Parses `: depth.exr` or ` depth: depth.exr`, after `expect image`. False: it is something else.
static bool add_image(Reader *r, Piece text, bool alone) {
  const char *colon =
      text.start < text.end ? memchr(text.start, ':', (size_t)(text.end - text.start)) : NULL;
  if (!colon || (*text.start != ':' && !isspace((unsigned char)*text.start))) return false;
  add_expected(r, trim((Piece){colon + 1, text.end}), false, alone);
  const Plan *p = r->plans->count ? &r->plans->items[r->plans->count - 1] : NULL;
  if (r->plans->memory || !p || p->count == 0) return true;
  p->expected[p->count - 1].is_image = true;
  p->expected[p->count - 1].name = trim((Piece){text.start, colon});
  return true;
}

static void note_miss(Reader *r, Piece text) {
  const char *meant = cag_test_meant(text.start, (size_t)(text.end - text.start));
  if (!meant) return;
  Miss *miss = grow((void **)&r->plans->misses, &r->plans->miss_count, sizeof *miss);
  if (miss) *miss = (Miss){text, meant, r->line};
  else r->plans->memory = true;
}

// Reads the text after the `//` of a comment.
static void read_comment(Reader *r, Piece text, bool alone) {
  Piece rest;
  text = trim(text);
  if (begins_with(text, "expect error:", &rest)) {
    add_errors(r, rest, alone);
  } else if (begins_with(text, "expect image", &rest) &&
             add_image(r, after(text, "expect image"), alone)) {
    return;
  } else if (begins_with(text, "expect:", &rest)) {
    add_expected(r, rest, false, alone);
  } else if (begins_with(text, "run:", &rest)) {
    Plan *p = add_plan(r->plans, r->limits, r->line);
    if (p) read_options(r->plans, p, rest);
  } else {
    note_miss(r, text);
  }
}

// Reads the rest of a line with an unterminated text or comment.
static void read_broken_line(Reader *r, const char *at, const char *line_end) {
  Piece rest;
  for (; at + 2 <= line_end; at++)
    if (at[0] == '/' && at[1] == '/' &&
        begins_with(trim((Piece){at + 2, line_end}), "expect error:", &rest))
      add_errors(r, rest, false);
}

static const char *end_of_line(const Reader *r, const char *at) {
  const char *newline = memchr(at, '\n', (size_t)(r->end - at));
  return newline ? newline : r->end;
}

// Returns the position after the `*/` of the block comment at `at`, or NULL if it is unterminated.
// Block comments nest.
static const char *skip_block_comment(const char *at, const char *end) {
  size_t depth = 0;
  for (; at + 2 <= end; at++) {
    if (at[0] == '/' && at[1] == '*') {
      depth++;
      at++;
    } else if (at[0] == '*' && at[1] == '/') {
      at++;
      if (--depth == 0) return at + 1;
    }
  }
  return NULL;
}

static const char *skip_raw(const char *at, const char *end) {
  const char *close = memchr(at + 1, '`', (size_t)(end - at - 1));
  return close ? close + 1 : NULL;
}

// Returns the position after the closing quote of the text at `at`, or NULL if there is none on its
// line. The { } of a text contain expressions that may contain texts: `holes` counts the open
// braces in each enclosing text.
#define TEXT_NESTING 64
static const char *skip_text(const char *at, const char *line_end) {
  unsigned holes[TEXT_NESTING] = {0}, depth = 0;
  for (at++; at < line_end; at++) {
    const char c = *at;
    if (holes[depth] == 0) { // within the text
      if (c == '\\') at++;
      else if (c == '{') holes[depth] = 1;
      else if (c == '"' && depth == 0) return at + 1;
      else if (c == '"') depth--;
    } else if (c == '"') {
      if (++depth == TEXT_NESTING) return NULL;
      holes[depth] = 0;
    } else if (c == '{') {
      holes[depth]++;
    } else if (c == '}') {
      holes[depth]--;
    } else if (c == '`') {
      const char *behind = skip_raw(at, line_end);
      if (!behind) return NULL;
      at = behind - 1;
    }
  }
  return NULL;
}

static void count_lines(Reader *r, const char *from, const char *to) {
  for (; from < to; from++) {
    if (*from != '\n') continue;
    r->line++;
    r->line_start = from + 1;
  }
}

static bool is_blank(const char *from, const char *to) {
  while (from < to && isspace((unsigned char)*from)) from++;
  return from == to;
}

// Reads the comment or text at `at`, if there is one, and returns the next position.
static const char *read_at(Reader *r, const char *at) {
  const char *line_end = end_of_line(r, at), *behind;
  const bool two = at + 2 <= r->end;
  if (two && at[0] == '/' && at[1] == '/') {
    read_comment(r, (Piece){at + 2, line_end}, is_blank(r->line_start, at));
    return line_end;
  }
  if (two && at[0] == '/' && at[1] == '*') behind = skip_block_comment(at, r->end);
  else if (*at == '`') behind = skip_raw(at, r->end);
  else if (*at == '"') behind = skip_text(at, line_end);
  else return at + 1;
  if (behind) return behind;
  read_broken_line(r, at, line_end);
  return line_end;
}

static bool read_plans(const char *text, size_t length, const CagSessionOptions *limits,
                       Plans *plans) {
  Reader r = {.start = text,
              .end = text + length,
              .line = 1,
              .line_start = text,
              .limits = limits,
              .plans = plans};
  for (const char *at = text; at < r.end;) {
    const char *behind = read_at(&r, at);
    count_lines(&r, at, behind);
    at = behind;
  }
  if (plans->count == 0) add_plan(plans, limits, 0);
  return !plans->memory;
}

// --- A run ---

typedef struct Run {
  const CagTestOptions *options;
  CagTestCounts *counts;
  const char *path;   // shown in messages, and read if `text` is NULL
  const char *text;   // NULL: the file's
  size_t length;      // of the text
  const char *about;  // the definition whose documentation contains the example; NULL: a script
  size_t example;     // number among the examples of the definition, from 1
  const char *folder; // of an example: the folder of its script
  Plan *plan;
  const Plans *plans; // in the first run of a script: other results of reading it
  bool pictured;      // the reference picture, if there is one, belongs to this run
  char *name;
  bool failed;
} Run;

static void fail(Run *r, size_t line, const char *message, const char *expected, const char *got,
                 const char *detail) {
  r->failed = true;
  if (!r->options->failure) return;
  r->options->failure(r->options->context,
                      &(CagTestFailure){r->name, r->path, line, message, expected, got, detail});
}

static void end_run(Run *r, CagTestOutcome outcome, double seconds, const char *remark) {
  size_t *counts[] = {&r->counts->passed, &r->counts->failed, &r->counts->skipped};
  ++*counts[outcome];
  if (r->options->ended) r->options->ended(r->options->context, r->name, outcome, seconds, remark);
}

static char *rendered_errors(const CagSession *s) {
  char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  if (!f) return NULL;
  cag_session_write_diagnostics(s, CAG_STYLE_TEXT, f);
  fclose(f);
  return text;
}

// Tests whether a line expects the error. An error with a location in this script must be on that
// line. But in a run with options, a comment on a line of its own expects only the code, because
// such comments are after the script.
static bool meets(const Run *r, const CagErrorView *error, const Expected *e) {
  size_t n = (size_t)(e->text.end - e->text.start);
  if (e->met || !e->is_error || strlen(error->code) != n || memcmp(error->code, e->text.start, n))
    return false;
  bool here = error->file && strcmp(error->file, r->path) == 0;
  return !here || error->line == e->line || (e->alone && r->plan->options);
}

static bool is_expected(Run *r, const CagErrorView *error) {
  for (size_t i = 0; i < r->plan->count; i++) {
    if (!meets(r, error, &r->plan->expected[i])) continue;
    r->plan->expected[i].met = true;
    return true;
  }
  return false;
}

static void check_errors(Run *r, const CagSession *s) {
  bool all = true;
  size_t line = 0;
  char message[256];
  // Repeated errors with the same line or code, which have already been expected, are not reported
  // again.
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    if (is_expected(r, &e)) continue;
    if (all) {
      snprintf(message, sizeof message, "unexpected error: %s", e.code);
      line = e.file && strcmp(e.file, r->path) == 0 ? e.line : 0;
    }
    all = false;
  }
  if (!all) {
    char *errors = rendered_errors(s);
    fail(r, line, message, NULL, NULL, errors);
    cag_free(errors);
  }
  for (size_t i = 0; i < r->plan->count; i++) {
    const Expected *e = &r->plan->expected[i];
    if (!e->is_error || e->met) continue;
    snprintf(message, sizeof message, "the expected error %.*s did not occur",
             (int)(e->text.end - e->text.start), e->text.start);
    fail(r, e->line, message, NULL, NULL, NULL);
  }
}

// Compares the output line by line, and reports the first difference.
static void check_output(Run *r, const char *text, size_t size) {
  const char *at = text, *end = text + size;
  size_t last_line = r->plan->line;
  for (size_t i = 0; i < r->plan->count; i++) {
    const Expected *e = &r->plan->expected[i];
    if (e->is_error || e->is_image) continue;
    char *expected = cag_strndup(e->text.start, (size_t)(e->text.end - e->text.start));
    last_line = e->line;
    if (at == end) {
      fail(r, e->line, "the output ends before this line", expected, NULL, NULL);
      cag_free(expected);
      return;
    }
    const char *stop = memchr(at, '\n', (size_t)(end - at));
    if (!stop) stop = end;
    Piece got = trim((Piece){at, stop});
    bool same = expected && (size_t)(got.end - got.start) == strlen(expected) &&
                memcmp(got.start, expected, strlen(expected)) == 0;
    if (!same) {
      char *found = cag_strndup(got.start, (size_t)(got.end - got.start));
      fail(r, e->line, "the output is different", expected, found, NULL);
      cag_free(found);
      cag_free(expected);
      return;
    }
    cag_free(expected);
    at = stop < end ? stop + 1 : end;
  }
  if (at == end || last_line == r->plan->line) return; // a script without expected lines may print
  const char *stop = memchr(at, '\n', (size_t)(end - at));
  char *found = cag_strndup(at, (size_t)((stop ? stop : end) - at));
  fail(r, last_line, "there is more output than expected", NULL, found, NULL);
  cag_free(found);
}

// --- Images ---

// Returns the path of an expected image, which is relative to the script, or NULL if memory ran
// out.
static char *image_path(const Run *r, Piece text) {
  const char *slash = strrchr(r->path, '/');
  const int n = (int)(text.end - text.start);
  char *path = NULL;
  if (*text.start == '/') return cag_strndup(text.start, (size_t)n);
  const int made = r->folder
                       ? cag_asprintf(&path, "%s/%.*s", r->folder, n, text.start)
                       : cag_asprintf(&path, "%.*s%.*s", slash ? (int)(slash + 1 - r->path) : 0,
                                      r->path, n, text.start);
  return made < 0 ? NULL : path;
}

// Writes the expected image anew.
static void update_image(Run *r, CagSession *s, const Expected *e, const char *name,
                         const char *path) {
  CagImageOptions options;
  cag_image_options_init(&options);
  options.image = name;
  if (cag_session_export_image(s, path, NULL, &options) == CAG_STATUS_OK) return;
  char *errors = rendered_errors(s);
  fail(r, e->line, "the image cannot be written", NULL, NULL, errors);
  cag_free(errors);
}

static void check_image(Run *r, CagSession *s, const Expected *e) {
  char *path = image_path(r, e->text);
  const bool named = e->name.start < e->name.end;
  char *name = named ? cag_strndup(e->name.start, (size_t)(e->name.end - e->name.start)) : NULL;
  if (!path || (named && !name)) {
    fail(r, e->line, "there is not enough memory for the image", NULL, NULL, NULL);
  } else if (r->options->update) {
    update_image(r, s, e, name, path);
  } else {
    char *message = cag_test_image(s, name, path);
    if (!message || *message)
      fail(r, e->line, message ? message : "the image cannot be compared", NULL, NULL, NULL);
    cag_free(message);
  }
  cag_free(path);
  cag_free(name);
}

static void check_images(Run *r, CagSession *s) {
  for (size_t i = 0; i < r->plan->count; i++)
    if (r->plan->expected[i].is_image) check_image(r, s, &r->plan->expected[i]);
}

// --- Pictures ---

static bool ends_with(const char *path, const char *ending) {
  size_t n = strlen(path), k = strlen(ending);
  return n >= k && strcmp(path + n - k, ending) == 0;
}

// Returns the reference picture of the script, to be freed, or NULL.
static char *find_reference(const char *path) {
  static const char *const endings[] = {".exr", ".png"};
  size_t stem = strlen(path) - (ends_with(path, ".cag") ? 4 : 0);
  for (size_t i = 0; i < 2; i++) {
    char *reference;
    struct stat status;
    if (cag_asprintf(&reference, "%.*s%s", (int)stem, path, endings[i]) < 0) return NULL;
    if (stat(reference, &status) == 0 && S_ISREG(status.st_mode)) return reference;
    cag_free(reference);
  }
  return NULL;
}

static bool read_picture(const char *path, CagImage *out, CagError *err) {
  return ends_with(path, ".exr") ? cag_exr_read(path, out, NULL, err)
                                 : cag_png_read(path, out, err);
}

// Compares the rendered picture with the reference.
static bool compare_pictures(Run *r, const CagImage *reference, const char *reference_path,
                             const char *path) {
  CagImage image;
  CagCompareReport report;
  CagError err = {0};
  if (!read_picture(path, &image, &err)) {
    fail(r, 0, err.message, NULL, NULL, NULL);
    return false;
  }
  bool ok =
      cag_compare_images(reference, reference_path, &image, path, CAG_TEST_PIXEL, &report, &err);
  cag_image_free(&image);
  if (!ok) {
    fail(r, 0, err.message, NULL, NULL, NULL);
    return false;
  }
  double share = (double)report.differing_pixels / ((double)report.width * (double)report.height);
  ok = share <= CAG_TEST_PIXELS && (!report.has_color || report.delta_e_mean <= CAG_TEST_DELTA_E);
  if (!ok) {
    char *message = NULL;
    if (cag_asprintf(
            &message,
            "the picture differs from %s: the mean color difference is %.3g (limit %g), and %.3g%% of the pixels differ (limit %g%%); the picture is kept in %s",
            reference_path, report.delta_e_mean, CAG_TEST_DELTA_E, 100 * share,
            100 * CAG_TEST_PIXELS, path) < 0)
      message = NULL;
    fail(r, 0, message ? message : "the picture differs from its reference", NULL, NULL, NULL);
    cag_free(message);
  }
  cag_compare_report_free(&report);
  return ok;
}

// Renders to `path` at the size of the reference. Returns false after a failure was reported.
static bool render(Run *r, CagSession *s, const CagImage *reference, const char *path) {
  CagRenderOptions options;
  cag_render_options_init(&options);
  options.width = (int)reference->width;
  options.height = (int)reference->height;
  const double limit = r->options->session.max_time;
  options.time_limit = limit > 0 ? limit : CAG_TEST_PICTURE_SECONDS;
  s->options.max_time = options.time_limit; // making the scene's meshes is part of rendering
  cag_session_renew_time(s);
  if (cag_session_render(s, &options, path) == CAG_STATUS_OK) return true;
  char *errors = rendered_errors(s);
  fail(r, 0, "the scene cannot be rendered", NULL, NULL, errors);
  cag_free(errors);
  return false;
}

// Renders into a temporary folder, which is removed unless the picture differs.
static bool render_and_compare(Run *r, CagSession *s, const CagImage *reference,
                               const char *reference_path) {
  const char *root = getenv("TMPDIR"), *slash = strrchr(reference_path, '/');
  char *folder = NULL, *path = NULL;
  if (cag_asprintf(&folder, "%s/cag-test-XXXXXX", root && *root ? root : "/tmp") < 0) return false;
  bool ok = mkdtemp(folder) != NULL;
  if (!ok) fail(r, 0, "cannot create a folder for the picture", NULL, NULL, NULL);
  ok = ok && cag_asprintf(&path, "%s/%s", folder, slash ? slash + 1 : reference_path) >= 0;
  bool keep = false;
  if (ok) ok = render(r, s, reference, path);
  if (ok) {
    ok = compare_pictures(r, reference, reference_path, path);
    keep = !ok;
  }
  if (path && !keep) unlink(path);
  if (!keep) rmdir(folder);
  cag_free(path);
  cag_free(folder);
  return ok;
}

static int test_picture(Run *r, CagSession *s, const char *reference_path) {
  char version[256];
  double begin = cag_clock_seconds();
  CagImage reference;
  CagError err = {0};
  const char *remark = NULL;
  r->failed = false;
  if (!cag_find_povray(version, sizeof version)) {
    end_run(r, CAG_TEST_SKIPPED, 0, version);
    return CAG_STATUS_OK;
  }
  if (!read_picture(reference_path, &reference, &err)) {
    fail(r, 0, err.message, NULL, NULL, NULL);
  } else {
    bool ok = r->options->update ? render(r, s, &reference, reference_path)
                                 : render_and_compare(r, s, &reference, reference_path);
    if (ok && r->options->update) remark = "renewed";
    cag_image_free(&reference);
    if (!ok) r->failed = true;
  }
  const volatile int *interrupt = r->options->session.interrupt;
  if (interrupt && *interrupt) return CAG_STATUS_INTERRUPTED;
  end_run(r, r->failed ? CAG_TEST_FAILED : CAG_TEST_PASSED, cag_clock_seconds() - begin, remark);
  return CAG_STATUS_OK;
}

// --- Runs ---

static bool is_chosen(const Run *r) {
  return !r->options->filter || strstr(r->name, r->options->filter);
}

static CagSession *make_session(const Run *r, FILE *out) {
  CagSessionOptions options = r->plan->limits;
  options.out = out;
  options.folder = r->folder;
  if (!(options.max_time > 0)) options.max_time = CAG_TEST_SECONDS;
  CagSession *s = cag_session_new(&options);
  for (size_t i = 0; s && !r->about && i < r->options->define_count; i++)
    cag_session_define(s, r->options->define_names[i], r->options->define_values[i]);
  for (size_t i = 0; s && i < r->plan->define_count; i++)
    cag_session_define(s, r->plan->defines[i].name, r->plan->defines[i].value);
  return s;
}

static bool expects_error(const Plan *p) {
  for (size_t i = 0; i < p->count; i++)
    if (p->expected[i].is_error) return true;
  return false;
}

// The picture belongs to a run that succeeds.
static int test_reference(Run *r, CagSession *s) {
  const bool none = r->options->no_pictures || r->text || !r->pictured || expects_error(r->plan);
  char *reference = none ? NULL : find_reference(r->path);
  if (!reference) return CAG_STATUS_OK;
  char *name = r->name;
  int status = CAG_STATUS_OK;
  if (cag_asprintf(&r->name, "%s (picture)", name) < 0) r->name = NULL;
  if (!r->name) status = CAG_STATUS_LIMIT;
  else status = test_picture(r, s, reference);
  cag_free(r->name);
  r->name = name;
  cag_free(reference);
  return status;
}

static void report_misses(Run *r) {
  for (size_t i = 0; r->plans && i < r->plans->miss_count; i++) {
    const Miss *miss = &r->plans->misses[i];
    char message[160];
    const int shown = (int)(miss->text.end - miss->text.start);
    snprintf(message, sizeof message, "`// %.*s` expects nothing; write `// %s`",
             shown < 60 ? shown : 60, miss->text.start, miss->meant);
    fail(r, miss->line, message, NULL, NULL, NULL);
  }
}

static int perform(Run *r) {
  double begin = cag_clock_seconds();
  char *output = NULL;
  size_t size = 0;
  FILE *out = open_memstream(&output, &size);
  CagSession *s = out ? make_session(r, out) : NULL;
  int status = CAG_STATUS_LIMIT;
  if (s && r->plan->problem) {
    fail(r, r->plan->line, r->plan->problem, NULL, NULL, NULL);
    end_run(r, CAG_TEST_FAILED, 0, NULL);
    status = CAG_STATUS_OK;
  } else if (s) {
    report_misses(r);
    status = r->text ? cag_session_run_text(s, r->path, r->text, r->length)
                     : cag_session_run_file(s, r->path);
    fflush(out);
    if (status != CAG_STATUS_INTERRUPTED) {
      check_errors(r, s);
      // Output that is missing because of an error is not reported separately.
      if (!r->failed) check_output(r, output, size);
      if (!r->failed) check_images(r, s);
      bool ok = !r->failed;
      end_run(r, ok ? CAG_TEST_PASSED : CAG_TEST_FAILED, cag_clock_seconds() - begin, NULL);
      status = ok && status == CAG_STATUS_OK ? test_reference(r, s) : CAG_STATUS_OK;
    }
  }
  cag_session_free(s);
  if (out) fclose(out);
  cag_free(output);
  return status;
}

static char *run_name(const Run *r) {
  char *name, about[256] = "";
  const char *options = r->plan->options;
  if (r->about && r->example == 1) snprintf(about, sizeof about, ": example of %s", r->about);
  else if (r->about) snprintf(about, sizeof about, ": example %zu of %s", r->example, r->about);
  if (cag_asprintf(&name, "%s%s%s%s", r->path, about, options ? " " : "", options ? options : "") <
      0)
    return NULL;
  return name;
}

static bool some_pictured(const Plans *plans) {
  for (size_t i = 0; i < plans->count; i++)
    if (plans->items[i].picture) return true;
  return false;
}

// Runs a script with all its runs. `text` is its text, even if the run reads the file.
static int run_plans(const Run *script, const char *text, size_t length) {
  Plans plans = {0};
  const CagTestOptions *options = script->options;
  int status = CAG_STATUS_OK;
  if (!read_plans(text, length, &options->session, &plans)) status = CAG_STATUS_LIMIT;
  for (size_t i = 0; i < plans.count && status == CAG_STATUS_OK; i++) {
    Run r = *script;
    r.plan = &plans.items[i];
    r.plans = i == 0 ? &plans : NULL;
    r.pictured = some_pictured(&plans) ? r.plan->picture : !r.plan->options;
    r.name = run_name(&r);
    if (!r.name) status = CAG_STATUS_LIMIT;
    else if (is_chosen(&r)) status = perform(&r);
    cag_free(r.name);
  }
  free_plans(&plans);
  return status;
}

int cag_test_text(const char *name, const char *text, size_t length, const CagTestOptions *options,
                  CagTestCounts *counts) {
  const Run r = {
      .options = options, .counts = counts, .path = name, .text = text, .length = length};
  return run_plans(&r, text, length);
}

// --- Examples in the documentation of definitions ---

// Returns an example as a script in which everything is at the line and column of the file, so that
// failures are reported with their location in the file. Its imports come first.
static char *place_example(const CagDocEntry *e, size_t first, const char *part, size_t length,
                           const char *import, size_t *size) {
  char *text = NULL;
  FILE *out = open_memstream(&text, size);
  if (!out) return NULL;
  size_t at_line = 1, line = first;
  const char *at = part;
  for (; at_line + 1 < e->lines[first]; at_line++) fputc('\n', out);
  if (import) fprintf(out, "%s%s", import, at_line < e->lines[first] ? "" : ";");
  while (at < part + length) {
    for (; at_line < e->lines[line]; at_line++) fputc('\n', out);
    const size_t n = strcspn(at, "\n");
    fprintf(out, "%*s%.*s", (int)strlen("/// "), "", (int)n, at); // in place of the slashes
    at += n + (at[n] == '\n');
    line++;
  }
  fclose(out);
  return text;
}

// The parts of an example.
typedef struct Head {
  const CagDocModule *module;
  const char *file, *part;
  size_t length;
  char *example, *import; // import: NULL if it needs none
} Head;

static void read_head(void *context) {
  Head *h = context;
  h->example = cag_doc_part_text(h->part, h->length, true);
  h->import = cag_doc_script_import(h->module, h->file, h->example);
}

// Runs an example that starts at a line of the entry's text. `script` contains its number.
static int run_example(const Run *script, const CagDocModule *m, const CagDocEntry *e, size_t line,
                       const char *part, size_t length) {
  const char *slash = strrchr(script->path, '/');
  Run r = *script;
  Head head = {m, slash ? slash + 1 : script->path, part, length, NULL, NULL};
  const bool read = cag_memory_guard(read_head, &head);
  char *const example = head.example, *const import = head.import;
  char *folder =
      slash ? cag_strndup(script->path, slash == script->path ? 1 : (size_t)(slash - script->path))
            : cag_strdup(".");
  r.about = e->name;
  r.folder = folder;
  r.text = place_example(e, line, part, length, import, &r.length);
  const int status = read && r.text && folder ? run_plans(&r, r.text, r.length) : CAG_STATUS_LIMIT;
  cag_free((void *)(size_t)r.text);
  cag_free(folder);
  cag_free(import);
  cag_free(example);
  return status;
}

static int run_examples_of(const Run *script, const CagDocModule *m, const CagDocEntry *e) {
  int status = CAG_STATUS_OK;
  size_t line = 0, n;
  bool is_code;
  Run r = *script;
  for (const char *at = e->text; at && *at && status == CAG_STATUS_OK; at += n) {
    n = cag_doc_part(at, &is_code);
    if (is_code) {
      r.example++;
      status = run_example(&r, m, e, line, at, n);
    }
    for (size_t i = 0; i < n; i++) line += at[i] == '\n';
  }
  return status;
}

// Examples of a script with errors are not run, because the script's own run reports the errors.
static int run_examples(const Run *script, const char *text, size_t length) {
  if (!memmem(text, length, "///     ", 8)) return CAG_STATUS_OK;
  CagSession *s = cag_session_new(&script->options->session);
  CagDocModule m = {0};
  int status = s ? CAG_STATUS_OK : CAG_STATUS_LIMIT;
  if (s && cag_session_read_doc(s, script->path, text, length, &m) == CAG_STATUS_OK)
    for (size_t i = 0; i < m.count && status == CAG_STATUS_OK; i++)
      status = run_examples_of(script, &m, &m.entries[i]);
  cag_doc_module_free(&m);
  cag_session_free(s);
  return status;
}

static char *read_whole(const char *path, size_t *length) {
  FILE *f = fopen(path, "rb");
  if (!f) return NULL;
  char *text = NULL;
  size_t capacity = 0, n = 0;
  for (;;) {
    if (!CAG_RESERVE(text, capacity, n + 4096)) break;
    size_t k = fread(text + n, 1, capacity - n, f);
    if (k == 0) break;
    n += k;
  }
  bool ok = text && !ferror(f) && feof(f);
  fclose(f);
  *length = n;
  if (ok) return text;
  cag_free(text);
  return NULL;
}

int cag_test_file(const char *path, const CagTestOptions *options, CagTestCounts *counts) {
  size_t length;
  errno = 0;
  char *text = read_whole(path, &length);
  if (!text) {
    char message[256];
    snprintf(message, sizeof message, "cannot read the script: %s",
             errno ? strerror(errno) : "there is not enough memory");
    if (options->failure)
      options->failure(options->context,
                       &(CagTestFailure){.test = path, .file = path, .message = message});
    counts->failed++;
    return CAG_STATUS_FILE;
  }
  const Run r = {.options = options, .counts = counts, .path = path};
  int status = run_plans(&r, text, length);
  if (status == CAG_STATUS_OK) status = run_examples(&r, text, length);
  cag_free(text);
  return status;
}
