// Statements, and the parser as a whole.

#include "lang/parser.h"
#include "base/array.h"
#include "base/memory.h"
#include "lang/damage.h"
#include "lang/parse.h"

#include <string.h>

// ---- statements ----

static CagStatement *new_statement(Parser *p, CagStatementKind kind) {
  CagStatement *s = cag_arena_alloc(&p->module->arena, sizeof *s);
  s->kind = kind;
  s->span = parse_current(p)->span;
  s->doc = cag_parse_doc(p);
  p->statement_head = s->span;
  p->statement_kind = parse_kind(p);
  return s;
}

static CagStatement *end_statement(Parser *p, CagStatement *s) {
  if (p->previous.span.end > s->span.start) s->span.end = p->previous.span.end;
  return s;
}

// Adds the text of one /// comment, without its slashes and the blank after them.
static void add_doc_line(Parser *p, size_t list, CagSpan span) {
  const char *text = p->module->source->text + span.start + 3;
  size_t length = span.end - span.start - 3;
  if (length && *text == ' ') text++, length--;
  if (cag_parse_list_begin(p) > list) cag_parse_list_push(p, "\n", 1);
  if (length) cag_parse_list_push(p, text, length);
}

// Returns the documentation before the current token: all its /// lines.
const char *cag_parse_doc(Parser *p) {
  const CagComment *comments = p->lexer.comments;
  size_t end = parse_current(p)->comments, first = end;
  bool any = false;
  while (first > 0 && comments[first - 1].span.start >= p->previous.span.end)
    any |= comments[--first].doc;
  if (!any) return NULL;
  size_t list = cag_parse_list_begin(p), length;
  for (size_t i = first; i < end; i++)
    if (comments[i].doc) add_doc_line(p, list, comments[i].span);
  cag_parse_list_push(p, "", 1);
  return cag_parse_list_end(p, list, 1, &length);
}

// Makes a name belong to its statement.
static void add_to_statement(Parser *p, CagStatement *s, CagDecl *d) {
  d->statement = s;
  d->doc = s->doc;
  if (d->kind != CAG_DECL_TOP) return;
  d->index = p->top_count;
  if (!CAG_RESERVE(p->tops, p->top_capacity, p->top_count + 1)) cag_memory_leave();
  p->tops[p->top_count++] = d;
}

static CagDecl *declare_in(Parser *p, CagStatement *s, CagDeclKind kind, const CagToken *name) {
  CagDecl *d = cag_parse_declare(p, kind, name);
  add_to_statement(p, s, d);
  return d;
}

// Reads the name that a statement defines. Reports anything else, and enters panic mode.
static bool statement_name(Parser *p, CagToken *name, const char *what) {
  *name = *parse_current(p);
  if (cag_parse_accept(p, CAG_TOKEN_NAME)) return true;
  char word[64];
  const char *found = cag_parse_found(p, word, sizeof word);
  if (parse_kind(p) >= CAG_TOKEN_FIRST_WORD)
    cag_parse_help(cag_parse_error(p, CAG_ERR_reserved_name, cag_parse_here(p),
                                   "expected %s, found %s", what, found),
                   "choose another name");
  else
    cag_parse_error(p, CAG_ERR_expected_name, cag_parse_here(p), "expected %s, found %s", what,
                    found);
  name->as.name = cag_names_intern(&p->names, "_", 1)->bytes;
  return false;
}

static void expect(Parser *p, CagTokenKind kind, const char *wanted) {
  if (p->panic || cag_parse_accept(p, kind)) return;
  cag_parse_unexpected(p, NULL, CAG_ERR_expected_word, wanted);
}

// pattern "=" expr
static CagStatement *pattern_definition(Parser *p, CagDeclKind kind) {
  CagStatement *s = new_statement(p, CAG_STATEMENT_DEFINITION);
  CagPattern *pattern = s->as.definition.pattern = cag_parse_pattern(p, kind, "a name");
  add_to_statement(p, s, s->as.definition.decl = cag_parse_whole(p, kind, pattern));
  for (size_t i = 0; i < pattern->name_count; i++) add_to_statement(p, s, pattern->names[i]);
  expect(p, CAG_TOKEN_EQUALS, "`=`");
  s->as.definition.value = cag_parse_expression(p);
  return end_statement(p, s);
}

// definition = name [ "(" [ parameters ] ")" ] "=" expr | pattern "=" expr
CagStatement *cag_parse_definition(Parser *p, bool top) {
  const CagDeclKind kind = top ? CAG_DECL_TOP : CAG_DECL_BLOCK;
  if (parse_kind(p) != CAG_TOKEN_NAME) return pattern_definition(p, kind);
  CagStatement *s = new_statement(p, CAG_STATEMENT_DEFINITION);
  CagToken name = *parse_current(p);
  cag_parse_advance(p);
  CagFunctionAst *f = NULL;
  if (parse_kind(p) == CAG_TOKEN_LEFT_PAREN) f = cag_parse_function(p, name.as.name);
  s->as.definition.decl = declare_in(p, s, kind, &name);
  if (!f || !cag_parse_foreign_body(p)) expect(p, CAG_TOKEN_EQUALS, "`=`");
  CagExpr *value = cag_parse_expression(p);
  if (f) {
    f->body = value;
    CagExpr *e = cag_parse_new(p, CAG_EXPR_LAMBDA, name.span.start);
    e->span.end = p->previous.span.end;
    e->height = value->height + 1;
    for (size_t i = 0; i < f->parameter_count; i++)
      if (f->parameters[i].fallback && f->parameters[i].fallback->height >= e->height)
        e->height = f->parameters[i].fallback->height + 1;
    e->as.function = f;
    f->span = e->span;
    if (!top) f->self = s->as.definition.decl;
    value = e;
  }
  s->as.definition.value = value;
  return end_statement(p, s);
}

// Reads a constant text, without { }.
static const char *plain_text(Parser *p, const char *what) {
  CagToken *t = parse_current(p);
  if (t->kind == CAG_TOKEN_TEXT_HEAD) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_text_not_plain, t->span, "%s has no { } in it", what),
                   "a brace itself is written \\{");
    return "";
  }
  const char *text = t->as.text.bytes;
  if (strlen(text) != t->as.text.length)
    cag_parse_help(cag_parse_error(p, CAG_ERR_text_not_plain, t->span,
                                   "%s has no character \\u{0} in it", what),
                   "remove the character");
  cag_parse_advance(p);
  return text;
}

static bool at_text(Parser *p) {
  return parse_kind(p) == CAG_TOKEN_TEXT || parse_kind(p) == CAG_TOKEN_TEXT_HEAD;
}

// param = "param" name "=" operand [ "in" expr ] [ text ]
static CagStatement *param(Parser *p) {
  CagStatement *s = new_statement(p, CAG_STATEMENT_PARAM);
  cag_parse_advance(p);
  CagToken name;
  statement_name(p, &name, "the name of the param");
  s->as.param.decl = declare_in(p, s, CAG_DECL_TOP, &name);
  expect(p, CAG_TOKEN_EQUALS, "`=` and a default");
  s->as.param.value = cag_parse_operand(p);
  if (cag_parse_accept(p, CAG_TOKEN_IN)) s->as.param.domain = cag_parse_expression(p);
  if (at_text(p) && !cag_parse_at_newline(p))
    s->as.param.label = plain_text(p, "the label of a param");
  return end_statement(p, s);
}

// ---- import ----

// Returns the last word of a path in a text: the part between its last `/` and its `.cag`. Returns
// false if it is not a valid name.
static bool word_of_path(Parser *p, const char *path, CagToken *word) {
  const char *slash = strrchr(path, '/'), *start = slash ? slash + 1 : path;
  size_t length = strlen(start);
  if (length > 4 && strcmp(start + length - 4, ".cag") == 0) length -= 4;
  char *name = cag_arena_copy(&p->module->arena, start, length);
  p->probe_source = cag_checked(cag_source_new("", name, length));
  cag_lexer_init(&p->probe, p->probe_source, &p->module->arena, &p->names, NULL);
  CagToken end;
  cag_lexer_next(&p->probe, word);
  cag_lexer_next(&p->probe, &end);
  bool good = word->kind == CAG_TOKEN_NAME && word->span.start == 0 && word->span.end == length &&
              end.kind == CAG_TOKEN_END;
  cag_parse_probe_end(p);
  return good;
}

// name { "." name }: returns the path and its last name.
static const char *module_path(Parser *p, CagToken *last) {
  size_t list = cag_parse_list_begin(p), length;
  do {
    if (!statement_name(p, last, "the name of a module")) break;
    if (cag_parse_list_begin(p) > list) cag_parse_list_push(p, ".", 1);
    cag_parse_list_push(p, last->as.name, strlen(last->as.name));
  } while (cag_parse_accept(p, CAG_TOKEN_DOT));
  cag_parse_list_push(p, "", 1);
  return cag_parse_list_end(p, list, 1, &length);
}

// ":" name { "," name }
static void import_names(Parser *p, CagStatement *s) {
  size_t list = cag_parse_list_begin(p);
  do {
    CagToken name;
    if (parse_kind(p) == CAG_TOKEN_STAR) {
      cag_parse_help(
          cag_parse_error(p, CAG_ERR_expected_name, cag_parse_here(p),
                          "expected a name of the module, found `*`"),
          "list the names that the file uses, or import the module and write module.name");
      break;
    }
    if (!statement_name(p, &name, "a name of the module")) break;
    CagImportName item = {cag_parse_declare(p, CAG_DECL_IMPORTED, &name), name.as.name};
    item.decl->statement = s;
    cag_parse_list_push(p, &item, sizeof item);
  } while (cag_parse_accept(p, CAG_TOKEN_COMMA));
  s->as.import.names = cag_parse_list_end(p, list, sizeof(CagImportName), &s->as.import.name_count);
}

// import = "import" ( name { "." name } | text ) [ "as" name ] [ ":" name { "," name } ]
static CagStatement *import(Parser *p) {
  CagStatement *s = new_statement(p, CAG_STATEMENT_IMPORT);
  cag_parse_advance(p);
  CagToken word = {0};
  bool has_word = true;
  CagSpan path = cag_parse_here(p);
  if (at_text(p)) {
    s->as.import.is_text = true;
    s->as.import.path = plain_text(p, "the path of an import");
    has_word = word_of_path(p, s->as.import.path, &word);
    word.span = path;
  } else {
    s->as.import.path = module_path(p, &word);
    path.end = p->previous.span.end;
  }
  s->as.import.path_span = path;
  if (cag_parse_accept(p, CAG_TOKEN_AS)) {
    has_word = statement_name(p, &word, "the name for the module");
    s->as.import.alias = word.as.name;
  }
  bool names = cag_parse_accept(p, CAG_TOKEN_COLON);
  if (names) import_names(p, s);
  if (names && !s->as.import.alias) return end_statement(p, s);
  if (!has_word && !p->panic) {
    cag_parse_help(
        cag_parse_mend(p, CAG_ERR_import_needs_name, path, "this path does not end in a name"),
        "add a name: as part");
    return end_statement(p, s);
  }
  if (!p->panic) {
    s->as.import.decl = cag_parse_declare(p, CAG_DECL_IMPORT, &word);
    s->as.import.decl->statement = s;
  }
  return end_statement(p, s);
}

// ---- show, print, assert ----

// ( "show" | "print" ) expr { "," expr }
static CagStatement *list_statement(Parser *p, CagStatementKind kind) {
  CagStatement *s = new_statement(p, kind);
  cag_parse_advance(p);
  size_t list = cag_parse_list_begin(p);
  do {
    CagExpr *e = cag_parse_expression(p);
    cag_parse_list_push(p, &e, sizeof e);
  } while (!p->panic && cag_parse_accept(p, CAG_TOKEN_COMMA));
  s->as.list.items = cag_parse_list_end(p, list, sizeof(CagExpr *), &s->as.list.count);
  return end_statement(p, s);
}

// assert = "assert" expr [ "," expr ]
CagStatement *cag_parse_assert(Parser *p) {
  CagStatement *s = new_statement(p, CAG_STATEMENT_ASSERT);
  cag_parse_advance(p);
  s->as.assertion.condition = cag_parse_expression(p);
  if (cag_parse_accept(p, CAG_TOKEN_COMMA)) s->as.assertion.message = cag_parse_expression(p);
  return end_statement(p, s);
}

// ---- habits ----

static bool is_one_of(const char *name, const char *const *words, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (strcmp(name, words[i]) == 0) return true;
  return false;
}
#define IS_ONE_OF(name, ...)                                                                       \
  is_one_of(name, (const char *const[]){__VA_ARGS__},                                              \
            sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

// Tests for a word that starts definitions in other languages, followed by a name or a pattern.
static bool at_definition_keyword(Parser *p) {
  const CagToken next = *cag_parse_peek(p, 1);
  const bool bracket = next.kind == CAG_TOKEN_LEFT_SQUARE || next.kind == CAG_TOKEN_LEFT_BRACE;
  if (next.kind != CAG_TOKEN_NAME && !bracket) return false;
  if (!IS_ONE_OF(parse_current(p)->as.name, "let", "var", "val", "const", "def", "define", "fn",
                 "fun", "func", "function", "local", "auto", "int", "float", "double", "string",
                 "bool", "number", "module", "export", "final", "static", "set"))
    return false;
  return !bracket || cag_parse_behind_bracket(p, next.span.start) == CAG_TOKEN_EQUALS;
}

static void skip_definition_keyword(Parser *p) {
  const CagToken word = *parse_current(p);
  cag_parse_help(
      cag_parse_mend(p, CAG_ERR_definition_keyword, word.span, "a definition starts with its name"),
      "remove `%s`", word.as.name);
  p->habit = word.span.start;
  cag_parse_advance(p);
}

// Recognizes a name of another language at the start of a statement.
//
// A word before a definition is skipped, and the definition is read.
static bool name_habit(Parser *p) {
  CagToken word = *parse_current(p), next = *cag_parse_peek(p, 1);
  if (next.newline_before) return false;
  if (cag_parse_foreign_word(p)) return true;
  if (at_definition_keyword(p)) {
    skip_definition_keyword(p);
    return false;
  }
  bool value_follows = cag_parse_begins_expression(next.kind) && next.kind != CAG_TOKEN_MINUS &&
                       next.kind != CAG_TOKEN_LEFT_SQUARE &&
                       (next.kind != CAG_TOKEN_LEFT_PAREN || next.span.start > word.span.end);
  if (!value_follows) return false;
  if (IS_ONE_OF(word.as.name, "return", "yield")) {
    cag_parse_help(
        cag_parse_mend(p, CAG_ERR_return, word.span, "`%s` does not exist in cag", word.as.name),
        "the last expression of a block is its value");
    cag_parse_advance(p);
    return false;
  }
  if (IS_ONE_OF(word.as.name, "while", "foreach", "repeat", "until", "loop")) {
    if (next.kind == CAG_TOKEN_LEFT_PAREN && strcmp(word.as.name, "repeat") == 0) return false;
    cag_parse_help(cag_parse_error(p, CAG_ERR_loop, word.span,
                                   "there is no `%s`; values cannot be changed", word.as.name),
                   "to build a list, write [for x in xs: ...]; to build a value, use %s",
                   cag_foreign_syntax(CAG_FOREIGN_while_loop));
    return true;
  }
  return false;
}

bool cag_parse_habit(Parser *p, bool in_block) {
  CagTokenKind kind = parse_kind(p);
  if (kind == CAG_TOKEN_NAME) return name_habit(p);
  if (kind < CAG_TOKEN_FIRST_WORD) return false;
  CagTokenKind next = parse_kind_at(p, 1);
  CagSpan here = cag_parse_here(p);
  char word[64];
  const char *found = cag_parse_quote(p, here, word, sizeof word, "");
  if (next == CAG_TOKEN_EQUALS ||
      (next == CAG_TOKEN_LEFT_PAREN && in_block && kind == CAG_TOKEN_BY)) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_reserved_name, here,
                                   "`%s` is a word of the language and cannot be defined", found),
                   "choose another name");
    return true;
  }
  if (kind == CAG_TOKEN_FOR) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_loop, here,
                                   "`for` is not a statement; it is only allowed in a list"),
                   "write %s", cag_foreign_syntax(CAG_FOREIGN_for_statement));
    return true;
  }
  if (!in_block) return false;
  if (kind == CAG_TOKEN_SHOW || kind == CAG_TOKEN_PRINT || kind == CAG_TOKEN_PARAM ||
      kind == CAG_TOKEN_IMPORT) {
    if (cag_parse_at_statement(p)) {
      cag_parse_unexpected(p, NULL, CAG_ERR_bracket_not_closed, "`}`");
      return true;
    }
    CagDiagnostic *d = cag_parse_error(p, CAG_ERR_block_statement, here,
                                       "`%s` is only allowed at the top level", found);
    cag_parse_help(d, kind == CAG_TOKEN_PRINT
                          ? "write trace(x) to see a value from within"
                          : "a block consists of definitions, asserts, and its value");
    return true;
  }
  return false;
}

// ---- the module ----

// Reads an expression instead of a statement.
static CagStatement *expression_statement(Parser *p) {
  CagStatement *s = new_statement(p, CAG_STATEMENT_EXPRESSION);
  const bool below = p->previous.span.end > 0; // another statement
  CagExpr *e = cag_parse_expression(p);
  s->as.expression = e;
  end_statement(p, s);
  if (p->mode == CAG_PARSE_REPL || p->panic) return s;
  if (parse_kind(p) == CAG_TOKEN_ASSIGN_OPERATOR || parse_kind(p) == CAG_TOKEN_QUESTION ||
      parse_kind(p) == CAG_TOKEN_EQUALS || cag_parse_foreign_follows(p))
    return s; // already reported
  char text[QUOTE_SIZE];
  const char *said = cag_parse_quote(p, e->span, text, sizeof text, "...");
  CagDiagnostic *d = cag_parse_mend(p, CAG_ERR_expression_statement, e->span,
                                    "an expression alone is not a statement");
  if (e->kind == CAG_EXPR_BINARY && e->as.binary.op == CAG_OP_EQUAL &&
      e->as.binary.left->kind == CAG_EXPR_NAME)
    cag_parse_help(d, "to define %s, write =", e->as.binary.left->as.name.id);
  else if (below && p->module->source->text[e->span.start] == '-')
    cag_parse_help(d, "%s", cag_parse_minus_help);
  else cag_parse_help(d, "write print %s, or show it, or give it a name", said);
  return s;
}

static CagStatement *name_statement(Parser *p) {
  CagToken *next = cag_parse_peek(p, 1);
  char text[QUOTE_SIZE];
  bool mended = p->previous.kind == CAG_TOKEN_NAME && p->previous.span.start == p->habit;
  if (next->kind == CAG_TOKEN_EQUALS || cag_parse_at_function(p) ||
      (mended && next->kind == CAG_TOKEN_LEFT_PAREN))
    return cag_parse_definition(p, true);
  next = cag_parse_peek(p, 1);
  if (next->kind == CAG_TOKEN_ASSIGN_OPERATOR) {
    const char *name = parse_current(p)->as.name;
    const char *op = cag_parse_quote(p, next->span, text, sizeof text, "=");
    CagDiagnostic *d = cag_parse_error(p, CAG_ERR_assignment_operator, next->span,
                                       "values cannot be changed: %s keeps its value", name);
    cag_parse_help(d, "define a new name: %s2 = %s %.*s ...", name, name, (int)strlen(op) - 1, op);
    return NULL;
  }
  return expression_statement(p);
}

// statement = import | param | definition | "show" list | "print" list | assert
static CagStatement *statement(Parser *p) {
  if (cag_parse_habit(p, false)) return NULL;
  CagTokenKind kind = parse_kind(p);
  switch (kind) {
  case CAG_TOKEN_IMPORT: return import(p);
  case CAG_TOKEN_PARAM: return param(p);
  case CAG_TOKEN_SHOW: return list_statement(p, CAG_STATEMENT_SHOW);
  case CAG_TOKEN_PRINT: return list_statement(p, CAG_STATEMENT_PRINT);
  case CAG_TOKEN_ASSERT: return cag_parse_assert(p);
  case CAG_TOKEN_NAME: return name_statement(p);
  default: break;
  }
  if (cag_parse_at_pattern(p)) return cag_parse_definition(p, true);
  if (cag_parse_begins_expression(kind)) return expression_statement(p);
  char word[64];
  if (kind == CAG_TOKEN_RIGHT_PAREN || kind == CAG_TOKEN_RIGHT_SQUARE ||
      kind == CAG_TOKEN_RIGHT_BRACE)
    cag_parse_unexpected(p, NULL, CAG_ERR_expected_statement, "a statement");
  else
    cag_parse_help(cag_parse_error(p, CAG_ERR_expected_statement, cag_parse_here(p),
                                   "expected a statement, found %s",
                                   cag_parse_found(p, word, sizeof word)),
                   "there is nothing before this line to continue");
  return NULL;
}

// end = newline | ";" | end of the file
static void end_of_statement(Parser *p, const CagStatement *s) {
  if (p->panic) return;
  CagTokenKind kind = parse_kind(p);
  if (kind == CAG_TOKEN_END || kind == CAG_TOKEN_SEMICOLON) return;
  if (cag_parse_at_newline(p) && (cag_parse_is_word(kind) || cag_parse_begins_expression(kind)) &&
      kind != CAG_TOKEN_ELSE && kind != CAG_TOKEN_THEN && kind != CAG_TOKEN_BY &&
      kind != CAG_TOKEN_AS)
    return;
  const CagExpr *before = NULL;
  if (s && s->kind == CAG_STATEMENT_DEFINITION) before = s->as.definition.value;
  if (before && before->kind == CAG_EXPR_LAMBDA) before = before->as.function->body;
  if (s && s->kind == CAG_STATEMENT_EXPRESSION) before = s->as.expression;
  if (s && (s->kind == CAG_STATEMENT_SHOW || s->kind == CAG_STATEMENT_PRINT) && s->as.list.count)
    before = s->as.list.items[s->as.list.count - 1];
  cag_parse_unexpected(p, before, CAG_ERR_expected_end, "the end of the line or `;`");
}

// Tests whether no bracket is open, and a line starts in its first column with a value that does
// not continue the previous line.
static bool at_new_line(Parser *p) {
  const CagToken *t = parse_current(p);
  if (p->bracket_count || p->excess || !t->newline_before || !cag_parse_begins_expression(t->kind))
    return false;
  if (t->span.start > 0 && p->module->source->text[t->span.start - 1] != '\n') return false;
  switch (p->previous.kind) {
  case CAG_TOKEN_RIGHT_PAREN:
  case CAG_TOKEN_RIGHT_SQUARE:
  case CAG_TOKEN_RIGHT_BRACE:
  case CAG_TOKEN_TEXT_TAIL:
  case CAG_TOKEN_ERROR:
  case CAG_TOKEN_SEMICOLON: return true;
  case CAG_TOKEN_MINUS:
  case CAG_TOKEN_IF:
  case CAG_TOKEN_NOT: return false;
  default: return cag_parse_begins_expression(p->previous.kind);
  }
}

// Treats a bracket of the wrong kind, just reported, as the right one, unless it could close
// another open bracket.
static void pass_wrong_closer(Parser *p, CagErrorId told) {
  CagTokenKind kind = parse_current(p)->kind;
  if (told != CAG_ERR_bracket_mismatch || p->excess || p->bracket_count == 0) return;
  if (kind >= CAG_TOKEN_COMMA || p->open[kind]) return;
  p->open[p->brackets[--p->bracket_count].closer]--;
  p->panic = true;
  cag_parse_skip(p);
  p->panic = false;
}

// Ends panic mode: skips to the next statement in the first column, and reports a bracket that is
// still open there.
static void recover(Parser *p, uint32_t start) {
  CagDiagnostics *errors = p->lexer.errors;
  size_t told = p->errors->count;
  bool unclosed_told =
      told && cag_diagnostics_at(p->errors, told - 1)->id == CAG_ERR_bracket_not_closed;
  p->lexer.errors = NULL; // no errors are reported in the skipped text
  p->panic = false;
  pass_wrong_closer(p, told ? cag_diagnostics_at(p->errors, told - 1)->id : CAG_ERR_COUNT);
  while (parse_kind(p) != CAG_TOKEN_END) {
    if (parse_current(p)->span.start > start && (cag_parse_at_statement(p) || at_new_line(p)))
      break;
    p->panic = true; // nor for its brackets
    cag_parse_skip(p);
    p->panic = false;
  }
  p->lexer.errors = errors;
  for (size_t i = 0; i < p->bracket_count; i++) // an open text ended with its line
    if (p->brackets[i].closer == CAG_TOKEN_TEXT_TAIL) p->bracket_count = i;
  if (p->bracket_count && !p->excess && !unclosed_told) {
    const Bracket *b = &p->brackets[p->bracket_count - 1];
    CagDiagnostic *d =
        cag_parse_mend(p, CAG_ERR_bracket_not_closed, b->span,
                       "this bracket is not closed: %s is missing", cag_token_what(b->closer));
    cag_parse_help(d, "opened here");
  }
  p->bracket_count = p->excess = p->depth = 0;
  memset(p->open, 0, sizeof p->open);
  p->stack_size = 0;
  p->newlines = true;
}

static void add_damaged_name(void *context, const char *name) {
  Parser *p = context;
  if (!CAG_RESERVE(p->damaged_names, p->damaged_name_capacity, p->damaged_name_count + 1))
    cag_memory_leave();
  p->damaged_names[p->damaged_name_count++] = name;
}

static uint32_t indent_of(Parser *p) {
  const char *text = p->module->source->text;
  const uint32_t start = parse_current(p)->span.start;
  uint32_t at = start;
  while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\t')) at--;
  return at == 0 || text[at - 1] == '\n' ? start - at : UINT32_MAX;
}

BlockStart cag_parse_block_start(Parser *p) {
  return (BlockStart){p->bracket_count, p->depth, indent_of(p), parse_current(p)->span.start};
}

// Tests whether the current token is the brace that closes the block. Other brackets may be open.
static bool at_end_of_block(Parser *p, const BlockStart *b) {
  if (parse_current(p)->kind != CAG_TOKEN_RIGHT_BRACE) return false;
  for (size_t i = b->brackets; i < p->bracket_count; i++)
    if (p->brackets[i].closer == CAG_TOKEN_RIGHT_BRACE) return false;
  return true;
}

// Tests whether the current token starts a line of the block, as its indentation shows.
static bool at_line_of_block(Parser *p, const BlockStart *b) {
  const CagToken *t = parse_current(p);
  return t->newline_before && b->indent != UINT32_MAX && t->span.start > b->statement &&
         (cag_parse_is_word(t->kind) || cag_parse_begins_expression(t->kind)) &&
         indent_of(p) == b->indent;
}

// Closes the brackets that are still open in a line of the block.
static void drop_brackets(Parser *p, size_t count) {
  while (p->bracket_count > count) p->open[p->brackets[--p->bracket_count].closer]--;
}

// The names that the text from `start` to the current token may define. A name at its start may
// lack its `=`, unless the parenthesis of a call follows directly.
static void add_names_of_line(Parser *p, uint32_t start) {
  const CagSpan passed = {start, parse_current(p)->span.start};
  CagToken name, next;
  cag_lexer_probe(&p->probe, &p->lexer, start);
  cag_lexer_next(&p->probe, &name);
  cag_lexer_next(&p->probe, &next);
  cag_parse_probe_end(p);
  const bool called = next.kind == CAG_TOKEN_LEFT_PAREN && next.span.start == name.span.end;
  if (name.kind == CAG_TOKEN_NAME && !called) add_damaged_name(p, name.as.name);
  cag_damaged_names(&p->lexer, passed, add_damaged_name, p);
}

bool cag_parse_recover_in_block(Parser *p, const BlockStart *b) {
  if (p->excess || cag_diagnostics_full(p->errors)) return false;
  CagDiagnostics *errors = p->lexer.errors;
  p->lexer.errors = NULL; // no errors are reported in the skipped text
  bool line = false, end = false;
  while (p->bracket_count >= b->brackets && parse_current(p)->kind != CAG_TOKEN_END) {
    p->panic = false;
    if (cag_parse_at_statement(p) || (end = at_end_of_block(p, b)) ||
        (line = at_line_of_block(p, b)))
      break;
    p->panic = true;
    cag_parse_skip(p);
  }
  p->lexer.errors = errors;
  p->panic = !line && !end;
  if (p->panic) return false;
  if (!p->each) add_names_of_line(p, b->statement);
  drop_brackets(p, b->brackets);
  p->depth = b->depth;
  p->newlines = true;
  if (end) cag_parse_skip(p);
  return line;
}

// Skips an unreadable statement. `s` is the part that was read, or NULL.
static void pass_damaged(Parser *p, CagStatement *s, uint32_t start) {
  recover(p, start);
  if (s) s->damage = CAG_DAMAGED;
  if (p->each) return; // the names are not needed
  const CagToken *next = parse_current(p);
  const CagSpan passed = {start, next->kind == CAG_TOKEN_END ? (uint32_t)p->module->source->length
                                                             : next->span.start};
  cag_damaged_names(&p->lexer, passed, add_damaged_name, p);
}

static void show_comments(Parser *p) {
  p->module->comments = p->lexer.comments;
  p->module->comment_count = p->lexer.comment_count;
}

// Passes a statement to `each`, and frees its tree, unless the next word, which was already read,
// is in the same arena.
static void hand_over(Parser *p, const CagStatement *s) {
  show_comments(p);
  p->each(p->each_context, p->module, s);
  p->top_count = 0;
  const CagTokenKind next = parse_current(p)->kind;
  if (p->count == 1 && next != CAG_TOKEN_TEXT && next != CAG_TOKEN_TEXT_HEAD)
    cag_arena_reset(&p->module->arena);
}

static void statements(Parser *p) {
  for (;;) {
    while (cag_parse_accept(p, CAG_TOKEN_SEMICOLON)) {}
    if (parse_kind(p) == CAG_TOKEN_END) break;
    uint32_t start = parse_current(p)->span.start;
    CagStatement *s = statement(p);
    end_of_statement(p, s);
    if (p->panic) pass_damaged(p, s, start);
    if (cag_diagnostics_full(p->errors)) break;
    if (!s) continue;
    if (p->each) {
      if (p->errors->count + p->errors->dropped == p->first_error) hand_over(p, s);
      continue;
    }
    if (!CAG_RESERVE(p->statements, p->statement_capacity, p->statement_count + 1))
      cag_memory_leave();
    p->statements[p->statement_count++] = s;
  }
}

static bool check_encoding(const CagSource *source, CagDiagnostics *errors) {
  size_t bad = cag_source_bad_utf8(source);
  if (bad == source->length) return true;
  CagSpan span = {(uint32_t)bad, (uint32_t)bad + 1};
  unsigned char byte = (unsigned char)source->text[bad];
  if (byte == 0)
    cag_diagnostic_set_help(cag_diagnostics_add(errors, CAG_ERR_invalid_utf8, source, span,
                                                "this is not text: it contains a zero byte"),
                            "a script is a text in UTF-8");
  else
    cag_diagnostic_set_help(cag_diagnostics_add(errors, CAG_ERR_invalid_utf8, source, span,
                                                "the byte 0x%02X is not UTF-8 here", byte),
                            "save the file as UTF-8");
  return false;
}

static void copy_results(Parser *p) {
  CagModuleAst *m = p->module;
  const size_t statement_bytes = p->statement_count * sizeof *m->statements;
  m->statements = cag_arena_alloc(&m->arena, statement_bytes);
  if (statement_bytes) memcpy(m->statements, p->statements, statement_bytes);
  m->count = p->statement_count;
  m->tops = cag_arena_alloc(&m->arena, p->top_count * sizeof *m->tops);
  if (p->top_count) memcpy(m->tops, p->tops, p->top_count * sizeof *m->tops);
  m->top_count = p->top_count;
  size_t bytes = p->lexer.comment_count * sizeof *m->comments;
  m->comments = cag_arena_alloc(&m->arena, bytes);
  if (bytes) memcpy(m->comments, p->lexer.comments, bytes);
  m->comment_count = p->lexer.comment_count;
  m->name_count = p->names.count;
  bytes = p->damaged_name_count * sizeof *m->damaged_names;
  m->damaged_names = cag_arena_alloc(&m->arena, bytes);
  if (bytes) memcpy(m->damaged_names, p->damaged_names, bytes);
  m->damaged_name_count = p->damaged_name_count;
}

// Marks the statements that contain errors numbered `from` or higher.
static void mark_mended(CagModuleAst *m, const CagDiagnostics *errors, size_t from) {
  size_t k = 0; // both are sorted
  for (size_t i = from; i < errors->count; i++) {
    const uint32_t at = cag_diagnostics_at(errors, i)->span.start;
    while (k < m->count && m->statements[k]->span.end <= at) k++;
    if (k < m->count && m->statements[k]->damage == CAG_SOUND && m->statements[k]->span.start <= at)
      m->statements[k]->damage = CAG_MENDED;
  }
}

// Parses into a module. The arena of names may differ from the module's.
static void parse_into(Parser *p, CagArena *names) {
  CagModuleAst *m = p->module;
  CagDiagnostics *errors = p->errors;
  const size_t before = errors->count;
  p->first_error = errors->count + errors->dropped;
  p->newlines = true;
  p->habit = UINT32_MAX;
  cag_names_init(&p->names, names);
  cag_lexer_init(&p->lexer, m->source, &m->arena, &p->names, errors);
  cag_parse_peek(p, 0);
  statements(p);
  cag_diagnostics_sort(errors, before); // those of the lexer may be a few words ahead
}

static void release(Parser *p) {
  cag_lexer_release(&p->lexer);
  cag_parse_probe_end(p);
  cag_names_release(&p->names);
  cag_free(p->stack);
  cag_free(p->tops);
  cag_free(p->damaged_names);
  cag_free(p->statements);
  cag_free(p);
}

// Reports exhausted memory. If the work was asked to stop, the caller reports the reason.
static void fail_memory(const CagSource *source, CagDiagnostics *errors) {
  if (cag_source_stopped(source)) return;
  cag_diagnostics_add(errors, CAG_ERR_limit_memory, NULL, (CagSpan){0, 0},
                      "not enough memory to read %s", source->name);
}

static void parse_module(void *context) {
  Parser *p = context;
  const size_t before = p->errors->count;
  parse_into(p, &p->module->arena);
  copy_results(p);
  mark_mended(p->module, p->errors, before);
}

// Parses. *cut_off is set if the first error was that the text ended too early. Returns NULL if
// memory ran out.
static CagModuleAst *parse(const CagSource *source, CagParseMode mode, CagDiagnostics *errors,
                           bool *cut_off) {
  *cut_off = false;
  CagModuleAst *m = cag_calloc(1, sizeof *m);
  Parser *p = cag_calloc(1, sizeof *p);
  bool done = m && p;
  if (done) m->source = source;
  if (done && check_encoding(source, errors)) {
    p->module = m;
    p->errors = errors;
    p->mode = mode;
    done = cag_memory_guard(parse_module, p);
    *cut_off = p->cut_off;
  }
  if (p) release(p);
  if (done) return m;
  fail_memory(source, errors);
  cag_module_ast_free(m);
  return NULL;
}

CagModuleAst *cag_parse(const CagSource *source, CagParseMode mode, CagDiagnostics *errors) {
  bool cut_off;
  return parse(source, mode, errors, &cut_off);
}

typedef struct EachParse {
  Parser *parser;
  CagArena names;
  bool sound;
} EachParse;

static void parse_each(void *context) {
  EachParse *e = context;
  Parser *p = e->parser;
  parse_into(p, &e->names);
  e->sound = p->errors->count + p->errors->dropped == p->first_error;
  if (e->sound) hand_over(p, NULL);
}

bool cag_parse_each(const CagSource *source, CagParseEach *each, void *context,
                    CagDiagnostics *errors) {
  if (!check_encoding(source, errors)) return false;
  CagModuleAst m = {.source = source};
  EachParse e = {.parser = cag_calloc(1, sizeof(Parser))};
  if (e.parser) {
    e.parser->module = &m;
    e.parser->errors = errors;
    e.parser->each = each;
    e.parser->each_context = context;
  }
  const bool done = e.parser && cag_memory_guard(parse_each, &e);
  if (e.parser) release(e.parser);
  cag_arena_free(&e.names);
  cag_arena_free(&m.arena);
  if (!done) fail_memory(source, errors);
  return done && e.sound;
}

void cag_module_ast_free(CagModuleAst *m) {
  if (!m) return;
  cag_arena_free(&m->arena);
  cag_free(m);
}

bool cag_parse_incomplete(const char *text, size_t length) {
  CagSource *source = cag_source_new("", text, length);
  if (!source) return false;
  CagDiagnostics errors = {0};
  bool cut_off;
  cag_module_ast_free(parse(source, CAG_PARSE_REPL, &errors, &cut_off));
  cag_diagnostics_clear(&errors);
  cag_source_free(source);
  return cut_off;
}
