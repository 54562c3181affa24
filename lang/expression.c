// Expressions: one function for each line of the grammar, loosest first at the end of the file.

#include "lang/parse.h"

#include <stdlib.h>
#include <string.h>

// ---- nodes ----

CagExpr *parse_new(Parser *p, CagExprKind kind, uint32_t start) {
  CagExpr *e = cag_arena_alloc(&p->module->arena, sizeof *e);
  e->kind = kind;
  e->height = 1;
  e->span = (CagSpan){start, start};
  return e;
}

// Ends a node behind the last token.
static CagExpr *finish(Parser *p, CagExpr *e) {
  uint32_t end = p->previous.span.end;
  e->span.end = end > e->span.start ? end : e->span.start;
  return e;
}

// Puts `below` under e in the count of heights.
static void stack_on(Parser *p, CagExpr *e, const CagExpr *below) {
  if (!below || below->height < e->height) return;
  e->height = below->height + 1;
  if (e->height <= CAG_MAX_HEIGHT || p->panic) return;
  parse_help(parse_error(p, CAG_ERR_too_long, parse_here(p),
                         "more than %d operators and brackets build one expression",
                         CAG_MAX_HEIGHT),
             "name a part of it, or use a list");
}

static CagExpr *error_here(Parser *p) { return parse_new(p, CAG_EXPR_ERROR, p->previous.span.end); }

// Counts recursion that no bracket bounds. Gives false, in panic, when it is too deep.
static bool deeper(Parser *p) {
  if (p->depth < CAG_MAX_NESTING) {
    p->depth++;
    return true;
  }
  parse_error(p, CAG_ERR_too_deep, parse_here(p), "operators nest more than %d deep here",
              CAG_MAX_NESTING);
  return false;
}

static CagExpr *binary(Parser *p, CagExprKind kind, CagBinaryOp op, CagSpan op_span, CagExpr *left,
                       CagExpr *right) {
  CagExpr *e = parse_new(p, kind, left->span.start);
  e->as.binary.op = op;
  e->as.binary.op_span = op_span;
  e->as.binary.left = left;
  e->as.binary.right = right;
  stack_on(p, e, left);
  stack_on(p, e, right);
  return finish(p, e);
}

// ---- functions ----

CagDecl *parse_declare(Parser *p, CagDeclKind kind, const CagToken *name) {
  CagDecl *d = cag_arena_alloc(&p->module->arena, sizeof *d);
  d->kind = kind;
  d->name = name->as.name;
  d->span = name->span;
  return d;
}

// Consumes a name that is defined here; NULL, in panic, when something else stands here.
static const CagToken *name_to_define(Parser *p, CagToken *name, const char *what) {
  if (parse_kind(p) == CAG_TOKEN_NAME) {
    *name = *parse_current(p);
    parse_advance(p);
    return name;
  }
  char word[64];
  const char *found = parse_found(p, word, sizeof word);
  if (parse_is_word(parse_kind(p)))
    parse_help(
        parse_error(p, CAG_ERR_reserved_name, parse_here(p), "expected %s, found %s", what, found),
        "choose another name");
  else parse_error(p, CAG_ERR_expected_name, parse_here(p), "expected %s, found %s", what, found);
  return NULL;
}

// parameters = parameter { "," parameter }          parameter = name [ "=" expr ]
//
// From the opening bracket to the closing one.
static void parameters(Parser *p, CagFunctionAst *f) {
  Opened o = parse_open(p, false);
  size_t list = parse_list_begin(p);
  CagExpr *last = NULL;
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_PAREN) {
    CagToken name;
    if (parse_kind(p) == CAG_TOKEN_END) break;
    if (!name_to_define(p, &name, "the name of a parameter")) break;
    CagParameter parameter = {parse_declare(p, CAG_DECL_PARAMETER, &name), NULL};
    last = NULL;
    if (parse_accept(p, CAG_TOKEN_EQUALS)) {
      parameter.fallback = last = parse_expression(p);
    } else if (parse_kind(p) == CAG_TOKEN_COLON && parse_kind_at(p, 1) == CAG_TOKEN_NAME) {
      parse_help(parse_error(p, CAG_ERR_expected_separator, parse_here(p),
                             "expected `,` or `)`, found `:`"),
                 "parameters have no types; a default is written %s = 1", name.as.name);
    }
    parse_list_push(p, &parameter, sizeof parameter);
    if (!parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  parse_close(p, o, CAG_TOKEN_RIGHT_PAREN, last, "`,` or `)`");
  f->parameters = parse_list_end(p, list, sizeof *f->parameters, &f->parameter_count);
  while (f->required_count < f->parameter_count && !f->parameters[f->required_count].fallback)
    f->required_count++;
}

// Puts defaults and body under the expression that holds the function.
static CagExpr *function_expression(Parser *p, CagFunctionAst *f, uint32_t start) {
  CagExpr *e = parse_new(p, CAG_EXPR_LAMBDA, start);
  e->as.function = f;
  for (size_t i = 0; i < f->parameter_count; i++) stack_on(p, e, f->parameters[i].fallback);
  stack_on(p, e, f->body);
  finish(p, e);
  f->span = e->span;
  return e;
}

// The parameters of a definition: "(" [ parameters ] ")"
CagFunctionAst *parse_function(Parser *p, const char *name) {
  CagFunctionAst *f = cag_arena_alloc(&p->module->arena, sizeof *f);
  f->name = name;
  parameters(p, f);
  return f;
}

// Whether `(` opens the parameters of a lambda: when `)`, `name ,`, `name =` or `name ) =>`
// follows.
static bool opens_lambda(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_LEFT_PAREN) return false;
  CagTokenKind next = parse_kind_at(p, 1);
  if (next == CAG_TOKEN_RIGHT_PAREN) return true;
  if (next != CAG_TOKEN_NAME) return false;
  next = parse_kind_at(p, 2);
  return next == CAG_TOKEN_COMMA || next == CAG_TOKEN_EQUALS ||
         (next == CAG_TOKEN_RIGHT_PAREN && parse_kind_at(p, 3) == CAG_TOKEN_ARROW);
}

static bool at_lambda(Parser *p) {
  CagTokenKind kind = parse_kind(p);
  if (kind == CAG_TOKEN_NAME) return parse_kind_at(p, 1) == CAG_TOKEN_ARROW;
  return kind == CAG_TOKEN_LEFT_PAREN && opens_lambda(p);
}

// print(a, b), or a list in parentheses.
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
    CagDiagnostic *d = parse_mend(p, CAG_ERR_print_parentheses, span,
                                  "%s is a statement and takes no parentheses", word);
    parse_help(d, "write %s %s", word, parse_quote(p, inside, text, sizeof text, "a, b"));
    return;
  }
  if (inside.end <= inside.start)
    parse_help(parse_mend(p, CAG_ERR_tuple, span, "there is nothing in these parentheses"),
               "an empty list is [], a function without parameters () => e");
  else
    parse_help(parse_mend(p, CAG_ERR_tuple, span, "a list stands in [ ]"), "write [%s]",
               parse_quote(p, inside, text, sizeof text, "a, b"));
}

static CagExpr *group(Parser *p);

// lambda = ( name | "(" [ parameters ] ")" ) "=>" expr
static CagExpr *lambda(Parser *p) {
  uint32_t start = parse_here(p).start;
  CagFunctionAst *f = cag_arena_alloc(&p->module->arena, sizeof *f);
  if (parse_kind(p) == CAG_TOKEN_NAME) {
    CagParameter parameter = {parse_declare(p, CAG_DECL_PARAMETER, parse_current(p)), NULL};
    parse_advance(p);
    f->parameters = cag_arena_alloc(&p->module->arena, sizeof parameter);
    f->parameters[0] = parameter;
    f->parameter_count = f->required_count = 1;
  } else {
    if (parse_at_tuple(p)) return group(p);
    parameters(p, f);
  }
  if (!parse_accept(p, CAG_TOKEN_ARROW)) parse_unexpected(p, NULL, CAG_ERR_expected_word, "`=>`");
  if (p->panic || !deeper(p)) return error_here(p);
  f->body = parse_expression(p);
  p->depth--;
  return function_expression(p, f, start);
}

// ---- if ----

static void expect_then(Parser *p, const CagExpr *condition) {
  if (p->panic || parse_accept(p, CAG_TOKEN_THEN)) return;
  CagTokenKind kind = parse_kind(p);
  if (kind == CAG_TOKEN_COLON || kind == CAG_TOKEN_LEFT_BRACE) {
    char word[64];
    const char *found = parse_found(p, word, sizeof word);
    parse_help(
        parse_error(p, CAG_ERR_expected_word, parse_here(p), "expected `then`, found %s", found),
        "write if c then a else b");
    return;
  }
  parse_unexpected(p, condition, CAG_ERR_expected_word, "`then`");
}

static bool expect_else(Parser *p, CagSpan opening, const CagExpr *value) {
  if (p->panic || parse_accept(p, CAG_TOKEN_ELSE)) return !p->panic;
  const CagToken *t = parse_current(p);
  if (parse_token_is(p, t, "elif") || parse_token_is(p, t, "elseif") ||
      parse_token_is(p, t, "elsif")) {
    parse_help(parse_mend(p, CAG_ERR_elif, t->span, "`%s` is two words here", t->as.name),
               "write else if");
    t = parse_current(p);
    parse_advance(p);
    return true;
  }
  bool over = t->kind == CAG_TOKEN_END || t->newline_before || t->kind == CAG_TOKEN_COMMA ||
              t->kind == CAG_TOKEN_SEMICOLON || t->kind == CAG_TOKEN_RIGHT_PAREN ||
              t->kind == CAG_TOKEN_RIGHT_SQUARE || t->kind == CAG_TOKEN_RIGHT_BRACE ||
              t->kind == CAG_TOKEN_TEXT_TAIL;
  if (over) {
    CagDiagnostic *d = parse_error(p, CAG_ERR_if_without_else, opening, "this `if` has no `else`");
    parse_help(d, "its value in the other case is missing: else none");
  } else {
    parse_unexpected(p, value, CAG_ERR_expected_word, "`else`");
  }
  return false;
}

// "if" expr "then" expr "else" expr
//
// A chain of `else if` is read in a loop: generated code has long ones.
static CagExpr *branch(Parser *p) {
  size_t list = parse_list_begin(p);
  CagExpr *first = NULL, *last = NULL;
  if (!deeper(p)) return error_here(p);
  bool was_elif;
  do {
    CagSpan opening = parse_here(p);
    CagExpr *e = parse_new(p, CAG_EXPR_IF, opening.start);
    if (parse_kind(p) == CAG_TOKEN_IF) parse_advance(p);
    e->as.branch.condition = parse_expression(p);
    expect_then(p, e->as.branch.condition);
    e->as.branch.then = parse_expression(p);
    was_elif = false;
    if (expect_else(p, opening, e->as.branch.then)) was_elif = p->previous.kind == CAG_TOKEN_NAME;
    if (last) last->as.branch.otherwise = e;
    else first = e;
    last = e;
    parse_list_push(p, &e, sizeof e);
  } while (!p->panic && (was_elif || parse_kind(p) == CAG_TOKEN_IF));
  last->as.branch.otherwise = parse_expression(p);

  size_t count;
  CagExpr **chain = parse_list_end(p, list, sizeof *chain, &count);
  for (size_t i = count; i-- > 0;) {
    stack_on(p, chain[i], chain[i]->as.branch.condition);
    stack_on(p, chain[i], chain[i]->as.branch.then);
    stack_on(p, chain[i], chain[i]->as.branch.otherwise);
    finish(p, chain[i]);
  }
  p->depth--;
  return first;
}

// ---- lists ----

// "for" clause ...   clause = ( name | "[" name { "," name } "]" ) "in" expr [ "if" expr ]
static bool clause_name(Parser *p, size_t *list) {
  CagToken name;
  (void)list;
  if (!name_to_define(p, &name, "a name")) return false;
  CagDecl *d = strcmp(name.as.name, "_") == 0 ? NULL : parse_declare(p, CAG_DECL_CLAUSE, &name);
  parse_list_push(p, &d, sizeof d);
  return true;
}

static CagClause clause(Parser *p) {
  CagClause c = {.span = parse_here(p)};
  size_t list = parse_list_begin(p);
  if (parse_kind(p) == CAG_TOKEN_LEFT_SQUARE) {
    c.pattern = true;
    Opened o = parse_open(p, false);
    while (clause_name(p, &list) && parse_accept(p, CAG_TOKEN_COMMA) &&
           parse_kind(p) != CAG_TOKEN_RIGHT_SQUARE) {}
    parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, NULL, "`,` or `]`");
  } else {
    clause_name(p, &list);
    if (parse_kind(p) == CAG_TOKEN_COMMA && parse_kind_at(p, 1) == CAG_TOKEN_NAME) {
      parse_help(parse_error(p, CAG_ERR_expected_word, parse_here(p), "expected `in`, found `,`"),
                 "to take elements apart write [for [a, b] in xs: ...]");
    }
  }
  c.names = parse_list_end(p, list, sizeof *c.names, &c.name_count);
  if (!parse_accept(p, CAG_TOKEN_IN)) {
    if (parse_kind(p) == CAG_TOKEN_EQUALS) {
      parse_help(parse_error(p, CAG_ERR_expected_word, parse_here(p), "expected `in`, found `=`"),
                 "write for i in 0..10");
    } else {
      parse_unexpected(p, NULL, CAG_ERR_expected_word, "`in`");
    }
  }
  c.source = parse_expression(p);
  if (parse_accept(p, CAG_TOKEN_IF)) c.filter = parse_expression(p);
  c.span.end = p->previous.span.end;
  return c;
}

static CagExpr *comprehension(Parser *p, Opened o) {
  CagExpr *e = parse_new(p, CAG_EXPR_COMPREHENSION, o.span.start);
  parse_advance(p); // for
  size_t list = parse_list_begin(p);
  const CagExpr *last;
  do {
    CagClause c = clause(p);
    last = c.filter ? c.filter : c.source;
    stack_on(p, e, c.source);
    stack_on(p, e, c.filter);
    parse_list_push(p, &c, sizeof c);
  } while (!p->panic && parse_accept(p, CAG_TOKEN_COMMA));
  e->as.comprehension.clauses =
      parse_list_end(p, list, sizeof(CagClause), &e->as.comprehension.count);
  if (!parse_accept(p, CAG_TOKEN_COLON)) {
    if (parse_kind(p) == CAG_TOKEN_FOR)
      parse_help(
          parse_error(p, CAG_ERR_expected_word, parse_here(p), "expected `,` or `:`, found `for`"),
          "write [for x in xs, y in ys: ...]");
    else parse_unexpected(p, last, CAG_ERR_expected_word, "`,` or `:`");
  }
  e->as.comprehension.body = parse_expression(p);
  stack_on(p, e, e->as.comprehension.body);
  parse_accept(p, CAG_TOKEN_COMMA);
  parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, e->as.comprehension.body, "`]`");
  return finish(p, e);
}

static CagExpr *spread(Parser *p) {
  CagExpr *e = parse_new(p, CAG_EXPR_SPREAD, parse_here(p).start);
  parse_advance(p);
  e->as.unary.operand = parse_expression(p);
  stack_on(p, e, e->as.unary.operand);
  return finish(p, e);
}

// "[" [ item { "," item } ] "]"  | "[" "for" clause { "," clause } ":" expr "]"      item = expr |
// "..." expr
static CagExpr *list_expression(Parser *p) {
  Opened o = parse_open(p, false);
  if (parse_kind(p) == CAG_TOKEN_FOR) return comprehension(p, o);
  CagExpr *e = parse_new(p, CAG_EXPR_LIST, o.span.start), *item = NULL;
  size_t list = parse_list_begin(p);
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_SQUARE) {
    item = parse_kind(p) == CAG_TOKEN_SPREAD ? spread(p) : parse_expression(p);
    stack_on(p, e, item);
    parse_list_push(p, &item, sizeof item);
    if (!parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, item, "`,` or `]`");
  e->as.list.items = parse_list_end(p, list, sizeof(CagExpr *), &e->as.list.count);
  return finish(p, e);
}

// ---- records and blocks ----

// The name of a field: a word, or a text that stands for itself.
static bool field_name(Parser *p, CagField *f) {
  CagToken *t = parse_current(p);
  CagTokenKind kind = parse_kind(p);
  f->name_span = t->span;
  if (parse_is_word(kind)) {
    f->name = t->as.name;
  } else if (kind == CAG_TOKEN_TEXT) {
    f->name = cag_names_intern(&p->names, t->as.text.bytes, t->as.text.length)->bytes;
  } else if (kind == CAG_TOKEN_TEXT_HEAD) {
    parse_help(
        parse_error(p, CAG_ERR_text_not_plain, t->span, "the name of a field has no { } in it"),
        "a record with computed names is record([[name, value], ...])");
    return false;
  } else {
    parse_unexpected(p, NULL, CAG_ERR_expected_name, "the name of a field or `}`");
    return false;
  }
  parse_advance(p);
  return true;
}

// field = ( word | text ) ":" expr | "..." expr
static CagField field(Parser *p) {
  CagField f = {0};
  if (parse_kind(p) == CAG_TOKEN_SPREAD) {
    f.name_span = parse_here(p);
    parse_advance(p);
    f.value = parse_expression(p);
    return f;
  }
  if (!field_name(p, &f)) {
    f.value = error_here(p);
    return f;
  }
  if (parse_kind(p) == CAG_TOKEN_EQUALS) {
    parse_help(
        parse_mend(p, CAG_ERR_argument_equals, parse_here(p), "a field is written with a colon"),
        "write %s: value", f.name);
    parse_advance(p);
  } else if (!parse_accept(p, CAG_TOKEN_COLON)) {
    parse_unexpected(p, NULL, CAG_ERR_expected_word, "`:` behind the name of the field");
  }
  f.value = parse_expression(p);
  return f;
}

// record = "{" [ field { "," field } ] "}"
static CagExpr *record(Parser *p) {
  Opened o = parse_open(p, false);
  CagExpr *e = parse_new(p, CAG_EXPR_RECORD, o.span.start), *last = NULL;
  size_t list = parse_list_begin(p);
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_BRACE) {
    // the next statement of the file, where a field should stand, means that the brace is open
    if (parse_at_statement(p)) break;
    CagField f = field(p);
    last = f.value;
    stack_on(p, e, last);
    parse_list_push(p, &f, sizeof f);
    if (!parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  parse_close(p, o, CAG_TOKEN_RIGHT_BRACE, last, "`,` or `}`");
  e->as.record.fields = parse_list_end(p, list, sizeof(CagField), &e->as.record.count);
  return finish(p, e);
}

static bool at_definition(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_NAME) return false;
  CagTokenKind next = parse_kind_at(p, 1);
  if (next == CAG_TOKEN_EQUALS) return true;
  return next == CAG_TOKEN_LEFT_PAREN && parse_at_function(p);
}

// Behind a statement of a block: newline, `;`, or the end of the block.
static void end_in_block(Parser *p) {
  if (p->panic || parse_accept(p, CAG_TOKEN_SEMICOLON)) return;
  if (parse_kind(p) == CAG_TOKEN_RIGHT_BRACE) return;
  if (parse_at_newline(p) && parse_kind(p) != CAG_TOKEN_END &&
      (parse_is_word(parse_kind(p)) || parse_begins_expression(parse_kind(p))))
    return;
  parse_unexpected(p, NULL, CAG_ERR_expected_end, "the end of the line or `;`");
}

// Behind the value of a block.
static void close_block(Parser *p, Opened o, const CagExpr *value) {
  bool ended = parse_accept(p, CAG_TOKEN_SEMICOLON) || parse_at_newline(p);
  CagTokenKind kind = parse_kind(p);
  if (ended && !p->panic && kind != CAG_TOKEN_RIGHT_BRACE && kind != CAG_TOKEN_END &&
      !parse_at_statement(p) && (parse_is_word(kind) || parse_begins_expression(kind))) {
    parse_help(parse_error(p, CAG_ERR_expression_statement, value->span,
                           "this value is not the last thing of its block, so nothing uses it"),
               "give it a name, or leave it out");
    return;
  }
  if (kind == CAG_TOKEN_COMMA && !ended)
    parse_help(
        parse_error(p, CAG_ERR_tuple, o.span, "this brace opens a block, which has one value"),
        "a list stands in [ ], the fields of a record have names: { a: 1 }");
  else if (kind == CAG_TOKEN_COLON && value->kind == CAG_EXPR_TEMPLATE)
    parse_help(
        parse_error(p, CAG_ERR_text_not_plain, value->span, "the name of a field has no { } in it"),
        "a record with computed names is record([[name, value], ...])");
  parse_close(p, o, CAG_TOKEN_RIGHT_BRACE, value, "`}`");
}

// block = "{" { ( definition | assert ) end } expr [ ";" ] "}"
static CagExpr *block(Parser *p) {
  Opened o = parse_open(p, true);
  CagExpr *e = parse_new(p, CAG_EXPR_BLOCK, o.span.start), *value = NULL;
  size_t list = parse_list_begin(p);
  while (!p->panic && !value) {
    CagStatement *s = NULL;
    while (parse_accept(p, CAG_TOKEN_SEMICOLON)) {}
    if (parse_habit(p, true)) break;
    if (parse_kind(p) == CAG_TOKEN_ASSERT) {
      s = parse_assert(p);
      stack_on(p, e, s->as.assertion.condition);
      stack_on(p, e, s->as.assertion.message);
    } else if (at_definition(p)) {
      s = parse_definition(p, false);
      stack_on(p, e, s->as.definition.value);
    } else if (parse_kind(p) == CAG_TOKEN_RIGHT_BRACE) {
      parse_help(
          parse_error(p, CAG_ERR_block_without_value, parse_here(p), "this block has no value"),
          "it ends with an expression");
    } else {
      value = parse_expression(p);
    }
    if (s) {
      parse_list_push(p, &s, sizeof s);
      end_in_block(p);
    }
  }
  if (!value) value = error_here(p);
  close_block(p, o, value);
  e->as.block.value = value;
  stack_on(p, e, value);
  e->as.block.statements = parse_list_end(p, list, sizeof(CagStatement *), &e->as.block.count);
  return finish(p, e);
}

// `{` opens a record when `}`, `...`, or a word or text with its `:` follows, else a block.
static CagExpr *braces(Parser *p) {
  CagTokenKind next = parse_kind_at(p, 1);
  bool is_record =
      next == CAG_TOKEN_RIGHT_BRACE || next == CAG_TOKEN_SPREAD ||
      ((parse_is_word(next) || next == CAG_TOKEN_TEXT) && parse_kind_at(p, 2) == CAG_TOKEN_COLON);
  return is_record ? record(p) : block(p);
}

// ---- primaries ----

static CagExpr *text_part(Parser *p) {
  CagToken *t = parse_current(p);
  CagExpr *e = parse_new(p, CAG_EXPR_TEXT, t->span.start);
  e->as.text.bytes = t->as.text.bytes;
  e->as.text.length = t->as.text.length;
  e->span.end = t->span.end;
  return e;
}

// A text with { }: head, expression, { middle, expression }, tail.
static CagExpr *template(Parser *p) {
  CagExpr *e = parse_new(p, CAG_EXPR_TEMPLATE, parse_here(p).start);
  size_t list = parse_list_begin(p);
  CagExpr *part = text_part(p);
  parse_list_push(p, &part, sizeof part);
  Opened o = parse_open(p, false);
  for (bool last = false; !last && !p->panic;) {
    CagTokenKind kind = parse_kind(p);
    if (kind == CAG_TOKEN_TEXT_MIDDLE || kind == CAG_TOKEN_TEXT_TAIL) {
      CagSpan span = {p->previous.span.end - 1, parse_here(p).start + 1};
      parse_help(parse_mend(p, CAG_ERR_empty_interpolation, span, "there is nothing in these { }"),
                 "the braces themselves are written \\{ and \\}");
      part = error_here(p);
    } else {
      part = parse_expression(p);
    }
    stack_on(p, e, part);
    parse_list_push(p, &part, sizeof part);
    kind = parse_kind(p);
    if (kind != CAG_TOKEN_TEXT_MIDDLE && kind != CAG_TOKEN_TEXT_TAIL) {
      parse_unexpected(p, part, CAG_ERR_expected_separator, "`}`");
      break;
    }
    CagExpr *text = text_part(p);
    parse_list_push(p, &text, sizeof text);
    last = kind == CAG_TOKEN_TEXT_TAIL;
    parse_advance(p);
  }
  p->newlines = o.newlines;
  e->as.list.items = parse_list_end(p, list, sizeof(CagExpr *), &e->as.list.count);
  return finish(p, e);
}

// "(" expr ")"
static CagExpr *group(Parser *p) {
  Opened o = parse_open(p, false);
  CagExpr *e = parse_new(p, CAG_EXPR_GROUP, o.span.start);
  bool tuple = parse_kind(p) == CAG_TOKEN_RIGHT_PAREN;
  CagExpr *value = e->as.unary.operand = tuple ? error_here(p) : parse_expression(p);
  stack_on(p, e, value);
  tuple |= parse_kind(p) == CAG_TOKEN_COMMA;
  while (parse_accept(p, CAG_TOKEN_COMMA) && parse_kind(p) != CAG_TOKEN_RIGHT_PAREN)
    value = parse_expression(p);
  if (parse_close(p, o, CAG_TOKEN_RIGHT_PAREN, value, "`)`") && tuple) {
    report_tuple(p, (CagSpan){o.span.start, p->previous.span.end});
    e->kind = CAG_EXPR_ERROR;
  }
  return finish(p, e);
}

// A definition begins where the value of the line before should stand.
static bool at_next_definition(Parser *p) {
  if (!parse_current(p)->newline_before) return false;
  if (p->newlines && parse_kind(p) == CAG_TOKEN_NAME && parse_kind_at(p, 1) == CAG_TOKEN_EQUALS)
    return true;
  return parse_at_statement(p);
}

// Says that an expression is missing before the current token.
static CagExpr *missing(Parser *p) {
  if (p->panic) return error_here(p);
  CagSpan here = parse_here(p);
  CagTokenKind kind = parse_kind(p);
  char word[64], before[QUOTE_SIZE];
  const char *found = parse_found(p, word, sizeof word);
  CagDiagnostic *d = NULL;
  if ((p->bracket_count && kind == CAG_TOKEN_END) || (!p->newlines && parse_at_statement(p))) {
    parse_unexpected(p, NULL, CAG_ERR_expected_expression, "an expression");
  } else if (kind == CAG_TOKEN_DOT && parse_kind_at(p, 1) == CAG_TOKEN_NUMBER) {
    CagSpan number = parse_peek(p, 1)->span;
    here.end = number.end;
    d = parse_error(p, CAG_ERR_number_point, here,
                    "a number has digits on both sides of its point");
    parse_help(d, "write 0.%s", parse_quote(p, number, before, sizeof before, "5"));
  } else if (kind == CAG_TOKEN_RANGE || kind == CAG_TOKEN_RANGE_OPEN) {
    d = parse_error(p, CAG_ERR_open_range, here, "this range has no start");
    parse_help(d, "the first element is number 0: 0..3");
  } else if (kind == CAG_TOKEN_SPREAD) {
    d = parse_error(p, CAG_ERR_spread_misplaced, here, "`...` stands in a list or a record");
    parse_help(d, "a list is spread into another: [...xs, 4]");
  } else if (kind == CAG_TOKEN_FOR) {
    d = parse_error(p, CAG_ERR_loop, here, "`for` stands in a list");
    parse_help(d, "write [for x in xs: ...]");
  } else if (at_next_definition(p) || kind == CAG_TOKEN_END) {
    const char *after = parse_quote(p, p->previous.span, before, sizeof before, NULL);
    CagSpan place = kind == CAG_TOKEN_END ? here : p->previous.span;
    if (after)
      d = parse_error(p, CAG_ERR_expected_expression, place, "expected an expression after `%s`",
                      after);
    else
      d = parse_error(p, CAG_ERR_expected_expression, place, "expected an expression, found %s",
                      found);
  } else {
    d = parse_error(p, CAG_ERR_expected_expression, here, "expected an expression, found %s",
                    found);
    if (kind == CAG_TOKEN_PLUS) parse_help(d, "a number has no + before it");
    else if (kind == CAG_TOKEN_EQUALS && p->previous.kind == CAG_TOKEN_GREATER)
      parse_help(d, "write >=");
    else if (kind == CAG_TOKEN_SHOW || kind == CAG_TOKEN_PRINT || kind == CAG_TOKEN_ASSERT)
      parse_help(d, "a statement begins with it, and no value");
    else if (kind == CAG_TOKEN_COMMA && p->previous.kind == CAG_TOKEN_COMMA)
      parse_help(d, "one comma too many");
  }
  return error_here(p);
}

// Something that reaches far to the right, inside an operation: read, and reported.
static CagExpr *in_parentheses(Parser *p, CagExpr *(*read)(Parser *), const char *what) {
  CagSpan here = parse_here(p);
  CagExpr *e = read(p);
  if (e->kind == CAG_EXPR_ERROR) return e;
  char text[QUOTE_SIZE];
  CagDiagnostic *d =
      parse_mend(p, CAG_ERR_needs_parentheses, here, "inside an operation %s in parentheses", what);
  parse_help(d, "write (%s)", parse_quote(p, e->span, text, sizeof text, "..."));
  return e;
}

static CagExpr *negation(Parser *p);

static CagExpr *simple(Parser *p, CagExprKind kind) {
  CagExpr *e = parse_new(p, kind, parse_here(p).start);
  parse_advance(p);
  return finish(p, e);
}

// primary = number | text | "true" | "false" | "none" | name | "(" expr ")" | "[" ... "]" | record
// | block
static CagExpr *primary(Parser *p) {
  CagToken *t = parse_current(p);
  CagExpr *e;
  switch (parse_kind(p)) {
  case CAG_TOKEN_NUMBER:
  case CAG_TOKEN_ANGLE:
    e = parse_new(p, t->kind == CAG_TOKEN_NUMBER ? CAG_EXPR_NUMBER : CAG_EXPR_ANGLE, t->span.start);
    e->as.number = t->as.number;
    parse_advance(p);
    return finish(p, e);
  case CAG_TOKEN_NAME:
    if (t->newline_before && at_next_definition(p)) return missing(p);
    if (parse_kind_at(p, 1) == CAG_TOKEN_ARROW)
      return in_parentheses(p, lambda, "a function stands");
    t = parse_current(p);
    e = parse_new(p, CAG_EXPR_NAME, t->span.start);
    e->as.name.id = t->as.name;
    parse_advance(p);
    return finish(p, e);
  case CAG_TOKEN_TEXT:
    e = text_part(p);
    parse_advance(p);
    return e;
  case CAG_TOKEN_TEXT_HEAD: return template(p);
  case CAG_TOKEN_TRUE: return simple(p, CAG_EXPR_TRUE);
  case CAG_TOKEN_FALSE: return simple(p, CAG_EXPR_FALSE);
  case CAG_TOKEN_NONE: return simple(p, CAG_EXPR_NONE);
  case CAG_TOKEN_LEFT_PAREN:
    if (opens_lambda(p)) return in_parentheses(p, lambda, "a function stands");
    return group(p);
  case CAG_TOKEN_LEFT_SQUARE: return list_expression(p);
  case CAG_TOKEN_LEFT_BRACE: return braces(p);
  case CAG_TOKEN_IF: return in_parentheses(p, branch, "an `if` stands");
  case CAG_TOKEN_NOT: return in_parentheses(p, negation, "a `not` stands");
  default: return missing(p);
  }
}

// ---- calls, indices, members ----

// argument = expr | word ":" expr
static CagArgument argument(Parser *p, bool *named) {
  CagArgument a = {0};
  CagToken *t = parse_current(p);
  CagTokenKind next = parse_is_word(parse_kind(p)) ? parse_kind_at(p, 1) : CAG_TOKEN_END;
  bool foreign = next == CAG_TOKEN_EQUALS && !parse_at_statement(p);
  if (next == CAG_TOKEN_COLON || foreign) {
    t = parse_current(p);
    a.name = t->as.name;
    a.name_span = t->span;
    parse_advance(p);
    if (foreign)
      parse_help(parse_mend(p, CAG_ERR_argument_equals, parse_here(p),
                            "an argument by name is written with a colon"),
                 "write %s: value", a.name);
    parse_advance(p);
    *named = true;
    a.value = parse_expression(p);
    return a;
  }
  if (parse_kind(p) == CAG_TOKEN_SPREAD) {
    parse_help(
        parse_error(p, CAG_ERR_spread_misplaced, t->span, "`...` stands in a list or a record"),
        "a call takes each argument by itself");
    a.value = error_here(p);
    return a;
  }
  a.value = parse_expression(p);
  if (*named && !p->panic && a.value->kind != CAG_EXPR_ERROR)
    parse_help(parse_mend(p, CAG_ERR_position_after_name, a.value->span,
                          "arguments by position come before those by name"),
               "give it a name too, or move it to the front");
  return a;
}

// call = "(" [ argument { "," argument } ] ")"
static CagExpr *call(Parser *p, CagExpr *callee) {
  CagExpr *e = parse_new(p, CAG_EXPR_CALL, callee->span.start), *last = NULL;
  e->as.call.callee = callee;
  stack_on(p, e, callee);
  Opened o = parse_open(p, false);
  size_t list = parse_list_begin(p);
  bool named = false;
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_PAREN) {
    CagArgument a = argument(p, &named);
    last = a.value;
    stack_on(p, e, last);
    parse_list_push(p, &a, sizeof a);
    if (!parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  parse_close(p, o, CAG_TOKEN_RIGHT_PAREN, last, "`,` or `)`");
  e->as.call.arguments = parse_list_end(p, list, sizeof(CagArgument), &e->as.call.count);
  return finish(p, e);
}

static CagExpr *index_expression(Parser *p, CagExpr *object) {
  CagSpan at = parse_here(p);
  Opened o = parse_open(p, false);
  CagExpr *inside = parse_expression(p);
  parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, inside, "`]`");
  return binary(p, CAG_EXPR_INDEX, CAG_OP_ADD, at, object, inside);
}

static CagExpr *member(Parser *p, CagExpr *object) {
  CagSpan dot = parse_here(p);
  parse_advance(p);
  CagToken *t = parse_current(p);
  if (!parse_is_word(parse_kind(p))) {
    char text[QUOTE_SIZE], word[64];
    const char *found = parse_found(p, word, sizeof word);
    CagSpan span = {object->span.start, dot.end};
    if (object->kind == CAG_EXPR_NUMBER && object->span.end == dot.start)
      parse_help(parse_error(p, CAG_ERR_number_point, span,
                             "a number has digits on both sides of its point"),
                 "write %s.0", parse_quote(p, object->span, text, sizeof text, "1"));
    else if (parse_kind(p) == CAG_TOKEN_NUMBER)
      parse_help(parse_error(p, CAG_ERR_expected_name, t->span,
                             "expected a name after `.`, found %s", found),
                 "an element of a list is xs[0]");
    else
      parse_error(p, CAG_ERR_expected_name, parse_here(p), "expected a name after `.`, found %s",
                  found);
    return object;
  }
  CagExpr *e = parse_new(p, CAG_EXPR_MEMBER, object->span.start);
  e->as.member.object = object;
  e->as.member.name = t->as.name;
  e->as.member.name_span = t->span;
  stack_on(p, e, object);
  parse_advance(p);
  return finish(p, e);
}

// postfix = primary { call | "[" expr "]" | "." word }
//
// The bracket of a call and of an index stands on the line of what it follows, inside brackets too.
static CagExpr *postfix(Parser *p) {
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

// ---- operators ----

static CagExpr *unary(Parser *p);

// power = postfix [ "^" ( power | "-" ... ) ]
static CagExpr *power(Parser *p) {
  CagExpr *e = postfix(p);
  if (parse_kind(p) != CAG_TOKEN_CARET) return e;
  CagSpan op = parse_here(p);
  parse_advance(p);
  if (!deeper(p)) return e;
  CagExpr *right = unary(p);
  p->depth--;
  return binary(p, CAG_EXPR_BINARY, CAG_OP_POWER, op, e, right);
}

// unary = "-" unary | power
static CagExpr *unary(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_MINUS) return power(p);
  CagExpr *e = parse_new(p, CAG_EXPR_NEGATE, parse_here(p).start);
  parse_advance(p);
  if (!deeper(p)) return error_here(p);
  e->as.unary.operand = unary(p);
  p->depth--;
  stack_on(p, e, e->as.unary.operand);
  return finish(p, e);
}

// product = unary { ( "*" | "/" | "%" | "&" ) unary }
static CagExpr *product(Parser *p) {
  CagExpr *e = unary(p);
  for (;;) {
    CagBinaryOp op;
    switch (parse_kind(p)) {
    case CAG_TOKEN_STAR: op = CAG_OP_MULTIPLY; break;
    case CAG_TOKEN_SLASH: op = CAG_OP_DIVIDE; break;
    case CAG_TOKEN_PERCENT: op = CAG_OP_MODULO; break;
    case CAG_TOKEN_AMPERSAND: op = CAG_OP_INTERSECTION; break;
    default: return e;
    }
    CagSpan at = parse_here(p);
    parse_advance(p);
    CagExpr *right = unary(p);
    e = binary(p, CAG_EXPR_BINARY, op, at, e, right);
  }
}

// sum = product { ( "+" | "-" | "|" ) product }
//
// A line that begins with `-` begins something new.
static CagExpr *sum(Parser *p) {
  CagExpr *e = product(p);
  for (;;) {
    CagBinaryOp op;
    switch (parse_kind(p)) {
    case CAG_TOKEN_PLUS: op = CAG_OP_ADD; break;
    case CAG_TOKEN_MINUS:
      if (parse_at_newline(p)) return e;
      op = CAG_OP_SUBTRACT;
      break;
    case CAG_TOKEN_BAR: op = CAG_OP_UNION; break;
    default: return e;
    }
    CagSpan at = parse_here(p);
    parse_advance(p);
    CagExpr *right = product(p);
    e = binary(p, CAG_EXPR_BINARY, op, at, e, right);
  }
}

static bool at_range(Parser *p) {
  return parse_kind(p) == CAG_TOKEN_RANGE || parse_kind(p) == CAG_TOKEN_RANGE_OPEN;
}

// The end of a range, behind its `..`.
static CagExpr *range_end(Parser *p) {
  CagTokenKind kind = parse_kind(p);
  if (!p->panic && (kind == CAG_TOKEN_RIGHT_SQUARE || kind == CAG_TOKEN_RIGHT_PAREN)) {
    parse_help(parse_error(p, CAG_ERR_open_range, p->previous.span, "this range has no end"),
               kind == CAG_TOKEN_RIGHT_SQUARE ? "the last element is number -1: 1..-1"
                                              : "an unbounded range ends at inf");
    return error_here(p);
  }
  return sum(p);
}

static void report_chained_range(Parser *p, const CagExpr *e) {
  CagSpan again = parse_here(p);
  parse_advance(p);
  CagExpr *third = range_end(p);
  char a[QUOTE_SIZE], b[QUOTE_SIZE], c[QUOTE_SIZE];
  CagDiagnostic *d =
      parse_mend(p, CAG_ERR_chained_range, again, "a range has one start and one end");
  parse_help(d, "a step is written %s..%s by %s",
             parse_quote(p, e->as.range.low->span, a, sizeof a, "a"),
             parse_quote(p, third->span, c, sizeof c, "b"),
             parse_quote(p, e->as.range.high->span, b, sizeof b, "step"));
}

// operand = sum [ ( ".." | "..<" ) sum [ "by" sum ] ]
CagExpr *parse_operand(Parser *p) {
  CagExpr *low = sum(p);
  if (!at_range(p)) return low;
  CagExpr *e = parse_new(p, CAG_EXPR_RANGE, low->span.start);
  e->as.range.low = low;
  e->as.range.open = parse_kind(p) == CAG_TOKEN_RANGE_OPEN;
  parse_advance(p);
  e->as.range.high = range_end(p);
  if (at_range(p)) report_chained_range(p, e);
  if (parse_accept(p, CAG_TOKEN_BY)) e->as.range.step = sum(p);
  stack_on(p, e, low);
  stack_on(p, e, e->as.range.high);
  stack_on(p, e, e->as.range.step);
  return finish(p, e);
}

static bool comparison_op(CagTokenKind kind, CagBinaryOp *op) {
  switch (kind) {
  case CAG_TOKEN_EQUAL: *op = CAG_OP_EQUAL; return true;
  case CAG_TOKEN_NOT_EQUAL: *op = CAG_OP_NOT_EQUAL; return true;
  case CAG_TOKEN_LESS: *op = CAG_OP_LESS; return true;
  case CAG_TOKEN_LESS_EQUAL: *op = CAG_OP_LESS_EQUAL; return true;
  case CAG_TOKEN_GREATER: *op = CAG_OP_GREATER; return true;
  case CAG_TOKEN_GREATER_EQUAL: *op = CAG_OP_GREATER_EQUAL; return true;
  case CAG_TOKEN_IN: *op = CAG_OP_IN; return true;
  default: return false;
  }
}

static void report_chained_comparison(Parser *p, const CagExpr *e) {
  CagSpan again = parse_here(p), first = e->as.binary.op_span;
  parse_advance(p);
  CagExpr *third = parse_operand(p);
  char a[QUOTE_SIZE], b[QUOTE_SIZE], c[QUOTE_SIZE], op1[8], op2[8];
  const char *middle = parse_quote(p, e->as.binary.right->span, b, sizeof b, "b");
  CagDiagnostic *d = parse_mend(p, CAG_ERR_chained_comparison, again, "comparisons do not chain");
  parse_help(
      d, "write %s %s %s and %s %s %s", parse_quote(p, e->as.binary.left->span, a, sizeof a, "a"),
      parse_quote(p, first, op1, sizeof op1, "<"), middle, middle,
      parse_quote(p, again, op2, sizeof op2, "<"), parse_quote(p, third->span, c, sizeof c, "c"));
}

// comparison = operand [ ( "==" | "!=" | "<" | "<=" | ">" | ">=" | "in" ) operand ]
static CagExpr *comparison(Parser *p) {
  CagExpr *e = parse_operand(p);
  CagBinaryOp op;
  if (!comparison_op(parse_kind(p), &op)) return e;
  CagSpan at = parse_here(p);
  parse_advance(p);
  CagExpr *right = parse_operand(p);
  e = binary(p, CAG_EXPR_BINARY, op, at, e, right);
  if (comparison_op(parse_kind(p), &op)) report_chained_comparison(p, e);
  while (comparison_op(parse_kind(p), &op)) { // told once
    parse_advance(p);
    parse_operand(p);
  }
  return e;
}

// negation = "not" negation | comparison
static CagExpr *negation(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_NOT) return comparison(p);
  CagExpr *e = parse_new(p, CAG_EXPR_NOT, parse_here(p).start);
  parse_advance(p);
  if (!deeper(p)) return error_here(p);
  e->as.unary.operand = negation(p);
  p->depth--;
  stack_on(p, e, e->as.unary.operand);
  return finish(p, e);
}

// conjunction = negation { "and" negation }
static CagExpr *conjunction(Parser *p) {
  CagExpr *e = negation(p);
  while (parse_kind(p) == CAG_TOKEN_AND) {
    CagSpan at = parse_here(p);
    parse_advance(p);
    CagExpr *right = negation(p);
    e = binary(p, CAG_EXPR_AND, CAG_OP_ADD, at, e, right);
  }
  return e;
}

// disjunction = conjunction { "or" conjunction }
static CagExpr *disjunction(Parser *p) {
  CagExpr *e = conjunction(p);
  while (parse_kind(p) == CAG_TOKEN_OR) {
    CagSpan at = parse_here(p);
    parse_advance(p);
    CagExpr *right = conjunction(p);
    e = binary(p, CAG_EXPR_OR, CAG_OP_ADD, at, e, right);
  }
  return e;
}

// pipe = disjunction { "|>" disjunction }
static CagExpr *pipe_expression(Parser *p) {
  CagExpr *e = disjunction(p);
  while (parse_kind(p) == CAG_TOKEN_PIPE) {
    CagSpan at = parse_here(p);
    parse_advance(p);
    CagExpr *right = disjunction(p);
    e = binary(p, CAG_EXPR_PIPE, CAG_OP_ADD, at, e, right);
  }
  return e;
}

// expr = lambda | "if" expr "then" expr "else" expr | pipe
CagExpr *parse_expression(Parser *p) {
  if (parse_current(p)->newline_before && at_next_definition(p)) return missing(p);
  if (parse_kind(p) == CAG_TOKEN_IF) return branch(p);
  if (at_lambda(p)) return lambda(p);
  return pipe_expression(p);
}
