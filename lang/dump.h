// The syntax tree as nested lists, for tests: `a + b * 2` is (+ a (* b 2)).

#ifndef CAG_LANG_DUMP_H
#define CAG_LANG_DUMP_H

#include <stdio.h>

#include "lang/ast.h"

// Writes one line for each statement.
void cag_ast_dump(FILE *out, const CagModuleAst *m);
void cag_expr_dump(FILE *out, const CagExpr *e);

#endif
