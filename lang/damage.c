// Names that unparsable text may define.
//
// The search works on characters, because after a missing bracket or quote the lexer misreads the
// rest of the text. A name counts as defined before a `=`, as a parameter, between `for` and `in`, and
// in brackets at the start of a line that a `=` follows. If the text begins with two names, it is a
// definition in another language (`module f(x) {`, `def f(x):`), and all names of its head count. All
// names of an import count, too.

#include "lang/damage.h"

#include "base/array.h"
#include "base/memory.h"

#include <string.h>

// Parameters in deeper brackets are ignored.
#define NESTING_MAX 64

typedef struct Word {
  const char *name;
  uint32_t end;
  bool defined;
} Word;

typedef struct Search {
  CagLexer probe;
  const char *text;
  uint32_t end;
  Word *words; // of the open brackets
  size_t count, capacity;
  size_t opened[NESTING_MAX]; // index of the first word of each open bracket
  uint32_t at[NESTING_MAX];   // offset of each open bracket
  size_t depth;
  uint32_t pattern;               // end of the pattern of a definition
  bool first, head, loop, import; // at the first word; in the head of a definition in another
                                  // language; between `for` and `in`; in an import
  CagDamagedName *found;
  void *context;
} Search;

static bool is_name_byte(unsigned char c) {
  return c >= 128 || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

// What follows the text at `p` after blanks.
typedef enum Sequel { OTHER, EQUALS, ARROW } Sequel;

static Sequel sequel(const Search *s, uint32_t p) {
  while (p < s->end && (s->text[p] == ' ' || s->text[p] == '\t')) p++;
  if (p >= s->end || s->text[p] != '=' || s->text[p + 1] == '=') return OTHER;
  return s->text[p + 1] == '>' ? ARROW : EQUALS;
}

static void add_word(Search *s, const CagToken *t) {
  if (!CAG_RESERVE(s->words, s->capacity, s->count + 1)) cag_memory_leave();
  const bool defined = s->head || s->loop || s->import || t->span.start < s->pattern ||
                       sequel(s, t->span.end) != OTHER;
  s->words[s->count++] = (Word){t->as.name, t->span.end, defined};
}

// Tests whether a name follows at `p` on the same line after blanks.
static bool before_name(const Search *s, uint32_t p) {
  const uint32_t start = p;
  while (p < s->end && (s->text[p] == ' ' || s->text[p] == '\t')) p++;
  return p > start && p < s->end && is_name_byte((unsigned char)s->text[p]);
}

// Reports the words from index `from` on. All words of a parameter list count as defined.
static void take_words(Search *s, size_t from, bool parameters) {
  for (size_t i = from; i < s->count; i++)
    if (parameters || s->words[i].defined) s->found(s->context, s->words[i].name);
  s->count = from;
}

// The name before the parameters of a definition is the name of the function.
static void close_bracket(Search *s, uint32_t p) {
  if (s->depth == 0) return;
  if (--s->depth >= NESTING_MAX) return;
  const Sequel next = sequel(s, p + 1);
  size_t from = s->opened[s->depth];
  if (next == EQUALS && from > 0 && s->words[from - 1].end == s->at[s->depth]) from--;
  take_words(s, from, next != OTHER);
}

// Reads the name or the reserved word at `p` and returns its end.
static uint32_t read_word(Search *s, uint32_t p) {
  CagToken t;
  s->probe.position = p;
  cag_lexer_next(&s->probe, &t);
  if (s->first) {
    s->head = t.kind == CAG_TOKEN_NAME && before_name(s, t.span.end);
    s->import = t.kind == CAG_TOKEN_IMPORT;
    s->first = false;
  }
  if (t.kind == CAG_TOKEN_NAME) add_word(s, &t);
  else if (t.kind == CAG_TOKEN_FOR) s->loop = true;
  else if (t.kind == CAG_TOKEN_IN) s->loop = false;
  return t.span.end > p ? t.span.end : p + 1;
}

// Longer patterns are not recognized.
#define PATTERN_MAX 1000

// Tests whether nothing but blanks is before `p` on its line.
static bool starts_line(const Search *s, uint32_t p) {
  while (p > 0 && (s->text[p - 1] == ' ' || s->text[p - 1] == '\t')) p--;
  return p == 0 || s->text[p - 1] == '\n';
}

// Finds the end of a pattern that opens at `p`: the bracket before the `=` of its definition.
static void find_pattern(Search *s, uint32_t p) {
  const uint32_t end = s->end - p > PATTERN_MAX ? p + PATTERN_MAX : s->end;
  if (!starts_line(s, p)) return;
  size_t open = 0;
  for (uint32_t i = p; i < end; i++) {
    const char c = s->text[i];
    if (c == '=' && !strchr("=>", s->text[i + 1]) && !strchr("=<>!", s->text[i - 1])) {
      s->pattern = i; // its bracket is not closed
      return;
    }
    if (c == '[' || c == '{') open++;
    else if ((c == ']' || c == '}') && --open == 0) {
      if (sequel(s, i + 1) == EQUALS) s->pattern = i;
      return;
    }
  }
}

static void read_sign(Search *s, uint32_t p) {
  if (s->text[p] == '[' || s->text[p] == '{') find_pattern(s, p);
  switch (s->text[p]) {
  case '(':
    if (s->depth < NESTING_MAX) {
      s->opened[s->depth] = s->count;
      s->at[s->depth] = p;
    }
    s->depth++;
    break;
  case ')': close_bracket(s, p); break;
  case '{': // in a pattern of a loop
  case ':': s->head = false; break;
  case '=':
  case '\n': s->head = s->loop = false; break;
  default: break;
  }
}

static void release_search(void *search) {
  Search *s = search;
  cag_lexer_release(&s->probe);
  cag_free(s->words);
}

void cag_damaged_names(const CagLexer *lexer, CagSpan span, CagDamagedName *found, void *context) {
  Search s = {.text = lexer->source->text, .end = span.end, .first = true};
  s.found = found;
  s.context = context;
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, release_search, &s);
  cag_lexer_probe(&s.probe, lexer, span.start);
  for (uint32_t p = span.start; p < span.end;) {
    if (is_name_byte((unsigned char)s.text[p])) {
      p = read_word(&s, p);
    } else if (is_digit(s.text[p])) { // including its unit
      while (p < span.end && (is_digit(s.text[p]) || is_name_byte((unsigned char)s.text[p]))) p++;
    } else {
      read_sign(&s, p++);
    }
    if (s.depth == 0 && s.text[p] == '\n') take_words(&s, 0, false);
  }
  take_words(&s, 0, false);
  cag_cleanup_run(&cleanup);
}
