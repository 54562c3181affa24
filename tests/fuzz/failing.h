// Failing allocations, for programs that the Makefile links with --wrap of the functions in
// WRAPPED. Only allocations of cag itself fail, not those of libraries.

#ifndef CAG_TESTS_FUZZ_FAILING_H
#define CAG_TESTS_FUZZ_FAILING_H

#include <errno.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static size_t made;     // number of allocations so far in this run
static size_t failing;  // index of the first allocation that fails, from 1; 0: none
static bool failing_on; // whether all later allocations fail as well

// With -a of tests/fuzz/memory, set a breakpoint here.
static __attribute__((noinline)) bool fail_allocation(void) {
  errno = ENOMEM;
  return true;
}

static bool is_failing(void) {
  const size_t n = __atomic_add_fetch(&made, 1, __ATOMIC_RELAXED);
  return (n == failing || (failing_on && failing && n > failing)) && fail_allocation();
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
char *__real_strdup(const char *text);
char *__real_strndup(const char *text, size_t n);
char *__real_realpath(const char *path, char *resolved);
int __real_vasprintf(char **out, const char *format, va_list args);
FILE *__real_open_memstream(char **text, size_t *size);

void *__wrap_malloc(size_t size) { return is_failing() ? NULL : __real_malloc(size); }
void *__wrap_calloc(size_t count, size_t size) {
  return is_failing() ? NULL : __real_calloc(count, size);
}
void *__wrap_realloc(void *old, size_t size) {
  return is_failing() ? NULL : __real_realloc(old, size);
}
char *__wrap_strdup(const char *text) { return is_failing() ? NULL : __real_strdup(text); }
char *__wrap_strndup(const char *text, size_t n) {
  return is_failing() ? NULL : __real_strndup(text, n);
}
char *__wrap_realpath(const char *path, char *resolved) {
  return is_failing() ? NULL : __real_realpath(path, resolved);
}
int __wrap_vasprintf(char **out, const char *format, va_list args) {
  return is_failing() ? -1 : __real_vasprintf(out, format, args);
}
int __wrap_asprintf(char **out, const char *format, ...) {
  va_list args;
  va_start(args, format);
  const int n = is_failing() ? -1 : __real_vasprintf(out, format, args);
  va_end(args);
  return n;
}
FILE *__wrap_open_memstream(char **text, size_t *size) {
  return is_failing() ? NULL : __real_open_memstream(text, size);
}

#endif
