// What the files of the parser share: the parser's state, its tokens, errors and brackets.
//
// Tokens come from a short look-ahead. After an error the parser is in panic: every token reads as
// END, so that all functions return by themselves, and further errors are not reported;
// cag_parse_recover ends it at the next statement. Brackets are counted where tokens are consumed,
// in panic too, so the stack always holds what is open at this place.

#ifndef CAG_LANG_PARSE_H
#define CAG_LANG_PARSE_H

#include "lang/foreign.h"
#include "lang/lexer.h"
#include "lang/parser.h"

#define LOOK_AHEAD 4

typedef struct Bracket {
  CagTokenKind closer;
  CagSpan span;
} Bracket;

typedef struct Parser {
  CagLexer lexer;
  CagLexer probe;          // reads far ahead, or reads the text of probe_source
  CagSource *probe_source; // a word of a path; NULL: none
  CagNames names;
  CagModuleAst *module;
  CagDiagnostics *errors;
  CagParseMode mode;

  CagToken ahead[LOOK_AHEAD]; // ring: the current token, and those looked at beyond it
  unsigned first, count;
  CagToken previous; // the one consumed last
  bool panic;
  bool cut_off;       // the first error was that the text ends too early
  size_t first_error; // errors that were there before this parse

  bool newlines; // newlines count here: the innermost bracket is a block, or there is none
  Bracket brackets[CAG_MAX_NESTING];
  size_t bracket_count;
  uint32_t open[CAG_TOKEN_COMMA]; // how many of them each closing bracket would close
  size_t vain;                    // words looked through ahead for a bracket that was not found
  size_t excess;                  // brackets open beyond the limit
  unsigned depth;         // recursion that no bracket causes: signs, powers, functions, branches
  CagSpan statement_head; // first word of the statement, for hints
  CagTokenKind statement_kind;
  uint32_t habit; // where a word of another language before a definition was passed over

  char *stack; // lists under way
  size_t stack_size, stack_capacity;
  CagDecl **tops;
  size_t top_count, top_capacity;
  const char **damaged_names;
  size_t damaged_name_count, damaged_name_capacity;
  CagStatement **statements;
  size_t statement_count, statement_capacity;

  CagParseEach *each; // takes the statements one by one; NULL: they are kept
  void *each_context;
} Parser;

// ---- tokens ----

CagToken *cag_parse_peek(Parser *p, unsigned n); // n = 0: the current one
void cag_parse_advance(Parser *p);
void cag_parse_skip(Parser *p); // the same, in panic too
void cag_parse_probe_end(Parser *p);

static inline CagTokenKind parse_kind(Parser *p) {
  return p->panic ? CAG_TOKEN_END : p->ahead[p->first].kind;
}
static inline CagToken *parse_current(Parser *p) { return &p->ahead[p->first]; }
static inline CagTokenKind parse_kind_at(Parser *p, unsigned n) {
  return p->panic ? CAG_TOKEN_END : cag_parse_peek(p, n)->kind;
}
bool cag_parse_accept(Parser *p, CagTokenKind kind);
// A newline stands before the current token, in a place where newlines count.
bool cag_parse_at_newline(Parser *p);
// The current token begins a line in its first column, and a statement.
bool cag_parse_at_statement(Parser *p);
// A name with parameters and a `=` stands here: a definition and no call.
bool cag_parse_at_function(Parser *p);
// Here, where `(` opens parameters, stands a list in parentheses instead: no `=>` follows.
bool cag_parse_at_tuple(Parser *p);
bool cag_parse_is_word(CagTokenKind kind); // a name or a reserved word
bool cag_parse_begins_expression(CagTokenKind kind);
bool cag_parse_token_is(Parser *p, const CagToken *t, const char *name);

// ---- errors ----

// Reports an error and goes into panic. NULL when the parser is in panic already.
CagDiagnostic *cag_parse_error(Parser *p, CagErrorId id, CagSpan span, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// Reports an error whose fix is obvious, so that parsing can continue.
CagDiagnostic *cag_parse_mend(Parser *p, CagErrorId id, CagSpan span, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void cag_parse_help(CagDiagnostic *d, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void cag_parse_related(Parser *p, CagDiagnostic *d, CagSpan span, const char *text);
// How a message calls the current token: "`foo`", "the end of the file".
const char *cag_parse_found(Parser *p, char *buffer, size_t size);
CagSpan cag_parse_here(Parser *p); // of the current token; behind the last one at the end
// The text of a span for a hint, `else_text` when it is long or has line breaks.
const char *cag_parse_quote(Parser *p, CagSpan span, char *buffer, size_t size,
                            const char *else_text);
#define QUOTE_SIZE 64
// Says what is wrong with the token behind a complete expression. `wanted` is what could have stood
// there.
void cag_parse_unexpected(Parser *p, const CagExpr *before, CagErrorId id, const char *wanted);

// ---- forms of other languages ----

// What to do where a line that begins with `-` was meant to go on with the line above.
extern const char cag_parse_minus_help[];

// Each reports the form that stands here, in panic, and gives true; false: none of them is here.
//
// Behind a complete expression, which `before` is when it is known; where an expression is missing;
// in place of the `=` of a definition with parameters; where a `:` divides an index or a list.
bool cag_parse_foreign_behind(Parser *p, const CagExpr *before);
bool cag_parse_foreign_value(Parser *p);
bool cag_parse_foreign_body(Parser *p);
bool cag_parse_foreign_colon(Parser *p, CagForeignSyntax id);
// A word at the head of a statement; the next word stands on its line.
bool cag_parse_foreign_word(Parser *p);
// Whether an expression goes on with such a form behind it, so that it is not a statement by
// itself.
bool cag_parse_foreign_follows(Parser *p);

// ---- brackets and lists ----

// Consumes the opening bracket that is the current token; newlines count inside when `newlines`.
// Gives what cag_parse_close needs.
typedef struct Opened {
  CagSpan span;
  bool newlines; // whether they counted outside
} Opened;
Opened cag_parse_open(Parser *p, bool newlines);
// Consumes the closing bracket. `wanted` is what else could stand there: "`,` or `)`".
bool cag_parse_close(Parser *p, Opened o, CagTokenKind closer, const CagExpr *before,
                     const char *wanted);

size_t cag_parse_list_begin(Parser *p);
void cag_parse_list_push(Parser *p, const void *item, size_t size);
// The list since `begin` as an array in the arena.
void *cag_parse_list_end(Parser *p, size_t begin, size_t size, size_t *count);

// ---- the grammar ----

CagDecl *cag_parse_declare(Parser *p, CagDeclKind kind, const CagToken *name);
CagExpr *cag_parse_new(Parser *p, CagExprKind kind, uint32_t start);
// Ends a node behind the last token.
CagExpr *cag_parse_finish(Parser *p, CagExpr *e);
// Counts `below` into the height of e.
void cag_parse_stack_on(Parser *p, CagExpr *e, const CagExpr *below);
CagExpr *cag_parse_error_node(Parser *p);
CagExpr *cag_parse_binary(Parser *p, CagExprKind kind, CagBinaryOp op, CagSpan op_span,
                          CagExpr *left, CagExpr *right);
// Counts recursion that no bracket bounds. Gives false, in panic, when it is too deep.
bool cag_parse_deeper(Parser *p);
// Consumes a name that is defined here; NULL, in panic, when something else stands here.
const CagToken *cag_parse_name_to_define(Parser *p, CagToken *name, const char *what);
// Whether a definition begins where the value of the line before should stand.
bool cag_parse_at_next_definition(Parser *p);
// Says that an expression is missing before the current token.
CagExpr *cag_parse_missing(Parser *p);
bool cag_parse_opens_lambda(Parser *p);
CagExpr *cag_parse_lambda(Parser *p);
CagExpr *cag_parse_branch(Parser *p);
CagExpr *cag_parse_negation(Parser *p);
CagExpr *cag_parse_postfix(Parser *p);
CagExpr *cag_parse_group(Parser *p);
CagExpr *cag_parse_expression(Parser *p);
CagExpr *cag_parse_operand(Parser *p);
CagFunctionAst *cag_parse_function(Parser *p, const char *name);
CagStatement *cag_parse_definition(Parser *p, bool top);
CagStatement *cag_parse_assert(Parser *p);
const char *cag_parse_doc(Parser *p);
// Reports statements and words that have no place at the head of a statement here. Gives true when
// it did.
bool cag_parse_habit(Parser *p, bool in_block);

#endif
