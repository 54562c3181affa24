// Loaded before a program (LD_PRELOAD), this makes one of its allocations fail: the first of the
// place in the program that is number CAG_FAIL_PLACE, in the order in which places first allocate.
// Allocations of libraries go on. The number of places is written to the file CAG_FAIL_COUNT.

#include <dlfcn.h>
#include <errno.h>
#include <link.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLACES_MAX 8192

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static uintptr_t low, high; // the program's code
static uintptr_t places[PLACES_MAX];
static size_t count, failing;

static int find_program(struct dl_phdr_info *info, size_t size, void *context) {
  (void)size, (void)context;
  for (int i = 0; i < info->dlpi_phnum; i++) {
    const ElfW(Phdr) *p = &info->dlpi_phdr[i];
    if (p->p_type != PT_LOAD || !(p->p_flags & PF_X)) continue;
    low = info->dlpi_addr + p->p_vaddr;
    high = low + p->p_memsz;
  }
  return 1; // the first is the program
}

// Programs that this one starts have their memory.
__attribute__((constructor)) static void begin(void) {
  const char *place = getenv("CAG_FAIL_PLACE");
  unsetenv("LD_PRELOAD");
  dl_iterate_phdr(find_program, NULL);
  failing = place ? strtoul(place, NULL, 10) : 0;
}

__attribute__((destructor)) static void end(void) {
  const char *path = getenv("CAG_FAIL_COUNT");
  FILE *f = path ? fopen(path, "w") : NULL;
  if (!f) return;
  fprintf(f, "%zu\n", count);
  fclose(f);
}

static bool is_failing(const void *caller) {
  const uintptr_t at = (uintptr_t)caller;
  if (at < low || at >= high) return false;
  bool fails = false;
  pthread_mutex_lock(&lock);
  size_t i = 0;
  while (i < count && places[i] != at) i++;
  if (i == count && count < PLACES_MAX) {
    places[count++] = at;
    fails = count == failing;
  }
  pthread_mutex_unlock(&lock);
  if (fails) errno = ENOMEM;
  return fails;
}

#define CALLER __builtin_return_address(0)
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t n, size_t size);
void *__libc_realloc(void *old, size_t size);

void *malloc(size_t size) { return is_failing(CALLER) ? NULL : __libc_malloc(size); }
void *calloc(size_t n, size_t size) { return is_failing(CALLER) ? NULL : __libc_calloc(n, size); }
void *realloc(void *old, size_t size) {
  return is_failing(CALLER) ? NULL : __libc_realloc(old, size);
}
char *strdup(const char *text) { return is_failing(CALLER) ? NULL : NEXT(strdup)(text); }
char *strndup(const char *text, size_t n) {
  return is_failing(CALLER) ? NULL : NEXT(strndup)(text, n);
}
char *realpath(const char *path, char *out) {
  return is_failing(CALLER) ? NULL : NEXT(realpath)(path, out);
}
int vasprintf(char **out, const char *format, va_list list) {
  return is_failing(CALLER) ? -1 : NEXT(vasprintf)(out, format, list);
}
int asprintf(char **out, const char *format, ...) {
  if (is_failing(CALLER)) return -1;
  va_list list;
  va_start(list, format);
  const int n = NEXT(vasprintf)(out, format, list);
  va_end(list);
  return n;
}
FILE *open_memstream(char **text, size_t *size) {
  return is_failing(CALLER) ? NULL : NEXT(open_memstream)(text, size);
}
