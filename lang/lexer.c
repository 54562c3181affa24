// The lexer: one function for each kind of word, selected by the first byte.

#include "lang/lexer.h"

#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <utf8proc.h>

#include "base/array.h"
#include "base/memory.h"
#include "lang/foreign.h"

typedef unsigned char byte;

// ---- errors and tokens ----

static CagDiagnostic *report(CagLexer *lx, CagErrorId id, uint32_t start, uint32_t end,
                             const char *format, ...) __attribute__((format(printf, 5, 6)));
static CagDiagnostic *report(CagLexer *lx, CagErrorId id, uint32_t start, uint32_t end,
                             const char *format, ...) {
  if (!lx->errors) return NULL;
  va_list args;
  va_start(args, format);
  char message[512];
  vsnprintf(message, sizeof message, format, args);
  va_end(args);
  return cag_diagnostics_add(lx->errors, id, lx->source, (CagSpan){start, end}, "%s", message);
}

static void help(CagDiagnostic *d, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void help(CagDiagnostic *d, const char *format, ...) {
  if (!d) return;
  va_list args;
  va_start(args, format);
  char text[256];
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  cag_diagnostic_set_help(d, "%s", text);
}

const char cag_lexer_brace_help[] =
    "the { } of a text contain an expression; write \\{ for a brace, or `...` around the whole text";

static byte at(const CagLexer *lx, uint32_t offset) { return (byte)lx->source->text[offset]; }

static void finish(CagLexer *lx, CagToken *t, CagTokenKind kind, uint32_t end) {
  t->kind = kind;
  t->span.end = end;
  lx->position = end;
}

static void reserve_buffer(CagLexer *lx, size_t size) {
  if (!CAG_RESERVE(lx->buffer, lx->buffer_capacity, size)) cag_memory_leave();
}

// ---- characters ----

// ENDS_RUN: ends a quoted text, or must be replaced in it.
enum { IS_NAME = 1, IS_DIGIT = 2, IS_BLANK = 4, ENDS_RUN = 8 };

static const byte classes[128] = {
    [' '] = IS_BLANK, ['\t'] = IS_BLANK, ['\r'] = IS_BLANK, ['_'] = IS_NAME,   ['0'] = IS_DIGIT,
    ['1'] = IS_DIGIT, ['2'] = IS_DIGIT,  ['3'] = IS_DIGIT,  ['4'] = IS_DIGIT,  ['5'] = IS_DIGIT,
    ['6'] = IS_DIGIT, ['7'] = IS_DIGIT,  ['8'] = IS_DIGIT,  ['9'] = IS_DIGIT,  ['a'] = IS_NAME,
    ['b'] = IS_NAME,  ['c'] = IS_NAME,   ['d'] = IS_NAME,   ['e'] = IS_NAME,   ['f'] = IS_NAME,
    ['g'] = IS_NAME,  ['h'] = IS_NAME,   ['i'] = IS_NAME,   ['j'] = IS_NAME,   ['k'] = IS_NAME,
    ['l'] = IS_NAME,  ['m'] = IS_NAME,   ['n'] = IS_NAME,   ['o'] = IS_NAME,   ['p'] = IS_NAME,
    ['q'] = IS_NAME,  ['r'] = IS_NAME,   ['s'] = IS_NAME,   ['t'] = IS_NAME,   ['u'] = IS_NAME,
    ['v'] = IS_NAME,  ['w'] = IS_NAME,   ['x'] = IS_NAME,   ['y'] = IS_NAME,   ['z'] = IS_NAME,
    ['A'] = IS_NAME,  ['B'] = IS_NAME,   ['C'] = IS_NAME,   ['D'] = IS_NAME,   ['E'] = IS_NAME,
    ['F'] = IS_NAME,  ['G'] = IS_NAME,   ['H'] = IS_NAME,   ['I'] = IS_NAME,   ['J'] = IS_NAME,
    ['K'] = IS_NAME,  ['L'] = IS_NAME,   ['M'] = IS_NAME,   ['N'] = IS_NAME,   ['O'] = IS_NAME,
    ['P'] = IS_NAME,  ['Q'] = IS_NAME,   ['R'] = IS_NAME,   ['S'] = IS_NAME,   ['T'] = IS_NAME,
    ['U'] = IS_NAME,  ['V'] = IS_NAME,   ['W'] = IS_NAME,   ['X'] = IS_NAME,   ['Y'] = IS_NAME,
    ['Z'] = IS_NAME,  ['"'] = ENDS_RUN,  ['{'] = ENDS_RUN,  ['\\'] = ENDS_RUN, ['\n'] = ENDS_RUN,
    [0] = ENDS_RUN,
};

static bool is_digit(byte c) { return c < 128 && (classes[c] & IS_DIGIT); }

// Returns the character at an offset and its length in bytes. The source is valid UTF-8.
static int32_t code_point(const CagLexer *lx, uint32_t offset, uint32_t *length) {
  utf8proc_int32_t c = -1;
  utf8proc_ssize_t n = utf8proc_iterate((const byte *)lx->source->text + offset,
                                        (utf8proc_ssize_t)(lx->source->length - offset), &c);
  *length = n > 0 ? (uint32_t)n : 1;
  return c;
}

static bool is_letter(int32_t c) {
  utf8proc_category_t k = utf8proc_category(c);
  return (k >= UTF8PROC_CATEGORY_LU && k <= UTF8PROC_CATEGORY_LO) || k == UTF8PROC_CATEGORY_NL;
}

// Tests for characters that can follow the first letter, including marks, so that decomposed and
// composed forms become the same name.
static bool continues_name(int32_t c) {
  utf8proc_category_t k = utf8proc_category(c);
  return is_letter(c) || k == UTF8PROC_CATEGORY_ND || k == UTF8PROC_CATEGORY_MN ||
         k == UTF8PROC_CATEGORY_MC;
}

// Returns the end of the name characters from `offset` on. *ascii is set if all are ASCII.
static uint32_t name_end(const CagLexer *lx, uint32_t offset, bool *ascii) {
  *ascii = true;
  for (;;) {
    byte c = at(lx, offset);
    if (c < 128) {
      if (!(classes[c] & (IS_NAME | IS_DIGIT))) return offset;
      offset++;
      continue;
    }
    uint32_t n;
    if (!continues_name(code_point(lx, offset, &n))) return offset;
    *ascii = false;
    offset += n;
  }
}

static bool begins_name(const CagLexer *lx, uint32_t offset) {
  byte c = at(lx, offset);
  if (c < 128) return classes[c] & IS_NAME;
  uint32_t n;
  return is_letter(code_point(lx, offset, &n));
}

// ---- comments and blanks ----

static void keep_comment(CagLexer *lx, uint32_t start, uint32_t end, bool doc, bool block) {
  if (!lx->keep_comments) return;
  if (!CAG_RESERVE(lx->comments, lx->comment_capacity, lx->comment_count + 1)) cag_memory_leave();
  lx->comments[lx->comment_count++] = (CagComment){{start, end}, doc, block};
}

static void skip_line_comment(CagLexer *lx) {
  uint32_t start = lx->position;
  const char *text = lx->source->text;
  const char *newline = memchr(text + start, '\n', lx->source->length - start);
  uint32_t end = newline ? (uint32_t)(newline - text) : (uint32_t)lx->source->length;
  lx->position = end;
  if (end > start && text[end - 1] == '\r') end--;
  bool doc = text[start + 1] == '/' && text[start + 2] == '/' && text[start + 3] != '/';
  keep_comment(lx, start, end, doc, false);
}

// "/*" { comment | character } "*/". Returns false if the end is missing.
static bool skip_block_comment(CagLexer *lx, bool *newline) {
  uint32_t start = lx->position, p = start + 2, depth = 1, length = (uint32_t)lx->source->length;
  while (depth) {
    if (p >= length) {
      lx->position = length;
      lx->cut_off = true;
      help(report(lx, CAG_ERR_comment_not_closed, start, start + 2, "this comment is never closed"),
           "close it with */");
      return false;
    }
    byte c = at(lx, p++);
    if (c == '*' && at(lx, p) == '/') depth--, p++;
    else if (c == '/' && at(lx, p) == '*') depth++, p++;
    else if (c == '\n') *newline = true;
  }
  lx->position = p;
  keep_comment(lx, start, p, false, true);
  return true;
}

// A `#`: a comment of another language, or a directive such as #declare.
static void report_hash(CagLexer *lx, uint32_t start) {
  const char *word = lx->source->text + start + 1;
  CagDiagnostic *d =
      report(lx, CAG_ERR_hash_comment, start, start + 1, "comments do not start with #");
  if (strncmp(word, "include", 7) == 0)
    help(d, "write %s", cag_foreign_syntax(CAG_FOREIGN_include_line));
  else if (strncmp(word, "declare", 7) == 0 || strncmp(word, "local", 5) == 0)
    help(d, "write %s", cag_foreign_syntax(CAG_FOREIGN_declare_line));
  else help(d, "a comment starts with //; a color is a text: \"#ff8000\"");
}

// Skips blanks and comments. Returns false after an error that ends the text.
static bool skip_blanks(CagLexer *lx, bool *newline) {
  for (;;) {
    byte c = at(lx, lx->position);
    if (c < 128 && (classes[c] & IS_BLANK)) {
      lx->position++;
    } else if (c == '\n') {
      *newline = true;
      lx->position++;
    } else if (c == '/' && at(lx, lx->position + 1) == '/') {
      skip_line_comment(lx);
    } else if (c == '/' && at(lx, lx->position + 1) == '*') {
      if (!skip_block_comment(lx, newline)) return false;
    } else if (c == '#') {
      uint32_t start = lx->position;
      report_hash(lx, start);
      skip_line_comment(lx);
    } else if (c >= 128) { // no-break and other spaces, often from pasted text
      uint32_t n;
      int32_t wide = code_point(lx, lx->position, &n);
      bool mark = wide == 0xfeff && lx->position == 0;
      if (!mark && utf8proc_category(wide) != UTF8PROC_CATEGORY_ZS) return true;
      lx->position += n;
    } else {
      return true;
    }
  }
}

// ---- numbers ----

// A unit is `factor` times ten to the power of `shift`, so that the decimal digits of a number can
// be scaled before they are rounded: 2.3cm is exactly 23.
typedef struct Unit {
  const char *name;
  int factor, shift;
  bool angle;
} Unit;

static const Unit units[] = {
    {"mm", 1, 0, false},  {"cm", 1, 1, false},    {"m", 1, 3, false},
    {"um", 1, -3, false}, {"in", 254, -1, false}, {"ft", 3048, -1, false},
    {"deg", 1, 0, true},  {"turn", 360, 0, true}, {"rad", 0, 0, true}, // factor 0: use pi
};
#define UNIT_COUNT (sizeof units / sizeof *units)

static const Unit *find_unit(const char *name, size_t length) {
  for (size_t i = 0; i < UNIT_COUNT; i++)
    if (strlen(units[i].name) == length && memcmp(units[i].name, name, length) == 0)
      return &units[i];
  return NULL;
}

bool cag_lexer_is_unit(const char *name) { return find_unit(name, strlen(name)) != NULL; }

double cag_lexer_unit_length(const char *name) {
  const Unit *unit = find_unit(name, strlen(name));
  if (!unit || unit->angle) return 0;
  // Dividing rounds once: 0.1 as a factor would not be exact.
  return unit->shift < 0 ? unit->factor / pow(10, -unit->shift)
                         : unit->factor * pow(10, unit->shift);
}

// Reports an unknown unit, and suggests the one that was probably meant.
static void unknown_unit(CagLexer *lx, uint32_t number, uint32_t start, uint32_t end) {
  const char *text = lx->source->text;
  int digits = (int)(start - number), length = (int)(end - start);
  if (length > 40 || digits > 40) {
    report(lx, CAG_ERR_unknown_unit, start, end, "a number is followed directly by a long word");
    return;
  }
  if (text[start] == '_') {
    help(report(lx, CAG_ERR_number_underscore, number, end,
                "`_` in a number must be between two digits"),
         "write %.*s", digits, text + number);
    return;
  }
  CagDiagnostic *d =
      report(lx, CAG_ERR_unknown_unit, start, end, "unknown unit `%.*s`", length, text + start);
  static const struct {
    const char *said, *meant;
  } habits[] = {{"degrees", "deg"}, {"degree", "deg"}, {"radians", "rad"}, {"radian", "rad"},
                {"turns", "turn"},  {"inch", "in"},    {"inches", "in"},   {"feet", "ft"},
                {"foot", "ft"},     {"meters", "m"},   {"metres", "m"}};
  const char *meant = NULL;
  for (size_t i = 0; i < sizeof habits / sizeof *habits; i++)
    if (strlen(habits[i].said) == (size_t)length &&
        memcmp(habits[i].said, text + start, (size_t)length) == 0)
      meant = habits[i].meant;
  if (!meant) {
    char word[44];
    const char *names[UNIT_COUNT];
    for (size_t i = 0; i < UNIT_COUNT; i++) names[i] = units[i].name;
    snprintf(word, sizeof word, "%.*s", length, text + start);
    meant = length > 1 ? cag_nearest_name(word, names, UNIT_COUNT) : NULL;
  }
  if (meant)
    help(d, "write %.*s%s, or %.*s * %.*s", digits, text + number, meant, digits, text + number,
         length, text + start);
  else help(d, "to multiply, write %.*s * %.*s", digits, text + number, length, text + start);
}

static const double powers_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                       1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
#define EXACT_POWER 22                     // largest power of ten that a double holds exactly
#define EXACT_INTEGER ((uint64_t)1 << 53)  // integers up to it are exact in a double
#define MANTISSA_LIMIT ((uint64_t)1 << 59) // another digit still fits in 64 bits
#define EXPONENT_LIMIT 100000              // with larger exponents, every number is 0 or overflows

// Computes mantissa * 10^exponent, correctly rounded, if both are exact in doubles (Clinger 1990).
// Returns false otherwise.
static bool exact_value(uint64_t mantissa, long exponent, double *value) {
  if (mantissa > EXACT_INTEGER || exponent < -EXACT_POWER || exponent > EXACT_POWER) return false;
  double m = (double)mantissa;
  *value = exponent < 0 ? m / powers_of_ten[-exponent] : m * powers_of_ten[exponent];
  return true;
}

// Converts the number in [start, end) times 10^shift, with the C library in the C locale.
static double slow_value(CagLexer *lx, uint32_t start, uint32_t end, int shift) {
  size_t needed = end - start + 1, n = 0;
  reserve_buffer(lx, needed);
  for (uint32_t i = start; i < end; i++)
    if (at(lx, i) != '_') lx->buffer[n++] = (char)at(lx, i);
  lx->buffer[n] = 0;
  if (!lx->locale) lx->locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  double v = lx->locale ? strtod_l(lx->buffer, NULL, lx->locale) : strtod(lx->buffer, NULL);
  return shift < 0 ? v / powers_of_ten[-shift] : v * powers_of_ten[shift];
}

typedef struct Decimal {
  uint64_t mantissa;
  long exponent;
  bool whole; // all digits fit in the mantissa
} Decimal;

static uint32_t read_digits(CagLexer *lx, uint32_t p, Decimal *d, bool fraction) {
  for (;;) {
    byte c = at(lx, p);
    if (c == '_' && is_digit(at(lx, p + 1))) {
      p++;
      continue;
    }
    if (!is_digit(c)) return p;
    if (d->mantissa < MANTISSA_LIMIT) {
      d->mantissa = 10 * d->mantissa + (c - '0');
      d->exponent -= fraction;
    } else {
      d->whole = d->whole && c == '0';
      d->exponent += !fraction;
    }
    p++;
  }
}

static uint32_t read_exponent(CagLexer *lx, uint32_t p, Decimal *d) {
  if ((at(lx, p) | 0x20) != 'e') return p;
  uint32_t q = p + 1;
  bool negative = at(lx, q) == '-';
  if (negative || at(lx, q) == '+') q++;
  if (!is_digit(at(lx, q))) return p;
  long e = 0;
  for (; is_digit(at(lx, q)); q++)
    if (e < EXPONENT_LIMIT) e = 10 * e + (at(lx, q) - '0');
  d->exponent += negative ? -e : e;
  return q;
}

// number = digits [ "." digits ] [ ("e" | "E") [ "+" | "-" ] digits ] [ unit ]
static void lex_number(CagLexer *lx, CagToken *t) {
  uint32_t start = t->span.start;
  Decimal d = {0, 0, true};
  uint32_t p = read_digits(lx, start, &d, false);
  if (at(lx, p) == '.' && is_digit(at(lx, p + 1))) p = read_digits(lx, p + 1, &d, true);
  p = read_exponent(lx, p, &d);

  static const Unit plain = {"", 1, 0, false};
  const Unit *unit = &plain;
  uint32_t end = p;
  if (begins_name(lx, p)) {
    bool ascii;
    end = name_end(lx, p, &ascii);
    unit = find_unit(lx->source->text + p, end - p);
    if (!unit) {
      unknown_unit(lx, start, p, end);
      unit = &plain;
    }
  } else if (at(lx, p) == 0xc2 && at(lx, p + 1) == 0xb0) { // the degree sign
    end = p + 2;
    help(report(lx, CAG_ERR_unknown_unit, p, end, "the degree sign is not a unit"), "write %.*sdeg",
         (int)(p - start > 40 ? 40 : p - start), lx->source->text + start);
    const Unit *degree = find_unit("deg", 3);
    if (degree) unit = degree;
  }

  double value;
  uint64_t factor = unit->factor ? (uint64_t)unit->factor : 1;
  bool exact = d.whole && d.mantissa <= EXACT_INTEGER &&
               exact_value(d.mantissa * factor, d.exponent + unit->shift, &value);
  if (!exact) value = slow_value(lx, start, p, unit->shift) * (double)factor;
  if (unit->factor == 0) value = (double)((long double)value * (180 / 3.14159265358979323846264L));
  if (isinf(value)) {
    help(report(lx, CAG_ERR_number_too_large, start, end, "this number is too large"),
         "the largest is about 1.8e308; an unbounded interval ends at inf");
    value = 0;
  }
  t->as.number = value;
  finish(lx, t, unit->angle ? CAG_TOKEN_ANGLE : CAG_TOKEN_NUMBER, end);
}

// ---- names ----

static void lex_name(CagLexer *lx, CagToken *t) {
  const char *text = lx->source->text;
  const uint32_t start = t->span.start;
  uint32_t end = start, hash = CAG_NAME_HASH;
  byte c;
  for (; (c = (byte)text[end]) < 128 && (classes[c] & (IS_NAME | IS_DIGIT)); end++)
    hash = cag_name_hash(hash, c);
  bool ascii = c < 128;
  CagNameHead *head;
  utf8proc_uint8_t *composed = NULL;
  if (ascii) {
    head = cag_names_intern_hashed(lx->names, text + start, end - start, hash);
    t->as.name = head->bytes;
    finish(lx, t, head->token ? (CagTokenKind)head->token : CAG_TOKEN_NAME, end);
    return;
  }
  end = name_end(lx, start, &ascii);
  if (!ascii && utf8proc_map((const byte *)text + start, (utf8proc_ssize_t)(end - start), &composed,
                             UTF8PROC_COMPOSE | UTF8PROC_STABLE) >= 0) {
    head = cag_names_intern(lx->names, (char *)composed, strlen((char *)composed));
    cag_free(composed);
  } else {
    head = cag_names_intern(lx->names, text + start, end - start);
  }
  t->as.name = head->bytes;
  finish(lx, t, head->token ? (CagTokenKind)head->token : CAG_TOKEN_NAME, end);
}

// ---- texts ----

static void put_bytes(CagLexer *lx, size_t *length, const char *bytes, size_t n) {
  reserve_buffer(lx, *length + n);
  memcpy(lx->buffer + *length, bytes, n);
  *length += n;
}

static void put_byte(CagLexer *lx, size_t *length, char c) {
  reserve_buffer(lx, *length + 1);
  lx->buffer[(*length)++] = c;
}

static void put_code_point(CagLexer *lx, size_t *length, int32_t c) {
  byte bytes[4];
  utf8proc_ssize_t n = utf8proc_encode_char(c, bytes);
  for (utf8proc_ssize_t i = 0; i < n; i++) put_byte(lx, length, (char)bytes[i]);
}

// \u{hex}: returns the position after it.
static uint32_t lex_code_point(CagLexer *lx, uint32_t backslash, size_t *length) {
  uint32_t p = backslash + 2;
  int32_t c = 0;
  size_t digits = 0;
  bool good = at(lx, p) == '{';
  if (good)
    for (p++;; p++) {
      byte h = at(lx, p);
      int value = is_digit(h)                              ? h - '0'
                  : (h | 0x20) >= 'a' && (h | 0x20) <= 'f' ? (h | 0x20) - 'a' + 10
                                                           : -1;
      if (value < 0) break;
      if (digits++ < 7) c = 16 * c + value;
    }
  good = good && at(lx, p) == '}' && digits >= 1 && digits <= 6 && utf8proc_codepoint_valid(c);
  if (at(lx, p) == '}') p++;
  if (good) put_code_point(lx, length, c);
  else
    help(
        report(lx, CAG_ERR_bad_code_point, backslash, p, "this escape sequence is not a character"),
        "\\u{3b8} contains one to six hexadecimal digits, up to 10FFFF");
  return p;
}

static uint32_t lex_escape(CagLexer *lx, uint32_t backslash, size_t *length) {
  byte c = at(lx, backslash + 1);
  switch (c) {
  case 'n': put_byte(lx, length, '\n'); break;
  case 't': put_byte(lx, length, '\t'); break;
  case '"':
  case '\\':
  case '{':
  case '}': put_byte(lx, length, (char)c); break;
  case 'u': return lex_code_point(lx, backslash, length);
  default: {
    if (c == 0 || c == '\n' || c == '\r') return backslash + 1; // the missing quote is reported
    uint32_t n;
    code_point(lx, backslash + 1, &n);
    CagDiagnostic *d =
        report(lx, CAG_ERR_unknown_escape, backslash, backslash + 1 + n,
               "`%.*s` is not an escape sequence", (int)n + 1, lx->source->text + backslash);
    if (c == 'x') help(d, "write \\u{41} for the character with the number 41");
    else if (c == 'r') help(d, "write \\u{d} for a carriage return");
    else if (c == '\'') help(d, "a single quote needs no backslash");
    else
      help(d, "the escape sequences are \\\" \\\\ \\n \\t \\{ \\} \\u{...}; a backslash is \\\\");
    return backslash + 1 + n;
  }
  }
  return backslash + 2;
}

static void text_not_closed(CagLexer *lx, CagToken *t, uint32_t quote, uint32_t end) {
  while (end > quote + 1 && (at(lx, end - 1) == '\r' || at(lx, end - 1) == ' ')) end--;
  CagDiagnostic *d =
      report(lx, CAG_ERR_text_not_closed, quote, end, "this text is not closed on its line");
  if (lx->text_count) help(d, "%s", cag_lexer_brace_help);
  else help(d, "close it with \"; a line break inside is \\n");
  lx->text_count = 0;
  t->kind = CAG_TOKEN_ERROR;
}

// Reads the part of a text from `p` to its closing quote or its next `{`. `quote` is the start of
// the whole text. `inside`: the part starts after a `}`.
static void lex_text(CagLexer *lx, CagToken *t, uint32_t quote, uint32_t p, bool inside) {
  size_t length = 0;
  for (;;) {
    const uint32_t from = p;
    byte c;
    while (!(c = at(lx, p), c < 128 && (classes[c] & ENDS_RUN))) p++;
    put_bytes(lx, &length, lx->source->text + from, p - from);
    if (c == '"' || c == '{') break;
    if (c == '\n' || p >= lx->source->length) {
      lx->position = p;
      t->span.end = p;
      text_not_closed(lx, t, quote, p);
      return;
    }
    if (c == '\\') {
      p = lex_escape(lx, p, &length);
    } else {
      put_byte(lx, &length, (char)c);
      p++;
    }
  }
  bool last = at(lx, p) == '"';
  t->as.text.bytes = cag_arena_copy(lx->arena, lx->buffer, length);
  t->as.text.length = length;
  finish(lx, t,
         inside ? (last ? CAG_TOKEN_TEXT_TAIL : CAG_TOKEN_TEXT_MIDDLE)
                : (last ? CAG_TOKEN_TEXT : CAG_TOKEN_TEXT_HEAD),
         p + 1);
  if (inside && last) lx->text_count--;
  if (!inside && !last) {
    if (!CAG_RESERVE(lx->texts, lx->text_capacity, lx->text_count + 1)) cag_memory_leave();
    lx->texts[lx->text_count++] = (CagOpenText){quote, 0};
  }
}

// "`" { character } "`"
static void lex_raw_text(CagLexer *lx, CagToken *t) {
  uint32_t start = t->span.start + 1;
  const char *text = lx->source->text;
  const char *close = memchr(text + start, '`', lx->source->length - start);
  if (!close) {
    lx->cut_off = true;
    help(report(lx, CAG_ERR_raw_text_not_closed, start - 1, start, "this raw text is never closed"),
         "close it with `");
    finish(lx, t, CAG_TOKEN_ERROR, (uint32_t)lx->source->length);
    return;
  }
  uint32_t end = (uint32_t)(close - text);
  if (lx->text_count) { // a text ends on its line, with everything in its { }
    const char *newline = memchr(text + start, '\n', end - start);
    if (newline) {
      finish(lx, t, CAG_TOKEN_ERROR, (uint32_t)(newline - text));
      text_not_closed(lx, t, lx->texts[0].start, t->span.end);
      return;
    }
  }
  t->as.text.bytes = cag_arena_copy(lx->arena, text + start, end - start);
  t->as.text.length = end - start;
  finish(lx, t, CAG_TOKEN_TEXT, end + 1);
}

// Reports 'text', and reads it as a text if it ends on its line.
static void lex_single_quotes(CagLexer *lx, CagToken *t) {
  uint32_t start = t->span.start, p = start + 1;
  while (p < lx->source->length && at(lx, p) != '\n' && at(lx, p) != '\'') p++;
  bool closed = at(lx, p) == '\'';
  uint32_t end = closed ? p + 1 : start + 1;
  CagDiagnostic *d =
      report(lx, CAG_ERR_single_quotes, start, end, "texts are written in double quotes");
  if (closed && p - start - 1 <= 60)
    help(d, "write \"%.*s\"", (int)(p - start - 1), lx->source->text + start + 1);
  else help(d, "write \"text\"");
  if (closed) {
    t->as.text.bytes = cag_arena_copy(lx->arena, lx->source->text + start + 1, p - start - 1);
    t->as.text.length = p - start - 1;
  }
  finish(lx, t, closed ? CAG_TOKEN_TEXT : CAG_TOKEN_ERROR, end);
}

// ---- signs ----

// A sign of the language, or of another language with its equivalent. The first match is taken, so
// longer signs come before their prefixes.
typedef struct Sign {
  const char *spelling;
  CagTokenKind kind;
  const char *meant; // NULL: a sign of the language
  CagErrorId error;
} Sign;

#define OUR(spelling, kind)                                                                        \
  { spelling, CAG_TOKEN_##kind, NULL, CAG_ERR_COUNT }
#define THEIR(spelling, kind, meant, error)                                                        \
  { spelling, CAG_TOKEN_##kind, meant, CAG_ERR_##error }

static const Sign signs[] = {
    THEIR("===", EQUAL, "==", foreign_operator),
    THEIR("!==", NOT_EQUAL, "!=", foreign_operator),
    THEIR("**=", ASSIGN_OPERATOR, "^", power_operator),
    THEIR("<>", NOT_EQUAL, "!=", foreign_operator),
    THEIR("->", ARROW, "=>", foreign_operator),
    THEIR(":=", EQUALS, "=", foreign_operator),
    THEIR("&&", AND, "and", logic_operator),
    THEIR("||", OR, "or", logic_operator),
    THEIR("**", CARET, "^", power_operator),
    OUR("..<", RANGE_OPEN),
    OUR("...", SPREAD),
    OUR("..", RANGE),
    OUR("==", EQUAL),
    OUR("!=", NOT_EQUAL),
    OUR("<=", LESS_EQUAL),
    OUR(">=", GREATER_EQUAL),
    OUR("=>", ARROW),
    OUR("|>", PIPE),
    OUR("+=", ASSIGN_OPERATOR),
    OUR("-=", ASSIGN_OPERATOR),
    OUR("*=", ASSIGN_OPERATOR),
    OUR("/=", ASSIGN_OPERATOR),
    OUR("%=", ASSIGN_OPERATOR),
    OUR("^=", ASSIGN_OPERATOR),
    OUR("|=", ASSIGN_OPERATOR),
    OUR("&=", ASSIGN_OPERATOR),
    OUR("(", LEFT_PAREN),
    OUR(")", RIGHT_PAREN),
    OUR("[", LEFT_SQUARE),
    OUR("]", RIGHT_SQUARE),
    OUR("{", LEFT_BRACE),
    OUR("}", RIGHT_BRACE),
    OUR(",", COMMA),
    OUR(":", COLON),
    OUR(";", SEMICOLON),
    OUR(".", DOT),
    OUR("=", EQUALS),
    OUR("<", LESS),
    OUR(">", GREATER),
    OUR("+", PLUS),
    OUR("-", MINUS),
    OUR("*", STAR),
    OUR("/", SLASH),
    OUR("%", PERCENT),
    OUR("|", BAR),
    OUR("&", AMPERSAND),
    OUR("^", CARET),
    OUR("?", QUESTION),
    THEIR("!", NOT, "not", not_operator),
};

// Signs of one byte that are not the start of a longer one, for speed.
static const byte single[128] = {
    ['('] = CAG_TOKEN_LEFT_PAREN,   [')'] = CAG_TOKEN_RIGHT_PAREN, ['['] = CAG_TOKEN_LEFT_SQUARE,
    [']'] = CAG_TOKEN_RIGHT_SQUARE, ['{'] = CAG_TOKEN_LEFT_BRACE,  ['}'] = CAG_TOKEN_RIGHT_BRACE,
    [','] = CAG_TOKEN_COMMA,        [';'] = CAG_TOKEN_SEMICOLON,   ['?'] = CAG_TOKEN_QUESTION,
};

// Signs of one byte that may also be the start of a longer one: they stand alone unless a byte of
// `lengthens` follows.
static const byte alone[128] = {
    ['.'] = CAG_TOKEN_DOT,     [':'] = CAG_TOKEN_COLON,   ['='] = CAG_TOKEN_EQUALS,
    ['<'] = CAG_TOKEN_LESS,    ['>'] = CAG_TOKEN_GREATER, ['+'] = CAG_TOKEN_PLUS,
    ['-'] = CAG_TOKEN_MINUS,   ['*'] = CAG_TOKEN_STAR,    ['/'] = CAG_TOKEN_SLASH,
    ['%'] = CAG_TOKEN_PERCENT, ['|'] = CAG_TOKEN_BAR,     ['&'] = CAG_TOKEN_AMPERSAND,
    ['^'] = CAG_TOKEN_CARET,
};
static const bool lengthens[256] = {
    ['='] = true, ['>'] = true, ['<'] = true, ['.'] = true,
    ['|'] = true, ['&'] = true, ['*'] = true,
};

// Characters of mathematics and word processors, and their equivalents.
static const struct {
  int32_t character;
  const char *meant;
} typeset[] = {
    {0xd7, "*"},         {0xf7, "/"},     {0x2212, "-"},  {0x2013, "-"},  {0x2014, "-"},
    {0x22c5, "*"},       {0xb7, "*"},     {0x2264, "<="}, {0x2265, ">="}, {0x2260, "!="},
    {0x2026, "..."},     {0x201c, "\""},  {0x201d, "\""}, {0x2018, "\""}, {0x2019, "\""},
    {0x221a, "sqrt(x)"}, {0x221e, "inf"}, {0x2208, "in"}, {0xb2, "^2"},   {0xb3, "^3"},
    {0x2192, "=>"},      {0xff0c, ","},   {0xff08, "("},  {0xff09, ")"},  {0xb0, "deg"},
};

// Recognizes special variables of OpenSCAD, such as $fn, which are not supported.
static bool special_variable(CagLexer *lx, CagToken *t) {
  static const struct {
    const char *name;
    CagForeignSyntax form;
  } known[] = {{"$fn", CAG_FOREIGN_special_fn},
               {"$fa", CAG_FOREIGN_special_fn},
               {"$fs", CAG_FOREIGN_special_fn},
               {"$t", CAG_FOREIGN_special_t},
               {"$children", CAG_FOREIGN_special_children}};
  const char *text = lx->source->text;
  uint32_t start = t->span.start, end = start + 1;
  while (at(lx, end) < 128 && classes[at(lx, end)] & (IS_NAME | IS_DIGIT)) end++;
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    if (strlen(known[i].name) != end - start || memcmp(known[i].name, text + start, end - start))
      continue;
    help(report(lx, CAG_ERR_unknown_character, start, end, "unknown name `%s`", known[i].name),
         "write %s", cag_foreign_syntax(known[i].form));
    finish(lx, t, CAG_TOKEN_ERROR, end);
    return true;
  }
  return false;
}

static void unknown_character(CagLexer *lx, CagToken *t) {
  uint32_t start = t->span.start, n;
  int32_t c = code_point(lx, start, &n);
  CagDiagnostic *d;
  if (c == '$' && special_variable(lx, t)) return;
  if (c < 32 || c == 127)
    d = report(lx, CAG_ERR_unknown_character, start, start + n,
               "the control character U+%04X is not allowed here", (unsigned)c);
  else
    d = report(lx, CAG_ERR_unknown_character, start, start + n, "`%.*s` is not allowed here",
               (int)n, lx->source->text + start);
  for (size_t i = 0; i < sizeof typeset / sizeof *typeset; i++)
    if (typeset[i].character == c) help(d, "write %s", typeset[i].meant);
  if (c == '~') help(d, "the negation of a condition is `not c`");
  if (c == '\\') help(d, "a function is written x => e; a line continues after an operator");
  if (c == '@') help(d, "a product of transforms is written A * B");
  finish(lx, t, CAG_TOKEN_ERROR, start + n);
}

static void lex_sign(CagLexer *lx, CagToken *t) {
  const char *p = lx->source->text + t->span.start;
  const byte one = (byte)*p;
  if (one < 128 && alone[one] && !lengthens[(byte)p[1]]) {
    finish(lx, t, alone[one], t->span.start + 1);
    return;
  }
  for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
    const Sign *s = &signs[i];
    if (*s->spelling != *p) continue;
    size_t n = strlen(s->spelling);
    if (strncmp(s->spelling, p, n) != 0) continue;
    uint32_t end = t->span.start + (uint32_t)n;
    finish(lx, t, s->kind, end);
    if (s->kind >= CAG_TOKEN_FIRST_WORD) // && is read as the word `and`
      t->as.name = cag_names_intern(lx->names, s->meant, strlen(s->meant))->bytes;
    if (s->meant)
      help(report(lx, s->error, t->span.start, end, "`%s` is not an operator here", s->spelling),
           "write %s", s->meant);
    return;
  }
  unknown_character(lx, t);
}

// Counts braces inside the { } of a text. Returns true for the one that ends the expression.
static bool ends_interpolation(CagLexer *lx, CagTokenKind kind) {
  if (lx->text_count == 0) return false;
  CagOpenText *text = &lx->texts[lx->text_count - 1];
  if (kind == CAG_TOKEN_LEFT_BRACE) text->braces++;
  if (kind != CAG_TOKEN_RIGHT_BRACE) return false;
  if (text->braces == 0) return true;
  text->braces--;
  return false;
}

void cag_lexer_next(CagLexer *lx, CagToken *t) {
  cag_source_check(lx->source);
  t->newline_before = false;
  bool whole = skip_blanks(lx, &t->newline_before);
  uint32_t start = lx->position;
  t->span = (CagSpan){start, start};
  t->comments = (uint32_t)lx->comment_count;
  t->kind = CAG_TOKEN_ERROR;
  if (!whole) {
    lx->text_count = 0;
    return;
  }
  if (lx->text_count && (t->newline_before || start >= lx->source->length)) {
    uint32_t quote = lx->texts[0].start;
    const char *text = lx->source->text;
    const char *newline = memchr(text + quote, '\n', lx->source->length - quote);
    text_not_closed(lx, t, quote, newline ? (uint32_t)(newline - text) : start);
    return;
  }
  if (start >= lx->source->length) {
    finish(lx, t, CAG_TOKEN_END, start);
    return;
  }
  byte c = at(lx, start);
  if (c >= 128) {
    if (begins_name(lx, start)) lex_name(lx, t);
    else unknown_character(lx, t);
  } else if (classes[c] & IS_NAME) {
    lex_name(lx, t);
  } else if (classes[c] & IS_DIGIT) {
    lex_number(lx, t);
  } else if (single[c]) {
    if (ends_interpolation(lx, single[c]))
      lex_text(lx, t, lx->texts[lx->text_count - 1].start, start + 1, true);
    else finish(lx, t, single[c], start + 1);
  } else if (c == '"') {
    lex_text(lx, t, start, start + 1, false);
  } else if (c == '`') {
    lex_raw_text(lx, t);
  } else if (c == '\'') {
    lex_single_quotes(lx, t);
  } else {
    lex_sign(lx, t);
  }
}

// ---- interface ----

static const char *const whats[] = {
#define CAG_TOKEN(name, what) what,
    CAG_TOKENS(CAG_TOKEN)
#undef CAG_TOKEN
};
#define TOKEN_COUNT (sizeof whats / sizeof *whats)

const char *cag_token_what(CagTokenKind kind) { return whats[kind]; }

// Extracts the spelling of a reserved word from its name in messages, by removing the quotes.
static size_t reserved_word(size_t kind, const char **word) {
  *word = whats[kind] + 1;
  return strlen(*word) - 1;
}

bool cag_word_is_reserved(const char *name) {
  for (size_t k = CAG_TOKEN_FIRST_WORD; k < TOKEN_COUNT; k++) {
    const char *word;
    size_t n = reserved_word(k, &word);
    if (strlen(name) == n && memcmp(name, word, n) == 0) return true;
  }
  return false;
}

void cag_lexer_init(CagLexer *lx, const CagSource *source, CagArena *arena, CagNames *names,
                    CagDiagnostics *errors) {
  *lx = (CagLexer){.source = source, .arena = arena, .names = names, .errors = errors};
  lx->keep_comments = true;
  reserve_buffer(lx, 1);
  for (size_t k = CAG_TOKEN_FIRST_WORD; k < TOKEN_COUNT; k++) {
    const char *word;
    size_t n = reserved_word(k, &word);
    cag_names_intern(names, word, n)->token = (uint32_t)k;
  }
}

void cag_lexer_probe(CagLexer *probe, const CagLexer *lx, uint32_t position) {
  *probe = (CagLexer){.source = lx->source, .arena = lx->arena, .names = lx->names};
  probe->position = position;
  reserve_buffer(probe, 1);
}

void cag_lexer_release(CagLexer *lx) {
  cag_free(lx->texts);
  cag_free(lx->comments);
  cag_free(lx->buffer);
  if (lx->locale) freelocale(lx->locale);
}
