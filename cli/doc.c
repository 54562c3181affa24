// cag doc [NAME|PATH ...]: documentation on a terminal, or, with --html DIR, as a site, to which
// scripts can be added.

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/diagnostic.h"
#include "cli/scripts.h"
#include "lang/foreign.h"

// --- The nearest of all names ---

typedef struct Names {
  char **items;
  size_t count, capacity;
} Names;

static void keep_name(void *context, const char *name) {
  Names *n = context;
  if (!CAG_RESERVE(n->items, n->capacity, n->count + 1)) return;
  char *copy = strdup(name);
  if (copy) n->items[n->count++] = copy;
}

static int reject(CagTool *t, CagSession *s, const char *name) {
  Names names = {0};
  char help[300] = "`cag doc` alone lists all functions and modules";
  cag_session_document_names(s, keep_name, &names);
  const char *nearest = cag_nearest_name(name, (const char *const *)names.items, names.count);
  const char *form = cag_foreign_name(name);
  if (form) snprintf(help, sizeof help, "in cag, write %.280s", form);
  else if (nearest) snprintf(help, sizeof help, "did you mean `cag doc %.200s`?", nearest);
  const int status = cag_tool_fail(t, CAG_STATUS_USAGE, help,
                                   "unknown function, module, or error code `%s`", name);
  for (size_t i = 0; i < names.count; i++) free(names.items[i]);
  free(names.items);
  return status;
}

// --- Operands ---

static bool is_path(const char *operand) {
  const size_t n = strlen(operand);
  return strcmp(operand, "-") == 0 || strchr(operand, '/') ||
         (n > 4 && strcmp(operand + n - 4, ".cag") == 0);
}

static bool is_styled(const CagTool *t) {
  const char *terminal = getenv("TERM"), *none = getenv("NO_COLOR");
  if (t->color != CAG_TOOL_COLOR_AUTO) return t->color == CAG_TOOL_COLOR_ALWAYS;
  return isatty(STDOUT_FILENO) && !(none && *none) && terminal && strcmp(terminal, "dumb") != 0;
}

static int document_script(CagTool *t, CagSession *s, const char *path) {
  size_t length;
  char *text = cag_tool_read_file(t, path, &length);
  if (!text) return CAG_STATUS_FILE;
  const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
  const int status = cag_session_document_text(s, name, text, length, is_styled(t), stdout);
  free(text);
  return cag_tool_finish(t, s, status);
}

// --- The site ---

static void say_to_tool(void *context, const char *message) {
  cag_tool_say(context, "%s", message);
}

typedef struct Paths {
  char **items;
  size_t count;
} Paths;

static int keep_path(void *context, const char *path) {
  Paths *p = context;
  char **items = realloc(p->items, (p->count + 1) * sizeof *items);
  if (!items) return CAG_STATUS_LIMIT;
  p->items = items;
  p->items[p->count] = strdup(path);
  return p->items[p->count++] ? CAG_STATUS_OK : CAG_STATUS_LIMIT;
}

static int reject_operand(CagTool *t, const char *operand) {
  if (strcmp(operand, "-") == 0)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "save the script to a file",
                         "--html expects scripts and folders, found '-'");
  return cag_tool_fail(t, CAG_STATUS_USAGE,
                       "omit the name: the site includes all functions and modules",
                       "--html expects scripts and folders, found '%s'", operand);
}

// Names always have pages, so only scripts and folders are added.
static bool is_site_path(const char *operand) {
  struct stat st;
  return strcmp(operand, "-") != 0 && (is_path(operand) || stat(operand, &st) == 0);
}

static int make_site(CagTool *t, CagSession *s, int argc, char **argv) {
  Paths paths = {0};
  CagToolScripts scripts = {.tool = t, .each = keep_path, .context = &paths};
  for (int i = 0; i < argc; i++)
    if (!is_site_path(argv[i])) return reject_operand(t, argv[i]);
  int status = argc ? cag_tool_each_script(&scripts, argc, argv) : CAG_STATUS_OK;
  if (status == CAG_STATUS_OK) status = scripts.status;
  CagSiteOptions options = {.session = t->session,
                            .no_pictures = t->no_pictures,
                            .playground = t->playground,
                            .jobs = t->jobs,
                            .scripts = (const char *const *)paths.items,
                            .script_count = paths.count,
                            .say = say_to_tool,
                            .context = t};
  if (status == CAG_STATUS_OK)
    status = cag_tool_finish(t, s, cag_session_write_site(s, t->html, &options));
  for (size_t i = 0; i < paths.count; i++) free(paths.items[i]);
  free(paths.items);
  return status;
}

typedef struct Showing {
  CagTool *tool;
  CagSession *session;
  size_t count;
} Showing;

static int show_script(void *context, const char *path) {
  Showing *w = context;
  if (w->count++) putchar('\n');
  return document_script(w->tool, w->session, path);
}

// A folder stands for the scripts below it.
static int show_path(CagTool *t, CagSession *s, const char *path) {
  Showing w = {t, s, 0};
  CagToolScripts scripts = {.tool = t, .each = show_script, .context = &w};
  char *paths[] = {(char *)(size_t)path};
  const int status = cag_tool_each_script(&scripts, 1, paths);
  return status == CAG_STATUS_OK ? scripts.status : status;
}

static int show(CagTool *t, CagSession *s, const char *operand) {
  if (operand && is_path(operand)) return show_path(t, s, operand);
  if (cag_session_document(s, operand, is_styled(t), stdout)) return CAG_STATUS_OK;
  if (!operand) { // where nothing is named, only memory can be missing
    cag_tool_finish(t, s, CAG_STATUS_LIMIT);
    return CAG_STATUS_LIMIT;
  }
  return is_site_path(operand) ? show_path(t, s, operand) : reject(t, s, operand);
}

int cag_tool_doc(CagTool *t, int argc, char **argv) {
  CagSession *s = cag_tool_session(t);
  if (!s) return CAG_STATUS_LIMIT;
  int status = CAG_STATUS_OK;
  if (t->html) {
    status = make_site(t, s, argc, argv);
  } else {
    for (int i = 0; i < (argc ? argc : 1) && status == CAG_STATUS_OK; i++) {
      if (i) putchar('\n');
      status = show(t, s, argc ? argv[i] : NULL);
    }
  }
  cag_session_free(s);
  return status;
}
