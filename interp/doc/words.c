// Documentation of words of the language and of topics, as text for a terminal.

#include <string.h>

#include "interp/doc/doc.h"

typedef struct Row {
  bool is_topic;
  const char *word, *head, *text, *example; // head: the form of a word, or the references of a
                                            // topic
} Row;

static const Row rows[] = {
#define CAG_DOC_WORD(word, form, text, example) {false, word, form, text, example},
#define CAG_DOC_TOPIC(word, see, text, example) {true, word, see, text, example},
#include "interp/doc/words.def"
#undef CAG_DOC_WORD
#undef CAG_DOC_TOPIC
};
#define COUNT (sizeof rows / sizeof *rows)

static void write_row(const CagDocWriter *w, const Row *r) {
  fprintf(w->out, w->styled ? "\033[1m%s\033[0m\n" : "%s\n", r->is_topic ? r->word : r->head);
  cag_doc_write_wrapped(w->out, r->text, strlen(r->text), 2);
  fputs("\n  Example\n", w->out);
  cag_doc_write_indented(w->out, r->example, 4);
  if (!r->is_topic) return;
  fputs("\n  See also\n", w->out);
  cag_doc_write_wrapped(w->out, r->head, strlen(r->head), 4);
}

bool cag_doc_write_word(const CagDocWriter *w, const char *word, bool more) {
  bool found = false;
  for (size_t i = 0; i < COUNT; i++) {
    if (strcmp(rows[i].word, word) != 0) continue;
    if (more || found) fputc('\n', w->out);
    write_row(w, &rows[i]);
    found = true;
  }
  return found;
}

bool cag_doc_word_row(size_t i, const char **word, const char **see, const char **example) {
  if (i >= COUNT) return false;
  if (word) *word = rows[i].word;
  if (see) *see = rows[i].is_topic ? rows[i].head : NULL;
  if (example) *example = rows[i].example;
  return true;
}
