#include "live/model_files.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/digest.h"

// A larger file is not text that someone edits.
enum { SIZE_MOST = 64 << 20 };

static bool is_below(const char *folder, const char *path) {
  const size_t n = strlen(folder);
  if (!strcmp(folder, "/")) return true;
  return !strncmp(path, folder, n) && path[n] == '/';
}

// The real path of `path` below the folder. For a file that does not exist, its folder must.
static bool resolve(const char *folder, const char *path, char out[PATH_MAX], const char **why) {
  char whole[PATH_MAX], root[PATH_MAX];
  *why = "the file is not in the folder of the script";
  if (!*path || *path == '/' || !realpath(folder, root)) return false;
  if (snprintf(whole, sizeof whole, "%s/%s", root, path) >= (int)sizeof whole) return false;
  if (realpath(whole, out)) return is_below(root, out);
  if (errno != ENOENT) return false;
  char *slash = strrchr(whole, '/');
  const char *name = slash + 1;
  *slash = 0;
  char above[PATH_MAX];
  if (!realpath(whole, above) || (strcmp(above, root) != 0 && !is_below(root, above))) return false;
  if (!*name || !strcmp(name, ".") || !strcmp(name, "..")) return false;
  return snprintf(out, PATH_MAX, "%s/%s", above, name) < PATH_MAX;
}

char *cag_model_path(const char *folder, const char *path) {
  char real[PATH_MAX];
  const char *why;
  return resolve(folder, path, real, &why) ? strdup(real) : NULL;
}

bool cag_model_read(const char *folder, const char *path, char **text, size_t *size,
                    const char **why) {
  char real[PATH_MAX];
  struct stat st;
  if (!resolve(folder, path, real, why)) return false;
  FILE *f = fopen(real, "rb");
  *why = "the file cannot be read";
  if (!f) return false;
  bool ok = fstat(fileno(f), &st) == 0 && S_ISREG(st.st_mode) && st.st_size <= SIZE_MOST;
  *text = ok ? malloc((size_t)st.st_size + 1) : NULL;
  if (*text) {
    *size = fread(*text, 1, (size_t)st.st_size, f);
    (*text)[*size] = 0;
  }
  fclose(f);
  return *text != NULL;
}

static bool ends_with(const char *path, const char *end) {
  const size_t n = strlen(path), k = strlen(end);
  return n > k && !strcmp(path + n - k, end);
}

bool cag_model_write(const char *folder, const char *path, const char *text, size_t size,
                     CagError *err) {
  char real[PATH_MAX];
  const char *why;
  if (!resolve(folder, path, real, &why)) return cag_fail_io(err, CAG_E_FILE, NULL, "%s", why);
  if (!ends_with(path, ".cag") && !ends_with(path, ".params.json"))
    return cag_fail_io(err, CAG_E_FILE, NULL, "only scripts and their params can be written");
  CagAtomicFile *f = cag_atomic_file_open(real, err);
  if (!f) return false;
  cag_atomic_file_write(f, text, size);
  return cag_atomic_file_commit(f, err);
}

void cag_model_version(const char *text, size_t size, char out[CAG_VERSION_SIZE]) {
  CagDigest d = cag_digest_start();
  cag_digest_bytes(&d, text, size);
  snprintf(out, CAG_VERSION_SIZE, "%016llx%016llx", (unsigned long long)d.a,
           (unsigned long long)d.b);
}
