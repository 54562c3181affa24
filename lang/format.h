// Formatting of scripts.
//
// The layout is determined by the tree. Of the old layout, only comments and blank lines are kept.
// The tree never changes: words are kept as written (units, parentheses, texts). Only spaces, line
// breaks, `;` between statements, and commas before closing brackets are replaced.

#ifndef CAG_LANG_FORMAT_H
#define CAG_LANG_FORMAT_H

#include "base/diagnostic.h"
#include "base/source.h"

// The maximum line width, unless a word is longer.
#define CAG_FORMAT_WIDTH 100

// Formats a script. Returns a malloc'd, NUL-terminated text of `length` bytes. Formatting the
// result does not change it. Returns NULL if the script has errors or memory runs out, and reports
// the reason. The memory for syntax trees depends on the longest statement only.
char *cag_format(const CagSource *source, CagDiagnostics *errors, size_t *length);

#endif
