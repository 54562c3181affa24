// File name patterns with a placeholder for the frame number.
//
// A pattern is user input and never passed to printf. Its conversion is parsed here.

#include "cli/frames.h"

#include <stdio.h>
#include <string.h>

// The conversion at a percent sign.
typedef struct {
  size_t length; // in the pattern; 0: unknown conversion
  bool percent;  // it is %%
  bool zeros;
  int digits;
} Conversion;

static Conversion read_conversion(const char *at) {
  Conversion c = {0};
  const char *p = at + 1;
  if (*p == '%') return (Conversion){.length = 2, .percent = true};
  c.zeros = *p == '0';
  while (*p >= '0' && *p <= '9' && c.digits <= CAG_FRAMES_DIGITS_MAX)
    c.digits = 10 * c.digits + (*p++ - '0');
  if (*p == 'd' && c.digits <= CAG_FRAMES_DIGITS_MAX) c.length = (size_t)(p + 1 - at);
  return c;
}

int cag_frames_places(const char *pattern) {
  int places = 0;
  for (const char *at = pattern; (at = strchr(at, '%'));) {
    const Conversion c = read_conversion(at);
    if (!c.length) return -1;
    places += !c.percent;
    at += c.length;
  }
  return places;
}

bool cag_frames_name(const char *pattern, long frame, char *out, size_t size) {
  size_t used = 0;
  for (const char *at = pattern; *at;) {
    const Conversion c = *at == '%' ? read_conversion(at) : (Conversion){0};
    char piece[64];
    if (!c.length || c.percent) snprintf(piece, sizeof piece, "%c", *at);
    else if (c.zeros) snprintf(piece, sizeof piece, "%0*ld", c.digits, frame);
    else snprintf(piece, sizeof piece, "%*ld", c.digits, frame);
    const size_t n = strlen(piece);
    if (used + n >= size) return false;
    memcpy(out + used, piece, n);
    used += n;
    at += c.length ? c.length : 1;
  }
  out[used] = '\0';
  return true;
}
