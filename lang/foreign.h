// Words and forms of other languages (foreign.def), and the corresponding forms in cag.

#ifndef CAG_LANG_FOREIGN_H
#define CAG_LANG_FOREIGN_H

#include <stddef.h>

// The rows for the parser and the lexer, by id: CAG_FOREIGN_for_statement.
typedef enum CagForeignSyntax {
#define CAG_FOREIGN_NAME(word, form)
#define CAG_FOREIGN_MEMBER(word, form)
#define CAG_FOREIGN_ARGUMENT(word, meant, example, form)
#define CAG_FOREIGN_CALL(function, example, form)
#define CAG_FOREIGN_SYNTAX(id, example, form) CAG_FOREIGN_##id,
#include "lang/foreign.def"
#undef CAG_FOREIGN_NAME
#undef CAG_FOREIGN_MEMBER
#undef CAG_FOREIGN_ARGUMENT
#undef CAG_FOREIGN_CALL
#undef CAG_FOREIGN_SYNTAX
  CAG_FOREIGN_SYNTAX_COUNT
} CagForeignSyntax;

const char *cag_foreign_syntax(CagForeignSyntax id);

// Return the form to write instead of a name, a member, or a call of one of our functions with
// wrong arguments, or NULL if none is known.
const char *cag_foreign_name(const char *word);
const char *cag_foreign_member(const char *word);
const char *cag_foreign_call(const char *function);

// Returns the parameter, one of `count` `parameters`, that an unknown argument name probably means,
// and the form of such a call, or NULL.
const char *cag_foreign_argument(const char *word, const char *const *parameters, size_t count,
                                 const char **form);

#endif
