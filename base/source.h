// Source texts: the bytes of one script, and the conversion of byte offsets to lines and columns.
//
// Spans are byte offsets into the text. Lines and columns (in code points, from 1) are computed
// only when a message needs them.

#ifndef CAG_BASE_SOURCE_H
#define CAG_BASE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/guard.h"

// A half-open range of bytes [start, end) of a source.
typedef struct CagSpan {
  uint32_t start, end;
} CagSpan;

typedef struct CagSource {
  char *name;      // as shown in messages: the path as the user gave it, "<repl>", "std.materials"
  char *text;      // NUL-terminated, `length` bytes before the NUL
  size_t length;   // at most CAG_SOURCE_MAX
  uint32_t *lines; // offset of each line's first byte
  size_t line_count;
  bool library;             // of the standard library
  const volatile int *stop; // becomes nonzero if work on the text is to end; NULL: never
} CagSource;

// 1 GiB: offsets fit in 32 bits with room to spare.
#define CAG_SOURCE_MAX ((size_t)1 << 30)

typedef struct CagPosition {
  size_t line, column; // from 1; the column counts code points
} CagPosition;

// Makes a source from a copy of text. Returns NULL if memory ran out. Does not check UTF-8 (see
// cag_source_bad_utf8).
CagSource *cag_source_new(const char *name, const char *text, size_t length);
void cag_source_free(CagSource *s);

// Returns the offset of the first byte that is not part of valid UTF-8 (or is NUL), or `length` if
// all are valid.
size_t cag_source_bad_utf8(const CagSource *s);

static inline bool cag_source_stopped(const CagSource *s) { return s->stop && *s->stop; }
// Abandons the work of the innermost guard (base/guard.h) if work on the text is to end.
static inline void cag_source_check(const CagSource *s) {
  if (cag_source_stopped(s)) cag_memory_leave();
}

// Copies the text of a span to `out`, with a single blank for blanks and line breaks. A text that
// does not fit is cut off and ends with "...". Returns its length. `size` is at least 8.
size_t cag_source_excerpt(const CagSource *s, CagSpan span, char *out, size_t size);

CagPosition cag_source_position(const CagSource *s, uint32_t offset);

// Returns a pointer to line `line` (from 1), and its length without the newline.
const char *cag_source_line(const CagSource *s, size_t line, size_t *length);

#endif
