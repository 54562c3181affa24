// Source texts: the bytes of one script, and the way from a byte offset to line and column.
//
// A source is checked to be valid UTF-8 when it is made. Spans are byte offsets into it; lines and
// columns (code points, from 1) are computed only when a message needs them.

#ifndef CAG_BASE_SOURCE_H
#define CAG_BASE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/guard.h"

// Half-open range of bytes [start, end) of a source.
typedef struct CagSpan {
  uint32_t start, end;
} CagSpan;

typedef struct CagSource {
  char *name;      // as messages show it: the path as the user gave it, "<repl>", "std.materials"
  char *text;      // NUL-terminated, `length` bytes before the NUL
  size_t length;   // at most CAG_SOURCE_MAX
  uint32_t *lines; // offset of each line's first byte
  size_t line_count;
  const volatile int *stop; // becomes nonzero if work on the text is to end; NULL: never
} CagSource;

// 1 GiB: offsets fit in 32 bits with room to spare.
#define CAG_SOURCE_MAX ((size_t)1 << 30)

typedef struct CagPosition {
  size_t line, column; // from 1; the column counts code points
} CagPosition;

// Makes a source of a copy of text. NULL when memory is out. Does not check UTF-8 (see
// cag_source_bad_utf8).
CagSource *cag_source_new(const char *name, const char *text, size_t length);
void cag_source_free(CagSource *s);

// Offset of the first byte that is not part of valid UTF-8 (or is NUL); `length` when all is well.
size_t cag_source_bad_utf8(const CagSource *s);

static inline bool cag_source_stopped(const CagSource *s) { return s->stop && *s->stop; }
// Abandons the work of the innermost guard (base/guard.h) if work on the text is to end.
static inline void cag_source_check(const CagSource *s) {
  if (cag_source_stopped(s)) cag_memory_leave();
}

CagPosition cag_source_position(const CagSource *s, uint32_t offset);

// The text of a line (from 1), without its newline: pointer into the source, and its length.
const char *cag_source_line(const CagSource *s, size_t line, size_t *length);

#endif
