// Parsing of text to a syntax tree, and name resolution.

#ifndef CAG_LANG_PARSER_H
#define CAG_LANG_PARSER_H

#include "lang/ast.h"

typedef enum CagParseMode {
  CAG_PARSE_FILE, // a module
  CAG_PARSE_REPL  // statements, and also bare expressions
} CagParseMode;

// The maximum nesting depth of brackets (language, section 8).
#define CAG_MAX_NESTING 1000
// The maximum height of an expression tree, for example a chain of this many operators, or of
// brackets with their contents. It is low enough for recursive traversals on an ordinary stack,
// even in a build with sanitizers.
#define CAG_MAX_HEIGHT 4000

// Parses a source. Returns a tree (release it with cag_module_ast_free), or NULL if memory ran out.
// Up to 20 errors are added to `errors`, and the tree has ERROR expressions in place of unreadable
// text.
CagModuleAst *cag_parse(const CagSource *source, CagParseMode mode, CagDiagnostics *errors);
void cag_module_ast_free(CagModuleAst *m);

// Parses a file for work that handles each statement once. Calls `each` for every statement in
// order as long as the text has no errors, and with NULL after the last one; `m` holds the comments
// up to the next statement. A statement is released when `each` returns, so a long file needs no
// more memory than its longest statement. Returns whether there was no error; if there was, discard
// the results of `each`. `each` may abandon the work if memory runs out (base/guard.h).
typedef void CagParseEach(void *context, const CagModuleAst *m, const CagStatement *s);
bool cag_parse_each(const CagSource *source, CagParseEach *each, void *context,
                    CagDiagnostics *errors);

// Tests whether an input of the REPL needs another line: it has an open bracket, text, or comment,
// or ends with an operator.
bool cag_parse_incomplete(const char *text, size_t length);

// Names outside of the file, for the resolver.
typedef struct CagResolveEnv {
  void *context;
  // Returns the index of the built-in with this name, or (size_t)-1.
  size_t (*find_builtin)(void *context, const char *name);
  // All built-in names, for suggestions.
  const char *const *builtin_names;
  size_t builtin_count;
  // Returns the index of a name from an earlier input (REPL), or (size_t)-1. NULL: there are none.
  size_t (*find_outer)(void *context, const char *name);
  const char *const *outer_names;
  size_t outer_count;
  // Whether the module that import statement s refers to defines the public name; `names` (may be
  // NULL) receives all its public names for a hint. NULL: not checked.
  bool (*module_has)(void *context, const CagStatement *s, const char *name,
                     const char *const **names, size_t *count);
} CagResolveEnv;

// Binds every NAME of the tree and sets owners and selves. Reports unknown names (with the nearest
// known name), names defined twice, names that hide a name of an enclosing inner scope, imported
// names that do not exist, and `m.x` of an imported module without x. Returns false if memory ran
// out, which is also reported.
bool cag_resolve(CagModuleAst *m, const CagResolveEnv *env, CagDiagnostics *errors);

#endif
