// The one layout of scripts.
//
// Formatting looks at the tree and at nothing of the old layout but comments and blank lines, and
// never changes the tree: what is written stays written (units, parentheses, texts), only spaces,
// line breaks, `;` between statements and commas before closing brackets are set anew.

#ifndef CAG_LANG_FORMAT_H
#define CAG_LANG_FORMAT_H

#include "lang/diagnostic.h"
#include "lang/source.h"

// Columns that a line has, where its words allow it.
#define CAG_FORMAT_WIDTH 100

// The script laid out: malloc'd and NUL-terminated, `length` bytes. Formatting the result gives it
// again. NULL where the script has errors or memory is out, which is reported. Memory for trees
// goes by the longest statement.
char *cag_format(const CagSource *source, CagDiagnostics *errors, size_t *length);

#endif
