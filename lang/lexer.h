// Text to words. The lexer gives one token at a time and looks at nothing but the text: whether a
// newline ends a statement, or a `{` opens a record, is the parser's to say.
//
// A text with { } comes as several tokens: a HEAD up to the first `{`, the tokens of the
// expression, then a MIDDLE for each `} ... {` and a TAIL for the last `} ..."`. The lexer keeps a
// stack of the texts that it stands inside, with the number of plain braces open in each, so
// nesting takes no recursion.
//
// What is wrong with a single word (an unknown unit, an operator of another language) is reported
// here and mended: the token that was meant is given, and parsing goes on. An ERROR token means
// that it cannot go on; its error is reported already.

#ifndef CAG_LANG_LEXER_H
#define CAG_LANG_LEXER_H

#include "lang/ast.h"
#include "lang/names.h"

// CAG_TOKEN(name, what a message calls it)
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
  bool newline_before; // a line ends between the token before and this one
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

// A text whose { } the lexer stands inside.
typedef struct CagOpenText {
  uint32_t start;  // of its opening quote
  uint32_t braces; // plain braces open within its { }
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
  char *buffer; // the text being read, its escapes resolved
  size_t buffer_capacity;
  void *locale; // the C locale for strtod, made when first needed
} CagLexer;

// The lexer borrows everything it is given. Reserved words are interned into `names`.
void cag_lexer_init(CagLexer *lx, const CagSource *source, CagArena *arena, CagNames *names,
                    CagDiagnostics *errors);
// A second lexer on the same text, silent and from another place, to look far ahead.
void cag_lexer_probe(CagLexer *probe, const CagLexer *lx, uint32_t position);
void cag_lexer_release(CagLexer *lx);

void cag_lexer_next(CagLexer *lx, CagToken *t);

// What a message calls a token of this kind: "`)`", "a number".
const char *cag_token_what(CagTokenKind kind);

// Whether a word of this spelling is reserved.
bool cag_word_is_reserved(const char *word);

// What to write for a brace in a text.
extern const char cag_lexer_brace_help[];

// Whether a word is one of the units that come directly after a number.
bool cag_lexer_is_unit(const char *name);

#endif
