// Words and numbers of text formats, line by line.
//
// Blanks are spaces, tabs and a backslash at the end of a line with that end; a line ends with \n,
// \r or both. The text has a zero byte behind its end.

#ifndef CAG_INTERP_FORMATS_TEXT_SCAN_H
#define CAG_INTERP_FORMATS_TEXT_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CagTextScan {
  const char *at, *end;
} CagTextScan;

void cag_scan_blanks(CagTextScan *s);
// Behind blanks, is this the end of a line or of the text?
bool cag_scan_at_line_end(CagTextScan *s);
// To the beginning of the next line.
void cag_scan_next_line(CagTextScan *s);
// To the next word, over lines: false at the end of the text.
bool cag_scan_to_word(CagTextScan *s);
// The word behind blanks; its length, 0 at the end of a line.
size_t cag_scan_word(CagTextScan *s, const char **word);
// Is the word this one, whatever its capitals?
bool cag_scan_is(const char *word, size_t n, const char *expected);
// A decimal number behind blanks, rounded as strtod does. False, and nothing read: there is none.
// One too large for a double is infinite.
bool cag_scan_number(CagTextScan *s, double *x);
// A whole number behind blanks. False: there is none, or it has more than 18 digits.
bool cag_scan_integer(CagTextScan *s, int64_t *x);

#endif
