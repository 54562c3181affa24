// Misspelled expectations, which would silently not be tested.

#include <ctype.h>
#include <string.h>

#include "interp/session/expect_near.h"

// Longer words before a colon are ordinary text.
#define KEY_MOST 24

// Tests whether a and b differ by one missing, additional, or changed letter, or two swapped
// neighbors.
static bool is_one_off(const char *a, const char *b) {
  const size_t n = strlen(a), m = strlen(b);
  size_t head = 0, tail = 0;
  while (head < n && head < m && a[head] == b[head]) head++;
  while (tail < n - head && tail < m - head && a[n - 1 - tail] == b[m - 1 - tail]) tail++;
  const size_t x = n - head - tail, y = m - head - tail;
  if (x <= 1 && y <= 1) return x + y > 0;
  return x == 2 && y == 2 && a[head] == b[head + 1] && a[head + 1] == b[head];
}

static bool is_one_of(const char *word, const char *const *words, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (strcmp(word, words[i]) == 0) return true;
  return false;
}
#define IS_ONE_OF(word, ...)                                                                       \
  is_one_of(word, (const char *const[]){__VA_ARGS__},                                              \
            sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

const char *cag_test_meant(const char *text, size_t length) {
  char key[KEY_MOST + 1] = "", *second;
  const char *colon = memchr(text, ':', length);
  const char *code = "expect error E";
  if (!colon && length > strlen(code) && memcmp(text, code, strlen(code)) == 0)
    return isdigit((unsigned char)text[strlen(code)]) ? "expect error:" : NULL;
  const size_t n = colon ? (size_t)(colon - text) : length;
  if (!colon || n > KEY_MOST) return NULL;
  for (size_t i = 0; i < n; i++) key[i] = (char)tolower((unsigned char)text[i]);
  for (size_t i = n; i > 0 && key[i - 1] == ' '; i--) key[i - 1] = 0;
  if (strncmp(text, "expect image", 12) == 0 || strncmp(text, "expect:", 7) == 0 ||
      strncmp(text, "expect error:", 13) == 0)
    return NULL;
  if ((second = strpbrk(key, " -_"))) *second++ = 0;
  const bool is_first = IS_ONE_OF(key, "expect", "expects", "expected", "expecting") ||
                        (is_one_off(key, "expect") && strcmp(key, "expert") != 0);
  if (!is_first) return NULL;
  if (!second || IS_ONE_OF(second, "output", "value", "result")) return "expect:";
  return IS_ONE_OF(second, "error", "errors") || is_one_off(second, "error") ? "expect error:"
                                                                             : NULL;
}
