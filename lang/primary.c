// The expressions that bind tightest: literals, texts, brackets of all kinds, and calls, indices,
// and members after them.

#include "lang/parse.h"

#include <string.h>

// ---- lists ----

// clause = pattern "in" expr [ "if" expr ]
static CagClause clause(Parser *p) {
  CagClause c = {.span = cag_parse_here(p)};
  if (parse_kind(p) == CAG_TOKEN_LEFT_PAREN)
    cag_parse_help(cag_parse_error(p, CAG_ERR_foreign_form, cag_parse_here(p),
                                   "the loop of a comprehension is written without parentheses"),
                   "write %s", cag_foreign_syntax(CAG_FOREIGN_for_parentheses));
  c.pattern = cag_parse_pattern(p, CAG_DECL_CLAUSE, "a name");
  if (parse_kind(p) == CAG_TOKEN_COMMA && parse_kind_at(p, 1) == CAG_TOKEN_NAME) {
    cag_parse_help(
        cag_parse_error(p, CAG_ERR_expected_word, cag_parse_here(p), "expected `in`, found `,`"),
        "to unpack elements, write [for [a, b] in xs: ...]");
  }
  if (!cag_parse_accept(p, CAG_TOKEN_IN)) {
    if (parse_kind(p) == CAG_TOKEN_EQUALS) {
      cag_parse_help(
          cag_parse_error(p, CAG_ERR_expected_word, cag_parse_here(p), "expected `in`, found `=`"),
          "write for i in 0..10");
    } else {
      cag_parse_unexpected(p, NULL, CAG_ERR_expected_word, "`in`");
    }
  }
  c.source = cag_parse_expression(p);
  if (cag_parse_accept(p, CAG_TOKEN_IF)) c.filter = cag_parse_expression(p);
  c.span.end = p->previous.span.end;
  return c;
}

static CagExpr *comprehension(Parser *p, Opened o) {
  CagExpr *e = cag_parse_new(p, CAG_EXPR_COMPREHENSION, o.span.start);
  cag_parse_advance(p); // for
  size_t list = cag_parse_list_begin(p);
  const CagExpr *last;
  do {
    CagClause c = clause(p);
    last = c.filter ? c.filter : c.source;
    cag_parse_stack_on(p, e, c.source);
    cag_parse_stack_on(p, e, c.filter);
    cag_parse_list_push(p, &c, sizeof c);
  } while (!p->panic && cag_parse_accept(p, CAG_TOKEN_COMMA));
  e->as.comprehension.clauses =
      cag_parse_list_end(p, list, sizeof(CagClause), &e->as.comprehension.count);
  if (!cag_parse_accept(p, CAG_TOKEN_COLON)) {
    if (parse_kind(p) == CAG_TOKEN_FOR)
      cag_parse_help(cag_parse_error(p, CAG_ERR_expected_word, cag_parse_here(p),
                                     "expected `,` or `:`, found `for`"),
                     "write [for x in xs, y in ys: ...]");
    else cag_parse_unexpected(p, last, CAG_ERR_expected_word, "`,` or `:`");
  }
  e->as.comprehension.body = cag_parse_expression(p);
  cag_parse_stack_on(p, e, e->as.comprehension.body);
  cag_parse_accept(p, CAG_TOKEN_COMMA);
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, e->as.comprehension.body, "`]`");
  return cag_parse_finish(p, e);
}

static CagExpr *spread(Parser *p) {
  CagExpr *e = cag_parse_new(p, CAG_EXPR_SPREAD, cag_parse_here(p).start);
  cag_parse_advance(p);
  e->as.unary.operand = cag_parse_expression(p);
  cag_parse_stack_on(p, e, e->as.unary.operand);
  return cag_parse_finish(p, e);
}

// "[" [ item { "," item } ] "]"  | "[" "for" clause { "," clause } ":" expr "]"      item = expr |
// "..." expr
static CagExpr *list_expression(Parser *p) {
  Opened o = cag_parse_open(p, false);
  if (parse_kind(p) == CAG_TOKEN_FOR) return comprehension(p, o);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_LIST, o.span.start), *item = NULL;
  size_t list = cag_parse_list_begin(p);
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_SQUARE) {
    item = parse_kind(p) == CAG_TOKEN_SPREAD ? spread(p) : cag_parse_expression(p);
    cag_parse_stack_on(p, e, item);
    cag_parse_list_push(p, &item, sizeof item);
    if (!cag_parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  cag_parse_foreign_colon(p, CAG_FOREIGN_colon_range);
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, item, "`,` or `]`");
  e->as.list.items = cag_parse_list_end(p, list, sizeof(CagExpr *), &e->as.list.count);
  return cag_parse_finish(p, e);
}

// ---- records and blocks ----

// Reads the name of a field: a word, or a constant text.
static bool field_name(Parser *p, CagField *f) {
  CagToken *t = parse_current(p);
  CagTokenKind kind = parse_kind(p);
  f->name_span = t->span;
  if (cag_parse_is_word(kind)) {
    f->name = t->as.name;
  } else if (kind == CAG_TOKEN_TEXT) {
    f->name = cag_names_intern(&p->names, t->as.text.bytes, t->as.text.length)->bytes;
  } else if (kind == CAG_TOKEN_TEXT_HEAD) {
    cag_parse_help(
        cag_parse_error(p, CAG_ERR_text_not_plain, t->span, "the name of a field has no { } in it"),
        "a record with computed names is record([[name, value], ...])");
    return false;
  } else {
    cag_parse_unexpected(p, NULL, CAG_ERR_expected_name, "the name of a field or `}`");
    return false;
  }
  cag_parse_advance(p);
  return true;
}

// field = ( word | text ) ":" expr | "..." expr
static CagField field(Parser *p) {
  CagField f = {0};
  if (parse_kind(p) == CAG_TOKEN_SPREAD) {
    f.name_span = cag_parse_here(p);
    cag_parse_advance(p);
    f.value = cag_parse_expression(p);
    return f;
  }
  if (!field_name(p, &f)) {
    f.value = cag_parse_error_node(p);
    return f;
  }
  if (parse_kind(p) == CAG_TOKEN_EQUALS) {
    cag_parse_help(cag_parse_mend(p, CAG_ERR_argument_equals, cag_parse_here(p),
                                  "a field is written with a colon"),
                   "write %s: value", f.name);
    cag_parse_advance(p);
  } else if (!cag_parse_accept(p, CAG_TOKEN_COLON)) {
    cag_parse_unexpected(p, NULL, CAG_ERR_expected_word, "`:` after the name of the field");
  }
  f.value = cag_parse_expression(p);
  return f;
}

// record = "{" [ field { "," field } ] "}"
static CagExpr *record(Parser *p) {
  Opened o = cag_parse_open(p, false);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_RECORD, o.span.start), *last = NULL;
  size_t list = cag_parse_list_begin(p);
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_BRACE) {
    // a statement of the file instead of a field means that the brace is open
    if (cag_parse_at_statement(p)) break;
    CagField f = field(p);
    last = f.value;
    cag_parse_stack_on(p, e, last);
    cag_parse_list_push(p, &f, sizeof f);
    if (!cag_parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_BRACE, last, "`,` or `}`");
  e->as.record.fields = cag_parse_list_end(p, list, sizeof(CagField), &e->as.record.count);
  return cag_parse_finish(p, e);
}

static bool at_definition(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_NAME) return cag_parse_at_pattern(p);
  CagTokenKind next = parse_kind_at(p, 1);
  if (next == CAG_TOKEN_EQUALS) return true;
  return next == CAG_TOKEN_LEFT_PAREN && cag_parse_at_function(p);
}

// After a statement of a block: a newline, `;`, or the end of the block.
static void end_in_block(Parser *p) {
  if (p->panic || cag_parse_accept(p, CAG_TOKEN_SEMICOLON)) return;
  if (parse_kind(p) == CAG_TOKEN_RIGHT_BRACE) return;
  if (cag_parse_at_newline(p) && parse_kind(p) != CAG_TOKEN_END &&
      (cag_parse_is_word(parse_kind(p)) || cag_parse_begins_expression(parse_kind(p))))
    return;
  cag_parse_unexpected(p, NULL, CAG_ERR_expected_end, "the end of the line or `;`");
}

// After the value of a block.
static void close_block(Parser *p, Opened o, const CagExpr *value) {
  bool ended = cag_parse_accept(p, CAG_TOKEN_SEMICOLON) || cag_parse_at_newline(p);
  CagTokenKind kind = parse_kind(p);
  if (ended && !p->panic && kind != CAG_TOKEN_RIGHT_BRACE && kind != CAG_TOKEN_END &&
      !cag_parse_at_statement(p) &&
      (cag_parse_is_word(kind) || cag_parse_begins_expression(kind))) {
    cag_parse_help(
        cag_parse_error(p, CAG_ERR_expression_statement, value->span,
                        "this value is not the last expression of its block, so it is not used"),
        "%s", kind == CAG_TOKEN_MINUS ? cag_parse_minus_help : "give it a name, or remove it");
    return;
  }
  if (kind == CAG_TOKEN_COMMA && !ended)
    cag_parse_help(
        cag_parse_error(p, CAG_ERR_tuple, o.span, "this brace opens a block, which has one value"),
        "a list is written in [ ]; the fields of a record have names: { a: 1 }");
  else if (kind == CAG_TOKEN_COLON && value->kind == CAG_EXPR_TEMPLATE)
    cag_parse_help(cag_parse_error(p, CAG_ERR_text_not_plain, value->span,
                                   "the name of a field has no { } in it"),
                   "a record with computed names is record([[name, value], ...])");
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_BRACE, value, "`}`");
}

// definition | assert | expr. An expression is the value of the block.
static CagStatement *block_statement(Parser *p, Opened o, CagExpr *block, CagExpr **value) {
  CagStatement *s = NULL;
  if (parse_kind(p) == CAG_TOKEN_ASSERT) {
    s = cag_parse_assert(p);
    cag_parse_stack_on(p, block, s->as.assertion.condition);
    cag_parse_stack_on(p, block, s->as.assertion.message);
  } else if (at_definition(p)) {
    s = cag_parse_definition(p, false);
    cag_parse_stack_on(p, block, s->as.definition.value);
  } else if (parse_kind(p) == CAG_TOKEN_RIGHT_BRACE) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_block_without_value, cag_parse_here(p),
                                   "this block has no value"),
                   "it ends with an expression");
  } else {
    *value = cag_parse_expression(p);
    cag_parse_stack_on(p, block, *value);
    close_block(p, o, *value);
  }
  if (s) end_in_block(p);
  return s;
}

// block = "{" { ( definition | assert ) end } expr [ ";" ] "}"
//
// After an error, the block continues at its next line.
static CagExpr *block(Parser *p) {
  Opened o = cag_parse_open(p, true);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_BLOCK, o.span.start), *value = NULL;
  BlockStart start = cag_parse_block_start(p);
  size_t list = cag_parse_list_begin(p);
  for (bool closed = false; !closed;) {
    while (cag_parse_accept(p, CAG_TOKEN_SEMICOLON)) {}
    start.statement = parse_current(p)->span.start;
    CagStatement *s = cag_parse_habit(p, true) ? NULL : block_statement(p, o, e, &value);
    if (s && p->panic) s->damage = CAG_DAMAGED;
    if (s) cag_parse_list_push(p, &s, sizeof s);
    else e->as.block.damaged = p->panic;
    closed = p->panic ? !cag_parse_recover_in_block(p, &start) : !s;
  }
  p->newlines = o.newlines;
  if (!value) value = cag_parse_error_node(p);
  e->as.block.value = value;
  e->as.block.statements = cag_parse_list_end(p, list, sizeof(CagStatement *), &e->as.block.count);
  return cag_parse_finish(p, e);
}

// `{` opens a record before `}`, `...`, or a word or text with a `:`, and otherwise a block.
static CagExpr *braces(Parser *p) {
  CagTokenKind next = parse_kind_at(p, 1);
  bool is_record = next == CAG_TOKEN_RIGHT_BRACE || next == CAG_TOKEN_SPREAD ||
                   ((cag_parse_is_word(next) || next == CAG_TOKEN_TEXT) &&
                    parse_kind_at(p, 2) == CAG_TOKEN_COLON);
  return is_record ? record(p) : block(p);
}

// ---- primaries ----

static CagExpr *text_part(Parser *p) {
  CagToken *t = parse_current(p);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_TEXT, t->span.start);
  e->as.text.bytes = t->as.text.bytes;
  e->as.text.length = t->as.text.length;
  e->span.end = t->span.end;
  return e;
}

// A text with { }: head, expression, { middle, expression }, tail.
static CagExpr *template(Parser *p) {
  CagExpr *e = cag_parse_new(p, CAG_EXPR_TEMPLATE, cag_parse_here(p).start);
  size_t list = cag_parse_list_begin(p);
  CagExpr *part = text_part(p);
  cag_parse_list_push(p, &part, sizeof part);
  Opened o = cag_parse_open(p, false);
  for (bool last = false; !last && !p->panic;) {
    CagTokenKind kind = parse_kind(p);
    if (kind == CAG_TOKEN_TEXT_MIDDLE || kind == CAG_TOKEN_TEXT_TAIL) {
      CagSpan span = {p->previous.span.end - 1, cag_parse_here(p).start + 1};
      cag_parse_help(
          cag_parse_mend(p, CAG_ERR_empty_interpolation, span, "there is nothing in these { }"),
          "%s", cag_lexer_brace_help);
      part = cag_parse_error_node(p);
    } else {
      part = cag_parse_expression(p);
    }
    cag_parse_stack_on(p, e, part);
    cag_parse_list_push(p, &part, sizeof part);
    kind = parse_kind(p);
    if (kind != CAG_TOKEN_TEXT_MIDDLE && kind != CAG_TOKEN_TEXT_TAIL) {
      cag_parse_unexpected(p, part, CAG_ERR_expected_separator, "`}`");
      break;
    }
    CagExpr *text = text_part(p);
    cag_parse_list_push(p, &text, sizeof text);
    last = kind == CAG_TOKEN_TEXT_TAIL;
    cag_parse_advance(p);
  }
  p->newlines = o.newlines;
  e->as.list.items = cag_parse_list_end(p, list, sizeof(CagExpr *), &e->as.list.count);
  return cag_parse_finish(p, e);
}

// Reports print(a, b), or a list in parentheses.
static void report_tuple(Parser *p, CagSpan span) {
  char text[QUOTE_SIZE];
  CagSpan inside = {span.start + 1, span.end - 1};
  const char *between = p->module->source->text + p->statement_head.end;
  bool of_statement = span.start >= p->statement_head.end &&
                      strspn(between, " \t") == span.start - p->statement_head.end;
  if (of_statement &&
      (p->statement_kind == CAG_TOKEN_PRINT || p->statement_kind == CAG_TOKEN_SHOW ||
       p->statement_kind == CAG_TOKEN_ASSERT)) {
    const char *word = p->statement_kind == CAG_TOKEN_PRINT  ? "print"
                       : p->statement_kind == CAG_TOKEN_SHOW ? "show"
                                                             : "assert";
    CagDiagnostic *d = cag_parse_mend(p, CAG_ERR_print_parentheses, span,
                                      "%s is a statement, without parentheses", word);
    cag_parse_help(d, "write %s %s", word, cag_parse_quote(p, inside, text, sizeof text, "a, b"));
    return;
  }
  if (inside.end <= inside.start)
    cag_parse_help(cag_parse_mend(p, CAG_ERR_tuple, span, "there is nothing in these parentheses"),
                   "an empty list is [], a function without parameters () => e");
  else
    cag_parse_help(cag_parse_mend(p, CAG_ERR_tuple, span, "a list is written in [ ]"), "write [%s]",
                   cag_parse_quote(p, inside, text, sizeof text, "a, b"));
}

// "(" expr ")"
CagExpr *cag_parse_group(Parser *p) {
  Opened o = cag_parse_open(p, false);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_GROUP, o.span.start);
  bool tuple = parse_kind(p) == CAG_TOKEN_RIGHT_PAREN;
  CagExpr *value = e->as.unary.operand = tuple ? cag_parse_error_node(p) : cag_parse_expression(p);
  cag_parse_stack_on(p, e, value);
  tuple |= parse_kind(p) == CAG_TOKEN_COMMA;
  while (cag_parse_accept(p, CAG_TOKEN_COMMA) && parse_kind(p) != CAG_TOKEN_RIGHT_PAREN)
    value = cag_parse_expression(p);
  if (cag_parse_close(p, o, CAG_TOKEN_RIGHT_PAREN, value, "`)`") && tuple) {
    report_tuple(p, (CagSpan){o.span.start, p->previous.span.end});
    e->kind = CAG_EXPR_ERROR;
  }
  return cag_parse_finish(p, e);
}

// Tests whether a definition starts where the value of the previous line is expected.
bool cag_parse_at_next_definition(Parser *p) {
  if (!parse_current(p)->newline_before) return false;
  if (p->newlines && parse_kind(p) == CAG_TOKEN_NAME && parse_kind_at(p, 1) == CAG_TOKEN_EQUALS)
    return true;
  if (p->newlines && cag_parse_at_pattern(p)) return true;
  return cag_parse_at_statement(p);
}

// Reports that an expression is missing before the current token.
CagExpr *cag_parse_missing(Parser *p) {
  if (p->panic) return cag_parse_error_node(p);
  CagSpan here = cag_parse_here(p);
  CagTokenKind kind = parse_kind(p);
  char word[64], before[QUOTE_SIZE];
  const char *found = cag_parse_found(p, word, sizeof word);
  CagDiagnostic *d = NULL;
  if (cag_parse_foreign_value(p)) return cag_parse_error_node(p);
  if ((p->bracket_count && kind == CAG_TOKEN_END) || (!p->newlines && cag_parse_at_statement(p))) {
    cag_parse_unexpected(p, NULL, CAG_ERR_expected_expression, "an expression");
  } else if (kind == CAG_TOKEN_DOT && parse_kind_at(p, 1) == CAG_TOKEN_NUMBER) {
    CagSpan number = cag_parse_peek(p, 1)->span;
    here.end = number.end;
    d = cag_parse_error(p, CAG_ERR_number_point, here,
                        "a number has digits on both sides of its point");
    cag_parse_help(d, "write 0.%s", cag_parse_quote(p, number, before, sizeof before, "5"));
  } else if (kind == CAG_TOKEN_RANGE || kind == CAG_TOKEN_RANGE_OPEN) {
    d = cag_parse_error(p, CAG_ERR_open_range, here, "this range has no start");
    cag_parse_help(d, "the first element has the index 0: 0..3");
  } else if (kind == CAG_TOKEN_SPREAD) {
    d = cag_parse_error(p, CAG_ERR_spread_misplaced, here,
                        "`...` is only allowed in a list or a record");
    cag_parse_help(d, "a list is spread into another: [...xs, 4]");
  } else if (kind == CAG_TOKEN_FOR) {
    d = cag_parse_error(p, CAG_ERR_loop, here, "`for` is only allowed in a list");
    cag_parse_help(d, "write [for x in xs: ...]");
  } else if (cag_parse_at_next_definition(p) || kind == CAG_TOKEN_END) {
    const char *after = cag_parse_quote(p, p->previous.span, before, sizeof before, NULL);
    CagSpan place = kind == CAG_TOKEN_END ? here : p->previous.span;
    if (after)
      cag_parse_error(p, CAG_ERR_expected_expression, place, "expected an expression after `%s`",
                      after);
    else
      cag_parse_error(p, CAG_ERR_expected_expression, place, "expected an expression, found %s",
                      found);
  } else {
    d = cag_parse_error(p, CAG_ERR_expected_expression, here, "expected an expression, found %s",
                        found);
    if (kind == CAG_TOKEN_PLUS) cag_parse_help(d, "remove the +");
    else if (kind == CAG_TOKEN_EQUALS && p->previous.kind == CAG_TOKEN_GREATER)
      cag_parse_help(d, "write >=");
    else if (kind == CAG_TOKEN_SHOW || kind == CAG_TOKEN_PRINT || kind == CAG_TOKEN_ASSERT)
      cag_parse_help(d, "it starts a statement, not a value");
    else if (kind == CAG_TOKEN_COMMA && p->previous.kind == CAG_TOKEN_COMMA)
      cag_parse_help(d, "remove one comma");
  }
  return cag_parse_error_node(p);
}

// Reads and reports an expression that needs parentheses inside of an operation, because it extends
// far to the right.
static CagExpr *in_parentheses(Parser *p, CagExpr *(*read)(Parser *), const char *what) {
  CagSpan here = cag_parse_here(p);
  CagExpr *e = read(p);
  if (e->kind == CAG_EXPR_ERROR) return e;
  char text[QUOTE_SIZE];
  CagDiagnostic *d = cag_parse_mend(p, CAG_ERR_needs_parentheses, here,
                                    "put %s in parentheses inside of an operation", what);
  cag_parse_help(d, "write (%s)", cag_parse_quote(p, e->span, text, sizeof text, "..."));
  return e;
}

static CagExpr *simple(Parser *p, CagExprKind kind) {
  CagExpr *e = cag_parse_new(p, kind, cag_parse_here(p).start);
  cag_parse_advance(p);
  return cag_parse_finish(p, e);
}

// primary = number | text | "true" | "false" | "none" | name | "(" expr ")" | "[" ... "]" | record
// | block
static CagExpr *primary(Parser *p) {
  CagToken *t = parse_current(p);
  CagExpr *e;
  switch (parse_kind(p)) {
  case CAG_TOKEN_NUMBER:
  case CAG_TOKEN_ANGLE:
    e = cag_parse_new(p, t->kind == CAG_TOKEN_NUMBER ? CAG_EXPR_NUMBER : CAG_EXPR_ANGLE,
                      t->span.start);
    e->as.number = t->as.number;
    cag_parse_advance(p);
    return cag_parse_finish(p, e);
  case CAG_TOKEN_NAME:
    if (t->newline_before && cag_parse_at_next_definition(p)) return cag_parse_missing(p);
    if (parse_kind_at(p, 1) == CAG_TOKEN_ARROW)
      return in_parentheses(p, cag_parse_lambda, "a function");
    t = parse_current(p);
    e = cag_parse_new(p, CAG_EXPR_NAME, t->span.start);
    e->as.name.id = t->as.name;
    cag_parse_advance(p);
    return cag_parse_finish(p, e);
  case CAG_TOKEN_TEXT:
    e = text_part(p);
    cag_parse_advance(p);
    return e;
  case CAG_TOKEN_TEXT_HEAD: return template(p);
  case CAG_TOKEN_TRUE: return simple(p, CAG_EXPR_TRUE);
  case CAG_TOKEN_FALSE: return simple(p, CAG_EXPR_FALSE);
  case CAG_TOKEN_NONE: return simple(p, CAG_EXPR_NONE);
  case CAG_TOKEN_LEFT_PAREN:
    if (cag_parse_opens_lambda(p)) return in_parentheses(p, cag_parse_lambda, "a function");
    return cag_parse_group(p);
  case CAG_TOKEN_LEFT_SQUARE: return list_expression(p);
  case CAG_TOKEN_LEFT_BRACE: return braces(p);
  case CAG_TOKEN_IF: return in_parentheses(p, cag_parse_branch, "an `if`");
  case CAG_TOKEN_NOT: return in_parentheses(p, cag_parse_negation, "a `not`");
  default: return cag_parse_missing(p);
  }
}

// ---- calls, indices, members ----

// argument = expr | word ":" expr
static CagArgument argument(Parser *p, bool *named) {
  CagArgument a = {0};
  CagToken *t = parse_current(p);
  CagTokenKind next = cag_parse_is_word(parse_kind(p)) ? parse_kind_at(p, 1) : CAG_TOKEN_END;
  bool foreign = next == CAG_TOKEN_EQUALS && !cag_parse_at_statement(p);
  if (next == CAG_TOKEN_COLON || foreign) {
    t = parse_current(p);
    a.name = t->as.name;
    a.name_span = t->span;
    cag_parse_advance(p);
    if (foreign)
      cag_parse_help(cag_parse_mend(p, CAG_ERR_argument_equals, cag_parse_here(p),
                                    "a named argument is written with a colon"),
                     "write %s: value", a.name);
    cag_parse_advance(p);
    *named = true;
    a.value = cag_parse_expression(p);
    return a;
  }
  if (parse_kind(p) == CAG_TOKEN_SPREAD) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_spread_misplaced, t->span,
                                   "`...` is only allowed in a list or a record"),
                   "pass each argument separately");
    a.value = cag_parse_error_node(p);
    return a;
  }
  a.value = cag_parse_expression(p);
  if (*named && !p->panic && a.value->kind != CAG_EXPR_ERROR)
    cag_parse_help(cag_parse_mend(p, CAG_ERR_position_after_name, a.value->span,
                                  "positional arguments come before named ones"),
                   "name it as well, or move it to the front");
  return a;
}

// call = "(" [ argument { "," argument } ] ")"
static CagExpr *call(Parser *p, CagExpr *callee) {
  CagExpr *e = cag_parse_new(p, CAG_EXPR_CALL, callee->span.start), *last = NULL;
  e->as.call.callee = callee;
  cag_parse_stack_on(p, e, callee);
  Opened o = cag_parse_open(p, false);
  size_t list = cag_parse_list_begin(p);
  bool named = false;
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_PAREN) {
    CagArgument a = argument(p, &named);
    last = a.value;
    cag_parse_stack_on(p, e, last);
    cag_parse_list_push(p, &a, sizeof a);
    if (!cag_parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_PAREN, last, "`,` or `)`");
  e->as.call.arguments = cag_parse_list_end(p, list, sizeof(CagArgument), &e->as.call.count);
  return cag_parse_finish(p, e);
}

static CagExpr *index_expression(Parser *p, CagExpr *object) {
  CagSpan at = cag_parse_here(p);
  Opened o = cag_parse_open(p, false);
  CagExpr *inside = cag_parse_expression(p);
  cag_parse_foreign_colon(p, CAG_FOREIGN_colon_slice);
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, inside, "`]`");
  return cag_parse_binary(p, CAG_EXPR_INDEX, CAG_OP_ADD, at, object, inside);
}

static CagExpr *member(Parser *p, CagExpr *object) {
  CagSpan dot = cag_parse_here(p);
  cag_parse_advance(p);
  CagToken *t = parse_current(p);
  if (!cag_parse_is_word(parse_kind(p))) {
    char text[QUOTE_SIZE], word[64];
    const char *found = cag_parse_found(p, word, sizeof word);
    CagSpan span = {object->span.start, dot.end};
    if (object->kind == CAG_EXPR_NUMBER && object->span.end == dot.start)
      cag_parse_help(cag_parse_error(p, CAG_ERR_number_point, span,
                                     "a number has digits on both sides of its point"),
                     "write %s.0", cag_parse_quote(p, object->span, text, sizeof text, "1"));
    else if (parse_kind(p) == CAG_TOKEN_NUMBER)
      cag_parse_help(cag_parse_error(p, CAG_ERR_expected_name, t->span,
                                     "expected a name after `.`, found %s", found),
                     "an element of a list is xs[0]");
    else
      cag_parse_error(p, CAG_ERR_expected_name, cag_parse_here(p),
                      "expected a name after `.`, found %s", found);
    return object;
  }
  CagExpr *e = cag_parse_new(p, CAG_EXPR_MEMBER, object->span.start);
  e->as.member.object = object;
  e->as.member.name = t->as.name;
  e->as.member.name_span = t->span;
  cag_parse_stack_on(p, e, object);
  cag_parse_advance(p);
  return cag_parse_finish(p, e);
}

// postfix = primary { call | "[" expr "]" | "." word }
//
// The bracket of a call or an index must be on the same line as the expression before it, even
// inside of brackets.
CagExpr *cag_parse_postfix(Parser *p) {
  CagExpr *e = primary(p);
  for (;;) {
    bool moved = parse_current(p)->newline_before;
    switch (parse_kind(p)) {
    case CAG_TOKEN_LEFT_PAREN:
      if (moved) return e;
      e = call(p, e);
      break;
    case CAG_TOKEN_LEFT_SQUARE:
      if (moved) return e;
      e = index_expression(p, e);
      break;
    case CAG_TOKEN_DOT: e = member(p, e); break;
    default: return e;
    }
  }
}
