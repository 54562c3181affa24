// Where the points of a call stand in a script: the expressions of its argument.

#ifndef CAG_INTERP_SESSION_POINT_LITERALS_H
#define CAG_INTERP_SESSION_POINT_LITERALS_H

#include "interp/vm/vm.h"

// An expression and the module that it stands in. No expression: it is not known.
typedef struct CagLiteral {
  const CagModuleUnit *module;
  const CagExpr *expr;
} CagLiteral;

// Returns the argument for a parameter (from 0) in the text of a call. It is unknown if the text
// calls another function, which has called this one.
CagLiteral cag_literal_of_argument(const CagVm *vm, const CagOriginStep *step, size_t parameter);

// Follows names to their definitions, and indices into lists that are written out, as far as the
// result does not depend on a run.
CagLiteral cag_literal_resolve(const CagVm *vm, CagLiteral l);

// Finds the n elements of a list. All elements of a comprehension are its body. Elements that
// cannot be found get no expression.
void cag_literal_elements(const CagVm *vm, CagLiteral list, size_t n, CagLiteral *out);

// Whether an expression is a number, which may have a minus sign. *span is that of its text.
bool cag_literal_is_number(CagLiteral l, CagSpan *span, double *value);

#endif
