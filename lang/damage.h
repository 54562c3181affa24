// Names that unparsable text may define.

#ifndef CAG_LANG_DAMAGE_H
#define CAG_LANG_DAMAGE_H

#include "lang/lexer.h"

typedef void CagDamagedName(void *context, const char *name);

// Calls `found` for each name that the text of the span may define, as far as this can be
// determined. A name may be reported several times. `lexer` must read the same text.
void cag_damaged_names(const CagLexer *lexer, CagSpan span, CagDamagedName *found, void *context);

#endif
