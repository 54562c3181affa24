// URIs of documents, the files of the library, and the scripts in the folders of the workspace.
//
// Modules of the library have no files. When a client asks for a place in one, its text is written
// to a read-only file in the cache folder of the user, because every client can open files.

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "live/lsp_parts.h"
#include "live/model_files.h"

// Larger folders are read in part.
#define FILES_MAX 5000
#define DEPTH_MAX 12

char *lsp_copy(const char *text) { return text ? strdup(text) : NULL; }

// --- URIs ---

static int hex(char c) {
  return c >= '0' && c <= '9' ? c - '0' : isxdigit((unsigned char)c) ? tolower(c) - 'a' + 10 : -1;
}

static char *decoded(const char *text) {
  char *out = malloc(strlen(text) + 1), *to = out;
  if (!out) return NULL;
  for (const char *at = text; *at; at++) {
    const bool escape = *at == '%' && hex(at[1]) >= 0 && hex(at[2]) >= 0;
    const char c = escape ? (char)(16 * hex(at[1]) + hex(at[2])) : *at;
    if (!c) break;
    *to++ = c;
    at += escape ? 2 : 0;
  }
  *to = 0;
  return out;
}

static char *encoded(const char *scheme, const char *path) {
  char *out = malloc(strlen(scheme) + 3 * strlen(path) + 1), *to = out;
  if (!out) return NULL;
  to += sprintf(to, "%s", scheme);
  for (const char *at = path; *at; at++) {
    if (isalnum((unsigned char)*at) || strchr("/-_.~", *at)) *to++ = *at;
    else to += sprintf(to, "%%%02X", (unsigned char)*at);
  }
  *to = 0;
  return out;
}

// Returns the folder for the files of the library, which is made, or NULL.
static const char *library_folder(CagLsp *l) {
  char path[PATH_MAX];
  const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  if (l->library) return l->library;
  if (cache && *cache == '/') snprintf(path, sizeof path, "%s/cag/%s/std", cache, cag_version());
  else if (home && *home == '/')
    snprintf(path, sizeof path, "%s/.cache/cag/%s/std", home, cag_version());
  else return NULL;
  for (char *at = path + 1; *at; at++) {
    if (*at != '/') continue;
    *at = 0;
    mkdir(path, 0777);
    *at = '/';
  }
  if (mkdir(path, 0777) != 0 && errno != EEXIST) return NULL;
  char *real = realpath(path, NULL);
  l->library = real;
  return l->library;
}

static bool has_text(const char *path, const char *text, size_t length) {
  FILE *f = fopen(path, "r");
  char *old = f ? malloc(length + 1) : NULL;
  const bool same = old && fread(old, 1, length + 1, f) == length && memcmp(old, text, length) == 0;
  free(old);
  if (f) fclose(f);
  return same;
}

// Writes a module of the library to its file, unless it is there. Returns its path, or NULL.
static char *library_file(CagLsp *l, const char *module) {
  char path[PATH_MAX], fresh[PATH_MAX];
  size_t length;
  const char *folder = library_folder(l), *text = cag_document_text(l->workspace, module, &length);
  if (!folder || !text || strncmp(module, "std.", 4) != 0) return NULL;
  if (snprintf(path, sizeof path, "%s/%s.cag", folder, module + 4) >= (int)sizeof path) return NULL;
  if (has_text(path, text, length)) return strdup(path);
  if (snprintf(fresh, sizeof fresh, "%s.%d", path, (int)getpid()) >= (int)sizeof fresh) return NULL;
  FILE *f = fopen(fresh, "w");
  bool good = f && fwrite(text, 1, length, f) == length;
  if (f) good = fclose(f) == 0 && good;
  if (good) good = chmod(fresh, 0444) == 0 && rename(fresh, path) == 0;
  if (!good) unlink(fresh);
  return good ? strdup(path) : NULL;
}

static bool is_module(const char *name) {
  const char *module;
  for (size_t i = 0; (module = cag_library_module(i)); i++)
    if (strcmp(module, name) == 0) return true;
  return false;
}

// Returns the module whose file this is, as "std.robots" (malloc), or NULL.
static char *module_of_path(CagLsp *l, const char *path) {
  const char *folder = library_folder(l);
  const size_t n = folder ? strlen(folder) : 0, length = strlen(path);
  if (!n || strncmp(path, folder, n) != 0 || path[n] != '/' || length < n + 6 ||
      strcmp(path + length - 4, ".cag") != 0 || strchr(path + n + 1, '/'))
    return NULL;
  char name[PATH_MAX];
  snprintf(name, sizeof name, "std.%.*s", (int)(length - n - 5), path + n + 1);
  return is_module(name) ? strdup(name) : NULL;
}

// Returns the name of a document of a server that is limited to a folder.
static char *file_in_folder(CagLsp *l, const char *uri) {
  const char *const folder = l->options.folder;
  const size_t n = strlen(folder);
  if (strncmp(uri, "cag:", 4) == 0) return is_module(uri + 4) ? strdup(uri + 4) : NULL;
  char *path = strncmp(uri, "file:///", 8) == 0 ? decoded(uri + 7) : NULL, *real = NULL;
  if (path && strcmp(path, folder) == 0) real = strdup(folder);
  else if (path && strncmp(path, folder, n) == 0 && path[n] == '/')
    real = cag_model_path(folder, path + n + 1);
  free(path);
  return real;
}

char *lsp_file_of_uri(CagLsp *l, const char *uri) {
  const char *path = NULL;
  if (l->options.folder) return file_in_folder(l, uri);
  if (strncmp(uri, "file:///", 8) == 0) path = uri + 7;
  else if (strncmp(uri, "file://localhost/", 17) == 0) path = uri + 16;
  if (path) {
    char *file = decoded(path), *module = file ? module_of_path(l, file) : NULL;
    if (!module) return file;
    free(file);
    return module;
  }
  // A text that is in no file. Its name has no `/`.
  char *name = strdup(uri);
  for (char *at = name; name && *at; at++)
    if (*at == '/') *at = '\\';
  return name;
}

char *lsp_uri_of_file(CagLsp *l, const char *file) {
  const LspDocument *d = lsp_find_file(l, file);
  if (d) return strdup(d->uri);
  if (strchr(file, '/')) return encoded("file://", file);
  if (l->options.folder) return is_module(file) ? encoded("cag:", file) : NULL;
  char *path = library_file(l, file);
  char *uri = path ? encoded("file://", path) : NULL;
  free(path);
  return uri;
}

// --- Folders ---

static bool is_skipped(const char *name) {
  static const char *const names[] = {"node_modules", "build", "target", "dist", "__pycache__"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(name, names[i]) == 0) return true;
  return name[0] == '.';
}

static bool is_script(const char *name) {
  const size_t n = strlen(name);
  return n > 4 && strcmp(name + n - 4, ".cag") == 0;
}

// Adds or removes the scripts in a folder and those below.
static void scan(CagLsp *l, const char *folder, int depth, bool below, bool add, size_t *count) {
  DIR *dir = opendir(folder);
  const struct dirent *entry;
  while (dir && (entry = readdir(dir)) && *count < FILES_MAX) {
    char path[PATH_MAX];
    struct stat st;
    if (is_skipped(entry->d_name)) continue;
    if (snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) >= (int)sizeof path) continue;
    if (lstat(path, &st) != 0) continue; // links could lead in circles
    if (S_ISDIR(st.st_mode) && below && depth < DEPTH_MAX)
      scan(l, path, depth + 1, below, add, count);
    if (!S_ISREG(st.st_mode) || !is_script(entry->d_name)) continue;
    ++*count;
    if (add) cag_workspace_add_file(l->workspace, path);
    else cag_workspace_remove_file(l->workspace, path);
  }
  if (dir) closedir(dir);
}

void lsp_add_folder(CagLsp *l, const char *uri) {
  char *path = lsp_file_of_uri(l, uri), *real = path ? realpath(path, NULL) : NULL;
  char **folders = real ? realloc(l->folders, (l->folder_count + 1) * sizeof *folders) : NULL;
  free(path);
  if (folders) {
    l->folders = folders;
    l->folders[l->folder_count++] = real;
  } else free(real);
}

void lsp_scan_folders(CagLsp *l) {
  size_t count = 0;
  for (size_t i = 0; i < l->folder_count; i++) scan(l, l->folders[i], 0, true, true, &count);
}

void lsp_remove_folder(CagLsp *l, const char *uri) {
  char *path = lsp_file_of_uri(l, uri), *real = path ? realpath(path, NULL) : NULL;
  size_t count = 0;
  for (size_t i = 0; real && i < l->folder_count; i++) {
    if (strcmp(l->folders[i], real) != 0) continue;
    scan(l, real, 0, true, false, &count);
    free(l->folders[i]);
    l->folders[i] = l->folders[--l->folder_count];
    break;
  }
  free(real);
  free(path);
}

void lsp_scan_beside(CagLsp *l, const char *file) {
  char folder[PATH_MAX];
  const char *slash = strrchr(file, '/');
  size_t count = 0;
  if (!slash || slash == file || slash - file >= (long)sizeof folder) return;
  snprintf(folder, sizeof folder, "%.*s", (int)(slash - file), file);
  for (size_t i = 0; i < l->folder_count; i++) {
    const size_t n = strlen(l->folders[i]);
    if (strncmp(folder, l->folders[i], n) == 0 && (folder[n] == '/' || !folder[n])) return;
  }
  scan(l, folder, 0, false, true, &count);
}
