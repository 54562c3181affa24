// Runs the examples of the site, each in its own session, and makes their pictures.
//
// A picture shows what the example shows. If the example shows nothing, the picture shows the call
// of the documented function if that returns a shape or an image, or else the last one that the
// example defines. Images are written as they are, curves and regions of one plane become .svg, and
// all others are rendered. File names of pictures are derived from their contents, so that existing pictures need not be made again.

#include <pthread.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/memory.h"
#include "interp/scene/scene.h"
#include "interp/session/images.h"
#include "interp/session/session.h"
#include "interp/session/site.h"

// The time limit, in seconds, for an example, and for its picture.
#define SECONDS 120.0
// The name of examples in messages.
#define NAME "example.cag"
// The thickness of a drawing due to rounding, as a fraction of its width.
#define FLAT 1e-9

static bool is_same(const CagSiteExample *e, const char *folder, const char *text, size_t length) {
  return strlen(e->text) == length && strncmp(e->text, text, length) == 0 &&
         (folder && e->folder ? strcmp(folder, e->folder) == 0 : !folder && !e->folder);
}

const CagSiteExample *cag_site_example(CagSite *s, const CagSiteSpot *spot, const char *text,
                                       size_t length) {
  for (size_t i = 0; i < s->count; i++)
    if (is_same(&s->examples[i], spot->folder, text, length)) return &s->examples[i];
  if (s->final) return NULL;
  if (!CAG_RESERVE(s->examples, s->capacity, s->count + 1)) cag_memory_leave();
  CagSiteExample *e = &s->examples[s->count++];
  *e = (CagSiteExample){.about = spot->about};
  e->text = cag_checked(cag_strndup(text, length));
  if (spot->function) e->function = cag_checked(cag_strdup(spot->function));
  if (spot->folder) e->folder = cag_checked(cag_strdup(spot->folder));
  return NULL;
}

// --- Sessions ---

static CagSession *open_session(const CagSite *site, const CagSiteExample *e, FILE *out,
                                FILE *messages) {
  CagSessionOptions options = site->options->session;
  options.folder = e->folder;
  options.out = out;
  options.messages = messages;
  if (options.max_time <= 0) options.max_time = SECONDS;
  return cag_session_new(&options);
}

typedef struct Type {
  char name[32];
} Type;

static void keep_type(void *context, const char *text, const char *type) {
  (void)text;
  snprintf(((Type *)context)->name, sizeof((Type *)context)->name, "%s", type);
}

// Returns the type of an expression in an interactive session, or "" if it fails.
static Type type_of(CagSession *s, const char *expression) {
  Type t = {""};
  if (cag_session_input(s, expression, strlen(expression), keep_type, &t) != CAG_STATUS_OK)
    t.name[0] = 0;
  return t;
}

// Tests whether an expression is a shape or an image, or a list of these.
static bool is_shape(CagSession *s, const char *expression, Type t) {
  static const char *const shapes[] = {"curve", "region", "surface", "solid",
                                       "mesh",  "group",  "image"};
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    if (strcmp(t.name, shapes[i]) == 0) return true;
  if (strcmp(t.name, "list") != 0) return false;
  char *first = cag_doc_text("(%s)[0]", expression);
  t = type_of(s, first);
  const bool shape = strcmp(t.name, "list") != 0 && is_shape(s, first, t);
  cag_free(first);
  return shape;
}

// --- The contents of pictures ---

// Returns the call of the function in the text, with balanced parentheses, allocated with malloc,
// or NULL.
static char *find_call(const char *text, const char *function) {
  const size_t n = strlen(function);
  for (const char *at = text; (at = strstr(at, function)); at += n) {
    const char before = at > text ? at[-1] : ' ';
    if (at[n] != '(' || before == '_' || before == '.' || (before >= 'a' && before <= 'z'))
      continue;
    int depth = 0;
    for (const char *end = at + n; *end; end++) {
      depth += (*end == '(') - (*end == ')');
      if (depth == 0) return cag_strndup(at, (size_t)(end + 1 - at));
    }
  }
  return NULL;
}

// Returns the last definition of the session that is a shape, as an expression, allocated with
// malloc.
static char *last_shape(CagSession *s) {
  size_t count = 0;
  while (cag_session_name(s, count, NULL, NULL)) count++;
  while (count-- > 0) {
    const char *name = cag_session_name(s, count, NULL, NULL);
    char *copy = cag_strdup(name);
    if (!copy) return NULL;
    const Type t = type_of(s, copy);
    char *posed = NULL;
    if (is_shape(s, copy, t)) return copy;
    if (strcmp(t.name, "robot") == 0) posed = cag_doc_text("posed(%s)", copy);
    cag_free(copy);
    if (posed) return posed;
  }
  return NULL;
}

// Returns the expression to show for an example that shows nothing, allocated with malloc, or NULL
// if it contains no shape.
static char *choose_shape(const CagSite *site, const CagSiteExample *e, FILE *out) {
  CagSession *s = open_session(site, e, out, out);
  char *call = e->function ? find_call(e->text, e->function) : NULL, *shape = NULL;
  if (s && cag_session_input(s, e->text, strlen(e->text), NULL, NULL) == CAG_STATUS_OK) {
    if (call && is_shape(s, call, type_of(s, call))) {
      shape = call;
      call = NULL;
    } else {
      shape = last_shape(s);
    }
  }
  cag_free(call);
  if (s) cag_session_free(s);
  return shape;
}

// Tests whether only curves and regions of one plane z = constant are shown.
static bool is_drawing(const CagScene *scene) {
  const CagBounds *b = &scene->bounds;
  bool drawn = scene->item_count > 0;
  for (size_t i = 0; i < scene->item_count; i++)
    drawn = drawn &&
            (scene->items[i].kind == CAG_ITEM_CURVE || scene->items[i].kind == CAG_ITEM_REGION);
  return drawn && b->max.z - b->min.z <= FLAT * (1 + b->max.x - b->min.x);
}

static char *picture_name(const char *text, const char *shape, const char *ending) {
  uint64_t h = cag_hash_text(CAG_HASH_START, CAG_VERSION);
  h = cag_hash_text(cag_hash_text(h, text), shape ? shape : "");
  return cag_doc_text("pictures/%016llx.%s", (unsigned long long)h, ending);
}

// Writes the image that a session shows.
static void make_preview(const CagSite *site, CagSession *s, CagSiteExample *e, const char *shape) {
  char *name = picture_name(e->text, shape, "png");
  char *path = cag_doc_text("%s/%s", site->folder, name);
  const int status = cag_session_write_preview(s, path, CAG_SITE_WIDTH, CAG_SITE_HEIGHT,
                                               &e->picture_width, &e->picture_height);
  if (status == CAG_STATUS_OK) e->picture = name;
  else cag_free(name);
  cag_free(path);
}

// Makes the picture of a session's scene unless it exists.
static void make_picture(const CagSite *site, CagSession *s, CagSiteExample *e, const char *shape) {
  CagShownCounts counts;
  if (cag_session_shows_image(s)) {
    make_preview(site, s, e, shape);
    return;
  }
  if (cag_session_scene(s, &counts) != CAG_STATUS_OK || counts.items == 0) return;
  e->picture_width = CAG_SITE_WIDTH;
  e->picture_height = CAG_SITE_HEIGHT;
  const bool drawing = is_drawing(&s->scene);
  char *name = picture_name(e->text, shape, drawing ? "svg" : "png");
  char *path = cag_doc_text("%s/%s", site->folder, name);
  int status = CAG_STATUS_OK;
  if (access(path, R_OK) != 0 && drawing) {
    status = cag_session_export(s, path, "svg");
  } else if (access(path, R_OK) != 0) {
    CagRenderOptions options;
    cag_render_options_init(&options);
    options.width = CAG_SITE_WIDTH;
    options.height = CAG_SITE_HEIGHT;
    options.quality = "draft";
    options.threads = 1;
    options.time_limit = SECONDS;
    status = cag_session_render(s, &options, path);
  }
  if (status == CAG_STATUS_OK) e->picture = name;
  else cag_free(name);
  cag_free(path);
}

static void picture(const CagSite *site, CagSession *ran, CagSiteExample *e, FILE *out) {
  CagShownCounts counts = {0};
  if (cag_session_shows_image(ran) ||
      (cag_session_scene(ran, &counts) == CAG_STATUS_OK && counts.items > 0)) {
    make_picture(site, ran, e, NULL);
    return;
  }
  char *shape = choose_shape(site, e, out);
  if (!shape) return;
  char *text = cag_doc_text("%s\nshow %s\n", e->text, shape);
  CagSession *s = open_session(site, e, out, out);
  if (s && cag_session_run_text(s, NAME, text, strlen(text)) == CAG_STATUS_OK)
    make_picture(site, s, e, shape);
  if (s) cag_session_free(s);
  cag_free(text);
  cag_free(shape);
}

// --- A run ---

// Tests whether a position of a script is in a line of documentation, which is not an expectation.
static bool is_documentation(const char *script, const char *at) {
  while (at > script && at[-1] != '\n') at--;
  return strncmp(at + strspn(at, " "), "///", 3) == 0;
}

// Compares the output with the `expect:` comments, in order. A script without them always passes.
static bool is_expected(const char *script, const char *output) {
  const char *line = output, *at = strstr(script, "// expect:");
  for (; at; at = strstr(at + 1, "// expect:")) {
    if (is_documentation(script, at)) continue;
    const char *want = at + strlen("// expect:");
    size_t n = strcspn(want, "\n"), m = strcspn(line, "\n");
    const char *got = line;
    if (!*line && n) return false;
    line += m + (line[m] == '\n');
    while (n && *want == ' ') want++, n--;
    while (n && want[n - 1] == ' ') n--;
    while (m && *got == ' ') got++, m--;
    while (m && got[m - 1] == ' ') m--;
    if (n != m || strncmp(want, got, n) != 0) return false;
  }
  return true;
}

// Tests whether a run failed because cag-brep is missing, unless the example expects that.
static bool lacks_kernel(const CagSession *s, const char *text) {
  for (size_t i = 0; i < cag_session_error_count(s); i++) {
    CagErrorView e;
    cag_session_error(s, i, &e);
    if (strcmp(e.reason, "kernel-missing") == 0) return !strstr(text, e.code);
  }
  return false;
}

static void drop_output(CagSiteExample *e) {
  cag_free(e->output);
  e->output = NULL;
}

static void run_example(const CagSite *site, CagSiteExample *e) {
  size_t length, told_length;
  char *told = NULL;
  FILE *out = open_memstream(&e->output, &length), *messages = open_memstream(&told, &told_length);
  FILE *quiet = fopen("/dev/null", "w");
  CagSession *s = out && messages && quiet ? open_session(site, e, out, messages) : NULL;
  if (!s) cag_memory_leave();
  const int status = cag_session_run_text(s, NAME, e->text, strlen(e->text));
  const bool fails = strstr(e->text, "// expect error:") != NULL;
  if (status != CAG_STATUS_OK) cag_session_write_diagnostics(s, CAG_STYLE_TEXT, out);
  fflush(out);
  e->unavailable = lacks_kernel(s, e->text);
  if (!e->unavailable &&
      (fails != (status != CAG_STATUS_OK) || (!fails && !is_expected(e->text, e->output))))
    e->failure = cag_strdup(e->output);
  fflush(messages);
  fwrite(told, 1, told_length, out); // output of trace
  if (status == CAG_STATUS_OK && !site->options->no_pictures) {
    s->options.out = s->options.messages = quiet; // geometry may call functions again
    picture(site, s, e, quiet);
  }
  cag_session_free(s);
  fclose(out);
  fclose(messages);
  fclose(quiet);
  if (e->unavailable) drop_output(e);
  cag_free(told);
}

// --- All examples ---

typedef struct Running {
  CagSite *site;
  pthread_mutex_t mutex;
  bool starved; // memory ran out for an example
} Running;

typedef struct OneExample {
  const CagSite *site;
  CagSiteExample *example;
} OneExample;

static void run_one(void *context) {
  const OneExample *one = context;
  run_example(one->site, one->example);
}

static void *work(void *context) {
  Running *r = context;
  CagSite *s = r->site;
  const volatile int *stop = s->options->session.interrupt;
  pthread_mutex_lock(&r->mutex);
  while (s->next < s->count && !r->starved && !(stop && *stop)) {
    OneExample one = {s, &s->examples[s->next++]};
    pthread_mutex_unlock(&r->mutex);
    const bool done = cag_memory_guard(run_one, &one);
    pthread_mutex_lock(&r->mutex);
    r->starved |= !done;
  }
  pthread_mutex_unlock(&r->mutex);
  return NULL;
}

void cag_site_run(CagSite *s) {
  const long processors = sysconf(_SC_NPROCESSORS_ONLN);
  size_t jobs = s->options->jobs ? s->options->jobs : processors > 0 ? (size_t)processors : 1;
  if (jobs > s->count) jobs = s->count;
  Running r = {.site = s};
  pthread_t *threads = cag_calloc(jobs + 1, sizeof *threads);
  if (!threads) cag_memory_leave();
  pthread_mutex_init(&r.mutex, NULL);
  size_t started = 0;
  while (started < jobs && pthread_create(&threads[started], NULL, work, &r) == 0) started++;
  if (started == 0) work(&r);
  for (size_t i = 0; i < started; i++) pthread_join(threads[i], NULL);
  pthread_mutex_destroy(&r.mutex);
  cag_free(threads);
  if (r.starved) cag_memory_leave();
}
