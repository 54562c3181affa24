// Atomic output files: buffering, renaming, and the registry of temporary files.
//
// The registry is a process-wide table that a signal handler may read. A slot holds the descriptor
// of the folder and the name of a temporary file in it (not a path, because the working folder may
// change). A slot is written only while its state is BUSY, and the handler touches only slots that
// are LIVE. A slot also holds the process id, because a child after fork owns none of the files.

#include "base/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/stop.h"

// Large enough that system calls cost little compared to formatting and copying.
#define BUFFER_SIZE ((size_t)1024 * 1024)
// The maximum number of outputs open at once in a process; a batch has one or two per core.
#define SLOT_COUNT 256
// Attempts to find an unused temporary name. With 64 random bits, a second attempt indicates a
// problem rather than a coincidence.
#define NAME_TRIES 16
// The name is preceded by "." and followed by ".", 16 hexadecimal digits, and ".tmp".
#define NAME_EXTRA 22

typedef enum { SLOT_FREE, SLOT_BUSY, SLOT_LIVE } SlotState;

typedef struct {
  atomic_int state;
  int folder;
  pid_t owner;
  char name[NAME_MAX + 1];
} Slot;

static Slot slots[SLOT_COUNT];

struct CagAtomicFileState {
  CagAtomicFile
      file; // what the caller holds; first, so that both have one address and one allocation
  int fd;
  int folder;     // descriptor of the destination's folder, or -1 when written directly
  Slot *slot;     // registry entry of the temporary file, or NULL when written directly
  char *name;     // final name in the folder
  char *shown;    // the path as the user gave it, for messages
  uint64_t taken; // bytes passed to the system
  int error;      // errno of the first failure, or 0
  bool in_memory; // fd is then -1, and the buffer is flushed to:
  char *memory;
  size_t memory_capacity;
  char buffer[BUFFER_SIZE];
};

static Slot *slot_take(void) {
  for (size_t i = 0; i < SLOT_COUNT; i++) {
    int expected = SLOT_FREE;
    if (atomic_compare_exchange_strong(&slots[i].state, &expected, SLOT_BUSY)) return &slots[i];
  }
  return NULL;
}

static void slot_release(Slot *s) {
  if (s) atomic_store(&s->state, SLOT_FREE);
}

void cag_atomic_files_cleanup(void) {
  int saved = errno;
  pid_t self = getpid();
  for (size_t i = 0; i < SLOT_COUNT; i++) {
    if (atomic_load(&slots[i].state) != SLOT_LIVE || slots[i].owner != self) continue;
    unlinkat(slots[i].folder, slots[i].name, 0);
  }
  errno = saved;
}

static bool fail_open(CagError *err, const char *path, int code) {
  const char *help = code == ENOENT || code == ENOTDIR ? "create the folder first, or name another"
                     : code == EACCES || code == EPERM || code == EROFS
                         ? "choose a folder that you can write to"
                         : NULL;
  return cag_fail_io(err, CAG_E_FILE, help, "cannot write '%s': %s", path, strerror(code));
}

// How an output is written, which depends on what exists at its path.
typedef enum { PLACE_RENAMED, PLACE_DIRECT, PLACE_REFUSED } PlaceKind;

// Examines `path`, following symbolic links. Sets `mode` to the permission bits to keep, or to 0 if
// nothing exists there.
static PlaceKind place_inspect(const char *path, mode_t *mode, CagError *err) {
  struct stat st;
  *mode = 0;
  if (stat(path, &st) != 0) {
    int code = errno;
    if (code == ENOENT && lstat(path, &st) == 0) {
      cag_fail_io(err, CAG_E_FILE, "remove the link, or name its target",
                  "cannot write '%s': it is a symbolic link to a file that does not exist", path);
      return PLACE_REFUSED;
    }
    if (code == ENOENT) return PLACE_RENAMED;
    fail_open(err, path, code);
    return PLACE_REFUSED;
  }
  if (S_ISCHR(st.st_mode) || S_ISFIFO(st.st_mode)) return PLACE_DIRECT;
  if (!S_ISREG(st.st_mode)) {
    const char *what = S_ISDIR(st.st_mode)    ? "a folder"
                       : S_ISSOCK(st.st_mode) ? "a socket"
                                              : "a disk";
    cag_fail_io(err, CAG_E_FILE, S_ISDIR(st.st_mode) ? "name a file in it" : NULL,
                "cannot write '%s': it is %s", path, what);
    return PLACE_REFUSED;
  }
  if (faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) != 0) {
    int code = errno;
    cag_fail_io(err, CAG_E_FILE, "allow writing with chmod, or choose another name",
                "cannot write '%s': the file is write-protected (%s)", path, strerror(code));
    return PLACE_REFUSED;
  }
  *mode = st.st_mode & 0777;
  return PLACE_RENAMED;
}

// Makes the name of the temporary file: hidden, starting with the final name, and ending with
// random digits.
static void temporary_name(const char *name, char out[NAME_MAX + 1]) {
  uint64_t digits = 0;
  if (getrandom(&digits, sizeof digits, GRND_NONBLOCK) != sizeof digits) {
    static atomic_uint_least64_t counter;
    digits = (uint64_t)getpid() << 32 | atomic_fetch_add(&counter, 1);
  }
  int keep = (int)strnlen(name, NAME_MAX - NAME_EXTRA);
  snprintf(out, NAME_MAX + 1, ".%.*s.%016llx.tmp", keep, name, (unsigned long long)digits);
}

// Creates the temporary file in s->folder and enters it into the registry.
static bool create_temporary(struct CagAtomicFileState *s, mode_t keep_mode, CagError *err) {
  s->slot = slot_take();
  if (!s->slot)
    return cag_fail_io(err, CAG_E_LIMIT, "close some of them first",
                       "cannot write '%s': %d output files are already open", s->shown, SLOT_COUNT);
  s->slot->folder = s->folder;
  s->slot->owner = getpid();
  int code = EEXIST;
  for (int attempt = 0; attempt < NAME_TRIES && s->fd < 0 && code == EEXIST; attempt++) {
    temporary_name(s->name, s->slot->name);
    // Live before the file exists, so that a signal between the two calls leaves nothing behind.
    atomic_store(&s->slot->state, SLOT_LIVE);
    // The kernel applies the umask: a new file gets the mode that any program would give it.
    s->fd = openat(s->folder, s->slot->name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                   0666);
    code = errno;
    if (s->fd < 0) atomic_store(&s->slot->state, SLOT_BUSY);
  }
  if (s->fd < 0) return fail_open(err, s->shown, code);
  if (keep_mode && fchmod(s->fd, keep_mode) != 0) return fail_open(err, s->shown, errno);
  return true;
}

// Resolves links and splits the path into an open folder and a name, so that later changes of links
// have no effect.
static bool open_folder(struct CagAtomicFileState *s, bool exists, CagError *err) {
  char *resolved = exists ? cag_realpath(s->shown) : cag_strdup(s->shown);
  if (!resolved) return fail_open(err, s->shown, errno);
  char *slash = strrchr(resolved, '/');
  const char *name = slash ? slash + 1 : resolved;
  bool ok = false;
  if (!*name || !strcmp(name, ".") || !strcmp(name, "..")) {
    cag_fail_io(err, CAG_E_FILE, "name a file", "cannot write '%s': it is the name of a folder",
                s->shown);
    goto done;
  }
  s->name = cag_strdup(name);
  if (!s->name) {
    fail_open(err, s->shown, ENOMEM);
    goto done;
  }
  if (slash) slash[slash == resolved ? 1 : 0] = '\0';
  s->folder = open(slash ? resolved : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ok = s->folder >= 0 || fail_open(err, s->shown, errno);
done:
  cag_free(resolved);
  return ok;
}

// Closes what is open, removes the temporary file, and releases everything.
static void dispose(struct CagAtomicFileState *s) {
  if (s->slot && atomic_load(&s->slot->state) == SLOT_LIVE) unlinkat(s->folder, s->slot->name, 0);
  slot_release(s->slot);
  if (s->fd >= 0 && s->fd != STDOUT_FILENO) close(s->fd);
  if (s->folder >= 0) close(s->folder);
  cag_free(s->memory);
  cag_free(s->name);
  cag_free(s->shown);
  cag_free(s);
}

static bool open_place(struct CagAtomicFileState *s, const char *path, CagError *err) {
  if (!strcmp(path, "-")) {
    fflush(stdout); // earlier output of printf comes first
    s->fd = STDOUT_FILENO;
    return true;
  }
  mode_t mode;
  switch (place_inspect(path, &mode, err)) {
  case PLACE_REFUSED: return false;
  case PLACE_DIRECT:
    s->fd = open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC);
    return s->fd >= 0 || fail_open(err, path, errno);
  case PLACE_RENAMED: break;
  }
  return open_folder(s, mode != 0, err) && create_temporary(s, mode, err);
}

// Returns an unopened file with an empty buffer, called `shown` in messages.
static struct CagAtomicFileState *new_state(const char *shown, CagError *err) {
  struct CagAtomicFileState *s = cag_malloc(sizeof *s);
  char *copy = cag_strdup(shown);
  if (!s || !copy) {
    cag_free(s);
    cag_free(copy);
    fail_open(err, shown, ENOMEM);
    return NULL;
  }
  // Without the buffer, whose pages stay untouched until they are used.
  memset(s, 0, offsetof(struct CagAtomicFileState, buffer));
  s->fd = s->folder = -1;
  s->shown = copy;
  s->file = (CagAtomicFile){s->buffer, s->buffer + BUFFER_SIZE, s};
  return s;
}

CagAtomicFile *cag_atomic_file_open_memory(CagError *err) {
  struct CagAtomicFileState *s = new_state("memory", err);
  if (!s) return NULL;
  s->in_memory = true;
  return &s->file;
}

CagAtomicFile *cag_atomic_file_open(const char *path, CagError *err) {
  if (!*path) {
    cag_fail_io(err, CAG_E_FILE, "name a file, or - for standard output",
                "cannot write a file with an empty name");
    return NULL;
  }
  struct CagAtomicFileState *s = new_state(strcmp(path, "-") ? path : "standard output", err);
  if (!s) return NULL;
  if (!open_place(s, path, err)) {
    dispose(s);
    return NULL;
  }
  return &s->file;
}

// Opens an unnamed file in the destination's folder, which disappears when it is closed. Sets
// *known to false if the file system does not support such files or the open fails; only a regular
// open can then tell whether the output is writable.
static bool try_folder(const char *path, bool exists, bool *known, CagError *err) {
  struct CagAtomicFileState *s = new_state(path, err);
  *known = true;
  if (!s) return false;
  const bool good = open_folder(s, exists, err);
#ifdef O_TMPFILE
  const int fd = good ? openat(s->folder, ".", O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600) : -1;
#else
  const int fd = -1;
#endif
  *known = !good || fd >= 0;
  if (fd >= 0) close(fd);
  dispose(s);
  return good;
}

bool cag_atomic_file_try(const char *path, CagError *err) {
  mode_t mode;
  if (!strcmp(path, "-")) return true;
  bool known = false, good = false;
  switch (*path ? place_inspect(path, &mode, err) : PLACE_RENAMED) {
  case PLACE_REFUSED: return false;
  case PLACE_DIRECT: return true;
  case PLACE_RENAMED:
    if (*path) good = try_folder(path, mode != 0, &known, err);
  }
  if (known) return good;
  CagAtomicFile *trial = cag_atomic_file_open(path, err);
  cag_atomic_file_abort(trial);
  return trial != NULL;
}

// Appends to the memory, which always has room for one more zero byte.
static void append(struct CagAtomicFileState *s, const char *data, size_t n) {
  const size_t size = (size_t)s->taken;
  if (n >= s->memory_capacity - size) {
    const size_t capacity = 2 * (size + n) + 1;
    char *larger = cag_realloc(s->memory, capacity);
    if (!larger) {
      s->error = ENOMEM;
      return;
    }
    s->memory = larger;
    s->memory_capacity = capacity;
  }
  if (n) memcpy(s->memory + size, data, n);
}

// Passes all n bytes to the system, repeating partial writes. Does nothing after a failure.
static void write_through(struct CagAtomicFileState *s, const char *data, size_t n) {
  if (!s->error && cag_stopped()) s->error = ECANCELED;
  if (s->in_memory && !s->error) append(s, data, n);
  s->taken += n;
  while (n > 0 && !s->error && !s->in_memory) {
    ssize_t done = write(s->fd, data, n);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      s->error = done < 0 ? errno : EIO;
      return;
    }
    data += done;
    n -= (size_t)done;
  }
}

void cag_atomic_file_flush(CagAtomicFile *f) {
  struct CagAtomicFileState *s = f->state;
  write_through(s, s->buffer, (size_t)(f->at - s->buffer));
  f->at = s->buffer;
}

void cag_atomic_file_expect(CagAtomicFile *f, uint64_t bytes) {
#ifdef FALLOC_FL_KEEP_SIZE
  // Only a hint: if the disk is full, a later write reports it.
  const struct CagAtomicFileState *s = f->state;
  if (s->slot && !s->error && bytes > BUFFER_SIZE && bytes <= INT64_MAX)
    (void)!fallocate(s->fd, FALLOC_FL_KEEP_SIZE, 0, (off_t)bytes);
#else
  (void)f;
  (void)bytes;
#endif
}

void cag_atomic_file_write(CagAtomicFile *f, const void *data, size_t n) {
  if (n > (size_t)(f->limit - f->at)) cag_atomic_file_flush(f);
  if (n >= BUFFER_SIZE) {
    write_through(f->state, data, n);
    return;
  }
  if (n) memcpy(f->at, data, n);
  f->at += n;
}

void cag_atomic_file_text(CagAtomicFile *f, const char *text) {
  cag_atomic_file_write(f, text, strlen(text));
}

void cag_atomic_file_printf(CagAtomicFile *f, const char *format, ...) {
  va_list args;
  va_start(args, format);
  size_t room = (size_t)(f->limit - f->at);
  va_list again;
  va_copy(again, args);
  int n = vsnprintf(f->at, room, format, args);
  // A negative result, for a text longer than INT_MAX or exhausted memory, counts as exhausted
  // memory.
  if (n >= 0 && (size_t)n < room) {
    f->at += n;
  } else {
    char *text = n < 0 ? NULL : cag_malloc((size_t)n + 1);
    if (text) {
      vsnprintf(text, (size_t)n + 1, format, again);
      cag_atomic_file_write(f, text, (size_t)n);
      cag_free(text);
    } else if (!f->state->error) {
      f->state->error = ENOMEM;
    }
  }
  va_end(again);
  va_end(args);
}

bool cag_atomic_file_failed(const CagAtomicFile *f) { return f->state->error != 0; }

uint64_t cag_atomic_file_size(const CagAtomicFile *f) {
  return f->state->taken + (uint64_t)(f->at - f->state->buffer);
}

static void fail_write(const struct CagAtomicFileState *s, int code, CagError *err) {
  if (code == ECANCELED) {
    cag_fail_io(err, CAG_E_CALLBACK, NULL, "interrupted");
    return;
  }
  const char *help = code == ENOSPC || code == EDQUOT ? "free some space, or write to another disk"
                     : code == EFBIG ? "raise the limit of a file's size (ulimit -f), or write less"
                     : code == EPIPE ? "the program that reads the output ended early"
                                     : NULL;
  cag_fail_io(err, CAG_E_FILE, help, "writing '%s' failed: %s%s", s->shown, strerror(code),
              s->slot ? "; the earlier file, if any, is unchanged" : "");
}

bool cag_atomic_file_commit(CagAtomicFile *f, CagError *err) {
  struct CagAtomicFileState *s = f->state;
  cag_atomic_file_flush(f);
  // Some file systems report a full disk only when the file is closed.
  if (s->fd != STDOUT_FILENO && close(s->fd) != 0 && !s->error && errno != EINTR) s->error = errno;
  s->fd = -1;
  if (!s->error && s->slot) {
    if (renameat(s->folder, s->slot->name, s->folder, s->name) == 0) {
      slot_release(s->slot);
      s->slot = NULL;
    } else {
      s->error = errno;
    }
  }
  bool ok = s->error == 0;
  if (!ok) fail_write(s, s->error, err);
  dispose(s);
  return ok;
}

bool cag_atomic_file_commit_memory(CagAtomicFile *f, char **bytes, size_t *size, CagError *err) {
  struct CagAtomicFileState *s = f->state;
  cag_atomic_file_flush(f);
  const bool ok = s->error == 0;
  if (ok) {
    s->memory[s->taken] = '\0';
    *bytes = s->memory;
    *size = (size_t)s->taken;
    s->memory = NULL;
  } else {
    fail_write(s, s->error, err);
  }
  dispose(s);
  return ok;
}

void cag_atomic_file_abort(CagAtomicFile *f) {
  if (f) dispose(f->state);
}
