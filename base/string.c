// Growing strings.

#include "base/string.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"

// The bytes of a failed string. Never written to.
static char no_bytes[1];

static void fail_string(CagString *s) {
  if (!s->failed) cag_free(s->bytes);
  *s = (CagString){.bytes = no_bytes, .most = s->most, .failed = true};
}

void cag_string_add(CagString *s, const char *bytes, size_t n) {
  if (s->failed) return;
  if (!CAG_RESERVE(s->bytes, s->capacity, s->length + n + 1)) {
    fail_string(s);
    return;
  }
  if (n) memcpy(s->bytes + s->length, bytes, n);
  s->length += n;
  s->bytes[s->length] = 0;
}

void cag_string_printf(CagString *s, const char *format, ...) {
  char buffer[512];
  va_list args;
  va_start(args, format);
  int n = vsnprintf(buffer, sizeof buffer, format, args);
  va_end(args);
  if ((size_t)n < sizeof buffer) {
    cag_string_add(s, buffer, (size_t)n);
    return;
  }
  char *big = cag_malloc((size_t)n + 1);
  if (!big) {
    fail_string(s);
    return;
  }
  va_start(args, format);
  vsnprintf(big, (size_t)n + 1, format, args);
  va_end(args);
  cag_string_add(s, big, (size_t)n);
  cag_free(big);
}

void cag_string_free(CagString *s) {
  if (!s->failed) cag_free(s->bytes);
  *s = (CagString){0};
}
