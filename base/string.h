// Growing strings.

#ifndef CAG_BASE_STRING_H
#define CAG_BASE_STRING_H

#include <stdbool.h>
#include <stddef.h>

// A growing string with a terminating NUL. If memory runs out, the string becomes empty, stays
// empty, and sets `failed`. Callers check `failed` once before they use the bytes.
typedef struct CagString {
  char *bytes; // NULL if nothing was added
  size_t length, capacity;
  size_t most; // length at which writers stop (see cag_print_value); 0: unlimited
  bool failed;
} CagString;
void cag_string_add(CagString *s, const char *bytes, size_t n);
void cag_string_printf(CagString *s, const char *format, ...) __attribute__((format(printf, 2, 3)));
void cag_string_free(CagString *s);

#endif
