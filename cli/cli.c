// Parses the command line by tables.
//
// Options can be before, between, and after the operands, up to `--`. The first operand is the
// command. An option before it can be interpreted only after the command is known, so argv is
// parsed twice: once for the command, and once for the rest. Operands are moved to the front of
// argv.

#include "cli/cli.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/diagnostic.h"
#include "cli/params.h"
#include "cli/tiles.h"
#include "interp/render/image.h"

const CagToolCommand cag_tool_commands[CAG_TOOL_COMMAND_COUNT] = {
#define CAG_COMMAND(name, operands, least, most, summary, story, examples)                         \
  {#name, operands, summary, story, examples, least, most, cag_tool_##name},
#include "cli/commands.def"
#undef CAG_COMMAND
};

// --- Values of options ---

static bool reject(const CagTool *t, const char *help, const char *option, const char *value,
                   const char *problem) {
  if (t->refusal) {
    snprintf(t->refusal->message, sizeof t->refusal->message, "'%.100s': %.150s", value, problem);
    snprintf(t->refusal->help, sizeof t->refusal->help, "%s", help);
    return false;
  }
  cag_tool_fail(t, CAG_STATUS_USAGE, help, "%s '%s': %s", option, value, problem);
  return false;
}

// Parses a number that must be the whole text, except for an optional `suffix` (NULL: none).
static bool read_number(const char *text, const char *suffix, double *out) {
  char *end;
  if (!*text || strchr(" \t\n", *text)) return false;
  *out = strtod(text, &end);
  if (end != text && suffix && !strcasecmp(end, suffix)) end += strlen(end);
  return end != text && !*end && isfinite(*out);
}

// Parses an integer of plain digits. `end` is set to its end.
static bool read_whole(const char *text, const char **end, long *out) {
  char *stop;
  if (*text < '0' || *text > '9') return false;
  errno = 0;
  *out = strtol(text, &stop, 10);
  *end = stop;
  return errno == 0;
}

// The largest count that is accepted.
#define COUNT_MAX 1e15

static bool read_count(const CagTool *t, const char *option, const char *value, size_t *out) {
  double n;
  if (!read_number(value, NULL, &n) || n < 1 || n > COUNT_MAX || n != floor(n))
    return reject(t, "give a whole number of at least 1", option, value, "expected a count");
  *out = (size_t)n;
  return true;
}

static bool one_of(const CagTool *t, const char *option, const char *value,
                   const char *const *choices, size_t count, const char *help, size_t *index) {
  for (*index = 0; *index < count; ++*index)
    if (!strcmp(value, choices[*index])) return true;
  return reject(t, help, option, value, "unknown choice");
}

static bool set_output(CagTool *t, const char *value) {
  if (t->output) {
    cag_tool_fail(t, CAG_STATUS_USAGE, "run the command again for another output",
                  "-o is given twice: '%s' and '%s'", t->output, value);
    return false;
  }
  if (!*value)
    return reject(t, "name a file, or - for standard output", "-o", value, "expected a name");
  t->output = value;
  return true;
}

static bool set_format(CagTool *t, const char *value) {
  t->format = *value == '.' ? value + 1 : value;
  return true;
}

static bool set_size(CagTool *t, const char *value) {
  static const char HELP[] = "write width x height in pixels, such as 1280x720";
  long w, h;
  const char *at = value;
  if (!read_whole(at, &at, &w) || *at++ != 'x' || !read_whole(at, &at, &h) || *at)
    return reject(t, HELP, "--size", value, "expected a size");
  if (w < 1 || h < 1 || (size_t)w > CAG_IMAGE_SIDE_MAX || (size_t)h > CAG_IMAGE_SIDE_MAX)
    return reject(t, HELP, "--size", value, "width and height must be 1 to 131072 pixels");
  t->width = (int)w;
  t->height = (int)h;
  return true;
}

static bool set_quality(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"draft", "normal", "final"};
  size_t i;
  t->quality = value;
  return one_of(t, "--quality", value, CHOICES, 3, "choose draft, normal, or final", &i);
}

static bool set_camera(CagTool *t, const char *value) {
  t->camera = value;
  return true;
}

static bool set_frames(CagTool *t, const char *value) {
  static const char HELP[] = "write the first and the last frame, such as 0..47";
  const char *at = value;
  if (!read_whole(at, &at, &t->first_frame) || strncmp(at, "..", 2) ||
      !read_whole(at + 2, &at, &t->last_frame) || *at)
    return reject(t, HELP, "--frames", value, "expected a range of frames");
  if (t->last_frame < t->first_frame)
    return reject(t, HELP, "--frames", value, "the last frame comes before the first");
  if (t->last_frame >= INT_MAX)
    return reject(t, HELP, "--frames", value, "there are too many frames");
  t->has_frames = true;
  return true;
}

static bool set_image(CagTool *t, const char *value) {
  t->image = value;
  return true;
}

static bool set_range(CagTool *t, const char *value) {
  static const char HELP[] = "write the numbers that become black and white, such as 0..1";
  char low[64];
  const char *dots = strstr(value, "..");
  const size_t n = dots ? (size_t)(dots - value) : 0;
  if (n == 0 || n >= sizeof low) return reject(t, HELP, "--range", value, "expected a range");
  memcpy(low, value, n);
  low[n] = 0;
  if (!read_number(low, NULL, &t->range_low) || !read_number(dots + 2, NULL, &t->range_high))
    return reject(t, HELP, "--range", value, "expected a range");
  if (t->range_low >= t->range_high)
    return reject(t, HELP, "--range", value, "the start is not below the end");
  return t->has_range = true;
}

static bool set_bits(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"8", "16"};
  size_t i;
  if (!one_of(t, "--bits", value, CHOICES, 2, "there are 8 and 16", &i)) return false;
  t->bits = i == 0 ? 8 : 16;
  return true;
}

static bool set_exposure(CagTool *t, const char *value) {
  if (read_number(value, NULL, &t->exposure)) return true;
  return reject(t, "give a number of stops, such as 0.5 or -1", "--exposure", value,
                "expected a number");
}

static bool set_by_part(CagTool *t, const char *value) {
  (void)value;
  return t->by_part = true;
}

static bool set_passes(CagTool *t, const char *value) {
  t->passes = value;
  return true;
}

static bool set_engine(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"auto", "povray", "preview"};
  size_t i;
  t->engine = value;
  return one_of(t, "--engine", value, CHOICES, 3, "choose povray, preview, or auto", &i);
}

static bool set_pov_csg(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"auto", "native", "mesh"};
  size_t i;
  t->session.pov_csg = value;
  return one_of(t, "--pov-csg", value, CHOICES, 3, "choose auto, native, or mesh", &i);
}

static bool set_threshold(CagTool *t, const char *value) {
  if (read_number(value, NULL, &t->threshold) && t->threshold >= 0) return true;
  return reject(t, "give a number of at least 0, such as 0.01", "--threshold", value,
                "expected a number of at least 0");
}

static bool set_heatmap(CagTool *t, const char *value) {
  t->heatmap = value;
  return true;
}

static bool set_filter(CagTool *t, const char *value) {
  t->filter = value;
  return true;
}

// Makes room for one more item. Growing one by one is sufficient for command lines.
static void *grow(void *array, size_t count, size_t size) {
  void *larger = realloc(array, (count + 1) * size);
  if (larger) return larger;
  fputs("cag: out of memory\n", stderr);
  exit(CAG_STATUS_LIMIT);
}

static bool set_define(CagTool *t, const char *value) {
  const char *equals = strchr(value, '=');
  if (!equals || equals == value)
    return reject(t, "write -D name=value, such as -D height=200", "-D", value,
                  "expected NAME=VALUE");
  char *name = strndup(value, (size_t)(equals - value));
  t->defines = grow(t->defines, t->define_count, sizeof *t->defines);
  if (!name) return false;
  t->defines[t->define_count++] = (CagToolDefine){name, equals + 1};
  return true;
}

// Keeps the name and, behind it, the value.
static void add_define(void *context, const char *name, const char *value) {
  CagTool *t = context;
  const size_t n = strlen(name) + 1, m = strlen(value) + 1;
  char *copy = grow(NULL, n + m, 1);
  memcpy(copy, name, n);
  memcpy(copy + n, value, m);
  t->defines = grow(t->defines, t->define_count, sizeof *t->defines);
  t->defines[t->define_count++] = (CagToolDefine){copy, copy + n};
}

static bool set_params(CagTool *t, const char *value) {
  CagToolRefusal why;
  return cag_params_read(value, add_define, t, &why) ||
         reject(t, why.help, "--params", value, why.message);
}

static bool set_include(CagTool *t, const char *value) {
  const char **path = (const char **)(size_t)t->session.module_path;
  if (!*value) return reject(t, "name a folder", "-I", value, "expected a name");
  path = grow(path, t->session.module_path_count, sizeof *path);
  path[t->session.module_path_count++] = value;
  t->session.module_path = path;
  return true;
}

static bool set_tolerance(CagTool *t, const char *value) {
  if (read_number(value, "mm", &t->session.tolerance) && t->session.tolerance > 0) return true;
  return reject(t, "give a number of millimeters greater than 0, such as 0.05", "--tolerance",
                value, "expected a distance");
}

static bool set_max_memory(CagTool *t, const char *value) {
  static const char UNITS[] = "KMGT";
  char *end;
  const bool begins = (*value >= '0' && *value <= '9') || *value == '.';
  double bytes = begins ? strtod(value, &end) : 0;
  const char *unit = begins && *end ? strchr(UNITS, *end & ~0x20) : NULL;
  if (unit) {
    bytes = ldexp(bytes, 10 * (int)(unit - UNITS + 1));
    end++;
    if (!strcasecmp(end, "iB") || !strcasecmp(end, "B")) end += strlen(end);
  }
  if (!begins || *end || !(bytes >= 1) || bytes > COUNT_MAX)
    return reject(t, "give a number of bytes, or a number with K, M, G, or T, such as 512M",
                  "--max-memory", value, "expected a size");
  t->session.max_memory = (size_t)bytes;
  return true;
}

static bool set_max_time(CagTool *t, const char *value) {
  if (read_number(value, "s", &t->session.max_time) && t->session.max_time > 0) return true;
  return reject(t, "give a number of seconds greater than 0, such as 60", "--max-time", value,
                "expected a time");
}

static bool set_max_depth(CagTool *t, const char *value) {
  return read_count(t, "--max-depth", value, &t->session.max_depth);
}

static bool set_max_triangles(CagTool *t, const char *value) {
  return read_count(t, "--max-triangles", value, &t->session.max_triangles);
}

static bool set_diagnostics(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"text", "json"};
  size_t i;
  if (!one_of(t, "--diagnostics", value, CHOICES, 2, "choose text or json", &i)) return false;
  t->style = i == 1 ? CAG_STYLE_JSON : CAG_STYLE_TEXT;
  return true;
}

static bool set_color(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"auto", "always", "never"}; // in the order of CagToolColor
  size_t i;
  if (!one_of(t, "--color", value, CHOICES, 3, "choose auto, always, or never", &i)) return false;
  t->color = (CagToolColor)i;
  return true;
}

// Flags have no value.
static bool set_update(CagTool *t, const char *value) {
  (void)value;
  return t->update = true;
}

static bool set_jobs(CagTool *t, const char *value) {
  return read_count(t, "--jobs", value, &t->jobs);
}

static bool set_report(CagTool *t, const char *value) {
  t->report = value;
  return true;
}

static bool set_region(CagTool *t, const char *value) {
  static const char HELP[] =
      "write the width x height, and the offset from the left and the top, such as 640x360+640+0";
  long n[4];
  const char *at = value, *between = "x++";
  for (int i = 0; i < 4; i++) {
    if (!read_whole(at, &at, &n[i]) || n[i] > (long)CAG_IMAGE_SIDE_MAX || *at != between[i])
      return reject(t, HELP, "--region", value, "expected a region");
    at += i < 3;
  }
  if (n[0] < 1 || n[1] < 1) return reject(t, HELP, "--region", value, "the region is empty");
  t->region = (CagRenderRegion){(int)n[2], (int)n[3], (int)n[0], (int)n[1]};
  return true;
}

static bool set_threads(CagTool *t, const char *value) {
  size_t n = 0;
  if (!read_count(t, "--threads", value, &n)) return false;
  t->threads = n < INT_MAX ? (int)n : INT_MAX;
  return true;
}

static bool set_port(CagTool *t, const char *value) {
  size_t n = 0;
  if (!read_count(t, "--port", value, &n)) return false;
  if (n > 65535) return reject(t, "a port is 1 to 65535", "--port", value, "a port");
  t->port = (int)n;
  return true;
}

static bool set_no_open(CagTool *t, const char *value) {
  (void)value;
  return t->no_open = true;
}

static bool set_read_only(CagTool *t, const char *value) {
  (void)value;
  return t->read_only = true;
}

static bool set_views(CagTool *t, const char *value) {
  t->views = value;
  return *value || reject(t, "name cameras, such as iso,front,top,right", "--views", value,
                          "expected a list of cameras");
}

// z=10 removes what lies above z = 10, and -z=10 what lies below.
static bool set_section(CagTool *t, const char *value) {
  static const char AXES[] = "xyz";
  const char *at = value + (*value == '-'), *axis = *at ? strchr(AXES, *at) : NULL;
  double height;
  if (!axis || at[1] != '=' || !read_number(at + 2, "mm", &height))
    return reject(
        t,
        "write an axis and a position in millimeters, such as z=10, or -z=10 to remove the other side",
        "--section", value, "expected a plane");
  const double sign = *value == '-' ? -1 : 1;
  memset(t->section, 0, sizeof t->section);
  t->section[axis - AXES] = sign;
  t->section[3] = sign * height;
  return t->has_section = true;
}

static bool set_watch(CagTool *t, const char *value) {
  (void)value;
  return t->watch = true;
}

static bool set_interference(CagTool *t, const char *value) {
  (void)value;
  return t->interference = true;
}

static bool set_json(CagTool *t, const char *value) {
  (void)value;
  return t->json = true;
}

static bool set_samples(CagTool *t, const char *value) {
  size_t n = 0;
  const size_t most = 10000;
  if (!read_count(t, "--samples", value, &n)) return false;
  t->samples = (int)(n < most ? n : most);
  return true;
}

static bool set_loop(CagTool *t, const char *value) {
  (void)value;
  return t->loop = true;
}

static bool set_keep_partial(CagTool *t, const char *value) {
  (void)value;
  return t->keep_partial = true;
}

static bool set_progress(CagTool *t, const char *value) {
  (void)value;
  return t->progress = true;
}

static bool set_retries(CagTool *t, const char *value) {
  long n;
  if (!read_whole(value, &value, &n) || *value)
    return reject(t, "give a whole number, such as 2", "--retries", value, "expected a count");
  t->retries = (size_t)n;
  return true;
}

static bool set_fresh(CagTool *t, const char *value) {
  (void)value;
  return t->fresh = true;
}

static bool set_engine_queue(CagTool *t, const char *value) {
  static const char *const CHOICES[] = {"slurm"};
  size_t i;
  t->queue = value;
  return one_of(t, "--engine-queue", value, CHOICES, 1, "the only queue is slurm", &i);
}

static bool set_tiles(CagTool *t, const char *value) {
  int columns, lines;
  t->tiles = value;
  return cag_tiles_read(value, &columns, &lines) ||
         reject(t, "write columns x rows, such as 4x3; at most 64x64", "--tiles", value,
                "expected tiles");
}

static bool set_element(CagTool *t, const char *value) {
  long n;
  const char *end;
  t->element = value;
  return (read_whole(value, &end, &n) && !*end) ||
         reject(t, "it is the number of the array's task", "--element", value, "expected a number");
}

static bool set_html(CagTool *t, const char *value) {
  t->html = value;
  return true;
}

static bool set_playground(CagTool *t, const char *value) {
  t->playground = value;
  return true;
}

static bool set_check(CagTool *t, const char *value) {
  (void)value;
  return t->check = true;
}

static bool set_diff(CagTool *t, const char *value) {
  (void)value;
  return t->diff = true;
}

static bool set_no_pictures(CagTool *t, const char *value) {
  (void)value;
  return t->no_pictures = true;
}

static bool set_quiet(CagTool *t, const char *value) {
  (void)value;
  return t->quiet = true;
}

static bool set_verbose(CagTool *t, const char *value) {
  (void)value;
  return t->verbose = true;
}

static bool set_help(CagTool *t, const char *value) {
  (void)value;
  return t->wants_help = true;
}

static bool set_version(CagTool *t, const char *value) {
  (void)value;
  return t->wants_version = true;
}

#define ON(name) (1u << CAG_TOOL_##name)
#define ALL (~0u)
#define SCRIPTS                                                                                    \
  (ON(run) | ON(eval) | ON(export) | ON(render) | ON(test) | ON(repl) | ON(batch) | ON(measure) |  \
   ON(mcp) | ON(view) | ON(check))
const CagToolOption cag_tool_options[] = {
#define CAG_OPTION(id, letter, name, argument, commands, help)                                     \
  {#id, letter, name, argument, commands, help, set_##id},
#include "cli/options.def"
#undef CAG_OPTION
};
const size_t cag_tool_option_count = sizeof cag_tool_options / sizeof *cag_tool_options;

// --- Parsing ---

// An option as it is written in argv.
typedef struct {
  const CagToolOption *option; // NULL: unknown
  char shown[64];              // as the user wrote it: "--size", "-o"
  const char *value;           // after its = or its letter; NULL: none
} Given;

static bool takes(const CagToolCommand *c, const CagToolOption *o) {
  return o->commands >> (c - cag_tool_commands) & 1;
}

// Some options of different commands have one name; `command` may be NULL.
static Given find_long(const CagToolCommand *command, const char *word) {
  Given g = {0};
  const size_t n = strcspn(word + 2, "=");
  snprintf(g.shown, sizeof g.shown, "%.*s", (int)(n + 2), word);
  if (word[n + 2]) g.value = word + n + 3;
  for (size_t i = 0; i < cag_tool_option_count; i++) {
    const char *name = cag_tool_options[i].name;
    const CagToolOption *o = &cag_tool_options[i];
    if (!name || strlen(name) != n || strncmp(name, word + 2, n) != 0) continue;
    if (!g.option || (command && takes(command, o))) g.option = o;
  }
  return g;
}

// Returns the option with the letter at `at`. A value may follow directly: -Dname=value.
static Given find_short(const char *at) {
  Given g = {0};
  snprintf(g.shown, sizeof g.shown, "-%c", *at);
  for (size_t i = 0; i < cag_tool_option_count; i++)
    if (cag_tool_options[i].letter == *at) g.option = &cag_tool_options[i];
  if (g.option && g.option->argument && at[1]) g.value = at + 1 + (at[1] == '=');
  return g;
}

// Returns the name of an option of this command that is similar to what was written, or NULL.
static const char *nearest_option(const CagToolCommand *command, const char *shown) {
  const char *names[64];
  size_t count = 0;
  for (size_t i = 0; i < cag_tool_option_count; i++)
    if (cag_tool_options[i].name && takes(command, &cag_tool_options[i]))
      names[count++] = cag_tool_options[i].name;
  return strncmp(shown, "--", 2) ? NULL : cag_nearest_name(shown + 2, names, count);
}

static bool reject_option(const CagTool *t, const Given *g) {
  const char *nearest = nearest_option(t->command, g->shown);
  char help[256];
  const bool expression = t->command->run == cag_tool_eval;
  if (nearest) snprintf(help, sizeof help, "did you mean --%s?", nearest);
  else
    snprintf(help, sizeof help, "`cag %s --help` lists the options%s", t->command->name,
             expression ? "; an expression that begins with - comes after --" : "");
  cag_tool_fail(t, CAG_STATUS_USAGE, help,
                g->option ? "%s is an option of other commands" : "unknown option %s", g->shown);
  return false;
}

// Sets one option, whose value may be the next word. Returns the number of additional words used,
// or -1.
static int apply(CagTool *t, const Given *g, const char *next) {
  const CagToolOption *o = g->option;
  if (!o || !takes(t->command, o)) return reject_option(t, g), -1;
  if (!o->argument && g->value) {
    cag_tool_fail(t, CAG_STATUS_USAGE, NULL, "%s takes no value", g->shown);
    return -1;
  }
  // If a word such as --size follows, the value was forgotten.
  const bool missing = o->argument && !g->value && (!next || !strncmp(next, "--", 2));
  if (missing) {
    char help[128];
    snprintf(help, sizeof help, "write %s %s", g->shown, o->argument);
    cag_tool_fail(t, CAG_STATUS_USAGE, help, "%s needs a value", g->shown);
    return -1;
  }
  if (!o->set(t, g->value ? g->value : next)) return -1;
  return o->argument && !g->value;
}

// Sets the options of one word, which may be several letters in a row. Returns the count as above.
static int apply_word(CagTool *t, char *word, const char *next) {
  if (word[1] == '-') {
    const Given g = find_long(t->command, word);
    return apply(t, &g, next);
  }
  for (const char *at = word + 1; *at; at++) {
    const Given g = find_short(at);
    const int taken = apply(t, &g, next);
    if (taken != 0 || g.value) return taken;
  }
  return 0;
}

// A single - is standard input. A - that is not followed by a letter starts an expression: cag eval
// '-2^2'.
static bool is_option(const char *word) {
  const char c = word[0] == '-' ? word[1] : 0;
  return c == '-' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Tests whether this word is an option whose value is the next word.
static bool takes_next(const char *word) {
  if (word[1] == '-') {
    const Given g = find_long(NULL, word);
    return g.option && g.option->argument && !g.value;
  }
  for (const char *at = word + 1; *at; at++) {
    const Given g = find_short(at);
    if (g.option && g.option->argument) return !g.value;
  }
  return false;
}

// Returns the index of the first operand, which is the command, or argc if there is none.
static int find_command(int argc, char **argv) {
  for (int i = 1; i < argc; i++) {
    if (!strcmp(argv[i], "--")) return i + 1 < argc ? i + 1 : argc;
    if (!is_option(argv[i])) return i;
    i += takes_next(argv[i]);
  }
  return argc;
}

bool cag_tool_try(CagTool *t, const char *name, const char *value, CagToolRefusal *why) {
  for (size_t i = 0; i < cag_tool_option_count; i++) {
    const CagToolOption *o = &cag_tool_options[i];
    if (!o->name || strcmp(o->name, name) != 0) continue;
    *why = (CagToolRefusal){0};
    t->refusal = why;
    const bool taken = o->set(t, value);
    t->refusal = NULL;
    return taken;
  }
  return false;
}

static bool reject_command(CagTool *t, const char *word) {
  const char *names[CAG_TOOL_COMMAND_COUNT];
  char help[300];
  for (size_t i = 0; i < CAG_TOOL_COMMAND_COUNT; i++) names[i] = cag_tool_commands[i].name;
  const char *nearest = cag_nearest_name(word, names, CAG_TOOL_COMMAND_COUNT);
  const size_t n = strlen(word);
  t->command = NULL;
  if (n > 4 && !strcmp(word + n - 4, ".cag"))
    snprintf(help, sizeof help, "to run the script, write `cag run %.200s`", word);
  else if (nearest) snprintf(help, sizeof help, "did you mean `cag %s`?", nearest);
  else snprintf(help, sizeof help, "`cag --help` lists the commands");
  cag_tool_fail(t, CAG_STATUS_USAGE, help, "unknown command `%s`", word);
  return false;
}

static bool choose_command(CagTool *t, const char *word) {
  for (size_t i = 0; i < CAG_TOOL_COMMAND_COUNT; i++) {
    t->command = &cag_tool_commands[i];
    if (!strcmp(word, t->command->name)) return true;
  }
  return reject_command(t, word);
}

static bool check_operands(const CagTool *t, int count, char **operands) {
  const CagToolCommand *c = t->command;
  char help[128];
  snprintf(help, sizeof help, "write `cag %s %s`; `cag %s --help` shows examples", c->name,
           c->operands, c->name);
  if (count < c->least) {
    if (count)
      cag_tool_fail(t, CAG_STATUS_USAGE, help, "expected %s, found only '%s'", c->operands,
                    operands[0]);
    else cag_tool_fail(t, CAG_STATUS_USAGE, help, "%s is missing", c->operands);
    return false;
  }
  if (count > c->most) {
    cag_tool_fail(t, CAG_STATUS_USAGE, help, "unexpected argument '%s'", operands[c->most]);
    return false;
  }
  return true;
}

// Determines the style from --diagnostics, --color, and the terminal.
static void settle_style(CagTool *t) {
  const char *terminal = getenv("TERM"), *none = getenv("NO_COLOR");
  const bool colorful =
      isatty(STDERR_FILENO) && !(none && *none) && terminal && strcmp(terminal, "dumb") != 0;
  if (t->style == CAG_STYLE_JSON) return;
  if (t->color == CAG_TOOL_COLOR_ALWAYS || (t->color == CAG_TOOL_COLOR_AUTO && colorful))
    t->style = CAG_STYLE_COLOR;
}

bool cag_tool_read(CagTool *t, int argc, char **argv, int *operand_count) {
  *t = (CagTool){0};
  cag_session_options_init(&t->session);
  t->session.interrupt = &cag_tool_interrupt;

  // The command; without one, the REPL.
  const int command_at = find_command(argc, argv);
  t->command = &cag_tool_commands[CAG_TOOL_repl];
  if (command_at < argc && !choose_command(t, argv[command_at])) return false;

  // The options, and the rest of argv.
  int count = 0;
  bool options = true;
  for (int i = 1; i < argc; i++) {
    if (options && !strcmp(argv[i], "--")) {
      options = false;
    } else if (options && is_option(argv[i])) {
      const int taken = apply_word(t, argv[i], i + 1 < argc ? argv[i + 1] : NULL);
      if (taken < 0) return false;
      i += taken;
    } else if (i != command_at) {
      argv[count++] = argv[i];
    }
  }
  if (command_at == argc && (t->wants_help || t->wants_version)) t->command = NULL;
  settle_style(t);
  *operand_count = count;
  return t->wants_help || t->wants_version || check_operands(t, count, argv);
}

void cag_tool_release(CagTool *t) {
  for (size_t i = 0; i < t->define_count; i++) free((char *)(size_t)t->defines[i].name);
  free(t->defines);
  free((void *)(size_t)t->session.module_path);
}
