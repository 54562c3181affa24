// Documentation: what is known of functions, modules and scripts, as text and as a site.
//
// One source serves all: the rows of the built-ins' table, what `///` lines say in the standard
// library and in scripts, parameters.def, the kinds of errors, and the documents of docs/ that are
// compiled into the program.

#ifndef CAG_INTERP_DOC_H
#define CAG_INTERP_DOC_H

#include <stdio.h>

#include "cag.h"
#include "interp/vm/builtin.h"
#include "lang/ast.h"

// --- Parameters ---

typedef struct CagDocParameter {
  const char *functions, *name, *type, *meaning; // functions: words, "" for all others
} CagDocParameter;

// What a parameter of a built-in means; "" if no row says it. Its type is in the signature.
const char *cag_doc_meaning(const char *function, const char *parameter);
// A parameter of a function of a library module ("std.robots"); NULL if no row describes it.
const CagDocParameter *cag_doc_module_parameter(const char *module, const char *function,
                                                const char *parameter);

// --- Definitions of a script or module ---

typedef enum CagDocKind { CAG_DOC_VALUE, CAG_DOC_FUNCTION, CAG_DOC_PARAM } CagDocKind;

typedef struct CagDocArgument {
  char *name, *fallback; // the default's text; NULL: none
  char *meaning;         // what the /// lines say of it: "number, mm: how wide"; NULL: nothing
} CagDocArgument;

// A public definition. Texts are malloc'd.
typedef struct CagDocEntry {
  CagDocKind kind;
  char *name;
  char *signature;        // "flat(profile, height = 10)"; of a param all of its line
  char *text;             // of the /// lines, without those of parameters; NULL: there are none
  size_t *lines;          // for each line of the text, which of the source it is
  char *fallback, *range; // of a param: its default, and what it may be (NULL: anything)
  char *label;            // of a param: what is said about it; NULL: nothing
  CagDocArgument *arguments;
  size_t argument_count;
} CagDocEntry;

typedef struct CagDocModule {
  char *name;    // "std.robots", or a path
  char *purpose; // the comment that the text begins with, in plain lines; "" where there is none
  CagDocEntry *entries;
  size_t count;
} CagDocModule;

// The definitions of a parsed text.
void cag_doc_module_read(const CagModuleAst *ast, const char *name, CagDocModule *out);
void cag_doc_module_free(CagDocModule *m);

// The head of a documentation's text that is all prose, or all a script (lines indented by four,
// and the blank ones between them); bytes of it, 0 at the end of the text.
size_t cag_doc_part(const char *text, bool *is_code);
// The bytes of such a head, a script without its indentation; malloc'd.
char *cag_doc_part_text(const char *text, size_t length, bool is_code);
// What an example in a script's documentation begins with to see the script: it imports what it
// names of the file's definitions. NULL: it imports things itself, or names none. malloc'd.
char *cag_doc_script_import(const CagDocModule *m, const char *file, const char *example);

// Reads a script's text with a session, which keeps what is wrong with it. Gives the status.
int cag_session_read_doc(CagSession *s, const char *name, const char *text, size_t length,
                         CagDocModule *out);

// The library module called "std.robots" or "robots", by its place in the library; NULL: none.
const char *cag_doc_library(const char *name, const char **text, size_t *length);

// Name of library module i, NULL behind the last.
const char *cag_doc_module_name(size_t i);

// The default that a signature says: of `"left"|"right"`, all that may be said, the first. `n`
// bytes.
size_t cag_doc_default(const char *fallback);

// The first sentence of a summary: `n` bytes from its start on.
size_t cag_doc_sentence(const char *text);

// Calls `give` for each kind of error that a summary names, as "(parameter-range)".
void cag_doc_reasons(const char *summary, void (*give)(void *context, CagErrorId id),
                     void *context);

// A text like that of printf, malloc'd. Leaves the work when memory is out (base/guard.h).
char *cag_doc_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

// --- Text for a terminal ---

typedef struct CagDocWriter {
  FILE *out;
  bool styled; // headings bold, by the codes of terminals
} CagDocWriter;

void cag_doc_write_overview(const CagDocWriter *w);
// What is said of a word of the language and of a topic; `more`: below something. False: nothing.
bool cag_doc_write_word(const CagDocWriter *w, const char *word, bool more);
// Row i of these; `see` is NULL for words. False behind the last.
bool cag_doc_word_row(size_t i, const char **word, const char **see, const char **example);
// Text wrapped at word ends, and lines as they stand, both indented.
void cag_doc_write_wrapped(FILE *out, const char *text, size_t length, size_t indent);
void cag_doc_write_indented(FILE *out, const char *text, int indent);
void cag_doc_write_builtin(const CagDocWriter *w, size_t index);
void cag_doc_write_module(const CagDocWriter *w, const CagDocModule *m);
void cag_doc_write_entry(const CagDocWriter *w, const CagDocModule *m, const CagDocEntry *e);

// --- Documents that are compiled into the program (tools/embed.sh) ---

typedef struct CagDocument {
  const char *path; // "docs/language.md"
  const char *text;
  size_t length;
} CagDocument;

extern const CagDocument cag_documents[];          // ends with a row of NULLs
const CagDocument *cag_document(const char *path); // NULL: none

typedef struct CagDocChapter {
  const char *path, *name, *title, *story; // "docs/batch.md", "batch"
} CagDocChapter;
// Chapter i of the manual, in their order. NULL after the last.
const CagDocChapter *cag_doc_chapter(size_t i);

#endif
