// Texts as regions: the lines of a text, aligned, or along a curve.

#ifndef CAG_GEOM_LETTER_LETTERING_H
#define CAG_GEOM_LETTER_LETTERING_H

#include "geom/curve/region.h"
#include "geom/letter/shape.h"

typedef enum CagLetterAlign { CAG_LETTER_LEFT, CAG_LETTER_CENTER, CAG_LETTER_RIGHT } CagLetterAlign;
typedef enum CagLetterValign {
  CAG_LETTER_BASELINE,
  CAG_LETTER_TOP,
  CAG_LETTER_MIDDLE,
  CAG_LETTER_BOTTOM
} CagLetterValign;

typedef struct CagLettering {
  CagFont *font; // keeps the glyphs of the text
  double size;   // the height of H in millimeters
  CagLetterAlign align;
  CagLetterValign valign;
  double spacing, line_spacing; // 1: those of the font
  CagLetterDirection direction;
  double width;          // in millimeters; 0: lines are not broken
  const CagCurve *along; // a plane curve; NULL: none
  bool missing;          // as in CagLetterRules
} CagLettering;

// Millimeters. Without ink, `box` is empty.
typedef struct CagLetteringMetrics {
  CagBounds box;          // of the outlines; not along a curve
  double ascent, descent; // above the first baseline, and below the last one
  double advance;         // of the longest line
  size_t lines;
} CagLetteringMetrics;

// The outlines have the font's own curves. Glyphs that overlap are united. Fails with the errors of
// fonts and shaping, and with "lettering-too-long" if a line is longer than the curve.
CagStatus cag_lettering(const char *text, size_t n, const CagLettering *how, CagRegion **out,
                        CagError *err);
CagStatus cag_lettering_measure(const char *text, size_t n, const CagLettering *how,
                                CagLetteringMetrics *out, CagError *err);

#endif
