// Documentation of functions, modules, and scripts, as text and as a site.
//
// Its sources are the table of built-ins, the `///` comments in the standard library and in
// scripts, parameters.def, the table of errors, and the documents of docs/ that are embedded into
// the program.

#ifndef CAG_INTERP_DOC_H
#define CAG_INTERP_DOC_H

#include <stdio.h>

#include "cag.h"
#include "interp/vm/builtin.h"
#include "lang/ast.h"

// --- Parameters ---

typedef struct CagDocParameter {
  const char *functions, *name, *type, *meaning; // functions: separated by blanks, "" for all
                                                 // others
} CagDocParameter;

// Returns the meaning of a parameter of a built-in, or "" if no row states it. Its type is in the
// signature.
const char *cag_doc_meaning(const char *function, const char *parameter);
// Returns a parameter of a function of a library module ("std.robots"), or NULL if no row describes
// it.
const CagDocParameter *cag_doc_module_parameter(const char *module, const char *function,
                                                const char *parameter);

// --- Definitions of a script or module ---

typedef enum CagDocKind { CAG_DOC_VALUE, CAG_DOC_FUNCTION, CAG_DOC_PARAM } CagDocKind;

typedef struct CagDocArgument {
  char *name, *fallback; // text of the default; NULL: none
  char *meaning;         // what the /// from the /// lines: "number, mm: how wide"; NULL: none
} CagDocArgument;

// A public definition. Texts are allocated with malloc.
typedef struct CagDocEntry {
  CagDocKind kind;
  char *name;
  char *signature;        // "flat(profile, height = 10)"; for a param, its whole line
  char *text;             // of the /// the /// lines without those of parameters; NULL: none
  size_t *lines;          // for each line of the text, its line in the source
  char *fallback, *range; // of a param: its default, and its allowed values (NULL: any)
  char *label;            // of a param: its label; NULL: none
  CagDocArgument *arguments;
  size_t argument_count;
} CagDocEntry;

typedef struct CagDocModule {
  char *name;    // "std.robots", or a path
  char *purpose; // the comment at the start of the text, as plain lines; "" if there is none
  CagDocEntry *entries;
  size_t count;
} CagDocModule;

// Reads the definitions of a parsed text.
void cag_doc_module_read(const CagModuleAst *ast, const char *name, CagDocModule *out);
void cag_doc_module_free(CagDocModule *m);

// Finds the first part of a documentation text, which is either prose or a script (lines indented
// by four, and blank lines between them). Returns its number of bytes, 0 at the end of the text.
size_t cag_doc_part(const char *text, bool *is_code);
// Returns the text of such a part, allocated with malloc, and without the indentation of a script.
char *cag_doc_part_text(const char *text, size_t length, bool is_code);
// Returns an import statement that makes an example in a script's documentation see the definitions
// of the script that it uses, allocated with malloc, or NULL if the example uses none or has its
// own imports.
char *cag_doc_script_import(const CagDocModule *m, const char *file, const char *example);

// Reads a script's text with a session, which keeps the diagnostics. Returns the status.
int cag_session_read_doc(CagSession *s, const char *name, const char *text, size_t length,
                         CagDocModule *out);

// Returns the full name of the library module called "std.robots" or "robots", or NULL.
const char *cag_doc_library(const char *name, const char **text, size_t *length);

// Returns the name of library module i, or NULL after the last one.
const char *cag_doc_module_name(size_t i);

// Returns the number of bytes of the default in a signature. Of a choice such as `"left"|"right"`,
// it is the first.
size_t cag_doc_default(const char *fallback);

// Returns the number of bytes of the first sentence of a summary.
size_t cag_doc_sentence(const char *text);

// Calls `give` with each kind of error that a summary names, as in "(parameter-range)".
void cag_doc_reasons(const char *summary, void (*give)(void *context, CagErrorId id),
                     void *context);

// Formats a text as printf does, allocated with malloc. Leaves the guard if memory runs out
// (base/guard.h).
char *cag_doc_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

// --- Text for a terminal ---

typedef struct CagDocWriter {
  FILE *out;
  bool styled; // bold headings, with terminal escape codes
} CagDocWriter;

void cag_doc_write_overview(const CagDocWriter *w);
// Writes the documentation of a word of the language or a topic. `more`: text comes before it.
// Returns false if there is none.
bool cag_doc_write_word(const CagDocWriter *w, const char *word, bool more);
// Returns row i of these; `see` is NULL for words. Returns false after the last row.
bool cag_doc_word_row(size_t i, const char **word, const char **see, const char **example);
// Writes text with wrapped lines, or lines as they are, both indented.
void cag_doc_write_wrapped(FILE *out, const char *text, size_t length, size_t indent);
void cag_doc_write_indented(FILE *out, const char *text, int indent);
void cag_doc_write_builtin(const CagDocWriter *w, size_t index);
void cag_doc_write_module(const CagDocWriter *w, const CagDocModule *m);
void cag_doc_write_entry(const CagDocWriter *w, const CagDocModule *m, const CagDocEntry *e);

// --- Documents that are embedded into the program (tools/embed.sh) ---

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
// Returns chapter i of the manual, in order, or NULL after the last one.
const CagDocChapter *cag_doc_chapter(size_t i);

#endif
