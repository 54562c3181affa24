// Steps over the characters of texts in UTF-8, which are taken to be valid. utf8proc reads code
// points and widths.

#ifndef CAG_BASE_UTF8_H
#define CAG_BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

// A byte of a character other than its first.
static inline bool cag_utf8_is_within(char c) { return ((unsigned char)c & 0xC0) == 0x80; }

// Characters that begin in n bytes.
static inline size_t cag_utf8_count(const char *s, size_t n) {
  size_t count = 0;
  for (size_t i = 0; i < n; i++) count += !cag_utf8_is_within(s[i]);
  return count;
}

// Where the character with byte i begins. Byte i may be the end of the text.
static inline size_t cag_utf8_start(const char *s, size_t i) {
  while (i > 0 && cag_utf8_is_within(s[i])) i--;
  return i;
}

// Where the character after the one with byte i begins, or n.
static inline size_t cag_utf8_next(const char *s, size_t n, size_t i) {
  do i++;
  while (i < n && cag_utf8_is_within(s[i]));
  return i;
}

#endif
