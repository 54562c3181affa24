// The `:` commands of the REPL. Unique prefixes are accepted: `:q`.

#include <ctype.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/diagnostic.h"
#include "cli/progress.h"
#include "cli/repl.h"

typedef enum Operand { NOTHING, MAYBE, NEEDED } Operand;

typedef void Perform(CagRepl *repl, char *operand);
static Perform show_help, show_doc, show_type, show_time, list_names, show_scene, hide, load,
    reload, save, edit, render, export_scene, clear, quit;

// In the order of :help.
static const struct Command {
  const char *name, *operand;
  Operand wants;
  bool file;
  Perform *perform;
  const char *story;
} commands[] = {
    {":help", "[NAME]", MAYBE, false, show_help, "this list, or what NAME is"},
    {":doc", "[NAME]", MAYBE, false, show_doc,
     "documentation of a function, a definition, a command, or an error code; without NAME, all functions"},
    {":type", "EXPR", NEEDED, false, show_type, "the type of a value"},
    {":time", "EXPR", NEEDED, false, show_time, "a value, and how long it took"},
    {":list", "", NOTHING, false, list_names, "the definitions"},
    {":scene", "", NOTHING, false, show_scene, "what is shown"},
    {":hide", "NAME", NEEDED, false, hide, "remove what `show NAME` shows from the scene"},
    {":load", "FILE", NEEDED, true, load, "add the definitions of a script"},
    {":reload", "", NOTHING, false, reload, "start again with the scripts that were loaded"},
    {":save", "FILE", NEEDED, true, save, "write the definitions and what is shown as a script"},
    {":edit", "[FILE]", MAYBE, true, edit,
     "open FILE, the script loaded last, or the definitions in $VISUAL or $EDITOR, then load it"},
    {":render", "[OUT]", MAYBE, true, render, "render a picture of what is shown: .png or .exr"},
    {":export", "OUT", NEEDED, true, export_scene, "write what is shown: .obj .stl .pov ..."},
    {":clear", "", NOTHING, false, clear, "remove all definitions and everything that is shown"},
    {":quit", "", NOTHING, false, quit, "end (Ctrl-D)"},
};
#define COUNT (sizeof commands / sizeof *commands)

bool cag_repl_command_row(size_t i, const char **name, const char **operand, const char **story) {
  if (i >= COUNT) return false;
  if (name) *name = commands[i].name;
  if (operand) *operand = commands[i].operand;
  if (story) *story = commands[i].story;
  return true;
}

// Returns the command with this name or prefix. `several` counts the matches.
static const struct Command *find_command(const char *name, size_t *several) {
  const struct Command *found = NULL;
  *several = 0;
  for (size_t i = 0; i < COUNT; i++) {
    if (strcmp(commands[i].name, name) == 0) return &commands[i];
    if (strncmp(commands[i].name, name, strlen(name)) != 0) continue;
    found = &commands[i];
    ++*several;
  }
  return *several == 1 ? found : NULL;
}

bool cag_repl_command_takes_file(const char *name) {
  size_t several;
  const struct Command *c = find_command(name, &several);
  return c && c->file;
}

static void fail_unknown(CagRepl *repl, const char *name, size_t several) {
  const char *names[COUNT];
  for (size_t i = 0; i < COUNT; i++) names[i] = commands[i].name;
  const char *nearest = cag_nearest_name(name, names, COUNT);
  if (several > 1) {
    char list[128] = "";
    for (size_t i = 0, n = 0; i < COUNT && n < sizeof list; i++)
      if (strncmp(commands[i].name, name, strlen(name)) == 0)
        n += (size_t)snprintf(list + n, sizeof list - n, "%s%s", n ? ", " : "", commands[i].name);
    cag_repl_fail(repl, CAG_STATUS_USAGE, "`%s` could be %s", name, list);
  } else if (nearest) {
    cag_repl_fail(repl, CAG_STATUS_USAGE, "unknown command `%s`; did you mean `%s`?", name,
                  nearest);
  } else {
    cag_repl_fail(repl, CAG_STATUS_USAGE, "unknown command `%s`; :help lists all commands", name);
  }
}

void cag_repl_command(CagRepl *repl, char *line) {
  size_t n = strcspn(line, " \t"), several;
  char *operand = line + n + strspn(line + n, " \t");
  for (char *end = operand + strlen(operand); end > operand && isspace((unsigned char)end[-1]);)
    *--end = 0;
  line[n] = 0;
  const struct Command *c = find_command(line, &several);
  if (!c) fail_unknown(repl, line, several);
  else if (c->wants == NEEDED && !*operand)
    cag_repl_fail(repl, CAG_STATUS_USAGE, "%s needs an argument: %s %s", c->name, c->name,
                  c->operand);
  else if (c->wants == NOTHING && *operand)
    cag_repl_fail(repl, CAG_STATUS_USAGE, "%s takes no argument, found `%s`", c->name, operand);
  else c->perform(repl, operand);
}

// --- Help ---

// The column where descriptions of commands start (in a narrow window, they are below the name),
// and the line width without a terminal.
#define STORY_COLUMN 16
#define NARROW_COLUMN 4
#define NARROW 48
#define WIDTH 92

static size_t terminal_width(void) {
  struct winsize size;
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known && size.ws_col < WIDTH ? size.ws_col : WIDTH;
}

// Writes wrapped text from column `at` on. Further lines start at `indent`.
static void print_wrapped(const char *text, size_t at, size_t indent) {
  const size_t width = terminal_width();
  for (bool first = true; *text; first = false) {
    const size_t n = strcspn(text, " ");
    if (!first && at + 1 + n > width) {
      printf("\n%*s", (int)indent, "");
      at = indent;
    } else if (!first) {
      putchar(' ');
      at++;
    }
    printf("%.*s", (int)n, text);
    at += n;
    text += n + (text[n] == ' ');
  }
  putchar('\n');
}

static void list_commands(void) {
  const bool narrow = terminal_width() < NARROW;
  const int column = narrow ? NARROW_COLUMN : STORY_COLUMN;
  for (size_t i = 0; i < COUNT; i++) {
    char head[32];
    snprintf(head, sizeof head, "%s %s", commands[i].name, commands[i].operand);
    if (narrow) printf("%s\n%*s", head, column, "");
    else printf("%-*s", column, head);
    print_wrapped(commands[i].story, (size_t)column, (size_t)column);
  }
  print_wrapped(
      "Anything else is a definition, a statement, or an expression of the language. Tab completes names. Ctrl-C stops a running evaluation.",
      0, 0);
}

// Lists all built-in functions by family.
static void list_builtins(void) {
  const size_t width = terminal_width();
  const char *signature, *family, *heading = "";
  size_t column = 0;
  char last[64] = "";
  for (size_t i = 0; cag_builtin_row(i, &signature, NULL, NULL, &family); i++) {
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(signature, "("), signature);
    if (family && strcmp(family, heading) != 0) {
      printf("%s%s:", *heading ? "\n" : "", family);
      heading = family;
      column = strlen(family) + 1;
    } else if (strcmp(name, last) == 0) {
      continue;
    }
    if (column + 1 + strlen(name) > width) {
      printf("\n   ");
      column = 3;
    }
    printf(" %s", name);
    column += 1 + strlen(name);
    snprintf(last, sizeof last, "%s", name);
  }
  putchar('\n');
}

static bool explain_command(const char *name) {
  size_t several;
  const struct Command *c = *name == ':' ? find_command(name, &several) : NULL;
  if (c) printf("%s %s\n  %s\n", c->name, c->operand, c->story);
  return c != NULL;
}

static bool is_error_code(const char *name) {
  return (*name == 'E' || *name == 'e') && strlen(name) == 5 && strspn(name + 1, "0123456789") == 4;
}

static const char *nearest_name(const CagRepl *repl, const char *name) {
  const char *const *builtins = cag_builtin_name_list();
  size_t count = 0, names = 0;
  while (builtins[count]) count++;
  while (cag_session_name(repl->session, names, NULL, NULL)) names++;
  const char **all = malloc((count + names + 1) * sizeof *all);
  if (!all) return NULL;
  for (size_t i = 0; i < names; i++) all[i] = cag_session_name(repl->session, i, NULL, NULL);
  memcpy(all + names, builtins, count * sizeof *all);
  const char *nearest = cag_nearest_name(name, all, count + names);
  free(all);
  return nearest;
}

// Writes the output of `cag doc` for a name, including names imported from the library. Uses a
// separate session, because reading modules would drop this one's definitions.
static bool document(const CagRepl *repl, const char *name) {
  char whole[256];
  const bool imported = cag_session_library_name(repl->session, name, whole, sizeof whole);
  CagSession *s = cag_tool_session(repl->tool);
  const bool styled = repl->interactive && repl->tool->style == CAG_STYLE_COLOR;
  const bool told = s && cag_session_document(s, imported ? whole : name, styled, stdout);
  cag_session_free(s);
  return told;
}

static void show_doc(CagRepl *repl, char *name) {
  char library[256];
  if (!*name) {
    list_builtins();
    return;
  }
  const bool own = !cag_session_library_name(repl->session, name, library, sizeof library);
  if (explain_command(name) || (own && cag_session_write_doc(repl->session, name, stdout)) ||
      document(repl, name) || (is_error_code(name) && cag_explain(name, stdout)))
    return;
  const char *nearest = nearest_name(repl, name);
  if (nearest)
    cag_repl_fail(repl, CAG_STATUS_USAGE, "unknown name `%s`; did you mean `%s`?", name, nearest);
  else cag_repl_fail(repl, CAG_STATUS_USAGE, "unknown name `%s`; :doc lists the functions", name);
}

static void show_help(CagRepl *repl, char *name) {
  if (*name) show_doc(repl, name);
  else list_commands();
}

// --- Values ---

typedef struct Answer {
  size_t count;
  bool only_type;
} Answer;

static void take_value(void *context, const char *text, const char *type) {
  Answer *a = context;
  a->count++;
  if (a->only_type) puts(type);
  else printf("%s : %s\n", text, type);
}

// Evaluates an expression. Returns false if it failed or is missing.
static bool evaluate_operand(CagRepl *repl, const char *command, const char *text, bool only_type) {
  Answer answer = {.only_type = only_type};
  int status = cag_session_input(repl->session, text, strlen(text), take_value, &answer);
  cag_repl_finish(repl, status);
  if (status != CAG_STATUS_OK) return false;
  if (answer.count == 0)
    cag_repl_fail(repl, CAG_STATUS_USAGE, "%s expects an expression, found a statement", command);
  return answer.count > 0;
}

static void show_type(CagRepl *repl, char *text) { evaluate_operand(repl, ":type", text, true); }

static void show_time(CagRepl *repl, char *text) {
  double begin = cag_clock_seconds();
  if (!evaluate_operand(repl, ":time", text, false)) return;
  double seconds = cag_clock_seconds() - begin;
  if (seconds < 1) printf("%.3g ms\n", seconds * 1e3);
  else printf("%.3g s\n", seconds);
}

// --- Definitions ---

static void list_names(CagRepl *repl, char *operand) {
  (void)operand;
  const char *name, *text;
  size_t length;
  for (size_t i = 0; (name = cag_session_name(repl->session, i, &text, &length)); i++) {
    if (!text) {
      printf("%s (imported)\n", name);
      continue;
    }
    size_t n = 0;
    while (n < length && text[n] != '\n') n++;
    printf("%.*s%s\n", (int)n, text, n < length ? " ..." : "");
  }
}

static void show_scene(CagRepl *repl, char *operand) {
  (void)operand;
  cag_session_describe_scene(repl->session, stdout);
}

static void hide(CagRepl *repl, char *operand) {
  if (cag_session_hide(repl->session, operand) > 0) return;
  cag_repl_fail(repl, CAG_STATUS_USAGE, "`%s` is not shown; :scene lists what is", operand);
}

// Replaces ~/ at the start of a path by the user's home folder. The caller frees the result.
static char *expand(const char *path) {
  const char *home = getenv("HOME");
  char *out;
  if (strncmp(path, "~/", 2) != 0 || !home) return strdup(path);
  return asprintf(&out, "%s%s", home, path + 1) < 0 ? NULL : out;
}

static void load(CagRepl *repl, char *operand) {
  char *path = expand(operand);
  if (path) cag_repl_load(repl, path);
  free(path);
}

static void reload(CagRepl *repl, char *operand) {
  (void)operand;
  if (repl->loaded_count == 0) {
    cag_repl_fail(repl, CAG_STATUS_USAGE, "no script is loaded; use :load FILE");
    return;
  }
  cag_session_clear(repl->session);
  for (size_t i = 0; i < repl->loaded_count; i++) cag_repl_load(repl, repl->loaded[i]);
}

static void clear(CagRepl *repl, char *operand) {
  (void)operand;
  cag_session_clear(repl->session);
  while (repl->loaded_count) free(repl->loaded[--repl->loaded_count]);
}

static void quit(CagRepl *repl, char *operand) {
  (void)operand;
  repl->quit = true;
}

// Writes to a temporary file first, so that an existing file remains until the new one is complete.
static bool write_script(CagRepl *repl, const char *path) {
  char *beside = NULL;
  if (asprintf(&beside, "%s.tmp", path) < 0) return false;
  FILE *f = fopen(beside, "we");
  if (f) cag_session_write_script(repl->session, f);
  bool failed = f && ferror(f);
  bool ok = f && fclose(f) == 0 && !failed && rename(beside, path) == 0;
  if (!ok) {
    cag_repl_fail(repl, CAG_STATUS_FILE, "cannot write %s: %s", path, strerror(errno));
    if (f) unlink(beside);
  }
  free(beside);
  return ok;
}

static void save(CagRepl *repl, char *operand) {
  char *path = expand(operand);
  if (path && write_script(repl, path)) printf("wrote %s\n", path);
  free(path);
}

// --- Editing ---

// Runs the user's editor on a file. Meanwhile, Ctrl-C goes to the editor.
static bool run_editor(CagRepl *repl, const char *path) {
  const char *editor = getenv("VISUAL");
  if (!editor || !*editor) editor = getenv("EDITOR");
  if (!editor || !*editor) editor = "vi";
  struct sigaction ignore = {.sa_handler = SIG_IGN}, before;
  char *command;
  if (asprintf(&command, "%s \"$1\"", editor) < 0) return false;
  fflush(stdout);
  sigaction(SIGINT, &ignore, &before);
  pid_t child = fork();
  if (child == 0) {
    signal(SIGINT, SIG_DFL);
    execl("/bin/sh", "sh", "-c", command, "sh", path, (char *)NULL);
    _exit(127);
  }
  int status = -1;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  sigaction(SIGINT, &before, NULL);
  free(command);
  if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
  cag_repl_fail(repl, CAG_STATUS_FILE,
                "the editor `%s` failed; set VISUAL or EDITOR to another one", editor);
  return false;
}

// Edits the definitions: they are written to a file, whose edited contents replace them.
static void edit_definitions(CagRepl *repl) {
  const char *root = getenv("TMPDIR");
  char *path;
  if (asprintf(&path, "%s/cag-XXXXXX.cag", root && *root ? root : "/tmp") < 0) return;
  int fd = mkstemps(path, 4);
  if (fd < 0) {
    cag_repl_fail(repl, CAG_STATUS_FILE, "cannot write %s: %s", path, strerror(errno));
  } else {
    close(fd);
    if (write_script(repl, path) && run_editor(repl, path)) {
      cag_session_clear(repl->session);
      cag_repl_finish(repl, cag_session_input_file(repl->session, path));
    }
    unlink(path);
  }
  free(path);
}

static void edit(CagRepl *repl, char *operand) {
  if (!*operand && repl->loaded_count == 0) {
    edit_definitions(repl);
    return;
  }
  char *path = *operand ? expand(operand) : strdup(repl->loaded[repl->loaded_count - 1]);
  if (path && run_editor(repl, path)) {
    bool known = false;
    for (size_t i = 0; i < repl->loaded_count; i++)
      known = known || strcmp(repl->loaded[i], path) == 0;
    if (known) reload(repl, operand);
    else cag_repl_load(repl, path);
  }
  free(path);
}

// --- Outputs ---

// Returns the default name of a picture, derived from the script loaded last.
static char *default_picture(const CagRepl *repl) {
  char *path;
  const char *script = repl->loaded_count ? repl->loaded[repl->loaded_count - 1] : "scene.cag";
  const char *slash = strrchr(script, '/'), *name = slash ? slash + 1 : script;
  const char *dot = strrchr(name, '.');
  size_t n = dot ? (size_t)(dot - name) : strlen(name);
  return asprintf(&path, "%.*s.png", (int)n, name) < 0 ? NULL : path;
}

static void render(CagRepl *repl, char *operand) {
  char *path = *operand ? expand(operand) : default_picture(repl);
  if (!path) return;
  CagRenderOptions options;
  CagProgress progress;
  cag_render_options_init(&options);
  cag_progress_begin(&progress, repl->tool);
  options.progress = cag_progress_show;
  options.progress_context = &progress;
  int status = cag_session_render(repl->session, &options, path);
  cag_progress_end(&progress);
  cag_repl_finish(repl, status);
  if (status == CAG_STATUS_OK) printf("wrote %s\n", path);
  free(path);
}

static void export_scene(CagRepl *repl, char *operand) {
  char *path = expand(operand);
  if (!path) return;
  int status = cag_session_export(repl->session, path, NULL);
  cag_repl_finish(repl, status);
  if (status == CAG_STATUS_OK && strcmp(path, "-") != 0) printf("wrote %s\n", path);
  free(path);
}
