// Words and forms of other languages (foreign.def), and the form to write in their place.

#ifndef CAG_LANG_FOREIGN_H
#define CAG_LANG_FOREIGN_H

#include <stddef.h>

// The rows of the parser and the lexer, by id: CAG_FOREIGN_for_statement.
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

// The form to write for a name, for a member, and for a call of one of our functions whose
// arguments do not fit it; NULL: none is known.
const char *cag_foreign_name(const char *word);
const char *cag_foreign_member(const char *word);
const char *cag_foreign_call(const char *function);

// The parameter, of `count` `parameters`, that an unknown name of an argument stands for, and the
// form of such a call; NULL: none.
const char *cag_foreign_argument(const char *word, const char *const *parameters, size_t count,
                                 const char **form);

#endif
