// Recognizes forms of other languages, so that the parser can suggest the correct form (from
// foreign.def) instead of only stating what it expected.

#include <string.h>

#include "lang/parse.h"

const char cag_parse_minus_help[] =
    "a line that starts with `-` is a new statement; to continue the previous line, end that line with `-`";

// Reports a form and enters panic mode. Returns true.
static bool report_form(Parser *p, CagSpan span, CagForeignSyntax id, const char *message) {
  cag_parse_help(cag_parse_error(p, CAG_ERR_foreign_form, span, "%s", message), "write %s",
                 cag_foreign_syntax(id));
  return true;
}

static bool is_called(const CagExpr *e, const char *name) {
  return e->kind == CAG_EXPR_CALL && e->as.call.callee->kind == CAG_EXPR_NAME &&
         strcmp(e->as.call.callee->as.name.id, name) == 0;
}

static bool is_name(const CagExpr *e, const char *name) {
  return e->kind == CAG_EXPR_NAME && strcmp(e->as.name.id, name) == 0;
}

// ---- behind an expression ----

// Recognizes union() { ... } and sphere { ... }.
static bool braces_behind(Parser *p, const CagExpr *before) {
  static const struct {
    const char *name;
    CagForeignSyntax id;
  } operations[] = {{"union", CAG_FOREIGN_union_braces},
                    {"difference", CAG_FOREIGN_difference_braces},
                    {"intersection", CAG_FOREIGN_intersection_braces},
                    {"hull", CAG_FOREIGN_hull_braces}};
  if (is_name(before, "try"))
    return report_form(p, before->span, CAG_FOREIGN_try_braces, "`try` does not exist in cag");
  if (is_called(before, "switch") || is_called(before, "match"))
    return report_form(p, before->span, CAG_FOREIGN_switch_word,
                       "a conditional is written with `if`");
  for (size_t i = 0; i < sizeof operations / sizeof *operations; i++)
    if (is_called(before, operations[i].name) || is_name(before, operations[i].name))
      return report_form(p, cag_parse_here(p), operations[i].id,
                         "the operands of a set operation are in parentheses, not in { }");
  if (before->kind == CAG_EXPR_CALL)
    return report_form(p, cag_parse_here(p), CAG_FOREIGN_call_braces,
                       "the arguments of a function are in parentheses, not in { }");
  if (before->kind == CAG_EXPR_NAME)
    return report_form(p, cag_parse_here(p), CAG_FOREIGN_object_braces,
                       "the arguments of a function are in parentheses, not in { }");
  return false;
}

// Recognizes `translate(V) sphere(2)`. The suggestion puts the shape before the pipe, and reverses
// a chain of modifiers.
#define MODIFIERS_MAX 4
static bool modifiers_behind(Parser *p, const CagExpr *before) {
  CagSpan parts[MODIFIERS_MAX] = {before->span};
  size_t count = 1;
  const CagSpan here = cag_parse_here(p);
  while (count < MODIFIERS_MAX && parse_kind(p) == CAG_TOKEN_NAME && !cag_parse_at_newline(p))
    parts[count++] = cag_parse_postfix(p)->span;
  if (p->panic) return true;
  char form[MODIFIERS_MAX * (QUOTE_SIZE + 4)] = "", part[QUOTE_SIZE];
  for (size_t i = count; i-- > 0;) {
    strcat(form, i + 1 < count ? " |> " : "");
    strcat(form, cag_parse_quote(p, parts[i], part, sizeof part, "..."));
  }
  if (strstr(form, "..."))
    snprintf(form, sizeof form, "%s", cag_foreign_syntax(CAG_FOREIGN_modifier));
  cag_parse_help(cag_parse_error(p, CAG_ERR_foreign_form, here,
                                 "a function does not apply to what follows its call"),
                 "write %s", form);
  return true;
}

static bool name_behind(Parser *p, const CagExpr *before) {
  static const struct {
    const char *word;
    CagForeignSyntax id;
  } operators[] = {{"mod", CAG_FOREIGN_word_operator},
                   {"rem", CAG_FOREIGN_word_operator},
                   {"div", CAG_FOREIGN_word_division},
                   {"is", CAG_FOREIGN_word_is},
                   {"eq", CAG_FOREIGN_word_is}};
  const CagToken *t = parse_current(p);
  const char *word = t->as.name;
  char number[QUOTE_SIZE], message[QUOTE_SIZE];
  if (p->previous.kind == CAG_TOKEN_NUMBER && cag_lexer_is_unit(word) &&
      cag_parse_quote(p, p->previous.span, number, sizeof number, NULL)) {
    cag_parse_help(
        cag_parse_error(p, CAG_ERR_foreign_form, t->span, "a unit comes directly after its number"),
        "write %s%s", number, word);
    return true;
  }
  for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
    if (strcmp(word, operators[i].word) != 0) continue;
    snprintf(message, sizeof message, "`%s` is not an operator", word);
    return report_form(p, t->span, operators[i].id, message);
  }
  if (!before) return false;
  if (is_name(before, "lambda"))
    return report_form(p, before->span, CAG_FOREIGN_lambda_word, "a function is written with =>");
  if (is_name(before, "new"))
    return report_form(p, before->span, CAG_FOREIGN_new_word, "`new` does not exist in cag");
  if (before->kind == CAG_EXPR_CALL) return modifiers_behind(p, before);
  return false;
}

static bool text_behind(Parser *p, const CagExpr *before) {
  static const char *const printing[] = {"echo", "puts", "println", "printf"};
  if (before->kind != CAG_EXPR_NAME) return false;
  if (before->span.end == parse_current(p)->span.start)
    return report_form(
        p, before->span, CAG_FOREIGN_prefixed_text,
        "a text has no letter before it; the { } of any text can contain expressions");
  for (size_t i = 0; i < sizeof printing / sizeof *printing; i++)
    if (is_name(before, printing[i]))
      return report_form(p, before->span, CAG_FOREIGN_print_word, "values are printed by `print`");
  return false;
}

// Recognizes braces that are meant literally after an expression in the { } of a text. A `:`
// directly followed by a format specifier is reported elsewhere.
static bool brace_in_text(Parser *p) {
  if (p->bracket_count == 0 || p->brackets[p->bracket_count - 1].closer != CAG_TOKEN_TEXT_TAIL)
    return false;
  char word[64];
  const CagToken t = *parse_current(p);
  if (t.kind == CAG_TOKEN_COLON && cag_parse_peek(p, 1)->span.start == t.span.end) return false;
  if (t.kind != CAG_TOKEN_COLON && t.kind != CAG_TOKEN_LEFT_BRACE && t.kind != CAG_TOKEN_NAME &&
      t.kind != CAG_TOKEN_SEMICOLON && t.kind != CAG_TOKEN_EQUALS)
    return false;
  cag_parse_help(cag_parse_error(p, CAG_ERR_expected_separator, t.span, "expected `}`, found %s",
                                 cag_parse_found(p, word, sizeof word)),
                 "%s", cag_lexer_brace_help);
  return true;
}

bool cag_parse_foreign_behind(Parser *p, const CagExpr *before) {
  if (brace_in_text(p)) return true;
  if (p->panic || parse_current(p)->newline_before) return false;
  switch (parse_kind(p)) {
  case CAG_TOKEN_LEFT_BRACE: return before && braces_behind(p, before);
  case CAG_TOKEN_NAME: return name_behind(p, before);
  case CAG_TOKEN_TEXT:
  case CAG_TOKEN_TEXT_HEAD: return before && text_behind(p, before);
  case CAG_TOKEN_COLON:
    if (p->bracket_count || !before || before->kind != CAG_EXPR_NAME) return false;
    return report_form(p, cag_parse_here(p), CAG_FOREIGN_typed_definition,
                       "a definition does not state a type");
  default: return false;
  }
}

bool cag_parse_foreign_follows(Parser *p) {
  if (p->panic || parse_current(p)->newline_before) return false;
  switch (parse_kind(p)) {
  case CAG_TOKEN_LEFT_BRACE:
  case CAG_TOKEN_NAME:
  case CAG_TOKEN_TEXT:
  case CAG_TOKEN_TEXT_HEAD:
  case CAG_TOKEN_COLON: return true;
  default: return false;
  }
}

// ---- elsewhere ----

bool cag_parse_foreign_value(Parser *p) {
  if (p->panic) return false;
  const CagSpan here = cag_parse_here(p);
  switch (parse_kind(p)) {
  case CAG_TOKEN_LESS:
    return report_form(p, here, CAG_FOREIGN_angle_vector, "points and vectors are written in [ ]");
  case CAG_TOKEN_BAR:
    return report_form(p, here, CAG_FOREIGN_bars, "a function is written with =>");
  case CAG_TOKEN_PLUS:
    if (p->previous.kind != CAG_TOKEN_PLUS || p->previous.span.end != here.start) return false;
    return report_form(p, here, CAG_FOREIGN_increment,
                       "values cannot be changed, so there is no ++");
  default: return false;
  }
}

bool cag_parse_foreign_body(Parser *p) {
  if (p->panic) return false;
  const CagSpan here = cag_parse_here(p);
  if (parse_kind(p) == CAG_TOKEN_LEFT_BRACE)
    return report_form(p, here, CAG_FOREIGN_function_braces,
                       "expected `=` between the parameters and the value, found `{`");
  if (parse_kind(p) == CAG_TOKEN_COLON)
    return report_form(p, here, CAG_FOREIGN_function_colon,
                       "expected `=` between the parameters and the value, found `:`");
  return false;
}

bool cag_parse_foreign_colon(Parser *p, CagForeignSyntax id) {
  if (parse_kind(p) != CAG_TOKEN_COLON) return false;
  return report_form(p, cag_parse_here(p), id,
                     "a range is written with two points, not with a colon");
}

static bool is_word(const CagToken *t, const char *a, const char *b, const char *c) {
  return strcmp(t->as.name, a) == 0 || strcmp(t->as.name, b) == 0 || strcmp(t->as.name, c) == 0;
}

bool cag_parse_foreign_word(Parser *p) {
  const CagToken word = *parse_current(p);
  const CagTokenKind next = parse_kind_at(p, 1);
  if (next == CAG_TOKEN_LESS && is_word(&word, "include", "use", "import"))
    return report_form(p, word.span, CAG_FOREIGN_include_file, "a module is read by `import`");
  if (next != CAG_TOKEN_NAME) return false;
  if (is_word(&word, "class", "struct", "interface"))
    return report_form(p, word.span, CAG_FOREIGN_class_word,
                       "there are no classes; a function can return a record or a shape");
  if (is_word(&word, "from", "using", "require"))
    return report_form(p, word.span, CAG_FOREIGN_from_import, "a module is read by `import`");
  return false;
}
