// Iteration over the characters of texts in UTF-8, which must be valid. Code points and widths are
// read with utf8proc.

#ifndef CAG_BASE_UTF8_H
#define CAG_BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

// Tests for a continuation byte, that is, any byte of a character but its first.
static inline bool cag_utf8_is_within(char c) { return ((unsigned char)c & 0xC0) == 0x80; }

// Counts the characters that start in n bytes.
static inline size_t cag_utf8_count(const char *s, size_t n) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) count += !cag_utf8_is_within(s[i]);
  return count;
}

// Returns the start of the character that contains byte i. Byte i may be the end of the text.
static inline size_t cag_utf8_start(const char *s, size_t i) {
  while (i > 0 && cag_utf8_is_within(s[i])) i--;
  return i;
}

// Returns the start of the character after the one that contains byte i, or n.
static inline size_t cag_utf8_next(const char *s, size_t n, size_t i) {
  do i++;
  while (i < n && cag_utf8_is_within(s[i]));
  return i;
}

#endif
