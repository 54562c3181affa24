// Expressions: one function for each rule of the grammar, with the loosest binding at the end of
// the file.

#include "lang/parse.h"

#include <stdlib.h>
#include <string.h>

// ---- nodes ----

CagExpr *cag_parse_new(Parser *p, CagExprKind kind, uint32_t start) {
  CagExpr *e = cag_arena_alloc(&p->module->arena, sizeof *e);
  e->kind = kind;
  e->height = 1;
  e->span = (CagSpan){start, start};
  return e;
}

// Ends a node after the last token.
CagExpr *cag_parse_finish(Parser *p, CagExpr *e) {
  uint32_t end = p->previous.span.end;
  e->span.end = end > e->span.start ? end : e->span.start;
  return e;
}

// Updates the height of e for its child `below`.
void cag_parse_stack_on(Parser *p, CagExpr *e, const CagExpr *below) {
  if (!below || below->height < e->height) return;
  e->height = below->height + 1;
  if (e->height <= CAG_MAX_HEIGHT || p->panic) return;
  cag_parse_help(cag_parse_error(p, CAG_ERR_too_long, cag_parse_here(p),
                                 "more than %d operators and brackets build one expression",
                                 CAG_MAX_HEIGHT),
                 "name a part of it, or use a list");
}

CagExpr *cag_parse_error_node(Parser *p) {
  return cag_parse_new(p, CAG_EXPR_ERROR, p->previous.span.end);
}

// Counts recursion without brackets. If it is too deep, enters panic mode and returns false.
bool cag_parse_deeper(Parser *p) {
  if (p->depth < CAG_MAX_NESTING) {
    p->depth++;
    return true;
  }
  cag_parse_error(p, CAG_ERR_too_deep, cag_parse_here(p),
                  "operators are nested more than %d deep here", CAG_MAX_NESTING);
  return false;
}

CagExpr *cag_parse_binary(Parser *p, CagExprKind kind, CagBinaryOp op, CagSpan op_span,
                          CagExpr *left, CagExpr *right) {
  CagExpr *e = cag_parse_new(p, kind, left->span.start);
  e->as.binary.op = op;
  e->as.binary.op_span = op_span;
  e->as.binary.left = left;
  e->as.binary.right = right;
  cag_parse_stack_on(p, e, left);
  cag_parse_stack_on(p, e, right);
  return cag_parse_finish(p, e);
}

// ---- functions ----

CagDecl *cag_parse_declare(Parser *p, CagDeclKind kind, const CagToken *name) {
  CagDecl *d = cag_arena_alloc(&p->module->arena, sizeof *d);
  d->kind = kind;
  d->name = name->as.name;
  d->span = name->span;
  return d;
}

// Consumes the name of a definition. If there is none, enters panic mode and returns NULL.
const CagToken *cag_parse_name_to_define(Parser *p, CagToken *name, const char *what) {
  if (parse_kind(p) == CAG_TOKEN_NAME) {
    *name = *parse_current(p);
    cag_parse_advance(p);
    return name;
  }
  char word[64];
  const char *found = cag_parse_found(p, word, sizeof word);
  if (cag_parse_is_word(parse_kind(p)))
    cag_parse_help(cag_parse_error(p, CAG_ERR_reserved_name, cag_parse_here(p),
                                   "expected %s, found %s", what, found),
                   "choose another name");
  else
    cag_parse_error(p, CAG_ERR_expected_name, cag_parse_here(p), "expected %s, found %s", what,
                    found);
  return NULL;
}

static bool at_bracket(CagTokenKind kind) {
  return kind == CAG_TOKEN_LEFT_SQUARE || kind == CAG_TOKEN_LEFT_BRACE;
}

// parameter = name [ "=" expr ] | pattern
static bool parameter(Parser *p, CagParameter *out) {
  *out = (CagParameter){0};
  CagToken name;
  if (at_bracket(parse_kind(p))) {
    out->pattern = cag_parse_pattern(p, CAG_DECL_PARAMETER, "the name of a parameter");
    out->decl = cag_parse_whole(p, CAG_DECL_PARAMETER, out->pattern);
    if (parse_kind(p) == CAG_TOKEN_EQUALS)
      cag_parse_help(cag_parse_error(p, CAG_ERR_expected_separator, cag_parse_here(p),
                                     "a parameter that is a pattern has no default"),
                     "name the parameter, and take it apart in a block");
    return true;
  }
  if (!cag_parse_name_to_define(p, &name, "the name of a parameter")) return false;
  out->decl = cag_parse_declare(p, CAG_DECL_PARAMETER, &name);
  if (cag_parse_accept(p, CAG_TOKEN_EQUALS)) {
    out->fallback = cag_parse_expression(p);
  } else if (parse_kind(p) == CAG_TOKEN_COLON && parse_kind_at(p, 1) == CAG_TOKEN_NAME) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_expected_separator, cag_parse_here(p),
                                   "expected `,` or `)`, found `:`"),
                   "parameters have no types; a default is written %s = 1", name.as.name);
  }
  return true;
}

// parameters = parameter { "," parameter }
//
// Reads from the opening bracket to the closing one.
static void parameters(Parser *p, CagFunctionAst *f) {
  Opened o = cag_parse_open(p, false);
  size_t list = cag_parse_list_begin(p);
  CagExpr *last = NULL;
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_PAREN) {
    CagParameter item;
    if (parse_kind(p) == CAG_TOKEN_END || !parameter(p, &item)) break;
    last = item.fallback;
    cag_parse_list_push(p, &item, sizeof item);
    if (!cag_parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_PAREN, last, "`,` or `)`");
  f->parameters = cag_parse_list_end(p, list, sizeof *f->parameters, &f->parameter_count);
  while (f->required_count < f->parameter_count && !f->parameters[f->required_count].fallback)
    f->required_count++;
}

// Makes defaults and body children of the expression for the function.
static CagExpr *function_expression(Parser *p, CagFunctionAst *f, uint32_t start) {
  CagExpr *e = cag_parse_new(p, CAG_EXPR_LAMBDA, start);
  e->as.function = f;
  for (size_t i = 0; i < f->parameter_count; i++)
    cag_parse_stack_on(p, e, f->parameters[i].fallback);
  cag_parse_stack_on(p, e, f->body);
  cag_parse_finish(p, e);
  f->span = e->span;
  return e;
}

// The parameters of a definition: "(" [ parameters ] ")"
CagFunctionAst *cag_parse_function(Parser *p, const char *name) {
  CagFunctionAst *f = cag_arena_alloc(&p->module->arena, sizeof *f);
  f->name = name;
  parameters(p, f);
  return f;
}

// Tests whether `(` opens the parameters of a lambda, which is the case before `)`, `name ,`, `name
// =`, `name ) =>`, or a pattern if `=>` follows the matching `)`.
bool cag_parse_opens_lambda(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_LEFT_PAREN) return false;
  CagTokenKind next = parse_kind_at(p, 1);
  if (next == CAG_TOKEN_RIGHT_PAREN) return true;
  if (at_bracket(next))
    return cag_parse_behind_bracket(p, parse_current(p)->span.start) == CAG_TOKEN_ARROW;
  if (next != CAG_TOKEN_NAME) return false;
  next = parse_kind_at(p, 2);
  return next == CAG_TOKEN_COMMA || next == CAG_TOKEN_EQUALS ||
         (next == CAG_TOKEN_RIGHT_PAREN && parse_kind_at(p, 3) == CAG_TOKEN_ARROW);
}

static bool at_lambda(Parser *p) {
  CagTokenKind kind = parse_kind(p);
  if (kind == CAG_TOKEN_NAME) return parse_kind_at(p, 1) == CAG_TOKEN_ARROW;
  return kind == CAG_TOKEN_LEFT_PAREN && cag_parse_opens_lambda(p);
}

// lambda = ( name | "(" [ parameters ] ")" ) "=>" expr
CagExpr *cag_parse_lambda(Parser *p) {
  uint32_t start = cag_parse_here(p).start;
  CagFunctionAst *f = cag_arena_alloc(&p->module->arena, sizeof *f);
  if (parse_kind(p) == CAG_TOKEN_NAME) {
    f->parameters = cag_arena_alloc(&p->module->arena, sizeof *f->parameters);
    f->parameters[0].decl = cag_parse_declare(p, CAG_DECL_PARAMETER, parse_current(p));
    cag_parse_advance(p);
    f->parameter_count = f->required_count = 1;
  } else {
    if (cag_parse_at_tuple(p)) return cag_parse_group(p);
    parameters(p, f);
  }
  if (!cag_parse_accept(p, CAG_TOKEN_ARROW))
    cag_parse_unexpected(p, NULL, CAG_ERR_expected_word, "`=>`");
  if (p->panic || !cag_parse_deeper(p)) return cag_parse_error_node(p);
  f->body = cag_parse_expression(p);
  p->depth--;
  return function_expression(p, f, start);
}

// ---- if ----

static void expect_then(Parser *p, const CagExpr *condition) {
  if (p->panic || cag_parse_accept(p, CAG_TOKEN_THEN)) return;
  CagTokenKind kind = parse_kind(p);
  if (kind == CAG_TOKEN_COLON || kind == CAG_TOKEN_LEFT_BRACE) {
    char word[64];
    const char *found = cag_parse_found(p, word, sizeof word);
    cag_parse_help(cag_parse_error(p, CAG_ERR_expected_word, cag_parse_here(p),
                                   "expected `then`, found %s", found),
                   "write %s", cag_foreign_syntax(CAG_FOREIGN_if_braces));
    return;
  }
  cag_parse_unexpected(p, condition, CAG_ERR_expected_word, "`then`");
}

static bool expect_else(Parser *p, CagSpan opening, const CagExpr *value) {
  if (p->panic || cag_parse_accept(p, CAG_TOKEN_ELSE)) return !p->panic;
  const CagToken *t = parse_current(p);
  if (cag_parse_token_is(p, t, "elif") || cag_parse_token_is(p, t, "elseif") ||
      cag_parse_token_is(p, t, "elsif")) {
    cag_parse_help(cag_parse_mend(p, CAG_ERR_elif, t->span, "`%s` is two words here", t->as.name),
                   "write else if");
    cag_parse_advance(p);
    return true;
  }
  bool over = t->kind == CAG_TOKEN_END || t->newline_before || t->kind == CAG_TOKEN_COMMA ||
              t->kind == CAG_TOKEN_SEMICOLON || t->kind == CAG_TOKEN_RIGHT_PAREN ||
              t->kind == CAG_TOKEN_RIGHT_SQUARE || t->kind == CAG_TOKEN_RIGHT_BRACE ||
              t->kind == CAG_TOKEN_TEXT_TAIL;
  if (over) {
    CagDiagnostic *d =
        cag_parse_error(p, CAG_ERR_if_without_else, opening, "this `if` has no `else`");
    cag_parse_help(d, "add a value for the other case, such as else none");
  } else {
    cag_parse_unexpected(p, value, CAG_ERR_expected_word, "`else`");
  }
  return false;
}

// "if" expr "then" expr "else" expr
//
// A chain of `else if` is read in a loop, because generated code has long ones.
CagExpr *cag_parse_branch(Parser *p) {
  size_t list = cag_parse_list_begin(p);
  CagExpr *first = NULL, *last = NULL;
  if (!cag_parse_deeper(p)) return cag_parse_error_node(p);
  bool was_elif;
  do {
    CagSpan opening = cag_parse_here(p);
    CagExpr *e = cag_parse_new(p, CAG_EXPR_IF, opening.start);
    if (parse_kind(p) == CAG_TOKEN_IF) cag_parse_advance(p);
    e->as.branch.condition = cag_parse_expression(p);
    expect_then(p, e->as.branch.condition);
    e->as.branch.then = cag_parse_expression(p);
    was_elif = false;
    if (expect_else(p, opening, e->as.branch.then)) was_elif = p->previous.kind == CAG_TOKEN_NAME;
    if (last) last->as.branch.otherwise = e;
    else first = e;
    last = e;
    cag_parse_list_push(p, &e, sizeof e);
  } while (!p->panic && (was_elif || parse_kind(p) == CAG_TOKEN_IF));
  last->as.branch.otherwise = cag_parse_expression(p);

  size_t count;
  CagExpr **chain = cag_parse_list_end(p, list, sizeof *chain, &count);
  for (size_t i = count; i-- > 0;) {
    cag_parse_stack_on(p, chain[i], chain[i]->as.branch.condition);
    cag_parse_stack_on(p, chain[i], chain[i]->as.branch.then);
    cag_parse_stack_on(p, chain[i], chain[i]->as.branch.otherwise);
    cag_parse_finish(p, chain[i]);
  }
  p->depth--;
  return first;
}

// ---- operators ----
//
// Each function below can be given its first operand, already read. Most expressions are a single
// operand, for which this avoids going through all levels.

static CagExpr *unary(Parser *p);

// power = postfix [ "^" ( power | "-" ... ) ]
static CagExpr *power(Parser *p) {
  CagExpr *e = cag_parse_postfix(p);
  if (parse_kind(p) != CAG_TOKEN_CARET) return e;
  CagSpan op = cag_parse_here(p);
  cag_parse_advance(p);
  if (!cag_parse_deeper(p)) return e;
  CagExpr *right = unary(p);
  p->depth--;
  return cag_parse_binary(p, CAG_EXPR_BINARY, CAG_OP_POWER, op, e, right);
}

// unary = "-" unary | power
static CagExpr *unary(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_MINUS) return power(p);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_NEGATE, cag_parse_here(p).start);
  cag_parse_advance(p);
  if (!cag_parse_deeper(p)) return cag_parse_error_node(p);
  e->as.unary.operand = unary(p);
  p->depth--;
  cag_parse_stack_on(p, e, e->as.unary.operand);
  return cag_parse_finish(p, e);
}

// product = unary { ( "*" | "/" | "%" | "&" ) unary }
static CagExpr *product(Parser *p, CagExpr *first) {
  CagExpr *e = first ? first : unary(p);
  for (;;) {
    CagBinaryOp op;
    switch (parse_kind(p)) {
    case CAG_TOKEN_STAR: op = CAG_OP_MULTIPLY; break;
    case CAG_TOKEN_SLASH: op = CAG_OP_DIVIDE; break;
    case CAG_TOKEN_PERCENT: op = CAG_OP_MODULO; break;
    case CAG_TOKEN_AMPERSAND: op = CAG_OP_INTERSECTION; break;
    default: return e;
    }
    CagSpan at = cag_parse_here(p);
    cag_parse_advance(p);
    CagExpr *right = unary(p);
    e = cag_parse_binary(p, CAG_EXPR_BINARY, op, at, e, right);
  }
}

// sum = product { ( "+" | "-" | "|" ) product }
//
// A line that starts with `-` starts a new statement.
static CagExpr *sum(Parser *p, CagExpr *first) {
  CagExpr *e = product(p, first);
  for (;;) {
    CagBinaryOp op;
    switch (parse_kind(p)) {
    case CAG_TOKEN_PLUS: op = CAG_OP_ADD; break;
    case CAG_TOKEN_MINUS:
      if (cag_parse_at_newline(p)) return e;
      op = CAG_OP_SUBTRACT;
      break;
    case CAG_TOKEN_BAR: op = CAG_OP_UNION; break;
    default: return e;
    }
    CagSpan at = cag_parse_here(p);
    cag_parse_advance(p);
    CagExpr *right = product(p, NULL);
    e = cag_parse_binary(p, CAG_EXPR_BINARY, op, at, e, right);
  }
}

static bool at_range(Parser *p) {
  return parse_kind(p) == CAG_TOKEN_RANGE || parse_kind(p) == CAG_TOKEN_RANGE_OPEN;
}

// Reads the end of a range, after its `..`.
static CagExpr *range_end(Parser *p) {
  CagTokenKind kind = parse_kind(p);
  if (!p->panic && (kind == CAG_TOKEN_RIGHT_SQUARE || kind == CAG_TOKEN_RIGHT_PAREN)) {
    cag_parse_help(
        cag_parse_error(p, CAG_ERR_open_range, p->previous.span, "this range has no end"),
        kind == CAG_TOKEN_RIGHT_SQUARE ? "the last element has the index -1: 1..-1"
                                       : "an unbounded range ends at inf");
    return cag_parse_error_node(p);
  }
  return sum(p, NULL);
}

static void report_chained_range(Parser *p, const CagExpr *e) {
  CagSpan again = cag_parse_here(p);
  cag_parse_advance(p);
  CagExpr *third = range_end(p);
  char a[QUOTE_SIZE], b[QUOTE_SIZE], c[QUOTE_SIZE];
  CagDiagnostic *d =
      cag_parse_mend(p, CAG_ERR_chained_range, again, "a range has one start and one end");
  cag_parse_help(d, "a step is written %s..%s by %s",
                 cag_parse_quote(p, e->as.range.low->span, a, sizeof a, "a"),
                 cag_parse_quote(p, third->span, c, sizeof c, "b"),
                 cag_parse_quote(p, e->as.range.high->span, b, sizeof b, "step"));
}

// operand = sum [ ( ".." | "..<" ) sum [ "by" sum ] ]
static CagExpr *operand(Parser *p, CagExpr *first) {
  CagExpr *low = sum(p, first);
  if (!at_range(p)) return low;
  CagExpr *e = cag_parse_new(p, CAG_EXPR_RANGE, low->span.start);
  e->as.range.low = low;
  e->as.range.open = parse_kind(p) == CAG_TOKEN_RANGE_OPEN;
  cag_parse_advance(p);
  e->as.range.high = range_end(p);
  if (at_range(p)) report_chained_range(p, e);
  if (cag_parse_accept(p, CAG_TOKEN_BY)) e->as.range.step = sum(p, NULL);
  cag_parse_stack_on(p, e, low);
  cag_parse_stack_on(p, e, e->as.range.high);
  cag_parse_stack_on(p, e, e->as.range.step);
  return cag_parse_finish(p, e);
}

CagExpr *cag_parse_operand(Parser *p) { return operand(p, NULL); }

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
  CagSpan again = cag_parse_here(p), first = e->as.binary.op_span;
  cag_parse_advance(p);
  CagExpr *third = cag_parse_operand(p);
  char a[QUOTE_SIZE], b[QUOTE_SIZE], c[QUOTE_SIZE], op1[8], op2[8];
  const char *middle = cag_parse_quote(p, e->as.binary.right->span, b, sizeof b, "b");
  CagDiagnostic *d =
      cag_parse_mend(p, CAG_ERR_chained_comparison, again, "comparisons cannot be chained");
  cag_parse_help(d, "write %s %s %s and %s %s %s",
                 cag_parse_quote(p, e->as.binary.left->span, a, sizeof a, "a"),
                 cag_parse_quote(p, first, op1, sizeof op1, "<"), middle, middle,
                 cag_parse_quote(p, again, op2, sizeof op2, "<"),
                 cag_parse_quote(p, third->span, c, sizeof c, "c"));
}

// comparison = operand [ ( "==" | "!=" | "<" | "<=" | ">" | ">=" | "in" ) operand ]
static CagExpr *comparison(Parser *p, CagExpr *first) {
  CagExpr *e = operand(p, first);
  CagBinaryOp op;
  if (!comparison_op(parse_kind(p), &op)) return e;
  CagSpan at = cag_parse_here(p);
  cag_parse_advance(p);
  CagExpr *right = cag_parse_operand(p);
  e = cag_parse_binary(p, CAG_EXPR_BINARY, op, at, e, right);
  if (comparison_op(parse_kind(p), &op)) report_chained_comparison(p, e);
  while (comparison_op(parse_kind(p), &op)) { // reported only once
    cag_parse_advance(p);
    cag_parse_operand(p);
  }
  return e;
}

// negation = "not" negation | comparison
static CagExpr *negation(Parser *p, CagExpr *first) {
  if (first || parse_kind(p) != CAG_TOKEN_NOT) return comparison(p, first);
  CagExpr *e = cag_parse_new(p, CAG_EXPR_NOT, cag_parse_here(p).start);
  cag_parse_advance(p);
  if (!cag_parse_deeper(p)) return cag_parse_error_node(p);
  e->as.unary.operand = negation(p, NULL);
  p->depth--;
  cag_parse_stack_on(p, e, e->as.unary.operand);
  return cag_parse_finish(p, e);
}

CagExpr *cag_parse_negation(Parser *p) { return negation(p, NULL); }

// conjunction = negation { "and" negation }
static CagExpr *conjunction(Parser *p, CagExpr *first) {
  CagExpr *e = negation(p, first);
  while (parse_kind(p) == CAG_TOKEN_AND) {
    CagSpan at = cag_parse_here(p);
    cag_parse_advance(p);
    CagExpr *right = negation(p, NULL);
    e = cag_parse_binary(p, CAG_EXPR_AND, CAG_OP_ADD, at, e, right);
  }
  return e;
}

// disjunction = conjunction { "or" conjunction }
static CagExpr *disjunction(Parser *p, CagExpr *first) {
  CagExpr *e = conjunction(p, first);
  while (parse_kind(p) == CAG_TOKEN_OR) {
    CagSpan at = cag_parse_here(p);
    cag_parse_advance(p);
    CagExpr *right = conjunction(p, NULL);
    e = cag_parse_binary(p, CAG_EXPR_OR, CAG_OP_ADD, at, e, right);
  }
  return e;
}

// pipe = disjunction { "|>" disjunction }
static CagExpr *pipe_expression(Parser *p, CagExpr *first) {
  CagExpr *e = disjunction(p, first);
  while (parse_kind(p) == CAG_TOKEN_PIPE) {
    CagSpan at = cag_parse_here(p);
    cag_parse_advance(p);
    CagExpr *right = disjunction(p, NULL);
    e = cag_parse_binary(p, CAG_EXPR_PIPE, CAG_OP_ADD, at, e, right);
  }
  return e;
}

// Tests for tokens between operands. (`^` is consumed together with them.)
static bool is_operator(CagTokenKind kind) {
  switch (kind) {
  case CAG_TOKEN_RANGE:
  case CAG_TOKEN_RANGE_OPEN:
  case CAG_TOKEN_PIPE:
  case CAG_TOKEN_EQUAL:
  case CAG_TOKEN_NOT_EQUAL:
  case CAG_TOKEN_LESS:
  case CAG_TOKEN_LESS_EQUAL:
  case CAG_TOKEN_GREATER:
  case CAG_TOKEN_GREATER_EQUAL:
  case CAG_TOKEN_PLUS:
  case CAG_TOKEN_MINUS:
  case CAG_TOKEN_STAR:
  case CAG_TOKEN_SLASH:
  case CAG_TOKEN_PERCENT:
  case CAG_TOKEN_BAR:
  case CAG_TOKEN_AMPERSAND:
  case CAG_TOKEN_AND:
  case CAG_TOKEN_IN:
  case CAG_TOKEN_OR: return true;
  default: return false;
  }
}

// Tests for a single word between commas and brackets, as most expressions are, for which no
// operators need to be checked.
static bool at_single_word(Parser *p) {
  switch (parse_kind(p)) {
  case CAG_TOKEN_NUMBER:
  case CAG_TOKEN_ANGLE:
  case CAG_TOKEN_NAME:
    switch (parse_kind_at(p, 1)) {
    case CAG_TOKEN_COMMA:
    case CAG_TOKEN_RIGHT_PAREN:
    case CAG_TOKEN_RIGHT_SQUARE: return true;
    default: return false;
    }
  default: return false;
  }
}

// expr = lambda | "if" expr "then" expr "else" expr | pipe
CagExpr *cag_parse_expression(Parser *p) {
  if (parse_current(p)->newline_before && cag_parse_at_next_definition(p))
    return cag_parse_missing(p);
  if (at_single_word(p)) return cag_parse_postfix(p);
  if (parse_kind(p) == CAG_TOKEN_IF) return cag_parse_branch(p);
  if (at_lambda(p)) return cag_parse_lambda(p);
  if (parse_kind(p) == CAG_TOKEN_NOT) return pipe_expression(p, NULL);
  CagExpr *first = unary(p);
  return is_operator(parse_kind(p)) ? pipe_expression(p, first) : first;
}
