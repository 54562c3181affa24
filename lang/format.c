// Formats scripts: converts the tree to documents (layout.h), statement by statement.
//
// Words are copied from the source by their spans. Comments are in a separate list. Each is placed
// before the word that follows it, and the printer keeps comments at line ends at line ends. Line
// breaks are allowed only where a statement can continue: in brackets, after operators, and before
// `|>`, `then`, and `else`.

#include "lang/format.h"

#include <stdlib.h>
#include <string.h>

#include "lang/layout.h"
#include "lang/parser.h"
#include "lang/tree.h"

#define INDENT 2
// Patterns with at most this many characters, without blanks, are not broken.
#define SHORT_PATTERN 60
// List elements up to this width are placed several per line.
#define SMALL_ITEM 28

typedef struct Format {
  const CagModuleAst *module;
  const char *text;
  Layout layout;
  size_t comment;      // the next one to place
  uint32_t comment_at; // where it starts; the end of the text if there are no more
  bool begun;          // a statement has been placed
  bool inner;          // the current expression is part of another: an operand, an element, an
                       // argument
  bool data; // the last placed expression is data: words, and lists, records, and calls that
             // contain only data
  char *out; // the whole text, after the last statement was printed
  size_t length;
} Format;

static Doc *expression(Format *f, const CagExpr *e);

// Formats an expression that is part of another one (`inner`), or that is the value of a definition
// or the body of a function.
static Doc *within(Format *f, const CagExpr *e, bool inner) {
  const bool outer = f->inner;
  f->inner = inner;
  Doc *d = expression(f, e);
  f->inner = outer;
  return d;
}
static Doc *part(Format *f, const CagExpr *e) { return within(f, e, true); }
static Doc *whole(Format *f, const CagExpr *e) { return within(f, e, false); }

// ---- words and comments ----

// Counts the line ends in [start, end) of the source.
static size_t newlines(const Format *f, uint32_t start, uint32_t end) {
  size_t n = 0;
  for (const char *p = f->text + start, *stop = f->text + end;
       p < stop && (p = memchr(p, '\n', (size_t)(stop - p))); p++)
    n++;
  return n;
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// Counts the line ends in the white space directly before `at`.
static size_t lines_before(const Format *f, uint32_t at) {
  size_t n = 0;
  while (at > 0 && is_blank(f->text[at - 1])) n += f->text[--at] == '\n';
  return n;
}

// Tests whether nothing but a comma is between `at` and the end of its line.
static bool ends_line(const Format *f, uint32_t at) {
  const char *p = f->text + at;
  while (*p && strchr(" \t\r,;", *p)) p++;
  return *p == '\n' || *p == 0;
}

// Converts Windows line ends in a multi-line comment.
static Doc *mended_comment(Format *f, const char *text, size_t length) {
  char *out = cag_layout_memory(&f->layout, length);
  size_t n = 0;
  for (size_t i = 0; i < length; i++)
    if (text[i] != '\r' || i + 1 == length || text[i + 1] != '\n') out[n++] = text[i];
  return cag_layout_text(&f->layout, out, n);
}

static Doc *comment_text(Format *f, const CagComment *c) {
  const char *text = f->text + c->span.start;
  size_t length = c->span.end - c->span.start;
  while (length && strchr(" \t\r", text[length - 1])) length--;
  if (c->block && memchr(text, '\r', length)) return mended_comment(f, text, length);
  return cag_layout_text(&f->layout, text, length);
}

static inline bool comments_before(const Format *f, uint32_t offset) {
  return f->comment_at < offset;
}

static void look_for_comment(Format *f) {
  const CagModuleAst *m = f->module;
  f->comment_at = f->comment < m->comment_count ? m->comments[f->comment].span.start : UINT32_MAX;
}

static const CagComment *next_comment(Format *f) {
  const CagComment *c = &f->module->comments[f->comment++];
  look_for_comment(f);
  return c;
}

// Tests whether a line break follows the last comment: before the next comment, or as a blank line
// before the word at `offset`.
static bool breaks_next(const Format *f, uint32_t offset, bool inner) {
  if (comments_before(f, offset))
    return lines_before(f, f->module->comments[f->comment].span.start) > 0;
  return !inner && lines_before(f, offset) > 1;
}

// Places a comment that a line break follows.
static void set_last(Format *f, Docs *out, Doc *text, bool begins_line) {
  layout_add(out, begins_line ? cag_layout_comment(&f->layout, text)
                              : cag_layout_trailing(&f->layout, text));
}

// Places one comment. `inner`: it is before a closing bracket, so no space follows it.
static void set_comment(Format *f, Docs *out, const CagComment *c, uint32_t offset, bool inner) {
  const size_t before = lines_before(f, c->span.start);
  const bool alone = !c->block || (ends_line(f, c->span.end) && !(inner && before == 0)) ||
                     breaks_next(f, offset, inner);
  Doc *text = comment_text(f, c);
  if (before > 1) layout_add(out, cag_layout_blank(&f->layout));
  if (alone) {
    set_last(f, out, text, before > 0);
  } else {
    layout_add(out, cag_layout_inline(&f->layout, text));
    if (!inner) layout_add(out, cag_layout_plain(&f->layout, " ", 1));
  }
}

static bool set_each_comment(Format *f, Docs *out, uint32_t offset, bool inner) {
  const bool some = comments_before(f, offset);
  while (comments_before(f, offset)) set_comment(f, out, next_comment(f), offset, inner);
  return some;
}

static inline void set_comments(Format *f, Docs *out, uint32_t offset, bool inner) {
  if (!comments_before(f, offset)) return;
  if (set_each_comment(f, out, offset, inner) && !inner && lines_before(f, offset) > 1)
    layout_add(out, cag_layout_blank(&f->layout));
}

// Places the comments before a bracket that is on its own line.
static void set_last_comments(Format *f, Docs *out, uint32_t offset) {
  while (comments_before(f, offset)) {
    const CagComment *c = next_comment(f);
    const size_t before = lines_before(f, c->span.start);
    if (before > 1) layout_add(out, cag_layout_blank(&f->layout));
    set_last(f, out, comment_text(f, c), before > 0);
  }
}

// Places the text of the span, after the comments before it.
static void set_span(Format *f, Docs *out, CagSpan span) {
  set_comments(f, out, span.start, false);
  layout_add(out, cag_layout_text(&f->layout, f->text + span.start, span.end - span.start));
  while (comments_before(f, span.end)) next_comment(f); // in the { } of a text
}

static inline void set_word(Format *f, Docs *out, const char *word) {
  layout_add(out, cag_layout_plain(&f->layout, word, strlen(word)));
}

// Places a closing bracket, which is the last byte of the expression that it closes.
static void set_closer(Format *f, Docs *out, uint32_t end, const char *word) {
  set_comments(f, out, end - 1, true);
  set_word(f, out, word);
}

static Doc *span_doc(Format *f, CagSpan span) {
  if (!comments_before(f, span.end))
    return cag_layout_text(&f->layout, f->text + span.start, span.end - span.start);
  Docs d = {0};
  set_span(f, &d, span);
  return cag_layout_concat(&f->layout, &d);
}

// ---- lists between brackets ----

// Tests for a blank line in the source before `start`, or before the comments there.
static bool blank_before(const Format *f, uint32_t start) {
  if (comments_before(f, start)) start = f->module->comments[f->comment].span.start;
  return lines_before(f, start) > 1;
}

// Tests for expressions that may start after a bracket or `=>` and break within their own brackets.
static bool opens_by_itself(const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_BLOCK:
  case CAG_EXPR_LIST:
  case CAG_EXPR_RECORD:
  case CAG_EXPR_COMPREHENSION: return true;
  case CAG_EXPR_LAMBDA: return opens_by_itself(e->as.function->body);
  case CAG_EXPR_CALL:
    return e->as.call.count == 1 && opens_by_itself(e->as.call.arguments[0].value);
  default: return false;
  }
}

static bool is_long_text(const Format *f, const CagExpr *e) {
  return e->kind == CAG_EXPR_TEXT && newlines(f, e->span.start, e->span.end) > 0;
}

static Doc *argument(Format *f, const CagArgument *a) {
  Docs d = {0};
  if (a->name) {
    set_span(f, &d, a->name_span);
    set_word(f, &d, ": ");
  }
  layout_add(&d, part(f, a->value));
  return cag_layout_concat(&f->layout, &d);
}

static Doc *call(Format *f, const CagExpr *e) {
  Docs d = {0}, items = {0};
  layout_add(&d, expression(f, e->as.call.callee));
  bool clear = true; // no comment is where hugging would remove its line
  bool gathers = true, opens = !comments_before(f, e->span.end - 1);
  const CagExpr *last = NULL;
  bool data = true;
  for (size_t i = 0; i < e->as.call.count; i++) {
    const CagArgument *a = &e->as.call.arguments[i];
    clear = !comments_before(f, a->value->span.start);
    gathers = gathers && a->value->kind != CAG_EXPR_PIPE;
    if (i) layout_add(&items, cag_layout_space(&f->layout));
    last = a->value;
    Doc *item = argument(f, a);
    data = data && f->data;
    if (i + 1 < e->as.call.count) cag_layout_comma(item);
    layout_add(&items, item);
  }
  clear = clear && !comments_before(f, e->span.end - 1);
  const bool hugs = last && clear && (opens_by_itself(last) || is_long_text(f, last));
  Docs end = {0};
  set_closer(f, &end, e->span.end, ")");
  Doc *arguments = cag_layout_brackets(&f->layout, '(', &items, cag_layout_concat(&f->layout, &end),
                                       INDENT, false, hugs);
  arguments->gathers = gathers;
  arguments->opens =
      opens && e->as.call.count > 1 && opens_by_itself(e->as.call.arguments[0].value);
  layout_add(&d, arguments);
  f->data = data;
  return cag_layout_concat(&f->layout, &d);
}

// ---- tables ----

static bool is_number(const CagExpr *e) {
  if (e->kind == CAG_EXPR_NEGATE) e = e->as.unary.operand;
  return e->kind == CAG_EXPR_NUMBER || e->kind == CAG_EXPR_ANGLE;
}

// Tests whether both are numbers, or lists of the same shape. Increases `words` by the count of
// numbers in each.
static bool have_one_shape(const CagExpr *a, const CagExpr *b, size_t *words) {
  if (is_number(a)) {
    ++*words;
    return is_number(b);
  }
  if (a->kind != CAG_EXPR_LIST || b->kind != CAG_EXPR_LIST) return false;
  const size_t n = a->as.list.count;
  bool same = n > 0 && b->as.list.count == n;
  for (size_t i = 0; i < n && same; i++)
    same = have_one_shape(a->as.list.items[i], b->as.list.items[i], words);
  return same;
}

// Returns the count of numbers in each row of a list of rows of the same shape, or 0 for anything
// else.
static size_t table_words(const CagExpr *e) {
  if (e->kind != CAG_EXPR_LIST || e->as.list.count < 2) return 0;
  const CagExpr *first = e->as.list.items[0];
  if (first->kind != CAG_EXPR_LIST) return 0;
  size_t words = 0;
  for (size_t i = 1; i < e->as.list.count; i++) {
    words = 0;
    if (!have_one_shape(first, e->as.list.items[i], &words)) return 0;
  }
  return words;
}

// Tests whether each row can be on one line, because no comment in it forces a break.
static bool rows_are_whole(const Docs *items) {
  for (const Doc *d = items->head; d; d = d->next) {
    const Doc *row = d;
    if (d->kind == DOC_CONCAT)
      for (row = d->child; row->next;) row = row->next;
    if (row->kind > DOC_INLINE && (row->kind < DOC_BRACKETS || row->width >= DOC_ENDLESS))
      return false;
  }
  return true;
}

// ---- lists and records ----

static bool is_small(const Doc *d) { return d->width <= SMALL_ITEM; }

// Formats the items of a list or record between its brackets.
static Doc *items_doc(Format *f, const CagExpr *e, Doc *(*item)(Format *, const CagExpr *, size_t),
                      uint32_t (*start)(const CagExpr *, size_t), size_t count, char open,
                      const char *close) {
  Docs items = {0}, end = {0};
  const bool record = e->kind == CAG_EXPR_RECORD;
  bool small = !record, data = true;
  for (size_t i = 0; i < count; i++) {
    const bool blank = i && blank_before(f, start(e, i));
    if (blank) layout_add(&items, cag_layout_blank(&f->layout));
    if (i) layout_add(&items, blank ? cag_layout_hard(&f->layout) : cag_layout_space(&f->layout));
    Doc *d = item(f, e, i);
    small = small && is_small(d);
    data = data && f->data;
    if (i + 1 < count) cag_layout_comma(d);
    layout_add(&items, d);
  }
  set_closer(f, &end, e->span.end, close);
  Doc *closing = cag_layout_concat(&f->layout, &end);
  f->data = data;
  if (count > 1 && (small || (record && data)))
    return cag_layout_filled(&f->layout, open, &items, closing, INDENT, record);
  const size_t words = table_words(e);
  if (words && rows_are_whole(&items))
    return cag_layout_table(&f->layout, open, &items, closing, INDENT, words);
  return cag_layout_brackets(&f->layout, open, &items, closing, INDENT, record && count,
                             count == 1 && !record && opens_by_itself(e->as.list.items[0]));
}

static Doc *list_item(Format *f, const CagExpr *e, size_t i) {
  return part(f, e->as.list.items[i]);
}
static uint32_t list_start(const CagExpr *e, size_t i) { return e->as.list.items[i]->span.start; }

static Doc *field_item(Format *f, const CagExpr *e, size_t i) {
  const CagField *field = &e->as.record.fields[i];
  Docs d = {0};
  if (!field->name) {
    set_span(f, &d, field->name_span); // the dots
    layout_add(&d, expression(f, field->value));
    return cag_layout_concat(&f->layout, &d);
  }
  set_span(f, &d, field->name_span);
  set_word(f, &d, ": ");
  layout_add(&d, part(f, field->value));
  return cag_layout_concat(&f->layout, &d);
}
static uint32_t field_start(const CagExpr *e, size_t i) {
  return e->as.record.fields[i].name_span.start;
}

// ---- patterns ----

static Doc *pattern(Format *f, const CagPattern *p);

static Doc *pattern_part(Format *f, const CagPatternPart *part) {
  Docs d = {0};
  if (part->field && !cag_pattern_is_shorthand(part)) {
    set_span(f, &d, part->field_span);
    set_word(f, &d, ": ");
  }
  layout_add(&d, pattern(f, part->pattern));
  return cag_layout_concat(&f->layout, &d);
}

static Doc *rest_of_list(Format *f, const CagPattern *p) {
  Docs d = {0};
  set_comments(f, &d, p->rest_span.start, false);
  set_word(f, &d, "...");
  set_span(f, &d, p->rest->span);
  return cag_layout_concat(&f->layout, &d);
}

// Counts characters without blanks and a comma before the bracket, which the layout may change.
static bool is_short(const Format *f, CagSpan span) {
  size_t n = 0;
  bool comma = false;
  for (uint32_t i = span.start; i < span.end && n <= SHORT_PATTERN; i++) {
    if (strchr(" \t\r\n", f->text[i])) continue;
    n += 1 - (comma && strchr("]}", f->text[i]));
    comma = f->text[i] == ',';
  }
  return n <= SHORT_PATTERN;
}

// Formats a pattern that stays on one line.
static Doc *short_pattern(Format *f, const CagPattern *p) {
  const bool list = p->kind == CAG_PATTERN_LIST;
  Docs d = {0};
  set_word(f, &d, list ? "[" : "{ ");
  for (size_t i = 0; i < p->count; i++) {
    if (i) set_word(f, &d, ", ");
    layout_add(&d, pattern_part(f, &p->parts[i]));
  }
  if (p->rest && p->count) set_word(f, &d, ", ");
  if (p->rest) layout_add(&d, rest_of_list(f, p));
  set_word(f, &d, list ? "]" : " }");
  return cag_layout_concat(&f->layout, &d);
}

static Doc *pattern(Format *f, const CagPattern *p) {
  if (p->kind == CAG_PATTERN_NAME) return span_doc(f, p->span);
  if (is_short(f, p->span) && !comments_before(f, p->span.end)) return short_pattern(f, p);
  const bool list = p->kind == CAG_PATTERN_LIST;
  Docs d = {0}, items = {0}, end = {0};
  set_comments(f, &d, p->span.start, false);
  for (size_t i = 0; i < p->count; i++) {
    if (i) layout_add(&items, cag_layout_space(&f->layout));
    Doc *item = pattern_part(f, &p->parts[i]);
    if (i + 1 < p->count || p->rest) cag_layout_comma(item);
    layout_add(&items, item);
  }
  if (p->rest && p->count) layout_add(&items, cag_layout_space(&f->layout));
  if (p->rest) layout_add(&items, rest_of_list(f, p));
  set_closer(f, &end, p->span.end, list ? "]" : "}");
  layout_add(&d, cag_layout_brackets(&f->layout, list ? '[' : '{', &items,
                                     cag_layout_concat(&f->layout, &end), INDENT, !list, false));
  return cag_layout_concat(&f->layout, &d);
}

// ---- functions ----

static Doc *parameter(Format *f, const CagParameter *p) {
  Docs d = {0};
  if (p->pattern) return pattern(f, p->pattern);
  set_span(f, &d, p->decl->span);
  if (p->fallback) {
    set_word(f, &d, " = ");
    layout_add(&d, expression(f, p->fallback));
  }
  return cag_layout_concat(&f->layout, &d);
}

static Doc *parameters(Format *f, const CagFunctionAst *fn) {
  Docs items = {0};
  bool small = fn->parameter_count > 1;
  for (size_t i = 0; i < fn->parameter_count; i++) {
    if (i) layout_add(&items, cag_layout_space(&f->layout));
    Doc *d = parameter(f, &fn->parameters[i]);
    small = small && is_small(d);
    if (i + 1 < fn->parameter_count) cag_layout_comma(d);
    layout_add(&items, d);
  }
  Doc *close = cag_layout_plain(&f->layout, ")", 1);
  if (small) return cag_layout_filled(&f->layout, '(', &items, close, INDENT, false);
  Doc *d = cag_layout_brackets(&f->layout, '(', &items, close, INDENT, false, false);
  d->gathers = true;
  return d;
}

// Places the value after `=` or `=>`, either starting there or, for an `if`, possibly on a new
// line.
static void set_value(Format *f, Docs *out, const CagExpr *value) {
  if (comments_before(f, value->span.start)) {
    Docs d = {0};
    layout_add(&d, cag_layout_space(&f->layout));
    set_comments(f, &d, value->span.start, false);
    layout_add(&d, whole(f, value));
    layout_add(out, cag_layout_group(&f->layout, cag_layout_nest(&f->layout, INDENT, &d)));
  } else if (value->kind == CAG_EXPR_IF) {
    Docs d = {0};
    layout_add(&d, cag_layout_space(&f->layout));
    Doc *choice = whole(f, value);
    if (choice->kind == DOC_GROUP)
      choice->kind = DOC_CONCAT; // breaks together with the line before it
    layout_add(&d, choice);
    layout_add(out, cag_layout_group(&f->layout, cag_layout_nest(&f->layout, INDENT, &d)));
  } else {
    set_word(f, out, " ");
    layout_add(out, whole(f, value));
  }
}

static Doc *lambda(Format *f, const CagExpr *e) {
  const CagFunctionAst *fn = e->as.function;
  Docs d = {0};
  set_comments(f, &d, e->span.start, false);
  if (fn->parameter_count == 1 && !fn->parameters[0].fallback && !fn->parameters[0].pattern)
    set_span(f, &d, fn->parameters[0].decl->span);
  else layout_add(&d, parameters(f, fn));
  set_word(f, &d, " =>");
  set_value(f, &d, fn->body);
  return cag_layout_concat(&f->layout, &d);
}

// ---- operators ----

static int level(const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_PIPE: return 1;
  case CAG_EXPR_OR: return 2;
  case CAG_EXPR_AND: return 3;
  case CAG_EXPR_BINARY:
    switch (e->as.binary.op) {
    case CAG_OP_ADD:
    case CAG_OP_SUBTRACT:
    case CAG_OP_UNION: return 5;
    case CAG_OP_MULTIPLY:
    case CAG_OP_DIVIDE:
    case CAG_OP_MODULO:
    case CAG_OP_INTERSECTION: return 6;
    case CAG_OP_POWER: return 7;
    default: return 4;
    }
  default: return 0;
  }
}

static Doc *power(Format *f, const CagExpr *e) {
  Docs d = {0};
  layout_add(&d, expression(f, e->as.binary.left));
  set_word(f, &d, "^");
  layout_add(&d, expression(f, e->as.binary.right));
  return cag_layout_concat(&f->layout, &d);
}

// Places the operator of a binary expression as written, between spaces.
static void set_operator(Format *f, Docs *out, const CagExpr *e) {
  const CagSpan s = e->as.binary.op_span;
  set_word(f, out, " ");
  layout_add(out, cag_layout_text(&f->layout, f->text + s.start, s.end - s.start));
}

// Tests for operands that can be next to * or / without spaces.
static bool is_factor(const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE:
  case CAG_EXPR_NAME: return true;
  case CAG_EXPR_MEMBER: return is_factor(e->as.member.object);
  case CAG_EXPR_INDEX: return is_factor(e->as.binary.left) && is_factor(e->as.binary.right);
  case CAG_EXPR_BINARY:
    return e->as.binary.op == CAG_OP_POWER && is_factor(e->as.binary.left) &&
           is_factor(e->as.binary.right);
  default: return false;
  }
}

// The maximum number of factors in a product without spaces.
#define FACTORS_MAX 4

// Tests for products of plain words, such as 2*r and a.x/3, which have no spaces if they are part
// of another expression.
static bool is_product(const CagExpr *e) {
  size_t factors = 1;
  for (; e->kind == CAG_EXPR_BINARY &&
         (e->as.binary.op == CAG_OP_MULTIPLY || e->as.binary.op == CAG_OP_DIVIDE);
       e = e->as.binary.left) {
    if (++factors > FACTORS_MAX || !is_factor(e->as.binary.right)) return false;
  }
  if (e->kind == CAG_EXPR_NEGATE) e = e->as.unary.operand;
  return factors > 1 && is_factor(e);
}

static Doc *product(Format *f, const CagExpr *e) {
  if (e->kind != CAG_EXPR_BINARY || e->as.binary.op == CAG_OP_POWER) return expression(f, e);
  Docs d = {0};
  layout_add(&d, product(f, e->as.binary.left));
  set_word(f, &d, e->as.binary.op == CAG_OP_MULTIPLY ? "*" : "/");
  layout_add(&d, expression(f, e->as.binary.right));
  return cag_layout_concat(&f->layout, &d);
}

// a + b - c: the operands of one level, with a line break after each operator if they do not fit.
static Doc *chain(Format *f, const CagExpr *e) {
  const int mine = level(e);
  if (f->inner && is_product(e) && !comments_before(f, e->span.end)) return product(f, e);
  const bool parts = mine == 4 || mine == 5; // of a sum or a comparison
  size_t n = 0;
  for (const CagExpr *x = e; level(x) == mine; x = x->as.binary.left) n++;
  const CagExpr **links = cag_layout_memory(&f->layout, n * sizeof *links);
  size_t at = n;
  for (const CagExpr *x = e; level(x) == mine; x = x->as.binary.left) links[--at] = x;
  Docs d = {0}, item = {0};
  layout_add(&item, within(f, links[0]->as.binary.left, parts || f->inner));
  for (size_t i = 0; i < n; i++) {
    set_operator(f, &item, links[i]);
    layout_add(&d, cag_layout_concat(&f->layout, &item));
    layout_add(&d, cag_layout_space(&f->layout));
    item = (Docs){0};
    layout_add(&item, within(f, links[i]->as.binary.right, parts || f->inner));
  }
  layout_add(&d, cag_layout_concat(&f->layout, &item));
  return cag_layout_fill(&f->layout, INDENT, &d);
}

// a |> f |> g: all on one line, or each stage on its own line.
static Doc *pipe(Format *f, const CagExpr *e) {
  size_t n = 0;
  for (const CagExpr *x = e; x->kind == CAG_EXPR_PIPE; x = x->as.binary.left) n++;
  const CagExpr **links = cag_layout_memory(&f->layout, n * sizeof *links);
  size_t at = n;
  for (const CagExpr *x = e; x->kind == CAG_EXPR_PIPE; x = x->as.binary.left) links[--at] = x;
  Docs stages = {0};
  Doc *head = expression(f, links[0]->as.binary.left);
  for (size_t i = 0; i < n; i++) {
    set_comments(f, &stages, links[i]->as.binary.op_span.start, true);
    layout_add(&stages, cag_layout_space(&f->layout));
    set_word(f, &stages, "|> ");
    layout_add(&stages, expression(f, links[i]->as.binary.right));
  }
  return cag_layout_stages(&f->layout, head, cag_layout_nest(&f->layout, INDENT, &stages));
}

static bool is_plain(const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_NUMBER:
  case CAG_EXPR_ANGLE:
  case CAG_EXPR_NAME:
  case CAG_EXPR_MEMBER:
  case CAG_EXPR_INDEX:
  case CAG_EXPR_CALL:
  case CAG_EXPR_GROUP: return true;
  case CAG_EXPR_BINARY:
    return level(e) > 4 && is_plain(e->as.binary.left) && is_plain(e->as.binary.right);
  default: return false;
  }
}

// Formats the end of a range, where arithmetic has no spaces: 0..n-1.
static Doc *range_end(Format *f, const CagExpr *e) {
  if (e->kind != CAG_EXPR_BINARY || !is_plain(e)) return expression(f, e);
  Docs d = {0};
  const CagSpan s = e->as.binary.op_span;
  layout_add(&d, range_end(f, e->as.binary.left));
  layout_add(&d, cag_layout_text(&f->layout, f->text + s.start, s.end - s.start));
  layout_add(&d, range_end(f, e->as.binary.right));
  return cag_layout_concat(&f->layout, &d);
}

static Doc *range(Format *f, const CagExpr *e) {
  Docs d = {0};
  layout_add(&d, range_end(f, e->as.range.low));
  const bool data = f->data;
  set_word(f, &d, e->as.range.open ? "..<" : "..");
  layout_add(&d, range_end(f, e->as.range.high));
  if (e->as.range.step) {
    set_word(f, &d, " by ");
    layout_add(&d, range_end(f, e->as.range.step));
  }
  f->data = f->data && data;
  return cag_layout_concat(&f->layout, &d);
}

static Doc *prefixed(Format *f, const CagExpr *e, const char *word) {
  Docs d = {0};
  set_comments(f, &d, e->span.start, false);
  set_word(f, &d, word);
  layout_add(&d, expression(f, e->as.unary.operand));
  return cag_layout_concat(&f->layout, &d);
}

static Doc *group(Format *f, const CagExpr *e) {
  Docs d = {0}, items = {0}, end = {0};
  set_comments(f, &d, e->span.start, false);
  const bool clear = !comments_before(f, e->as.unary.operand->span.start);
  layout_add(&items, part(f, e->as.unary.operand));
  set_closer(f, &end, e->span.end, ")");
  layout_add(&d, cag_layout_brackets(&f->layout, '(', &items, cag_layout_concat(&f->layout, &end),
                                     INDENT, false, clear && opens_by_itself(e->as.unary.operand)));
  return cag_layout_concat(&f->layout, &d);
}

// if a then b else if c then d else e: on one line, or each branch on its own line.
static Doc *branches(Format *f, const CagExpr *e) {
  Docs d = {0};
  const char *word = "if ";
  for (bool first = true;; first = false) {
    if (first) set_comments(f, &d, e->span.start, false);
    else set_each_comment(f, &d, e->span.start, false); // they are before `else`
    set_word(f, &d, word);
    layout_add(&d, expression(f, e->as.branch.condition));
    set_word(f, &d, " then ");
    layout_add(&d, expression(f, e->as.branch.then));
    if (e->as.branch.then->kind == CAG_EXPR_BLOCK) set_word(f, &d, " ");
    else layout_add(&d, cag_layout_space(&f->layout));
    if (e->as.branch.otherwise->kind != CAG_EXPR_IF) break;
    e = e->as.branch.otherwise;
    word = "else if ";
  }
  set_word(f, &d, "else ");
  layout_add(&d, expression(f, e->as.branch.otherwise));
  return cag_layout_group(&f->layout, cag_layout_concat(&f->layout, &d));
}

static void set_clause(Format *f, Docs *d, const CagClause *c) {
  set_comments(f, d, c->span.start, false);
  layout_add(d, pattern(f, c->pattern));
  set_word(f, d, " in ");
  layout_add(d, expression(f, c->source));
  if (!c->filter) return;
  set_word(f, d, " if ");
  layout_add(d, expression(f, c->filter));
}

static Doc *comprehension(Format *f, const CagExpr *e) {
  Docs d = {0}, clauses = {0}, body = {0};
  set_comments(f, &d, e->span.start, false);
  set_word(f, &d, "[for ");
  for (size_t i = 0; i < e->as.comprehension.count; i++) {
    if (i) layout_add(&clauses, cag_layout_space(&f->layout));
    Docs item = {0};
    set_clause(f, &item, &e->as.comprehension.clauses[i]);
    set_word(f, &item, i + 1 < e->as.comprehension.count ? "," : ":");
    layout_add(&clauses, cag_layout_concat(&f->layout, &item));
  }
  layout_add(&d, cag_layout_group(&f->layout, cag_layout_nest(&f->layout, INDENT, &clauses)));
  const bool opens = e->as.comprehension.body->kind == CAG_EXPR_BLOCK &&
                     !comments_before(f, e->as.comprehension.body->span.start);
  if (opens) {
    set_word(f, &d, " ");
    layout_add(&d, whole(f, e->as.comprehension.body));
  } else {
    layout_add(&body, cag_layout_space(&f->layout));
    layout_add(&body, whole(f, e->as.comprehension.body));
    layout_add(&d, cag_layout_nest(&f->layout, INDENT, &body));
  }
  set_closer(f, &d, e->span.end, "]");
  return cag_layout_group(&f->layout, cag_layout_concat(&f->layout, &d));
}

static void set_statement(Format *f, Docs *d, const CagStatement *s);

static Doc *block(Format *f, const CagExpr *e) {
  Docs d = {0}, inner = {0};
  set_comments(f, &d, e->span.start, false);
  set_word(f, &d, "{");
  const size_t n = e->as.block.count;
  for (size_t i = 0; i <= n; i++) {
    const CagSpan span = i < n ? e->as.block.statements[i]->span : e->as.block.value->span;
    if (i && blank_before(f, span.start)) layout_add(&inner, cag_layout_blank(&f->layout));
    layout_add(&inner, n ? cag_layout_hard(&f->layout) : cag_layout_space(&f->layout));
    if (i < n) set_statement(f, &inner, e->as.block.statements[i]);
    else layout_add(&inner, whole(f, e->as.block.value));
  }
  if (n) set_last_comments(f, &inner, e->span.end - 1);
  else set_comments(f, &inner, e->span.end - 1, true);
  layout_add(&d, cag_layout_nest(&f->layout, INDENT, &inner));
  layout_add(&d, n ? cag_layout_hard(&f->layout) : cag_layout_space(&f->layout));
  set_word(f, &d, "}");
  return cag_layout_group(&f->layout, cag_layout_concat(&f->layout, &d));
}

static Doc *bracketed(Format *f, const CagExpr *e) {
  Docs d = {0};
  set_comments(f, &d, e->span.start, false);
  if (e->kind == CAG_EXPR_LIST)
    layout_add(&d, items_doc(f, e, list_item, list_start, e->as.list.count, '[', "]"));
  else layout_add(&d, items_doc(f, e, field_item, field_start, e->as.record.count, '{', "}"));
  return cag_layout_concat(&f->layout, &d);
}

static Doc *index_of(Format *f, const CagExpr *e) {
  Docs d = {0};
  layout_add(&d, expression(f, e->as.binary.left));
  set_word(f, &d, "[");
  layout_add(&d, part(f, e->as.binary.right));
  set_closer(f, &d, e->span.end, "]");
  return cag_layout_concat(&f->layout, &d);
}

static Doc *member(Format *f, const CagExpr *e) {
  Docs d = {0};
  layout_add(&d, expression(f, e->as.member.object));
  set_comments(f, &d, e->as.member.name_span.start, true);
  set_word(f, &d, ".");
  set_span(f, &d, e->as.member.name_span);
  return cag_layout_concat(&f->layout, &d);
}

// Formats computed expressions, which are not data.
static Doc *computed(Format *f, const CagExpr *e) {
  switch (e->kind) {
  case CAG_EXPR_GROUP: return group(f, e);
  case CAG_EXPR_COMPREHENSION: return comprehension(f, e);
  case CAG_EXPR_BLOCK: return block(f, e);
  case CAG_EXPR_LAMBDA: return lambda(f, e);
  case CAG_EXPR_IF: return branches(f, e);
  case CAG_EXPR_NOT: return prefixed(f, e, "not ");
  case CAG_EXPR_BINARY: return e->as.binary.op == CAG_OP_POWER ? power(f, e) : chain(f, e);
  case CAG_EXPR_PIPE: return pipe(f, e);
  default: return chain(f, e); // and, or
  }
}

static Doc *expression(Format *f, const CagExpr *e) {
  Doc *d;
  switch (e->kind) {
  case CAG_EXPR_LIST:
  case CAG_EXPR_RECORD: return bracketed(f, e);
  case CAG_EXPR_SPREAD: return prefixed(f, e, "...");
  case CAG_EXPR_NEGATE: return prefixed(f, e, "-");
  case CAG_EXPR_RANGE: return range(f, e);
  case CAG_EXPR_CALL: return call(f, e);
  case CAG_EXPR_INDEX: return index_of(f, e);
  case CAG_EXPR_MEMBER: return member(f, e);
  case CAG_EXPR_GROUP:
  case CAG_EXPR_COMPREHENSION:
  case CAG_EXPR_BLOCK:
  case CAG_EXPR_LAMBDA:
  case CAG_EXPR_IF:
  case CAG_EXPR_NOT:
  case CAG_EXPR_BINARY:
  case CAG_EXPR_PIPE:
  case CAG_EXPR_AND:
  case CAG_EXPR_OR:
    d = computed(f, e);
    f->data = false;
    return d;
  default: // numbers, texts, names: as written
    f->data = true;
    return span_doc(f, e->span);
  }
}

// ---- statements ----

static void set_import(Format *f, Docs *d, const CagStatement *s) {
  set_word(f, d, "import ");
  set_span(f, d, s->as.import.path_span);
  if (s->as.import.alias) {
    set_word(f, d, " as ");
    layout_add(d, cag_layout_text(&f->layout, s->as.import.alias, strlen(s->as.import.alias)));
  }
  if (!s->as.import.name_count) return;
  Docs names = {0};
  for (size_t i = 0; i < s->as.import.name_count; i++) {
    if (i) layout_add(&names, cag_layout_space(&f->layout));
    Doc *name = span_doc(f, s->as.import.names[i].decl->span);
    if (i + 1 < s->as.import.name_count) cag_layout_comma(name);
    layout_add(&names, name);
  }
  set_word(f, d, ": ");
  layout_add(d, cag_layout_fill(&f->layout, INDENT, &names));
}

// Returns the start of the label of a param, which is the last word of the statement.
static uint32_t label_start(const Format *f, const CagStatement *s) {
  const CagExpr *last = s->as.param.domain ? s->as.param.domain : s->as.param.value;
  const uint32_t from = last->span.end;
  size_t comment = f->comment;
  for (uint32_t at = from; at < s->span.end; at++) {
    while (comment < f->module->comment_count && f->module->comments[comment].span.start < at)
      comment++;
    if (comment < f->module->comment_count && f->module->comments[comment].span.start == at) {
      at = f->module->comments[comment].span.end - 1;
      continue;
    }
    if (f->text[at] == '"' || f->text[at] == '`') return at;
  }
  return s->span.end;
}

// Tests whether the word is on one line that does not end with a comment.
static bool stands_last(const Format *f, CagSpan word) {
  const char *end = f->text + word.end;
  end += strspn(end, " \t\r;");
  return newlines(f, word.start, word.end) == 0 && *end != '/';
}

static void set_param(Format *f, Docs *d, const CagStatement *s) {
  set_word(f, d, "param ");
  set_span(f, d, s->as.param.decl->span);
  set_word(f, d, " = ");
  layout_add(d, expression(f, s->as.param.value));
  if (s->as.param.domain) {
    set_word(f, d, " in ");
    layout_add(d, expression(f, s->as.param.domain));
  }
  if (!s->as.param.label) return;
  const CagSpan label = {label_start(f, s), s->span.end};
  // Labels at the ends of neighboring lines are aligned, as comments are.
  if (!comments_before(f, label.start) && stands_last(f, label)) {
    Doc *text = cag_layout_text(&f->layout, f->text + label.start, label.end - label.start);
    layout_add(d, cag_layout_trailing(&f->layout, text));
    return;
  }
  set_word(f, d, " ");
  set_span(f, d, label);
}

static void set_definition(Format *f, Docs *d, const CagStatement *s) {
  const CagExpr *value = s->as.definition.value;
  if (s->as.definition.pattern) layout_add(d, pattern(f, s->as.definition.pattern));
  else set_span(f, d, s->as.definition.decl->span);
  if (value->kind == CAG_EXPR_LAMBDA && value->as.function->name) {
    layout_add(d, parameters(f, value->as.function));
    value = value->as.function->body;
  }
  set_word(f, d, " =");
  set_value(f, d, value);
}

static void set_list(Format *f, Docs *d, const CagStatement *s, const char *word) {
  set_word(f, d, word);
  if (s->as.list.count == 1) {
    layout_add(d, expression(f, s->as.list.items[0]));
    return;
  }
  Docs items = {0};
  for (size_t i = 0; i < s->as.list.count; i++) {
    if (i) layout_add(&items, cag_layout_space(&f->layout));
    Doc *item = expression(f, s->as.list.items[i]);
    if (i + 1 < s->as.list.count) cag_layout_comma(item);
    layout_add(&items, item);
  }
  layout_add(d, cag_layout_fill(&f->layout, INDENT, &items));
}

static void set_assert(Format *f, Docs *d, const CagStatement *s) {
  set_word(f, d, "assert ");
  if (!s->as.assertion.message) {
    layout_add(d, expression(f, s->as.assertion.condition));
    return;
  }
  Docs parts = {0}, message = {0};
  Doc *condition = expression(f, s->as.assertion.condition);
  cag_layout_comma(condition);
  layout_add(&parts, condition);
  layout_add(&message, cag_layout_space(&f->layout));
  layout_add(&message, expression(f, s->as.assertion.message));
  layout_add(&parts, cag_layout_nest(&f->layout, INDENT, &message));
  layout_add(d, cag_layout_group(&f->layout, cag_layout_concat(&f->layout, &parts)));
}

static void set_statement(Format *f, Docs *d, const CagStatement *s) {
  set_comments(f, d, s->span.start, false);
  switch (s->kind) {
  case CAG_STATEMENT_IMPORT: set_import(f, d, s); break;
  case CAG_STATEMENT_PARAM: set_param(f, d, s); break;
  case CAG_STATEMENT_DEFINITION: set_definition(f, d, s); break;
  case CAG_STATEMENT_SHOW: set_list(f, d, s, "show "); break;
  case CAG_STATEMENT_PRINT: set_list(f, d, s, "print "); break;
  case CAG_STATEMENT_ASSERT: set_assert(f, d, s); break;
  case CAG_STATEMENT_EXPRESSION: layout_add(d, expression(f, s->as.expression)); break;
  }
}

// Formats and prints a statement of the module, or (NULL) what follows the last one.
static void print_statement(void *context, const CagModuleAst *m, const CagStatement *s) {
  Format *f = context;
  Docs d = {0};
  const uint32_t start = s ? s->span.start : (uint32_t)m->source->length;
  f->module = m;
  look_for_comment(f);
  if (f->begun && blank_before(f, start)) layout_add(&d, cag_layout_blank(&f->layout));
  if (s) set_statement(f, &d, s);
  else set_comments(f, &d, start, false);
  cag_layout_print(&f->layout, cag_layout_concat(&f->layout, &d));
  f->begun = true;
  if (!s) f->out = cag_layout_finish(&f->layout, &f->length);
}

char *cag_format(const CagSource *source, CagDiagnostics *errors, size_t *length) {
  Format f = {.text = source->text};
  cag_layout_init(&f.layout, source, CAG_FORMAT_WIDTH);
  cag_parse_each(source, print_statement, &f, errors);
  cag_layout_release(&f.layout);
  *length = f.length;
  return f.out;
}
