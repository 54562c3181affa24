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

#endif
