// Internals of the checker: its state, its reports, the types of names, and type inference.

#ifndef CAG_INTERP_CHECK_WALK_H
#define CAG_INTERP_CHECK_WALK_H

#include "base/arena.h"
#include "interp/check/constant.h"
#include "interp/check/types.h"

// The types of a definition, a parameter, or a name of a comprehension.
typedef struct Known {
  const CagDecl *decl;
  CagTypes types;
} Known;

typedef struct Check {
  CagVm *vm;
  const CagModuleUnit *unit;
  const CagModuleAst *ast;
  Known *known; // open addressing by the address of the declaration
  size_t known_count, known_size;
  // Top-level definitions: their types, and which other definitions they use.
  CagTypes *top_types;
  bool *top_done, *top_busy, *reached;
  size_t *edges; // pairs: user and used definition
  size_t edge_count, edge_capacity;
  size_t top;             // definition whose value is being checked; the number of definitions for
                          // statements
  size_t unjudged;        // enclosing calls of `attempt`
  bool again;             // a part of a value is inferred once more, for its types
  CagDiagnostics ignored; // errors in them
  size_t depth;           // nesting of definitions that are being checked
  CagConstants constants;
  bool *top_bad;   // top-level definitions with errors
  CagArena memory; // holds all of the above
  size_t thunks;   // enclosing functions without parameters, whose calls may be meant to fail
} Check;

// ---- reports ----

// Adds an error with its message. Errors inside `attempt` are discarded.
CagDiagnostic *cag_check_report(Check *c, CagErrorId id, CagSpan span, const char *message);
CagDiagnostic *cag_check_warn(Check *c, CagErrorId id, CagSpan span, const char *message);
// Reports "WANTED, found a number".
void cag_check_report_found(Check *c, CagErrorId id, CagSpan span, const char *wanted,
                            CagTypes types);
size_t cag_check_error_count(const Check *c);

// ---- names ----

// Records the types of a parameter, or of a name in a block or a comprehension.
void cag_check_learn(Check *c, const CagDecl *decl, CagTypes types);
// Returns the types of a top-level definition, and checks the definition first if necessary.
CagTypes cag_check_types_of_top(Check *c, const CagDecl *decl);
// Returns the definition of an imported name or a member of an imported module, or NULL if
// it is unknown.
const CagDecl *cag_check_find_public(const Check *c, const CagStatement *import, const char *name);
// Warns about the use of a definition whose documentation contains `deprecated: ...`.
void cag_check_deprecated(Check *c, const CagDecl *decl, const char *name, CagSpan span);
CagTypes cag_check_infer_name(Check *c, const CagExpr *e);

// ---- expressions ----

// Infers the types that an expression may have, and reports errors in it.
CagTypes cag_check_infer(Check *c, const CagExpr *e);
// Records the types of the names of a pattern that takes a value of these types apart, and reports a
// value that it cannot take apart. `value` is its expression, or NULL.
void cag_check_learn_pattern(Check *c, const CagPattern *pattern, CagTypes types,
                             const CagExpr *value);
void cag_check_infer_all(Check *c, CagExpr *const *items, size_t count);
CagTypes cag_check_infer_call(Check *c, const CagExpr *e);
CagTypes cag_check_infer_pipe(Check *c, const CagExpr *e);
// Reports a condition that can be neither true nor false. `of` names the construct that requires
// it.
void cag_check_expect_bool(Check *c, const CagExpr *e, const char *of);

#endif
