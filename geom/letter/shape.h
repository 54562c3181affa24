// From a text to the glyphs of its lines: bidirectional order (FriBidi), shaping (HarfBuzz), and
// breaking of lines.

#ifndef CAG_GEOM_LETTER_SHAPE_H
#define CAG_GEOM_LETTER_SHAPE_H

#include "geom/letter/font.h"

typedef enum CagLetterDirection {
  CAG_LETTER_LTR,
  CAG_LETTER_RTL,
  CAG_LETTER_TTB,
  CAG_LETTER_AUTO // by the first letter of each paragraph (Unicode Standard Annex 9)
} CagLetterDirection;

// A glyph of a line. Lengths are in units of the font; the line starts at the origin and runs to
// the right, or down.
typedef struct CagLetter {
  uint32_t glyph;
  double x, y;   // its origin
  double middle; // the middle of its advance along the line
} CagLetter;

typedef struct CagLetterLine {
  size_t first, count; // its glyphs, in the order in which they are seen
  double advance;
} CagLetterLine;

typedef struct CagLetters {
  CagLetter *items;
  CagLetterLine *lines;
  size_t count, capacity, line_count, line_capacity;
} CagLetters;

typedef struct CagLetterRules {
  CagLetterDirection direction;
  double spacing; // advances are multiplied by it
  double width;   // lines are broken after spaces and hyphens to be at most this wide; 0: none are
  bool missing;   // characters without a glyph get the font's sign for them; else they are an error
} CagLetterRules;

// `text` is valid UTF-8 of n bytes; line feeds end lines. Fails with "glyph-missing" and
// "library-missing".
CagStatus cag_letters_shape(const CagFont *f, const char *text, size_t n, const CagLetterRules *r,
                            CagLetters *out, CagError *err);
void cag_letters_free(CagLetters *l);

#endif
