// cag render FILE -o OUT: renders a picture, the pictures of a film, or those of several cameras.
//
// The pictures of several cameras are made of one run of the script. Each frame of a film is a separate run of the script, with its own frame and frames. The first
// failure ends the command. Earlier frames remain complete.

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/frames.h"
#include "cli/progress.h"
#include "cli/tool.h"
#include "cli/views.h"
#include "cli/watch.h"

// A script from standard input is stored, because each frame runs it.
typedef struct {
  const char *path;
  char *text; // NULL: read from path
  size_t length;
} Script;

typedef struct {
  CagTool *tool;
  CagSession *session;
  Script script;
  CagRenderOptions options;
  CagProgress progress;
  double frames; // length of the film
} Film;

// --- The command line ---

static bool has_ending(const char *path, const char *ending) {
  const size_t n = strlen(path), m = strlen(ending);
  return n > m && path[n - m - 1] != '/' && !strcasecmp(path + n - m, ending);
}

static int check_ending(const CagTool *t) {
  static const char HELP[] = "pictures are .exr or .png; `cag export` writes meshes and scenes";
  const char *format = t->format;
  if (format && strcasecmp(format, "exr") != 0 && strcasecmp(format, "png") != 0)
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP, "unknown picture format '.%s'", format);
  if (!strcmp(t->output, "-"))
    return format ? CAG_STATUS_OK
                  : cag_tool_fail(t, CAG_STATUS_USAGE, "add --format exr or --format png",
                                  "standard output has no extension that determines the format");
  const char *ending = has_ending(t->output, ".exr")   ? "exr"
                       : has_ending(t->output, ".png") ? "png"
                                                       : NULL;
  if (!ending)
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP, "cannot render to '%s': expected .exr or .png",
                         t->output);
  if (format && strcasecmp(format, ending) != 0)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "omit --format, or change the extension",
                         "--format %s and the output '%s' contradict each other", format,
                         t->output);
  return CAG_STATUS_OK;
}

// Names of cameras become parts of file names.
static int check_view_names(const CagTool *t) {
  char name[CAG_VIEW_NAME_MAX], other[CAG_VIEW_NAME_MAX];
  for (const char *at = t->views; cag_views_next(&at, name);) {
    if (!*name || strchr(name, '/'))
      return cag_tool_fail(t, CAG_STATUS_USAGE, "name cameras, such as iso,front,top,right",
                           "--views '%s': expected names of cameras without a slash", t->views);
    for (const char *rest = at; cag_views_next(&rest, other);)
      if (!strcmp(name, other))
        return cag_tool_fail(t, CAG_STATUS_USAGE, NULL, "--views names `%s` twice", name);
  }
  return CAG_STATUS_OK;
}

static int check_views(const CagTool *t) {
  static const char HELP[] =
      "write the name of the camera as %s, such as vase.%s.png, and a % as %%";
  const int places = cag_views_places(t->output);
  const char *other = t->has_frames ? "--frames" : t->camera ? "--camera" : NULL;
  if (other)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "omit one of them",
                         "--views and %s cannot be combined", other);
  if (!strcmp(t->output, "-"))
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP,
                         "standard output cannot have the pictures of several cameras");
  if (places < 0)
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP,
                         "a %% in the output '%s' is not a placeholder for a camera", t->output);
  if (places == 0 && strchr(t->views, ','))
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP,
                         "all views would be written to the same output '%s'", t->output);
  return check_view_names(t);
}

static int check_pattern(const CagTool *t) {
  static const char HELP[] = "write the number as %04d, such as film.%04d.png, and a % as %%";
  const int places = cag_frames_places(t->output);
  if (t->views) return check_views(t);
  if (!t->has_frames && cag_views_places(t->output) > 0)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "add --views, such as --views iso,front,top,right",
                         "the output '%s' has a placeholder for a camera, but --views is not given",
                         t->output);
  if (!t->has_frames)
    return places <= 0 ? CAG_STATUS_OK
                       : cag_tool_fail(t, CAG_STATUS_USAGE, "add --frames, such as --frames 0..47",
                                       "the output '%s' has a placeholder for a frame number, but "
                                       "--frames is not given",
                                       t->output);
  if (places < 0 || places > 1)
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP,
                         places < 0
                             ? "a %% in the output '%s' is not a placeholder for a frame number"
                             : "the output '%s' has several placeholders for a frame number",
                         t->output);
  if (places == 0 && t->last_frame > t->first_frame)
    return cag_tool_fail(t, CAG_STATUS_USAGE, HELP,
                         "all frames would be written to the same output '%s'", t->output);
  return CAG_STATUS_OK;
}

// Determines the length of the film: B+1 for --frames A..B, unless -D frames=N is larger.
static int find_length(const CagTool *t, double *frames) {
  *frames = (double)t->last_frame + 1;
  for (size_t i = 0; i < t->define_count; i++) {
    const CagToolDefine *d = &t->defines[i];
    if (!strcmp(d->name, "frame") || !strcmp(d->name, "time"))
      return cag_tool_fail(t, CAG_STATUS_USAGE, "omit one of them",
                           "--frames sets `%s`, and so does -D", d->name);
    if (strcmp(d->name, "frames") != 0) continue;
    char *end;
    *frames = strtod(d->value, &end);
    if (end == d->value || *end || !(*frames >= 1) || *frames > INT_MAX ||
        *frames != (double)(long)*frames)
      return cag_tool_fail(t, CAG_STATUS_USAGE, "with --frames, give an integer, such as 96",
                           "-D frames=%s: expected the length of a film", d->value);
  }
  if (*frames > (double)t->last_frame) return CAG_STATUS_OK;
  return cag_tool_fail(t, CAG_STATUS_USAGE, "the frames of a film of N are 0..N-1",
                       "--frames %ld..%ld exceeds the film of %.0f frames", t->first_frame,
                       t->last_frame, *frames);
}

static int check(const CagTool *t, double *frames) {
  *frames = 1;
  if (!t->output)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "name the output with -o OUT, such as -o out.png",
                         "the output is missing");
  int status = check_ending(t);
  if (status == CAG_STATUS_OK) status = check_pattern(t);
  if (status == CAG_STATUS_OK && t->has_frames) status = find_length(t, frames);
  if (status == CAG_STATUS_OK && t->loop && !t->has_frames)
    status = cag_tool_fail(t, CAG_STATUS_USAGE, "add --frames, such as --frames 0..47",
                           "--loop applies to films, but --frames is missing");
  if (status == CAG_STATUS_OK && t->watch && t->keep_partial)
    status = cag_tool_fail(t, CAG_STATUS_USAGE, "omit one of them",
                           "--watch keeps the last complete picture, but --keep-partial does not");
  return status;
}

// --- Rendering ---

// Reads a script from standard input.
static bool read_input(Script *s) {
  size_t capacity = 0;
  char *text = NULL;
  s->length = 0;
  do {
    if (s->length == capacity) {
      capacity = capacity ? 2 * capacity : 65536;
      char *larger = realloc(text, capacity);
      if (!larger) break;
      text = larger;
    }
    s->length += fread(text + s->length, 1, capacity - s->length, stdin);
  } while (!feof(stdin) && !ferror(stdin));
  s->text = text;
  return text && feof(stdin);
}

static int run_script(Film *f) {
  const Script *s = &f->script;
  return s->text ? cag_session_run_text(f->session, "standard input", s->text, s->length)
                 : cag_session_run_file(f->session, s->path);
}

// Renders to standard output through a temporary file, whose extension determines the format.
static int render_to_output(Film *f) {
  const char *base = getenv("TMPDIR");
  char folder[PATH_MAX], path[PATH_MAX + 16], bytes[65536];
  snprintf(folder, sizeof folder, "%s/cag-output-XXXXXX", base && *base == '/' ? base : "/tmp");
  if (!mkdtemp(folder))
    return cag_tool_fail(f->tool, CAG_STATUS_FILE, "set TMPDIR to a folder that you may write to",
                         "cannot create the temporary file '%s'", folder);
  snprintf(path, sizeof path, "%s/out.%s", folder, f->tool->format);
  int status = cag_session_render(f->session, &f->options, path);
  FILE *picture = status == CAG_STATUS_OK ? fopen(path, "rbe") : NULL;
  size_t n;
  while (picture && (n = fread(bytes, 1, sizeof bytes, picture)) > 0)
    if (fwrite(bytes, 1, n, stdout) != n) break; // main.c reports it at the end
  if (picture) fclose(picture);
  unlink(path);
  rmdir(folder);
  return status;
}

static bool has_camera(CagSession *s, const char *name) {
  const char *one;
  for (size_t i = 0; (one = cag_standard_camera(i)); i++)
    if (!strcmp(one, name)) return true;
  for (size_t i = 0; (one = cag_session_camera(s, i)); i++)
    if (!strcmp(one, name)) return true;
  return false;
}

static void say_done(const Film *f, const char *path, double seconds) {
  cag_tool_say_tolerances(f->tool, f->session);
  cag_tool_say(f->tool, "wrote %s in %.1f s", path, seconds);
}

static int render_view(Film *f, const char *view) {
  const CagTool *t = f->tool;
  char path[PATH_MAX];
  const double begun = cag_clock_seconds();
  if (!cag_views_name(t->output, view, path, sizeof path))
    return cag_tool_fail(t, CAG_STATUS_FILE, NULL, "the name of the picture of %s is too long",
                         view);
  int status = cag_tool_check_place(t, path);
  if (status != CAG_STATUS_OK) return status;
  cag_tool_make_folder(path);
  f->options.camera = view;
  status = cag_session_render(f->session, &f->options, path);
  cag_progress_end(&f->progress);
  if (status == CAG_STATUS_OK && t->verbose) say_done(f, path, cag_clock_seconds() - begun);
  return status;
}

// Renders all views of one scene. An unknown one is found before the first is rendered.
static int render_views(Film *f) {
  const CagTool *t = f->tool;
  char name[CAG_VIEW_NAME_MAX];
  CagShownCounts counts;
  int status = run_script(f);
  fflush(stdout);
  if (status == CAG_STATUS_OK) status = cag_session_scene(f->session, &counts);
  const char *unknown = NULL;
  for (const char *at = t->views; status == CAG_STATUS_OK && !unknown && cag_views_next(&at, name);)
    if (!has_camera(f->session, name)) unknown = name;
  for (const char *at = unknown ? unknown : t->views;
       status == CAG_STATUS_OK && cag_views_next(&at, name);)
    status = render_view(f, name);
  return cag_tool_finish(f->tool, f->session, status);
}

static int render_frame(Film *f, long frame) {
  const CagTool *t = f->tool;
  char path[PATH_MAX];
  const double begun = cag_clock_seconds();
  snprintf(path, sizeof path, "%s", t->output);
  if (t->has_frames && !cag_frames_name(t->output, frame, path, sizeof path))
    return cag_tool_fail(t, CAG_STATUS_FILE, NULL, "the name of frame %ld is too long", frame);
  int status = cag_tool_check_place(t, path);
  if (status != CAG_STATUS_OK) return status;

  if (t->has_frames) cag_session_set_frame(f->session, (double)frame, f->frames);
  f->progress.frame = frame;
  status = run_script(f);
  fflush(stdout); // prints come before messages about the picture
  if (status == CAG_STATUS_OK) {
    cag_tool_make_folder(path);
    status =
        strcmp(path, "-") ? cag_session_render(f->session, &f->options, path) : render_to_output(f);
  }
  cag_progress_end(&f->progress);
  status = cag_tool_finish(f->tool, f->session, status);
  if (status == CAG_STATUS_OK && t->verbose) say_done(f, path, cag_clock_seconds() - begun);
  return status;
}

static int render_film(Film *f) {
  const CagTool *t = f->tool;
  if (!strcmp(f->script.path, "-") && t->last_frame > t->first_frame && !read_input(&f->script))
    return cag_tool_fail(t, CAG_STATUS_FILE, NULL, "cannot read standard input");
  if (t->views) return render_views(f);
  int status = CAG_STATUS_OK;
  for (long frame = t->first_frame; status == CAG_STATUS_OK && frame <= t->last_frame; frame++) {
    status = render_frame(f, frame);
    if (cag_tool_interrupt) status = CAG_STATUS_INTERRUPTED;
  }
  return status;
}

static int render_script(CagTool *t, CagSession *s, void *film) {
  Film *f = film;
  f->session = s;
  cag_session_set_loop(s, t->loop);
  cag_progress_begin(&f->progress, t);
  return render_film(f);
}

int cag_tool_render(CagTool *t, int argc, char **argv) {
  (void)argc;
  Film f = {.tool = t, .script = {.path = argv[0]}};
  int status = check(t, &f.frames);
  if (status != CAG_STATUS_OK) return status;
  if (!strcmp(t->output, "-")) t->session.out = stderr;
  cag_render_options_init(&f.options);
  f.options.width = t->width;
  f.options.height = t->height;
  f.options.camera = t->camera;
  f.options.samples = t->samples;
  f.options.engine = t->engine;
  f.options.passes = t->passes;
  f.options.keep_partial = t->keep_partial;
  f.options.exposure = t->exposure;
  f.options.progress = cag_progress_show;
  f.options.progress_context = &f.progress;
  if (t->quality) f.options.quality = t->quality;
  f.options.region = t->region;
  f.options.threads = t->threads;
  status = cag_tool_rounds(t, argv[0], render_script, &f);
  free(f.script.text);
  return status;
}
