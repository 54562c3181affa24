// Internals of documents (see "Documents" in include/cag.h): texts that are being edited, and what
// is known about them.
//
// A document is read again when it is asked about after a change: parsed, with its imports, and its
// names resolved, in a machine of its own. This takes less time than a key stroke, also for long
// files, so nothing is updated piece by piece. A check is made only on request.
//
// Nodes of the syntax tree, units, and occurrences belong to the machine of the document. They are
// valid until the document is read again.

#ifndef CAG_INTERP_DOCUMENT_H
#define CAG_INTERP_DOCUMENT_H

#include "base/arena.h"
#include "cag.h"
#include "interp/check/types.h"
#include "interp/session/session.h"
#include "lang/lexer.h"
#include "lang/tree.h"

// A check reports at most this many problems. Editors show fewer.
#define PROBLEMS_MAX 10000

// What a name stands for.
typedef struct Entity {
  enum EntityKind {
    ENTITY_NONE,    // it is unknown
    ENTITY_DECL,    // a declaration: decl, in unit
    ENTITY_BUILTIN, // a built-in: index
    ENTITY_MODULE,  // a module: unit
    ENTITY_FIELD,   // a field of a record or another value: name
    ENTITY_ARGUMENT // a parameter of a built-in: index of the built-in, name of the parameter
  } kind;
  const CagModuleUnit *unit;
  const CagDecl *decl;
  size_t index;
  const char *name;
} Entity;

// A place in the text that names something.
typedef struct Occurrence {
  CagSpan span;
  Entity entity; // for a name of another module, its definition there
  // The declaration by which the module knows the name; for members of a module, NULL.
  const CagDecl *decl;
  enum OccurrenceRole {
    ROLE_USE,
    ROLE_DEFINITION,
    ROLE_SHORTHAND, // a definition by the name of a field: size in {size} = box
    ROLE_IMPORTED,  // in the list of an import
    ROLE_LABEL      // the name of an argument
  } role;
} Occurrence;

// A file that was read, to notice when it changes.
typedef struct FileState {
  char *path;
  int64_t seconds, nanoseconds, size; // size -1: the file does not exist
} FileState;

typedef struct Document {
  char *file;  // as the host names it
  char *path;  // real path; NULL: a module of the library, or a text that is in no file
  bool open;   // the host has given the text
  bool listed; // by cag_workspace_add_file
  bool stale;  // it may have changed since the last check
  char *text;  // NULL: it is not read yet
  size_t length, capacity;
  size_t *lines; // start of each line; NULL: not known
  size_t line_count;

  CagSession *session; // holds the machine; NULL: the text has not been parsed
  CagModuleUnit *unit;
  bool checked;
  CagTypes *types;         // of the top-level definitions; after a check
  Occurrence *occurrences; // sorted by their start
  size_t occurrence_count;
  FileState *imports;
  size_t import_count;
} Document;

struct CagWorkspace {
  CagSessionOptions options;
  Document **documents;
  size_t count, capacity;
  Document *last; // found last; NULL: none
  FILE *sink;     // receives what `trace` would write in constant definitions
};

// --- workspace.c ---

// Returns the document, or NULL if there is none of this name and memory ran out.
Document *cag_workspace_document(CagWorkspace *w, const char *file);
// Reads the text, unless it is known. Returns false if the file cannot be read.
bool cag_document_has_text(CagWorkspace *w, Document *d);
// Parses the text and resolves its names if that has not been done yet. Returns false if there is
// no text, or memory or time ran out.
bool cag_document_ready(CagWorkspace *w, Document *d);
// The same by name. Returns NULL on failure.
Document *cag_document_get(CagWorkspace *w, const char *file);
// The same, and checks it.
bool cag_document_make_checked(CagWorkspace *w, Document *d);
// Frees the tree of a document that is not open.
void cag_document_rest(Document *d);
// Returns the name of the document that a unit was read from, which is valid as long as both.
const char *cag_document_file_of(const CagWorkspace *w, const Document *d,
                                 const CagModuleUnit *unit);
CagPlace cag_document_place(const CagWorkspace *w, const Document *d, const CagModuleUnit *unit,
                            CagSpan span);
// Runs `work` in a guard against exhausted memory. Returns false if it was abandoned.
bool cag_document_guard(void (*work)(void *context), void *context);
// Calls `each` for every document whose text contains the word, and the open ones first. It is
// ready. Stops if `each` returns false.
void cag_workspace_each(CagWorkspace *w, const char *word, bool (*each)(void *context, Document *d),
                        void *context);

// --- occurrences.c ---

// Lists all occurrences of names in the document.
void cag_document_list(Document *d);
// Returns the occurrence at an offset, or the one that ends there, or NULL.
const Occurrence *cag_document_occurrence(const Document *d, size_t offset);
// Returns the definition that a name of a module refers to in another module, or the declaration
// itself.
Entity cag_entity_of_decl(const CagVm *vm, const CagModuleUnit *unit, const CagDecl *decl);
Entity cag_entity_of_member(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *member);
Entity cag_entity_of_callee(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *callee);
bool cag_entity_equal(const Entity *a, const Entity *b);
// Returns the function of a definition, or NULL.
const CagFunctionAst *cag_entity_function(const Entity *e);
// Returns the value of a definition or param, or NULL.
const CagExpr *cag_entity_value(const Entity *e);
CagNameKind cag_entity_kind(const Entity *e);

// --- scope.c ---

// Calls `give` for each name that is visible at an offset, the innermost first, and then for those
// of the module. A name may be given twice; the first one counts.
void cag_document_scope(const Document *d, size_t offset,
                        void (*give)(void *context, const CagDecl *decl), void *context);
// Returns what a name means at an offset.
Entity cag_document_lookup(const Document *d, size_t offset, const char *name, size_t length);
// Gives the fields of a value, as far as they are known without running it.
typedef void GiveField(void *context, const char *name, const CagExpr *value,
                       const CagModuleUnit *unit);
void cag_fields_of(const CagVm *vm, const CagModuleUnit *unit, const CagExpr *value,
                   GiveField *give, void *context);

// --- pattern_at.c ---

typedef struct PatternAt {
  const CagPattern *pattern; // the innermost list or record pattern
  const CagExpr *value;      // of which the name of a field is written; NULL: none, or unknown
} PatternAt;
// Finds the pattern of a definition around an offset. Returns false if there is none.
bool cag_document_pattern(const Document *d, size_t offset, PatternAt *out);

// --- words.c: the tokens before a cursor ---

typedef struct Tokens {
  CagToken *items;
  size_t count;
  CagComment *comments;
  size_t comment_count;
} Tokens;
// Reads the tokens of a text up to those that start before `end`. They live in the arena.
Tokens cag_document_tokens(const Document *d, size_t end, CagArena *arena);

// A bracket that is open before the cursor.
typedef struct OpenBracket {
  size_t token;    // its index
  size_t commas;   // in it, before the cursor
  size_t argument; // index of the first token of the current item
} OpenBracket;

typedef struct Cursor {
  Tokens tokens;
  size_t offset;
  CagSpan word;  // the name at the cursor, up to the cursor; empty: none
  size_t before; // number of tokens before the word
  bool in_comment;
  const CagToken *text; // the text that contains the cursor; NULL: none
  OpenBracket *open;    // innermost last
  size_t open_count;
  size_t statement; // index of the first token of the statement
} Cursor;
void cag_document_cursor(const Document *d, size_t offset, CagArena *arena, Cursor *out);

// The call that encloses a cursor.
typedef struct CursorCall {
  Entity callee;
  const char *name;  // in the arena
  size_t position;   // index of the current argument, with one from a pipe
  const char *label; // name of the current argument; NULL: by position
  bool piped;
  size_t *labels; // tokens of the labels of other arguments
  size_t label_count;
} CursorCall;
// Finds the innermost call. Returns false if there is none.
bool cag_document_call(const Document *d, const Cursor *c, CagArena *arena, CursorCall *out);
// Returns what the tokens [.., end) that end with a name or a chain of members mean.
Entity cag_document_chain(const Document *d, const Cursor *c, size_t end, size_t *start);

// --- describe.c: Markdown ---

void cag_describe_entity(CagWorkspace *w, Document *d, const Entity *e, CagString *out);
// Adds the signature of a definition: "ring(outer, inner = outer / 2)".
void cag_describe_head(const Entity *e, CagString *out);
// Adds the text of /// lines as Markdown.
void cag_describe_doc(const char *doc, bool brief, CagString *out);
void cag_describe_builtin(size_t index, bool brief, CagString *out);
// Adds a word of the language. Returns false if it is none.
bool cag_describe_word(const char *word, CagString *out);

#endif
