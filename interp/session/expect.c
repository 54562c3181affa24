// Scripts as tests: running them and comparing the results with the plans of expect_plan.h.

#include "interp/session/expect.h"

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
#include "interp/render/povray.h"
#include "interp/session/expect_image.h"
#include "interp/session/expect_plan.h"
#include "interp/session/session.h"

void cag_test_options_init(CagTestOptions *o) {
  *o = (CagTestOptions){0};
  cag_session_options_init(&o->session);
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
  CagTestPlan *plan;
  const CagTestPlans *plans; // in the first run of a script: other results of reading it
  bool pictured;             // the reference picture, if there is one, belongs to this run
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
static bool meets(const Run *r, const CagErrorView *error, const CagTestExpected *e) {
  size_t n = (size_t)(e->text.end - e->text.start);
  if (e->met || !e->is_error || strlen(error->code) != n || memcmp(error->code, e->text.start, n))
    return false;
  bool here = error->file && strcmp(error->file, r->path) == 0;
  return !here || error->line == e->line || (e->alone && r->plan->options);
}

// The expectation that the error meets, or NULL.
static CagTestExpected *expectation_of(const Run *r, const CagErrorView *error) {
  for (size_t i = 0; i < r->plan->count; i++)
    if (meets(r, error, &r->plan->expected[i])) return &r->plan->expected[i];
  return NULL;
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
    CagTestExpected *expected = expectation_of(r, &e);
    if (expected) {
      expected->met = true;
      continue;
    }
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
    const CagTestExpected *e = &r->plan->expected[i];
    if (!e->is_error || e->met) continue;
    snprintf(message, sizeof message, "the expected error %.*s did not occur",
             (int)(e->text.end - e->text.start), e->text.start);
    fail(r, e->line, message, NULL, NULL, NULL);
  }
}

// Whether the run needs the helper program for exact solids, which is not here.
static bool lacks_kernel(const Run *r, const CagSession *s) {
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    if (strcmp(e.reason, "kernel-missing") == 0) return !expectation_of(r, &e);
  }
  return false;
}

// Compares the output line by line, and reports the first difference.
static void check_output(Run *r, const char *text, size_t size) {
  const char *at = text, *end = text + size;
  size_t last_line = r->plan->line;
  for (size_t i = 0; i < r->plan->count; i++) {
    const CagTestExpected *e = &r->plan->expected[i];
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
    CagTestPiece got = cag_test_trim((CagTestPiece){at, stop});
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
static char *image_path(const Run *r, CagTestPiece text) {
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
static void update_image(Run *r, CagSession *s, const CagTestExpected *e, const char *name,
                         const char *path) {
  CagImageOptions options;
  cag_image_options_init(&options);
  options.image = name;
  if (cag_session_export_image(s, path, NULL, &options) == CAG_STATUS_OK) return;
  char *errors = rendered_errors(s);
  fail(r, e->line, "the image cannot be written", NULL, NULL, errors);
  cag_free(errors);
}

static void check_image(Run *r, CagSession *s, const CagTestExpected *e) {
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

// How the picture is made: as the run says, else as the options of the test say.
static CagRenderOptions rendering_of(const Run *r) {
  CagRenderOptions o = r->plan->rendering, usual;
  cag_render_options_init(&usual);
  if (!o.engine) o.engine = r->options->engine;
  if (!o.quality) o.quality = r->options->quality ? r->options->quality : usual.quality;
  return o;
}

// Whether the reference is a picture of POV-Ray, which nothing else can be compared with.
static bool needs_povray(const CagRenderOptions *o) {
  if (o->engine && strcmp(o->engine, "auto") != 0) return strcmp(o->engine, "povray") == 0;
  return strcmp(o->quality, "draft") != 0;
}

// Renders to `path` at the size of the reference. Returns false after a failure was reported.
static bool render(Run *r, CagSession *s, const CagImage *reference, const char *path) {
  CagRenderOptions options = rendering_of(r);
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
  double begin = cag_clock_seconds();
  CagImage reference;
  CagError err = {0};
  const CagRenderOptions rendering = rendering_of(r);
  const char *remark = NULL;
  r->failed = false;
  if (needs_povray(&rendering) && !cag_povray_find(NULL, 0, NULL, &err)) {
    end_run(r, CAG_TEST_SKIPPED, 0, err.message);
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

static bool expects_error(const CagTestPlan *p) {
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
    const CagTestMiss *miss = &r->plans->misses[i];
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
    if (status != CAG_STATUS_INTERRUPTED && !r->failed && lacks_kernel(r, s)) {
      end_run(r, CAG_TEST_SKIPPED, 0, "the program cag-brep is missing");
      status = CAG_STATUS_OK;
    } else if (status != CAG_STATUS_INTERRUPTED) {
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

static bool some_pictured(const CagTestPlans *plans) {
  for (size_t i = 0; i < plans->count; i++)
    if (plans->items[i].picture) return true;
  return false;
}

// Runs a script with all its runs. `text` is its text, even if the run reads the file.
static int run_plans(const Run *script, const char *text, size_t length) {
  CagTestPlans plans = {0};
  const CagTestOptions *options = script->options;
  int status = CAG_STATUS_OK;
  if (!cag_test_read_plans(text, length, &options->session, &plans)) status = CAG_STATUS_LIMIT;
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
  cag_test_free_plans(&plans);
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
