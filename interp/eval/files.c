// Which files a script may have, and reading them (language, section 8).

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "interp/eval/vm.h"

// Larger files are refused: no script or table is so large by right.
#define FILE_MAX ((size_t)1 << 30)

static bool below(const char *path, const char *folder) {
  size_t n = strlen(folder);
  if (strcmp(folder, "/") == 0) return true;
  return strncmp(path, folder, n) == 0 && (path[n] == '/' || path[n] == 0);
}

static bool is_allowed(const CagVm *vm, const char *real) {
  if (vm->root && below(real, vm->root)) return true;
  for (size_t i = 0; i < vm->include_count; i++)
    if (below(real, vm->include[i])) return true;
  return false;
}

char *cag_allowed_path(CagVm *vm, const char *path, const char *beside, char *message,
                       size_t size) {
  char *joined = NULL;
  const char *asked = path;
  if (path[0] != '/' && beside) {
    if (asprintf(&joined, "%s/%s", beside, path) < 0) return NULL;
    asked = joined;
  }
  char *real = realpath(asked, NULL);
  int why = errno;
  // Whether a file outside exists is not told: only a missing one below the folders is called
  // missing.
  bool outside = real ? !is_allowed(vm, real) : path[0] == '/' || strstr(path, "..") != NULL;
  free(joined);
  if (real && !outside) return real;
  if (outside)
    snprintf(message, size,
             "%s lies outside of the folders that the script may read: that of the main script, "
             "and those of -I",
             path);
  else snprintf(message, size, "%s: %s", path, strerror(why));
  free(real);
  return NULL;
}

char *cag_read_whole_file(const char *path, size_t *length, const char **why) {
  FILE *f = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
  if (!f) {
    *why = strerror(errno);
    return NULL;
  }
  struct stat st;
  if (fstat(fileno(f), &st) == 0 && S_ISDIR(st.st_mode)) {
    if (f != stdin) fclose(f);
    *why = "it is a folder";
    return NULL;
  }
  size_t capacity = st.st_size > 0 ? (size_t)st.st_size + 1 : 65536, n = 0;
  char *bytes = capacity <= FILE_MAX ? malloc(capacity) : NULL;
  *why = NULL;
  while (bytes) {
    n += fread(bytes + n, 1, capacity - 1 - n, f);
    if (ferror(f)) {
      *why = strerror(errno);
      break;
    }
    if (n < capacity - 1) {
      int c = fgetc(f);
      if (c == EOF) break;
      ungetc(c, f);
      continue;
    }
    int c = fgetc(f);
    if (c == EOF) break;
    ungetc(c, f);
    if (capacity >= FILE_MAX) {
      *why = "it is larger than 1 GiB";
      break;
    }
    char *more = realloc(bytes, capacity * 2);
    if (!more) {
      *why = "there is not enough memory for it";
      break;
    }
    bytes = more;
    capacity *= 2;
  }
  if (f != stdin) fclose(f);
  if (!bytes || *why) {
    if (!*why) *why = "it is too large";
    free(bytes);
    return NULL;
  }
  bytes[n] = 0;
  *length = n;
  return bytes;
}

bool cag_vm_open_file(CagCall *call, int argument, const char *path, char **bytes, size_t *n) {
  CagVm *vm = call->vm;
  // A path is relative to the file that says it.
  char *folder = NULL;
  if (vm->frame_count) {
    const CagSource *s = vm->frames[vm->frame_count - 1].proto->source;
    for (size_t i = 0; i < vm->module_count; i++)
      if (vm->modules[i]->source == s && vm->modules[i]->path)
        folder = strdup(vm->modules[i]->path);
    char *slash = folder ? strrchr(folder, '/') : NULL;
    if (slash) *slash = 0;
  }
  char message[512];
  char *real =
      cag_allowed_path(vm, path, folder && *folder ? folder : vm->root, message, sizeof message);
  free(folder);
  if (!real) return cag_fail_call(call, argument, CAG_ERR_file, "cannot read it: %s", message);
  const char *why;
  *bytes = cag_read_whole_file(real, n, &why);
  free(real);
  if (!*bytes) return cag_fail_call(call, argument, CAG_ERR_file, "cannot read %s: %s", path, why);
  return true;
}
