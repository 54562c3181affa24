// Fonts by the names that scripts give.

#ifndef CAG_INTERP_BUILTIN_LETTERS_H
#define CAG_INTERP_BUILTIN_LETTERS_H

#include "geom/letter/font.h"
#include "interp/vm/builtin.h"

// The font of an argument: "sans", the name of a font of the system, or the path of a file, whose
// bytes are held. The font is held as well.
bool cag_letters_font(CagCall *call, int argument, const char *name, CagFontStyle style,
                      CagFont **out);

#endif
