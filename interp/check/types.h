// Sets of types, and what is known of built-in functions by their rows.

#ifndef CAG_INTERP_CHECK_TYPES_H
#define CAG_INTERP_CHECK_TYPES_H

#include "interp/vm/builtin.h"
#include "lang/ast.h"

typedef uint64_t CagTypes; // bits 1 << CagType

#define CAG_TYPES(type) ((CagTypes)1 << CAG_##type)
#define CAG_TYPES_ANY ((((CagTypes)1 << CAG_TYPE_COUNT) - 1))
// What a comprehension runs over, and `in` looks into.
#define CAG_TYPES_LOOPED (CAG_TYPES(LIST) | CAG_TYPES(RANGE) | CAG_TYPES(TEXT) | CAG_TYPES(RECORD))
#define CAG_TYPES_FUNCTION (CAG_TYPES(CLOSURE) | CAG_TYPES(BUILTIN))

// The types that a row's `result` names; any where it does not say.
CagTypes cag_types_of_result(const char *result);
// The types that parameter number `parameter` of a row takes.
CagTypes cag_types_taken(const CagBuiltin *row, const CagSignature *s, size_t parameter);
// What an operator gives of operands of these types; 0: it joins none of them.
CagTypes cag_types_joined(CagBinaryOp op, CagTypes left, CagTypes right);
// "a number or an angle"; buffer of `size`.
const char *cag_types_text(CagTypes types, char *buffer, size_t size);

#endif
