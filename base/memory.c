// Allocation with accounting, over malloc.

#include "base/memory.h"

#include <errno.h>
#include <limits.h>
#include <malloc.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

_Thread_local CagAccount *cag_account;

CagAccount *cag_account_lend(CagAccount *account) {
  CagAccount *before = cag_account;
  cag_account = account;
  return before;
}

static bool has_room(const CagAccount *a, size_t bytes) {
  return bytes <= a->limit && a->used <= a->limit - bytes;
}

bool cag_account_has_room(size_t bytes) { return !cag_account || has_room(cag_account, bytes); }

size_t cag_account_room(void) {
  const CagAccount *a = cag_account;
  if (!a) return SIZE_MAX / 2;
  const size_t room = a->limit > a->used ? a->limit - a->used : 0;
  return room < SIZE_MAX / 2 ? room : SIZE_MAX / 2;
}

bool cag_account_hold(size_t bytes) {
  if (!cag_account) return true;
  if (!has_room(cag_account, bytes)) return false;
  cag_account->used += bytes;
  return true;
}

static void credit(CagAccount *a, size_t bytes) { a->used -= bytes < a->used ? bytes : a->used; }

void cag_account_drop(size_t bytes) {
  if (cag_account) credit(cag_account, bytes);
}

static void *refuse(void) {
  errno = ENOMEM;
  return NULL;
}

// The usable size of a block is a little larger than the requested size, so the limit may be
// exceeded by that much.
static void *charged(void *block) {
  if (cag_account && block) cag_account->used += malloc_usable_size(block);
  return block;
}

void *cag_malloc(size_t size) {
  if (!cag_account_has_room(size)) return refuse();
  return charged(malloc(size));
}

void *cag_calloc(size_t count, size_t size) {
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes) || !cag_account_has_room(bytes)) return refuse();
  return charged(calloc(count, size));
}

void *cag_realloc(void *block, size_t size) {
  CagAccount *a = cag_account;
  if (!a) return realloc(block, size);
  // The old block stays charged until the new one has its contents.
  const size_t old = block ? malloc_usable_size(block) : 0;
  if (size > old && !has_room(a, size - old)) return refuse();
  void *moved = realloc(block, size);
  if (!moved && size > 0) return NULL;
  credit(a, old);
  return charged(moved);
}

void cag_free(void *block) {
  if (cag_account && block) credit(cag_account, malloc_usable_size(block));
  free(block);
}

char *cag_strndup(const char *text, size_t length) {
  const size_t n = strnlen(text, length);
  char *copy = cag_malloc(n + 1);
  if (!copy) return NULL;
  memcpy(copy, text, n);
  copy[n] = '\0';
  return copy;
}

char *cag_strdup(const char *text) { return cag_strndup(text, SIZE_MAX); }

int cag_vasprintf(char **out, const char *format, va_list args) {
  va_list again;
  va_copy(again, args);
  const int n = vsnprintf(NULL, 0, format, again);
  va_end(again);
  *out = n < 0 ? NULL : cag_malloc((size_t)n + 1);
  if (!*out) return -1;
  return vsnprintf(*out, (size_t)n + 1, format, args);
}

int cag_asprintf(char **out, const char *format, ...) {
  va_list args;
  va_start(args, format);
  const int n = cag_vasprintf(out, format, args);
  va_end(args);
  return n;
}

char *cag_realpath(const char *path) {
  char real[PATH_MAX];
  return realpath(path, real) ? cag_strdup(real) : NULL;
}

// Smaller blocks do not contain a large page.
#define SCATTERED_MIN ((size_t)4 << 20)

void cag_memory_scattered(void *block, size_t size) {
#ifdef MADV_HUGEPAGE
  const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
  const uintptr_t from = ((uintptr_t)block + page - 1) / page * page;
  const uintptr_t to = ((uintptr_t)block + size) / page * page;
  if (block && size >= SCATTERED_MIN) madvise((void *)from, to - from, MADV_HUGEPAGE);
#else
  (void)block;
  (void)size;
#endif
}

void cag_adopt(void *block) { charged(block); }

void cag_disown(void *block) {
  if (cag_account && block) credit(cag_account, malloc_usable_size(block));
}
