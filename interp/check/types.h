// Sets of types, and the types of built-in functions according to their rows.

#ifndef CAG_INTERP_CHECK_TYPES_H
#define CAG_INTERP_CHECK_TYPES_H

#include "interp/vm/builtin.h"
#include "lang/ast.h"

typedef uint64_t CagTypes; // bits 1 << CagType

#define CAG_TYPES(type) ((CagTypes)1 << CAG_##type)
#define CAG_TYPES_ANY ((((CagTypes)1 << CAG_TYPE_COUNT) - 1))
// The types that a comprehension can iterate over, and that `in` can search.
#define CAG_TYPES_LOOPED (CAG_TYPES(LIST) | CAG_TYPES(RANGE) | CAG_TYPES(TEXT) | CAG_TYPES(RECORD))
#define CAG_TYPES_FUNCTION (CAG_TYPES(CLOSURE) | CAG_TYPES(BUILTIN))

// Returns the types named by a row's `result`, or any if there are none.
CagTypes cag_types_of_result(const char *result);
// Returns the types that parameter number `parameter` of a row accepts.
CagTypes cag_types_taken(const CagBuiltin *row, const CagSignature *s, size_t parameter);
// Returns the possible types of the result of an operator for operands of these types; 0: the
// operator does not support them.
CagTypes cag_types_joined(CagBinaryOp op, CagTypes left, CagTypes right);
// Writes text such as "a number or an angle" to `buffer`, of `size` bytes.
const char *cag_types_text(CagTypes types, char *buffer, size_t size);

#endif
