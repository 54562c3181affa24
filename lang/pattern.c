// Patterns, which take lists and records apart and name their parts.

#include "lang/parse.h"

#include <string.h>

// The text of a longer pattern is cut off where it serves as a name.
#define TEXT_MAX 64

bool cag_parse_at_pattern(Parser *p) {
  const CagTokenKind kind = parse_kind(p);
  return (kind == CAG_TOKEN_LEFT_SQUARE || kind == CAG_TOKEN_LEFT_BRACE) &&
         cag_parse_behind_bracket(p, parse_current(p)->span.start) == CAG_TOKEN_EQUALS;
}

// ---- the tree ----

static CagPattern *new_pattern(Parser *p, CagPatternKind kind, uint32_t start) {
  CagPattern *pattern = cag_arena_alloc(&p->module->arena, sizeof *pattern);
  pattern->kind = kind;
  pattern->span = (CagSpan){start, start};
  return pattern;
}

static CagPattern *finish_pattern(Parser *p, CagPattern *pattern) {
  const uint32_t end = p->previous.span.end;
  if (end > pattern->span.start) pattern->span.end = end;
  return pattern;
}

static CagPattern *name_pattern(Parser *p, CagDeclKind kind, const CagToken *name) {
  CagPattern *pattern = new_pattern(p, CAG_PATTERN_NAME, name->span.start);
  pattern->span = name->span;
  pattern->decl = cag_parse_declare(p, kind, name);
  return pattern;
}

// ---- the grammar ----

static CagPattern *any_pattern(Parser *p, CagDeclKind kind, const char *what);

// What stands for a name that could not be read.
static CagPattern *missing_pattern(Parser *p, CagDeclKind kind) {
  CagToken blank = {.kind = CAG_TOKEN_NAME, .span = cag_parse_here(p)};
  blank.as.name = cag_names_intern(&p->names, "_", 1)->bytes;
  return name_pattern(p, kind, &blank);
}

static void refuse_default(Parser *p) {
  if (parse_kind(p) != CAG_TOKEN_EQUALS) return;
  cag_parse_help(cag_parse_error(p, CAG_ERR_expected_separator, cag_parse_here(p),
                                 "a name in a pattern has no default"),
                 "give the default in a definition of its own");
}

// "..." name, at the end of a list
static void rest_of_list(Parser *p, CagDeclKind kind, CagPattern *pattern) {
  const CagSpan dots = cag_parse_here(p);
  CagToken name;
  cag_parse_advance(p);
  if (!cag_parse_name_to_define(p, &name, "a name for the rest of the list")) return;
  pattern->rest = cag_parse_declare(p, kind, &name);
  pattern->rest_span = (CagSpan){dots.start, name.span.end};
  const bool last = !cag_parse_accept(p, CAG_TOKEN_COMMA);
  if (last || parse_kind(p) == CAG_TOKEN_RIGHT_SQUARE) return;
  cag_parse_help(cag_parse_error(p, CAG_ERR_spread_misplaced, pattern->rest_span,
                                 "the rest of the list comes last in a pattern"),
                 "to name the last element, index the rest: %s[-1]", name.as.name);
}

// "[" ( "..." name | pattern { "," pattern } [ "," "..." name ] ) "]"
static CagPattern *list_pattern(Parser *p, CagDeclKind kind) {
  CagPattern *pattern = new_pattern(p, CAG_PATTERN_LIST, cag_parse_here(p).start);
  const Opened o = cag_parse_open(p, false);
  const size_t list = cag_parse_list_begin(p);
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_SQUARE) {
    if (parse_kind(p) == CAG_TOKEN_SPREAD) {
      rest_of_list(p, kind, pattern);
      break;
    }
    CagPatternPart part = {.pattern = any_pattern(p, kind, "a name")};
    refuse_default(p);
    cag_parse_list_push(p, &part, sizeof part);
    if (!cag_parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_SQUARE, NULL, "`,` or `]`");
  pattern->parts = cag_parse_list_end(p, list, sizeof *pattern->parts, &pattern->count);
  return finish_pattern(p, pattern);
}

// word [ ":" pattern ]
static bool field_pattern(Parser *p, CagDeclKind kind, CagPatternPart *part) {
  const CagToken word = *parse_current(p);
  if (parse_kind(p) == CAG_TOKEN_SPREAD) {
    cag_parse_help(cag_parse_error(p, CAG_ERR_spread_misplaced, cag_parse_here(p),
                                   "`...` is only allowed in the pattern of a list"),
                   "remove it: the record may have more fields");
    return false;
  }
  if (!cag_parse_is_word(parse_kind(p))) {
    cag_parse_unexpected(p, NULL, CAG_ERR_expected_name, "the name of a field or `}`");
    return false;
  }
  part->field = word.as.name;
  part->field_span = word.span;
  cag_parse_advance(p);
  if (cag_parse_accept(p, CAG_TOKEN_COLON)) {
    part->pattern = any_pattern(p, kind, "a name for the field");
  } else if (word.kind == CAG_TOKEN_NAME) {
    part->pattern = name_pattern(p, kind, &word);
  } else {
    cag_parse_help(cag_parse_error(p, CAG_ERR_reserved_name, word.span,
                                   "the reserved word `%s` cannot be defined", word.as.name),
                   "name the field: write %s: name", word.as.name);
    part->pattern = missing_pattern(p, kind);
  }
  refuse_default(p);
  return true;
}

// "{" word [ ":" pattern ] { "," word [ ":" pattern ] } "}"
static CagPattern *record_pattern(Parser *p, CagDeclKind kind) {
  CagPattern *pattern = new_pattern(p, CAG_PATTERN_RECORD, cag_parse_here(p).start);
  const Opened o = cag_parse_open(p, false);
  const size_t list = cag_parse_list_begin(p);
  while (!p->panic && parse_kind(p) != CAG_TOKEN_RIGHT_BRACE) {
    CagPatternPart part = {0};
    if (cag_parse_at_statement(p) || !field_pattern(p, kind, &part)) break;
    cag_parse_list_push(p, &part, sizeof part);
    if (!cag_parse_accept(p, CAG_TOKEN_COMMA)) break;
  }
  cag_parse_close(p, o, CAG_TOKEN_RIGHT_BRACE, NULL, "`,` or `}`");
  pattern->parts = cag_parse_list_end(p, list, sizeof *pattern->parts, &pattern->count);
  return finish_pattern(p, pattern);
}

static CagPattern *any_pattern(Parser *p, CagDeclKind kind, const char *what) {
  const CagTokenKind start = parse_kind(p);
  if (start == CAG_TOKEN_LEFT_SQUARE || start == CAG_TOKEN_LEFT_BRACE) {
    CagPattern *pattern =
        start == CAG_TOKEN_LEFT_SQUARE ? list_pattern(p, kind) : record_pattern(p, kind);
    if (!p->panic && pattern->count == 0 && !pattern->rest)
      cag_parse_help(cag_parse_mend(p, CAG_ERR_expected_name, pattern->span,
                                    "expected at least one name in a pattern"),
                     "`_` stands for a value that is not used");
    return pattern;
  }
  CagToken name;
  if (!cag_parse_name_to_define(p, &name, what)) return missing_pattern(p, kind);
  return name_pattern(p, kind, &name);
}

// ---- names ----

static void push_name(Parser *p, CagDecl *decl) {
  if (strcmp(decl->name, "_") != 0) cag_parse_list_push(p, &decl, sizeof decl);
}

static void push_names(Parser *p, const CagPattern *pattern) {
  if (pattern->decl) push_name(p, pattern->decl);
  for (size_t i = 0; i < pattern->count; i++) push_names(p, pattern->parts[i].pattern);
  if (pattern->rest) push_name(p, pattern->rest);
}

CagPattern *cag_parse_pattern(Parser *p, CagDeclKind kind, const char *what) {
  CagPattern *pattern = any_pattern(p, kind, what);
  const size_t list = cag_parse_list_begin(p);
  push_names(p, pattern);
  pattern->names = cag_parse_list_end(p, list, sizeof *pattern->names, &pattern->name_count);
  return pattern;
}

CagDecl *cag_parse_whole(Parser *p, CagDeclKind kind, const CagPattern *pattern) {
  char text[TEXT_MAX];
  const size_t length = cag_source_excerpt(p->module->source, pattern->span, text, sizeof text);
  CagToken name = {.kind = CAG_TOKEN_NAME, .span = pattern->span};
  name.as.name = cag_names_intern(&p->names, text, length)->bytes;
  CagDecl *decl = cag_parse_declare(p, kind, &name);
  decl->whole = true;
  return decl;
}
