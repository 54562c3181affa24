// Access to files by scripts, and reading files (language, section 8).

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/memory.h"
#include "base/stop.h"
#include "interp/vm/vm.h"

// Larger files are refused.
#define FILE_MAX ((size_t)1 << 30)

// Reading can be stopped between chunks.
#define CHUNK ((size_t)16 << 20)

// Reasons that are distinguished by their address.
static const char TOO_LARGE[] = "it is too large";
const char cag_file_out_of_memory[] = "out of memory";

static bool below(const char *path, const char *folder) {
  if (!folder) return false;
  size_t n = strlen(folder);
  if (strcmp(folder, "/") == 0) return true;
  return strncmp(path, folder, n) == 0 && (path[n] == '/' || path[n] == 0);
}

static bool is_allowed(const CagVm *vm, const char *real) {
  if (below(real, vm->root)) return true;
  for (size_t i = 0; i < vm->include_count; i++)
    if (below(real, vm->include[i])) return true;
  return false;
}

char *cag_vm_real_path(CagVm *vm, const char *path) {
  char *real = cag_realpath(path);
  vm->starved |= !real && errno == ENOMEM;
  return real;
}

static void note_absolute(CagVm *vm, const char *path) {
  const uint64_t hash = cag_hash_text(CAG_HASH_START, path);
  size_t i;
  for (CagHashWalk w = cag_hash_walk(&vm->reads_by_path, hash); cag_hash_next(&w, &i);)
    if (!strcmp(vm->reads[i], path)) return;
  char *copy = cag_strdup(path);
  if (!copy || !CAG_RESERVE(vm->reads, vm->read_capacity, vm->read_count + 1) ||
      !cag_hash_add(&vm->reads_by_path, hash, vm->read_count)) {
    cag_free(copy);
    vm->starved = true;
    return;
  }
  vm->reads[vm->read_count++] = copy;
}

void cag_vm_note_file(CagVm *vm, const char *path) {
  char *folder = path[0] == '/' ? NULL : getcwd(NULL, 0), *whole = NULL;
  if (!folder) note_absolute(vm, path);
  else if (cag_asprintf(&whole, "%s/%s", folder, path) < 0) vm->starved = true;
  else note_absolute(vm, whole);
  cag_free(whole);
  free(folder);
}

char *cag_allowed_path(CagVm *vm, const char *path, const char *beside, char *message,
                       size_t size) {
  char *joined = NULL;
  const char *asked = path;
  if (path[0] != '/' && beside) {
    if (cag_asprintf(&joined, "%s/%s", beside, path) < 0) {
      vm->starved = true;
      snprintf(message, size, "%s: %s", path, cag_file_out_of_memory);
      return NULL;
    }
    asked = joined;
  }
  char *real = cag_vm_real_path(vm, asked);
  int why = errno;
  // Does not reveal whether a file outside of the folders exists: only files inside are reported as
  // missing.
  bool outside = real ? !is_allowed(vm, real) : path[0] == '/' || strstr(path, "..") != NULL;
  // A file that is missing may appear, and a link may be changed to another file.
  if (!outside) cag_vm_note_file(vm, asked);
  if (!outside && real) cag_vm_note_file(vm, real);
  cag_free(joined);
  if (real && !outside) return real;
  if (outside)
    snprintf(
        message, size,
        "%s is outside of the folders that the script can read: the folder of the main script, and those of -I",
        path);
  else snprintf(message, size, "%s: %s", path, strerror(why));
  cag_free(real);
  return NULL;
}

// Reads the rest of a file, at most `most` bytes, and adds a zero byte. Returns NULL, with the
// reason in *why, if it cannot be read or is larger.
static char *read_rest(FILE *f, size_t first, size_t most, size_t *length, const char **why) {
  size_t capacity = first + 1, n = 0;
  char *bytes = cag_malloc(capacity);
  *why = bytes ? NULL : cag_file_out_of_memory;
  while (!*why) {
    const size_t room = capacity - 1 - n;
    n += fread(bytes + n, 1, room < CHUNK ? room : CHUNK, f);
    if (ferror(f)) *why = strerror(errno);
    else if (cag_stopped()) *why = "it was interrupted";
    else if (feof(f)) break;
    if (*why || n < capacity - 1) continue;
    const int c = fgetc(f); // files may be longer than their reported size
    if (c == EOF) break;
    ungetc(c, f);
    if (n >= most) *why = TOO_LARGE;
    else capacity = (capacity < most / 2 ? 2 * capacity : most) + 1;
    char *more = *why ? NULL : cag_realloc(bytes, capacity);
    if (more) bytes = more;
    else if (!*why) *why = cag_file_out_of_memory;
  }
  if (*why) {
    cag_free(bytes);
    return NULL;
  }
  bytes[n] = 0;
  *length = n;
  return bytes;
}

static char *read_at_most(const char *path, size_t most, size_t *length, const char **why) {
  const size_t first = 65536; // for pipes, whose size is unknown
  char *bytes = NULL;
  struct stat st;
  FILE *f = strcmp(path, "-") == 0 ? stdin : fopen(path, "rbe");
  if (!f) {
    *why = strerror(errno);
    return NULL;
  }
  const bool known = fstat(fileno(f), &st) == 0;
  const size_t size = known && st.st_size > 0 ? (size_t)st.st_size : first;
  if (known && S_ISDIR(st.st_mode)) *why = "it is a folder";
  else if (known && st.st_size > 0 && size > most) *why = TOO_LARGE;
  else bytes = read_rest(f, size < most ? size : most, most, length, why);
  if (f != stdin) fclose(f);
  return bytes;
}

char *cag_read_whole_file(const char *path, size_t *length, const char **why) {
  char *bytes = read_at_most(path, FILE_MAX, length, why);
  if (!bytes && *why == TOO_LARGE) *why = "it is larger than 1 GiB";
  return bytes;
}

bool cag_vm_open_file(CagCall *call, int argument, const char *path, char **bytes, size_t *n) {
  CagVm *vm = call->vm;
  // A path is relative to the file that contains it.
  char *folder = NULL;
  if (vm->frame_count) {
    const CagSource *s = vm->frames[vm->frame_count - 1].proto->source;
    for (size_t i = 0; i < vm->module_count; i++)
      if (vm->modules[i]->source == s && vm->modules[i]->path)
        folder = cag_checked(cag_strdup(vm->modules[i]->path));
    char *slash = folder ? strrchr(folder, '/') : NULL;
    if (slash) *slash = 0;
  }
  char message[512];
  char *real =
      cag_allowed_path(vm, path, folder && *folder ? folder : vm->root, message, sizeof message);
  cag_free(folder);
  // Then the folders of -I in order, as for modules.
  for (size_t i = 0; !real && path[0] != '/' && i < vm->include_count; i++) {
    char ignored[512];
    real = cag_allowed_path(vm, path, vm->include[i], ignored, sizeof ignored);
  }
  if (!real) return cag_fail_call(call, argument, CAG_ERR_file, "cannot read it: %s", message);
  const char *why;
  const size_t left = cag_account_room();
  *bytes = read_at_most(real, left < FILE_MAX ? left : FILE_MAX, n, &why);
  cag_free(real);
  if (!*bytes && !cag_keep_going(vm)) return false;
  if (!*bytes && why == TOO_LARGE) {
    if (left < FILE_MAX)
      return cag_fail_call(call, argument, CAG_ERR_limit_memory,
                           "%s is larger than the remaining memory (--max-memory)", path);
    why = "it is larger than 1 GiB";
  }
  vm->starved |= !*bytes && why == cag_file_out_of_memory;
  if (!*bytes) return cag_fail_call(call, argument, CAG_ERR_file, "cannot read %s: %s", path, why);
  return true;
}
