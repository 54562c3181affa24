// Basic functions of the parser: tokens, errors, panic mode, brackets, unfinished lists.

#include "lang/parse.h"

#include <stdarg.h>
#include <string.h>

#include "base/array.h"
#include "base/memory.h"

// ---- tokens ----

CagToken *cag_parse_peek(Parser *p, unsigned n) {
  while (p->count <= n) {
    cag_lexer_next(&p->lexer, &p->ahead[(p->first + p->count) % LOOK_AHEAD]);
    p->count++;
  }
  return &p->ahead[(p->first + n) % LOOK_AHEAD];
}

static CagTokenKind closer_of(CagTokenKind opener) {
  switch (opener) {
  case CAG_TOKEN_LEFT_PAREN: return CAG_TOKEN_RIGHT_PAREN;
  case CAG_TOKEN_LEFT_SQUARE: return CAG_TOKEN_RIGHT_SQUARE;
  case CAG_TOKEN_LEFT_BRACE: return CAG_TOKEN_RIGHT_BRACE;
  case CAG_TOKEN_TEXT_HEAD: return CAG_TOKEN_TEXT_TAIL;
  default: return CAG_TOKEN_END;
  }
}

static bool is_closer(CagTokenKind k) {
  return k == CAG_TOKEN_RIGHT_PAREN || k == CAG_TOKEN_RIGHT_SQUARE || k == CAG_TOKEN_RIGHT_BRACE ||
         k == CAG_TOKEN_TEXT_TAIL;
}

static void count_opener(Parser *p, const CagToken *t, CagTokenKind closer) {
  if (p->bracket_count < CAG_MAX_NESTING) {
    p->brackets[p->bracket_count++] = (Bracket){closer, t->span};
    p->open[closer]++;
    return;
  }
  p->excess++;
  cag_parse_error(p, CAG_ERR_too_deep, t->span, "brackets are nested more than %d deep here",
                  CAG_MAX_NESTING);
}

// Removes the bracket that a closer belongs to, and brackets left open inside it. Ignores a closer
// without an opening bracket.
static void count_closer(Parser *p, CagTokenKind closer) {
  if (p->excess) {
    p->excess--;
    return;
  }
  if (p->open[closer] == 0) return;
  CagTokenKind taken;
  do {
    taken = p->brackets[--p->bracket_count].closer;
    p->open[taken]--;
  } while (taken != closer);
}

void cag_parse_skip(Parser *p) {
  CagToken *t = parse_current(p);
  CagTokenKind closer = closer_of(t->kind);
  p->previous = *t;
  if (closer != CAG_TOKEN_END) count_opener(p, t, closer);
  else if (is_closer(t->kind)) count_closer(p, t->kind);
  p->first = (p->first + 1) % LOOK_AHEAD;
  p->count--;
  cag_parse_peek(p, 0);
}

void cag_parse_advance(Parser *p) {
  if (!p->panic) cag_parse_skip(p);
}

bool cag_parse_accept(Parser *p, CagTokenKind kind) {
  if (parse_kind(p) != kind || p->panic) return false;
  cag_parse_skip(p);
  return true;
}

bool cag_parse_at_newline(Parser *p) {
  return p->newlines && !p->panic && parse_current(p)->newline_before;
}

bool cag_parse_is_word(CagTokenKind kind) {
  return kind == CAG_TOKEN_NAME || kind >= CAG_TOKEN_FIRST_WORD;
}

bool cag_parse_begins_expression(CagTokenKind kind) {
  switch (kind) {
  case CAG_TOKEN_NUMBER:
  case CAG_TOKEN_ANGLE:
  case CAG_TOKEN_TEXT:
  case CAG_TOKEN_TEXT_HEAD:
  case CAG_TOKEN_NAME:
  case CAG_TOKEN_LEFT_PAREN:
  case CAG_TOKEN_LEFT_SQUARE:
  case CAG_TOKEN_LEFT_BRACE:
  case CAG_TOKEN_MINUS:
  case CAG_TOKEN_NOT:
  case CAG_TOKEN_IF:
  case CAG_TOKEN_TRUE:
  case CAG_TOKEN_FALSE:
  case CAG_TOKEN_NONE: return true;
  default: return false;
  }
}

bool cag_parse_token_is(Parser *p, const CagToken *t, const char *name) {
  (void)p;
  return t->kind == CAG_TOKEN_NAME && strcmp(t->as.name, name) == 0;
}

// ---- the start of statements ----

// The maximum number of words of a parameter list that are searched for its `=`.
#define LONGEST_PARAMETER_LIST 4096
// After this many words were searched in vain, only short lists are searched. Otherwise a text of
// only opening brackets would take quadratic time.
#define VAIN_LIMIT ((size_t)1 << 20)
#define VAIN_LENGTH 64

void cag_parse_probe_end(Parser *p) {
  cag_lexer_release(&p->probe);
  p->probe = (CagLexer){0};
  cag_source_free(p->probe_source);
  p->probe_source = NULL;
}

CagTokenKind cag_parse_behind_bracket(Parser *p, uint32_t start) {
  cag_lexer_probe(&p->probe, &p->lexer, start);
  CagToken t;
  size_t open = 0, seen = 0, most = p->vain < VAIN_LIMIT ? LONGEST_PARAMETER_LIST : VAIN_LENGTH;
  do {
    cag_lexer_next(&p->probe, &t);
    if (closer_of(t.kind) != CAG_TOKEN_END) open++;
    else if (is_closer(t.kind)) open--;
  } while (open && ++seen < most && t.kind != CAG_TOKEN_END && t.kind != CAG_TOKEN_ERROR);
  if (open == 0) cag_lexer_next(&p->probe, &t);
  else p->vain += seen;
  cag_parse_probe_end(p);
  return open == 0 ? t.kind : CAG_TOKEN_ERROR;
}

bool cag_parse_at_function(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_NAME || parse_kind_at(p, 1) != CAG_TOKEN_LEFT_PAREN) return false;
  const CagToken *paren = cag_parse_peek(p, 1);
  return !paren->newline_before &&
         cag_parse_behind_bracket(p, paren->span.start) == CAG_TOKEN_EQUALS;
}

bool cag_parse_at_tuple(Parser *p) {
  CagTokenKind behind = cag_parse_behind_bracket(p, parse_current(p)->span.start);
  return behind != CAG_TOKEN_ARROW && behind != CAG_TOKEN_ERROR;
}

static bool in_first_column(Parser *p) {
  uint32_t start = parse_current(p)->span.start;
  return start == 0 || p->module->source->text[start - 1] == '\n';
}

bool cag_parse_at_statement(Parser *p) {
  if (p->panic || !in_first_column(p)) return false;
  CagTokenKind next;
  switch (parse_kind(p)) {
  case CAG_TOKEN_IMPORT:
  case CAG_TOKEN_PARAM:
  case CAG_TOKEN_SHOW:
  case CAG_TOKEN_PRINT:
  case CAG_TOKEN_ASSERT: return parse_kind_at(p, 1) != CAG_TOKEN_COLON;
  case CAG_TOKEN_NAME:
    next = parse_kind_at(p, 1);
    if (next == CAG_TOKEN_EQUALS || next == CAG_TOKEN_ASSIGN_OPERATOR) return true;
    if (next == CAG_TOKEN_NAME) return !cag_parse_peek(p, 1)->newline_before;
    return cag_parse_at_function(p);
  case CAG_TOKEN_LEFT_SQUARE:
  case CAG_TOKEN_LEFT_BRACE: return cag_parse_at_pattern(p);
  default: return false;
  }
}

// ---- errors ----

static CagDiagnostic *add_error(Parser *p, CagErrorId id, CagSpan span, const char *format,
                                va_list args) {
  char message[512];
  vsnprintf(message, sizeof message, format, args);
  return cag_diagnostics_add(p->errors, id, p->module->source, span, "%s", message);
}

CagDiagnostic *cag_parse_error(Parser *p, CagErrorId id, CagSpan span, const char *format, ...) {
  if (p->panic) return NULL;
  CagTokenKind kind = parse_current(p)->kind;
  size_t told = p->errors->count + p->errors->dropped - p->first_error;
  if (kind == CAG_TOKEN_END && told == 0) p->cut_off = true;
  if (kind == CAG_TOKEN_ERROR && told == 1 && p->lexer.cut_off) p->cut_off = true;
  p->panic = true;
  if (kind == CAG_TOKEN_ERROR) return NULL; // already reported by the lexer
  va_list args;
  va_start(args, format);
  CagDiagnostic *d = add_error(p, id, span, format, args);
  va_end(args);
  return d;
}

CagDiagnostic *cag_parse_mend(Parser *p, CagErrorId id, CagSpan span, const char *format, ...) {
  if (p->panic) return NULL;
  va_list args;
  va_start(args, format);
  CagDiagnostic *d = add_error(p, id, span, format, args);
  va_end(args);
  return d;
}

void cag_parse_help(CagDiagnostic *d, const char *format, ...) {
  if (!d) return;
  va_list args;
  va_start(args, format);
  char text[512];
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  cag_diagnostic_set_help(d, "%s", text);
}

void cag_parse_related(Parser *p, CagDiagnostic *d, CagSpan span, const char *text) {
  if (d) cag_diagnostic_add_note(d, CAG_NOTE_RELATED, p->module->source, span, "%s", text);
}

const char *cag_parse_quote(Parser *p, CagSpan span, char *buffer, size_t size,
                            const char *else_text) {
  size_t length = span.end - span.start;
  const char *text = p->module->source->text + span.start;
  if (length == 0 || length >= size || memchr(text, '\n', length)) return else_text;
  memcpy(buffer, text, length);
  buffer[length] = 0;
  return buffer;
}

const char *cag_parse_found(Parser *p, char *buffer, size_t size) {
  const CagToken *t = parse_current(p);
  char word[40];
  switch (t->kind) {
  case CAG_TOKEN_END: return p->mode == CAG_PARSE_REPL ? "the end" : "the end of the file";
  case CAG_TOKEN_TEXT:
  case CAG_TOKEN_TEXT_HEAD: return "a text";
  case CAG_TOKEN_TEXT_MIDDLE:
  case CAG_TOKEN_TEXT_TAIL: return "`}`";
  default: break;
  }
  if (!cag_parse_quote(p, t->span, word, sizeof word, NULL)) return cag_token_what(t->kind);
  if (t->kind >= CAG_TOKEN_FIRST_WORD) snprintf(buffer, size, "the reserved word `%s`", word);
  else snprintf(buffer, size, "`%s`", word);
  return buffer;
}

CagSpan cag_parse_here(Parser *p) {
  CagSpan s = parse_current(p)->span;
  if (parse_current(p)->kind == CAG_TOKEN_END) s.start = s.end = p->previous.span.end;
  return s;
}

// Reports the innermost bracket if the text continues, or ends, as if it were closed.
static void report_unclosed(Parser *p) {
  if (p->bracket_count == 0) return;
  if (parse_kind(p) != CAG_TOKEN_END && !cag_parse_at_statement(p)) return;
  const Bracket *b = &p->brackets[p->bracket_count - 1];
  const char *closer = cag_token_what(b->closer);
  if (parse_kind(p) == CAG_TOKEN_END) {
    CagDiagnostic *d = cag_parse_error(p, CAG_ERR_bracket_not_closed, b->span,
                                       "this bracket is never closed: %s is missing", closer);
    cag_parse_help(d, "opened here");
    return;
  }
  CagSpan next = parse_current(p)->span;
  CagDiagnostic *d = cag_parse_error(p, CAG_ERR_bracket_not_closed, b->span,
                                     "this bracket is not closed: %s is missing", closer);
  cag_parse_help(d, "opened here");
  cag_parse_related(p, d, next, "still open where the next statement starts");
}

static void unexpected_closer(Parser *p, const char *found) {
  CagSpan here = cag_parse_here(p);
  if (p->bracket_count == 0) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_bracket_stray, here, "%s closes nothing", found),
                   "no bracket is open here");
    return;
  }
  const Bracket *b = &p->brackets[p->bracket_count - 1];
  CagSpan opener = b->span;
  const char *wanted = cag_token_what(b->closer);
  CagDiagnostic *d =
      cag_parse_error(p, CAG_ERR_bracket_mismatch, here, "expected %s, found %s", wanted, found);
  cag_parse_help(d, "close the inner bracket first");
  cag_parse_related(p, d, opener, "the open bracket");
}

// Reports c ? a : b.
static void report_ternary(Parser *p, const CagExpr *condition) {
  CagSpan here = cag_parse_here(p);
  cag_parse_advance(p);
  CagExpr *a = cag_parse_expression(p), *b = NULL;
  if (cag_parse_accept(p, CAG_TOKEN_COLON)) b = cag_parse_expression(p);
  char first[QUOTE_SIZE], second[QUOTE_SIZE], third[QUOTE_SIZE];
  CagDiagnostic *d = cag_parse_error(p, CAG_ERR_ternary, here, "`?` is not an operator");
  cag_parse_help(d, "write if %s then %s else %s",
                 condition ? cag_parse_quote(p, condition->span, first, sizeof first, "c") : "c",
                 cag_parse_quote(p, a->span, second, sizeof second, "a"),
                 b ? cag_parse_quote(p, b->span, third, sizeof third, "b") : "b");
}

// Reports a `=` in the bracket at the start of a statement, which was meant to be a pattern.
static bool report_open_pattern(Parser *p) {
  const Bracket *b = p->bracket_count ? &p->brackets[p->bracket_count - 1] : NULL;
  if (!b || b->span.start != p->statement_head.start || b->closer != CAG_TOKEN_RIGHT_SQUARE)
    return false;
  const CagSpan equals = cag_parse_here(p), opener = b->span;
  CagDiagnostic *d = cag_parse_error(p, CAG_ERR_bracket_not_closed, opener,
                                     "this bracket is not closed: %s is missing before `=`",
                                     cag_token_what(b->closer));
  cag_parse_help(d, "opened here");
  cag_parse_related(p, d, equals, "the definition of the pattern");
  return true;
}

// Reports words of other languages after a value.
static void report_habit(Parser *p, const CagExpr *before) {
  char text[QUOTE_SIZE];
  CagSpan here = cag_parse_here(p);
  const char *value = before ? cag_parse_quote(p, before->span, text, sizeof text, "a") : "a";
  CagDiagnostic *d;
  switch (parse_kind(p)) {
  case CAG_TOKEN_QUESTION: report_ternary(p, before); return;
  case CAG_TOKEN_EQUALS:
    if (report_open_pattern(p)) return;
    d = cag_parse_error(p, CAG_ERR_equals_in_expression, here,
                        "`=` defines a name, and is not allowed here");
    cag_parse_help(d, "to compare, write ==");
    return;
  case CAG_TOKEN_ASSIGN_OPERATOR:
    d = cag_parse_error(p, CAG_ERR_assignment_operator, here,
                        "values cannot be changed or assigned");
    cag_parse_help(d, "define a new name for the new value");
    return;
  case CAG_TOKEN_NOT:
    if (parse_kind_at(p, 1) != CAG_TOKEN_IN) return;
    here.end = cag_parse_peek(p, 1)->span.end;
    d = cag_parse_error(p, CAG_ERR_not_in, here, "`not in` is not an operator");
    cag_parse_help(d, "write not (%s in xs)", value);
    return;
  case CAG_TOKEN_IF:
    d = cag_parse_error(p, CAG_ERR_trailing_if, here, "the condition comes before the value");
    cag_parse_help(d, "write if c then %s else b", value);
    return;
  case CAG_TOKEN_FOR:
    d = cag_parse_error(p, CAG_ERR_trailing_for, here, "in a comprehension, the loop comes first");
    cag_parse_help(d, "write [for x in xs: %s]", value);
    return;
  case CAG_TOKEN_BY:
    d = cag_parse_error(p, CAG_ERR_by_without_range, here, "`by` needs a range before it");
    cag_parse_help(d, "write 0..10 by 2");
    return;
  case CAG_TOKEN_ARROW:
    d = cag_parse_error(p, CAG_ERR_function_parameters, here,
                        "expected the names of the parameters before `=>`");
    if (before && (before->kind == CAG_EXPR_LIST || before->kind == CAG_EXPR_RECORD))
      cag_parse_help(d, "a pattern stands in parentheses: write (%s) => e", value);
    else cag_parse_help(d, "write x => e or (x, y) => e");
    return;
  case CAG_TOKEN_COLON:
    if (p->bracket_count == 0 || p->brackets[p->bracket_count - 1].closer != CAG_TOKEN_TEXT_TAIL)
      return;
    d = cag_parse_error(p, CAG_ERR_format_spec, here,
                        "the { } of a text contain an expression without a format");
    cag_parse_help(d, "write {text(%s, digits: 2)}", value);
    return;
  default: return;
  }
}

void cag_parse_unexpected(Parser *p, const CagExpr *before, CagErrorId id, const char *wanted) {
  if (p->panic) return;
  report_unclosed(p);
  if (p->panic || cag_parse_foreign_behind(p, before)) return;
  report_habit(p, before);
  if (p->panic) return;
  char word[64];
  CagTokenKind kind = parse_kind(p);
  const char *found = cag_parse_found(p, word, sizeof word);
  if (is_closer(kind) || kind == CAG_TOKEN_TEXT_MIDDLE) {
    unexpected_closer(p, found);
    return;
  }
  bool moved = parse_current(p)->newline_before;
  CagDiagnostic *d =
      cag_parse_error(p, id, cag_parse_here(p), "expected %s, found %s", wanted, found);
  if (kind == CAG_TOKEN_LEFT_PAREN && moved && before)
    cag_parse_help(
        d, "a comma is missing before it, or the `(` of a call is not on the line of the function");
  else if (kind == CAG_TOKEN_LEFT_SQUARE && moved && before)
    cag_parse_help(
        d, "a comma is missing before it, or the `[` of an index is not on the line of the list");
  else if (id == CAG_ERR_expected_separator && cag_parse_begins_expression(kind))
    cag_parse_help(d, "a comma or an operator is missing before it");
  else if (id == CAG_ERR_expected_end && cag_parse_begins_expression(kind))
    cag_parse_help(d, "an operator is missing before it, or a line break");
  else if (kind == CAG_TOKEN_SPREAD) cag_parse_help(d, "a range is written 0..3");
  else if (kind == CAG_TOKEN_SEMICOLON)
    cag_parse_help(d, "separate the items in brackets with commas");
}

// ---- brackets ----

Opened cag_parse_open(Parser *p, bool newlines) {
  Opened o = {cag_parse_here(p), p->newlines};
  cag_parse_advance(p);
  p->newlines = newlines;
  return o;
}

bool cag_parse_close(Parser *p, Opened o, CagTokenKind closer, const CagExpr *before,
                     const char *wanted) {
  p->newlines = o.newlines;
  if (cag_parse_accept(p, closer)) return true;
  cag_parse_unexpected(p, before, CAG_ERR_expected_separator, wanted);
  return false;
}

// ---- unfinished lists ----

size_t cag_parse_list_begin(Parser *p) { return p->stack_size; }

void cag_parse_list_push(Parser *p, const void *item, size_t size) {
  if (!CAG_RESERVE(p->stack, p->stack_capacity, p->stack_size + size)) cag_memory_leave();
  memcpy(p->stack + p->stack_size, item, size);
  p->stack_size += size;
}

void *cag_parse_list_end(Parser *p, size_t begin, size_t size, size_t *count) {
  size_t bytes = p->stack_size - begin;
  void *items = cag_arena_alloc(&p->module->arena, bytes);
  if (bytes) memcpy(items, p->stack + begin, bytes);
  p->stack_size = begin;
  *count = bytes / size;
  return items;
}
