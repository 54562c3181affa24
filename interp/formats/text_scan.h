// Scanner for line-based text formats.
//
// Blanks are spaces, tabs, and a backslash at the end of a line together with the line end. A line
// ends with \n, \r, or both. The text must be followed by a zero byte.

#ifndef CAG_INTERP_FORMATS_TEXT_SCAN_H
#define CAG_INTERP_FORMATS_TEXT_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct CagTextScan {
  const char *at, *end;
} CagTextScan;

void cag_scan_blanks(CagTextScan *s);
// Skips blanks. Returns whether this is the end of a line or of the text.
bool cag_scan_at_line_end(CagTextScan *s);
// Skips to the start of the next line.
void cag_scan_next_line(CagTextScan *s);
// Skips to the next word, across lines. Returns false at the end of the text.
bool cag_scan_to_word(CagTextScan *s);
// Skips blanks and reads a word. Returns its length, or 0 at the end of a line.
size_t cag_scan_word(CagTextScan *s, const char **word);
// Compares the word, ignoring case.
bool cag_scan_is(const char *word, size_t n, const char *expected);
// Skips blanks and reads a decimal number, rounded as by strtod; too large numbers become infinite.
// Returns false, and reads nothing, if there is none.
bool cag_scan_number(CagTextScan *s, double *x);
// Skips blanks and reads an integer. Returns false if there is none, or if it has more than 18
// digits.
bool cag_scan_integer(CagTextScan *s, int64_t *x);

#endif
