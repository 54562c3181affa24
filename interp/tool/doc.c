// cag doc [NAME|PATH]: documentation on a terminal, or as a site with --html DIR.

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "interp/tool/scripts.h"
#include "lang/diagnostic.h"

// --- The nearest of all names ---

typedef struct Names {
  char **items;
  size_t count, capacity;
} Names;

static void keep_name(void *context, const char *name) {
  Names *n = context;
  if (n->count == n->capacity) {
    const size_t capacity = n->capacity ? 2 * n->capacity : 1024;
    char **items = realloc(n->items, capacity * sizeof *items);
    if (!items) return;
    n->items = items;
    n->capacity = capacity;
  }
  char *copy = strdup(name);
  if (copy) n->items[n->count++] = copy;
}

static int reject(CagTool *t, CagSession *s, const char *name) {
  Names names = {0};
  char help[300] = "`cag doc` alone lists all functions and modules";
  cag_session_document_names(s, keep_name, &names);
  const char *nearest = cag_nearest_name(name, (const char *const *)names.items, names.count);
  if (nearest) snprintf(help, sizeof help, "did you mean `cag doc %.200s`?", nearest);
  const int status = cag_tool_fail(t, CAG_STATUS_USAGE, help,
                                   "there is no function, module or error code '%s'", name);
  for (size_t i = 0; i < names.count; i++) free(names.items[i]);
  free(names.items);
  return status;
}

// --- What is asked for ---

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

static void say(void *context, const char *message) { cag_tool_say(context, "%s", message); }

static int make_site(CagTool *t, CagSession *s, const char *operand) {
  if (operand)
    return cag_tool_fail(t, CAG_STATUS_USAGE, "leave the name away",
                         "--html makes the site of all documentation, found '%s'", operand);
  CagSiteOptions options = {.session = t->session,
                            .no_pictures = t->no_pictures,
                            .jobs = t->jobs,
                            .say = say,
                            .context = t};
  return cag_tool_finish(t, s, cag_session_write_site(s, t->html, &options));
}

int cag_tool_doc(CagTool *t, int argc, char **argv) {
  const char *operand = argc ? argv[0] : NULL;
  CagSession *s = cag_tool_session(t);
  if (!s) return CAG_STATUS_LIMIT;
  int status = CAG_STATUS_OK;
  if (t->html) status = make_site(t, s, operand);
  else if (operand && is_path(operand)) status = document_script(t, s, operand);
  else if (!cag_session_document(s, operand, is_styled(t), stdout)) status = reject(t, s, operand);
  cag_session_free(s);
  return status;
}
