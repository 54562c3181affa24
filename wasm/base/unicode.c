// Replaces the functions of utf8proc that need its tables. HarfBuzz has smaller tables of the same
// version of Unicode for most of the same questions (hb-unicode.h).

#include <hb.h>
#include <stdbool.h>
#include <stdlib.h>
#include <utf8proc.h>

// A character has up to four characters of its canonical decomposition (Unicode Standard Annex 15).
#define DECOMPOSED_MOST 4

static hb_unicode_funcs_t *unicode(void) { return hb_unicode_funcs_get_default(); }

// --- Properties ---

utf8proc_category_t utf8proc_category(utf8proc_int32_t c) {
#define X(theirs, name) [HB_UNICODE_GENERAL_CATEGORY_##theirs] = UTF8PROC_CATEGORY_##name,
  static const unsigned char categories[] = {
      X(CONTROL, CC) X(FORMAT, CF) X(UNASSIGNED, CN) X(PRIVATE_USE, CO) X(SURROGATE, CS) X(
          LOWERCASE_LETTER, LL) X(MODIFIER_LETTER, LM) X(OTHER_LETTER, LO) X(TITLECASE_LETTER, LT)
          X(UPPERCASE_LETTER, LU) X(SPACING_MARK, MC) X(ENCLOSING_MARK, ME) X(NON_SPACING_MARK, MN)
              X(DECIMAL_NUMBER, ND) X(LETTER_NUMBER, NL) X(OTHER_NUMBER, NO)
                  X(CONNECT_PUNCTUATION, PC) X(DASH_PUNCTUATION, PD) X(CLOSE_PUNCTUATION, PE)
                      X(FINAL_PUNCTUATION, PF) X(INITIAL_PUNCTUATION, PI) X(OTHER_PUNCTUATION, PO)
                          X(OPEN_PUNCTUATION, PS) X(CURRENCY_SYMBOL, SC) X(MODIFIER_SYMBOL, SK)
                              X(MATH_SYMBOL, SM) X(OTHER_SYMBOL, SO) X(LINE_SEPARATOR, ZL)
                                  X(PARAGRAPH_SEPARATOR, ZP) X(SPACE_SEPARATOR, ZS)};
#undef X
  if (!utf8proc_codepoint_valid(c)) return UTF8PROC_CATEGORY_CN;
  return categories[hb_unicode_general_category(unicode(), (hb_codepoint_t)c)];
}

// The columns of a terminal that a character takes, by the blocks of Unicode. The page does not ask
// for it.
int utf8proc_charwidth(utf8proc_int32_t c) {
  static const struct {
    utf8proc_int32_t first, last;
  } wide[] = {{0x1100, 0x115f}, {0x2e80, 0x303e},   {0x3041, 0xa4c6},   {0xa960, 0xa97c},
              {0xac00, 0xd7a3}, {0xf900, 0xfad9},   {0xfe30, 0xfe6b},   {0xff01, 0xff60},
              {0xffe0, 0xffe6}, {0x16fe0, 0x1b2fb}, {0x1f300, 0x1f64f}, {0x20000, 0x323af}};
  switch (utf8proc_category(c)) {
  case UTF8PROC_CATEGORY_MN:
  case UTF8PROC_CATEGORY_MC:
  case UTF8PROC_CATEGORY_ME:
  case UTF8PROC_CATEGORY_CC:
  case UTF8PROC_CATEGORY_CF:
  case UTF8PROC_CATEGORY_CS:
  case UTF8PROC_CATEGORY_ZL:
  case UTF8PROC_CATEGORY_ZP: return 0;
  default: break;
  }
  for (size_t i = 0; i < sizeof wide / sizeof *wide; i++)
    if (c >= wide[i].first && c <= wide[i].last) return 2;
  return 1;
}

// --- Upper and lower forms ---

typedef struct CaseRange {
  utf8proc_int32_t first, last, step, delta;
} CaseRange;

// What wasm/case_table.c writes.
#include "case_table.h"

static utf8proc_int32_t form_of(utf8proc_int32_t c, const CaseRange *ranges, size_t n) {
  for (size_t i = 0; i < n && ranges[i].first <= c; i++)
    if (c <= ranges[i].last && (c - ranges[i].first) % ranges[i].step == 0)
      return c + ranges[i].delta;
  return c;
}

utf8proc_int32_t utf8proc_toupper(utf8proc_int32_t c) {
  return form_of(c, upper_ranges, sizeof upper_ranges / sizeof *upper_ranges);
}

utf8proc_int32_t utf8proc_tolower(utf8proc_int32_t c) {
  return form_of(c, lower_ranges, sizeof lower_ranges / sizeof *lower_ranges);
}

// --- Composed form ---

static int class_of(hb_codepoint_t c) { return (int)hb_unicode_combining_class(unicode(), c); }

// Appends the full canonical decomposition of c.
static size_t append_decomposed(hb_codepoint_t c, hb_codepoint_t *to, size_t n) {
  hb_codepoint_t a, b;
  if (!hb_unicode_decompose(unicode(), c, &a, &b)) {
    to[n++] = c;
    return n;
  }
  n = append_decomposed(a, to, n);
  return b ? append_decomposed(b, to, n) : n;
}

// Sorts successive marks by their combining class.
static void order_marks(hb_codepoint_t *c, size_t n) {
  for (size_t i = 1; i < n; i++) {
    const hb_codepoint_t mark = c[i];
    const int class = class_of(mark);
    size_t at = i;
    for (; class && at > 0 && class_of(c[at - 1]) > class; at--) c[at] = c[at - 1];
    c[at] = mark;
  }
}

// Composes characters with what follows and is not blocked. Returns how many are left.
static size_t compose(hb_codepoint_t *c, size_t n) {
  size_t count = 0, starter = n; // n: there is none
  for (size_t i = 0; i < n; i++) {
    const int class = class_of(c[i]);
    const bool next = count > 0 && starter == count - 1;
    const bool blocked = !next && count > 0 && class_of(c[count - 1]) >= class;
    hb_codepoint_t whole;
    if (starter < n && !blocked && hb_unicode_compose(unicode(), c[starter], c[i], &whole)) {
      c[starter] = whole;
      continue;
    }
    if (class == 0) starter = count;
    c[count++] = c[i];
  }
  return count;
}

// Whatever the options, composes.
utf8proc_ssize_t utf8proc_map(const utf8proc_uint8_t *text, utf8proc_ssize_t length,
                              utf8proc_uint8_t **out, utf8proc_option_t options) {
  (void)options;
  hb_codepoint_t *c = malloc(((size_t)length * DECOMPOSED_MOST + 1) * sizeof *c);
  size_t n = 0;
  utf8proc_ssize_t size = 0;
  if (!(*out = (utf8proc_uint8_t *)c)) return UTF8PROC_ERROR_NOMEM;
  for (utf8proc_ssize_t i = 0, bytes; i < length; i += bytes) {
    utf8proc_int32_t point;
    bytes = utf8proc_iterate(text + i, length - i, &point);
    if (bytes <= 0) {
      free(c);
      *out = NULL;
      return UTF8PROC_ERROR_INVALIDUTF8;
    }
    n = append_decomposed((hb_codepoint_t)point, c, n);
  }
  order_marks(c, n);
  n = compose(c, n);
  // A character takes at most four bytes, so those that are not yet read stay.
  for (size_t i = 0; i < n; i++) size += utf8proc_encode_char((utf8proc_int32_t)c[i], *out + size);
  (*out)[size] = 0;
  return size;
}
