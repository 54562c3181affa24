// Scanner for line-based text formats.

#include "interp/formats/text_scan.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool is_end(char c) { return c == '\n' || c == '\r' || c == 0; }
static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Tests for a backslash at the end of a line. The text ends with a zero, so at[1] can be read.
static bool is_continued(const char *at) { return *at == '\\' && (at[1] == '\n' || at[1] == '\r'); }

void cag_scan_blanks(CagTextScan *s) {
  for (;;) {
    while (s->at < s->end && is_space(*s->at)) s->at++;
    if (s->at >= s->end || !is_continued(s->at)) return;
    s->at += s->at[1] == '\r' && s->at[2] == '\n' ? 3 : 2;
  }
}

bool cag_scan_at_line_end(CagTextScan *s) {
  cag_scan_blanks(s);
  return s->at >= s->end || is_end(*s->at);
}

void cag_scan_next_line(CagTextScan *s) {
  while (s->at < s->end && *s->at != '\n' && *s->at != '\r') s->at++;
  if (s->at < s->end) s->at += *s->at == '\r' && s->at[1] == '\n' ? 2 : 1;
}

bool cag_scan_to_word(CagTextScan *s) {
  while (cag_scan_at_line_end(s)) {
    if (s->at >= s->end) return false;
    s->at++;
  }
  return true;
}

size_t cag_scan_word(CagTextScan *s, const char **word) {
  cag_scan_blanks(s);
  const char *begin = s->at;
  while (s->at < s->end && !is_end(*s->at) && !is_space(*s->at) && !is_continued(s->at)) s->at++;
  *word = begin;
  return (size_t)(s->at - begin);
}

bool cag_scan_is(const char *word, size_t n, const char *expected) {
  return strlen(expected) == n && strncasecmp(word, expected, n) == 0;
}

// Reads digits as an integer, of which the first 19 count. *dropped is the number of others.
static const char *read_digits(const char *p, uint64_t *mantissa, int *count, int *dropped) {
  const int most = 19; // digits that always fit in 64 bits
  for (; is_digit(*p); p++) {
    if (*count < most) {
      *mantissa = *mantissa * 10 + (uint64_t)(*p - '0');
      *count += *mantissa > 0;
    } else if (*dropped < 100000) ++*dropped;
  }
  return p;
}

static const char *read_exponent(const char *p, int *exponent) {
  if (*p != 'e' && *p != 'E') return p;
  const char *q = p + 1;
  bool negative = *q == '-';
  if (*q == '-' || *q == '+') q++;
  if (!is_digit(*q)) return p;
  int e = 0;
  for (; is_digit(*q); q++)
    if (e < 100000) e = 10 * e + (*q - '0');
  *exponent += negative ? -e : e;
  return q;
}

bool cag_scan_number(CagTextScan *s, double *x) {
  static const double power[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                 1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const int most_power = 22;                     // powers of ten up to this are exact doubles
  const uint64_t most_whole = (uint64_t)1 << 53; // so are these integers: a single rounding
  cag_scan_blanks(s);
  const char *begin = s->at, *p = begin;
  bool negative = *p == '-';
  if (*p == '-' || *p == '+') p++;
  uint64_t mantissa = 0;
  int count = 0, dropped = 0, exponent = 0, beyond = 0;
  const char *digits = p;
  p = read_digits(p, &mantissa, &count, &dropped);
  bool any = p > digits;
  if (*p == '.') {
    const char *point = ++p;
    p = read_digits(p, &mantissa, &count, &beyond);
    any |= p > point;
    exponent = -(int)(p - point < 1000000 ? p - point : 1000000) + beyond;
  }
  if (!any) return false;
  p = read_exponent(p, &exponent);
  if (p > s->end) return false;
  s->at = p;
  if (mantissa == 0) *x = 0;
  else if (dropped + beyond > 0 || mantissa > most_whole || exponent > most_power ||
           exponent < -most_power)
    *x = strtod(begin, NULL);
  else {
    double size = (double)mantissa;
    size = exponent < 0 ? size / power[-exponent] : size * power[exponent];
    *x = negative ? -size : size;
  }
  return true;
}

bool cag_scan_integer(CagTextScan *s, int64_t *x) {
  const int most = 18;
  cag_scan_blanks(s);
  const char *p = s->at;
  bool negative = *p == '-';
  if (*p == '-' || *p == '+') p++;
  int count = 0;
  int64_t n = 0;
  for (; is_digit(*p); p++) {
    if (++count > most) return false;
    n = 10 * n + (*p - '0');
  }
  if (count == 0) return false;
  s->at = p;
  *x = negative ? -n : n;
  return true;
}
