// Formatting of scripts.
//
// Formatting looks at the tree and at nothing of the old layout but comments and blank lines, and
// never changes the tree: what is written stays written (units, parentheses, texts), only spaces,
// line breaks, `;` between statements and commas before closing brackets are set anew.

#ifndef CAG_LANG_FORMAT_H
#define CAG_LANG_FORMAT_H

#include "base/diagnostic.h"
#include "base/source.h"

// Columns that a line has, where its words allow it.
#define CAG_FORMAT_WIDTH 100

// Formats a script. Returns a malloc'd, NUL-terminated text of `length` bytes. Formatting the
// result does not change it. Returns NULL if the script has errors or memory runs out, and reports
// the reason. The memory for syntax trees depends on the longest statement only.
char *cag_format(const CagSource *source, CagDiagnostics *errors, size_t *length);

#endif
