// Sources: a copy of the text and the table of its line starts.

#include "base/source.h"

#include <string.h>

#include "base/memory.h"
#include "base/utf8.h"

static bool make_lines(CagSource *s) {
  size_t lines = 1;
  for (const char *p = s->text, *end = p + s->length; (p = memchr(p, '\n', (size_t)(end - p))); p++)
    lines++;
  s->lines = cag_malloc(lines * sizeof *s->lines);
  if (!s->lines) return false;
  s->line_count = 0;
  s->lines[s->line_count++] = 0;
  for (const char *p = s->text, *end = p + s->length; (p = memchr(p, '\n', (size_t)(end - p))); p++)
    s->lines[s->line_count++] = (uint32_t)(p - s->text + 1);
  return true;
}

CagSource *cag_source_new(const char *name, const char *text, size_t length) {
  if (length > CAG_SOURCE_MAX) return NULL;
  CagSource *s = cag_calloc(1, sizeof *s);
  if (!s) return NULL;
  s->name = cag_strdup(name);
  s->text = cag_malloc(length + 1);
  if (s->name && s->text) {
    if (length) memcpy(s->text, text, length);
    s->text[length] = 0;
    s->length = length;
    if (make_lines(s)) return s;
  }
  cag_source_free(s);
  return NULL;
}

void cag_source_free(CagSource *s) {
  if (!s) return;
  cag_free(s->name);
  cag_free(s->text);
  cag_free(s->lines);
  cag_free(s);
}

// Returns the number of bytes of the well-formed UTF-8 character at p (Unicode 15, table 3-7), or 0
// if there is none. p is NUL-terminated, and a NUL is never part of a longer character, so nothing
// after the end is read.
static size_t character_length(const unsigned char *p) {
  unsigned char a = p[0], low = 0x80, high = 0xbf;
  size_t n;
  if (a < 0x80) return a != 0;
  if (a >= 0xc2 && a <= 0xdf) n = 2;
  else if (a >= 0xe0 && a <= 0xef) n = 3;
  else if (a >= 0xf0 && a <= 0xf4) n = 4;
  else return 0;
  if (a == 0xe0) low = 0xa0;       // no overlong forms
  else if (a == 0xed) high = 0x9f; // no surrogates
  else if (a == 0xf0) low = 0x90;
  else if (a == 0xf4) high = 0x8f; // nothing beyond U+10FFFF
  if (p[1] < low || p[1] > high) return 0;
  for (size_t i = 2; i < n; i++)
    if (p[i] < 0x80 || p[i] > 0xbf) return 0;
  return n;
}

size_t cag_source_bad_utf8(const CagSource *s) {
  const unsigned char *p = (const unsigned char *)s->text;
  size_t i = 0;
  while (i < s->length) {
    uint64_t eight; // Most of a script is ASCII: skip eight bytes at a time if none is zero or has
                    // its high bit set.
    while (s->length - i >= sizeof eight) {
      memcpy(&eight, p + i, sizeof eight);
      if ((eight | (eight - 0x0101010101010101u)) & 0x8080808080808080u) break;
      i += sizeof eight;
    }
    if (i >= s->length) break;
    size_t n = character_length(p + i);
    if (n == 0) return i;
    i += n;
  }
  return s->length;
}

CagPosition cag_source_position(const CagSource *s, uint32_t offset) {
  if (offset > s->length) offset = (uint32_t)s->length;
  size_t low = 0, high = s->line_count; // lines[low] <= offset < lines[high]
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (s->lines[middle] <= offset) low = middle;
    else high = middle;
  }
  const uint32_t start = s->lines[low];
  const size_t before = offset > start ? cag_utf8_count(s->text + start, offset - start) : 0;
  return (CagPosition){low + 1, before + 1};
}

const char *cag_source_line(const CagSource *s, size_t line, size_t *length) {
  if (line == 0 || line > s->line_count) {
    *length = 0;
    return s->text + s->length;
  }
  size_t start = s->lines[line - 1];
  size_t end = line < s->line_count ? s->lines[line] - 1 : s->length;
  if (end > start && s->text[end - 1] == '\r') end--;
  *length = end - start;
  return s->text + start;
}

size_t cag_source_excerpt(const CagSource *s, CagSpan span, char *out, size_t size) {
  const size_t most = size - 4; // before "..." and the NUL
  size_t n = 0;
  uint32_t i = span.start;
  while (i < span.end && n < most) {
    const size_t blank = strspn(s->text + i, " \t\r\n");
    if (blank) out[n++] = ' ';
    else out[n++] = s->text[i];
    i += blank ? (uint32_t)blank : 1;
  }
  if (i < span.end) {
    n = cag_utf8_start(out, n);
    memcpy(out + n, "...", 3);
    n += 3;
  }
  out[n] = 0;
  return n;
}
