// The scripts that operands of a command select, and reading them.

#include "cli/scripts.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool is_script(const char *name) {
  size_t n = strlen(name);
  return n > 4 && strcmp(name + n - 4, ".cag") == 0;
}

static int is_visible(const struct dirent *entry) { return entry->d_name[0] != '.'; }

static int by_bytes(const struct dirent **a, const struct dirent **b) {
  return strcmp((*a)->d_name, (*b)->d_name);
}

static int fail_path(CagToolScripts *s, const char *path) {
  s->status =
      cag_tool_fail(s->tool, CAG_STATUS_FILE, NULL, "cannot read %s: %s", path, strerror(errno));
  return CAG_STATUS_OK;
}

static int visit(CagToolScripts *s, const char *path) {
  s->count++;
  return s->each(s->context, path);
}

static int walk_folder(CagToolScripts *s, const char *folder);

// Handles an entry of a folder: a script, a folder of scripts, or something else.
static int walk_entry(CagToolScripts *s, const char *folder, const char *name) {
  char *path;
  struct stat link, target;
  size_t n = strlen(folder);
  const char *slash = n && folder[n - 1] == '/' ? "" : "/";
  const bool here = strcmp(folder, ".") == 0; // shown without ./
  if (asprintf(&path, "%s%s%s", here ? "" : folder, here ? "" : slash, name) < 0)
    return CAG_STATUS_LIMIT;
  int status = CAG_STATUS_OK;
  if (lstat(path, &link) == 0 && stat(path, &target) == 0) {
    // A link to a folder could be circular.
    if (S_ISDIR(link.st_mode)) status = walk_folder(s, path);
    else if (S_ISREG(target.st_mode) && is_script(name)) status = visit(s, path);
  }
  free(path);
  return status;
}

static int walk_folder(CagToolScripts *s, const char *folder) {
  struct dirent **entries;
  int n = scandir(folder, &entries, is_visible, by_bytes), status = CAG_STATUS_OK;
  if (n < 0) return fail_path(s, folder);
  for (int i = 0; i < n; i++) {
    if (status == CAG_STATUS_OK) status = walk_entry(s, folder, entries[i]->d_name);
    free(entries[i]);
  }
  free(entries);
  return status;
}

static int walk_path(CagToolScripts *s, const char *path) {
  struct stat st;
  if (strcmp(path, "-") == 0) return visit(s, path);
  if (stat(path, &st) != 0) return fail_path(s, path);
  return S_ISDIR(st.st_mode) ? walk_folder(s, path) : visit(s, path);
}

int cag_tool_each_script(CagToolScripts *s, int count, char **paths) {
  if (count == 0) return walk_folder(s, ".");
  int status = CAG_STATUS_OK;
  for (int i = 0; i < count && status == CAG_STATUS_OK; i++) status = walk_path(s, paths[i]);
  return status;
}

// The minimum number of bytes to read at once.
#define READ_SIZE ((size_t)64 * 1024)

// Larger files are not scripts. An endless one would use all memory.
#define READ_MAX ((size_t)1 << 30)

// Reads the rest of a file, NUL-terminated. Returns NULL, with errno, on failure.
static char *read_all(FILE *from, size_t *length) {
  struct stat st;
  size_t n = 0, capacity = READ_SIZE;
  const bool sized = fstat(fileno(from), &st) == 0 && st.st_size > 0;
  if (sized && (size_t)st.st_size <= READ_MAX) capacity += (size_t)st.st_size;
  char *text = malloc(capacity + 1);
  while (text && !feof(from) && !ferror(from)) {
    if (n > READ_MAX) {
      errno = EFBIG;
      break;
    }
    if (capacity - n < READ_SIZE / 2) {
      char *more = realloc(text, 2 * capacity + 1);
      if (!more) break;
      text = more;
      capacity *= 2;
    }
    n += fread(text + n, 1, capacity - n, from);
  }
  if (text && feof(from)) {
    text[n] = 0;
    *length = n;
    return text;
  }
  free(text);
  return NULL;
}

char *cag_tool_try_file(const char *path, size_t *length) {
  const bool input = strcmp(path, "-") == 0;
  FILE *from = input ? stdin : fopen(path, "rb");
  char *text = from ? read_all(from, length) : NULL;
  const int why = errno;
  if (from && !input) fclose(from);
  errno = why;
  return text;
}

char *cag_tool_read_file(const CagTool *t, const char *path, size_t *length) {
  char *text = cag_tool_try_file(path, length);
  if (!text) cag_tool_fail(t, CAG_STATUS_FILE, NULL, "cannot read %s: %s", path, strerror(errno));
  return text;
}
