// Internals of the parser: its state, tokens, errors, and brackets.
//
// Tokens come from a short look-ahead buffer. After an error, the parser is in panic mode: every
// token reads as END, so that all functions return, and further errors are not reported;
// cag_parse_recover ends this mode at the next statement. Brackets are counted when tokens are
// consumed, even in panic mode, so the stack always contains the open brackets.

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
  CagLexer probe;          // looks far ahead, or reads the text of probe_source
  CagSource *probe_source; // a word of a path; NULL: none
  CagNames names;
  CagModuleAst *module;
  CagDiagnostics *errors;
  CagParseMode mode;

  CagToken ahead[LOOK_AHEAD]; // ring: the current token and those after it that were read ahead
  unsigned first, count;
  CagToken previous; // the last one consumed
  bool panic;
  bool cut_off;       // the first error was that the text ends too early
  size_t first_error; // number of errors before this parse

  bool newlines; // newlines are significant here: the innermost bracket is a block, or there is
                 // none
  Bracket brackets[CAG_MAX_NESTING];
  size_t bracket_count;
  uint32_t open[CAG_TOKEN_COMMA]; // for each closing bracket, the number of brackets that it could
                                  // close
  size_t vain;                    // words read ahead in search of a bracket that was not found
  size_t excess;                  // open brackets beyond the limit
  unsigned depth;         // of recursion without brackets: signs, powers, functions, branches
  CagSpan statement_head; // first word of the statement, for hints
  CagTokenKind statement_kind;
  uint32_t habit; // location of a skipped word of another language before a definition

  char *stack; // unfinished lists
  size_t stack_size, stack_capacity;
  CagDecl **tops;
  size_t top_count, top_capacity;
  const char **damaged_names;
  size_t damaged_name_count, damaged_name_capacity;
  CagStatement **statements;
  size_t statement_count, statement_capacity;

  CagParseEach *each; // receives each statement; NULL: statements are kept
  void *each_context;
} Parser;

// ---- tokens ----

CagToken *cag_parse_peek(Parser *p, unsigned n); // n = 0: the current one
void cag_parse_advance(Parser *p);
void cag_parse_skip(Parser *p); // the same, even in panic mode
void cag_parse_probe_end(Parser *p);

static inline CagTokenKind parse_kind(Parser *p) {
  return p->panic ? CAG_TOKEN_END : p->ahead[p->first].kind;
}
static inline CagToken *parse_current(Parser *p) { return &p->ahead[p->first]; }
static inline CagTokenKind parse_kind_at(Parser *p, unsigned n) {
  return p->panic ? CAG_TOKEN_END : cag_parse_peek(p, n)->kind;
}
bool cag_parse_accept(Parser *p, CagTokenKind kind);
// Tests whether a significant newline precedes the current token.
bool cag_parse_at_newline(Parser *p);
// Tests whether the current token starts a statement in the first column of a line.
bool cag_parse_at_statement(Parser *p);
// Returns the token after the bracket that closes the one at `start`, or ERROR if it is not found.
CagTokenKind cag_parse_behind_bracket(Parser *p, uint32_t start);
// Tests for a name with parameters and a `=`: a definition rather than a call.
bool cag_parse_at_function(Parser *p);
// Tests, at a `(` that could open parameters, for a list in parentheses: no `=>` follows.
bool cag_parse_at_tuple(Parser *p);
bool cag_parse_is_word(CagTokenKind kind); // a name or a reserved word
bool cag_parse_begins_expression(CagTokenKind kind);
bool cag_parse_token_is(Parser *p, const CagToken *t, const char *name);

// ---- errors ----

// Reports an error and enters panic mode. Returns NULL if the parser is in panic mode already.
CagDiagnostic *cag_parse_error(Parser *p, CagErrorId id, CagSpan span, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// Reports an error whose fix is obvious, so that parsing can continue.
CagDiagnostic *cag_parse_mend(Parser *p, CagErrorId id, CagSpan span, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void cag_parse_help(CagDiagnostic *d, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void cag_parse_related(Parser *p, CagDiagnostic *d, CagSpan span, const char *text);
// Describes the current token for messages: "`foo`", "the end of the file".
const char *cag_parse_found(Parser *p, char *buffer, size_t size);
CagSpan cag_parse_here(Parser *p); // of the current token; after the last one at the end
// Returns the text of a span for a hint, or `else_text` if it is long or contains line breaks.
const char *cag_parse_quote(Parser *p, CagSpan span, char *buffer, size_t size,
                            const char *else_text);
#define QUOTE_SIZE 64
// Reports an unexpected token after a complete expression. `wanted` describes the tokens that are
// allowed there.
void cag_parse_unexpected(Parser *p, const CagExpr *before, CagErrorId id, const char *wanted);

// ---- forms of other languages ----

// The help for a line that starts with `-` and was meant to continue the previous line.
extern const char cag_parse_minus_help[];

// These functions test for forms of other languages. If there is one, they report it, enter panic
// mode, and return true.
//
// They are for the following locations: after a complete expression (`before`, or NULL if it is
// unknown); instead of an expression; instead of the `=` of a definition with parameters; and at a
// `:` in an index or a list.
bool cag_parse_foreign_behind(Parser *p, const CagExpr *before);
bool cag_parse_foreign_value(Parser *p);
bool cag_parse_foreign_body(Parser *p);
bool cag_parse_foreign_colon(Parser *p, CagForeignSyntax id);
// At a word at the start of a statement whose next word is on the same line.
bool cag_parse_foreign_word(Parser *p);
// Tests whether such a form continues the preceding expression, which is therefore not a complete
// statement.
bool cag_parse_foreign_follows(Parser *p);

// ---- brackets and lists ----

// Consumes the current token, an opening bracket. `newlines`: newlines inside are significant.
// Returns the state for cag_parse_close.
typedef struct Opened {
  CagSpan span;
  bool newlines; // they are significant outside
} Opened;
Opened cag_parse_open(Parser *p, bool newlines);
// Consumes the closing bracket. `wanted` describes the allowed tokens: "`,` or `)`".
bool cag_parse_close(Parser *p, Opened o, CagTokenKind closer, const CagExpr *before,
                     const char *wanted);

size_t cag_parse_list_begin(Parser *p);
void cag_parse_list_push(Parser *p, const void *item, size_t size);
// Returns the list since `begin` as an array in the arena.
void *cag_parse_list_end(Parser *p, size_t begin, size_t size, size_t *count);

// ---- the grammar ----

CagDecl *cag_parse_declare(Parser *p, CagDeclKind kind, const CagToken *name);
CagExpr *cag_parse_new(Parser *p, CagExprKind kind, uint32_t start);
// Ends a node after the last token.
CagExpr *cag_parse_finish(Parser *p, CagExpr *e);
// Updates the height of e for its child `below`.
void cag_parse_stack_on(Parser *p, CagExpr *e, const CagExpr *below);
CagExpr *cag_parse_error_node(Parser *p);
CagExpr *cag_parse_binary(Parser *p, CagExprKind kind, CagBinaryOp op, CagSpan op_span,
                          CagExpr *left, CagExpr *right);
// Counts recursion without brackets. If it is too deep, enters panic mode and returns false.
bool cag_parse_deeper(Parser *p);
// Consumes the name of a definition. If there is none, enters panic mode and returns NULL.
const CagToken *cag_parse_name_to_define(Parser *p, CagToken *name, const char *what);
// Where a block starts, for recovery within it.
typedef struct BlockStart {
  size_t brackets;    // that are open in it
  unsigned depth;     // of recursion
  uint32_t indent;    // of its first line; UINT32_MAX: it is on the line of its brace
  uint32_t statement; // start of the statement that is being read
} BlockStart;
BlockStart cag_parse_block_start(Parser *p); // at the first token of the block
// Ends panic mode, if the block has another line or its closing brace, and skips what is before it.
// Returns false if no line follows: the brace was skipped as well, or the block has no end.
bool cag_parse_recover_in_block(Parser *p, const BlockStart *b);
// Tests whether a definition starts where the value of the previous line is expected.
bool cag_parse_at_next_definition(Parser *p);
// Reports that an expression is missing before the current token.
CagExpr *cag_parse_missing(Parser *p);
bool cag_parse_opens_lambda(Parser *p);
CagExpr *cag_parse_lambda(Parser *p);
CagExpr *cag_parse_branch(Parser *p);
CagExpr *cag_parse_negation(Parser *p);
CagExpr *cag_parse_postfix(Parser *p);
CagExpr *cag_parse_group(Parser *p);
// Tests for a list or a record before a `=`: the pattern of a definition.
bool cag_parse_at_pattern(Parser *p);
// pattern = name | "_" | "[" ... "]" | "{" ... "}"
//
//   kind   the kind of declaration that the names in the pattern are
//   what   what a message says was expected if there is neither a name nor a bracket
CagPattern *cag_parse_pattern(Parser *p, CagDeclKind kind, const char *what);
// Declares the value that a pattern takes apart. Its name is the text of the pattern.
CagDecl *cag_parse_whole(Parser *p, CagDeclKind kind, const CagPattern *pattern);
CagExpr *cag_parse_expression(Parser *p);
CagExpr *cag_parse_operand(Parser *p);
CagFunctionAst *cag_parse_function(Parser *p, const char *name);
CagStatement *cag_parse_definition(Parser *p, bool top);
CagStatement *cag_parse_assert(Parser *p);
const char *cag_parse_doc(Parser *p);
// Reports statements and words of other languages at the start of a statement. Returns true if
// there was one.
bool cag_parse_habit(Parser *p, bool in_block);

#endif
