// The lexer: converts text to tokens, one at a time, by looking only at the text. Whether a newline
// ends a statement, or a `{` opens a record, is decided by the parser.
//
// A text with { } becomes several tokens: a HEAD up to the first `{`, the tokens of the expression,
// then a MIDDLE for each `} ... {` and a TAIL for the last `} ..."`. The lexer keeps a stack of the
// enclosing texts, with the number of open braces in each, so nesting needs no recursion.
//
// Errors in a single word (an unknown unit, an operator of another language) are reported and
// corrected here: the probable token is returned, and parsing continues. After an ERROR token,
// parsing cannot continue; its error has been reported.

#ifndef CAG_LANG_LEXER_H
#define CAG_LANG_LEXER_H

#include "lang/ast.h"
#include "lang/names.h"

// CAG_TOKEN(name, its name in messages)
#define CAG_TOKENS(CAG_TOKEN)                                                                      \
  CAG_TOKEN(END, "the end of the file")                                                            \
  CAG_TOKEN(ERROR, "an error")                                                                     \
  CAG_TOKEN(NUMBER, "a number")                                                                    \
  CAG_TOKEN(ANGLE, "an angle")                                                                     \
  CAG_TOKEN(TEXT, "a text")                                                                        \
  CAG_TOKEN(TEXT_HEAD, "a text")                                                                   \
  CAG_TOKEN(TEXT_MIDDLE, "`}`")                                                                    \
  CAG_TOKEN(TEXT_TAIL, "`}`")                                                                      \
  CAG_TOKEN(NAME, "a name")                                                                        \
  CAG_TOKEN(LEFT_PAREN, "`(`")                                                                     \
  CAG_TOKEN(RIGHT_PAREN, "`)`")                                                                    \
  CAG_TOKEN(LEFT_SQUARE, "`[`")                                                                    \
  CAG_TOKEN(RIGHT_SQUARE, "`]`")                                                                   \
  CAG_TOKEN(LEFT_BRACE, "`{`")                                                                     \
  CAG_TOKEN(RIGHT_BRACE, "`}`")                                                                    \
  CAG_TOKEN(COMMA, "`,`")                                                                          \
  CAG_TOKEN(COLON, "`:`")                                                                          \
  CAG_TOKEN(SEMICOLON, "`;`")                                                                      \
  CAG_TOKEN(DOT, "`.`")                                                                            \
  CAG_TOKEN(RANGE, "`..`")                                                                         \
  CAG_TOKEN(RANGE_OPEN, "`..<`")                                                                   \
  CAG_TOKEN(SPREAD, "`...`")                                                                       \
  CAG_TOKEN(EQUALS, "`=`")                                                                         \
  CAG_TOKEN(ARROW, "`=>`")                                                                         \
  CAG_TOKEN(PIPE, "`|>`")                                                                          \
  CAG_TOKEN(EQUAL, "`==`")                                                                         \
  CAG_TOKEN(NOT_EQUAL, "`!=`")                                                                     \
  CAG_TOKEN(LESS, "`<`")                                                                           \
  CAG_TOKEN(LESS_EQUAL, "`<=`")                                                                    \
  CAG_TOKEN(GREATER, "`>`")                                                                        \
  CAG_TOKEN(GREATER_EQUAL, "`>=`")                                                                 \
  CAG_TOKEN(PLUS, "`+`")                                                                           \
  CAG_TOKEN(MINUS, "`-`")                                                                          \
  CAG_TOKEN(STAR, "`*`")                                                                           \
  CAG_TOKEN(SLASH, "`/`")                                                                          \
  CAG_TOKEN(PERCENT, "`%`")                                                                        \
  CAG_TOKEN(BAR, "`|`")                                                                            \
  CAG_TOKEN(AMPERSAND, "`&`")                                                                      \
  CAG_TOKEN(CARET, "`^`")                                                                          \
  CAG_TOKEN(QUESTION, "`?`")                                                                       \
  CAG_TOKEN(ASSIGN_OPERATOR, "an operator that assigns")                                           \
  CAG_TOKEN(AND, "`and`")                                                                          \
  CAG_TOKEN(AS, "`as`")                                                                            \
  CAG_TOKEN(ASSERT, "`assert`")                                                                    \
  CAG_TOKEN(BY, "`by`")                                                                            \
  CAG_TOKEN(ELSE, "`else`")                                                                        \
  CAG_TOKEN(FALSE, "`false`")                                                                      \
  CAG_TOKEN(FOR, "`for`")                                                                          \
  CAG_TOKEN(IF, "`if`")                                                                            \
  CAG_TOKEN(IMPORT, "`import`")                                                                    \
  CAG_TOKEN(IN, "`in`")                                                                            \
  CAG_TOKEN(NONE, "`none`")                                                                        \
  CAG_TOKEN(NOT, "`not`")                                                                          \
  CAG_TOKEN(OR, "`or`")                                                                            \
  CAG_TOKEN(PARAM, "`param`")                                                                      \
  CAG_TOKEN(PRINT, "`print`")                                                                      \
  CAG_TOKEN(SHOW, "`show`")                                                                        \
  CAG_TOKEN(THEN, "`then`")                                                                        \
  CAG_TOKEN(TRUE, "`true`")

typedef enum CagTokenKind {
#define CAG_TOKEN(name, what) CAG_TOKEN_##name,
  CAG_TOKENS(CAG_TOKEN)
#undef CAG_TOKEN
} CagTokenKind;

#define CAG_TOKEN_FIRST_WORD CAG_TOKEN_AND // the reserved words are the last tokens

typedef struct CagToken {
  CagTokenKind kind;
  bool newline_before; // a line ends between the previous token and this one
  CagSpan span;
  uint32_t comments; // number of comments before it
  union {
    double number;    // NUMBER; ANGLE in degrees
    const char *name; // NAME and reserved words
    struct {
      const char *bytes;
      size_t length;
    } text; // TEXT, TEXT_HEAD, TEXT_MIDDLE, TEXT_TAIL
  } as;
} CagToken;

// A text whose { } contains the current token.
typedef struct CagOpenText {
  uint32_t start;  // of its opening quote
  uint32_t braces; // open braces within its { }
} CagOpenText;

typedef struct CagLexer {
  const CagSource *source;
  CagArena *arena;
  CagNames *names;
  CagDiagnostics *errors; // NULL: silent
  uint32_t position;
  bool cut_off; // the text ended inside a raw text or a comment
  bool keep_comments;
  CagOpenText *texts;
  size_t text_count, text_capacity;
  CagComment *comments;
  size_t comment_count, comment_capacity;
  char *buffer; // the text being read, with its escapes replaced
  size_t buffer_capacity;
  void *locale; // the C locale for strtod, created on first use
} CagLexer;

// The lexer borrows all its arguments. Reserved words are interned into `names`.
void cag_lexer_init(CagLexer *lx, const CagSource *source, CagArena *arena, CagNames *names,
                    CagDiagnostics *errors);
// A second, silent lexer on the same text, starting at another position, to look far ahead.
void cag_lexer_probe(CagLexer *probe, const CagLexer *lx, uint32_t position);
void cag_lexer_release(CagLexer *lx);

void cag_lexer_next(CagLexer *lx, CagToken *t);

// Returns the name of this kind of token in messages: "`)`", "a number".
const char *cag_token_what(CagTokenKind kind);

// Tests whether a word is reserved.
bool cag_word_is_reserved(const char *word);

// The help for a brace in a text.
extern const char cag_lexer_brace_help[];

// Tests whether a word is a unit that can directly follow a number.
bool cag_lexer_is_unit(const char *name);
// Returns the millimeters of a unit of length, or 0 if it is none.
double cag_lexer_unit_length(const char *name);

#endif
