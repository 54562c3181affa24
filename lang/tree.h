// Walks over the syntax tree.

#ifndef CAG_LANG_TREE_H
#define CAG_LANG_TREE_H

#include "lang/ast.h"

// Calls `each` for the expressions directly below e, in order.
void cag_tree_below(const CagExpr *e, void (*each)(void *context, const CagExpr *e), void *context);
// The same for a statement of a module or block.
void cag_tree_of_statement(const CagStatement *s, void (*each)(void *context, const CagExpr *e),
                           void *context);
// Returns the statement at the top level that contains the offset, or the last one before it; NULL:
// none.
const CagStatement *cag_tree_statement(const CagModuleAst *ast, size_t offset);

// Tests for a field of a record pattern without `:`, whose name is defined.
static inline bool cag_pattern_is_shorthand(const CagPatternPart *part) {
  return part->field && part->pattern->kind == CAG_PATTERN_NAME &&
         part->pattern->span.start == part->field_span.start;
}
// Returns the expression that is written for a part of a list or record pattern in a value, or NULL.
// `value` may be NULL.
const CagExpr *cag_tree_part(const CagPattern *pattern, size_t i, const CagExpr *value);
// Returns the expression whose value a name of a definition or a param has, or NULL if it is unknown.
// A name of a pattern has the value of a part of a list or a record, if that is written there.
const CagExpr *cag_tree_value(const CagDecl *decl);

#endif
