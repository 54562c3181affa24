// The scripts that a site documents in addition to the library: reading them, and their names.
//
// The name of a script is its path without the common folder of all scripts, so that a site does
// not reveal where it was made.

#include <string.h>

#include "base/memory.h"
#include "interp/session/session.h"
#include "interp/session/site.h"
#include "interp/vm/program.h"

// --- Names ---

// Returns the length of a path up to and including its last slash.
static size_t folder_length(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? (size_t)(slash - path) + 1 : 0;
}

// Returns the length of the common folder of all paths.
static size_t common_folder(const char *const *paths, size_t count) {
  size_t common = folder_length(paths[0]);
  for (size_t i = 1; i < count; i++) {
    size_t n = 0;
    while (n < common && paths[i][n] == paths[0][n]) n++;
    while (n > 0 && paths[0][n - 1] != '/') n--;
    common = n;
  }
  return common;
}

static bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

static bool is_taken(const CagSite *s, const char *page) {
  if (strcmp(page, "index") == 0) return true; // the list of all scripts
  for (size_t i = 0; i < s->script_count; i++)
    if (s->scripts[i].page && strcmp(s->scripts[i].page, page) == 0) return true;
  return false;
}

// The page of "parts/gripper.cag" is "parts.gripper". Its words need no escapes in a path or a URL.
static char *page_name(const CagSite *s, const char *name) {
  const size_t n = strlen(name);
  char *stem = cag_strndup(name, n > 4 && strcmp(name + n - 4, ".cag") == 0 ? n - 4 : n), *page;
  if (!stem) cag_memory_leave();
  for (char *at = stem; *at; at++)
    if (!is_plain(*at)) *at = *at == '/' ? '.' : '_';
  page = cag_strdup(stem);
  for (int i = 2; page && is_taken(s, page); i++) {
    cag_free(page);
    page = cag_doc_text("%s-%d", stem, i);
  }
  cag_free(stem);
  return page;
}

// --- Reading ---

static bool read_script(CagSite *s, const char *path, size_t common) {
  size_t length;
  const char *why;
  char *text = cag_read_whole_file(path, &length, &why);
  if (!text) {
    cag_session_drop_vm(s->session);
    cag_diagnostics_add(&s->session->diagnostics, CAG_ERR_module_unreadable, NULL, (CagSpan){0, 0},
                        "cannot read %s: %s", path, why);
    return false;
  }
  CagSiteScript *script = &s->scripts[s->script_count];
  const size_t folder = folder_length(path);
  const int status = cag_session_read_doc(s->session, path, text, length, &script->module);
  cag_free(text);
  if (status != CAG_STATUS_OK) {
    cag_doc_module_free(&script->module);
    return false;
  }
  cag_free(script->module.name);
  script->module.name = cag_strdup(path + common);
  script->file = cag_strdup(path + folder);
  script->folder = folder ? cag_strndup(path, folder) : cag_strdup(".");
  script->page = NULL;
  s->script_count++;
  if (!script->module.name || !script->file || !script->folder) cag_memory_leave();
  script->page = cag_checked(page_name(s, path + common));
  return true;
}

static bool is_again(const char *const *paths, size_t i) {
  for (size_t k = 0; k < i; k++)
    if (strcmp(paths[k], paths[i]) == 0) return true;
  return false;
}

bool cag_site_read_scripts(CagSite *s) {
  const char *const *paths = s->options->scripts;
  const size_t count = s->options->script_count;
  if (count == 0) return true;
  s->scripts = cag_calloc(count, sizeof *s->scripts);
  if (!s->scripts) cag_memory_leave();
  const size_t common = common_folder(paths, count);
  for (size_t i = 0; i < count; i++)
    if (!is_again(paths, i) && !read_script(s, paths[i], common)) return false;
  return true;
}

void cag_site_free_scripts(CagSite *s) {
  for (size_t i = 0; i < s->script_count; i++) {
    CagSiteScript *script = &s->scripts[i];
    cag_doc_module_free(&script->module);
    cag_free(script->file);
    cag_free(script->folder);
    cag_free(script->page);
  }
  cag_free(s->scripts);
}
