// The fonts of the system (fontconfig, which is loaded when it is first needed).

#ifndef CAG_INTERP_FORMATS_SYSTEM_FONTS_H
#define CAG_INTERP_FORMATS_SYSTEM_FONTS_H

#include "geom/letter/font.h"

// A face of a file. A face that has none of the styles is regular, and has its full name as name.
typedef struct CagSystemFont {
  char *name, *file;
  CagFontStyle style;
  unsigned index; // of the face in the file
} CagSystemFont;

typedef struct CagSystemFonts {
  CagSystemFont *items; // by name, style, and file
  size_t count, capacity;
} CagSystemFonts;

// Whose fonts these are, for messages: "this system".
extern const char *const cag_system_fonts_owner;

// The scalable TrueType and OpenType fonts. Fails with "library-missing".
CagStatus cag_system_fonts(CagSystemFonts *out, CagError *err);
void cag_system_fonts_free(CagSystemFonts *fonts);

#endif
