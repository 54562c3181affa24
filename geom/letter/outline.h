// Outlines of glyphs, as the font has them: lines, and quadratic and cubic Bezier curves.

#ifndef CAG_GEOM_LETTER_OUTLINE_H
#define CAG_GEOM_LETTER_OUTLINE_H

#include "geom/curve/region.h"
#include "geom/letter/font.h"

// The closed outlines of a glyph, in millimeters if `scale` is millimeters per unit of the font.
// Outlines without an extent are left out. The caller releases the loops, and frees the array.
CagStatus cag_glyph_loops(const CagFont *f, uint32_t glyph, double scale, CagCurve ***loops,
                          size_t *count, CagError *err);
// The region of a glyph: the points with a winding number other than 0.
CagStatus cag_glyph_region(const CagFont *f, uint32_t glyph, double scale, CagRegion **out,
                           CagError *err);
// Adds the box around a glyph to `box`, in units of the font.
CagStatus cag_glyph_bounds(const CagFont *f, uint32_t glyph, CagBounds *box, CagError *err);

// The box around a glyph, in units of the font. The font keeps it. Empty: the glyph has no outlines.
CagStatus cag_font_glyph_box(CagFont *f, uint32_t glyph, CagBounds *out, CagError *err);
// The region of a glyph, in units of the font, which keeps it: it is made once.
CagStatus cag_font_glyph_region(CagFont *f, uint32_t glyph, const CagRegion **out, CagError *err);

#endif
