// Fonts: TrueType and OpenType files in memory, and the fonts that are compiled into the program.
//
// Lengths are in units of the font, `em` of which are the height of the font; y is up, and the
// baseline is y = 0. A font belongs to one thread.

#ifndef CAG_GEOM_LETTER_FONT_H
#define CAG_GEOM_LETTER_FONT_H

#include "base/hash.h"
#include "geom/curve/region.h"
#include "geom/letter/libraries.h"

// X(NAME, text)
#define CAG_FONT_STYLES(X)                                                                         \
  X(REGULAR, "regular")                                                                            \
  X(BOLD, "bold")                                                                                  \
  X(ITALIC, "italic")                                                                              \
  X(BOLD_ITALIC, "bold italic")

typedef enum CagFontStyle {
#define X(name, text) CAG_FONT_##name,
  CAG_FONT_STYLES(X)
#undef X
      CAG_FONT_STYLE_COUNT
} CagFontStyle;

extern const char *const cag_font_styles[CAG_FONT_STYLE_COUNT];

// The family of the compiled-in fonts.
#define CAG_FONT_SANS "sans"

typedef struct CagFontFile {
  const unsigned char *bytes;
  size_t size;
} CagFontFile;
// The compiled-in fonts, by their style (generated).
extern const CagFontFile cag_compiled_fonts[CAG_FONT_STYLE_COUNT];
// One of them (geom/letter/compiled.c). In a browser, it is loaded when it is first needed.
CagStatus cag_font_compiled_file(CagFontStyle style, CagFontFile *out, CagError *err);

// A glyph that was asked for (geom/letter/outline.h).
typedef struct CagGlyph {
  uint32_t number;
  CagBounds box;     // of its outlines
  CagRegion *region; // NULL: not needed so far
} CagGlyph;

typedef struct CagFont {
  hb_font_t *hb;
  char name[100]; // for messages
  unsigned em;
  double capital;             // the height of H; without an H, 0.7 em
  double ascender, descender; // the largest heights above and below the baseline that lines allow
  double gap;                 // between the descenders of a line and the ascenders of the next
  size_t held;                // an estimate of the memory of HarfBuzz, held by the account
  CagGlyph *glyphs;           // those that were asked for
  size_t glyph_count, glyph_capacity;
  CagHashIndex glyph_index; // by their numbers
} CagFont;

CagStatus cag_font_compiled_in(CagFontStyle style, CagFont *out, CagError *err);
// The font number `index` of a file. `bytes` must outlive the font. Fails with "font-unreadable"
// and "library-missing".
CagStatus cag_font_new(const char *name, const void *bytes, size_t size, unsigned index,
                       CagFont *out, CagError *err);
void cag_font_free(CagFont *f);

#endif
