// Completion after `import`: modules of the library, scripts and folders beside the file and on the
// module path, and, after a `:`, the names of the module.

#include <ctype.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>

#include "cli/repl.h"

// --- Modules ---

// Converts a path to the form of an import: with points for slashes, without the extension of a
// script. Returns false for other files.
static bool dotted(char *path) {
  size_t n = strlen(path);
  if (n > 4 && strcmp(path + n - 4, ".cag") == 0) path[n - 4] = 0;
  else if (path[n - 1] != '/') return false;
  for (char *at = path; (at = strchr(at, '/'));) *at = '.';
  return true;
}

// Proposes scripts and folders whose path in `folder` ("" or ending with /) starts with the written
// text.
static void propose_scripts(CagReplProposals *p, const char *folder, const char *written) {
  glob_t found = {0};
  char *pattern = NULL;
  if (asprintf(&pattern, "%s%s*", folder, written) < 0) return;
  for (char *at = pattern + strlen(folder); (at = strchr(at, '.'));) *at = '/';
  if (glob(pattern, GLOB_MARK, NULL, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; i++) {
      char *path = found.gl_pathv[i] + strlen(folder);
      if (dotted(path)) cag_repl_propose_text(p, path, strlen(path), written);
    }
  globfree(&found);
  free(pattern);
}

static void propose_modules(CagRepl *repl, CagReplProposals *p, const char *written) {
  const char *name;
  p->length = strlen(written);
  for (size_t i = 0; (name = cag_library_module(i)); i++)
    cag_repl_propose_text(p, name, strlen(name), written);
  propose_scripts(p, "", written);
  for (size_t i = 0; i < repl->tool->session.module_path_count; i++) {
    char *folder = NULL;
    if (asprintf(&folder, "%s/", repl->tool->session.module_path[i]) < 0) return;
    propose_scripts(p, folder, written);
    free(folder);
  }
}

// --- Names of a module ---

typedef struct Names {
  CagReplProposals *proposals;
  const char *prefix;
} Names;

static void take_name(void *context, const char *name) {
  const Names *n = context;
  cag_repl_propose_text(n->proposals, name, strlen(name), n->prefix);
}

// Imports the module into a separate session, because completion must not define anything.
static void propose_names_of(CagRepl *repl, CagReplProposals *p, const char *module, size_t length,
                             const char *prefix) {
  char *text = NULL;
  p->length = strlen(prefix);
  CagSession *s = cag_session_new(&repl->tool->session);
  if (s && asprintf(&text, "import %.*s as module_of_tab", (int)length, module) >= 0) {
    if (cag_session_input(s, text, strlen(text), NULL, NULL) == CAG_STATUS_OK)
      cag_session_members(s, "module_of_tab", take_name, &(Names){p, prefix});
    free(text);
  }
  cag_session_free(s);
}

// Returns the length of the module's name, up to `as`, `:`, or spaces.
static size_t module_length(const char *rest) {
  if (*rest == '"') {
    const char *end = strchr(rest + 1, '"');
    return end ? (size_t)(end + 1 - rest) : strlen(rest);
  }
  return strcspn(rest, " \t:");
}

bool cag_repl_propose_import(CagRepl *repl, CagReplProposals *p, const char *line) {
  if (strncmp(line, "import", 6) != 0 || !isspace((unsigned char)line[6])) return false;
  const char *rest = line + 6 + strspn(line + 6, " \t");
  const size_t n = module_length(rest);
  const char *colon = strchr(rest + n, ':');
  if (!rest[n]) {
    if (*rest == '"') return false; // a file, as in other texts
    propose_modules(repl, p, rest);
  } else if (colon) {
    const char *end = line + strlen(line), *word = cag_repl_word(line, end);
    propose_names_of(repl, p, rest, n, word);
  }
  return true;
}
