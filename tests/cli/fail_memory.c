// A library for LD_PRELOAD that makes one allocation or system call of a program fail: the first
// call at the location in its code with the number CAG_FAIL_PLACE. Locations are numbered in the
// order of their first calls. CAG_FAIL_WHAT selects the calls: "memory" or "system". Calls made by
// libraries do not fail. The number of locations is written to the file CAG_FAIL_COUNT.

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#define PLACES_MAX 8192

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static uintptr_t low, high; // the program's code
static uintptr_t places[PLACES_MAX];
static size_t count, failing;
static bool of_system, ended;

static int find_program(struct dl_phdr_info *info, size_t size, void *context) {
  (void)size, (void)context;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[i];
    if (p->p_type != PT_LOAD || !(p->p_flags & PF_X)) continue;
    low = info->dlpi_addr + p->p_vaddr;
    high = low + p->p_memsz;
  }
  return 1; // the first entry is the program
}

// Programs started by this one are not affected.
__attribute__((constructor)) static void begin(void) {
  const char *place = getenv("CAG_FAIL_PLACE");
  unsetenv("LD_PRELOAD");
  dl_iterate_phdr(find_program, NULL);
  failing = place ? strtoul(place, NULL, 10) : 0;
  const char *what = getenv("CAG_FAIL_WHAT");
  of_system = what && strcmp(what, "system") == 0;
}

__attribute__((destructor)) static void end(void) {
  const char *path = getenv("CAG_FAIL_COUNT");
  FILE *f = path ? fopen(path, "w") : NULL;
  if (!f) return;
  fprintf(f, "%zu\n", count);
  fclose(f);
}

// Counting stops at the end of the program's main function. Destructors, such as those that write
// coverage counters, do not fail.
static void stop(void) { ended = true; }
static void begin_to_count(void) { atexit(stop); }

static bool is_failing(const void *caller, bool system) {
  static pthread_once_t once = PTHREAD_ONCE_INIT;
  const uintptr_t at = (uintptr_t)caller;
  if (system != of_system || at < low || at >= high || ended) return false;
  bool fails = false;
  pthread_once(&once, begin_to_count);
  pthread_mutex_lock(&lock);
  size_t i = 0;
  while (i < count && places[i] != at) i++;
  if (i == count && count < PLACES_MAX) {
    places[count++] = at;
    fails = count == failing;
  }
  pthread_mutex_unlock(&lock);
  if (fails) errno = system ? EIO : ENOMEM;
  return fails;
}

#define CALLER __builtin_return_address(0)
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *old, size_t size);

void *malloc(size_t size) { return is_failing(CALLER, false) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) {
  return is_failing(CALLER, false) ? NULL : __libc_calloc(n, size);
}
void *realloc(void *old, size_t size) {
  return is_failing(CALLER, false) ? NULL : __libc_realloc(old, size);
}
char *strdup(const char *text) { return is_failing(CALLER, false) ? NULL : NEXT(strdup)(text); }
char *strndup(const char *text, size_t n) {
  return is_failing(CALLER, false) ? NULL : NEXT(strndup)(text, n);
}
char *realpath(const char *path, char *out) {
  return is_failing(CALLER, false) ? NULL : NEXT(realpath)(path, out);
}
int vasprintf(char **out, const char *format, va_list list) {
  return is_failing(CALLER, false) ? -1 : NEXT(vasprintf)(out, format, list);
}
int asprintf(char **out, const char *format, ...) {
  if (is_failing(CALLER, false)) return -1;
  va_list list;
  va_start(list, format);
  const int n = NEXT(vasprintf)(out, format, list);
  va_end(list);
  return n;
}
FILE *open_memstream(char **text, size_t *size) {
  return is_failing(CALLER, false) ? NULL : NEXT(open_memstream)(text, size);
}

// System calls. A file is closed even if closing it fails.
#define FAIL(value)                                                                                \
  if (is_failing(CALLER, true)) return value

FILE *fopen(const char *path, const char *mode) {
  FAIL(NULL);
  return NEXT(fopen)(path, mode);
}
int fclose(FILE *f) {
  const bool fails = is_failing(CALLER, true);
  const int result = NEXT(fclose)(f);
  if (fails) errno = EIO;
  return fails ? EOF : result;
}
int fflush(FILE *f) {
  FAIL(EOF);
  return NEXT(fflush)(f);
}
int fseek(FILE *f, long offset, int whence) {
  FAIL(-1);
  return NEXT(fseek)(f, offset, whence);
}
size_t fread(void *to, size_t size, size_t n, FILE *f) {
  FAIL(0);
  return NEXT(fread)(to, size, n, f);
}
int open(const char *path, int flags, ...) {
  FAIL(-1);
  va_list list;
  va_start(list, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
  va_end(list);
  return NEXT(open)(path, flags, mode);
}
int openat(int folder, const char *path, int flags, ...) {
  FAIL(-1);
  va_list list;
  va_start(list, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(list, mode_t) : 0;
  va_end(list);
  return NEXT(openat)(folder, path, flags, mode);
}
int close(int fd) {
  const bool fails = is_failing(CALLER, true);
  const int result = NEXT(close)(fd);
  if (fails) errno = EIO;
  return fails ? -1 : result;
}
ssize_t read(int fd, void *to, size_t n) {
  FAIL(-1);
  return NEXT(read)(fd, to, n);
}
ssize_t write(int fd, const void *from, size_t n) {
  FAIL(-1);
  return NEXT(write)(fd, from, n);
}
int stat(const char *path, struct stat *out) {
  FAIL(-1);
  return NEXT(stat)(path, out);
}
int lstat(const char *path, struct stat *out) {
  FAIL(-1);
  return NEXT(lstat)(path, out);
}
int fstat(int fd, struct stat *out) {
  FAIL(-1);
  return NEXT(fstat)(fd, out);
}
int access(const char *path, int mode) {
  FAIL(-1);
  return NEXT(access)(path, mode);
}
int faccessat(int folder, const char *path, int mode, int flags) {
  FAIL(-1);
  return NEXT(faccessat)(folder, path, mode, flags);
}
int mkdir(const char *path, mode_t mode) {
  FAIL(-1);
  return NEXT(mkdir)(path, mode);
}
char *mkdtemp(char *pattern) {
  FAIL(NULL);
  return NEXT(mkdtemp)(pattern);
}
int mkstemps(char *pattern, int ending) {
  FAIL(-1);
  return NEXT(mkstemps)(pattern, ending);
}
int rename(const char *from, const char *to) {
  FAIL(-1);
  return NEXT(rename)(from, to);
}
int renameat(int from_folder, const char *from, int to_folder, const char *to) {
  FAIL(-1);
  return NEXT(renameat)(from_folder, from, to_folder, to);
}
int fchmod(int fd, mode_t mode) {
  FAIL(-1);
  return NEXT(fchmod)(fd, mode);
}
int ftruncate(int fd, off_t size) {
  FAIL(-1);
  return NEXT(ftruncate)(fd, size);
}
int fdatasync(int fd) {
  FAIL(-1);
  return NEXT(fdatasync)(fd);
}
DIR *opendir(const char *path) {
  FAIL(NULL);
  return NEXT(opendir)(path);
}
int pipe2(int fds[2], int flags) {
  FAIL(-1);
  return NEXT(pipe2)(fds, flags);
}
int dup2(int from, int to) {
  FAIL(-1);
  return NEXT(dup2)(from, to);
}
int chdir(const char *path) {
  FAIL(-1);
  return NEXT(chdir)(path);
}
int inotify_init1(int flags) {
  FAIL(-1);
  return NEXT(inotify_init1)(flags);
}
int inotify_add_watch(int fd, const char *path, uint32_t mask) {
  FAIL(-1);
  return NEXT(inotify_add_watch)(fd, path, mask);
}
// They pass on the maximum number of arguments, like the system calls.
int prctl(int option, ...) {
  FAIL(-1);
  unsigned long values[4];
  va_list list;
  va_start(list, option);
  for (int i = 0; i < 4; i++) values[i] = va_arg(list, unsigned long);
  va_end(list);
  return NEXT(prctl)(option, values[0], values[1], values[2], values[3]);
}
long syscall(long number, ...) {
  FAIL(-1);
  long values[6];
  va_list list;
  va_start(list, number);
  for (int i = 0; i < 6; i++) values[i] = va_arg(list, long);
  va_end(list);
  return NEXT(syscall)(number, values[0], values[1], values[2], values[3], values[4], values[5]);
}
pid_t fork(void) {
  FAIL(-1);
  return NEXT(fork)();
}
ssize_t getrandom(void *to, size_t n, unsigned flags) {
  FAIL(-1);
  return ((ssize_t(*)(void *, size_t, unsigned))dlsym(RTLD_NEXT, "getrandom"))(to, n, flags);
}
int pthread_create(pthread_t *out, const pthread_attr_t *attributes, void *(*work)(void *),
                   void *context) {
  if (is_failing(CALLER, true)) return EAGAIN;
  return NEXT(pthread_create)(out, attributes, work, context);
}
